#include "sketch/sketch_pixels.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "display/paint_view.h"

namespace goniochrome::sketch {

namespace {

constexpr double kCrease_deg = 8;             // neighbors whose aspecular angles differ more lie on two surfaces
constexpr double kLeastChangedShare = 0.005;  // fewer changed pixels are noise
// If more are touched, the whole paint is meant, unless so many are as they were and most of those touched are edited:
// compression and noise touch far more pixels than they edit, and a new paint leaves few as they were.
constexpr double kRepaintedShare = 0.5, kKeptShare = 0.1, kPlainlyEdited = 0.8;
constexpr std::size_t kPixelRows = 16;

// Where the buffers stand in a pixel.
struct Channels {
  int mask = 0, part = 0, aspecular = 0, lambert = 0, alpha = 0;
};

Result<Channels> channels_of(const image::AovFile& file) {
  Channels at;
  GONIO_ASSIGN(at.mask, file.channel("mask"));
  GONIO_ASSIGN(at.part, file.channel("part"));
  GONIO_ASSIGN(at.aspecular, file.channel("aspecular"));
  GONIO_ASSIGN(at.lambert, file.channel("lambert"));
  GONIO_ASSIGN(at.alpha, file.channel("A"));
  return at;
}

Result<void> check_sizes(const SketchInput& input) {
  const image::Image &buffers = input.buffers->image, &edited = input.edited->rgb;
  if (edited.width != buffers.width || edited.height != buffers.height)
    return input_error(
        "the picture is {} x {} pixels and the buffers of {} are {} x {}: bring both to one size, or "
        "register the picture",
        edited.width, edited.height, input.buffers->path, buffers.width, buffers.height);
  if (input.mask && (input.mask->width != buffers.width || input.mask->height != buffers.height))
    return input_error("the mask is {} x {} pixels and the buffers of {} are {} x {}: bring both to one size",
                       input.mask->width, input.mask->height, input.buffers->path, buffers.width, buffers.height);
  return {};
}

enum Change : std::uint8_t { kSame, kTouched, kEdited };

class Sorter {
 public:
  Sorter(const SketchInput& input, const Channels& at)
      : input_(input),
        image_(input.buffers->image),
        at_(at),
        original_gain_(std::exp2(-input.buffers->exposure_stops)) {
    for (const int part : input.parts) {
      if (wanted_.size() <= static_cast<std::size_t>(part)) wanted_.resize(part + 1, false);
      wanted_[part] = true;
    }
  }

  PixelUse use(int x, int y) const {
    const float* pixel = image_.pixel(x, y);
    if (pixel[at_.mask] < 0.5F) return PixelUse::kBackground;
    const auto part = static_cast<std::size_t>(std::lround(std::max(pixel[at_.part], 0.0F)));
    if (!wanted_.empty() && (part >= wanted_.size() || !wanted_[part])) return PixelUse::kOtherPart;
    if (input_.mask && !(*input_.mask->pixel(x, y) > 0.5F)) return PixelUse::kMasked;
    const int ex = x + input_.shift_x, ey = y + input_.shift_y;
    if (ex < 0 || ey < 0 || ex >= image_.width || ey >= image_.height) return PixelUse::kEdge;
    if (pixel[at_.alpha] < 0.999F || is_edge(x, y, pixel)) return PixelUse::kEdge;
    const auto state = input_.edited->state[static_cast<std::size_t>(ey) * image_.width + ex];
    if (state == Picture::kTransparent) return PixelUse::kTransparent;
    if (pixel[at_.lambert] < input_.least_cosine) return PixelUse::kGrazing;
    if (pixel[at_.aspecular] < input_.glare_deg) return PixelUse::kGlare;
    if (state == Picture::kClipped) return PixelUse::kClipped;
    return PixelUse::kUsed;
  }

  // How much an edit of the buffers' own picture, or of the shaded one, shows: kEdited above five codes of an 8-bit
  // display, about two units of lightness, kTouched where it is more than rounding.
  Change change(int x, int y, bool of_shaded) const {
    const float* pixel = of_shaded ? input_.shaded->pixel(x, y) : image_.pixel(x, y);
    const float* edited = input_.edited->pixel(x + input_.shift_x, y + input_.shift_y);
    color::Rgb was = (of_shaded ? 1 : original_gain_) * color::Rgb{pixel[0], pixel[1], pixel[2]};
    if (!input_.edited->scene_linear) was = display::in_display_gamut(was);
    const double scale = 1 / input_.buffers->white_luminance;
    was = scale * was;
    const color::Rgb is = (scale * input_.gain) * color::Rgb{edited[0], edited[1], edited[2]};
    const double brightest = std::max({was.x, was.y, was.z, is.x, is.y, is.z});
    double most = 0;
    for (int c = 0; c < 3; ++c)
      most = std::max(most, std::abs(is[c] - was[c]) / display::code_width(std::max(was[c], is[c]), brightest));
    const double touched = input_.edited->scene_linear ? 0.01 : 0.3;  // floats come back as they were
    return most > 1 ? kEdited : most > touched ? kTouched : kSame;
  }

