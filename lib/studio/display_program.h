// The program by which a page shows light on its screen: the view "Paint" of display/paint_view.h in the shading
// language of OpenGL ES 3.
#pragma once

#include <string>
#include <vector>

#include "display/paint_view.h"

namespace goniochrome::studio {

// A fragment shader with the uniforms `picture` (scene-linear radiance, premultiplied, its first row at the top),
// `share`, which a sum of samples is multiplied by, `gain`, `to_screen`, and `rows`, the height of the picture. What
// covers nothing shows a gray backdrop, as pictures of render-osmesa do.
std::string display_program();

// The matrix `to_screen`, column by column; the signal curve of all screens is the same.
std::vector<double> to_screen(display::Screen screen);

// The fragment program that draws over a picture where its surface is seen at 15 and at 45 degrees from the mirror
// direction of a light and at the travel, as rings in yellow, blue and pink, and the highlight of the light as a
// checker. It reads the G-buffer. OpenGL ES 3. [Shimizu2009] 3.6.1
std::string overlay_program();

}  // namespace goniochrome::studio
