#include "panels/goniogeom.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/coat.h"
#include "brdf/gloss.h"
#include "fit/highlight_end.h"
#include "fit/paint_fit.h"
#include "formats/default_basis.h"
#include "panels/internal/shading.h"

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

color::Lab shaded(const color::Lab& reflectance, double c, double k) {
  const auto lab = shaded_lab<double>({reflectance.L, reflectance.a, reflectance.b}, c, k);
  return {lab[0], lab[1], lab[2]};
}

// No color changes by more than this when its cosine goes from c to another and cbrt of it by one, as long as cbrt
// stays above `least_k`. On the cube root d Lab'/dk is (L + 16, a, b); below the knee L' changes more slowly still, and
// a', b' at most three times as fast (goniochrome-panels(7), "Shading").
double shading_reach(const color::Lab& reflectance, double least_k) {
  const double f = (reflectance.L + 16) / 116;
  const double darkest = least_k * std::min({f, f + reflectance.a / 500, f - reflectance.b / 200});
  const double w = darkest > kResponseKnee ? 1 : 3;
  const double lightness = std::max(std::abs(reflectance.L) + 16, -3 * reflectance.L);
  return std::sqrt(lightness * lightness + w * w * (reflectance.a * reflectance.a + reflectance.b * reflectance.b));
}

// CIEDE2000 is no metric. Up to some 10 units it is at most kStretch times as steep as the distance in Lab: the a* axis
// is stretched by up to 1.5 and the weights S are at least 1, but move with the mean of both colors. Between colors of
// opposite hue it even jumps; there the steps are short.
constexpr double kStretch = 2.5;
constexpr double kOppositeStep_deg = 0.02;

bool is_beyond_glare(const paint::LabReading& row) {
  return paint::aspecular_angle_deg(row.geometry) >= fit::kGlareAngle_deg;
}

bool may_be_opposite(const color::Lab& x, const color::Lab& y) {
  return x.a * y.a + x.b * y.b < 0;
}

// A root of `over` in [low,high], over(low) < 0 <= over(high), to 1e-10 deg, from above: regula falsi with halving of
// the stale end (Illinois).
template <class Function>
double root_between(double low, double high, double at_low, double at_high, const Function& over) {
  for (int i = 0; i < 100 && high - low > 1e-10; ++i) {
    double middle = low - at_low * (high - low) / (at_high - at_low);
    if (!(middle > low && middle < high)) middle = low + (high - low) / 2;
    const double value = over(middle);
    if (value >= 0) {
      high = middle, at_high = value, at_low /= 2;
    } else {
      low = middle, at_low = value, at_high /= 2;
    }
  }
  return high;
}

}  // namespace

FlakeCurve::FlakeCurve(const paint::Appearance& appearance) {
  const double travel = appearance.travel_deg, width = travel - paint::kFaceAngle_deg;
  const auto face = channels(appearance.face), flop = channels(appearance.flop);
  Piece slope{travel, travel, {}, false}, plateau{180, travel, {}, false};
  for (int c = 0; c < 3; ++c) {
    slope.coefficients[c] = {flop[c], 0, (face[c] - flop[c]) / (width * width), 0};
    plateau.coefficients[c] = {flop[c], 0, 0, 0};
  }
  pieces_ = {slope, plateau};
  residual_de00_ = appearance.residual_de00;
  tabulate_slopes();
}

Result<FlakeCurve> FlakeCurve::make(const paint::Paint& paint, paint::TargetCurve::Kind kind) {
  GONIO_ASSIGN(const double coat_index, brdf::coat_index_of_paint(paint));
  const bool is_measured = kind == paint::TargetCurve::Kind::kMeasured && paint.measurement &&
                           std::ranges::any_of(paint.measurement->rows, is_beyond_glare);
  GONIO_ASSIGN(FlakeCurve curve, is_measured ? measured(paint, coat_index) : of_appearance(paint));
  curve.coat_index_ = coat_index;
  return curve;
}

Result<FlakeCurve> FlakeCurve::of_appearance(const paint::Paint& paint) {
  GONIO_ASSIGN(const paint::Appearance appearance, appearance_of(paint));
  return FlakeCurve(appearance);
}

