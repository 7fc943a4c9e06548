#include "paint/curve.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "math/elementary.h"

namespace goniochrome::paint {

namespace {

// How far toward the face the clamped quadratic is at an angle: 1 at 15 deg, 0 from the travel on.
double face_weight(double travel_deg, double aspecular_deg) {
  if (aspecular_deg >= travel_deg) return 0;
  const double part = (travel_deg - aspecular_deg) / (travel_deg - kFaceAngle_deg);
  return part * part;
}

using Channels = std::array<double, 3>;
Channels channels(const color::Lab& lab) {
  return {lab.L, lab.a, lab.b};
}
color::Lab lab_of(const Channels& c) {
  return {c[0], c[1], c[2]};
}

// A point to be fitted, and the fit at one travel.
struct Sample {
  double aspecular_deg;
  Channels value;
  double weight = 1;
};
struct Fit {
  Channels face{}, flop{};
  double travel_deg = 60;
  double squares = 0;  // sum of weighted squared differences over samples and channels
};

double sum_of_weights(const std::vector<Sample>& samples) {
  double sum = 0;
  for (const Sample& sample : samples) sum += sample.weight;
  return sum;
}

// For fixed travel each channel is a straight line in the weight w: value = flop + (face - flop) w. Regression on
// w - mean(w), which does not cancel; where w is the same for all samples, only the mean is known and the color is
// constant.
Fit fit_at(double travel_deg, const std::vector<Sample>& samples) {
  const double n = sum_of_weights(samples);
  double mean_w = 0;
  Channels mean{};
  for (const Sample& sample : samples) {
    const double share = sample.weight / n;
    mean_w += share * face_weight(travel_deg, sample.aspecular_deg);
    for (int c = 0; c < 3; ++c) mean[c] += share * sample.value[c];
  }
  double spread = 0;
  Channels covariance{};
  for (const Sample& sample : samples) {
    const double w = face_weight(travel_deg, sample.aspecular_deg) - mean_w;
    spread += sample.weight * w * w;
    for (int c = 0; c < 3; ++c) covariance[c] += sample.weight * w * (sample.value[c] - mean[c]);
  }
  Fit fit;
  fit.travel_deg = travel_deg;
  for (int c = 0; c < 3; ++c) {
    const double slope = spread > 0 ? covariance[c] / spread : 0;
    fit.flop[c] = mean[c] - slope * mean_w;
    fit.face[c] = fit.flop[c] + slope;
  }
  for (const Sample& sample : samples) {
    const double w = face_weight(travel_deg, sample.aspecular_deg);
    for (int c = 0; c < 3; ++c) {
      const double miss = sample.value[c] - (fit.flop[c] + (fit.face[c] - fit.flop[c]) * w);
      fit.squares += sample.weight * miss * miss;
    }
  }
  return fit;
}

// The sum of squares that fit_at() leaves, without the fit: total - sum over channels of covariance^2 / spread. Quick,
// and good to a part in 1e-16 of the total, which is what a scan needs. `samples` have channel means of 0.
double squares_at(double travel_deg, const std::vector<Sample>& samples, double total) {
  double sum_w = 0, sum_ww = 0;
  Channels covariance{};
  for (const Sample& sample : samples) {
    const double way = std::max(0.0, travel_deg - sample.aspecular_deg), w = way * way;
    sum_w += sample.weight * w;
    sum_ww += sample.weight * w * w;
    for (int c = 0; c < 3; ++c) covariance[c] += sample.weight * w * sample.value[c];
  }
  const double spread = sum_ww - sum_w * sum_w / sum_of_weights(samples);
  if (!(spread > 0)) return total;
  double explained = 0;
  for (int c = 0; c < 3; ++c) explained += covariance[c] * covariance[c];
  return total - explained / spread;
}

// Gauss-Newton in the travel, with face and flop solved for at every step (variable projection). A step is
//   dT = sum j r / sum j j,   j = (face - flop) dw/dT less its own part in span{1, w},   w ~ (T - t)^2
// so that residuals r shrink quadratically where the curve is exact. Stays in [low,high]; stops where a step gains
// nothing.
Fit refined(Fit best, double low, double high, const std::vector<Sample>& samples) {
  for (int i = 0; i < 20 && best.squares > 0; ++i) {
    const double n = sum_of_weights(samples), unit = best.travel_deg - kFaceAngle_deg;
    double mean_w = 0, mean_d = 0;
    const auto weight = [&](const Sample& s) { return face_weight(best.travel_deg, s.aspecular_deg); };
    const auto slope = [&](const Sample& s) {
      return 2 * std::max(0.0, best.travel_deg - s.aspecular_deg) / unit / unit;
    };
    for (const Sample& sample : samples)
      mean_w += sample.weight * weight(sample) / n, mean_d += sample.weight * slope(sample) / n;
    double ww = 0, wd = 0;
    for (const Sample& sample : samples) {
      const double w = weight(sample) - mean_w;
      ww += sample.weight * w * w;
      wd += sample.weight * w * (slope(sample) - mean_d);
    }
    double jr = 0, jj = 0;
    for (const Sample& sample : samples) {
      const double w = weight(sample), d = slope(sample) - mean_d - (ww > 0 ? wd / ww : 0) * (w - mean_w);
      for (int c = 0; c < 3; ++c) {
        const double rise = best.face[c] - best.flop[c], j = rise * d;
        jr += sample.weight * j * (sample.value[c] - best.flop[c] - rise * w);
        jj += sample.weight * j * j;
      }
    }
    if (!(jj > 0)) break;
    const Fit next = fit_at(std::clamp(best.travel_deg + jr / jj, low, high), samples);
    if (!(next.squares < best.squares)) break;
    best = next;
  }
  return best;
}

// The nearest clamped quadratic, travel scanned from 15.5 to 180 deg in half degrees and refined around the best. The
// angles of the samples, where a sample joins the plateau, are half degrees on real instruments.
//
// If several travels fit equally well, as between the first two angles of an instrument that starts at 15 deg, the
// largest is taken, since it extrapolates least. Two angles alone never fix the travel; the plateau then begins at the
// larger one.
Fit nearest(const std::vector<Sample>& samples) {
  constexpr double kStep = 0.5, kFirst = kFaceAngle_deg + kStep, kLast = 180;
  const auto [least, most] = std::ranges::minmax(samples, {}, &Sample::aspecular_deg);
  const bool constant = std::ranges::all_of(samples, [&](const Sample& s) { return s.value == samples.front().value; });
  if (constant) return {samples.front().value, samples.front().value, 60, 0};
  const bool two_angles =
      std::ranges::all_of(samples, [&, low = least.aspecular_deg, high = most.aspecular_deg](const Sample& s) {
        return s.aspecular_deg == low || s.aspecular_deg == high;
      });
  if (two_angles) return fit_at(most.aspecular_deg > kFaceAngle_deg ? most.aspecular_deg : 60, samples);

  std::vector<Sample> centered = samples;
  Channels mean{};
  const double weights = sum_of_weights(samples);
  for (const Sample& sample : samples)
    for (int c = 0; c < 3; ++c) mean[c] += sample.weight * sample.value[c] / weights;
  double total = 0;
  for (Sample& sample : centered)
    for (int c = 0; c < 3; ++c) {
      sample.value[c] -= mean[c];
      total += sample.weight * sample.value[c] * sample.value[c];
    }
  double travel_deg = kFirst, squares = squares_at(kFirst, centered, total);
  for (double travel = kFirst + kStep; travel <= kLast; travel += kStep) {
    const double here = squares_at(travel, centered, total);
    if (here > squares + 1e-12 * total) continue;
    squares = std::min(squares, here);
    travel_deg = travel;
  }
  const Fit best = fit_at(travel_deg, samples);
  const Fit fine = refined(best, std::max(kFirst, travel_deg - kStep), std::min(kLast, travel_deg + kStep), samples);
  return fine.squares < best.squares * (1 - 1e-12) ? fine : best;
}

}  // namespace

color::Lab lab_at(const Appearance& appearance, double aspecular_deg) {
  const double w = face_weight(appearance.travel_deg, aspecular_deg);
  const Channels face = channels(appearance.face), flop = channels(appearance.flop);
  Channels value;
  for (int c = 0; c < 3; ++c) value[c] = flop[c] + (face[c] - flop[c]) * w;
  return lab_of(value);
}

Result<void> check(const Appearance& appearance) {
  if (appearance.travel_deg > kFaceAngle_deg && appearance.travel_deg <= 180) return {};
  return input_error("travel is {}: give an angle above 15 and up to 180 deg", shortest(appearance.travel_deg));
}

double extrapolation_at_specular(const Appearance& appearance) {
  return face_weight(appearance.travel_deg, 0);
}

double ChannelCurve::at(double aspecular_deg) const {
  return flop + (face - flop) * face_weight(travel_deg, aspecular_deg);
}

// With the plateau at or before 110 deg, flop = q110 and face = q15, and at 45 deg
//   s = (q45 - q110)/(q15 - q110) = ((theta_t - 45)/(theta_t - 15))^2,
// which gives theta_t = (45 - 15 sqrt(s))/(1 - sqrt(s)).
// Otherwise all three points lie on the parabola, whose vertex is theta_t. In Newton's form with q15 = 1, q110 = 0:
//   q(t) = 1 + d (t - 15) + c (t - 15)(t - 45),  d = (s - 1)/30,  c = (-s/65 - d)/95,  q'(t) = 0 at t = 30 - d/(2 c).
ChannelCurve channel_curve(double at_15, double at_45, double at_110) {
  if (at_15 == at_45 && at_45 == at_110) return {at_15, at_15, 60, true};
  const double s = at_15 == at_110 ? -1 : (at_45 - at_110) / (at_15 - at_110);
  if (s >= 0 && s < 1) {
    const double root = std::sqrt(s), travel = (45 - 15 * root) / (1 - root);
    if (travel <= 110) return {at_15, at_110, travel, true};
    const double d = (s - 1) / 30, c = (-s / 65 - d) / 95, vertex = 30 - d / (2 * c);
    if (c > 0 && vertex <= 180) {
      const double plateau = 1 + (vertex - 15) * (d + c * (vertex - 45));
      return {at_15, at_110 + (at_15 - at_110) * plateau, vertex, true};
    }
  }
  return nearest_channel_curve({{15, at_15}, {45, at_45}, {110, at_110}});
}

ChannelCurve nearest_channel_curve(const std::vector<ChannelValue>& values) {
  std::vector<Sample> samples;
  for (const ChannelValue& v : values) samples.push_back({v.aspecular_deg, {v.value, 0, 0}, v.weight});
  const Fit fit = nearest(samples);
  return {fit.face[0], fit.flop[0], fit.travel_deg, fit.squares == 0};
}

Result<AppearanceFit> appearance_from_rows(const std::vector<LabReading>& rows) {
  if (rows.empty()) return input_error("there are no Lab values to fit: measure at least one geometry");
  const bool in_plane = std::ranges::any_of(rows, [](const LabReading& r) { return !r.geometry.out_of_plane; });
  const auto is_fitted = [&](const LabReading& r) { return !in_plane || !r.geometry.out_of_plane; };
  std::vector<Sample> samples;
  for (const LabReading& row : rows)
    if (is_fitted(row)) samples.push_back({aspecular_angle_deg(row.geometry), channels(row.lab)});

  const Fit fit = nearest(samples);
  AppearanceFit result;
  result.appearance = {lab_of(fit.face), lab_of(fit.flop), fit.travel_deg, 0.0};
  for (const LabReading& row : rows) {
    const double de00 = color::delta_e_2000(row.lab, lab_at(result.appearance, aspecular_angle_deg(row.geometry)));
    result.de00.push_back(de00);
    if (is_fitted(row)) result.appearance.residual_de00 = std::max(*result.appearance.residual_de00, de00);
  }
  return result;
}

std::vector<LabReading> rows_of(const Appearance& appearance) {
  std::vector<LabReading> rows;
  for (const double angle : kExportAngles_deg) rows.push_back({{.aspecular_deg = angle}, lab_at(appearance, angle)});
  return rows;
}

namespace {

struct MeanRow {
  double aspecular_deg = 0;
  Channels value{};
};

// The in-plane rows by unsigned aspecular angle, ascending; rows at the same angle (45as15 and 45as-15) are averaged.
std::vector<MeanRow> in_plane_means(const std::vector<LabReading>& rows) {
  std::vector<MeanRow> single;
  for (const LabReading& row : rows)
    if (!row.geometry.out_of_plane) single.push_back({aspecular_angle_deg(row.geometry), channels(row.lab)});
  std::ranges::stable_sort(single, {}, &MeanRow::aspecular_deg);
  std::vector<MeanRow> means;
  for (auto first = single.begin(); first != single.end();) {
    const auto last = std::find_if(first, single.end(),
                                   [&](const MeanRow& r) { return r.aspecular_deg > first->aspecular_deg + 1e-9; });
    MeanRow mean{first->aspecular_deg};
    for (auto row = first; row != last; ++row)
      for (int c = 0; c < 3; ++c) mean.value[c] += row->value[c] / static_cast<double>(last - first);
    means.push_back(mean);
    first = last;
  }
  return means;
}

// The slope at an end, from the three points there, held to the sense of the first interval so that the curve does not
// overshoot. h and d are the widths and slopes of the first and second interval.
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  if (d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

// Slopes of the monotone piecewise cubic: the weighted harmonic mean of the neighboring intervals' slopes, 0 at an
// extremum. [Fritsch1984]
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> slopes(n, 0);
  if (n < 2) return slopes;
  std::vector<double> h(n - 1), d(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) h[i] = x[i + 1] - x[i], d[i] = (y[i + 1] - y[i]) / h[i];
  if (n == 2) return {d[0], d[0]};
  slopes.front() = end_slope(h[0], h[1], d[0], d[1]);
  slopes.back() = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (d[i - 1] * d[i] <= 0) continue;
    const double before = 2 * h[i] + h[i - 1], after = h[i] + 2 * h[i - 1];
    slopes[i] = (before + after) / (before / d[i - 1] + after / d[i]);
  }
  return slopes;
}

// The quadratic of one channel. Each value is weighted by the range of angles up to halfway to its neighbors. Otherwise
// the readings near specular, which instruments take close together, would decide the flop.
ChannelCurve quadratic_through(const std::vector<double>& angle_deg, const std::vector<double>& value) {
  std::vector<ChannelValue> values;
  const std::size_t last = angle_deg.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double width = angle_deg[std::min(i + 1, last)] - angle_deg[i > 0 ? i - 1 : 0];
    values.push_back({angle_deg[i], value[i], last > 0 ? width / 2 : 1});
  }
  return nearest_channel_curve(values);
}

