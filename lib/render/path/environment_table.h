// Directions drawn in proportion to the light that comes from them. goniochrome-paths(7), "PATHS".
#pragma once

#include <cstdint>
#include <vector>

#include "color/color.h"
#include "envmap/environment.h"
#include "rays/float3.h"

namespace goniochrome::render {

// A direction to light, with the probability of it in 1/sr by which it was drawn and the radiance from there.
struct LightSample {
  rays::Float3 direction;
  float pdf = 0;  // 0: nothing was drawn
  color::Rgb radiance;
};

// The environment's texels with the sum over their channels times their solid angle as weight. Within a texel
// directions are even in its column and row.
class EnvironmentTable {
 public:
  // The environment must outlive the table.
  explicit EnvironmentTable(const envmap::Environment& environment);

  // A direction drawn by numbers in [0,1); its density and light are looked up apart, since most rays need neither.
  struct Place {
    rays::Float3 direction;
    int column = 0, row = 0;
    double density = 0;  // solid angle for each texel there; 0: nothing was drawn
  };
  Place place(double u, double v) const;
  // Begins to fetch what place(u, v) and light() of it will read: the tables are larger than the caches near the
  // processor. For numbers that are known well before the place is asked for.
  void fetch(double u, double v) const;
  LightSample light(const Place& place) const;
  LightSample drawn(double u, double v) const { return light(place(u, v)); }
  // The probability density by which drawn() gives this direction, and the radiance that comes from there: that of the
  // texel that the direction falls in.
  LightSample at(const rays::Float3& direction) const;

  bool dark() const { return !(total_ > 0); }
  // (integral L)^2 / integral L^2, sr, of the mean over channels: 4 pi for an even environment, a lamp's own size where
  // it outshines all else.
  double extent_sr() const { return extent_sr_; }

 private:
  LightSample light(const rays::Float3& direction, int column, int row, double density) const;
  int row_at(double u) const;
  const float* cumulative(std::size_t row) const { return &columns_[row * (static_cast<std::size_t>(width_) + 1)]; }
  double cube_density(const rays::Float3& direction, int column, int row) const;

  const envmap::Environment* environment_;
  int width_ = 0, height_ = 0;
  double total_ = 0, extent_sr_ = 0;
  std::vector<double> row_solid_angle_, row_cosine_;  // of a lat-long map: of a texel, and of the rows' upper edges
  std::vector<double> rows_;                          // cumulative share of the rows, height + 1
  std::vector<float> columns_;                        // cumulative share within each row, width + 1 each
  std::vector<double> edges_;                         // of a cube: of the cells of a face, -1..1; width + 1
  // For each of equal steps of a number the interval where a search for it begins.
  std::vector<std::uint16_t> row_guide_, column_guide_;
};

}  // namespace goniochrome::render
