#include "paint/curve.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace goniochrome {

namespace {

// How far toward the face the clamped quadratic is at an angle: 1 at 15 deg, 0 from the travel on.
double face_weight(double travel_deg, double aspecular_deg) {
  if (aspecular_deg >= travel_deg) return 0;
  const double part = (travel_deg - aspecular_deg) / (travel_deg - kFaceAngle_deg);
  return part * part;
}

using Channels = std::array<double, 3>;
Channels channels(const Lab& lab) {
  return {lab.L, lab.a, lab.b};
}
Lab lab_of(const Channels& c) {
  return {c[0], c[1], c[2]};
}

// A point to be fitted, and what fits it at one travel.
struct Sample {
  double aspecular_deg;
  Channels value;
};
struct Fit {
  Channels face{}, flop{};
  double travel_deg = 60;
  double squares = 0;  // sum of squared differences over samples and channels
};

// For fixed travel each channel is a straight line in the weight w: value = flop + (face - flop) w. Regression on
// w - mean(w), which does not cancel; where w is the same for all samples, only the mean is known and the color is
// constant.
Fit fit_at(double travel_deg, const std::vector<Sample>& samples) {
  const auto n = static_cast<double>(samples.size());
  double mean_w = 0;
  Channels mean{};
  for (const Sample& sample : samples) {
    mean_w += face_weight(travel_deg, sample.aspecular_deg) / n;
    for (int c = 0; c < 3; ++c) mean[c] += sample.value[c] / n;
  }
  double spread = 0;
  Channels covariance{};
  for (const Sample& sample : samples) {
    const double w = face_weight(travel_deg, sample.aspecular_deg) - mean_w;
    spread += w * w;
    for (int c = 0; c < 3; ++c) covariance[c] += w * (sample.value[c] - mean[c]);
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
      fit.squares += miss * miss;
    }
  }
  return fit;
}

// The least sum of squares in [low,high] by golden section, to the precision of a double.
Fit refined(double low, double high, const std::vector<Sample>& samples) {
  constexpr double kGolden = 0.6180339887498949;
  Fit left = fit_at(high - kGolden * (high - low), samples), right = fit_at(low + kGolden * (high - low), samples);
  for (int i = 0; i < 80 && high - low > 1e-14 * high; ++i) {
    if (left.squares < right.squares) {
      high = right.travel_deg;
      right = left;
      left = fit_at(high - kGolden * (high - low), samples);
    } else {
      low = left.travel_deg;
      left = right;
      right = fit_at(low + kGolden * (high - low), samples);
    }
  }
  return left.squares < right.squares ? left : right;
}

// The nearest clamped quadratic, travel scanned from 15.5 to 180 deg in half degrees and refined around the best. The
// angles of the samples, where a sample joins the plateau, are half degrees on real instruments.
//
// Where travel does not matter, as between the first two angles of an instrument that starts at 15 deg, the largest is
// taken: it extrapolates least. Two angles alone never fix the travel: the plateau then begins at the wider one.
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

  Fit best = fit_at(kFirst, samples);
  for (double travel = kFirst + kStep; travel <= kLast; travel += kStep) {
    const Fit fit = fit_at(travel, samples);
    if (fit.squares <= best.squares * (1 + 1e-12)) best = fit;
  }
  const Fit fine =
      refined(std::max(kFirst, best.travel_deg - kStep), std::min(kLast, best.travel_deg + kStep), samples);
  return fine.squares < best.squares * (1 - 1e-12) ? fine : best;
}

}  // namespace

Lab lab_at(const Appearance& appearance, double aspecular_deg) {
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
  const Fit fit = nearest({{15, {at_15, 0, 0}}, {45, {at_45, 0, 0}}, {110, {at_110, 0, 0}}});
  return {fit.face[0], fit.flop[0], fit.travel_deg, false};
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
    const double de00 = delta_e_2000(row.lab, lab_at(result.appearance, aspecular_angle_deg(row.geometry)));
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

}  // namespace goniochrome