Result<FlakeCurve> FlakeCurve::measured(const paint::Paint& paint, double coat_index) {
  GONIO_ASSIGN(const paint::TargetCurve target, paint::TargetCurve::make(paint, paint::TargetCurve::Kind::kMeasured));
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(paint)));
  FlakeCurve curve;
  const std::vector<double>& known = target.known_angles_deg();
  const std::vector<double> knots(std::ranges::lower_bound(known, fit::kGlareAngle_deg), known.end());
  curve.add_highlight(target, white, coat_index, knots.front());
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double place = paint::curve_place(knots[i]), width = paint::curve_place(knots[i + 1]) - place;
    Piece piece{knots[i + 1], knots[i], {}, true};
    std::array<std::array<double, 3>, 4> y;
    for (int k = 0; k < 4; ++k)
      y[k] = channels(target.at(k == 3 ? knots[i + 1] : paint::angle_of_place_deg(place + k * width / 3)));
    for (int c = 0; c < 3; ++c) piece.coefficients[c] = cubic_through({y[0][c], y[1][c], y[2][c], y[3][c]}, width);
    curve.pieces_.push_back(piece);
  }
  Piece plateau{180, knots.back(), {}, false};
  const auto last = channels(target.at(knots.back()));
  for (int c = 0; c < 3; ++c) plateau.coefficients[c] = {last[c], 0, 0, 0};
  curve.pieces_.push_back(plateau);
  curve.tabulate_slopes();
  return curve;
}

// Cubics of one degree stay within 0.003 of the highlight that fit-paint continues, for the steepest one there is.
void FlakeCurve::add_highlight(const paint::TargetCurve& target, const color::Xyz& white, double coat_index,
                               double first_deg) {
  static const std::vector<double> kExponents = formats::default_basis().exponents;
  const auto passages = [&](double t) {
    return brdf::coat_passages(coat_index, std::cos(45 * kDegree), std::cos(brdf::instrument_view_deg(t) * kDegree));
  };
  const auto base = [&](double t) { return (1 / passages(t)) * color::rgb_from_lab(target.at(t), white); };
  const fit::HighlightEnd end{first_deg, first_deg + 10, base(first_deg), base(first_deg + 10)};
  const color::Rgb exponents = fit::highlight_exponents(end, fit::steepest_seen(kExponents, first_deg * kDegree));
  const auto count = static_cast<int>(std::ceil(first_deg));
  const double width = first_deg / count;
  for (int i = 0; i < count; ++i) {
    Piece piece{(i + 1) * width, i * width, {}, false};
    std::array<std::array<double, 3>, 4> y;
    for (int k = 0; k < 4; ++k) {
      const double t = (i + k / 3.0) * width;
      y[k] = channels(color::lab_from_rgb(passages(t) * fit::highlight_at(end, exponents, t), white));
    }
    for (int c = 0; c < 3; ++c) piece.coefficients[c] = cubic_through({y[0][c], y[1][c], y[2][c], y[3][c]}, width);
    pieces_.push_back(piece);
  }
}

double FlakeCurve::Piece::x(double aspecular_deg) const {
  return by_place ? paint::curve_place(aspecular_deg) - paint::curve_place(origin_deg) : aspecular_deg - origin_deg;
}

double FlakeCurve::Piece::steepest_x(double from_deg) const {
  return by_place ? paint::curve_place_slope(from_deg) : 1;
}

color::Lab FlakeCurve::at(double aspecular_deg) const {
  const Piece& piece = *std::upper_bound(pieces_.begin(), pieces_.end() - 1, aspecular_deg,
                                         [](double angle, const Piece& p) { return angle < p.until_deg; });
  const double x = piece.x(aspecular_deg);
  const auto value = [&](const std::array<double, 4>& c) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); };
  const auto& c = piece.coefficients;
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
        const double slope = piece.steepest_x(from) * steepest_channel(c, piece.x(from), piece.x(to));
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

double difference(DifferenceMetric metric, const color::Lab& x, const color::Lab& y) {
  return metric == DifferenceMetric::kDe76 ? color::delta_e_76(x, y) : color::delta_e_2000(x, y);
}

color::Lab panel_color(const color::Lab& reflectance, double cos_light) {
  const double c = std::max(0.0, cos_light);
  return shaded(reflectance, c, std::cbrt(c));
}

paint::DirectionPair directions(const LightView& g) {
  const double light = g.light_deg * kDegree, view = g.view_deg * kDegree, azimuth = g.azimuth_deg * kDegree;
  return {{-std::sin(light), 0, std::cos(light)},
          {std::sin(view) * std::cos(azimuth), std::sin(view) * std::sin(azimuth), std::cos(view)}};
}

