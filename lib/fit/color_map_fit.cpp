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
  double aspecular_air_deg = 0;
  std::vector<ColorMapRow> rows = {};  // of which this is the mean
};

// A surface through scattered colors that does not overshoot far from them: a constant plus a cone at each knot,
// Lab(p) = c + sum_i w_i |p - p_i|^power with sum_i w_i = 0 and 0 < power <= 1. The system is regular for any distinct
// knots (|p|^power is conditionally negative definite). At large distances the surface levels off, which it would not
// do for larger powers. A power of 1 is the smoothest; smaller ones tell less of a color to its neighbors.
class Cones {
 public:
  Cones(std::vector<Knot> knots, double power) : knots_(std::move(knots)), power_(power) {
    const Eigen::Index n = static_cast<Eigen::Index>(knots_.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 1, n + 1), colors = Eigen::MatrixXd::Zero(n + 1, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) system(i, j) = cone(distance(place(i), place(j)));
      system(i, n) = system(n, i) = 1;
      const color::Lab& lab = knots_[static_cast<std::size_t>(i)].lab;
      colors.row(i) << lab.L, lab.a, lab.b;
    }
    const Eigen::MatrixXd inverse = system.partialPivLu().inverse();
    weights_ = inverse * colors;
    // Left out, knot i is predicted with the error w_i/(A^-1)_ii (Rippa 1999).
    for (Eigen::Index i = 0; i < n; ++i) held_out_.push_back(weights_.row(i).norm() / std::abs(inverse(i, i)));
  }

  color::Lab at(const Place& p) const {
    const Eigen::Index n = static_cast<Eigen::Index>(knots_.size());
    Eigen::RowVector3d sum = weights_.row(n);
    for (Eigen::Index i = 0; i < n; ++i) sum += cone(distance(place(i), p)) * weights_.row(i);
    return {sum[0], sum[1], sum[2]};
  }
  double nearest_deg(const Place& p) const {
    double nearest = distance(knots_.front().place, p);
    for (const Knot& knot : knots_) nearest = std::min(nearest, distance(knot.place, p));
    return nearest;
  }
  // For each knot, the difference from what all others predict.
  const std::vector<double>& held_out_de76() const { return held_out_; }
  double sum_held_out_de76() const { return std::accumulate(held_out_.begin(), held_out_.end(), 0.0); }
  double power() const { return power_; }

 private:
  const Place& place(Eigen::Index i) const { return knots_[static_cast<std::size_t>(i)].place; }
  double cone(double distance_deg) const { return power_ == 1 ? distance_deg : std::pow(distance_deg, power_); }
  std::vector<Knot> knots_;
  double power_;
  Eigen::MatrixXd weights_;
  std::vector<double> held_out_;
};

// The cones of the power that predicts left-out knots best. Powers are tried from 1 downward as long as that helps.
Cones best_cones(const std::vector<Knot>& knots, std::optional<double> power) {
  Cones best(knots, power.value_or(1));
  for (const double smaller : {0.75, 0.5}) {
    if (power) break;
    Cones next(knots, smaller);
    if (!(next.sum_held_out_de76() < best.sum_held_out_de76())) break;
    best = std::move(next);
  }
  return best;
}

