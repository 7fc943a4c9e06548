#include "sketch/pick.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "base/encoding.h"
#include "base/file.h"
#include "base/text.h"
#include "paint/curve.h"
#include "sketch/dropper.h"
#include "sketch/sketch_picture.h"

namespace goniochrome::sketch {

namespace {

constexpr std::size_t kMostPixels = 20000;  // looked at
constexpr double kLightnessPart = 0.35;     // of L* against a* and b*: a color's shadow is that color
constexpr double kEnd = 0.15;               // the part of a group's pixels that is its light, and its dark, end
constexpr double kGlint = 0.02;             // the lightest pixels are reflections
constexpr int kMeanRounds = 25;

// Every step-th pixel of every step-th row from (x0, y0) up to (x1, y1), exclusive.
image::ImagePart piece_of(const image::ImagePart& image, int x0, int y0, int x1, int y1, int step) {
  const image::Image& all = image.image;
  image::ImagePart part{image.name, {}, image.attributes, image.type};
  image::Image& piece = part.image;
  piece.width = (x1 - x0 + step - 1) / step, piece.height = (y1 - y0 + step - 1) / step;
  piece.channels = all.channels, piece.channel_names = all.channel_names;
  for (int y = y0; y < y1; y += step)
    for (int x = x0; x < x1; x += step)
      piece.data.insert(piece.data.end(), all.pixel(x, y), all.pixel(x, y) + all.channels);
  return part;
}

struct Pixel {
  color::Rgb light;
  color::Lab lab;
  int group = 0;
};

double apart(const color::Lab& x, const color::Lab& y) {
  const double l = kLightnessPart * (x.L - y.L);
  return l * l + (x.a - y.a) * (x.a - y.a) + (x.b - y.b) * (x.b - y.b);
}

std::vector<Pixel> pixels_of(const Picture& picture) {
  std::vector<Pixel> pixels;
  const color::Xyz white = *color::white_point({});
  for (std::size_t i = 0; i < picture.state.size(); ++i) {
    if (picture.state[i] == Picture::kTransparent) continue;
    const color::Rgb light{picture.rgb.data[3 * i], picture.rgb.data[3 * i + 1], picture.rgb.data[3 * i + 2]};
    if (std::isfinite(light.x + light.y + light.z)) pixels.push_back({light, color::lab_from_rgb(light, white)});
  }
  return pixels;
}

// Every n-th pixel of every n-th row, so that kMostPixels are not passed by much.
image::ImagePart thinned(const image::ImagePart& image) {
  const image::Image& all = image.image;
  const double count = static_cast<double>(all.width) * all.height;
  return piece_of(image, 0, 0, all.width, all.height,
                  std::max(1, static_cast<int>(std::ceil(std::sqrt(count / kMostPixels)))));
}

// k-means. The first centers are spread by distance, from a fixed seed.
std::vector<color::Lab> centers_of(std::vector<Pixel>& pixels, int count) {
  std::mt19937_64 random(1);
  std::vector<color::Lab> centers = {pixels[pixels.size() / 2].lab};
  std::vector<double> nearest(pixels.size(), 1e300);
  while (static_cast<int>(centers.size()) < count) {
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      nearest[i] = std::min(nearest[i], apart(pixels[i].lab, centers.back())), sum += nearest[i];
    if (sum < 1e-6 * static_cast<double>(pixels.size())) break;
    double place = static_cast<double>(random() >> 11) * 0x1p-53 * sum;
    std::size_t chosen = 0;
    while (chosen + 1 < pixels.size() && (place -= nearest[chosen]) > 0) ++chosen;
    centers.push_back(pixels[chosen].lab);
  }
  for (int round = 0; round < kMeanRounds; ++round) {
    std::vector<color::Lab> sum(centers.size());
    std::vector<double> members(centers.size(), 0);
    for (Pixel& pixel : pixels) {
      for (std::size_t k = 0; k < centers.size(); ++k)
        if (apart(pixel.lab, centers[k]) < apart(pixel.lab, centers[pixel.group])) pixel.group = static_cast<int>(k);
      color::Lab& s = sum[pixel.group];
      s.L += pixel.lab.L, s.a += pixel.lab.a, s.b += pixel.lab.b, ++members[pixel.group];
    }
    for (std::size_t k = 0; k < centers.size(); ++k)
      if (members[k] > 0) centers[k] = {sum[k].L / members[k], sum[k].a / members[k], sum[k].b / members[k]};
  }
  return centers;
}

// The mean light of the members from rank `from` to `to`, 0..1 from the darkest.
color::Lab mean_between(const std::vector<const Pixel*>& sorted, double from, double to) {
  const auto rank = [&](double part) { return static_cast<std::size_t>(part * static_cast<double>(sorted.size())); };
  const std::size_t first = std::min(rank(from), sorted.size() - 1), last = std::max(rank(to), first + 1);
  color::Rgb sum;
  for (std::size_t i = first; i < last; ++i) sum += sorted[i]->light;
  return color::lab_from_rgb((1 / static_cast<double>(last - first)) * sum, *color::white_point({}));
}

// The reflectances of which diffusers show this sum, by Cramer's rule; nothing where they are dark in a channel.
std::optional<color::Rgb> reflectance_of(const color::Rgb& shown, const std::array<color::Rgb, 3>& diffusers) {
  const double determinant = dot(diffusers[0], cross(diffusers[1], diffusers[2]));
  const double scale = length(diffusers[0]) * length(diffusers[1]) * length(diffusers[2]);
  if (!(determinant > 1e-6 * scale) || !(scale > 0)) return std::nullopt;
  return color::Rgb{std::max(0.0, dot(shown, cross(diffusers[1], diffusers[2])) / determinant),
                    std::max(0.0, dot(shown, cross(diffusers[2], diffusers[0])) / determinant),
                    std::max(0.0, dot(shown, cross(diffusers[0], diffusers[1])) / determinant)};
}

// One board as it is read line by line.
class BoardReader {
 public:
  explicit BoardReader(const std::string& path) : path_(path), folder_(std::filesystem::path(path).parent_path()) {}

