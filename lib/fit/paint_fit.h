// Fitting paints to a basis of cosine lobes. [ShimizuMeyer] 4, [Shimizu2009] 2.4
// goniochrome-theory(7), FITTING.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "brdf/gloss.h"
#include "paint/basis.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome {

// kDeltaE starts from both others and then makes the color differences at the readings least.
enum class FitMethod { kL1, kL2, kDeltaE };

// "l1" | "l2" | "deltae"
const char* fit_method_name(FitMethod method);

struct FitOptions {
  FitMethod method = FitMethod::kL1;
  TargetCurve::Kind target = TargetCurve::Kind::kMeasured;
  bool perceptual_weights = true;                  // rows weighted by dL*/dY of the target
  std::optional<double> assumed_gloss_60_gu = {};  // for paints that state no gloss
};

// Readings nearer to specular than this hold conventional glare and belong to the gloss meter.
constexpr double kGlareAngle_deg = 10;

// A lobe that gives every sample less than this part of its peak is not seen by the samples.
constexpr double kSeenPart = 1e-3;

struct GeometryError {
  std::string geometry;
  double de00 = 0;
};

struct GlossMisfit {
  double angle_deg = 60, stated_gu = 0, misfit_gu = 0;  // simulated minus stated
};

// How good a fit is, and the proof.
struct PaintFitReport {
  std::string status = "optimal";  // "optimal" | "not_converged" (a solver gave up: the best weights found)
  double objective = 0;            // |W(Mx-b)| over all rows and channels, in L* where weights are perceptual
  double plain_objective = 0;      // the same without weights, in reflectance factor
  double optimality_gap = 0;       // the largest of the channels; see least_squares.h
  int active_lobes = 0;            // lobes with any weight, the mirror included
  std::vector<GeometryError> de00_by_geometry;  // against the readings (or the designed curve at 15, 45 and 110 deg)
  double de00_max = 0, de00_mean = 0;
  double gamut_de00 = 0;           // the largest color change from negative working-space channels of the target
  std::vector<double> unseen;      // exponents that no sample sees: K_DD left at 0
  int glare_rows = 0;              // readings left out for being within kGlareAngle_deg of specular
  std::vector<GlossMisfit> gloss;  // one per gloss reading
  double time_us = 0;
};

struct PaintFit {
  LobeFit lobes;  // only lobes with weight, exponents ascending, the mirror last
  PaintFitReport report;
};

// Fits paints to one basis. Immutable: many threads may share one.
class PaintFitter {
 public:
  PaintFitter(Basis basis, FitOptions options);

  // Error: the paint has no rows beyond glare and no appearance, its illuminant is unknown, or no gloss meter has the
  // angle of a reading.
  Result<PaintFit> fit(const Paint& paint) const;

  const Basis& basis() const { return basis_; }
  const FitOptions& options() const { return options_; }

 private:
  Basis basis_;
  FitOptions options_;
  GlossTable gloss_;
};

// Fits every paint on all cores; results stand in the order of the paints and do not depend on the number of threads.
std::vector<Result<PaintFit>> fits(const PaintFitter& fitter, const std::vector<Paint>& paints);

}  // namespace goniochrome