// With u the seam and m = u x n, the panel at b has the normal n cos b + m sin b. Seen along the seam, the light has
// the radius p and the phase q from n toward m, so that cos_light = p cos(q - b).
//
// Mirrored at the turning panel, the light keeps its radius, turns by 2b, and its part along the seam changes sign.
// With s and S the parts of light and view along the seam, p and P their radii and d the angle between mirrored light
// and view seen along the seam,
//   |r - v|^2 = (s + S)^2 + (p - P)^2 + 4 p P sin^2(d/2),    |r + v|^2 = (s - S)^2 + (p - P)^2 + 4 p P cos^2(d/2),
// and the aspecular angle is 2 atan2(|r - v|, |r + v|): sums of squares, nothing cancels. In plane, s = S = 0 and p = P
// = 1, so that it is |d| = |d0 - 2b|.
TiltedPair::TiltedPair(const Vec3& light, const Vec3& view, const Vec3& normal, const Vec3& axis) {
  const Vec3 m = cross(axis, normal);
  const double light_phase = std::atan2(dot(light, m), dot(light, normal));
  const double view_phase = std::atan2(dot(view, m), dot(view, normal));
  view_radius_ = std::hypot(dot(view, m), dot(view, normal));
  light_radius_ = std::hypot(dot(light, m), dot(light, normal));
  cos_phase_ = std::cos(light_phase), sin_phase_ = std::sin(light_phase);
  light_phase_deg_ = light_phase / kDegree, view_phase_deg_ = view_phase / kDegree;
  const double s = dot(light, axis), S = dot(view, axis), radii = light_radius_ - view_radius_;
  across_ = 4 * light_radius_ * view_radius_;
  difference_ = (s + S) * (s + S) + radii * radii;
  sum_ = (s - S) * (s - S) + radii * radii;
  // The mirrored light has the phase -q at b = 0 and 2b - q at b; the view has its own.
  const double half = (view_phase + light_phase) / 2;
  cos_half_ = std::cos(half), sin_half_ = std::sin(half);
  if (difference_ + sum_ < 1e-30) in_plane_deg_ = 2 * half / kDegree;
}

TiltedPair TiltedPair::make(const LightView& geometry, double seam_deg) {
  const paint::DirectionPair pair = directions(geometry);
  const double seam = seam_deg * kDegree;
  return TiltedPair(pair.light, pair.view, {0, 0, 1}, {std::cos(seam), -std::sin(seam), 0});
}

TiltedPair::State TiltedPair::at(double b_deg) const {
  const double b = b_deg * kDegree, cos_b = std::cos(b), sin_b = std::sin(b);
  const double cos_light = std::max(0.0, light_radius_ * (cos_phase_ * cos_b + sin_phase_ * sin_b));
  const double cos_view = std::max(0.0, view_radius_ * std::cos((view_phase_deg_ - b_deg) * kDegree));
  if (in_plane_deg_) {
    const double d = std::abs(*in_plane_deg_ - 2 * b_deg);  // below 540
    return {d <= 180 ? d : std::abs(360 - d), cos_light, cos_view};
  }
  const double sin_d = sin_half_ * cos_b - cos_half_ * sin_b, cos_d = cos_half_ * cos_b + sin_half_ * sin_b;
  const double apart = std::sqrt(difference_ + across_ * sin_d * sin_d);
  const double together = std::sqrt(sum_ + across_ * cos_d * cos_d);
  return {2 * std::atan2(apart, together) / kDegree, cos_light, cos_view};
}

double TiltedPair::State::shade(double coat_index) const {
  return cos_light * brdf::coat_passages_to_reading(coat_index, aspecular_deg, cos_light, cos_view);
}

namespace {

// The bounds of State::shade() where each cosine and the aspecular angle may be anything between their bounds: what a
// coat lets through rises with the cosine, and so does what it lets through where the angle is read.
struct ShadeBounds {
  double least, most;
};
ShadeBounds shade_bounds(double coat_index, const TiltedPair::State& low, const TiltedPair::State& high) {
  if (coat_index == paint::kNoCoat) return {low.cos_light, high.cos_light};
  const double from = low.aspecular_deg, to = high.aspecular_deg;
  // The reading is taken along the normal at 45 deg, and farther from it on both sides.
  const double frontal = std::clamp(45.0, from, to), steep = std::abs(from - 45) > std::abs(to - 45) ? from : to;
  const auto shade = [&](const TiltedPair::State& s, double aspecular_deg) {
    return TiltedPair::State{aspecular_deg, s.cos_light, s.cos_view}.shade(coat_index);
  };
  return {shade(low, frontal), shade(high, steep)};
}

}  // namespace

double difference_at(const FlakeCurve& curve, const TiltedPair& pair, double b_deg, DifferenceMetric metric) {
  const auto color = [&](double b) {
    const TiltedPair::State state = pair.at(b);
    return panel_color(curve.at(state.aspecular_deg), state.shade(curve.coat_index()));
  };
  return difference(metric, color(0), color(b_deg));
}

