// Photographs of a mirror ball: where the ball lies in the picture, and the light from all around that it shows. The
// camera is far away, so that every ray to the ball is parallel. goniochrome-prefiltering(7), "ENVIRONMENTS".
#pragma once

#include <string>

#include "base/result.h"
#include "envmap/environment.h"
#include "image/image.h"

namespace goniochrome::envmap {

// The outline where it can be told: in front of a dark ground the circle about what is lit, which may lie anywhere; or
// else, in a square picture, the circle that touches its sides. Error: neither, or what is lit has no round outline.
Result<BallDisc> ball_disc(const image::Image& rgb, const std::string& name);

// A lat-long map of what the ball reflects, about as fine as the picture is in the middle of the ball. The middle of
// the ball shows the camera, which is at +Z; +X is to the right in the picture, and +Y is up. Directions that fall on
// texels at the rim, which the background is mixed into, get what is beside them inside. Error: part of the ball lies
// outside of the picture, or it is less than 4 texels wide.
Result<image::Image> unrolled_ball(const image::Image& rgb, const BallDisc& disc, const std::string& name);

// True if a square picture cannot be an angular map, because light is in three or more of its corners, which lie beyond
// the disc and see nothing.
bool has_lit_corners(const image::Image& rgb);

}  // namespace goniochrome::envmap