std::array<ChannelCurve, 3> quadratics_of(const Appearance& a) {
  return {ChannelCurve{a.face.L, a.flop.L, a.travel_deg},
          {a.face.a, a.flop.a, a.travel_deg},
          {a.face.b, a.flop.b, a.travel_deg}};
}

}  // namespace

Result<TargetCurve> TargetCurve::make(const Paint& paint, Kind kind) {
  TargetCurve curve;
  const std::vector<LabReading> none;
  const auto& rows = paint.measurement ? paint.measurement->rows : none;
  const std::vector<MeanRow> means = in_plane_means(rows);
  for (const MeanRow& mean : means) {
    curve.known_deg_.push_back(mean.aspecular_deg);
    for (int c = 0; c < 3; ++c) curve.value_[c].push_back(mean.value[c]);
  }
  curve.kind_ = kind == Kind::kMeasured && !means.empty() ? Kind::kMeasured : Kind::kCurve;
  if (curve.kind_ == Kind::kMeasured) {
    for (const double angle : curve.known_deg_) curve.place_.push_back(curve_place(angle));
    for (int c = 0; c < 3; ++c) curve.slope_[c] = monotone_slopes(curve.place_, curve.value_[c]);
    return curve;
  }
  if (paint.appearance) {
    GONIO_TRY(check(*paint.appearance));
    curve.quadratic_ = quadratics_of(*paint.appearance);
  } else if (!means.empty()) {
    for (int c = 0; c < 3; ++c) curve.quadratic_[c] = quadratic_through(curve.known_deg_, curve.value_[c]);
  } else if (!rows.empty()) {
    GONIO_ASSIGN(const AppearanceFit fit, appearance_from_rows(rows));
    curve.quadratic_ = quadratics_of(fit.appearance);
  } else {
    return input_error("paint \"{}\" has no color: give it a measurement or an appearance", shown(paint.name));
  }
  if (means.empty()) curve.known_deg_.assign(kExportAngles_deg.begin(), kExportAngles_deg.end());
  return curve;
}