 private:
  bool is_edge(int x, int y, const float* pixel) const {
    if (x == 0 || y == 0 || x + 1 == image_.width || y + 1 == image_.height) return true;
    const float* const around[] = {image_.pixel(x - 1, y), image_.pixel(x + 1, y), image_.pixel(x, y - 1),
                                   image_.pixel(x, y + 1)};
    return std::any_of(std::begin(around), std::end(around), [&](const float* other) {
      return other[at_.part] != pixel[at_.part] || std::abs(other[at_.aspecular] - pixel[at_.aspecular]) > kCrease_deg;
    });
  }

  const SketchInput& input_;
  const image::Image& image_;
  const Channels at_;
  const double original_gain_;
  std::vector<bool> wanted_;
};

template <class Function>
void for_places(const image::Image& image, Function&& function) {
  parallel_for(static_cast<std::size_t>(image.height), kPixelRows, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < image.width; ++x) function(x, y, static_cast<std::size_t>(y) * image.width + x);
  });
}

bool could_be_used(PixelUse use) {
  return use == PixelUse::kUsed || use == PixelUse::kGlare;
}

// The change of every pixel that could be used, and how many of those used were touched and edited.
struct Changes {
  std::vector<std::uint8_t> of;
  std::size_t touched = 0, edited = 0;
};

// An edit covers areas; compression and noise scatter. A pixel stays changed where most of the nine around it are.
void drop_scattered(const image::Image& image, std::vector<std::uint8_t>& changed) {
  const std::vector<std::uint8_t> was = changed;
  const std::size_t width = static_cast<std::size_t>(image.width);
  parallel_for(static_cast<std::size_t>(image.height), kPixelRows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (std::size_t x = 0; x < width; ++x) {
        if (was[y * width + x] != kEdited) continue;
        if (y == 0 || x == 0 || y + 1 == static_cast<std::size_t>(image.height) || x + 1 == width) continue;
        int count = 0;
        for (const std::size_t row : {(y - 1) * width, y * width, (y + 1) * width})
          for (std::size_t column = x - 1; column <= x + 1; ++column) count += was[row + column] == kEdited;
        if (count < 5) changed[y * width + x] = kTouched;
      }
  });
}

Changes changes(const Sorter& sorter, const image::Image& image, const std::vector<PixelUse>& use, bool of_shaded) {
  Changes result;
  result.of.resize(use.size(), kSame);
  for_places(image, [&](int x, int y, std::size_t i) {
    if (could_be_used(use[i])) result.of[i] = sorter.change(x, y, of_shaded);
  });
  drop_scattered(image, result.of);
  for (std::size_t i = 0; i < use.size(); ++i)
    if (use[i] == PixelUse::kUsed) result.edited += result.of[i] == kEdited, result.touched += result.of[i] != kSame;
  return result;
}

constexpr int kShiftReach = 8;            // pixels
constexpr std::size_t kMostEdges = 8000;  // looked at
constexpr double kBetter = 1.1;           // than no shift; else none is suggested

// How strong the edge at a pixel is: the larger difference of the square roots of luminance to its neighbors. It counts
// at most 0.3, so that one glaring edge does not outvote all others.
template <class Luminance>
float edge(const Luminance& luminance, int x, int y) {
  const float here = luminance(x, y);
  return std::min(0.3F, std::max(std::abs(luminance(x + 1, y) - here), std::abs(luminance(x, y + 1) - here)));
}

struct Edge {
  float strength;
  int x, y;
};

}  // namespace

const char* pixel_use_name(PixelUse use) {
  constexpr const char* kNames[] = {"used",        "background", "other_part", "masked", "edge",
                                    "transparent", "clipped",    "grazing",    "glare",  "unchanged"};
  return kNames[static_cast<int>(use)];
}

