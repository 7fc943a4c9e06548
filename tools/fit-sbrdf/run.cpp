#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/clock.h"
#include "base/text.h"
#include "capture/map_fit.h"
#include "capture/photo_stack.h"
#include "capture/photo_table.h"
#include "image/surface_file.h"
#include "output_names.h"
#include "tool.h"

namespace goniochrome::tool {

namespace {

Result<void> check(const Options& options) {
  GONIO_TRY(check_output_name(options.output, "an EXR", ".exr"));
  if (options.method == "nonlinear" && options.lobes > 2)
    return usage_error("--method nonlinear takes 1 or 2 lobes, and --lobes is {}: take --method dictionary",
                       options.lobes);
  if (!options.error_map.empty() && !options.error_map.ends_with(".exr") && !options.error_map.ends_with(".png"))
    return usage_error("--error-map is \"{}\": give a name that ends in .exr or .png", options.error_map);
  return {};
}

// Nothing where the option is not given.
Result<capture::MapSize> size_of(const std::string& text) {
  if (text.empty()) return capture::MapSize{};
  const auto words = split(lower(text), 'x');
  if (words.size() == 2) {
    const auto columns = parse_integer(words[0]), rows = parse_integer(words[1]);
    if (columns && rows && std::min(*columns, *rows) >= 1 && std::max(*columns, *rows) <= 16384)
      return capture::MapSize{static_cast<int>(*columns), static_cast<int>(*rows)};
  }
  return usage_error("--texels is \"{}\": give two whole numbers from 1 to 16384, as in --texels 512x256", text);
}

capture::MapMethod method_of(const std::string& name) {
  for (const auto method : {capture::MapMethod::kDictionary, capture::MapMethod::kNonlinear})
    if (name == capture::method_name(method)) return method;
  return capture::MapMethod::kBest;
}

// The image of an option, or nothing where it is not given. `as_normals`: whole numbers stand for -1 to 1.
Result<std::optional<image::Image>> image_of(const std::string& path, bool as_normals) {
  if (path.empty()) return std::optional<image::Image>();
  GONIO_ASSIGN(image::ImagePart part, image::read_image(path));
  if (as_normals && part.image.channels < 3)
    return input_error("{}: has {} channels: the normals are in R, G and B", path, part.image.channels);
  if (as_normals && image::attribute_or(part.attributes, "goniochrome:integer", 0) != 0)
    for (float& value : part.image.data) value = 2 * value - 1;
  return std::optional(std::move(part.image));
}

std::string plan_text(const Options& options, const capture::PhotoTable& table) {
  const auto marked =
      std::ranges::count_if(table.photos, [](const capture::Photo& p) { return p.corners.has_value(); });
  return fmt::format(
      "{} photographs, {} of them held out; {} lobes for each texel, {} numbers\n"
      "{} photographs are rectified from their corners\n"
      "each texel needs {} photographs or more\n"
      "methods: dictionary weighs shadows and outliers down and asks neighbors; nonlinear is plain least squares, for "
      "1 or 2 lobes, and takes a tenth to a half of the time\n"
      "left out: light between texels, shadows that most photographs have, and light that is not white\n",
      table.photos.size(), options.holdout, options.lobes, 3 + 6 * options.lobes + 1, marked,
      capture::least_photos(options.lobes));
}

Result<void> write_error_map(const std::string& path, const capture::MapFit& fit, const cli::Session& session) {
  if (path.empty()) return {};
  const int width = fit.map.width, height = fit.map.height;
  const image::Attributes attributes = {{"goniochrome:command", session.provenance()}};
  if (path.ends_with(".exr"))
    return image::write_exr(path,
                            {{"", {width, height, 1, fit.error, {"error"}}, attributes, image::PixelType::kFloat}});
  image::Image picture{width, height, 3, {}, {}};
  constexpr float kWhite = 0.2F;
  for (std::size_t i = 0; i < fit.error.size(); ++i) {
    const float gray = std::min(fit.error[i] / kWhite, 1.0F);
    const bool uncertain = fit.alpha[i] > 0 && fit.certainty[i] == 0;
    picture.data.insert(picture.data.end(),
                        {uncertain ? 1.0F : gray, uncertain ? gray / 2 : gray, uncertain ? gray / 2 : gray});
  }
  return image::write_png(path, picture, attributes);
}

Result<void> write_map(const std::string& path, const capture::MapFit& fit, const cli::Session& session) {
  const image::Attributes attributes = {{"goniochrome:command", session.provenance()}};
  image::Image beside{fit.map.width, fit.map.height, 3, {}, {"alpha", "certainty", "error"}};
  for (std::size_t i = 0; i < fit.error.size(); ++i)
    beside.data.insert(beside.data.end(), {fit.alpha[i], fit.certainty[i], fit.error[i]});
  return image::write_sbrdf(path, fit.map, attributes, {{"capture", std::move(beside), {}, image::PixelType::kHalf}});
}

void report(const capture::PhotoTable& table, const capture::PhotoStack& stack, const capture::MapFit& fit,
            const Options& options, Json& results) {
  results["texels"] = fit.texels;
  results["uncertain"] = fit.uncertain;
  results["width"] = fit.map.width;
  results["height"] = fit.map.height;
  results["lobes"] = fit.map.lobes;
  results["rel_error_median"] = fit.rel_error_median;
  results["holdout_rel_error"] = options.holdout > 0 ? Json(fit.holdout_rel_error) : Json(nullptr);
  results["left_out_share"] = fit.left_out_share;
  results["method"] = capture::method_name(fit.method);
  results["methods"] = Json::array();
  for (const capture::MethodFigures& method : fit.methods)
    results["methods"].push_back({{"method", capture::method_name(method.method)},
                                  {"rel_error", method.rel_error},
                                  {"texel_us", method.texel_us}});
  results["images"] = Json::array();
  for (std::size_t k = 0; k < fit.photos.size(); ++k) {
    const capture::PhotoFigures& photo = fit.photos[k];
    results["images"].push_back({{"image", table.photos[k].image},
                                 {"exposure_factor", photo.exposure_factor},
                                 {"wrong_exposure", photo.wrong_exposure},
                                 {"held_out", photo.held_out},
                                 {"rel_error", photo.rel_error},
                                 {"saturated_share", stack.shares()[k].saturated},
                                 {"black_share", stack.shares()[k].black}});
  }
  results["fit_s"] = fit.fit_s;
  results["texels_per_s"] = fit.fit_s > 0 ? static_cast<double>(fit.texels) / fit.fit_s : 0;
}

void warn(const capture::PhotoTable& table, const capture::MapFit& fit, const Options& options, cli::Session& session) {
  for (std::size_t k = 0; k < fit.photos.size(); ++k) {
    const capture::PhotoFigures& photo = fit.photos[k];
    if (!photo.wrong_exposure) continue;
    const std::string right = shortest(std::round(1e4 * table.photos[k].exposure * photo.exposure_factor) / 1e4);
    session.warn(
        fmt::format("{}:{}: {} is {:.2f} times as bright as the other photographs predict: its exposure should "
                    "be {}{}; {}",
                    table.path, table.photos[k].line, table.photos[k].image, photo.exposure_factor, right,
                    photo.exposure_factor > 1 ? ", unless it shows a highlight that these lobes do not reach" : "",
                    options.mend_exposures ? "it was corrected" : "it was left out"));
  }
  if (fit.uncertain > 0)
    session.warn(
        fmt::format("{} of {} texels are uncertain, as the channel certainty tells: give more photographs near "
                    "the mirror direction, or fewer --lobes",
                    fit.uncertain, fit.texels));
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_TRY(check(options));
  GONIO_ASSIGN(const capture::MapSize size, size_of(options.texels));
  const std::string path = options.table.empty() ? "-" : options.table.front();
  GONIO_ASSIGN(const capture::PhotoTable table, capture::read_photo_table(path));
  session.explain(plan_text(options, table));
  // The table alone is checked before hundreds of pictures are read; the surface counts as a square for that.
  GONIO_TRY(capture::check_stations(table, options.width, options.width,
                                    capture::least_photos(options.lobes) + options.holdout));
  GONIO_ASSIGN(const std::optional<image::Image> mask, image_of(options.mask, false));
  GONIO_ASSIGN(const std::optional<image::Image> normals, image_of(options.normals, true));
  const Stopwatch clock;
  GONIO_ASSIGN(const capture::PhotoStack stack,
               capture::PhotoStack::open(table, options.saturated, size, [&](int done) {
                 session.progress(fmt::format("read {} of {} photographs", done, table.photos.size()));
               }));
  session.results()["read_s"] = clock.elapsed_s();
  capture::MapFitOptions how;
  how.lobes = options.lobes, how.method = method_of(options.method), how.holdout = options.holdout;
  how.width = options.width, how.relative_noise = options.noise, how.mend_exposures = options.mend_exposures;
  how.tile_rows = options.tile_rows;
  how.mask = mask ? &*mask : nullptr, how.normals = normals ? &*normals : nullptr;
  how.progress = [&](const std::string& stage, double share) {
    session.progress(fmt::format("{}: {:.0f} %", stage, 100 * share));
  };
  GONIO_ASSIGN(const capture::MapFit fit, capture::fit_map(table, stack, how));
  report(table, stack, fit, options, session.results());
  GONIO_TRY(write_error_map(options.error_map, fit, session));
  GONIO_TRY(write_map(options.output, fit, session));
  warn(table, fit, options, session);
  for (const capture::MethodFigures& method : fit.methods)
    session.say(fmt::format("{}: median error {:.2f} % where it did not look, {:.0f} us a texel",
                            capture::method_name(method.method), 100 * method.rel_error, method.texel_us));
  const double error = options.holdout > 0 ? fit.holdout_rel_error : fit.rel_error_median;
  session.say(fmt::format("{}: {} texels by {} in {:.1f} s, median error {:.2f} % {}, {} uncertain", session.tool(),
                          fit.texels, capture::method_name(fit.method), fit.fit_s, 100 * error,
                          options.holdout > 0 ? "of the photographs held out" : "of the photographs fitted",
                          fit.uncertain));
  return error <= options.common.tolerance ? cli::Verdict::kDone : cli::Verdict::kNegative;
}

}  // namespace goniochrome::tool
