// From image files to an Environment: the layout by its shape, the faces turned to OpenGL's, bad texels found.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "base/paths.h"
#include "base/text.h"
#include "envmap/environment.h"
#include "envmap/internal/mirror_ball.h"
#include "image/color_space.h"

namespace goniochrome::envmap {

namespace {

using BadPixels = Environment::BadPixels;
using Counts = Environment::Counts;

// Inks on paper reflect light and send none, so that no environment is printed.
Result<void> check_inks(const image::ImagePart& part, const std::string& name) {
  if (const std::string problem = image::inks_problem(part, name); !problem.empty()) return input_error("{}", problem);
  return {};
}

// Finds texels that are not finite or are negative in the first three channels, as stored. Error: the first by name.
Result<Counts> checked(image::Image& image, BadPixels bad_pixels, const std::string& name) {
  Counts counts;
  const int channels = std::min(image.channels, 3);
  const std::size_t texels = static_cast<std::size_t>(image.width) * image.height;
  for (std::size_t i = 0; i < texels; ++i) {
    float* texel = &image.data[i * image.channels];
    bool bad = false;
    for (int c = 0; c < channels && !bad; ++c) {
      const float value = texel[c];
      if (value >= 0 && std::isfinite(value)) continue;
      bad = true;
      if (bad_pixels == BadPixels::kError)
        return input_error(
            "{}: texel {},{} channel {} is {}: repair the image, or zero such texels with prefilter-envmap "
            "--bad-pixels zero",
            name, i % image.width, i / image.width, "RGB"[c], value);
      ++(std::isnan(value) ? counts.nan : std::isinf(value) ? counts.infinite : counts.negative);
    }
    if (bad) std::fill(texel, texel + channels, 0.0F);
  }
  return counts;
}

// A wider gamut than Rec.2020 leaves negative values there.
int clip_to_gamut(image::Image& rgb) {
  int clipped = 0;
  for (std::size_t i = 0; i < rgb.data.size(); i += 3) {
    bool outside = false;
    for (std::size_t c = i; c < i + 3; ++c)
      if (rgb.data[c] < 0) rgb.data[c] = 0, outside = true;
    clipped += outside;
  }
  return clipped;
}

// Copies the n x n block at (x,y), mirrored or turned as wanted, to a face of a strip.
struct Placement {
  int x = 0, y = 0;
  bool flip_columns = false, flip_rows = false;
};
image::Image strip_of(const image::Image& image, int n, const std::array<Placement, 6>& faces) {
  image::Image strip = image::even_image(n, 6 * n, 3);
  for (int f = 0; f < 6; ++f)
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const Placement& p = faces[f];
        const float* from =
            image.pixel(p.x + (p.flip_columns ? n - 1 - column : column), p.y + (p.flip_rows ? n - 1 - row : row));
        std::copy(from, from + 3, strip.pixel(column, f * n + row));
      }
  return strip;
}

std::array<Placement, 6> placements(int n, const std::array<std::array<int, 2>, 6>& cells) {
  std::array<Placement, 6> faces;
  for (int f = 0; f < 6; ++f) faces[f] = {cells[f][0] * n, cells[f][1] * n, false, false};
  return faces;
}

// OpenEXR's faces are OpenGL's seen from the other side: X and Z mirrored left to right, Y top to bottom.
std::array<Placement, 6> openexr_placements(int n) {
  std::array<Placement, 6> faces;
  for (int f = 0; f < 6; ++f) faces[f] = {0, f * n, f / 2 != 1, f / 2 == 1};
  return faces;
}

// The disc of an angular probe alone: what lies beyond the rim sees nothing.
image::Image without_corners(image::Image square) {
  const SphereGrid grid(SphereGrid::Layout::kAngular, square.width, square.height);
  for (int row = 0; row < square.height; ++row)
    for (int column = 0; column < square.width; ++column)
      if (grid.solid_angle(column, row) == 0) std::fill_n(square.pixel(column, row), 3, 0.0F);
  return square;
}

// The maps of a prefiltered environment, which are cubes, are means of its light, and filtering these again would blur
// it twice. Maps in a layout for other programs, which the attribute envmap or their shape tells, are images as those
// of others are.
Result<void> check_not_prefiltered(const image::ImagePart& part, const std::string& name) {
  const bool is_cube = part.image.height == 6 * part.image.width;
  if (!is_cube || text_attribute(part, "goniochrome:texels").empty() || !text_attribute(part, "envmap").empty())
    return {};
  const std::string source = text_attribute(part, "goniochrome:source");
  return input_error("{}: is prefiltered already: give the image that it was made from{}", name,
                     source.empty() ? "" : ", " + source);
}

// Error: the header of a Radiance picture states another view than the whole sphere as an angular probe. A header that
// states none may be that of any layout. [Ward, Radiance: rpict(1), options -vt, -vh and -vv]
Result<void> check_view(const image::ImagePart& part, const std::string& name) {
  const std::string view = text_attribute(part, "radiance:VIEW");
  char type = 'v';
  double across = 45, up = 45;
  const std::vector<std::string_view> words = split(view, ' ');
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].size() == 4 && words[i].starts_with("-vt")) type = words[i][3];
    if (i + 1 == words.size()) break;
    if (words[i] == "-vh") across = parse_number(words[i + 1]).value_or(0);
    if (words[i] == "-vv") up = parse_number(words[i + 1]).value_or(0);
  }
  const bool angular = type == 'a' && across == 360 && up == 360;
  if (view.empty() || (angular && part.image.width == part.image.height)) return {};
  return input_error(
      "{}: its header says VIEW= {}, which is no view of the whole sphere that is read: make it a lat-long map, or an "
      "angular one by -vta -vh 360 -vv 360, or remove that line where it is wrong",
      name, shown(view));
}

}  // namespace