// The rival: the color as a function of the aspecular angle in air, a straight line through the neighbors of each
// angle. They are weighted by a bell curve, whose width is the one that predicts left-out knots best.
class AspecularCurve {
 public:
  explicit AspecularCurve(std::vector<Knot> knots) : knots_(std::move(knots)) {
    for (const Knot& knot : knots_) {
      lowest_deg_ = std::min(lowest_deg_, knot.aspecular_air_deg);
      highest_deg_ = std::max(highest_deg_, knot.aspecular_air_deg);
    }
    double least = 0;
    for (const double width_deg : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 20.0}) {
      std::vector<double> errors;
      for (std::size_t i = 0; i < knots_.size(); ++i)
        errors.push_back(color::delta_e_76(line_at(knots_[i].aspecular_air_deg, width_deg, i), knots_[i].lab));
      const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
      if (!held_out_.empty() && !(sum < least)) continue;
      least = sum, held_out_ = std::move(errors), width_deg_ = width_deg;
    }
  }

  // Beyond the outermost readings their color is held.
  color::Lab at(double aspecular_deg) const {
    return line_at(std::clamp(aspecular_deg, lowest_deg_, highest_deg_), width_deg_, knots_.size());
  }
  double nearest_deg(double aspecular_deg) const {
    double nearest = 180;
    for (const Knot& knot : knots_) nearest = std::min(nearest, std::abs(knot.aspecular_air_deg - aspecular_deg));
    return nearest;
  }
  const std::vector<double>& held_out_de76() const { return held_out_; }

 private:
  color::Lab line_at(double at_deg, double width_deg, std::size_t left_out) const {
    double w0 = 0, w1 = 0, w2 = 0, y0[3] = {}, y1[3] = {};
    for (std::size_t i = 0; i < knots_.size(); ++i) {
      if (i == left_out) continue;
      const double x = knots_[i].aspecular_air_deg - at_deg;
      constexpr double kFloor = 1e-12;  // far from all knots the line of all of them is left
      const double w = std::exp(-0.5 * x * x / (width_deg * width_deg)) + kFloor;
      const double lab[3] = {knots_[i].lab.L, knots_[i].lab.a, knots_[i].lab.b};
      w0 += w, w1 += w * x, w2 += w * x * x;
      for (int c = 0; c < 3; ++c) y0[c] += w * lab[c], y1[c] += w * x * lab[c];
    }
    const double determinant = w0 * w2 - w1 * w1;
    double got[3];
    for (int c = 0; c < 3; ++c)
      got[c] = determinant > 1e-9 * w0 * w2 ? (w2 * y0[c] - w1 * y1[c]) / determinant : y0[c] / w0;
    return {got[0], got[1], got[2]};
  }

  std::vector<Knot> knots_;
  double lowest_deg_ = 180, highest_deg_ = 0, width_deg_ = 0;
  std::vector<double> held_out_;
};

// Rows of one place, to a fifth of a degree, become their mean.
std::vector<Knot> merged(const std::vector<Knot>& knots) {
  std::vector<Knot> result;
  for (const Knot& knot : knots) {
    const auto same =
        std::ranges::find_if(result, [&](const Knot& k) { return distance(k.place, knot.place) < kSamePlace_deg; });
    if (same == result.end()) {
      result.push_back(knot);
      continue;
    }
    same->rows.insert(same->rows.end(), knot.rows.begin(), knot.rows.end());
    const auto n = static_cast<double>(same->rows.size());
    same->lab.L += (knot.lab.L - same->lab.L) / n;
    same->lab.a += (knot.lab.a - same->lab.a) / n;
    same->lab.b += (knot.lab.b - same->lab.b) / n;
    same->aspecular_air_deg += (knot.aspecular_air_deg - same->aspecular_air_deg) / n;
  }
  return result;
}

double aspecular_deg(const Vec3& light, const Vec3& view) {
  return paint::aspecular_angle_rad(light, view, {0, 0, 1}) / kDegree;
}

// Fills the map, and returns the share of texels with a negative channel.
double fill(brdf::ColorMap& map, const Cones& cones, const AspecularCurve& curve, const color::Xyz& white) {
  const std::size_t rows = static_cast<std::size_t>(map.size) * 2;
  std::vector<int> negative(rows, 0);
  map.distance_deg.assign(rows * static_cast<std::size_t>(map.size), 0);
  parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (int column = 0; column < map.size; ++column) {
        const brdf::MapDirections d = brdf::map_directions(map.size, column, static_cast<int>(row));
        const Place place = place_of(brdf::flake_angles(d.light, d.view, map.index));
        const double angle_deg = aspecular_deg(d.light, d.view);
        color::Lab lab = map.aspecular ? curve.at(angle_deg) : cones.at(place);
        lab.L = std::max(lab.L, 0.0);
        const color::Rgb rgb = color::rgb_from_lab(lab, white);
        for (int c = 0; c < 3; ++c) map.texel(column, static_cast<int>(row))[c] = static_cast<float>(rgb[c]);
        map.distance_deg[row * static_cast<std::size_t>(map.size) + static_cast<std::size_t>(column)] =
            static_cast<float>(map.aspecular ? curve.nearest_deg(angle_deg) : cones.nearest_deg(place));
        negative[row] += rgb.x < 0 || rgb.y < 0 || rgb.z < 0;
      }
    }
  });
  return std::accumulate(negative.begin(), negative.end(), 0.0) / static_cast<double>(rows * map.size);
}

