#include "envmap/internal/weighted_diffuse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace goniochrome::envmap {

namespace {

constexpr int kGrid = 16;
constexpr double kSharpEnough = 50;  // exponent of a lobe that stands for the environment
constexpr int kSteps = 512;          // of the table of the share, in the cosine

// Light of one texel of the grid as a beam from the mean direction of its light.
struct Beam {
  Vec3 direction;
  std::array<float, 3> flux;
};

std::vector<Beam> beams_of(const CubeMap& map) {
  const int n = map.size, grid = std::min(n, kGrid);
  std::vector<Vec3> flux(static_cast<std::size_t>(6 * grid * grid)), moment(flux.size());
  // Faces are alike, so that the areas of one are those of all.
  std::vector<double> areas(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  parallel_for(static_cast<std::size_t>(n), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int column = 0; column < n; ++column) {
        const double s = 2.0 / n, y = s * static_cast<double>(row) - 1;
        areas[row * static_cast<std::size_t>(n) + static_cast<std::size_t>(column)] =
            cube_cell_solid_angle(s * column - 1, s * (column + 1) - 1, y, s * static_cast<double>(row + 1) - 1);
      }
  });
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const double area = areas[static_cast<std::size_t>(row * n + column)];
        const Vec3 light = area * vec3(map.at(face, row, column));
        const auto into = static_cast<std::size_t>((face * grid + row * grid / n) * grid + column * grid / n);
        flux[into] += light;
        moment[into] += (light.x + light.y + light.z) * cube_direction(face, column + 0.5, row + 0.5, n);
      }
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < flux.size(); ++i) {
    if (!(length(moment[i]) > 0)) continue;
    beams.push_back({normalized(moment[i]), floats(flux[i])});
  }
  return beams;
}

// T(c) c at even steps of c, over its integral relative to that of c.
std::vector<float> weighted_cosines(const std::function<double(double)>& share) {
  std::vector<float> table(kSteps + 2);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    sum += 2 * c * share(c) / kSteps;
  }
  for (int i = 0; i <= kSteps + 1; ++i) {
    const double c = std::min(1.0, static_cast<double>(i) / kSteps);
    table[static_cast<std::size_t>(i)] = static_cast<float>(c * share(c) / sum);
  }
  return table;
}

// The weighted sum over the plain one at the texels of a grid.
CubeMap ratios(const std::vector<Beam>& beams, const std::vector<float>& table, int grid) {
  CubeMap ratio(grid);
  for_texels(grid, [&](int face, int row, int column, const Vec3& n) {
    float plain[3] = {}, weighted[3] = {};
    for (const Beam& beam : beams) {
      const auto c = static_cast<float>(dot(n, beam.direction));
      if (!(c > 0)) continue;
      const float at = std::min(c, 1.0F) * kSteps;
      const auto i = static_cast<std::size_t>(at);
      const float w = table[i] + (at - static_cast<float>(i)) * (table[i + 1] - table[i]);
      for (std::size_t k = 0; k < 3; ++k) plain[k] += c * beam.flux[k], weighted[k] += w * beam.flux[k];
    }
    for (int k = 0; k < 3; ++k) ratio.at(face, row, column)[k] = plain[k] > 0 ? weighted[k] / plain[k] : 1;
  });
  return ratio;
}

}  // namespace

CubeMap weighted_diffuse(const PrefilteredEnvironment& env, const std::function<double(double)>& share) {
  const bool by_lobe = env.mirror.map.size == 0 && !env.lobes.empty() && env.lobes.back().exponent >= kSharpEnough;
  const CubeMap& source = by_lobe ? env.lobes.back().map : env.mirror.map;
  CubeMap map = env.diffuse.map;
  if (source.size == 0 || map.size == 0) return map;
  const std::vector<float> table = weighted_cosines(share);
  const CubeMap ratio = ratios(beams_of(source), table, std::min(map.size, kGrid));
  for_texels(map.size, [&](int face, int row, int column, const Vec3& direction) {
    const Vec3 r = bilinear(ratio, direction);
    for (int c = 0; c < 3; ++c) map.at(face, row, column)[c] *= static_cast<float>(r[c]);
  });
  return map;
}

}  // namespace goniochrome::envmap
