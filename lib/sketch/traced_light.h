// The light under the pixels of a picture as it was traced for them, with shadows and bounced light: what a dropper or
// an edit at a pixel needs to tell the paint from the light.
// goniochrome-transport(7), "TRANSPORT" and goniochrome-sketches(7), "MOOD BOARDS".
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "base/result.h"
#include "color/color.h"
#include "image/aov_file.h"

namespace goniochrome::render {
struct LobeTransport;
}

namespace goniochrome::sketch {

class TracedLight {
 public:
  // The light of buffers that render-osmesa wrote with --aov transport. Error: they hold no transport, or a damaged
  // one.
  static Result<TracedLight> of(const image::AovFile& buffers);

  int width() const;
  int height() const;

  // The light of a matt surface of reflectance 1 in one of R, G and B alone at this pixel (radiance, working space),
  // for each of the three: its color is the sum of them times its reflectances. Bounced light is that of the paints
  // that were worn. Nothing where no surface of the mesh was traced.
  std::optional<std::array<color::Rgb, 3>> diffusers(int x, int y) const;

  // True if this pixel shows a floor onto which the environment is projected, so that no paint is seen there.
  bool shows_floor(int x, int y) const;

  // The aspecular angle (deg) at which one lamp alone would give the flakes of a paint the light that they get at this
  // pixel, relative to the matt base below them. It is the least-squares answer over the lobes of the basis, of which
  // a lamp gives the lobe of exponent E the share cos^E of the angle. Nothing as above, or where the basis has no lobe
  // or the pixel no light.
  std::optional<double> aspecular_deg(int x, int y) const;

 private:
  TracedLight() = default;
  std::optional<std::size_t> point_at(int x, int y) const;

  std::shared_ptr<const render::LobeTransport> transport_;
  color::ReflectionOperator reflection_;
};

}  // namespace goniochrome::sketch
