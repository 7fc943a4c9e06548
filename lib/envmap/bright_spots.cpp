#include "envmap/bright_spots.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/text.h"
#include "envmap/patch.h"

namespace goniochrome::envmap {

namespace {

// Factors of the mean radiance: above the first, light is in a spot; above the second, it can be a sun.
constexpr double kBright = 3, kSunny = 30;
// Spots go on being cut while the spread of one, by its share of the light, exceeds this.
constexpr double kSpread = 1e-4;
constexpr double kLeastShare = 1e-3;     // of all light: less is no spot
constexpr double kWidest_rad = 0.5;      // wider is no spot
constexpr double kWidestSun_rad = 0.03;  // the air about a sun shines, and a probe spreads it
constexpr double kLeastSun = 0.1;        // of all light
constexpr double kMostWhite = 1e30;      // of a spot: far from what a float cannot hold

// The light of a texel beyond a level.
struct Excess {
  int column = 0, row = 0;
  color::Rgb radiance;
  Vec3 moment;       // integral of the direction over the texel, in sr
  double light = 0;  // the mean of the channels times the solid angle
};

// Texels and what they send together.
struct Cluster {
  std::vector<Excess> texels;
  double light = 0;
  Vec3 mean;  // direction, weighed by the light; shorter the wider the cluster is

  explicit Cluster(std::vector<Excess> of) : texels(std::move(of)) {
    for (const Excess& e : texels) light += e.light, mean += color::mean(e.radiance) * e.moment;
    if (light > 0) mean = (1 / light) * mean;
  }
  // 1 - |mean|^2: the sum of the variances along the axes.
  double variance() const { return std::max(0.0, 1 - dot(mean, mean)); }
  Vec3 direction() const { return normalized(mean); }
  // A disc's mean direction has the length cos^2(radius / 2).
  double radius_rad() const { return 2 * std::acos(std::sqrt(std::min(1.0, length(mean)))); }
  Vec3 longer_axis() const;
};

// The eigenvector of the largest eigenvalue of the covariance of directions, by powers of the matrix.
Vec3 Cluster::longer_axis() const {
  std::array<Vec3, 3> covariance;
  for (const Excess& e : texels) {
    const double solid_angle = length(e.moment);
    const Vec3 apart = (1 / solid_angle) * e.moment - mean;
    for (int i = 0; i < 3; ++i) covariance[static_cast<std::size_t>(i)] += e.light * apart[i] * apart;
  }
  Vec3 axis = normalized({1, 0.7, 0.4});
  for (int step = 0; step < 64; ++step) {
    const Vec3 next{dot(covariance[0], axis), dot(covariance[1], axis), dot(covariance[2], axis)};
    if (!(length(next) > 0)) break;
    axis = normalized(next);
  }
  return axis;
}

// All light of the environment, the mean of the channels.
double whole_light(const Environment& environment) {
  return color::mean(environment.flux());
}

std::vector<Excess> brighter_in_row(const Environment& environment, int row, double level) {
  std::vector<Excess> found;
  for (int column = 0; column < environment.width(); ++column) {
    const color::Rgb radiance = environment.texel(column, row);
    const double mean = color::mean(radiance);
    if (!(mean > level)) continue;
    Excess e{column, row, (1 - level / mean) * radiance, {}, 0};
    e.moment = moment_of_cell(environment, {1.0 * column, 1.0 * row, column + 1.0, row + 1.0});
    e.light = color::mean(e.radiance) * environment.solid_angle(column, row);
    if (length(e.moment) > 0) found.push_back(e);
  }
  return found;
}

// In the order of the rows.
std::vector<Excess> brighter_than(const Environment& environment, double level) {
  std::vector<std::vector<Excess>> rows(static_cast<std::size_t>(environment.height()));
  parallel_for(rows.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      rows[row] = brighter_in_row(environment, static_cast<int>(row), level);
  });
  std::size_t count = 0;
  for (const std::vector<Excess>& row : rows) count += row.size();
  std::vector<Excess> found;
  found.reserve(count);
  for (const std::vector<Excess>& row : rows) found.insert(found.end(), row.begin(), row.end());
  return found;
}

// The excess in clusters, none of which spreads much of the light.
std::vector<Cluster> clusters(const Environment& environment, double level, double whole, std::size_t most) {
  std::vector<Cluster> all;
  all.emplace_back(brighter_than(environment, level));
  const auto spread = [](const Cluster& c) { return c.light * c.variance(); };
  while (all.size() < most) {
    const auto widest = std::ranges::max_element(all, {}, spread);
    if (spread(*widest) <= kSpread * whole || widest->texels.size() < 2) break;
    const Vec3 axis = widest->longer_axis();
    const double middle = dot(axis, widest->mean);
    std::vector<Excess> texels = std::move(widest->texels);
    const auto second = std::stable_partition(texels.begin(), texels.end(), [&](const Excess& e) {
      return dot(axis, e.moment) <= middle * length(e.moment);
    });
    if (second == texels.begin() || second == texels.end()) {
      *widest = Cluster(std::move(texels));
      break;
    }
    Cluster other({second, texels.end()});
    texels.erase(second, texels.end());
    *widest = Cluster(std::move(texels));
    all.push_back(std::move(other));
  }
  return all;
}

// Together with what is left it lights a surface that faces it as the texels do.
Spot spot_of(const Cluster& cluster) {
  Spot spot{cluster.direction(), {}, cluster.radius_rad()};
  for (const Excess& e : cluster.texels) spot.white += (dot(e.moment, spot.direction) / kPi) * e.radiance;
  return spot;
}

}  // namespace