  Result<Board> read(const std::string& content) {
    for (const std::string_view text : split(content, '\n')) {
      ++line_;
      const std::string_view stated = trimmed(text);
      if (stated.empty() || stated.front() == '#') continue;
      const auto space = stated.find_first_of(" \t");
      const std::string word(stated.substr(0, space));
      const std::string rest(space == std::string_view::npos ? "" : trimmed(stated.substr(space)));
      GONIO_TRY(take(word, rest));
    }
    if (board_.paints.empty())
      return input_error("{}: has no paint: add a line \"paint NAME\" and its droppers", path_);
    for (const PaintPick& paint : board_.paints)
      if (!paint.face && !paint.flop)
        return input_error("{}: the paint {} has neither face nor flop: add a line \"face IMAGE@x,y\"", path_,
                           paint.name);
    return board_;
  }

 private:
  template <class... Args>
  Error error(fmt::format_string<Args...> text, Args&&... args) const {
    return input_error("{}:{}: {}", path_, line_, fmt::format(text, std::forward<Args>(args)...));
  }

  Result<void> take(const std::string& word, const std::string& rest) {
    const bool alone = word == "retro";
    if (alone && !rest.empty()) return error("\"retro\" stands alone");
    if (!alone && rest.empty()) return error("\"{}\" lacks what it says", word);
    if (word == "title") return void(board_.title = rest), Result<void>();
    if (word == "image") return take_image(rest);
    if (word == "paint") return take_paint(rest);
    constexpr const char* kOfPaint[] = {"face", "flop", "gloss", "travel", "retro"};
    if (std::find(std::begin(kOfPaint), std::end(kOfPaint), word) == std::end(kOfPaint))
      return error("\"{}\" is none of title, image, paint, face, flop, gloss, travel, retro", word);
    if (board_.paints.empty()) return error("\"{}\" belongs below a line \"paint NAME\"", word);
    PaintPick& paint = board_.paints.back();
    if (word == "retro") return void(paint.retro = true), Result<void>();
    if (word == "travel") return take_travel(rest, paint);
    return take_dropper(word, rest, word == "face" ? paint.face : word == "flop" ? paint.flop : paint.gloss);
  }

