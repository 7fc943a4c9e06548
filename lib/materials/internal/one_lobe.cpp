#include "materials/internal/one_lobe.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/angles.h"
#include "materials/internal/nearest.h"

namespace goniochrome::materials {

namespace {

OneLobe with(OneLobe p, const std::vector<Parameter>& x) {
  for (int c = 0; c < 3; ++c) {
    p.base[c] = x[static_cast<std::size_t>(c)].value;
    p.specular[c] = x[static_cast<std::size_t>(c) + 3].value;
  }
  p.roughness = x[6].value;
  if (x.size() > 7) p.strength = x[7].value;
  if (x.size() > 8) p.metalness = x[8].value;
  return p;
}

OneLobe coat_of(const paint::LobeFit& lobes) {
  OneLobe coat;
  const CoatGloss gloss = coat_gloss(lobes);
  coat.clearcoat = std::min(1.0, gloss.mirror + gloss.satin);
  coat.clearcoat_roughness = gloss.satin > gloss.mirror ? std::sqrt(gloss.satin_alpha) : 0;
  return coat;
}

}  // namespace

// The search begins at three roughnesses, since from one it could end beside the best one, and at a lobe that hardly is
// there, for paints without any. The darkest reflectance of
// each channel is the first guess of the diffuse color, and the brightest that of the lobe, whose peak is
// c/(4 pi alpha^2).
OneLobe nearest_one_lobe(const paint::Paint& paint, const OneLobeModel& model, Searched searched) {
  const bool has_strength = searched != Searched::kColorsAndRoughness;
  const OneLobe coat = coat_of(*paint.lobes);
  const auto known = color::white_point(paint::condition_of(paint));
  const color::Xyz white = known.ok() ? *known : color::Xyz{1, 1, 1};
  const std::vector<FitSample> samples = fit_samples(*paint.lobes);
  std::vector<color::Lab> wanted;
  color::Rgb darkest{1, 1, 1}, brightest;
  for (const FitSample& sample : samples) {
    wanted.push_back(color::lab_from_rgb(kPi * sample.f, white));
    const color::Rgb rgb = kPi * color::rec709_from_rec2020(sample.f);
    for (int c = 0; c < 3; ++c) {
      darkest[c] = std::max(0.001, std::min(darkest[c], rgb[c]));
      brightest[c] = std::max(brightest[c], rgb[c]);
    }
  }
  const auto residuals = [&](const std::vector<Parameter>& x, std::vector<double>& out) {
    const OneLobe p = with(coat, x);
    out.resize(3 * samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const color::Rgb f = color::rec2020_from_rec709(model(p, samples[i].light, samples[i].view));
      const Vec3 apart = color::delta_e_2000_vector(wanted[i], color::lab_from_rgb(kPi * f, white));
      for (int c = 0; c < 3; ++c) out[3 * i + static_cast<std::size_t>(c)] = std::sqrt(samples[i].weight) * apart[c];
    }
  };
  double best = std::numeric_limits<double>::infinity();
  OneLobe nearest = coat;
  constexpr double kLeastMetalness = 0.01;
  struct Start {
    double roughness, strength, metalness;
  };
  for (const auto& [roughness, strength, metalness] :
       {Start{0.35, 0.9, 0}, Start{0.55, 0.9, 0}, Start{0.8, 0.9, 0}, Start{0.55, 0.02, 0}, Start{0.45, 0.5, 0.5},
        Start{0.7, 0.5, 0.5}}) {
    if (!has_strength && strength < 0.9) continue;
    if ((searched == Searched::kMetalnessToo) != (metalness > 0)) continue;
    const double peak = std::pow(roughness, 4);
    std::vector<Parameter> x;
    for (int c = 0; c < 3; ++c) x.push_back({darkest[c], 0, 1});
    for (int c = 0; c < 3; ++c) x.push_back({std::clamp(brightest[c] * peak, 0.01, 0.9), 0, 1});
    x.push_back({roughness, 0.08, 1});
    if (has_strength) x.push_back({strength, 0, 1});
    if (searched == Searched::kMetalnessToo) x.push_back({metalness, kLeastMetalness, 1});
    const double sum = descend(x, residuals);
    if (sum < best) best = sum, nearest = with(coat, x);
  }
  return nearest;
}

double rounded(double value) {
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

OneLobe rounded(const OneLobe& parameters) {
  OneLobe p = parameters;
  for (int c = 0; c < 3; ++c) p.base[c] = rounded(p.base[c]), p.specular[c] = rounded(p.specular[c]);
  for (double* value : {&p.strength, &p.roughness, &p.clearcoat, &p.clearcoat_roughness, &p.metalness})
    *value = rounded(*value);
  return p;
}

}  // namespace goniochrome::materials
