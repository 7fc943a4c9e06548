// Facets are drawn among those that the viewer sees [Heitz2018]: the facets are stretched to those of slope 1, whose
// visible part is that of a hemisphere, drawn as a disc, and stretched back. The density of a facet h of slope a is
// then G1(wo) D(h) (wo.h)/cos_o, and that of the light which it mirrors, which turns by twice the angle of h,
//
//   p(wi) = G1(wo) D(h) / (4 cos_o),    G1(w) = 1/(1 + L(w)).
//
// The two scales are drawn by chance, and p is the mean over both. Facets of Gaussian slopes are drawn as those of GGX
// with the same a: none occurs more than 4/e times as often as there.
#include "brdf/coat_facets.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/gloss.h"
#include "brdf/internal/facets.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

Vec3 visible_facet(const Vec3& out, double slope, double u, double v) {
  const Vec3 seen = normalized({slope * out.x, slope * out.y, out.z});
  const double across = math::hypot(seen.x, seen.y);
  const Vec3 x = across > 1e-12 ? Vec3{-seen.y / across, seen.x / across, 0} : Vec3{1, 0, 0}, y = cross(seen, x);
  const double r = std::sqrt(u), p = r * math::cos(2 * kPi * v), raised = 0.5 * (1 + seen.z);
  const double q = (1 - raised) * std::sqrt(1 - p * p) + raised * r * math::sin(2 * kPi * v);
  const Vec3 h = p * x + q * y + std::sqrt(std::max(0.0, 1 - p * p - q * q)) * seen;
  return normalized({slope * h.x, slope * h.y, std::max(1e-12, h.z)});
}

Vec3 mirrored_by(const Vec3& half, const Vec3& out) {
  return 2 * dot(out, half) * half - out;
}

// Evenly spread pairs [Roberts].
struct Pair {
  double u, v;
};
Pair spread_pair(int i) {
  constexpr double kGolden = 1.32471795724474602596;
  return {std::fmod(0.5 + i / kGolden, 1), std::fmod(0.5 + i / (kGolden * kGolden), 1)};
}

bool is_even(const color::Rgb& c) {
  return c.x == c.y && c.y == c.z;
}

}  // namespace

// No scale is left out as long as it has any light, and none is drawn that has none.
double CoatFacets::sharp_chance(double cos_o) const {
  const double share = sharp_share(coat_, cos_o);
  return coat_.k > 0 ? std::clamp(share, 0.05, 0.95) : 1;
}

CoatFacets::Sent CoatFacets::sent(const Vec3& to_light, const Vec3& to_viewer) const {
  if (to_light.z <= 0 || to_viewer.z <= 0) return {};
  const double cos_i = std::min(1.0, to_light.z), cos_o = std::min(1.0, to_viewer.z);
  const Vec3 half = normalized(to_light + to_viewer);
  const double cosine = std::min(1.0, dot(to_light, half)), share = sharp_share(coat_, cosine),
               chance = sharp_chance(cos_o);
  Sent sent;
  const auto add = [&](double slope, double part, double drawn) {
    if (part <= 0 && drawn <= 0) return;
    const Facets facets{slope, coat_.slopes}, of_drawn{slope};
    sent.f_cos += part * facets.density(half) / (1 + facets.masking(cos_i) + facets.masking(cos_o));
    sent.pdf += drawn * of_drawn.density(half) / (1 + of_drawn.masking(cos_o));
  };
  add(coat_.slope, share, chance);
  add(coat_.haze, 1 - share, 1 - chance);
  sent.f_cos *= fresnel_dielectric(cosine, index_) / (4 * cos_o);
  sent.pdf /= 4 * cos_o;
  return sent;
}

Vec3 CoatFacets::drawn(const Vec3& to_viewer, double choice, double u, double v) const {
  const double slope = choice < sharp_chance(std::min(1.0, to_viewer.z)) ? coat_.slope : coat_.haze;
  return mirrored_by(visible_facet(to_viewer, slope, u, v), to_viewer);
}