class EnvironmentReader {
 public:
  static Environment make(Environment::Layout layout, image::Image rgb, const Counts& counts, const std::string& name) {
    Environment env;
    env.grid_ = SphereGrid(layout, rgb.width, rgb.height);
    env.rgb_ = std::move(rgb.data);
    env.source_ = name;
    env.replaced_ = counts;
    return env;
  }

  static Result<Environment> from_part(image::ImagePart part, BadPixels bad_pixels, const std::string& name) {
    GONIO_TRY(check_not_prefiltered(part, name));
    GONIO_TRY(check_view(part, name));
    const std::string envmap = text_attribute(part, "envmap");
    GONIO_ASSIGN(Picture picture, picture_of(std::move(part), bad_pixels, name));
    return arranged(std::move(picture.rgb), envmap, picture.counts, name);
  }

  static Result<Environment> from_ball(image::ImagePart part, const std::optional<BallDisc>& outline,
                                       BadPixels bad_pixels, const std::string& name) {
    GONIO_ASSIGN(const Picture picture, picture_of(std::move(part), bad_pixels, name));
    BallDisc disc = outline.value_or(BallDisc{});
    if (!outline) {
      GONIO_ASSIGN(disc, ball_disc(picture.rgb, name));
    }
    GONIO_ASSIGN(image::Image map, unrolled_ball(picture.rgb, disc, name));
    Environment env = make(Environment::Layout::kLatLong, std::move(map), picture.counts, name);
    env.ball_ = disc;
    return env;
  }

 private:
  // An image in the working space, and the texels that were replaced in it.
  struct Picture {
    image::Image rgb;
    Counts counts;
  };
  static Result<Picture> picture_of(image::ImagePart part, BadPixels bad_pixels, const std::string& name) {
    GONIO_TRY(check_inks(part, name));
    Picture picture;
    GONIO_ASSIGN(picture.counts, checked(part.image, bad_pixels, name));
    GONIO_ASSIGN(picture.rgb, image::working_space_rgb(std::move(part), name));
    picture.counts.out_of_gamut = clip_to_gamut(picture.rgb);
    return picture;
  }

  static Result<Environment> arranged(image::Image rgb, const std::string& envmap, const Counts& counts,
                                      const std::string& name) {
    using Layout = Environment::Layout;
    const int w = rgb.width, h = rgb.height;
    const auto cube = [&](int n, const std::array<std::array<int, 2>, 6>& cells) {
      return make(Layout::kCube, strip_of(rgb, n, placements(n, cells)), counts, name);
    };
    if (envmap == "cube") {
      if (h != 6 * w || w < 2)
        return input_error(
            "{}: is tagged as an OpenEXR cube but is {} x {}: six square faces of at least 2 x 2 are wanted", name, w,
            h);
      return make(Layout::kCubeEdges, strip_of(rgb, w, openexr_placements(w)), counts, name);
    }
    if (w >= 2 && std::abs(w - 2 * h) <= 1) return make(Layout::kLatLong, std::move(rgb), counts, name);
    if (envmap == "latlong")
      return input_error("{}: is tagged as lat-long but is {} x {}: it must be twice as wide as high", name, w, h);
    if (w == h && w >= 2) {
      const bool lit = has_lit_corners(rgb);
      Environment env = make(Layout::kAngular, without_corners(std::move(rgb)), counts, name);
      env.lit_corners_ = lit;
      return env;
    }
    if (h == 6 * w) return make(Layout::kCube, std::move(rgb), counts, name);
    if (w == 6 * h) return cube(h, {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}});
    // Crosses: the faces unfolded around +Z, as OpenGL addresses them; the upright cross has -Z below, upside down.
    if (3 * w == 4 * h) return cube(w / 4, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}});
    if (4 * w == 3 * h) {
      const int n = w / 3;
      auto faces = placements(n, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}}});
      faces[5].flip_columns = faces[5].flip_rows = true;
      return make(Layout::kCube, strip_of(rgb, n, faces), counts, name);
    }
    return input_error(
        "{}: {} x {} is no known shape: a lat-long map is 2:1, an angular probe 1:1, a cube 1:6, 6:1, 4:3 or 3:4, or "
        "six square files",
        name, w, h);
  }
};

