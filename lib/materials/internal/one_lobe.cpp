#include "materials/internal/one_lobe.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <optional>

#include "base/angles.h"
#include "materials/internal/nearest.h"

namespace goniochrome::materials {

namespace {

// A parameter of the model that a search moves.
struct Moved {
  double& (*of)(OneLobe& p);
  double low, high;
};
constexpr double kLeastMetalness = 0.01;
constexpr Moved kStrength = {[](OneLobe&p) -> double& { return p.strength; }, 0, 1},
                kMetalness = {[](OneLobe&p) -> double& { return p.metalness; }, kLeastMetalness, 1},
                kFilm = {[](OneLobe&p) -> double& { return p.film; }, 0, 1},
                kFilmIndex = {[](OneLobe&p) -> double& { return p.film_index; }, 1.05, 2.5},
                kFilmThickness = {[](OneLobe&p) -> double& { return p.film_nm; }, 50, 1200};

// Colors and roughness, which every search moves.
std::vector<Moved> all_of(std::initializer_list<Moved> more) {
  std::vector<Moved> moved = {{[](OneLobe& p) -> double& { return p.base.x; }, 0, 1},
                              {[](OneLobe& p) -> double& { return p.base.y; }, 0, 1},
                              {[](OneLobe& p) -> double& { return p.base.z; }, 0, 1},
                              {[](OneLobe& p) -> double& { return p.specular.x; }, 0, 1},
                              {[](OneLobe& p) -> double& { return p.specular.y; }, 0, 1},
                              {[](OneLobe& p) -> double& { return p.specular.z; }, 0, 1},
                              {[](OneLobe& p) -> double& { return p.roughness; }, 0.08, 1}};
  moved.insert(moved.end(), more);
  return moved;
}

OneLobe coat_of(const paint::LobeFit& lobes) {
  OneLobe coat;
  const CoatGloss gloss = coat_gloss(lobes);
  coat.clearcoat = std::min(1.0, gloss.mirror + gloss.satin);
  coat.clearcoat_roughness = gloss.satin > gloss.mirror ? std::sqrt(gloss.satin_alpha) : 0;
  return coat;
}

// A search compares a model with these samples.
class Search {
 public:
  Search(const paint::Paint& paint, const OneLobeModel& model) : model_(model), samples_(fit_samples(*paint.lobes)) {
    const auto known = color::white_point(paint::condition_of(paint));
    white_ = known.ok() ? *known : color::Xyz{1, 1, 1};
    for (const FitSample& sample : samples_) {
      wanted_.push_back(color::lab_from_rgb(kPi * sample.f, white_));
      const color::Rgb rgb = kPi * color::rec709_from_rec2020(sample.f);
      for (int c = 0; c < 3; ++c) {
        darkest_[c] = std::max(0.001, std::min(darkest_[c], rgb[c]));
        brightest_[c] = std::max(brightest_[c], rgb[c]);
      }
    }
  }
  const color::Rgb& darkest() const { return darkest_; }
  const color::Rgb& brightest() const { return brightest_; }

  // Moves the parameters downhill, and returns the sum of squares where it ends.
  double descend_from(OneLobe& p, const std::vector<Moved>& moved) const {
    std::vector<Parameter> x;
    for (const Moved& m : moved) x.push_back({m.of(p), m.low, m.high});
    const auto put = [&](OneLobe q, const std::vector<Parameter>& at) {
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i].of(q) = at[i].value;
      return q;
    };
    const double sum = descend(
        x, [&](const std::vector<Parameter>& at, std::vector<double>& out) { fill_differences(put(p, at), out); });
    p = put(p, x);
    return sum;
  }

 private:
  void fill_differences(const OneLobe& p, std::vector<double>& out) const {
    out.resize(3 * samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const color::Rgb f = color::rec2020_from_rec709(model_(p, samples_[i].light, samples_[i].view));
      const Vec3 apart = color::delta_e_2000_vector(wanted_[i], color::lab_from_rgb(kPi * f, white_));
      for (int c = 0; c < 3; ++c) out[3 * i + static_cast<std::size_t>(c)] = std::sqrt(samples_[i].weight) * apart[c];
    }
  }

