#include "sketch/internal/sketch_samples.h"

#include <array>

#include "sketch/internal/sketch_common.h"
#include "sketch/sketch_picture.h"

namespace goniochrome::sketch {

color::Lab SearchSamples::shown(const color::Rgb& rgb) const {
  return paint_lab(display ? in_display_gamut(rgb) : rgb);
}

color::Rgb shown_light(const Vec3* columns, const std::vector<color::Rgb>& weights,
                       const std::optional<color::ReflectionOperator>& reflection) {
  color::Rgb sum;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * columns[k];
  if (!reflection) return sum;
  std::array<color::Rgb, 3> pairs;  // light of channel d on weights of channel e
  for (std::size_t k = 0; k < weights.size(); ++k)
    for (int d = 0; d < 3; ++d) pairs[d] += columns[k][d] * weights[k];
  sum = {};
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) sum[c] += reflection->k[c][d][e] * pairs[d][e];
  return sum;
}

void differences(const SearchSamples& samples, const std::vector<color::Lab>& target,
                 const std::vector<color::Rgb>& weights, std::vector<double>& out) {
  for (std::size_t i = 0; i < target.size(); ++i) {
    const color::Lab lab = samples.shown(shown_light(samples.columns_of(i), weights, samples.reflection));
    out[3 * i] = lab.L - target[i].L, out[3 * i + 1] = lab.a - target[i].a, out[3 * i + 2] = lab.b - target[i].b;
  }
}

}  // namespace goniochrome::sketch
