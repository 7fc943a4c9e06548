#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "sketch/internal/sketch_common.h"
#include "sketch/internal/sketch_search.h"

namespace goniochrome::sketch {

namespace {

constexpr std::size_t kMostPixels = 6000;   // looked at for the answer; more change it by less than 0.05 dE
constexpr std::size_t kFirstPixels = 1000;  // and on the way to it
constexpr std::size_t kFewestPixels = 30;

SearchSamples samples_of(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                         std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, pixels.used.size() / most);
  std::vector<std::uint32_t> places;
  for (std::size_t i = 0; i < pixels.used.size(); i += step) places.push_back(pixels.used[i]);
  SearchSamples samples;
  samples.columns = search_columns(light.basis);
  samples.reflection = light.reflection;
  samples.display = !input.edited->scene_linear;
  samples.light.resize(places.size() * samples.columns);
  samples.importance.assign(places.size(), 1.0);
  parallel_for(places.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) light.shade(places[i], &samples.light[i * samples.columns]);
  });
  const double scale = 1 / input.buffers->white_luminance;
  for (const std::uint32_t place : places) samples.seen.push_back(scale * edited_light(input, place));
  return samples;
}

}  // namespace

SketchFit sketch_environment(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                             const SketchLimits& limits, bool with_differences) {
  const SearchFitters fitters(light.basis);
  const LobeSearch search(fitters, samples_of(input, pixels, light, kMostPixels));
  SketchFit fit;
  std::vector<color::Rgb> weights(search_columns(light.basis));
  const auto judge = [&] {
    std::vector<Vec3> columns(weights.size());
    const double scale = 1 / input.buffers->white_luminance;
    const auto difference = [&](std::size_t i) {
      light.shade(pixels.used[i], columns.data());
      const color::Rgb seen = scale * edited_light(input, pixels.used[i]);
      return color::delta_e_76(paint_lab(seen),
                               paint_lab(as_displayed(shown_light(columns.data(), weights, light.reflection), input)));
    };
    judge_sketch(pixels.used.size(), with_differences, difference, fit);
  };
  const auto give_up = [&](const std::string& reason) {
    const color::Rgb matt = search.matt();
    fall_back(matt, reason, fit);
    weights.assign(weights.size(), color::Rgb{}), weights[0] = (1 / kPi) * matt;
    judge();
    return fit;
  };
  if (pixels.used.size() < kFewestPixels)
    return give_up(fmt::format("{} pixels are too few for a search", pixels.used.size()));
  const LobeSearch first(fitters, samples_of(input, pixels, light, kFirstPixels));
  const FoundPaint found = search.find(first);
  take_found(found, fit);
  weights = found.weights;
  judge();
  if (fit.median_de76 > limits.median_de76) return give_up(poor_match(fit));
  return fit;
}

}  // namespace goniochrome::sketch
