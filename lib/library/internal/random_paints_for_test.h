// For tests and benchmarks of the search: random paints from solids to metallics, whose face and flop have related
// hues.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "base/angles.h"
#include "paint/paint.h"

namespace goniochrome::library::random_paints {

// Colors at `aspecular_deg` on a clamped quadratic between a random face and a flop of related hue, plus noise.
inline std::vector<color::Lab> colors(std::mt19937_64& random, const std::vector<double>& aspecular_deg) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto normal = [&](double sigma) { return std::normal_distribution<double>(0, sigma)(random); };
  const double chroma = std::abs(normal(30)), hue = uniform(0, 2 * kPi), L = uniform(10, 110);
  const double flop_L = L * uniform(0.05, 1), flop_chroma = chroma * uniform(0.1, 1.1), flop_hue = hue + normal(0.15);
  const double travel = uniform(45, 110);
  std::vector<color::Lab> result;
  for (const double t : aspecular_deg) {
    const double ramp = t < travel ? (travel - t) / (travel - 15) : 0, w = ramp * ramp;
    const auto mixed = [&](double face, double flop) { return flop + (face - flop) * w + normal(1); };
    result.push_back({std::max(0.0, mixed(L, flop_L)), mixed(chroma * std::cos(hue), flop_chroma * std::cos(flop_hue)),
                      mixed(chroma * std::sin(hue), flop_chroma * std::sin(flop_hue))});
  }
  return result;
}

inline paint::Paint paint(std::mt19937_64& random, std::string name, const std::vector<double>& aspecular_deg) {
  paint::Paint result;
  result.name = std::move(name);
  result.measurement = paint::Measurement{};
  const std::vector<color::Lab> lab = colors(random, aspecular_deg);
  for (std::size_t i = 0; i < lab.size(); ++i)
    result.measurement->rows.push_back({{.incidence_deg = 45, .aspecular_deg = aspecular_deg[i]}, lab[i]});
  return result;
}

}  // namespace goniochrome::library::random_paints
