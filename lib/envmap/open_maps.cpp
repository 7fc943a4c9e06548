#include "envmap/open_maps.h"

#include <algorithm>

#include "base/parallel.h"
#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"
#include "envmap/internal/weighted_diffuse.h"
#include "math/elementary.h"

namespace goniochrome::envmap {

namespace {

// Takes away from every texel what `of_spot` has of a spot in that direction.
template <class OfSpot>
void take_out(const std::vector<Spot>& spots, const OfSpot& of_spot, CubeMap& map) {
  if (spots.empty()) return;
  parallel_for(static_cast<std::size_t>(6 * map.size), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int face = static_cast<int>(i) / map.size, row = static_cast<int>(i) % map.size;
      for (int column = 0; column < map.size; ++column) {
        const Vec3 direction = cube_direction(face, column + 0.5, row + 0.5, map.size);
        float* texel = map.at(face, row, column);
        for (std::size_t k = 0; k < spots.size(); ++k) {
          const double share = of_spot(k, direction);
          if (share == 0) continue;
          for (int c = 0; c < 3; ++c) texel[c] -= static_cast<float>(share * spots[k].white[c]);
        }
      }
    }
  });
}

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
        if (dot(direction, spots[k].direction) < farthest[k]) return 0.0;
        const brdf::DiscLobeTable::Node gathered = tables[k]->at(length(direction - spots[k].direction));
        return 0.5 * (exponent + 1) * (gathered.plain[0] + gathered.plain[1]);
      },
      map);
  return map;
}

CubeMap diffuse_without_spots(CubeMap map, bool coated, const std::vector<Spot>& spots) {
  const double even = brdf::mean_coat_transmission(brdf::kCoatIndex);
  std::vector<double> sines;
  for (const Spot& spot : spots) sines.push_back(math::sin(spot.radius_rad));
  take_out(
      spots,
      [&](std::size_t k, const Vec3& normal) {
        const double cosine = dot(normal, spots[k].direction), radius = spots[k].radius_rad;
        if (cosine <= -sines[k]) return 0.0;
        const bool whole = cosine >= sines[k];  // above the horizon
        const double irradiance = whole ? cosine : brdf::disc_irradiance(cosine, radius);
        if (!coated || !(irradiance > 0)) return irradiance;
        const double mean_cosine = whole ? cosine : std::min(1.0, irradiance / brdf::disc_above(cosine, radius));
        return irradiance * brdf::coat_transmission(mean_cosine, brdf::kCoatIndex) / even;
      },
      map);
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
  env.open_coat_diffuse = open_coat_diffuse_map(env, spots);
  env.diffuse.open = open_diffuse_map(env, spots);
  for (PrefilteredLobe& lobe : env.lobes) lobe.open = open_map(env, lobe, spots);
}

}  // namespace goniochrome::envmap
