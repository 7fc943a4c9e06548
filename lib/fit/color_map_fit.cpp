#include "fit/color_map_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::fit {

namespace {

constexpr double kGlare_deg = 10, kGrazing_deg = 75;
constexpr double kSamePlace_deg = 0.2;

// A place on the map as its isoline: the aspecular angle in the coat and the angle of incidence on the flakes.
struct Place {
  double aspecular_deg, incidence_deg;
};
Place place_of(const brdf::FlakeAngles& angles) {
  return {2 * angles.flake_rad / kDegree, angles.incidence_rad / kDegree};
}
double distance(const Place& a, const Place& b) {
  return std::hypot(a.aspecular_deg - b.aspecular_deg, a.incidence_deg - b.incidence_deg);
}

struct Knot {
  Place place;
  color::Lab lab;
};

// The smoothest surface through scattered colors that does not overshoot far from them: a constant plus a cone at each
// knot, Lab(p) = c + sum_i w_i |p - p_i| with sum_i w_i = 0. The system is regular for any distinct knots (|p| is
// conditionally negative definite), and at large distances the surface levels off.
class Cones {
 public:
  explicit Cones(std::vector<Knot> knots) : knots_(std::move(knots)) {
    const Eigen::Index n = static_cast<Eigen::Index>(knots_.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 1, n + 1), colors = Eigen::MatrixXd::Zero(n + 1, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) system(i, j) = distance(place(i), place(j));
      system(i, n) = system(n, i) = 1;
      const color::Lab& lab = knots_[static_cast<std::size_t>(i)].lab;
      colors.row(i) << lab.L, lab.a, lab.b;
    }
    const Eigen::MatrixXd inverse = system.partialPivLu().inverse();
    weights_ = inverse * colors;
    // Left out, knot i is predicted with the error w_i/(A^-1)_ii (Rippa 1999).
    for (Eigen::Index i = 0; i < n; ++i)
      held_out_ += weights_.row(i).norm() / std::abs(inverse(i, i)) / static_cast<double>(n);
  }

  color::Lab at(const Place& p) const {
    const Eigen::Index n = static_cast<Eigen::Index>(knots_.size());
    Eigen::RowVector3d sum = weights_.row(n);
    for (Eigen::Index i = 0; i < n; ++i) sum += distance(place(i), p) * weights_.row(i);
    return {sum[0], sum[1], sum[2]};
  }
  double held_out_de76() const { return held_out_; }

 private:
  const Place& place(Eigen::Index i) const { return knots_[static_cast<std::size_t>(i)].place; }
  std::vector<Knot> knots_;
  Eigen::MatrixXd weights_;
  double held_out_ = 0;
};

// Rows of one place, to a fifth of a degree, become their mean.
std::vector<Knot> merged(const std::vector<Knot>& knots) {
  std::vector<Knot> result;
  std::vector<int> counts;
  for (const Knot& knot : knots) {
    const auto same =
        std::ranges::find_if(result, [&](const Knot& k) { return distance(k.place, knot.place) < kSamePlace_deg; });
    if (same == result.end()) {
      result.push_back(knot), counts.push_back(1);
      continue;
    }
    const int n = ++counts[static_cast<std::size_t>(same - result.begin())];
    same->lab.L += (knot.lab.L - same->lab.L) / n;
    same->lab.a += (knot.lab.a - same->lab.a) / n;
    same->lab.b += (knot.lab.b - same->lab.b) / n;
  }
  return result;
}

