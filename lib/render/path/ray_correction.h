// Draws the effects of rays on a picture that an engine made without them: at each sample of a pixel what the mesh
// changes of its light. goniochrome-plan(7), "Effects of rays".
#pragma once

#include <array>
#include <optional>

#include "image/image.h"
#include "render/effects.h"
#include "render/path/path_tracer.h"

namespace goniochrome::render {

// The paths that find what these effects change, reconstructed. Effects that change little stop after the first round.
PathRequest correction_request(const RayEffects& effects, int bounces, double tolerance_de00);

// How the effects were drawn; of several bands of a picture the means over their points, and the errors of all points.
struct CorrectionNoise {
  double de00_p95 = 0;        // of the size of the errors that rays leave
  double error_de00_p95 = 0;  // and of all errors of the picture
  double samples = 0;         // rays' samples of a visible point, in all
  double free_share = 0;
  double ms = 0;
  bool reached = true;  // whether all errors are within the tolerance
  bool dark = false;    // whether the mesh changes nothing at all
  // The change by each of the effects, in the order of plans, and whether the first pass was its last.
  std::array<FoundShare, kShareCount> found;

  double points = 0;  // that these are means over
  PointErrors drawn;  // of them

  // Adds a band that was drawn after these, of which the rows from `first` up to `last` are kept.
  void add(const PathPicture& one, int first, int last);
};

// The background around the mesh of a picture with a floor that shows the environment.
struct Backdrop {
  Background background = Background::kNone;
  color::Rgb color;
  const envmap::Environment* environment = nullptr;

  color::Rgb at(const rays::Float3& direction) const;
};

// A picture shows these beside the mesh: the floor, whose ground is shaded, or, above the horizon, the background.
struct MeshSurroundings {
  const Transport& transport;
  Backdrop backdrop;
  RayEffects effects;

  // The light of a pixel; nothing where that shows the mesh, or no background.
  std::optional<color::Rgb> at(const Gbuffer& gbuffer, int x, int y) const;
  // The mean of that light over these samples of a pixel.
  color::Rgb mean(PixelSamples samples, int x, int y) const;
  // Adds `gain` times that light at each of these samples of the pixels, and its coverage.
  void add(PixelSamples samples, float gain, image::Image& picture) const;
  // The change of the background by the floor, at 95 of 100 pixels that show it: CIEDE2000 to the backdrop.
  double floor_change(const Gbuffer& gbuffer, double white_luminance) const;
};

// Adds the correction, the mean over these samples of each pixel, to the first three channels of the picture, which
// holds radiance times coverage.
// `before` is the picture without corrections; it tells how visible noise is. Bit-identical for any number of threads.
PathPicture add_correction(const Transport& transport, PixelSamples samples, const PathRequest& request,
                           const image::Image& before, image::Image& picture);

}  // namespace goniochrome::render