bool is_beyond_critical(const brdf::FlakeAngles& angles, double index) {
  constexpr double kRounding_rad = 1e-9;
  return angles.flake_rad + angles.incidence_rad > std::asin(1 / index) + kRounding_rad;
}

// The usable rows: those that the map goes through, and those that it is only compared with, because they have no place
// on the map or are not to be part of it.
struct Usable {
  std::vector<Knot> knots;
  std::vector<ColorMapRow> others;
};

void sort_row(const ColorMapRow& row, bool into_map, const ColorMapOptions& options, Usable& usable, ColorMapFit& fit) {
  const double lowest = std::cos(kGrazing_deg * kDegree) - 1e-9, angle_deg = aspecular_deg(row.light, row.view);
  const bool glare = angle_deg < kGlare_deg, grazing = row.light.z < lowest || row.view.z < lowest;
  if (glare || grazing) {
    if (into_map) ++(glare ? fit.glare_rows : fit.grazing_rows);
    return;
  }
  const brdf::FlakeAngles angles = brdf::flake_angles(row.light, row.view, options.index);
  if (!into_map || is_beyond_critical(angles, options.index)) {
    if (into_map) ++fit.beyond_rows;
    usable.others.push_back(row);
    return;
  }
  usable.knots.push_back({place_of(angles), row.lab, angle_deg, {row}});
  ++fit.rows;
}

// A real row, and how far the predictions of both models from other rows are from it.
struct Compared {
  ColorMapRow row;
  double isolines_de76, aspecular_de76;
};

std::vector<Compared> comparisons(const Usable& usable, const std::vector<Knot>& knots, const Cones& cones,
                                  const AspecularCurve& curve, double index) {
  std::vector<Compared> all;
  for (std::size_t i = 0; i < knots.size(); ++i)
    for (const ColorMapRow& row : knots[i].rows)
      all.push_back({row, cones.held_out_de76()[i], curve.held_out_de76()[i]});
  for (const ColorMapRow& row : usable.others) {
    const brdf::InPlaneAngles in_plane =
        brdf::equivalent_in_plane_angles(row.light, row.view, index, brdf::CriticalAngle::kSlide);
    const auto direction = [](double angle_rad) { return Vec3{std::sin(angle_rad), 0, std::cos(angle_rad)}; };
    const Place place =
        place_of(brdf::flake_angles(direction(in_plane.light_rad), direction(in_plane.view_rad), index));
    all.push_back({row, color::delta_e_76(cones.at(place), row.lab),
                   color::delta_e_76(curve.at(aspecular_deg(row.light, row.view)), row.lab)});
  }
  return all;
}

// The standard error of the mean of isolines_de76 - aspecular_de76, from the sums over the rows of each light: with n
// rows of mean m under L lights, (L/(L-1) sum_l (sum_l d - n_l m)^2)^(1/2)/n.
std::optional<double> difference_error(const std::vector<Compared>& all, double mean) {
  std::map<long, double> lights;  // by their angle from the normal, to a degree
  for (const Compared& one : all)
    lights[std::lround(std::acos(std::clamp(one.row.light.z, -1.0, 1.0)) / kDegree)] +=
        one.isolines_de76 - one.aspecular_de76 - mean;
  if (lights.size() < 2) return std::nullopt;
  double squares = 0;
  for (const auto& [light, sum] : lights) squares += sum * sum;
  const auto count = static_cast<double>(lights.size());
  return std::sqrt(count / (count - 1) * squares) / static_cast<double>(all.size());
}

// Takes the model that predicts rows from others better.
void choose_model(const std::vector<Compared>& all, const ColorMapOptions& options, ColorMapFit& fit) {
  fit.compared_rows = static_cast<int>(all.size());
  for (const Compared& one : all)
    fit.isolines_de76 += one.isolines_de76 / fit.compared_rows,
        fit.aspecular_de76 += one.aspecular_de76 / fit.compared_rows;
  fit.difference_error_de76 = difference_error(all, fit.isolines_de76 - fit.aspecular_de76);
  fit.map.aspecular = options.model == ColorMapModel::kAspecular ||
                      (options.model == ColorMapModel::kBetter && fit.aspecular_de76 < fit.isolines_de76);
  fit.held_out_de76 = fit.map.aspecular ? fit.aspecular_de76 : fit.isolines_de76;
}