// Fills the map, and returns the share of texels with a negative channel.
double fill(brdf::ColorMap& map, const Cones& cones, const color::Xyz& white) {
  const std::size_t rows = static_cast<std::size_t>(map.size) * 2;
  std::vector<int> negative(rows, 0);
  parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (int column = 0; column < map.size; ++column) {
        const brdf::MapDirections d = brdf::map_directions(map.size, column, static_cast<int>(row));
        color::Lab lab = cones.at(place_of(brdf::flake_angles(d.light, d.view, map.index)));
        lab.L = std::max(lab.L, 0.0);
        const color::Rgb rgb = color::rgb_from_lab(lab, white);
        for (int c = 0; c < 3; ++c) map.texel(column, static_cast<int>(row))[c] = static_cast<float>(rgb[c]);
        negative[row] += rgb.x < 0 || rgb.y < 0 || rgb.z < 0;
      }
    }
  });
  return std::accumulate(negative.begin(), negative.end(), 0.0) / static_cast<double>(rows * map.size);
}

}  // namespace

Result<ColorMapFit> fit_color_map(const std::vector<ColorMapRow>& rows, const color::Xyz& white,
                                  const ColorMapOptions& options) {
  ColorMapFit fit;
  std::vector<Knot> knots;
  const double lowest = std::cos(kGrazing_deg * kDegree);
  for (const ColorMapRow& row : rows) {
    if (paint::aspecular_angle_rad(row.light, row.view, {0, 0, 1}) < kGlare_deg * kDegree) {
      ++fit.glare_rows;
    } else if (row.light.z < lowest || row.view.z < lowest) {
      ++fit.grazing_rows;
    } else {
      knots.push_back({place_of(brdf::flake_angles(row.light, row.view, options.index)), row.lab});
      ++fit.rows;
    }
  }
  std::map<long, int> incidences;
  for (const Knot& knot : knots) ++incidences[std::lround(knot.place.incidence_deg)];
  fit.illuminations = static_cast<int>(incidences.size());
  const std::vector<Knot> distinct = merged(knots);
  if (distinct.size() < 4 || fit.illuminations < 2)
    return input_error(
        "a color map takes 4 readings at 2 angles of incidence or more, at least {:g} deg from specular and at most "
        "{:g} deg from the normal: here are {} at {}",
        kGlare_deg, kGrazing_deg, distinct.size(), fit.illuminations);
  const Cones cones(distinct);
  fit.held_out_de76 = cones.held_out_de76();
  fit.map = brdf::color_map_of_size(options.size, options.index);
  fit.negative_share = fill(fit.map, cones, white);
  return fit;
}

Result<ColorMapFit> fit_color_map(const paint::Measurement& measurement, const ColorMapOptions& options) {
  GONIO_ASSIGN(const color::Xyz white, color::white_point(measurement.condition));
  std::vector<ColorMapRow> rows;
  for (const paint::LabReading& reading : measurement.rows) {
    const paint::DirectionPair pair = paint::directions(reading.geometry);
    if (pair.light.z > 0 && pair.view.z > 0) rows.push_back({pair.light, pair.view, reading.lab});
  }
  return fit_color_map(rows, white, options);
}

Result<ColorMapFit> fit_color_map(const brdf::MeasuredBrdf& brdf, const color::ViewingCondition& condition,
                                  const ColorMapOptions& options) {
  constexpr double kStep_deg = 5, kSurelyMeasured_deg = 2.5;
  brdf::MeasuredColorOptions asked{{}, condition, 0, 0};
  for (double light_deg = kStep_deg; light_deg <= kGrazing_deg; light_deg += kStep_deg)
    for (double view_deg = -kGrazing_deg; view_deg <= kGrazing_deg; view_deg += kStep_deg) {
      const double aspecular_deg = light_deg + view_deg;  // the mirror direction is at -light
      if (std::abs(aspecular_deg) >= kGlare_deg) asked.geometries.push_back({light_deg, aspecular_deg});
    }
  GONIO_ASSIGN(const brdf::MeasuredColor color, brdf::measured_color(brdf, asked));
  paint::Measurement measurement{condition, "", {}};
  for (const brdf::MeasuredReading& reading : color.readings)
    if (reading.outside_deg <= kSurelyMeasured_deg) measurement.rows.push_back({reading.geometry, reading.lab});
  return fit_color_map(measurement, options);
}

}  // namespace goniochrome::fit
