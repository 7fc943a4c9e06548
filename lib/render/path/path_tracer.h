// Pictures by paths: samples go where the picture is noisy, until its noise is below a tolerance or the time is up.
// goniochrome-paths(7), "PATHS".
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "image/image.h"
#include "render/path/found_shares.h"
#include "render/path/noise.h"
#include "render/path/pixel_pieces.h"
#include "render/path/transport.h"

namespace goniochrome::render {

struct PathRequest {
  PathOptions options = {};
  double tolerance_de00 = 0.5;  // of the picture's errors; 0: until another limit ends it
  // The errors that the picture has beside its noise, at any points of the mesh. Where they leave less than half of the
  // tolerance to the noise, samples end at that half.
  std::vector<double> beside_de00 = {};
  // The errors of the points that were drawn of the picture before; null: none. Samples end where these points or all
  // together are within the tolerance.
  const PointErrors* before = nullptr;
  // The shares of light that together change no more than this in the first round get no further samples, and their
  // pixels stay as they are: a part of the tolerance. 0: none stops, nor is told.
  double stop_de00 = 0;
  double time_limit_s = 0;     // 0: none
  int most_samples = 1 << 16;  // of a pixel
  double white_luminance = 1;  // what noise is seen before
  std::uint64_t seed = 1;
  // Tells what a pixel shows beside the mesh, as the mean over its samples; null: not known.
  std::function<color::Rgb(int x, int y)> beside_mesh = {};
  // The number of samples of a pixel, as sample_shifts() has them; with 1 the pixel centers are seen. Paths are spread
  // over them.
  int pixel_samples = 1;
  // If set, reconstruction() smooths the light along the surface, and the noise is the error that it measures.
  bool reconstruct = false;
  // The first round of such a picture samples at least so many of its points, and all at edges; neighbors tell others.
  std::size_t first_points = kFirstPoints;
  // Told after each round: the errors so far, and the seconds.
  std::function<void(double error_de00, double seconds)> progress = {};
};

// The light of one visible point; with several samples in a pixel, the mean over all of them, of which those that see
// nothing are black.
struct PathPoint {
  int x = 0, y = 0;
  float coverage = 1;     // share of the pixel's samples that see the scene or its floor
  bool floor = false;     // whether all that they see is the floor
  color::Rgb radiance;    // with PathOptions::correction: what to add to the radiance without the mesh in the way
  Covariance covariance;  // of the error of `radiance`; smoothed with that of its neighbors while samples are few
  double noise_de00 = 0;  // of one standard deviation
  int samples = 0;        // 0 where none were needed
};

struct PathPicture {
  std::vector<PathPoint> points;  // of the visible surface, row by row
  // The 95th percentile over the points of the mesh or over those of the floor, whichever is larger: a large floor that
  // is easy to draw does not hide the mesh. Of the noise, one standard deviation, or, of a reconstructed picture, of
  // the size of its errors.
  double noise_p95_de00 = 0;
  double noise_mean_de00 = 0;
  double error_p95_de00 = 0;  // the same of all errors; of a picture that is not reconstructed the noise
  double samples_mean = 0;    // of all points
  double free_share = 0;      // of points that needed no samples
  double time_s = 0;
  bool reached = false;                       // whether its errors are within the tolerance
  bool dark = true;                           // whether no point shows any light at all
  std::array<FoundShare, kShareCount> found;  // with PathRequest::stop_de00
};

// `base`: with PathOptions::correction what the points show without the mesh in the way, R G B in the first channels of
// each pixel; it tells how visible noise is, and is not added. Null: black. Bit-identical for any number of threads
// while no time limit ends it.
// `samples` are what the samples of the pixels see; paths are spread over them. The points of a surface may be others
// than those that rays find. PathRequest::pixel_samples counts where there is one surface.
PathPicture path_picture(const Transport& transport, PixelSamples samples, const image::Image* base,
                         const PathRequest& request);
inline PathPicture path_picture(const Transport& transport, const Gbuffer& surface, const image::Image* base,
                                const PathRequest& request) {
  const Gbuffer* one = &surface;
  return path_picture(transport, PixelSamples(&one, 1), base, request);
}

}  // namespace goniochrome::render
