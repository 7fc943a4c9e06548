#include "brdf/band_lobes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "color/color_bands.h"
#include "color/spectrum.h"
#include "math/elementary.h"
#include "math/least_squares.h"
#include "paint/spectra.h"

namespace goniochrome::brdf {

namespace {

using color::Bands;
using color::kBands;

// Weights whose channels differ by no more are gray: written and read numbers are exact, sums of them are not.
constexpr double kGray = 1e-6;
bool is_gray(const color::Rgb& c) {
  const double most = std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  return std::abs(c.x - c.y) <= kGray * most && std::abs(c.y - c.z) <= kGray * most;
}

// The mixture (non-negative) of the spectra and of an even one whose color is nearest to `wanted`.
Bands mixture(const color::Rgb& wanted, const std::vector<Bands>& spectra, const color::BandObserver& eye) {
  math::Matrix columns(3, static_cast<int>(spectra.size()));
  std::vector<double> right(3);
  for (int c = 0; c < 3; ++c) right[static_cast<std::size_t>(c)] = wanted[c];
  for (std::size_t k = 0; k < spectra.size(); ++k) {
    const color::Rgb rgb = eye.rgb(spectra[k]);
    for (int c = 0; c < 3; ++c) columns(c, static_cast<int>(k)) = rgb[c];
  }
  const math::NonNegativeFit fit = math::nnls(columns, right);
  Bands sum{};
  for (std::size_t k = 0; k < spectra.size(); ++k)
    for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += fit.x[k] * spectra[k][b];
  return sum;
}

// How much a weight in bands may leave its mixture, relative to its size, for a reading that is wrong by the whole of
// it.
constexpr double kMixtureCounts = 0.01;

// A colored weight of a paint.
struct Weight {
  std::size_t view = 0;
  std::optional<double> exponent;  // none: K_D
  color::Rgb color;
  Bands bands{};
};

Result<std::vector<Bands>> spectra_of(const paint::Paint& paint) {
  std::vector<Bands> all;
  if (!paint.measurement) return all;
  for (const paint::SpectrumReading& reading : paint.measurement->spectra) {
    std::vector<double> nm;
    for (std::size_t i = 0; i < reading.factors.size(); ++i)
      nm.push_back(reading.from_nm + reading.step_nm * static_cast<double>(i));
    GONIO_ASSIGN(const Bands bands, color::reflectance_bands(nm, reading.factors));
    all.push_back(bands);
  }
  return all;
}

bool has_weight(const paint::Lobe& lobe) {
  return lobe.directional_diffuse != color::Rgb{} || lobe.gloss != color::Rgb{};
}

double angle_deg(const Vec3& direction) {
  return math::atan2(math::hypot(direction.x, direction.y), direction.z) / kDegree;
}

// The reading of a paint by an instrument at a geometry, in one channel.
double read_of(const paint::LobeFit& fit, const paint::Geometry& geometry) {
  const auto [light, view] = paint::directions(geometry);
  return flake_reflectance_factor(at_view(fit, angle_deg(view)), paint::aspecular_angle_deg(geometry), angle_deg(light),
                                  angle_deg(view))
      .y;
}

// Makes the paint whose only weight is this one, of 1.
paint::LobeFit with_weight_alone(const paint::BandLobes& lobes, const Weight& weight) {
  paint::LobeFit fit;
  fit.coat_index = lobes.coat_index;
  for (std::size_t v = 0; v < lobes.views.size(); ++v) {
    paint::ViewLobes view{lobes.views[v].view_deg, {}, {}};
    if (v == weight.view && !weight.exponent) view.diffuse = {1, 1, 1};
    for (const double exponent : lobes.exponents) {
      const bool is_it = v == weight.view && weight.exponent == exponent;
      view.lobes.push_back({exponent, is_it ? color::Rgb{1, 1, 1} : color::Rgb{}, {}});
    }
    fit.views.push_back(std::move(view));
  }
  fit.diffuse = fit.views.front().diffuse, fit.lobes = fit.views.front().lobes;
  if (fit.views.size() == 1) fit.views.clear();
  return fit;
}

// The paint in one band.
paint::LobeFit in_band(const paint::BandLobes& lobes, std::size_t band) {
  paint::LobeFit fit;
  fit.coat_index = lobes.coat_index;
  for (const paint::BandWeights& weights : lobes.views) {
    paint::ViewLobes view{weights.view_deg, weights.diffuse[band] * color::Rgb{1, 1, 1}, {}};
    for (std::size_t j = 0; j < lobes.exponents.size(); ++j)
      view.lobes.push_back({lobes.exponents[j], weights.directional_diffuse[j][band] * color::Rgb{1, 1, 1}, {}});
    fit.views.push_back(std::move(view));
  }
  fit.diffuse = fit.views.front().diffuse, fit.lobes = fit.views.front().lobes;
  if (fit.views.size() == 1) fit.views.clear();
  return fit;
}

// Band by band the weights >= 0 that meet the readings best, beside those of `lobes`, which are gray; what no reading
// tells stays with the mixtures.
void meet_readings(const std::vector<paint::SpectrumReading>& readings, const std::vector<Bands>& spectra,
                   const paint::BandLobes& lobes, std::vector<Weight>& weights) {
  const auto columns = static_cast<int>(weights.size()), rows = static_cast<int>(readings.size());
  math::Matrix shape(rows + columns, columns);
  std::vector<double> level(readings.size());
  for (std::size_t g = 0; g < readings.size(); ++g) {
    level[g] = std::max(color::mean(spectra[g]), 1e-6);
    for (std::size_t k = 0; k < weights.size(); ++k)
      shape(static_cast<int>(g), static_cast<int>(k)) =
          read_of(with_weight_alone(lobes, weights[k]), readings[g].geometry) / level[g];
  }
  std::vector<double> size;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    size.push_back(std::max(color::mean(weights[k].bands), 1e-12));
    shape(rows + static_cast<int>(k), static_cast<int>(k)) = kMixtureCounts / size[k];
  }
  std::vector<double> right(static_cast<std::size_t>(shape.rows));
  for (std::size_t b = 0; b < static_cast<std::size_t>(kBands); ++b) {
    const paint::LobeFit gray = in_band(lobes, b);
    for (std::size_t g = 0; g < readings.size(); ++g)
      right[g] = (spectra[g][b] - read_of(gray, readings[g].geometry)) / level[g];
    for (std::size_t k = 0; k < weights.size(); ++k)
      right[readings.size() + k] = kMixtureCounts * weights[k].bands[b] / size[k];
    const math::NonNegativeFit fit = math::nnls(shape, right);
    for (std::size_t k = 0; k < weights.size(); ++k) weights[k].bands[b] = fit.x[k];
  }
}

Bands& place_of(const Weight& weight, paint::BandLobes& lobes) {
  paint::BandWeights& view = lobes.views[weight.view];
  if (!weight.exponent) return view.diffuse;
  const auto j = std::ranges::lower_bound(lobes.exponents, *weight.exponent) - lobes.exponents.begin();
  return view.directional_diffuse[static_cast<std::size_t>(j)];
}

// The bands of gloss. Error: it is colored, and not to be guessed.
Result<Bands> gloss_bands(const color::Rgb& gloss, const color::BandObserver& eye, NoSpectrum otherwise) {
  if (is_gray(gloss)) return color::even_bands(gloss.y);
  if (otherwise == NoSpectrum::kRefused) return input_error("its gloss is colored, and no spectrum tells of gloss");
  return color::bands_of_color(gloss, eye);
}

// Sets the gray weights and the gloss of a view, and lists the colored weights of its flakes.
Result<void> sort_weights(const paint::ViewLobes& view, std::size_t number, const color::BandObserver& eye,
                          NoSpectrum otherwise, paint::BandLobes& lobes, std::vector<Weight>& colored) {
  paint::BandWeights& weights = lobes.views.emplace_back();
  weights.view_deg = view.view_deg;
  weights.directional_diffuse.assign(lobes.exponents.size(), {});
  weights.gloss.assign(lobes.exponents.size(), {});
  const auto take = [&](const std::optional<double>& exponent, const color::Rgb& color) {
    const Weight weight{number, exponent, color, {}};
    if (is_gray(color)) {
      place_of(weight, lobes) = color::even_bands(color.y);
    } else {
      colored.push_back(weight);
    }
  };
  take({}, view.diffuse);
  for (const paint::Lobe& lobe : view.lobes) {
    if (!has_weight(lobe)) continue;
    GONIO_ASSIGN(const Bands gloss, gloss_bands(lobe.gloss, eye, otherwise));
    if (lobe.is_mirror()) {
      weights.mirror = gloss;
      continue;
    }
    const auto j =
        static_cast<std::size_t>(std::ranges::lower_bound(lobes.exponents, lobe.exponent) - lobes.exponents.begin());
    weights.gloss[j] = gloss;
    take(lobe.exponent, lobe.directional_diffuse);
  }
  return {};
}

double misfit_de00(const paint::ViewLobes& view, const paint::BandWeights& weights,
                   const std::vector<double>& exponents, const color::BandObserver& eye) {
  const color::Xyz d65 = color::xyz_d65_from_rgb({1, 1, 1});
  const auto apart = [&](const color::Rgb& wanted, const Bands& bands) {
    const double size = std::max({wanted.x, wanted.y, wanted.z});
    if (!(size > 0)) return 0.0;
    return color::delta_e_2000(color::lab_from_rgb((0.5 / size) * wanted, d65),
                               color::lab_from_rgb((0.5 / size) * eye.rgb(bands), d65));
  };
  double worst = apart(view.diffuse, weights.diffuse);
  for (const paint::Lobe& lobe : view.lobes) {
    if (lobe.is_mirror() || !has_weight(lobe)) continue;
    const auto j = static_cast<std::size_t>(std::ranges::lower_bound(exponents, lobe.exponent) - exponents.begin());
    worst = std::max(worst, apart(lobe.directional_diffuse, weights.directional_diffuse[j]));
  }
  return worst;
}

// The differences from the spectra in the light of an incandescent lamp, which the fit did not know.
Result<std::vector<double>> readings_de00(const paint::Paint& paint, const paint::BandLobes& lobes) {
  std::vector<double> all;
  if (!paint.measurement) return all;
  const color::ViewingCondition lamp{"A", 2};
  for (const paint::SpectrumReading& measured : paint.measurement->spectra) {
    paint::SpectrumReading predicted{measured.geometry, color::kFirstBand_nm, color::kBandStep_nm, {}};
    for (std::size_t b = 0; b < static_cast<std::size_t>(kBands); ++b)
      predicted.factors.push_back(read_of(in_band(lobes, b), measured.geometry));
    GONIO_ASSIGN(const color::Lab wanted, paint::lab_of(measured, lamp));
    GONIO_ASSIGN(const color::Lab shown, paint::lab_of(predicted, lamp));
    all.push_back(color::delta_e_2000(wanted, shown));
  }
  return all;
}

}  // namespace

