#include "tool.h"

#include <array>
#include <cmath>
#include <optional>

#include "base/csv_records.h"
#include "base/file.h"
#include "base/text.h"
#include "color/illuminant.h"
#include "color/reflection_file.h"
#include "color/spectrum.h"
#include "image/color_space.h"
#include "output_names.h"

namespace goniochrome::tool {

namespace {

// R,G,B or the name of an illuminant.
Result<color::Rgb> illuminant(const std::string& option, const std::string& text) {
  if (text.empty()) return usage_error("--{} is missing: give R,G,B, {}", option, color::spectral_illuminants());
  const auto words = split(text, ',');
  if (words.size() == 1 && !parse_number(text)) {
    const auto white = color::white_point(color::condition_of(text, 2));
    if (!white.ok()) return usage_error("--{} {}: give R,G,B, {}", option, text, color::spectral_illuminants());
    return color::rgb_from_xyz_d65(*white);
  }
  color::Rgb rgb;
  for (int c = 0; c < 3; ++c) {
    const auto value = words.size() == 3 ? parse_number(trimmed(words[static_cast<std::size_t>(c)])) : std::nullopt;
    if (!value || *value < 0)
      return usage_error("--{} {}: give three values of 0 or more, such as 1,0.9,0.1, or {}", option, text,
                         color::spectral_illuminants());
    rgb[c] = *value;
  }
  return rgb;
}

Result<color::ReflectionOperator> operator_of(const Options& options) {
  if (options.transfer.empty()) return color::chosen_operator(options.op);
  if (options.transfer.size() != 3)
    return usage_error("--transfer has {} values: give three, for red, green and blue", options.transfer.size());
  return color::chosen_operator(options.op, color::Rgb{options.transfer[0], options.transfer[1], options.transfer[2]});
}

std::string plan_text(const Options& options, const color::Rgb& from, const color::Rgb& to,
                      const color::Relighting& change) {
  std::string text = fmt::format("illuminant {} {} {} to {} {} {}, operator {}\n", shortest(from.x), shortest(from.y),
                                 shortest(from.z), shortest(to.x), shortest(to.y), shortest(to.z), options.op);
  text += fmt::format("condition number {:.4g}: relative errors of the image grow by at most that\n", change.condition);
  for (const auto& row : change.matrix) text += fmt::format("{:10.6f} {:10.6f} {:10.6f}\n", row[0], row[1], row[2]);
  return text;
}

// Changes every pixel, and returns how many of them have a negative channel. Error: the first pixel that is not finite.
Result<std::size_t> relit(image::Image& image, const color::Matrix3& matrix, bool keep_negative,
                          const std::string& name) {
  std::size_t negative = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      float* pixel = image.pixel(x, y);
      const color::Rgb color = color::product(matrix, vec3(pixel));
      negative += color.x < 0 || color.y < 0 || color.z < 0;
      for (int c = 0; c < 3; ++c) {
        pixel[c] = static_cast<float>(keep_negative ? color[c] : std::max(color[c], 0.0));
        if (!std::isfinite(pixel[c])) return input_error("{}: pixel ({},{}) is not finite", name, x, y);
      }
    }
  }
  return negative;
}

struct MatchingTable {
  std::vector<double> wavelengths_nm;
  std::vector<color::Rgb> values;
};

// Where the wavelength and the three values stand: the first columns, or those of these names in any order.
std::array<std::size_t, 4> columns_of(const std::vector<std::string>& heads) {
  constexpr std::array<std::array<std::string_view, 3>, 3> kNames = {
      {{"r", "g", "b"}, {"red", "green", "blue"}, {"x", "y", "z"}}};
  for (const auto& names : kNames) {
    std::array<std::size_t, 4> columns = {6, 0, 0, 0};
    std::size_t found = 0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < heads.size(); ++i)
        if (lower(heads[i]) == names[c]) columns[c + 1] = i, columns[0] -= i, ++found;
    if (found == 3 && heads.size() == 4) return columns;
  }
  return {0, 1, 2, 3};
}

// Reads color-matching functions: rows of a wavelength and three values, at equal steps, below a row of names or none.
// Error: the file, the line and the value.
Result<MatchingTable> read_matching_table(const std::string& path) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::vector<TableRow> rows, table_rows(CsvRecords(std::move(input)), true));
  MatchingTable table;
  std::array<std::size_t, 4> columns = {0, 1, 2, 3};
  for (const auto& [line, cells] : rows) {
    if (cells.size() != 4)
      return input_error("{}:{}: {} columns: give a wavelength and three values", path, line, cells.size());
    if (table.values.empty() && !number_in_cell(cells.front())) {  // the names of the columns
      columns = columns_of(cells);
      continue;
    }
    std::array<double, 4> values{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto value = number_in_cell(cells[columns[k]]);
      if (!value) return input_error("{}:{}: \"{}\" is not a number", path, line, shown(cells[columns[k]]));
      values[k] = *value;
    }
    std::vector<double>& nm = table.wavelengths_nm;
    nm.push_back(values[0]);
    table.values.push_back({values[1], values[2], values[3]});
    if (nm.size() < 2) continue;
    const double step = nm[1] - nm[0];
    if (!(step > 0) || std::abs(values[0] - nm[nm.size() - 2] - step) > 1e-6 * step)
      return input_error("{}:{}: wavelength {} breaks the equal steps of {}", path, line, values[0], step);
  }
  return table;
}