Result<SketchPixels> sketch_pixels(const SketchInput& input) {
  GONIO_TRY(check_sizes(input));
  GONIO_ASSIGN(const Channels at, channels_of(*input.buffers));
  const image::Image& image = input.buffers->image;
  const Sorter sorter(input, at);
  SketchPixels pixels;
  pixels.use.resize(static_cast<std::size_t>(image.width) * image.height);
  for_places(image, [&](int x, int y, std::size_t i) { pixels.use[i] = sorter.use(x, y); });
  const auto usable = static_cast<std::size_t>(std::ranges::count(pixels.use, PixelUse::kUsed));
  Changes changed;
  if (input.rule != PixelRule::kAll) {
    changed = changes(sorter, image, pixels.use, false);
    if (input.shaded != nullptr)
      if (Changes other = changes(sorter, image, pixels.use, true); other.touched < changed.touched)
        changed = std::move(other), pixels.from_shaded = true;
  }
  pixels.changed = changed.edited;
  const auto share = [&](std::size_t count) {
    return usable > 0 ? static_cast<double>(count) / static_cast<double>(usable) : 0;
  };
  const bool kept = 1 - share(changed.touched) >= kKeptShare &&
                    static_cast<double>(changed.edited) >= kPlainlyEdited * static_cast<double>(changed.touched);
  const bool partly = share(changed.edited) >= kLeastChangedShare && (share(changed.touched) < kRepaintedShare || kept);
  pixels.changed_only = input.rule == PixelRule::kChanged || (input.rule == PixelRule::kAuto && partly);
  for (std::size_t i = 0; i < pixels.use.size(); ++i) {
    PixelUse& use = pixels.use[i];
    if (could_be_used(use) && pixels.changed_only && changed.of[i] != kEdited) use = PixelUse::kUnchanged;
    if (use == PixelUse::kUsed) pixels.used.push_back(static_cast<std::uint32_t>(i));
    if (use == PixelUse::kGlare) pixels.glare.push_back(static_cast<std::uint32_t>(i));
    ++pixels.count[static_cast<std::size_t>(use)];
  }
  return pixels;
}

color::Rgb edited_light(const SketchInput& input, std::uint32_t place) {
  const int width = input.buffers->image.width;
  const int x = static_cast<int>(place % width) + input.shift_x, y = static_cast<int>(place / width) + input.shift_y;
  const float* pixel = input.edited->pixel(x, y);
  return {input.gain * pixel[0], input.gain * pixel[1], input.gain * pixel[2]};
}

// Shifts the strongest edges of the original over the edited picture, and adds up how strong its edges are there.
SketchShift sketch_shift(const SketchInput& input) {
  const image::Image &buffers = input.buffers->image, &edited = input.edited->rgb;
  const double white = input.buffers->white_luminance;
  const double gain_was = std::exp2(-input.buffers->exposure_stops) / white, gain_is = input.gain / white;
  const auto root = [](const float* p, double gain) {
    return std::sqrt(static_cast<float>(gain) * std::max(0.0F, 0.26F * p[0] + 0.68F * p[1] + 0.06F * p[2]));
  };
  const auto was = [&](int x, int y) { return root(buffers.pixel(x, y), gain_was); };
  const auto is = [&](int x, int y) { return root(edited.pixel(x, y), gain_is); };
  std::vector<Edge> edges;
  const int border = kShiftReach + 1;
  for (int y = border; y < buffers.height - border; y += 2)
    for (int x = border + (y & 2) / 2; x < buffers.width - border; x += 2)
      if (const float strength = edge(was, x, y); strength > 0.03F) edges.push_back({strength, x, y});
  if (edges.size() > kMostEdges) {
    std::nth_element(edges.begin(), edges.begin() + kMostEdges, edges.end(),
                     [](const Edge& a, const Edge& b) { return a.strength > b.strength; });
    edges.resize(kMostEdges);
  }
  constexpr int kSide = 2 * kShiftReach + 1;
  std::vector<double> agreement(kSide * kSide, 0);
  parallel_for(agreement.size(), kSide, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int dx = static_cast<int>(i % kSide) - kShiftReach, dy = static_cast<int>(i / kSide) - kShiftReach;
      for (const Edge& e : edges) agreement[i] += e.strength * edge(is, e.x + dx, e.y + dy);
    }
  });
  SketchShift best;
  double most = kBetter * agreement[kShiftReach * kSide + kShiftReach];
  for (int i = 0; i < kSide * kSide; ++i)
    if (agreement[i] > most) most = agreement[i], best = {i % kSide - kShiftReach, i / kSide - kShiftReach};
  return best;
}

}  // namespace goniochrome::sketch