  const OneLobeModel& model_;
  std::vector<FitSample> samples_;
  color::Xyz white_;
  std::vector<color::Lab> wanted_;
  color::Rgb darkest_{1, 1, 1}, brightest_;
};

}  // namespace

// The search begins at three roughnesses, since from one it could end beside the best one, and at a lobe that hardly is
// there, for paints without any. The darkest reflectance of
// each channel is the first guess of the diffuse color, and the brightest that of the lobe, whose peak is
// c/(4 pi alpha^2).
OneLobe nearest_one_lobe(const paint::Paint& paint, const OneLobeModel& model, Searched searched) {
  const bool has_strength = searched != Searched::kColorsAndRoughness, has_metal = searched == Searched::kMetalnessToo;
  const std::vector<Moved> moved = has_metal      ? all_of({kStrength, kMetalness})
                                   : has_strength ? all_of({kStrength})
                                                  : all_of({});
  const Search search(paint, model);
  const OneLobe coat = coat_of(*paint.lobes);
  double best = std::numeric_limits<double>::infinity();
  OneLobe nearest = coat;
  struct Start {
    double roughness, strength, metalness;
  };
  for (const auto& [roughness, strength, metalness] :
       {Start{0.35, 0.9, 0}, Start{0.55, 0.9, 0}, Start{0.8, 0.9, 0}, Start{0.55, 0.02, 0}, Start{0.45, 0.5, 0.5},
        Start{0.7, 0.5, 0.5}}) {
    if (!has_strength && strength < 0.9) continue;
    if (has_metal != (metalness > 0)) continue;
    OneLobe p = coat;
    p.roughness = roughness;
    if (has_strength) p.strength = strength;
    p.metalness = metalness;
    const double peak = std::pow(roughness, 4);
    p.base = search.darkest();
    for (int c = 0; c < 3; ++c) p.specular[c] = std::clamp(search.brightest()[c] * peak, 0.01, 0.9);
    const double sum = search.descend_from(p, moved);
    if (sum < best) best = sum, nearest = p;
  }
  return nearest;
}

Shown shown_by(const paint::Paint& paint, const OneLobeModel& model, const OneLobe& parameters) {
  return shown(paint, [&](const Vec3& light, const Vec3& view) {
    return color::rec2020_from_rec709(model(parameters, light, view));
  });
}

NearestLobe nearest_of(const paint::Paint& paint, const OneLobeModel& model, std::initializer_list<Searched> ways) {
  std::optional<NearestLobe> nearest;
  for (const Searched searched : ways) {
    NearestLobe now{rounded(nearest_one_lobe(paint, model, searched)), {}};
    now.shown = shown_by(paint, model, now.parameters);
    if (!nearest || now.shown.de00_mean < nearest->shown.de00_mean) nearest = std::move(now);
  }
  return *nearest;
}

// The hue of a film turns once with some 200 nm of thickness, so that the search begins at steps of a part of that.
OneLobe nearest_with_film(const paint::Paint& paint, const OneLobeModel& model, const OneLobe& without) {
  const Search search(paint, model);
  double best = std::numeric_limits<double>::infinity();
  OneLobe nearest = without;
  for (const double film_nm : {120, 200, 280, 360, 440, 560}) {
    OneLobe p = without;
    p.film = 0.5, p.film_index = 1.6, p.film_nm = film_nm;
    const double sum = search.descend_from(p, all_of({kStrength, kFilm, kFilmIndex, kFilmThickness}));
    if (sum < best) best = sum, nearest = p;
  }
  return nearest;
}

double rounded(double value) {
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

OneLobe rounded(const OneLobe& parameters) {
  OneLobe p = parameters;
  for (int c = 0; c < 3; ++c) p.base[c] = rounded(p.base[c]), p.specular[c] = rounded(p.specular[c]);
  for (double* value : {&p.strength, &p.roughness, &p.clearcoat, &p.clearcoat_roughness, &p.metalness, &p.film,
                        &p.film_index, &p.film_nm})
    *value = rounded(*value);
  return p;
}

}  // namespace goniochrome::materials