// `checks` are rows that the map does not go through and is compared with.
Result<ColorMapFit> fit_checked(const std::vector<ColorMapRow>& rows, const std::vector<ColorMapRow>& checks,
                                const color::Xyz& white, const ColorMapOptions& options) {
  ColorMapFit fit;
  Usable usable;
  for (const ColorMapRow& row : rows) sort_row(row, true, options, usable, fit);
  for (const ColorMapRow& row : checks) sort_row(row, false, options, usable, fit);
  std::map<long, int> incidences;
  for (const Knot& knot : usable.knots) ++incidences[std::lround(knot.place.incidence_deg)];
  fit.illuminations = static_cast<int>(incidences.size());
  const std::vector<Knot> distinct = merged(usable.knots);
  if (distinct.size() < 4 || fit.illuminations < 2)
    return input_error(
        "a color map takes 4 readings at 2 angles of incidence or more, at least {:g} deg from specular and at most "
        "{:g} deg from the normal: here are {} at {}",
        kGlare_deg, kGrazing_deg, distinct.size(), fit.illuminations);
  const Cones cones = best_cones(distinct, options.isolines_power);
  fit.isolines_power = cones.power();
  const AspecularCurve curve(distinct);
  fit.map = brdf::color_map_of_size(options.size, options.index);
  choose_model(comparisons(usable, distinct, cones, curve, options.index), options, fit);
  fit.negative_share = fill(fit.map, cones, curve, white);
  return fit;
}

// The colors of a file at pairs of directions, without those for which it has nothing near.
Result<std::vector<ColorMapRow>> measured_rows(const brdf::MeasuredBrdf& brdf, const brdf::ChannelColorimeter& meter,
                                               const std::vector<paint::DirectionPair>& pairs) {
  constexpr double kSurelyMeasured_deg = 2.5;
  std::vector<ColorMapRow> rows;
  for (const paint::DirectionPair& pair : pairs) {
    brdf::MeasuredValue value = brdf.value(pair.light, pair.view);
    if (!value.measured || value.outside_deg > kSurelyMeasured_deg) continue;
    for (double& f : value.f) f *= kPi;
    brdf::take_off_noise(brdf.traits(), value.f);
    const color::Lab lab = color::lab_from_xyz(meter.xyz(value.f), meter.white());
    if (!std::isfinite(lab.L + lab.a + lab.b)) return input_error("its data give no finite value: the file is damaged");
    rows.push_back({pair.light, pair.view, lab});
  }
  return rows;
}

// Pairs in plane, 5 deg apart.
std::vector<paint::DirectionPair> pairs_in_plane() {
  constexpr double kStep_deg = 5;
  const auto direction = [](double angle_deg) {
    return Vec3{std::sin(angle_deg * kDegree), 0, std::cos(angle_deg * kDegree)};
  };
  std::vector<paint::DirectionPair> pairs;
  for (double light_deg = kStep_deg; light_deg <= kGrazing_deg; light_deg += kStep_deg)
    for (double view_deg = -kGrazing_deg; view_deg <= kGrazing_deg; view_deg += kStep_deg)
      pairs.push_back({direction(light_deg), direction(view_deg)});
  return pairs;
}

}  // namespace

Result<ColorMapFit> fit_color_map(const std::vector<ColorMapRow>& rows, const color::Xyz& white,
                                  const ColorMapOptions& options) {
  return fit_checked(rows, {}, white, options);
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
  GONIO_ASSIGN(const auto meter, brdf::ChannelColorimeter::make(brdf.traits(), condition));
  if (brdf.traits().scattered) {
    GONIO_ASSIGN(const auto rows, measured_rows(brdf, meter, brdf.samples()));
    return fit_checked(rows, {}, meter.white(), options);
  }
  GONIO_ASSIGN(const auto rows, measured_rows(brdf, meter, pairs_in_plane()));
  std::vector<paint::DirectionPair> beside = brdf.samples();
  std::erase_if(beside, [](const paint::DirectionPair& pair) {
    return std::abs(cross(pair.light, pair.view).z) < 1e-3;  // what the map goes through
  });
  GONIO_ASSIGN(const auto checks, measured_rows(brdf, meter, beside));
  return fit_checked(rows, checks, meter.white(), options);
}

}  // namespace goniochrome::fit
