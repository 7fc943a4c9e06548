// Pictures of scene-linear light as a display shows them, by a view that has a name. Whoever uses it loads
// OpenColorIO; paint_view.h has the arithmetic of the default view, which is shown without it.
// goniochrome-rendering(7), "RENDERING".
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/byte_image.h"
#include "image/image.h"

namespace goniochrome::display {

// The way from light to one display by one view. Built in is an sRGB display with the views "Paint", "ACES SDR" and
// "Un-tone-mapped". Where $OCIO is set, the displays and views are those of that configuration; "View" names a view of
// its default display, and "Display/View" one of any display.
class Display {
 public:
  // An empty `view` is the default one. Upper and lower case are the same, and name() names a view too. Error: there is
  // no such view, and the message lists those there are.
  static Result<Display> make(const std::string& view);
  Display(Display&&) noexcept;
  ~Display();

  // The picture (R G B A, working space, premultiplied) times 2^stops in front of a backdrop of 18 % gray, as RGB
  // signals in 0..1. Error: a pixel is not finite.
  Result<image::Image> image(const image::Image& picture, double stops) const;

  // Shows a picture as 8 bits, rounded to the nearest, into `shown`, whose memory is used again. The view "Paint" is
  // exact here and takes 10 ns a pixel. `shown.signal` is that of the display, or none where its name does not tell.
  Result<void> show(const image::Image& picture, double stops, image::ByteImage& shown) const;

  // Brings the signals of the display, R G B in 0..1, back to light in the working space, exposed as it was shown, by
  // the exact inverse of Paint and the inverse that OpenColorIO has of other views. Error: it has none.
  Result<void> undo(image::Image& signals) const;

  // "sRGB / Paint"
  const std::string& name() const;

 private:
  struct State;
  explicit Display(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace goniochrome::display
