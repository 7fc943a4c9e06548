#include <algorithm>
#include <cmath>

#include "base/utf8.h"
#include "paint/curve.h"

namespace goniochrome::paint {

namespace {

struct MeanRow {
  double aspecular_deg = 0;
  std::array<double, 3> value{};
};

// The in-plane rows by unsigned aspecular angle, ascending; rows at the same angle (45as15 and 45as-15) are averaged.
std::vector<MeanRow> in_plane_means(const std::vector<LabReading>& rows) {
  std::vector<MeanRow> single;
  for (const LabReading& row : rows)
    if (!row.geometry.out_of_plane)
      single.push_back({aspecular_angle_deg(row.geometry), {row.lab.L, row.lab.a, row.lab.b}});
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

// The quadratic of one channel; each value weighs by the width of angles up to halfway to its neighbors, so that where
// an instrument has its readings close together, near specular, does not decide the flop.
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
    for (int c = 0; c < 3; ++c) curve.slope_[c] = monotone_slopes(curve.known_deg_, curve.value_[c]);
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

// Hermite's cubic on the interval that holds the angle.
color::Lab TargetCurve::at(double aspecular_deg) const {
  if (kind_ == Kind::kCurve)
    return {quadratic_[0].at(aspecular_deg), quadratic_[1].at(aspecular_deg), quadratic_[2].at(aspecular_deg)};
  const double t = std::clamp(aspecular_deg, known_deg_.front(), known_deg_.back());
  const auto above = std::ranges::upper_bound(known_deg_, t);
  const std::size_t last = known_deg_.size() - 1;
  const std::size_t i = above == known_deg_.end() ? last : static_cast<std::size_t>(above - known_deg_.begin()) - 1;
  if (t == known_deg_[i]) return {value_[0][i], value_[1][i], value_[2][i]};
  const double h = known_deg_[i + 1] - known_deg_[i], u = (t - known_deg_[i]) / h, v = 1 - u;
  std::array<double, 3> value;
  for (int c = 0; c < 3; ++c) {
    const double rise = value_[c][i + 1] - value_[c][i];
    value[c] = value_[c][i] + u * u * (3 - 2 * u) * rise + h * u * v * (v * slope_[c][i] - u * slope_[c][i + 1]);
  }
  return {value[0], value[1], value[2]};
}

}  // namespace goniochrome::paint
