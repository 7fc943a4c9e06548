// From photographs of a surface to its map: the lobes of every texel.
// goniochrome-surfaces(7), "SPATIALLY VARYING SURFACES".
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "brdf/sbrdf.h"
#include "capture/photo_stack.h"
#include "image/image.h"

namespace goniochrome::capture {

enum class MapMethod { kDictionary, kNonlinear, kBest };

struct MapFitOptions {
  int lobes = 2;  // 1 to 4
  MapMethod method = MapMethod::kBest;
  int holdout = 0;                        // photographs that the fit does not see, spread evenly over the table
  double width = 1;                       // of the surface, in the unit of the table
  double relative_noise = 0.02;           // of a value, one standard deviation, besides its rounding
  bool mend_exposures = false;            // a wrong exposure is corrected; else that photograph is left out
  int tile_rows = 0;                      // rows that are in memory at once; 0: as many as fit into 64 MB
  const image::Image* mask = nullptr;     // one channel counts: 0 is no part of the surface
  const image::Image* normals = nullptr;  // unit normals x y z of the texels; none: the surface is flat
  std::function<void(const std::string& stage, double share)> progress = {};
};

// Results of a fit for one photograph.
struct PhotoFigures {
  double exposure_factor = 1;  // its values over those that the others predict
  bool wrong_exposure = false;
  bool held_out = false;
  double rel_error = 0;  // median
};

// Errors of a method on a sample of texels, a fifth of whose photographs it does not see.
struct MethodFigures {
  MapMethod method = MapMethod::kDictionary;
  double rel_error = 0;  // median over the values that it does not see
  double texel_us = 0;   // time of a texel on one thread, without neighbors
};

struct MapFit {
  brdf::SbrdfTexture map;
  // By texel: 1 inside the mask, else 0; how sure the fit is, 0 to 1; median relative error over its photographs.
  std::vector<float> alpha, certainty, error;
  std::vector<PhotoFigures> photos;
  std::vector<MethodFigures> methods;
  MapMethod method = MapMethod::kDictionary;
  std::size_t texels = 0, uncertain = 0;               // inside the mask
  double rel_error_median = 0, holdout_rel_error = 0;  // over values above three times their rounding
  double left_out_share = 0;                           // values that were taken for shadows or outliers
  double fit_s = 0;
};

// The least number of photographs that a fit of so many lobes takes.
int least_photos(int lobes);

// Fits the map. Error: the photographs cannot tell how the surface reflects (check_stations()); a mask or a picture of
// normals of another size; a normal that looks away; or the stack cannot be read.
Result<MapFit> fit_map(const PhotoTable& table, const PhotoStack& stack, const MapFitOptions& options);

const char* method_name(MapMethod method);

}  // namespace goniochrome::capture
