// The pixels at which the effects of rays are measured. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <memory>
#include <vector>

#include "render/plan.h"

namespace goniochrome::render {

// Up to `count` pixels of which each shows something, one by chance of each of as many equal parts of a curve that
// fills the pictures: what repeats along rows or columns is met as often as it is there, and pixels that are near each
// other in the list are so in the picture.
std::vector<ProbePixel> spread_pixels(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count);

}  // namespace goniochrome::render
