// A paint's color against aspecular angle as pieces of polynomials, with bounds of how fast it changes.
// goniochrome-theory(7), GONIOGEOMETRIC INDEX.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/result.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome::panels {

class FlakeCurve {
 public:
  // The clamped quadratic of an appearance whose travel is in (15,180].
  explicit FlakeCurve(const paint::Appearance& appearance);

  // The curve of `paint`: kCurve is the clamped quadratic (fitted to the rows where it states none), kMeasured the
  // monotone cubic through the rows, or the quadratic where it has none. Error: the paint has no color.
  static Result<FlakeCurve> make(const paint::Paint& paint, paint::TargetCurve::Kind kind);

  // Lab at an unsigned aspecular angle (deg, 0..180).
  color::Lab at(double aspecular_deg) const;

  // How far the curve is from the rows it was fitted to (worst dE00), where that is known.
  std::optional<double> residual_de00() const { return residual_de00_; }

  // No stretch of the curve between these angles (deg, cut to 0..180) changes by more than this, in Lab units a degree.
  double steepest(double low_deg, double high_deg) const;

 private:
  // value = c0 + c1 x + c2 x^2 + c3 x^3 with x = angle - origin, up to the angle `until`.
  struct Piece {
    double until_deg = 180, origin_deg = 0;
    std::array<std::array<double, 4>, 3> coefficients{};
  };
  FlakeCurve() = default;
  void tabulate_slopes();

  static constexpr int kCells = 180;  // of one degree
  std::vector<Piece> pieces_;
  std::array<float, kCells> slope_{};
  std::optional<double> residual_de00_;
};

// The appearance of `paint`: the one it states, or else the one nearest to its rows, with the residual. Error: the
// paint has no color, or a travel outside its domain.
Result<paint::Appearance> appearance_of(const paint::Paint& paint);

}  // namespace goniochrome::panels
