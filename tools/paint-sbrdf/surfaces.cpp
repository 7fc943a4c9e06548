#include "surfaces.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/file.h"
#include "formats/reference.h"
#include "image/color_space.h"
#include "image/surface_file.h"
#include "paint_stream.h"

namespace goniochrome::tool {

namespace {

constexpr double kUsualMirrorExponent = 1000;
// Stands for a surface that is not there.
constexpr const char* kNothing = "none";

struct ReadPaint {
  paint::Paint paint;
  std::string file;
};

enum class Kind { kPaints, kMap, kPicture };

constexpr std::string_view kExrMark = "\x76\x2f\x31\x01";

// By what the file begins with; an EXR file is a map if it has the channels of one.
Result<Kind> kind_of(const std::string& path) {
  if (image::image_file(path) != path) return Kind::kPicture;  // a layer of one
  GONIO_ASSIGN(InputFile file, InputFile::open(path));
  GONIO_ASSIGN(const std::string_view head, file.peek());
  const auto first = head.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (first != std::string_view::npos && head[first] == '<') return Kind::kPaints;
  if (path.ends_with(".sbrdf.exr")) return Kind::kMap;
  if (!head.starts_with(kExrMark)) return Kind::kPicture;
  GONIO_ASSIGN(const std::vector<image::ImagePart> parts, image::read_exr(path));
  const bool is_map = std::ranges::any_of(parts, [](const image::ImagePart& part) {
    return std::ranges::find(part.image.channel_names, "diffuse.R") != part.image.channel_names.end();
  });
  return is_map ? Kind::kMap : Kind::kPicture;
}

Result<void> check_paint(const paint::Paint& paint, const std::string& file, cli::Session& session) {
  if (!paint.lobes)
    return input_error(
        "{}: the paint \"{}\" has no lobes: fit it first, as in `fit-paint {} --basis BASIS.xml -o "
        "FITTED.xml`",
        file, paint.name, file);
  if (paint.anisotropy && paint.anisotropy->alpha_x != paint.anisotropy->alpha_y)
    return input_error(
        "{}: the paint \"{}\" is brushed, and its lobes do not say so: take a map of brushed texels, or "
        "`paint-edit --anisotropy 0,0`",
        file, paint.name);
  if (paint.color_map || !paint.lobes->tilts.empty())
    session.warn(fmt::format("{}: {}: its color map is left out: the map shows its lobes", file, paint.name));
  if (!paint.lobes->views.empty())
    session.warn(fmt::format("{}: {}: the weights for all views together are taken", file, paint.name));
  return {};
}

Result<std::shared_ptr<const image::Image>> read_picture(const std::string& path, cli::Session& session) {
  GONIO_ASSIGN(image::ImagePart part, image::read_image(path));
  GONIO_ASSIGN(image::Image rgb, image::working_space_rgb(std::move(part), path));
  float most = 0;
  for (int row = 0; row < rgb.height; ++row) {
    for (int column = 0; column < rgb.width; ++column) {
      for (int c = 0; c < 3; ++c) {
        float& value = rgb.pixel(column, row)[c];
        if (!std::isfinite(value))
          return input_error("{}: pixel ({},{}) is {}: a reflectance is a finite number", path, column, row, value);
        value = std::max(value, 0.0F), most = std::max(most, value);
      }
    }
  }
  if (most > 1)
    session.warn(
        fmt::format("{}: reflects up to {:.3g}: a surface that makes no light reflects 1 at most", path, most));
  return std::shared_ptr<const image::Image>(std::make_shared<image::Image>(std::move(rgb)));
}

// A paint of a file, of which the lobes are made when the sharpest exponent of all is known.
struct Slot {
  Surface surface;
  std::optional<paint::Paint> paint;
};

Result<void> add_paints(InputFile input, const std::optional<std::string>& names, Surfaces& result,
                        std::vector<Slot>& slots, cli::Session& session) {
  const std::string file = input.name();
  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(std::move(input), std::nullopt));
  GONIO_ASSIGN(const std::vector<paint::Paint> paints, all_paints(*source, session));
  if (paints.empty()) return input_error("{}: holds no paint: name a file that has one", file);
  std::optional<formats::NameChoice> choice;
  if (names) choice.emplace(*names);
  for (const paint::Paint& paint : paints) {
    // The sharpest lobe of a library is the sharpest one for which its cubes were made.
    for (std::size_t i = 0; paint.lobes && i < paint.lobes->lobes.size(); ++i) {
      const double exponent = paint.lobes->lobes[i].exponent;
      if (!paint::is_mirror(exponent)) result.mirror_exponent = std::max(result.mirror_exponent, exponent);
    }
    if (choice && !choice->takes(paint.name)) continue;
    GONIO_TRY(check_paint(paint, file, session));
    if (!result.basis.empty() && result.basis != paint.lobes->basis)
      return input_error(
          "{}: the paint \"{}\" is fitted with the basis {}, but others with {}: fit all with one basis, "
          "so that one prefiltered environment serves the map",
          file, paint.name, paint.lobes->basis, result.basis);
    result.basis = paint.lobes->basis;
    slots.push_back({{paint.name, "paint", {}, nullptr, nullptr, 0}, paint});
  }
  if (choice) GONIO_TRY(choice->check_all_met(file));
  return {};
}

double gloss_angle(const paint::Paint& paint) {
  return paint.gloss.empty() ? 45 : paint.gloss.front().angle_deg;
}

}  // namespace

