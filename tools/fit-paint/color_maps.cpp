#include "color_maps.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "base/paths.h"
#include "image/surface_file.h"

namespace goniochrome::tool {

namespace {

constexpr int kMapWarningsShown = 5, kModelsTold = 5;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

// The path of the folder relative to the paint file, or to the current folder where the paints go to standard output.
std::filesystem::path folder_from_output(const Options& options) {
  const std::filesystem::path output = options.output == "-" ? "" : options.output;
  const auto base = output.has_parent_path() ? output.parent_path() : std::filesystem::path(".");
  return relative_path(options.color_map, base.string());
}

Result<fit::ColorMapFit> fitted(const paint::Paint& paint, const brdf::MeasuredBrdf* brdf,
                                const fit::ColorMapOptions& options) {
  if (brdf != nullptr) return fit::fit_color_map(*brdf, {"D65", 2}, options);
  if (!paint.measurement) return input_error("it has no readings");
  return fit::fit_color_map(*paint.measurement, options);
}

// The left-out readings tell which model is better.
bool is_sure(const fit::ColorMapFit& fit) {
  constexpr double kSure = 2;  // standard errors
  return fit.difference_error_de76 &&
         std::abs(fit.isolines_de76 - fit.aspecular_de76) >= kSure * *fit.difference_error_de76;
}

}  // namespace

ColorMaps::ColorMaps(const Options& options, cli::Session& session) : options_(options), session_(session) {}

Result<void> ColorMaps::begin() const {
  if (options_.color_map.empty()) return {};
  GONIO_TRY(make_folder(options_.color_map));
  return can_be_written((std::filesystem::path(options_.color_map) / "map.exr").string());
}

// The letters, digits, - and _ of the paint's name. A number follows where two names would become the same.
std::string ColorMaps::file_name(const std::string& paint) {
  std::string plain = paint;
  std::ranges::replace_if(
      plain, [](char c) { return !is_plain(c); }, '_');
  std::string name = plain;
  for (int n = 2; !names_.insert(name).second; ++n) name = fmt::format("{}-{}", plain, n);
  return name + ".exr";
}

Result<std::optional<MadeMap>> ColorMaps::add(paint::Paint& paint, const brdf::MeasuredBrdf* brdf,
                                              const std::string& where) {
  if (options_.color_map.empty()) return std::optional<MadeMap>();
  fit::ColorMapOptions asked;
  if (options_.color_map_model == "isolines") asked.model = fit::ColorMapModel::kIsolines;
  if (options_.color_map_model == "aspecular") asked.model = fit::ColorMapModel::kAspecular;
  if (paint.color_map) asked.index = paint.color_map->index;
  const auto fit = fitted(paint, brdf, asked);
  if (!fit.ok()) {
    if (++without_ <= kMapWarningsShown)
      session_.warn(fmt::format("{}: paint \"{}\" gets no color map: {}", where, paint.name, fit.error().message));
    return std::optional<MadeMap>();
  }
  const std::string name = file_name(paint.name);
  const std::string path = (std::filesystem::path(options_.color_map) / name).string();
  GONIO_TRY(image::write_color_map(path, fit->map,
                                   {{"goniochrome:command", session_.provenance()},
                                    {"goniochrome:heldOutIsolines", static_cast<float>(fit->isolines_de76)},
                                    {"goniochrome:heldOutAspecular", static_cast<float>(fit->aspecular_de76)}}));
  paint.color_map = paint::ColorMapReference{(folder_from_output(options_) / name).generic_string(), asked.index};
  ++made_;
  tell_model(*fit, paint.name);
  sum_held_out_ += fit->held_out_de76;
  if (fit->map.aspecular) ++aspecular_;
  session_.add("color_maps", [&] {
    return Json{{"name", paint.name},
                {"file", path},
                {"rows", fit->rows},
                {"glare_rows", fit->glare_rows},
                {"grazing_rows", fit->grazing_rows},
                {"beyond_rows", fit->beyond_rows},
                {"illuminations", fit->illuminations},
                {"model", fit->map.aspecular ? "aspecular" : "isolines"},
                {"isolines_power", fit->isolines_power},
                {"isolines_de76", json_number(fit->isolines_de76)},
                {"aspecular_de76", json_number(fit->aspecular_de76)},
                {"difference_error_de76",
                 fit->difference_error_de76 ? json_number(*fit->difference_error_de76) : Json(nullptr)},
                {"compared_rows", fit->compared_rows},
                {"held_out_de76", json_number(fit->held_out_de76)},
                {"negative_share", fit->negative_share}};
  });
  return std::optional(MadeMap{fit->map, options_.color_map_model == "isolines" || is_sure(*fit)});
}

// Which model the map of a paint has, and how sure it is that this is the better one.
void ColorMaps::tell_model(const fit::ColorMapFit& fit, const std::string& name) {
  if (++told_ > kModelsTold) return;
  const double apart = std::abs(fit.isolines_de76 - fit.aspecular_de76);
  session_.say(fmt::format(
      "{}: the map goes by {}: {} readings are predicted to {:.2f} dE76 by isolines and to {:.2f} by the aspecular "
      "angle, which differ by {:.2f}{}{}",
      name, fit.map.aspecular ? "the aspecular angle" : "isolines", fit.compared_rows, fit.isolines_de76,
      fit.aspecular_de76, apart,
      fit.difference_error_de76 ? fmt::format(" with a standard error of {:.2f}", *fit.difference_error_de76) : "",
      is_sure(fit) ? "" : ": they do not tell which is better"));
}

void ColorMaps::finish() {
  if (options_.color_map.empty()) return;
  session_.results()["without_color_map"] = without_;
  if (without_ > kMapWarningsShown)
    session_.warn(fmt::format("{} more paints get no color map", without_ - kMapWarningsShown));
  session_.say(
      fmt::format("{}: {} color maps, {} of them by the aspecular angle alone, mean dE76 of a reading predicted from "
                  "the others {:.2f}",
                  session_.tool(), made_, aspecular_, made_ > 0 ? sum_held_out_ / made_ : 0));
}

}  // namespace goniochrome::tool