// dE(b) rises and falls, so no bisection is safe. A step h from b is safe if no point of it can reach the threshold.
// The color moves by at most
//   2 h V k  for the curve (the aspecular angle changes by at most 2h; V its steepest slope there; shading by k =
//            cbrt(c) <= 1 never stretches a difference by more than k, and k > 1 by no more than c) plus
//   M |dk|   for the shading.
// c is the cosine to the light or, under a coat, that cosine times what the coat lets through.
// Steps of at least kShortestExcursion_deg end the approach to a crossing; the crossing is then bracketed by that step.
std::optional<double> first_crossing(const FlakeCurve& curve, const TiltedPair& pair, int sign, double threshold,
                                     DifferenceMetric metric) {
  struct Point {
    TiltedPair::State state;
    double c = 0, k = 0;
  };
  const double coat = curve.coat_index();
  const double stretch = metric == DifferenceMetric::kDe76 ? 1 : kStretch;
  const double range = pair.range_deg(sign), brightest = sign * pair.brightest_deg(),
               frontal = sign * pair.frontal_deg();
  const auto point = [&](double b) {
    const TiltedPair::State state = pair.at(sign * b);
    const double c = state.shade(coat);
    return Point{state, c, std::cbrt(c)};
  };
  const auto color = [&](const Point& p, const color::Lab& reflectance) { return shaded(reflectance, p.c, p.k); };
  // From panel to panel in steps as long as is safe; `room` is what is left below the threshold.
  Point here = point(0), next;
  color::Lab reflectance = curve.at(here.state.aspecular_deg);
  const color::Lab first = color(here, reflectance);
  double b = 0, step = 1, longest = range, room = threshold;
  while (b < range) {
    // Shorten the step until it is safe.
    step = std::min({2 * step, longest, range - b});
    for (;;) {
      next = point(b + step);
      // Within the step the cosines have no minimum, and their maxima at an end, at `brightest` or at `frontal`.
      const double as = here.state.aspecular_deg;
      const auto between = [&](double top_deg, double top, double x, double y) {
        return b < top_deg && top_deg < b + step ? top : std::max(x, y);
      };
      const TiltedPair::State &s = here.state, &t = next.state;
      const ShadeBounds bounds =
          shade_bounds(coat, {as - 2 * step, std::min(s.cos_light, t.cos_light), std::min(s.cos_view, t.cos_view)},
                       {as + 2 * step, between(brightest, pair.largest_cos(), s.cos_light, t.cos_light),
                        between(frontal, pair.largest_cos_view(), s.cos_view, t.cos_view)});
      const double most_k = std::cbrt(bounds.most), least_k = std::cbrt(bounds.least);
      const double move = 2 * step * curve.steepest(as - 2 * step, as + 2 * step) * std::max(most_k, bounds.most) +
                          std::max(most_k - here.k, here.k - least_k) * shading_reach(reflectance, least_k);
      if (stretch * move < room) break;
      if (step <= kShortestExcursion_deg) break;
      step = std::max(kShortestExcursion_deg, step * std::clamp(0.98 * room / (stretch * move), 0.02, 0.9));
    }
    // Take it, and find the crossing where it passed one.
    reflectance = curve.at(next.state.aspecular_deg);
    const color::Lab shown = color(next, reflectance);
    if (metric == DifferenceMetric::kDe00) longest = may_be_opposite(first, shown) ? kOppositeStep_deg : range;
    const double next_room = threshold - difference(metric, first, shown);
    if (next_room <= 0) {
      const auto over = [&](double x) {
        const Point p = point(x);
        return difference(metric, first, color(p, curve.at(p.state.aspecular_deg))) - threshold;
      };
      return root_between(b, b + step, -room, -next_room, over);
    }
    b += step, here = next, room = next_room;
  }
  return std::nullopt;
}

GeometryIndex geometry_index(const FlakeCurve& curve, const TiltedPair& pair, double threshold,
                             DifferenceMetric metric) {
  return {first_crossing(curve, pair, 1, threshold, metric), first_crossing(curve, pair, -1, threshold, metric)};
}

double larger_difference(const FlakeCurve& curve, const TiltedPair& pair, double b_deg, DifferenceMetric metric) {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (const int sign : {1, -1})
    if (b_deg < pair.range_deg(sign)) most = std::fmax(most, difference_at(curve, pair, sign * b_deg, metric));
  return most;
}

}  // namespace goniochrome::panels