// No offset from 0 to 10 deg predicts left-out readings clearly better than another; from 20 deg on, they become worse.
// The offset keeps the place finite at specular.
constexpr double kPlaceOffset_deg = 5;

double curve_place(double aspecular_deg) {
  return math::log(aspecular_deg + kPlaceOffset_deg);
}

double angle_of_place_deg(double place) {
  return math::exp(place) - kPlaceOffset_deg;
}

double curve_place_slope(double aspecular_deg) {
  return 1 / (aspecular_deg + kPlaceOffset_deg);
}

// Hermite's cubic on the interval that holds the angle.
color::Lab TargetCurve::at(double aspecular_deg) const {
  if (kind_ == Kind::kCurve)
    return {quadratic_[0].at(aspecular_deg), quadratic_[1].at(aspecular_deg), quadratic_[2].at(aspecular_deg)};
  const double t = std::clamp(aspecular_deg, known_deg_.front(), known_deg_.back());
  const auto above = std::ranges::upper_bound(known_deg_, t);
  const std::size_t last = known_deg_.size() - 1;
  const std::size_t i = above == known_deg_.end() ? last : static_cast<std::size_t>(above - known_deg_.begin()) - 1;
  if (t == known_deg_[i]) return {value_[0][i], value_[1][i], value_[2][i]};
  const double h = place_[i + 1] - place_[i], u = (curve_place(t) - place_[i]) / h, v = 1 - u;
  Channels value;
  for (int c = 0; c < 3; ++c) {
    const double rise = value_[c][i + 1] - value_[c][i];
    value[c] = value_[c][i] + u * u * (3 - 2 * u) * rise + h * u * v * (v * slope_[c][i] - u * slope_[c][i + 1]);
  }
  return lab_of(value);
}

}  // namespace goniochrome::paint
