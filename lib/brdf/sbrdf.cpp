#include "brdf/sbrdf.h"

#include <algorithm>
#include <cmath>

namespace goniochrome {

SbrdfTexel sbrdf_texel(const SbrdfTexture& texture, int column, int row) {
  const float* at = texture.texel(column, row);
  SbrdfTexel texel;
  texel.surface.diffuse = {at[0], at[1], at[2]};
  // The half of an angle -180..180 deg lies at -90..90: its cosine is not negative, its sine has the sign of the whole.
  const double size = std::hypot(at[3], at[4]), cosine = size > 0 ? at[3] / size : 1;
  texel.x_tangent = std::sqrt(std::max(0.5 * (1 + cosine), 0.0));
  texel.x_bitangent = std::copysign(std::sqrt(std::max(0.5 * (1 - cosine), 0.0)), at[4]);
  texel.surface.lobes.reserve(static_cast<std::size_t>(texture.lobes));
  for (int lobe = 0; lobe < texture.lobes; ++lobe) {
    const float* l = at + 5 + 7 * lobe;
    texel.surface.lobes.push_back({{l[0], l[1], l[2]}, {l[3], l[4], l[5]}, l[6]});
  }
  return texel;
}

namespace {

int wrapped(double index, int n) {
  const double rest = std::fmod(index, n);
  return static_cast<int>(rest < 0 ? rest + n : rest) % n;
}

}  // namespace

std::array<TextureTap, 4> texture_taps(int width, int height, double u, double v) {
  const double x = u * width - 0.5, y = (1 - v) * height - 0.5;
  const double left = std::floor(x), top = std::floor(y), s = x - left, t = y - top;
  const int x0 = wrapped(left, width), x1 = wrapped(left + 1, width);
  const int y0 = wrapped(top, height), y1 = wrapped(top + 1, height);
  return {{{x0, y0, (1 - s) * (1 - t)}, {x1, y0, s * (1 - t)}, {x0, y1, (1 - s) * t}, {x1, y1, s * t}}};
}

}  // namespace goniochrome
