// The bright part of an environment as a few discs, such as its sun, its windows and its lamps. What is bright and
// small can then be cut by the horizon of each point, and asked for by single rays.
// goniochrome-prefiltering(7), "ENVIRONMENTS".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "envmap/environment.h"

namespace goniochrome::envmap {

// A disc of even radiance that has as much light as a part of the environment, about the same mean direction and as
// widely spread about it.
struct Spot {
  Vec3 direction{0, 1, 0};  // to its middle, unit
  color::Rgb white;         // the radiance of a white diffuser that faces it: irradiance / pi
  double radius_rad = 0;    // above 0, up to a right angle

  bool operator==(const Spot&) const = default;
};

// The light that exceeds a few times the mean radiance, in at most `most` discs: the part that is spread most is cut in
// two across its longer axis until all are compact. None where nothing is that bright, or where it is all around.
constexpr int kMostSpots = 32, kUsualSpots = 12;
std::vector<Spot> bright_spots(const Environment& environment, int most = kUsualSpots);

// The radiance, as the mean of the channels, beyond which light is in a spot.
double bright_level(const Environment& environment);

// An environment with a sun: most of what is very bright lies within a few degrees, above the horizon.
struct SunlitSky {
  Spot sun;
  Environment sky;  // what is left of the environment: together they have its light
};
// None where the environment has no such sun, or where it gives little of the light.
std::optional<SunlitSky> sunlit_sky(const Environment& environment);

// Spots as files keep them: seven numbers to a spot. Error: what is wrong with the text, without its place.
std::string text_of_spots(const std::vector<Spot>& spots);
Result<std::vector<Spot>> spots_of_text(const std::string& text);

}  // namespace goniochrome::envmap