  Result<void> take_image(const std::string& rest) {
    const auto space = rest.find_first_of(" \t");
    if (space == std::string::npos) return error("image is \"{}\": write image NAME PATH", rest);
    const std::string name = rest.substr(0, space);
    if (find_image(name)) return error("there are two images named {}", name);
    const std::filesystem::path file(std::string(trimmed(std::string_view(rest).substr(space))));
    board_.images.push_back({name, file.is_absolute() ? file.string() : (folder_ / file).string()});
    return {};
  }

  Result<void> take_paint(const std::string& name) {
    const bool known =
        std::any_of(board_.paints.begin(), board_.paints.end(), [&](const auto& p) { return p.name == name; });
    if (known) return error("there are two paints named {}", name);
    board_.paints.push_back({});
    board_.paints.back().name = name;
    return {};
  }

  Result<void> take_travel(const std::string& rest, PaintPick& paint) {
    const auto travel = parse_number(rest);
    if (!travel || *travel <= 15 || *travel > 180)
      return error("travel is \"{}\": it lies above 15 and up to 180 degrees", rest);
    paint.travel_deg = *travel;
    return {};
  }

  Result<void> take_dropper(const std::string& word, const std::string& rest, std::optional<Dropper>& to) {
    if (to) return error("the paint {} has two droppers for its {}", board_.paints.back().name, word);
    const auto dropper = parse_dropper(rest, word);
    if (!dropper.ok()) return error("{}", dropper.error().message);
    if (!find_image(dropper->image))
      return error("{} names the image \"{}\", which no line \"image NAME PATH\" above has", word, dropper->image);
    to = *dropper;
    return {};
  }

  bool find_image(const std::string& name) const {
    return std::ranges::any_of(board_.images, [&](const auto& image) { return image.name == name; });
  }

