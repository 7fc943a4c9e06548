// A color map by isolines (two dimensions) against a table over all three angles of a pair of directions, and against
// measured pairs that are interpolated at every pixel, for the same flake paint: time of a lookup beside its error.
// [Kirchner] goniochrome-accuracy(7), "COLOR MAPS"
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "base/angles.h"
#include "brdf/color_map.h"

namespace goniochrome::brdf {
namespace {

// Reflectance factors of a paint that follows its isolines exactly.
color::Rgb flake_paint(const Vec3& wi, const Vec3& wo) {
  const FlakeAngles f = flake_angles(wi, wo, 1.5);
  const double flop = std::exp(-std::pow(f.flake_rad / 0.25, 2));
  return {0.05 + flop * (0.4 + 0.5 * f.incidence_rad), 0.04 + flop * (0.9 - f.incidence_rad), 0.05 + 0.6 * flop};
}

struct Pair {
  Vec3 wi, wo;
};

// Pairs of cosine-weighted directions that need no treatment at the critical angle.
std::vector<Pair> random_pairs(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto direction = [&] {
    const double r = std::sqrt(uniform(random)), phi = 2 * kPi * uniform(random);
    return Vec3{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)};
  };
  std::vector<Pair> pairs;
  while (static_cast<int>(pairs.size()) < count) {
    const Pair pair = {direction(), direction()};
    const FlakeAngles f = flake_angles(pair.wi, pair.wo, 1.5);
    if (f.flake_rad + f.incidence_rad < std::asin(1 / 1.5)) pairs.push_back(pair);
  }
  return pairs;
}

// Over both cosines and that of the azimuth between: no angle has to be computed. n^3 texels, corners on the borders.
class Table3 {
 public:
  explicit Table3(int n) : n_(n), values_(static_cast<std::size_t>(n) * n * n * 3) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) {
          const double zi = i / (n - 1.0), zo = j / (n - 1.0), c = 2 * k / (n - 1.0) - 1;
          const double si = std::sqrt(1 - zi * zi), so = std::sqrt(1 - zo * zo);
          const color::Rgb value = flake_paint({si, 0, zi}, {so * c, so * std::sqrt(1 - c * c), zo});
          for (int channel = 0; channel < 3; ++channel) at(i, j, k)[channel] = static_cast<float>(value[channel]);
        }
  }
  color::Rgb value(const Vec3& wi, const Vec3& wo) const {
    const double s2 = (wi.x * wi.x + wi.y * wi.y) * (wo.x * wo.x + wo.y * wo.y);
    const double c = s2 > 0 ? (wi.x * wo.x + wi.y * wo.y) / std::sqrt(s2) : 1;
    const double x[3] = {wi.z * (n_ - 1), wo.z * (n_ - 1), 0.5 * (c + 1) * (n_ - 1)};
    int low[3];
    double t[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::clamp(static_cast<int>(x[axis]), 0, n_ - 2);
      t[axis] = x[axis] - low[axis];
    }
    color::Rgb sum;
    for (int corner = 0; corner < 8; ++corner) {
      const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
      const double w = (i ? t[0] : 1 - t[0]) * (j ? t[1] : 1 - t[1]) * (k ? t[2] : 1 - t[2]);
      const float* texel = at(low[0] + i, low[1] + j, low[2] + k);
      for (int channel = 0; channel < 3; ++channel) sum[channel] += w * texel[channel];
    }
    return sum;
  }

 private:
  float* at(int i, int j, int k) { return &values_[3 * ((static_cast<std::size_t>(i) * n_ + j) * n_ + k)]; }
  const float* at(int i, int j, int k) const { return &values_[3 * ((static_cast<std::size_t>(i) * n_ + j) * n_ + k)]; }
  int n_;
  std::vector<float> values_;
};

// The 448 pairs of the instrument of [Kirchner] and their like: polar angles in steps of 10 deg and the azimuth in
// steps of 30 deg, on one side of the plane of incidence. A pair of directions gets the mean of all measured pairs by
// the inverse fourth power of their distance (Shepard), without any table.
class MeasuredPairs {
 public:
  MeasuredPairs() {
    for (int i = 0; i <= 7; ++i)
      for (int j = 0; j <= 7; ++j)
        for (int k = 0; k <= 6; ++k) {
          const double ti = 10 * i * kDegree, to = 10 * j * kDegree, az = 30 * k * kDegree;
          const Vec3 wi = {std::sin(ti), 0, std::cos(ti)};
          const Vec3 wo = {std::sin(to) * std::cos(az), std::sin(to) * std::sin(az), std::cos(to)};
          rows_.push_back({wi.z, wo.z, wi.x * wo.x, flake_paint(wi, wo)});
        }
  }
  std::size_t size() const { return rows_.size(); }
  color::Rgb value(const Vec3& wi, const Vec3& wo) const {
    const double across = wi.x * wo.x + wi.y * wo.y;
    color::Rgb sum;
    double weights = 0;
    for (const Row& row : rows_) {
      const double a = row.zi - wi.z, b = row.zo - wo.z, c = row.across - across, square = a * a + b * b + c * c;
      const double weight = 1 / (square * square + 1e-12);
      sum = sum + weight * row.value, weights += weight;
    }
    return (1 / weights) * sum;
  }

 private:
  struct Row {
    double zi, zo, across;  // cosines of both angles, and the product of both vectors along the surface
    color::Rgb value;
  };
  std::vector<Row> rows_;
};

// Runs lookups over the pairs; the mean error relative to the mean value stands beside the time.
template <class Lookup>
void measure(benchmark::State& state, const Lookup& lookup, double texels) {
  const std::vector<Pair> pairs = random_pairs(4096);
  double error = 0, size = 0;
  for (const Pair& pair : pairs) {
    const color::Rgb exact = flake_paint(pair.wi, pair.wo);
    error += length(lookup(pair) - exact), size += length(exact);
  }
  if (!(error < 0.2 * size)) state.SkipWithError("the lookup is off");
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(lookup(pairs[i++ & 4095]));
  state.counters["mean_error_percent"] = 100 * error / size;
  state.counters["kilobytes"] = texels * 12 / 1024;
}

void color_map_2d(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  ColorMap map = color_map_of_size(size, 1.5);
  for (int row = 0; row < 2 * size; ++row)
    for (int column = 0; column < size; ++column) {
      const MapDirections d = map_directions(size, column, row);
      const color::Rgb value = flake_paint(d.light, d.view);
      for (int c = 0; c < 3; ++c) map.texel(column, row)[c] = static_cast<float>(value[c]);
    }
  measure(
      state, [&](const Pair& p) { return reflectance_factor(map, p.wi, p.wo, CriticalAngle::kClip); },
      2.0 * size * size);
}
BENCHMARK(color_map_2d)->Arg(32)->Arg(64)->Arg(128)->Arg(256);

void table_3d(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const Table3 table(n);
  measure(
      state, [&](const Pair& p) { return table.value(p.wi, p.wo); }, 1.0 * n * n * n);
}
BENCHMARK(table_3d)->Arg(16)->Arg(32)->Arg(64)->Arg(128);

void measured_pairs(benchmark::State& state) {
  const MeasuredPairs pairs;
  measure(
      state, [&](const Pair& p) { return pairs.value(p.wi, p.wo); }, 2.0 * static_cast<double>(pairs.size()));
}
BENCHMARK(measured_pairs);

}  // namespace
}  // namespace goniochrome::brdf