double bright_level(const Environment& environment) {
  return kBright * whole_light(environment) / (4 * kPi);
}

std::vector<Spot> bright_spots(const Environment& environment, int most) {
  const double whole = whole_light(environment);
  if (most <= 0 || !(whole > 0) || !std::isfinite(whole)) return {};
  std::vector<Spot> spots;
  const double level = bright_level(environment);
  for (const Cluster& cluster : clusters(environment, level, whole, static_cast<std::size_t>(most))) {
    if (cluster.light < kLeastShare * whole || cluster.radius_rad() > kWidest_rad) continue;
    const Spot spot = spot_of(cluster);
    if (spot.radius_rad > 0 && std::max({spot.white.x, spot.white.y, spot.white.z}) <= kMostWhite)
      spots.push_back(spot);
  }
  return spots;
}

std::optional<SunlitSky> sunlit_sky(const Environment& environment) {
  const double whole = whole_light(environment);
  if (!(whole > 0) || !std::isfinite(whole)) return std::nullopt;
  const double level = kSunny * whole / (4 * kPi);
  const std::vector<Cluster> all = clusters(environment, level, whole, kUsualSpots);
  const Cluster& brightest = *std::ranges::max_element(all, {}, &Cluster::light);
  if (brightest.light < kLeastSun * whole) return std::nullopt;
  const Spot sun = spot_of(brightest);
  if (!(sun.radius_rad > 0) || sun.radius_rad > kWidestSun_rad || sun.direction.y <= std::sin(sun.radius_rad))
    return std::nullopt;
  std::vector<Environment::Dimmed> dimmed;
  for (const Excess& e : brightest.texels)
    dimmed.push_back({e.column, e.row, level / color::mean(environment.texel(e.column, e.row))});
  return SunlitSky{sun, environment.dimmed(dimmed)};
}

std::string text_of_spots(const std::vector<Spot>& spots) {
  std::string text;
  for (const Spot& spot : spots) {
    const double numbers[] = {spot.direction.x, spot.direction.y, spot.direction.z, spot.white.x,
                              spot.white.y,     spot.white.z,     spot.radius_rad};
    std::string line;
    for (const double number : numbers) line += (line.empty() ? "" : " ") + shortest(number);
    text += (text.empty() ? "" : ";") + line;
  }
  return text;
}

Result<std::vector<Spot>> spots_of_text(const std::string& text) {
  std::vector<Spot> spots;
  if (text.empty()) return spots;
  for (const std::string_view line : split(text, ';')) {
    const std::vector<std::string_view> words = split(line, ' ');
    std::array<double, 7> v{};
    if (words.size() != v.size()) return input_error("spot {} has {} numbers, not 7", spots.size() + 1, words.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
      const std::optional<double> number = parse_number(words[i]);
      if (!number || !std::isfinite(*number))
        return input_error("spot {} has \"{}\", which is no number", spots.size() + 1, words[i]);
      v[i] = *number;
    }
    const Vec3 direction{v[0], v[1], v[2]};
    const bool lit = std::min({v[3], v[4], v[5]}) >= 0 && std::max({v[3], v[4], v[5]}) <= kMostWhite;
    if (std::abs(length(direction) - 1) > 1e-6 || !lit || !(v[6] > 0) || v[6] > kPi / 2)
      return input_error(
          "spot {} has no direction of length 1, light that is not in 0 to {:g}, or a radius that is not in 0 to pi/2",
          spots.size() + 1, kMostWhite);
    spots.push_back({normalized(direction), {v[3], v[4], v[5]}, v[6]});
  }
  if (spots.size() > static_cast<std::size_t>(kMostSpots))
    return input_error("{} spots, more than {}", spots.size(), kMostSpots);
  return spots;
}

}  // namespace goniochrome::envmap
