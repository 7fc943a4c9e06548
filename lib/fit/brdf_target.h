// Measured BRDFs as fits see them: reflectance factors of the working space at thousands of pairs of directions, in the
// plane of incidence and out of it; and how far a model of a BRDF is from what was measured.
// goniochrome-fitting(7), "FITTING".
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/result.h"
#include "brdf/measured.h"
#include "color/color.h"
#include "paint/paint.h"

namespace goniochrome::fit {

// A measurement at one pair of directions. All file formats are isotropic, so three angles tell the pair.
struct BrdfSample {
  double aspecular_rad = 0;            // from specular
  double light_deg = 0, view_deg = 0;  // from the normal
  color::Rgb value;                    // reflectance factor in the working space; channels may be negative
};

// The unit directions of a sample in the frame whose z is the normal and whose x points to the light.
paint::DirectionPair directions_of(const BrdfSample& sample);

// The cosine of half the angle between light and viewer.
double half_angle_cosine(const BrdfSample& sample);

struct BrdfTarget {
  paint::Paint paint;  // its name, and what a five-angle instrument would have read, D65/2
  std::vector<BrdfSample> samples;
  std::shared_ptr<const brdf::MeasuredBrdf> source = {};  // where the BRDF was read from a file
  std::vector<std::string> remarks = {};                  // then: reasons to doubt what the file says
};

// The samples of a measured BRDF, and its readings at 15, 25, 45, 75 and 110 deg. Both are seen under D65 by the 2 deg
// observer, to whom the working space belongs. Error: the data give a value that is not finite, or none at all.
Result<BrdfTarget> brdf_target(const std::string& name, const brdf::MeasuredBrdf& brdf);

// Reads a file of a measured BRDF. The paint gets the name of the file without its folder and ending.
Result<BrdfTarget> read_brdf_target(InputFile& file);

// A model of a BRDF: f in 1/sr, working space, for unit directions above the surface in the frame whose z is the
// normal.
using BrdfModel = std::function<color::Rgb(const Vec3& to_light, const Vec3& to_viewer)>;

// How much light a model sends elsewhere than the measured BRDF does: the integral of |model - measured| cos_o over the
// directions of the viewer, specular included. It is the mean over lights at 0, 10, ..., 80 deg from the normal and
// over the channels of linear Rec.709, in which most such files are. Negative measurements count as 0, and directions
// that were not measured are left out. The quadrature is exact to 2 %. The result is empty where the file holds
// scattered directions, because a spike may be lost between them. Error: as brdf::ChannelColorimeter::make().
Result<std::optional<double>> albedo_error(const brdf::MeasuredBrdf& measured, const BrdfModel& model);

}  // namespace goniochrome::fit
