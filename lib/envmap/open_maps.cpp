#include "envmap/open_maps.h"

#include <algorithm>
#include <array>

#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"
#include "envmap/internal/weighted_diffuse.h"
#include "math/elementary.h"

namespace goniochrome::envmap {

namespace {

// Takes away from every texel of each map, which are of one size, what `of_spot` has for that map of a spot in that
// direction.
template <std::size_t kMaps, class OfSpot>
void take_out(const std::vector<Spot>& spots, const OfSpot& of_spot, const std::array<CubeMap*, kMaps>& maps) {
  if (spots.empty()) return;
  for_texels(maps[0]->size, [&](int face, int row, int column, const Vec3& direction) {
    for (std::size_t k = 0; k < spots.size(); ++k) {
      const std::array<double, kMaps> shares = of_spot(k, direction);
      for (std::size_t j = 0; j < kMaps; ++j) {
        if (shares[j] == 0) continue;
        float* texel = maps[j]->at(face, row, column);
        for (int c = 0; c < 3; ++c) texel[c] -= static_cast<float>(shares[j] * spots[k].white[c]);
      }
    }
  });
}

// Light of the spots in the diffuse map and in that under a coat.
class DiffuseOfSpots {
 public:
  explicit DiffuseOfSpots(const std::vector<Spot>& spots) : spots_(spots) {
    for (const Spot& spot : spots) sines_.push_back(math::sin(spot.radius_rad));
  }

  std::array<double, 1> plain(std::size_t k, const Vec3& normal) const {
    return {irradiance(k, dot(normal, spots_[k].direction))};
  }
  std::array<double, 1> coated(std::size_t k, const Vec3& normal) const { return {both(k, normal)[1]}; }
  std::array<double, 2> both(std::size_t k, const Vec3& normal) const {
    const double cosine = dot(normal, spots_[k].direction), plain = irradiance(k, cosine);
    if (!(plain > 0)) return {plain, plain};
    const double mean_cosine =
        is_whole(k, cosine) ? cosine : std::min(1.0, plain / brdf::disc_above(cosine, spots_[k].radius_rad));
    return {plain, plain * brdf::coat_transmission(mean_cosine, brdf::kCoatIndex) / even_};
  }

 private:
  // True if all of the spot is above the horizon.
  bool is_whole(std::size_t k, double cosine) const { return cosine >= sines_[k]; }
  double irradiance(std::size_t k, double cosine) const {
    if (cosine <= -sines_[k]) return 0;
    return is_whole(k, cosine) ? cosine : brdf::disc_irradiance(cosine, spots_[k].radius_rad);
  }

  const std::vector<Spot>& spots_;
  std::vector<double> sines_;
  double even_ = brdf::mean_coat_transmission(brdf::kCoatIndex);
};

}  // namespace

// P_E has (E+1)/(2 pi) times what the lobe gathers of each.
CubeMap without_spots(CubeMap map, double exponent, const std::vector<Spot>& spots) {
  std::vector<std::shared_ptr<const brdf::DiscLobeTable>> tables;
  std::vector<double> farthest;  // the cosine beyond which a lobe gathers nothing of the spot
  for (const Spot& spot : spots) {
    tables.push_back(brdf::disc_lobe_table(exponent, spot.radius_rad));
    const double chord = tables.back()->last_chord();
    farthest.push_back(1 - 0.5 * chord * chord);
  }
  take_out(
      spots,
      [&](std::size_t k, const Vec3& direction) {
        if (dot(direction, spots[k].direction) < farthest[k]) return std::array{0.0};
        const brdf::DiscLobeTable::Node gathered = tables[k]->at(length(direction - spots[k].direction));
        return std::array{0.5 * (exponent + 1) * (gathered.plain[0] + gathered.plain[1])};
      },
      std::array{&map});
  return map;
}

CubeMap diffuse_without_spots(CubeMap map, bool coated, const std::vector<Spot>& spots) {
  const DiffuseOfSpots diffuse(spots);
  const std::array maps{&map};
  if (coated)
    take_out(spots, [&](std::size_t k, const Vec3& normal) { return diffuse.coated(k, normal); }, maps);
  else
    take_out(spots, [&](std::size_t k, const Vec3& normal) { return diffuse.plain(k, normal); }, maps);
  return map;
}

namespace {

std::vector<Spot> first_spots(const PrefilteredEnvironment& env, std::size_t count) {
  return {env.spots.begin(), env.spots.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

MapPointer plain_map(const PrefilteredLobe& lobe) {
  return {MapPointer(), &lobe.map};
}

MapPointer coat_diffuse_map(const PrefilteredEnvironment& env) {
  if (env.coat_diffuse != nullptr) return env.coat_diffuse;
  return std::make_shared<const CubeMap>(
      weighted_diffuse(env, [](double c) { return brdf::coat_transmission(c, brdf::kCoatIndex); }));
}

MapPointer open_map(const PrefilteredEnvironment& env, const PrefilteredLobe& lobe, std::size_t spots) {
  if (spots == 0) return plain_map(lobe);
  if (lobe.open != nullptr && spots == env.spots.size()) return lobe.open;
  return std::make_shared<const CubeMap>(without_spots(lobe.map, lobe.exponent, first_spots(env, spots)));
}

MapPointer open_diffuse_map(const PrefilteredEnvironment& env, std::size_t spots) {
  if (spots == 0) return plain_map(env.diffuse);
  if (env.diffuse.open != nullptr && spots == env.spots.size()) return env.diffuse.open;
  return std::make_shared<const CubeMap>(diffuse_without_spots(env.diffuse.map, false, first_spots(env, spots)));
}

MapPointer open_coat_diffuse_map(const PrefilteredEnvironment& env, std::size_t spots) {
  const MapPointer whole = coat_diffuse_map(env);
  if (spots == 0) return whole;
  if (env.open_coat_diffuse != nullptr && spots == env.spots.size()) return env.open_coat_diffuse;
  return std::make_shared<const CubeMap>(diffuse_without_spots(*whole, true, first_spots(env, spots)));
}

void keep_open_maps(PrefilteredEnvironment& env) {
  if (env.diffuse.map.size == 0) return;
  env.coat_diffuse = coat_diffuse_map(env);
  const std::size_t spots = env.spots.size();
  if (spots == 0) return;
  if (env.open_coat_diffuse == nullptr && env.diffuse.open == nullptr) {
    // Both of them at once, for the price of one.
    CubeMap plain = env.diffuse.map, coated = *env.coat_diffuse;
    const DiffuseOfSpots diffuse(env.spots);
    take_out(
        env.spots, [&](std::size_t k, const Vec3& normal) { return diffuse.both(k, normal); },
        std::array{&plain, &coated});
    env.diffuse.open = std::make_shared<const CubeMap>(std::move(plain));
    env.open_coat_diffuse = std::make_shared<const CubeMap>(std::move(coated));
  }
  env.open_coat_diffuse = open_coat_diffuse_map(env, spots);
  env.diffuse.open = open_diffuse_map(env, spots);
  for (PrefilteredLobe& lobe : env.lobes) lobe.open = open_map(env, lobe, spots);
}

}  // namespace goniochrome::envmap
