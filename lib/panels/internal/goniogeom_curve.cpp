#include "panels/internal/goniogeom_curve.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::panels {

namespace {

std::array<double, 3> channels(const color::Lab& lab) {
  return {lab.L, lab.a, lab.b};
}

// The coefficients of the cubic through four equally spaced values, the first at x = 0 and the last at x = width.
// Newton's forward differences with s = 3x/width: y0 + d1 s + d2 s(s-1)/2 + d3 s(s-1)(s-2)/6.
std::array<double, 4> cubic_through(const std::array<double, 4>& y, double width) {
  const double d1 = y[1] - y[0], d2 = y[2] - 2 * y[1] + y[0], d3 = y[3] - 3 * y[2] + 3 * y[1] - y[0];
  const double s = 3 / width;
  return {y[0], s * (d1 - d2 / 2 + d3 / 3), s * s * (d2 / 2 - d3 / 2), s * s * s * d3 / 6};
}

// The largest |c1 + 2 c2 x + 3 c3 x^2| for x in [low,high]: at an end, or at the vertex.
double steepest_channel(const std::array<double, 4>& c, double low, double high) {
  const auto slope = [&](double x) { return std::abs(c[1] + x * (2 * c[2] + x * 3 * c[3])); };
  double most = std::max(slope(low), slope(high));
  if (c[3] != 0) {
    const double vertex = -c[2] / (3 * c[3]);
    if (vertex > low && vertex < high) most = std::max(most, slope(vertex));
  }
  return most;
}

}  // namespace

FlakeCurve::FlakeCurve(const paint::Appearance& appearance) {
  const double travel = appearance.travel_deg, width = travel - paint::kFaceAngle_deg;
  const auto face = channels(appearance.face), flop = channels(appearance.flop);
  Piece slope{travel, travel, {}}, plateau{180, travel, {}};
  for (int c = 0; c < 3; ++c) {
    slope.coefficients[c] = {flop[c], 0, (face[c] - flop[c]) / (width * width), 0};
    plateau.coefficients[c] = {flop[c], 0, 0, 0};
  }
  pieces_ = {slope, plateau};
  residual_de00_ = appearance.residual_de00;
  tabulate_slopes();
}

Result<FlakeCurve> FlakeCurve::make(const paint::Paint& paint, paint::TargetCurve::Kind kind) {
  if (kind == paint::TargetCurve::Kind::kMeasured && paint.measurement && !paint.measurement->rows.empty()) {
    GONIO_ASSIGN(const paint::TargetCurve target, paint::TargetCurve::make(paint, kind));
    if (target.kind() == paint::TargetCurve::Kind::kMeasured) {
      FlakeCurve curve;
      const std::vector<double>& knots = target.known_angles_deg();
      const auto constant = [&](double until, double at) {
        Piece piece{until, at, {}};
        const auto value = channels(target.at(at));
        for (int c = 0; c < 3; ++c) piece.coefficients[c] = {value[c], 0, 0, 0};
        curve.pieces_.push_back(piece);
      };
      constant(knots.front(), knots.front());
      for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const double width = knots[i + 1] - knots[i];
        Piece piece{knots[i + 1], knots[i], {}};
        std::array<std::array<double, 3>, 4> y;
        for (int k = 0; k < 4; ++k) y[k] = channels(target.at(k == 3 ? knots[i + 1] : knots[i] + k * width / 3));
        for (int c = 0; c < 3; ++c) piece.coefficients[c] = cubic_through({y[0][c], y[1][c], y[2][c], y[3][c]}, width);
        curve.pieces_.push_back(piece);
      }
      constant(180, knots.back());
      curve.tabulate_slopes();
      return curve;
    }
  }
  GONIO_ASSIGN(const paint::Appearance appearance, appearance_of(paint));
  return FlakeCurve(appearance);
}

color::Lab FlakeCurve::at(double aspecular_deg) const {
  std::size_t i = 0;
  while (i + 1 < pieces_.size() && aspecular_deg >= pieces_[i].until_deg) ++i;
  const double x = aspecular_deg - pieces_[i].origin_deg;
  const auto value = [&](const std::array<double, 4>& c) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); };
  const auto& c = pieces_[i].coefficients;
  return {value(c[0]), value(c[1]), value(c[2])};
}

double FlakeCurve::steepest(double low_deg, double high_deg) const {
  const int first = std::clamp(static_cast<int>(low_deg), 0, kCells - 1);
  const int last = std::clamp(static_cast<int>(high_deg), first, kCells - 1);
  float most = 0;
  for (int i = first; i <= last; ++i) most = std::max(most, slope_[i]);
  return most;
}

// The bound of a cell is the length of the three channels' bounds, rounded up to a float.
void FlakeCurve::tabulate_slopes() {
  for (int i = 0; i < kCells; ++i) {
    double from = i, most = 0;
    for (const Piece& piece : pieces_) {
      const double to = std::min<double>(i + 1, piece.until_deg);
      if (to < from) continue;
      double squares = 0;
      for (const auto& c : piece.coefficients) {
        const double slope = steepest_channel(c, from - piece.origin_deg, to - piece.origin_deg);
        squares += slope * slope;
      }
      most = std::max(most, std::sqrt(squares));
      from = to;
    }
    slope_[i] = static_cast<float>(most * (1 + 1e-6));
  }
}

Result<paint::Appearance> appearance_of(const paint::Paint& paint) {
  if (paint.appearance) {
    if (auto checked = paint::check(*paint.appearance); !checked.ok())
      return input_error("{}: {}", paint.name, checked.error().message);
    return *paint.appearance;
  }
  if (!paint.measurement || paint.measurement->rows.empty())
    return input_error("{}: the paint has neither Lab rows nor face, flop and travel: give one of them", paint.name);
  GONIO_ASSIGN(const paint::AppearanceFit fit, paint::appearance_from_rows(paint.measurement->rows));
  return fit.appearance;
}

}  // namespace goniochrome::panels
