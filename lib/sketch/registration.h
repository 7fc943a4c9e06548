// Where the buffers of a rendering lie in a scan of it, which has another size and was laid on the scanner by hand.
// goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include "base/result.h"
#include "image/aov_file.h"
#include "sketch/sketch_picture.h"

namespace goniochrome::sketch {

// The similarity from pixels of the buffers to those of the scan, about the middles of both:
//   scan = middle of scan + shift + scale R(turn) (buffers - middle of buffers),
// with y downward, so that a positive turn is clockwise as seen.
struct Registration {
  double scale = 1, turn_deg = 0;
  double shift_x = 0, shift_y = 0;  // pixels of the scan
  // The correlation of the edges of both pictures, -1..1, over what both show.
  double agreement = 0;
};

// The largest turn that is looked for. Scales are looked for from 0.75 to 1.15 of that at which the buffers just fit
// into the scan.
inline constexpr double kMostTurn_deg = 5;

// The similarity at which the edges of the buffers' own picture and of the scan meet best. Colors play no part, so the
// paint may have been changed. Error: no similarity makes the edges agree, as where the scan shows something else.
Result<Registration> registration_of(const image::AovFile& buffers, const Picture& scan);

// The scan as it looks in the pixels of the buffers: the mean light over the place of each. A pixel whose place is
// partly clipped or transparent is so itself, and one whose place is beyond the scan is transparent.
Picture registered(const Picture& scan, const Registration& registration, int width, int height);

// The registered mask: its first channel.
image::Image registered(const image::Image& mask, const Registration& registration, int width, int height);

}  // namespace goniochrome::sketch