Result<Environment> Environment::read(const std::string& path, BadPixels bad_pixels) {
  if (path.find("{face}") != std::string::npos) {
    GONIO_ASSIGN(const auto paths, face_paths(path));
    GONIO_ASSIGN(Environment env, read_faces(paths, bad_pixels));
    env.source_ = path;
    return env;
  }
  GONIO_ASSIGN(image::ImagePart part, image::read_image(path));
  return EnvironmentReader::from_part(std::move(part), bad_pixels, path == "-" ? "standard input" : path);
}

Result<Environment> Environment::read_ball(const std::string& path, const std::optional<BallDisc>& outline,
                                           BadPixels bad_pixels) {
  GONIO_ASSIGN(image::ImagePart part, image::read_image(path));
  return EnvironmentReader::from_ball(std::move(part), outline, bad_pixels, path == "-" ? "standard input" : path);
}

Result<Environment> Environment::read_faces(const std::vector<std::string>& paths, BadPixels bad_pixels) {
  if (paths.size() != 6)
    return usage_error("{} files were given: a cube takes six, +X -X +Y -Y +Z -Z; another map is one file",
                       paths.size());
  image::Image strip;
  Counts counts;
  for (int face = 0; face < 6; ++face) {
    const std::string& path = paths[face];
    GONIO_ASSIGN(image::ImagePart part, image::read_image(path));
    GONIO_TRY(check_inks(part, path));
    GONIO_ASSIGN(const Counts bad, checked(part.image, bad_pixels, path));
    GONIO_ASSIGN(const image::Image rgb, image::working_space_rgb(std::move(part), path));
    const int n = rgb.width;
    if (face == 0) strip = {n, 6 * n, 3, {}, {}};
    if (rgb.height != n || n != strip.width)
      return input_error("{}: is {} x {}: every face of this cube must be {} x {}", path, n, rgb.height, strip.width,
                         strip.width);
    strip.data.insert(strip.data.end(), rgb.data.begin(), rgb.data.end());
    counts.nan += bad.nan, counts.infinite += bad.infinite, counts.negative += bad.negative;
  }
  counts.out_of_gamut = clip_to_gamut(strip);
  return EnvironmentReader::make(Layout::kCube, std::move(strip), counts, paths.front());
}

Result<Environment> Environment::from_lat_long(image::Image rgb, BadPixels bad_pixels, const std::string& name) {
  GONIO_ASSIGN(const Counts counts, checked(rgb, bad_pixels, name));
  if (rgb.channels != 3 || rgb.width < 2 || std::abs(rgb.width - 2 * rgb.height) > 1)
    return input_error("{}: {} x {} is no lat-long map: it must be twice as wide as high", name, rgb.width, rgb.height);
  return EnvironmentReader::make(Layout::kLatLong, std::move(rgb), counts, name);
}

Result<Environment> Environment::from_angular(image::Image rgb, BadPixels bad_pixels, const std::string& name) {
  GONIO_ASSIGN(const Counts counts, checked(rgb, bad_pixels, name));
  if (rgb.channels != 3 || rgb.width < 2 || rgb.width != rgb.height)
    return input_error("{}: {} x {} is no angular probe: it must be square", name, rgb.width, rgb.height);
  return EnvironmentReader::make(Layout::kAngular, without_corners(std::move(rgb)), counts, name);
}

Environment Environment::from_cube(const CubeMap& map, const std::string& name) {
  return EnvironmentReader::make(Layout::kCube, {map.size, 6 * map.size, 3, map.texels, {}}, {}, name);
}

Result<Environment> Environment::from_cube_edges(image::Image strip, BadPixels bad_pixels, const std::string& name) {
  GONIO_ASSIGN(const Counts counts, checked(strip, bad_pixels, name));
  if (strip.channels != 3 || strip.height != 6 * strip.width || strip.width < 2)
    return input_error("{}: {} x {} is no strip of six faces of at least 2 x 2", name, strip.width, strip.height);
  return EnvironmentReader::make(Layout::kCubeEdges, std::move(strip), counts, name);
}

Result<std::vector<std::string>> face_paths(const std::string& pattern) {
  constexpr std::array<std::array<const char*, 6>, 5> kSpellings = {
      {{"px", "nx", "py", "ny", "pz", "nz"},
       {"posx", "negx", "posy", "negy", "posz", "negz"},
       {"right", "left", "top", "bottom", "front", "back"},
       {"+x", "-x", "+y", "-y", "+z", "-z"},
       {"0", "1", "2", "3", "4", "5"}}};
  const std::size_t at = pattern.find("{face}");
  const auto filled = [&](const char* face) { return std::string(pattern).replace(at, 6, face); };
  std::string tried;
  for (const auto& spelling : kSpellings) {
    if (!is_there(filled(spelling[0]))) {
      tried += (tried.empty() ? "" : ", ") + filled(spelling[0]);
      continue;
    }
    std::vector<std::string> paths;
    for (const char* face : spelling) paths.push_back(filled(face));
    return paths;
  }
  return input_error("{}: none of {} exists", pattern, tried);
}

}  // namespace goniochrome::envmap