// Refuses functions that leave out much of what is visible, and tells of those that leave out some of it.
Result<void> check_range(const MatchingTable& table, const std::string& path, cli::Session& session) {
  if (table.wavelengths_nm.size() < 2) return {};
  const auto meter = color::SpectralColorimeter::make(table.wavelengths_nm, {"D65", 2});
  if (!meter.ok()) return input_error("{}: {}", path, meter.error().message);
  if (meter->held_share() > color::kToldHeldShare)
    session.warn(fmt::format("{}: its wavelengths leave out {:.0f} % of what the observer sees", path,
                             100 * meter->held_share()));
  return {};
}

// --primaries: a name, or x,y of red, green, blue and, if wanted, white. Nothing where the option is not given.
Result<std::optional<color::Primaries>> primaries_of(const std::string& text) {
  if (text.empty()) return std::optional<color::Primaries>();
  if (text == "rec709") return std::optional(color::kRec709);
  if (text == "rec2020") return std::optional(color::kRec2020);
  const auto words = split(text, ',');
  color::Primaries primaries = color::kRec2020;
  bool right = words.size() == 6 || words.size() == 8;
  for (std::size_t i = 0; i < words.size() && right; ++i) {
    const auto value = parse_number(trimmed(words[i]));
    right = value.has_value();
    if (right) (i < 6 ? primaries.rgb[i / 2] : primaries.white)[i % 2] = *value;
  }
  if (!right)
    return usage_error(
        "--primaries is \"{}\": give rec709, rec2020, or x,y of red, green and blue and, if wanted, of white", text);
  const auto usable = color::in_working_space(color::component_wise(), primaries);
  if (!usable.ok()) return usage_error("--primaries is \"{}\": {}", text, usable.error().message);
  return std::optional(primaries);
}

Result<cli::Verdict> estimate(const Options& options, cli::Session& session) {
  if (!options.image.empty() || !options.from.empty() || !options.to.empty() || !options.transfer.empty())
    return usage_error("--estimate makes an operator: it takes no image, --from, --to or --transfer");
  GONIO_ASSIGN(const auto primaries, primaries_of(options.primaries));
  GONIO_ASSIGN(const MatchingTable table, read_matching_table(options.estimate));
  GONIO_TRY(check_range(table, options.estimate, session));
  GONIO_ASSIGN(const color::ReflectionOperator op, color::estimated_operator(table.values));
  session.results()["operator"] = op.k;
  session.results()["condition"] = nullptr;
  GONIO_TRY(write_file(options.output, color::reflection_json(op, primaries ? &*primaries : nullptr)));
  session.say(fmt::format("{}: each channel keeps {:.4f} {:.4f} {:.4f} of itself", session.tool(), op.k[0][0][0],
                          op.k[1][1][1], op.k[2][2][2]));
  return cli::Verdict::kDone;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (!options.estimate.empty()) return estimate(options, session);
  if (!options.primaries.empty())
    return usage_error("--primaries is for --estimate: an operator of --operator has its own");
  GONIO_TRY(check_output_name(options.output, "an EXR", ".exr"));
  GONIO_ASSIGN(const color::Rgb from, illuminant("from", options.from));
  GONIO_ASSIGN(const color::Rgb to, illuminant("to", options.to));
  GONIO_ASSIGN(const color::ReflectionOperator op, operator_of(options));
  auto change = color::relighting(op, from, to);
  if (!change.ok()) return usage_error("--from {}: {}", options.from, change.error().message);
  if (options.common.explain) session.explain(plan_text(options, from, to, *change));

  const std::string path = options.image.empty() ? "-" : options.image.front();
  GONIO_ASSIGN(const image::ImagePart part, image::read_image(path));
  if (!image::text_attribute(part, "goniochrome:texels").empty() && image::text_attribute(part, "envmap").empty())
    return input_error(
        "{}: is a prefiltered environment, of which an image holds one map: relight its source, and filter that", path);
  if (const std::string problem = image::inks_problem(part, path); !problem.empty()) session.warn(problem);
  GONIO_ASSIGN(image::Image image, image::working_space_rgb(part, path));
  GONIO_ASSIGN(const std::size_t negative, relit(image, change->matrix, options.negative == "keep", path));
  const double pixels = static_cast<double>(image.width) * image.height, share = static_cast<double>(negative) / pixels;

  session.results()["condition"] = change->condition;
  session.results()["negative_fraction"] = share;
  session.results()["matrix"] = change->matrix;
  session.results()["operator"] = op.k;
  session.results()["pixels"] = pixels;
  if (negative > 0)
    session.warn(fmt::format("{}: {} pixels of {} have a negative channel, {}", path, negative, pixels,
                             options.negative == "keep" ? "written as it is" : "set to zero"));
  image::ImagePart out{"", std::move(image), {}, image::PixelType::kHalf};
  out.attributes["goniochrome:command"] = session.provenance();
  out.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
  if (const auto envmap = part.attributes.find("envmap"); envmap != part.attributes.end())
    out.attributes["envmap"] = envmap->second;
  GONIO_TRY(image::write_exr(options.output, {out}));
  session.say(fmt::format("{}: {} pixels, condition number {:.3g}, {:.3g} % with a negative channel", session.tool(),
                          pixels, change->condition, 100 * share));
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