  std::string path_;
  std::filesystem::path folder_;
  int line_ = 0;
  Board board_;
};

}  // namespace

Result<Dropper> parse_dropper(const std::string& text, const std::string& option) {
  const auto error = [&] {
    return usage_error("{} is \"{}\": write IMAGE@X,Y or IMAGE@X,Y,RADIUS, in pixels from the upper left", option,
                       text);
  };
  const auto at = text.rfind('@');
  if (at == std::string::npos || at == 0) return error();
  const auto pieces = split(std::string_view(text).substr(at + 1), ',');
  if (pieces.size() != 2 && pieces.size() != 3) return error();
  const auto x = parse_integer(trimmed(pieces[0])), y = parse_integer(trimmed(pieces[1]));
  const auto radius = pieces.size() == 3 ? parse_number(trimmed(pieces[2])) : std::optional<double>(kPickRadius);
  constexpr std::int64_t kMost = 1 << 20;
  if (!x || !y || !radius || *x < 0 || *y < 0 || *x > kMost || *y > kMost || *radius < 0 || *radius > 4096)
    return error();
  return Dropper{text.substr(0, at), static_cast<int>(*x), static_cast<int>(*y), *radius};
}

Result<PickSample> pick(const image::ImagePart& image, const std::string& path, const Dropper& dropper,
                        const PickLight* light) {
  if (dropper.x >= image.image.width || dropper.y >= image.image.height)
    return input_error("{}: the point {},{} lies outside its {} x {} pixels", path, dropper.x, dropper.y,
                       image.image.width, image.image.height);
  // The part of the image that the disc touches.
  const int reach = static_cast<int>(std::ceil(dropper.radius));
  const int x0 = std::max(0, dropper.x - reach), x1 = std::min(image.image.width, dropper.x + reach + 1);
  const int y0 = std::max(0, dropper.y - reach), y1 = std::min(image.image.height, dropper.y + reach + 1);
  if (light != nullptr &&
      (light->traced->width() != image.image.width || light->traced->height() != image.image.height))
    return input_error("{}: has {} x {} pixels, and the light was traced for {} x {}", path, image.image.width,
                       image.image.height, light->traced->width(), light->traced->height());
  const PictureView view = light != nullptr ? PictureView::kPaint : PictureView::kPlain;
  GONIO_ASSIGN(const Picture picture, picture_of(piece_of(image, x0, y0, x1, y1, 1), path, view));
  PickSample sample{dropper, path, 0, 0, 0, {}, false, 0, picture.warnings};
  std::vector<color::Rgb> lights;
  std::array<color::Rgb, 3> diffusers{};
  for (int y = 0; y < picture.rgb.height; ++y)
    for (int x = 0; x < picture.rgb.width; ++x) {
      if (std::hypot(x0 + x - dropper.x, y0 + y - dropper.y) > dropper.radius) continue;
      const auto state = picture.state[static_cast<std::size_t>(y) * picture.rgb.width + x];
      if (state == Picture::kTransparent) {
        ++sample.transparent;
        continue;
      }
      const float* p = picture.pixel(x, y);
      const color::Rgb shown{p[0], p[1], p[2]};
      if (!std::isfinite(shown.x + shown.y + shown.z)) continue;
      if (light != nullptr) {
        const auto here = light->traced->diffusers(x0 + x, y0 + y);
        if (!here) continue;
        for (std::size_t c = 0; c < 3; ++c) diffusers[c] += (*here)[c];
      }
      sample.clipped += state == Picture::kClipped;
      ++sample.pixels, lights.push_back(shown);
    }
  if (sample.pixels == 0 && light != nullptr)
    return input_error("{}: no light was traced for the pixels about {},{}: put the dropper on the mesh", path,
                       dropper.x, dropper.y);
  if (sample.pixels == 0)
    return input_error("{}: every pixel about {},{} is transparent: move the dropper", path, dropper.x, dropper.y);
  const DropperColor found = dropper_color(lights);
  sample.lab = found.lab, sample.gloss = found.gloss;
  if (light != nullptr) {
    const double gain = picture.scene_linear ? light->gain_linear : light->gain_display;
    const auto explained = reflectance_of(gain * sample.pixels * found.mean, diffusers);
    if (!explained)
      return input_error("{}: the pixels about {},{} get no light: put the dropper elsewhere", path, dropper.x,
                         dropper.y);
    sample.lab = color::lab_from_rgb(*explained, *color::white_point({})), sample.lit = true;
  }
  return sample;
}

PickedPaint picked_paint(const PaintPick& pick, const std::optional<color::Lab>& face,
                         const std::optional<color::Lab>& flop, std::optional<double> gloss) {
  PickedPaint picked;
  paint::Appearance a{face ? *face : *flop, flop ? *flop : *face, pick.travel_deg, std::nullopt};
  if (!pick.retro && a.flop.L > a.face.L) {
    std::swap(a.face, a.flop);
    picked.swapped = true;
  }
  paint::Paint& paint = picked.paint;
  paint.name = pick.name;
  paint.paint_class = face && flop ? paint::PaintClass::kUnknown : paint::PaintClass::kSolid;
  paint.appearance = a;
  paint.measurement = paint::Measurement{{}, "", paint::rows_of(a)};
  if (gloss) paint.gloss.push_back({60, *gloss});
  return picked;
}

Result<std::vector<PalettePair>> palette(const image::ImagePart& image, const std::string& path, int count) {
  GONIO_ASSIGN(const Picture picture, picture_of(thinned(image), path, PictureView::kPlain));
  std::vector<Pixel> pixels = pixels_of(picture);
  if (pixels.empty()) return input_error("{}: every pixel is transparent: there is no color to propose", path);
  const std::size_t groups = centers_of(pixels, count).size();
  std::vector<PalettePair> pairs;
  for (std::size_t k = 0; k < groups; ++k) {
    std::vector<const Pixel*> members;
    for (const Pixel& pixel : pixels)
      if (pixel.group == static_cast<int>(k)) members.push_back(&pixel);
    if (members.empty()) continue;
    std::ranges::stable_sort(members, {}, [](const Pixel* pixel) { return pixel->lab.L; });
    pairs.push_back({mean_between(members, 1 - kEnd - kGlint, 1 - kGlint), mean_between(members, 0, kEnd),
                     static_cast<double>(members.size()) / static_cast<double>(pixels.size())});
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  return pairs;
}

Result<Board> read_board(const std::string& path) {
  GONIO_ASSIGN(const std::string content, file_content(path));
  const std::string text = as_utf8(content);
  return BoardReader(path).read(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text);
}

}  // namespace goniochrome::sketch
