// How much light a model sends elsewhere than a measured BRDF does. goniochrome-theory(7), FITTING.
#pragma once

#include <functional>
#include <optional>

#include "brdf/measured.h"
#include "color/color.h"

namespace goniochrome::fit {

// f in 1/sr, working space, for unit directions above the surface.
using BrdfModel = std::function<color::Rgb(const Vec3& to_light, const Vec3& to_viewer)>;

// The integral of |model - measured| cos_o over the directions of the viewer, specular included: the mean over lights
// at 0, 10, ..., 80 deg from the normal and over the channels of linear Rec.709, in which most such files are. Negative
// measurements count as 0; what was not measured is left out. Quadrature error 2 %. Nothing where the file holds
// scattered directions, between which a spike is lost. Error: as ChannelColorimeter::make().
Result<std::optional<double>> albedo_error(const brdf::MeasuredBrdf& measured, const BrdfModel& model);

}  // namespace goniochrome::fit
