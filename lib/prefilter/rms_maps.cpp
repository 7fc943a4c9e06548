#include "prefilter/rms_maps.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::prefilter {

namespace {

// Errors of mean squares, by the maps and by the look-up in them: a root mean square has half of each.
constexpr double kTolerance = 1e-2, kLookupTolerance = 4e-3;
constexpr int kMostRows = 256;

// The mean square of the radiance up to a level, on a lat-long grid that is no finer than lobes need. Cells that no
// texel has its center in show the texel that they lie in.
envmap::Environment squared(const envmap::Environment& from, double level) {
  const int rows = std::clamp(static_cast<int>(kPi / std::max(1e-9, from.largest_texel_rad())), 16, kMostRows),
            columns = 2 * rows;
  const envmap::SphereGrid grid(envmap::SphereGrid::Layout::kLatLong, columns, rows);
  const auto square = [&](const float* rgb) {
    const double mean = (static_cast<double>(rgb[0]) + rgb[1] + rgb[2]) / 3, scale = mean > level ? level / mean : 1;
    const Vec3 left{scale * rgb[0], scale * rgb[1], scale * rgb[2]};
    return Vec3{left.x * left.x, left.y * left.y, left.z * left.z};
  };
  const auto cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
             width = static_cast<std::size_t>(from.width());
  std::vector<int> cell_of(width * static_cast<std::size_t>(from.height()), -1);
  parallel_for(static_cast<std::size_t>(from.height()), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * width; i < end * width; ++i) {
      const int column = static_cast<int>(i % width), row = static_cast<int>(i / width);
      if (from.solid_angle(column, row) > 0) cell_of[i] = static_cast<int>(grid.texel(from.direction(column, row)));
    }
  });
  std::vector<Vec3> sums(cells);
  std::vector<double> weights(cells);
  for (std::size_t i = 0; i < cell_of.size(); ++i) {
    if (cell_of[i] < 0) continue;
    const int column = static_cast<int>(i % width), row = static_cast<int>(i / width);
    const double weight = from.solid_angle(column, row);
    sums[static_cast<std::size_t>(cell_of[i])] += weight * square(from.radiance(column, row));
    weights[static_cast<std::size_t>(cell_of[i])] += weight;
  }
  image::Image image = image::even_image(columns, rows, 3, {"R", "G", "B"});
  for (std::size_t i = 0; i < cells; ++i) {
    const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
    const Vec3 mean = weights[i] > 0 ? (1 / weights[i]) * sums[i] : square(from.lookup(grid.direction(column, row)));
    for (int c = 0; c < 3; ++c) image.data[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(mean[c]);
  }
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kZero, from.source());
}

}  // namespace

// Where there are no spots, nothing was taken out of the maps, and nothing is here.
void keep_rms_maps(const envmap::Environment& environment, const PrefilterRequest& request,
                   envmap::PrefilteredEnvironment& env) {
  PrefilterRequest squares;
  squares.mirror = squares.diffuse = false, squares.spots = 0;
  squares.tolerance = kTolerance, squares.turn = request.turn;
  for (const envmap::PrefilteredLobe& lobe : env.lobes) {
    squares.exponents.push_back(lobe.exponent);
    squares.sizes.push_back(std::min(lobe.map.size, own_size(lobe.exponent, kLookupTolerance)));
  }
  if (squares.exponents.empty()) return;
  const envmap::Environment light =
      squared(environment, env.spots.empty() ? INFINITY : envmap::bright_level(environment));
  const envmap::PrefilteredEnvironment made =
      prefiltered(light, squares, prefilter_plan(light, squares), [](const envmap::PrefilteredLobe&, double) {});
  for (std::size_t i = 0; i < env.lobes.size(); ++i) {
    envmap::CubeMap map = made.lobes[i].map;
    for (float& value : map.texels) value = std::sqrt(std::max(0.0F, value));
    env.lobes[i].rms = std::make_shared<const envmap::CubeMap>(std::move(map));
  }
}

}  // namespace goniochrome::prefilter
