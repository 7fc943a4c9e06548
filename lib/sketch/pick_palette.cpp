#include <algorithm>
#include <cmath>
#include <random>

#include "sketch/pick.h"
#include "sketch/sketch_picture.h"

namespace goniochrome::sketch {

namespace {

constexpr std::size_t kMostPixels = 20000;  // looked at
constexpr double kLightnessPart = 0.35;     // of L* against a* and b*: a color's shadow is that color
constexpr double kEnd = 0.15;               // the part of a group's pixels that is its light, and its dark, end
constexpr double kGlint = 0.02;             // the lightest pixels are reflections
constexpr int kRounds = 25;

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
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(count / kMostPixels))));
  image::ImagePart thin{image.name, {}, image.attributes, image.type};
  thin.image.channels = all.channels, thin.image.channel_names = all.channel_names;
  thin.image.width = (all.width + step - 1) / step, thin.image.height = (all.height + step - 1) / step;
  for (int y = 0; y < all.height; y += step)
    for (int x = 0; x < all.width; x += step)
      thin.image.data.insert(thin.image.data.end(), all.pixel(x, y), all.pixel(x, y) + all.channels);
  return thin;
}

// k-means; the first centers are spread by distance, from a fixed seed.
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
  for (int round = 0; round < kRounds; ++round) {
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

}  // namespace

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
    std::stable_sort(members.begin(), members.end(),
                     [](const Pixel* a, const Pixel* b) { return a->lab.L < b->lab.L; });
    pairs.push_back({mean_between(members, 1 - kEnd - kGlint, 1 - kGlint), mean_between(members, 0, kEnd),
                     static_cast<double>(members.size()) / static_cast<double>(pixels.size())});
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  return pairs;
}

}  // namespace goniochrome::sketch