brdf::LobeSurface Surface::texel(int column, int row) const {
  if (map) return brdf::lobe_surface(*map, column, row);
  if (!picture) return paint;
  const float* rgb = picture->pixel(column, row);
  return {(1 / kPi) * color::Rgb{rgb[0], rgb[1], rgb[2]}, {}};
}

Vec3 Surface::normal(int column, int row) const {
  if (!map) return {0, 0, 1};
  return map->normal(static_cast<std::size_t>(row) * static_cast<std::size_t>(map->width) +
                     static_cast<std::size_t>(column));
}

double Surface::alpha(int column, int row) const {
  if (kind == "nothing") return 0;
  if (!map || map->alpha.empty()) return 1;
  return map
      ->alpha[static_cast<std::size_t>(row) * static_cast<std::size_t>(map->width) + static_cast<std::size_t>(column)];
}

Result<Surfaces> read_surfaces(const Options& options, cli::Session& session) {
  Surfaces result;
  std::vector<Slot> slots;
  for (const std::string& input : options.inputs) {
    if (input == kNothing) {
      slots.push_back({{kNothing, "nothing", {}, nullptr, nullptr, 0}, {}});
      continue;
    }
    const auto [file, names] = formats::paint_reference(input);
    Kind kind = Kind::kPaints;
    if (file != "-") {
      GONIO_ASSIGN(kind, kind_of(file));
    }
    if (kind == Kind::kPicture) {
      GONIO_ASSIGN(auto picture, read_picture(file, session));
      slots.push_back({{file, "picture", {}, nullptr, std::move(picture), 0}, {}});
      continue;
    }
    GONIO_ASSIGN(InputFile opened, InputFile::open(file));
    if (file == "-") {
      GONIO_ASSIGN(const std::string_view head, opened.peek());
      if (head.starts_with(kExrMark)) kind = Kind::kMap;
    }
    if (kind == Kind::kPaints) {
      GONIO_TRY(add_paints(std::move(opened), names, result, slots, session));
    } else {
      GONIO_ASSIGN(brdf::SbrdfTexture map, image::read_sbrdf(std::move(opened)));
      slots.push_back({{file, "map", {}, std::make_shared<brdf::SbrdfTexture>(std::move(map)), nullptr, 0}, {}});
    }
  }
  if (options.mirror > 0) result.mirror_exponent = options.mirror;
  if (result.mirror_exponent == 0) result.mirror_exponent = kUsualMirrorExponent;
  for (Slot& slot : slots) {
    if (slot.paint) {
      const brdf::PaintedSurface painted =
          brdf::painted_surface(*slot.paint->lobes, gloss_angle(*slot.paint), result.mirror_exponent);
      slot.surface.paint = painted.surface, slot.surface.strength_error = painted.mirror_error;
    }
    result.all.push_back(std::move(slot.surface));
  }
  return result;
}

}  // namespace goniochrome::tool
