// The color of a paint as a curve over the aspecular angle, and how the three representations of a paint (measured
// rows, curve, face and flop) are made from one another. [Shimizu2009] 3.3.8-3.3.10;
// goniochrome-paint(7), "PAINT REPRESENTATIONS".
#pragma once

#include <array>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::paint {

constexpr double kFaceAngle_deg = 15;

// Lab at an unsigned aspecular angle (deg, 0..180) by the clamped quadratic in vertex form:
// flop + (face - flop) ((travel - t)/(travel - 15))^2 for t < travel, flop beyond. Exactly constant for a solid color.
color::Lab lab_at(const Appearance& appearance, double aspecular_deg);

// Refuses a travel outside (15,180]; the message names it.
Result<void> check(const Appearance& appearance);

// How far the quadratic is blown up at 0 deg: (travel/(travel-15))^2. Tools warn above 4.
double extrapolation_at_specular(const Appearance& appearance);

// One channel's clamped quadratic through its values at 15, 45 and 110 deg. It is `exact` if it passes through all
// three, which it does for 0 <= s < 1, s = (q45 - q110)/(q15 - q110), unless the vertex would lie beyond 180 deg, and
// for equal values. Any other channel gets the nearest clamped quadratic (least squares).
struct ChannelCurve {
  double face = 0, flop = 0, travel_deg = 60;
  bool exact = true;
  double at(double aspecular_deg) const;
};
ChannelCurve channel_curve(double at_15, double at_45, double at_110);

// One channel's clamped quadratic nearest (weighted least squares) to values at any number of angles, at least one.
struct ChannelValue {
  double aspecular_deg = 0, value = 0;
  double weight = 1;  // > 0
};
ChannelCurve nearest_channel_curve(const std::vector<ChannelValue>& values);

// The face, flop and travel nearest (least squares in Lab) to rows at any number of aspecular angles. For a fixed
// travel the problem is linear in face and flop; the travel is scanned over its domain and refined. The rows in the
// plane of incidence are fitted, or all rows if none is in that plane. `de00` has the miss of every row; residual_de00
// is the worst of the fitted ones. If several travels fit the rows equally well, the largest is taken, and 60 deg if
// the rows are constant. Error: no rows.
struct AppearanceFit {
  Appearance appearance;
  std::vector<double> de00;
};
Result<AppearanceFit> appearance_from_rows(const std::vector<LabReading>& rows);

// The aspecular angles (deg) at which designed paints are stated: 15/45/110 and 25/45/75. [Shimizu2009] 3.3.3
constexpr std::array<double, 5> kExportAngles_deg = {15, 25, 45, 75, 110};

// The readings of a designed paint: rows at 45 deg incidence and the export angles.
std::vector<LabReading> rows_of(const Appearance& appearance);

// Where an aspecular angle (deg, 0..180) stands on the axis on which measured curves are cubics: ln(t + 5 deg). Flakes
// turn their color fast near specular and slowly far from it, and in this place most paints change about evenly.
// goniochrome-paint(7), "PAINT REPRESENTATIONS", tells what that gains on held-out angles.
double curve_place(double aspecular_deg);
// The angle of a place, and how fast the place changes with the angle (1/deg).
double angle_of_place_deg(double place);
double curve_place_slope(double aspecular_deg);

// The color of a paint at any unsigned aspecular angle. In-plane rows at the same angle are averaged.
// - kMeasured: in each channel a piecewise cubic (PCHIP) in curve_place() of the angle, which passes through the rows,
//   stays between the values of neighboring rows, and is constant beyond the ends;
// - kCurve: the clamped quadratic of the appearance. If the paint has none, it is the quadratic in each channel that is
//   nearest to the rows, where each row counts for the angles that are nearest to it.
class TargetCurve {
 public:
  enum class Kind { kMeasured, kCurve };
  // The kind asked for, or the other one if the paint has only that. Error: the paint has neither rows nor an
  // appearance, or its appearance is out of its domain.
  static Result<TargetCurve> make(const Paint& paint, Kind kind);
  Kind kind() const { return kind_; }
  color::Lab at(double aspecular_deg) const;
  // The aspecular angles (deg, ascending, unsigned) at which the target is known and not interpolated: the rows', or
  // the export angles of a designed paint.
  const std::vector<double>& known_angles_deg() const { return known_deg_; }

 private:
  Kind kind_ = Kind::kMeasured;
  std::array<ChannelCurve, 3> quadratic_;
  std::vector<double> known_deg_, place_;             // of a measured curve: the places of the known angles
  std::array<std::vector<double>, 3> value_, slope_;  // per channel at the known angles, slopes by place
};

}  // namespace goniochrome::paint