// Directions of the disc and of the facets, each counted by the density that both together give it (the balance
// heuristic, [Veach1995] 3.1): the first are right for a disc that is narrower than the coat spreads it, the second for
// a wider one.
double CoatFacets::over_disc(const Vec3& to_viewer, const Vec3& middle, double radius_rad) const {
  constexpr int kDirections = 384;
  const double versine = 2 * math::pow(math::sin(0.5 * radius_rad), 2), disc_pdf = 1 / (2 * kPi * versine);
  const Vec3 x = normalized(cross(middle, std::abs(middle.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
             y = cross(middle, x);
  double sum = 0;
  const auto add = [&](const Vec3& light) {
    const Sent sent = this->sent(light, to_viewer);
    sum += sent.f_cos / (disc_pdf + sent.pdf);
  };
  // So many of the facets are of the coarse scale as it has the chance.
  const int sharp = static_cast<int>(std::lround(sharp_chance(std::min(1.0, to_viewer.z)) * kDirections));
  for (int i = 0; i < kDirections; ++i) {
    const auto [u, v] = spread_pair(i);
    const double low = u * versine, sine = std::sqrt(low * (2 - low));
    add((1 - low) * middle + (sine * math::cos(2 * kPi * v)) * x + (sine * math::sin(2 * kPi * v)) * y);
    const auto [a, b] = spread_pair(i < sharp ? i : i - sharp);
    const Vec3 mirrored = mirrored_by(visible_facet(to_viewer, i < sharp ? coat_.slope : coat_.haze, a, b), to_viewer),
               apart = mirrored - middle;
    if (dot(apart, apart) <= 2 * versine) add(mirrored);
  }
  const double sine = math::sin(radius_rad);
  return sum / kDirections / (kPi * sine * sine);
}

// The light of facets of slope a falls as exp(-(x/2a)^2) in the middle, or to its fourth power of the half, by GGX, and
// cos^E as exp(-E x^2/2). Across the plane it is narrower by the cosine.
double CoatFacets::sharpest_exponent(double cos_o) const {
  constexpr double kMost = 1e6;
  const double finest = coat_.k > 0 ? std::min(coat_.slope, coat_.haze) : coat_.slope,
               across = finest * std::max(cos_o, 0.05);
  return std::clamp(1 / (across * across), 1.0, kMost);
}

// The facets of slope a send light into about 4 pi a^2.
double CoatFacets::narrow_share(double light_sr, double cos_o) const {
  const double chance = sharp_chance(cos_o);
  const auto narrow = [light_sr](double slope) { return light_sr / (light_sr + 4 * kPi * slope * slope); };
  return chance * narrow(coat_.slope) + (1 - chance) * narrow(coat_.haze);
}

bool stands_for_coat(const paint::LobeFit& fit) {
  bool changes = false;
  for (const paint::ViewLobes& view : fit.views) {
    const std::vector<paint::Lobe>& first = fit.views.front().lobes;
    for (std::size_t j = 0; j < view.lobes.size(); ++j) {
      if (!is_even(view.lobes[j].gloss)) return false;
      changes = changes || j >= first.size() || view.lobes[j].gloss != first[j].gloss;
    }
  }
  return changes && std::ranges::all_of(kCoatViews_deg, [&](double angle) {
           return std::ranges::find(fit.views, angle, &paint::ViewLobes::view_deg) != fit.views.end();
         });
}

std::optional<RoughCoat> coat_of_lobes(const paint::LobeFit& fit, double gloss_deg) {
  if (!stands_for_coat(fit)) return std::nullopt;
  std::vector<double> exponents;
  paint::LobeFit gloss = fit;
  const auto keep_gloss = [](color::Rgb& diffuse, std::vector<paint::Lobe>& lobes) {
    diffuse = {};
    for (paint::Lobe& lobe : lobes) lobe.directional_diffuse = {};
  };
  keep_gloss(gloss.diffuse, gloss.lobes);
  for (paint::ViewLobes& view : gloss.views) {
    keep_gloss(view.diffuse, view.lobes);
    for (const paint::Lobe& lobe : view.lobes)
      if (!lobe.is_mirror() && lobe.gloss != color::Rgb{}) exponents.push_back(lobe.exponent);
  }
  std::ranges::sort(exponents);
  exponents.erase(std::ranges::unique(exponents).begin(), exponents.end());
  const GlossTable table(exponents);
  std::vector<paint::GlossReading> readings;
  for (const double angle : kGlossAngles_deg)
    readings.push_back({angle, gloss_units(table, **table.at(angle), gloss, gloss_deg)});
  constexpr double kRounding_gu = 0.02;  // the lobes read what their coat does: what is usual is not asked once more
  const Result<std::optional<RoughCoat>> coat = rough_coat_of(readings, mirror_index(fit.coat_index), kRounding_gu);
  return coat.ok() ? *coat : std::nullopt;
}

}  // namespace goniochrome::brdf
