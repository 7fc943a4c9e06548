#include "materials/internal/angle_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/angles.h"
#include "materials/internal/seen_paint.h"

namespace goniochrome::materials {

namespace {

// The nodes on both sides of a place, and its share of the way between them.
struct Between {
  std::size_t low, high;
  double share;
};
Between between(const std::vector<double>& nodes, double x) {
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nodes, x) - nodes.begin());
  if (above == 0) return {0, 0, 0};
  if (above == nodes.size()) return {above - 1, above - 1, 0};
  return {above - 1, above, (x - nodes[above - 1]) / (nodes[above] - nodes[above - 1])};
}

std::vector<double> radians(std::vector<double> degrees) {
  for (double& x : degrees) x *= kDegree;
  return degrees;
}

// The light of a gloss lobe is 2 pi K_G/(E + 1), of which F(45) is Fresnel's.
paint::BandLobes resolved(paint::BandLobes lobes) {
  const double fresnel = brdf::fresnel_dielectric(std::cos(brdf::kGlossIncidence_deg * kDegree), brdf::kCoatIndex);
  for (paint::BandWeights& view : lobes.views)
    for (std::size_t e = 0; e < lobes.exponents.size(); ++e) {
      if (lobes.exponents[e] < kSharpestInCells) continue;
      for (std::size_t band = 0; band < view.mirror.size(); ++band)
        view.mirror[band] += 2 * kPi * view.gloss[e][band] / ((lobes.exponents[e] + 1) * fresnel);
      view.gloss[e] = {};
    }
  return lobes;
}

}  // namespace

std::string meters(int band) {
  return fmt::format("{:.3g}", color::band_nm(band) * 1e-9);
}

const std::vector<double>& AngleTable::polar_rad() {
  static const std::vector<double> angles = [] {
    std::vector<double> degrees;
    for (int k = 0; k <= 32; ++k) degrees.push_back(2.5 * k);
    degrees.push_back(85);
    return radians(degrees);
  }();
  return angles;
}

const std::vector<double>& AngleTable::azimuth_rad() {
  static const std::vector<double> angles =
      radians({0, 30, 60, 80, 100, 115, 130, 140, 150, 155, 160, 165, 170, 172.5, 175, 177.5, 180});
  return angles;
}

color::Bands& AngleTable::cell(std::size_t incidence, std::size_t exit, std::size_t azimuth) {
  return cells_[(incidence * polar_rad().size() + exit) * azimuth_rad().size() + azimuth];
}

const color::Bands& AngleTable::cell(std::size_t incidence, std::size_t exit, std::size_t azimuth) const {
  return cells_[(incidence * polar_rad().size() + exit) * azimuth_rad().size() + azimuth];
}

AngleTable::AngleTable(const paint::BandLobes& paint)
    : cells_(polar_rad().size() * polar_rad().size() * azimuth_rad().size()) {
  const paint::BandLobes lobes = resolved(paint);
  const auto &polar = polar_rad(), &azimuth = azimuth_rad();
  for (std::size_t o = 0; o < polar.size(); ++o) {
    const SeenBands seen(lobes, polar[o]);
    for (std::size_t i = 0; i < polar.size(); ++i)
      for (std::size_t k = 0; k < azimuth.size(); ++k)
        cell(i, o, k) = seen.without_mirror(direction(polar[i], azimuth[k]));
    add_mirror(o, seen.mirror(), lobes.coat_index);
  }
}

// The image of the mirror is as wide as the cells: the node in the mirror direction has the light that the hat function
// of its cell takes in.
void AngleTable::add_mirror(std::size_t polar, const color::Bands& weight, double coat_index) {
  const auto &angles = polar_rad(), &azimuths = azimuth_rad();
  const double cosine = std::cos(angles[polar]),
               fresnel = brdf::fresnel_dielectric(cosine, brdf::mirror_index(coat_index));
  if (polar == 0) {
    const double solid = kPi * angles[1] * angles[1] / 3;
    for (std::size_t k = 0; k < azimuths.size(); ++k)
      for (std::size_t band = 0; band < weight.size(); ++band) cell(0, 0, k)[band] += fresnel * weight[band] / solid;
    return;
  }
  const double above = angles[std::min(polar + 1, angles.size() - 1)];
  const double wide = azimuths.back() - azimuths[azimuths.size() - 2];
  const double solid = std::sin(angles[polar]) * (above - angles[polar - 1]) / 2 * wide;
  color::Bands& peak = cell(polar, polar, azimuths.size() - 1);
  for (std::size_t band = 0; band < weight.size(); ++band) peak[band] += fresnel * weight[band] / (cosine * solid);
}

color::Bands AngleTable::at(const Vec3& light, const Vec3& view) const {
  const auto polar = [](const Vec3& v) { return std::acos(std::clamp(v.z, -1.0, 1.0)); };
  const double turn = std::atan2(light.x * view.y - light.y * view.x, light.x * view.x + light.y * view.y);
  const Between i = between(polar_rad(), polar(light)), o = between(polar_rad(), polar(view)),
                k = between(azimuth_rad(), std::abs(turn));
  color::Bands sum{};
  for (const auto& [incidence, share_i] : {std::pair(i.low, 1 - i.share), std::pair(i.high, i.share)})
    for (const auto& [exit, share_o] : {std::pair(o.low, 1 - o.share), std::pair(o.high, o.share)})
      for (const auto& [azimuth, share_k] : {std::pair(k.low, 1 - k.share), std::pair(k.high, k.share)}) {
        const color::Bands& f = cell(incidence, exit, azimuth);
        for (std::size_t band = 0; band < f.size(); ++band) sum[band] += share_i * share_o * share_k * f[band];
      }
  return sum;
}

std::string AngleTable::rows() const {
  std::string text;
  for (int band = 0; band < color::kBands; ++band)
    for (std::size_t i = 0; i < polar_rad().size(); ++i)
      for (std::size_t o = 0; o < polar_rad().size(); ++o)
        for (std::size_t k = 0; k < (o == 0 ? 1 : azimuth_rad().size()); ++k)
          fmt::format_to(std::back_inserter(text), "[{},{:.6g},{:.6g},{:.6g},{:.5g}],\n", meters(band), polar_rad()[i],
                         polar_rad()[o], azimuth_rad()[k], cell(i, o, k)[static_cast<std::size_t>(band)]);
  text.resize(text.size() - 2);
  return text + "\n";
}

}  // namespace goniochrome::materials