Result<paint::BandLobes> band_lobes(const paint::Paint& paint, const color::BandObserver& eye, NoSpectrum otherwise) {
  if (!paint.lobes) return input_error("it has no lobes");
  if (paint.color_map) return input_error("its color map has no spectra");
  const paint::LobeFit& fit = *paint.lobes;
  std::vector<paint::ViewLobes> views = fit.views;
  if (views.empty()) views.push_back({0, fit.diffuse, fit.lobes});
  paint::BandLobes result;
  result.coat_index = fit.coat_index;
  std::set<double> exponents;
  for (const paint::ViewLobes& view : views)
    for (const paint::Lobe& lobe : view.lobes)
      if (!lobe.is_mirror() && has_weight(lobe)) exponents.insert(lobe.exponent);
  result.exponents.assign(exponents.begin(), exponents.end());
  GONIO_ASSIGN(const std::vector<Bands> spectra, spectra_of(paint));
  std::vector<Weight> colored;
  for (std::size_t v = 0; v < views.size(); ++v) GONIO_TRY(sort_weights(views[v], v, eye, otherwise, result, colored));
  if (!colored.empty() && spectra.empty()) {
    if (otherwise == NoSpectrum::kRefused) return input_error("it has no spectrum");
    for (const Weight& weight : colored) place_of(weight, result) = color::bands_of_color(weight.color, eye);
  } else if (!colored.empty()) {
    std::vector<Bands> mixed = spectra;
    mixed.push_back(color::even_bands(1));
    for (Weight& weight : colored) weight.bands = mixture(weight.color, mixed, eye);
    meet_readings(paint.measurement->spectra, spectra, result, colored);
    for (const Weight& weight : colored)
      place_of(weight, result) = color::bands_of_color(weight.color, eye, weight.bands);
  }
  for (std::size_t v = 0; v < views.size(); ++v)
    result.misfit_de00 = std::max(result.misfit_de00, misfit_de00(views[v], result.views[v], result.exponents, eye));
  GONIO_ASSIGN(result.readings_de00, readings_de00(paint, result));
  return result;
}

}  // namespace goniochrome::brdf
