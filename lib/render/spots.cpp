#include "render/spots.h"

#include <algorithm>
#include <memory>

#include "base/parallel.h"
#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render {

namespace {

// Takes away from every texel what `of_spot` has of a spot in that direction.
template <class OfSpot>
void take_out(const std::vector<envmap::Spot>& spots, const OfSpot& of_spot, envmap::CubeMap& map) {
  if (spots.empty()) return;
  parallel_for(static_cast<std::size_t>(6 * map.size), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int face = static_cast<int>(i) / map.size, row = static_cast<int>(i) % map.size;
      for (int column = 0; column < map.size; ++column) {
        const Vec3 direction = envmap::cube_direction(face, column + 0.5, row + 0.5, map.size);
        float* texel = map.at(face, row, column);
        for (std::size_t k = 0; k < spots.size(); ++k) {
          const double share = of_spot(k, direction);
          for (int c = 0; c < 3; ++c) texel[c] -= static_cast<float>(share * spots[k].white[c]);
        }
      }
    }
  });
}

}  // namespace

Light light_of(const envmap::Spot& spot) {
  return {spot.direction, spot.white, spot.radius_rad, {}, false};
}

// P_E has (E+1)/(2 pi) times what the lobe gathers of each.
envmap::CubeMap without_spots(envmap::CubeMap map, double exponent, const std::vector<envmap::Spot>& spots) {
  std::vector<std::shared_ptr<const brdf::DiscLobeTable>> tables;
  for (const envmap::Spot& spot : spots) tables.push_back(brdf::disc_lobe_table(exponent, spot.radius_rad));
  take_out(
      spots,
      [&](std::size_t k, const Vec3& direction) {
        const brdf::DiscLobeTable::Node gathered = tables[k]->at(length(direction - spots[k].direction));
        return 0.5 * (exponent + 1) * (gathered.plain[0] + gathered.plain[1]);
      },
      map);
  return map;
}

envmap::CubeMap diffuse_without_spots(envmap::CubeMap map, bool coated, const std::vector<envmap::Spot>& spots) {
  const double even = brdf::mean_coat_transmission(brdf::kCoatIndex);
  take_out(
      spots,
      [&](std::size_t k, const Vec3& normal) {
        const double cosine = dot(normal, spots[k].direction), radius = spots[k].radius_rad;
        const double irradiance = brdf::disc_irradiance(cosine, radius);
        if (!coated || !(irradiance > 0)) return irradiance;
        const double mean_cosine = std::min(1.0, irradiance / brdf::disc_above(cosine, radius));
        return irradiance * brdf::coat_transmission(mean_cosine, brdf::kCoatIndex) / even;
      },
      map);
  return map;
}

}  // namespace goniochrome::render
