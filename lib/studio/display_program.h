// The program by which a page shows light on its screen: the view "Paint" of display/paint_view.h in the shading
// language of OpenGL ES 3.
#pragma once

#include <string>

namespace goniochrome::studio {

// A fragment shader with the uniforms `picture` (scene-linear radiance, premultiplied, its first row at the top),
// `share`, which a sum of samples is multiplied by, `gain`, and `rows`, the height of the picture. What covers nothing
// shows a gray backdrop, as pictures of render-osmesa do.
std::string display_program();

}  // namespace goniochrome::studio
