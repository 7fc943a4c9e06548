#include "render/spots.h"

namespace goniochrome::render {

Light light_of(const envmap::Spot& spot) {
  return {spot.direction, spot.white, spot.radius_rad, {}, false};
}

}  // namespace goniochrome::render
