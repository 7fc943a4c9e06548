// Two panels of one paint that meet at an angle: what color each shows, and the angle at which the difference is seen.
// [Shimizu2009] 4.3, goniochrome-panels(7), "GONIOGEOMETRIC INDEX".
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "base/result.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome::panels {

// A paint's color against aspecular angle as pieces of polynomials in the angle or in its place, with bounds of how
// fast it changes.
class FlakeCurve {
 public:
  // The clamped quadratic of an appearance whose travel is in (15,180].
  explicit FlakeCurve(const paint::Appearance& appearance);

  // The curve of `paint`. kCurve is the clamped quadratic of the appearance that the paint states, or else of the one
  // nearest to its rows; kMeasured is the monotone curve through the rows beyond glare, or the quadratic where there
  // are none. Below its first row the measured curve is the highlight that fit-paint continues, see
  // fit/highlight_end.h. Error: the paint has no color, an unknown illuminant, or a travel outside its domain.
  static Result<FlakeCurve> make(const paint::Paint& paint, paint::TargetCurve::Kind kind);

  // Lab at an unsigned aspecular angle (deg, 0..180).
  color::Lab at(double aspecular_deg) const;

  // brdf::coat_index_of_paint(): the curve holds where an instrument reads.
  double coat_index() const { return coat_index_; }

  // The largest dE00 between the curve and the rows it was fitted to, where that is known.
  std::optional<double> residual_de00() const { return residual_de00_; }

  // A bound of how fast the curve changes between these angles (deg, cut to 0..180), in Lab units a degree.
  double steepest(double low_deg, double high_deg) const;

 private:
  // value = c0 + c1 x + c2 x^2 + c3 x^3 up to the angle `until`, with x = angle - origin in degrees or, where
  // `by_place` is true, the difference of their paint::curve_place().
  struct Piece {
    double until_deg = 180, origin_deg = 0;
    std::array<std::array<double, 4>, 3> coefficients{};
    bool by_place = false;

    double x(double aspecular_deg) const;
    // The most that x changes in a degree, from that angle on.
    double steepest_x(double from_deg) const;
  };
  FlakeCurve() = default;
  static Result<FlakeCurve> of_appearance(const paint::Paint& paint);
  static Result<FlakeCurve> measured(const paint::Paint& paint, double coat_index);
  void add_highlight(const paint::TargetCurve& target, const color::Xyz& white, double coat_index, double first_deg);
  void tabulate_slopes();

  static constexpr int kCells = 180;  // of one degree
  std::vector<Piece> pieces_;
  std::array<float, kCells> slope_{};
  std::optional<double> residual_de00_;
  double coat_index_ = paint::kNoCoat;
};

// The appearance that a paint states, or else the one nearest to its rows. Error: the paint has no color, or a travel
// outside its domain.
Result<paint::Appearance> appearance_of(const paint::Paint& paint);

enum class DifferenceMetric { kDe76, kDe00 };
double difference(DifferenceMetric metric, const color::Lab& x, const color::Lab& y);

// The color, without gloss, of a panel whose reflectance factor is `reflectance` (Lab, any white), lit at an angle of
// this cosine, against a white that faces the light. A panel with a cosine below 0 is black.
color::Lab panel_color(const color::Lab& reflectance, double cos_light);

// One light and one viewer, relative to the first panel: polar angles in degrees, the light's from the normal, the
// viewer's positive on the far side of the normal from the light. `azimuth_deg` turns the viewer about the normal.
struct LightView {
  double light_deg = 45, view_deg = 0, azimuth_deg = 0;
};
// Unit directions in the frame x = away from the light in the plane of incidence, z = normal of the first panel.
paint::DirectionPair directions(const LightView& geometry);

// A second panel that is turned about the seam by b degrees while light and viewer stay where they are.
class TiltedPair {
 public:
  // `axis` is the seam, about which positive b turns the second panel by the right hand. All are unit vectors; the axis
  // lies in the panel, and light and viewer stand above it.
  TiltedPair(const Vec3& light, const Vec3& view, const Vec3& normal, const Vec3& axis);

  // The seam at `seam_deg` from the plane of incidence (90: across it), so oriented that positive b turns the second
  // panel toward the light.
  static TiltedPair make(const LightView& geometry, double seam_deg);

  // The state of the panel at b: its aspecular angle (deg) and the cosines to the light (0 where it is in its own
  // shadow) and to the viewer.
  struct State {
    double aspecular_deg = 0, cos_light = 0, cos_view = 1;

    // The cosine that stands for light and coat together, see brdf::coat_passages_to_reading().
    double shade(double coat_index) const;
  };
  State at(double b_deg) const;

  // The largest |b| (deg) of this sign at which the second panel still faces the viewer. It lies between 0 and 180.
  double range_deg(int sign) const { return sign > 0 ? 90 + view_phase_deg_ : 90 - view_phase_deg_; }

  // The b (deg) at which the second panel is lit at the largest cosine, and that cosine.
  double brightest_deg() const { return light_phase_deg_; }
  double largest_cos() const { return light_radius_; }
  // The angle of the viewer.
  double frontal_deg() const { return view_phase_deg_; }
  double largest_cos_view() const { return view_radius_; }

 private:
  double light_radius_, cos_phase_, sin_phase_;  // the light across the seam, and its phase from the normal
  double light_phase_deg_, view_phase_deg_, view_radius_;
  double across_, sum_, difference_;  // see at()
  double cos_half_, sin_half_;
  std::optional<double>
      in_plane_deg_;  // the aspecular angle at b = 0, signed toward the light, where all lie in one plane
};

// The difference of the two panels at b; at b = 0 there is none.
double difference_at(const FlakeCurve& curve, const TiltedPair& pair, double b_deg, DifferenceMetric metric);

// The smallest |b| (deg) of this sign at which the difference reaches `threshold` (> 0), within 1e-9 deg; none where
// the difference does not reach it before the second panel turns away from the viewer. An excursion above the threshold
// is missed only where it is shorter than kShortestExcursion_deg.
constexpr double kShortestExcursion_deg = 1e-6;
std::optional<double> first_crossing(const FlakeCurve& curve, const TiltedPair& pair, int sign, double threshold,
                                     DifferenceMetric metric);

// The first crossings of both signs.
struct GeometryIndex {
  std::optional<double> plus_deg, minus_deg;
  // The smaller of the two, or infinity.
  double smallest_deg() const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    return std::min(plus_deg.value_or(kNever), minus_deg.value_or(kNever));
  }
};
GeometryIndex geometry_index(const FlakeCurve& curve, const TiltedPair& pair, double threshold,
                             DifferenceMetric metric);

// The larger difference of the two signs at a given |b|; NaN where the panel faces away in both.
double larger_difference(const FlakeCurve& curve, const TiltedPair& pair, double b_deg, DifferenceMetric metric);

}  // namespace goniochrome::panels
