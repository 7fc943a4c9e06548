// From scene-linear radiance to a display, by a named view. goniochrome-theory(7), RENDERING.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "image/image.h"

namespace goniochrome::display {

// The default view: exact colors up to kKnee of display white, then a shoulder on the largest channel, so that a
// highlight grows brighter without changing hue. Takes and gives linear Rec.709; what lies outside its gamut is mixed
// with the gray of its luminance until it does not.
constexpr double kKnee = 0.8;
color::Rgb paint_view(const color::Rgb& rec709);

// A way to a display: the built-in sRGB one with the views "Paint", "ACES SDR" and "Un-tone-mapped", or, where $OCIO is
// set, the views of that configuration ("View" on its default display, or "Display/View"). Loads OpenColorIO.
class Display {
 public:
  // `view` may be empty for the default, and is matched without regard to case. Error: the views there are.
  static Result<Display> make(const std::string& view);
  Display(Display&&) noexcept;
  ~Display();

  // The picture (R G B A, working space, premultiplied) times 2^stops as RGB in 0..1, before a backdrop of 18 % gray.
  Result<image::Image> image(const image::Image& picture, double stops) const;

  // "sRGB / Paint"
  const std::string& name() const;

 private:
  struct State;
  explicit Display(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace goniochrome::display
