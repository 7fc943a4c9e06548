// Paints and measured BRDFs fitted to a basis of cosine lobes: the weights, how well they meet what was measured, and
// the proof that no other weights do better. [ShimizuMeyer] 4, [Shimizu2009] 2.4, goniochrome-fitting(7), "FITTING".
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/result.h"
#include "brdf/gloss.h"
#include "brdf/rough_coat.h"
#include "fit/brdf_target.h"
#include "formats/basis.h"
#include "paint/curve.h"
#include "paint/paint.h"

namespace goniochrome::fit {

// kL1 and kL2 make the weighted error of the reflectance factors least in that norm. kDeltaE starts from both and then
// makes the sum of squared color differences at the readings least, or over all directions of a measured BRDF; their
// mean is nowhere more than 0.01 above that of kL1, nor is the median of many, nor the mean at the readings of a BRDF.
enum class FitMethod { kL1, kL2, kDeltaE };

// "l1" | "l2" | "deltae"
const char* fit_method_name(FitMethod method);

// Which paints get the gloss of a rough coat, with weights for views of its own (see brdf::set_gloss_views()): those
// with two or three readings, all with a reading, whose others then follow the usual series of coats, or none.
enum class Satin { kBySeveral, kAll, kNone };

// Which paints get weights for several views of their readings, beside those for all views: none; those with readings
// that a coat keeps from being met that are met without it; or also those with readings that differ at one aspecular
// angle. Measured BRDFs get views every 15 deg by kWhereNeeded, and none by the others.
enum class ViewSets { kNone, kWhereLost, kWhereNeeded };

struct FitOptions {
  FitMethod method = FitMethod::kL1;
  paint::TargetCurve::Kind target = paint::TargetCurve::Kind::kMeasured;
  bool perceptual_weights = true;                       // rows weighted by dL*/dY of the target
  std::vector<paint::GlossReading> assumed_gloss = {};  // for paints that state no gloss
  int most_lobes = 0;                                   // flake lobes to use, the best subset of the basis; 0: all
  // The coat of every paint. None: each has that of brdf::coat_index_of_paint(). Measured BRDFs have no coat unless one
  // is told here.
  std::optional<double> coat_index = {};
  double prune_de00 = 0;               // --prune: lobes that move no color by more are dropped; 0: none are
  std::vector<double> views_deg = {};  // weights at these angles of the viewer too; empty: those of `view_sets`
  ViewSets view_sets = ViewSets::kWhereLost;
  Satin satin = Satin::kBySeveral;
  double steepest_deg = 75;   // measured BRDFs: directions farther from the normal are left out
  double time_limit_s = 0;    // for one paint, all of its fits together; 0: none
  bool by_incidence = false;  // PaintFitReport::incidences, of paints with several angles: a fit more for each of them
};

// Readings nearer to specular than this hold conventional glare, which the gloss meter measures.
constexpr double kGlareAngle_deg = 10;

// A color difference below this is not seen.
constexpr double kVisible_de00 = 0.5;

// Samples do not see a lobe that gives each of them less than this part of its peak.
constexpr double kSeenPart = 1e-3;

struct GeometryError {
  std::string geometry;
  double de00 = 0;
};

struct GlossMisfit {
  double angle_deg = 60;
  double simulated_gu = 0;               // the reading of the simulated meter on the fit
  std::optional<double> stated_gu = {};  // the reading that the paint states, which the fit was to meet
};

// How well lobes that were fitted to the five usual readings alone predict a measured BRDF: medians of the relative
// error (see BrdfFigures) over its directions beyond glare and at most 60 deg from the normal.
struct FiveAngleFigures {
  std::size_t directions = 0;
  double by_aspecular = 0;  // the lobes at the aspecular angle of each direction
  double by_flake = 0;      // the lobes at the angle that shows a light at 45 deg the same flakes, through the coat
};

// How well all that the lobes show meets a measured BRDF, over the directions that were fitted.
struct BrdfFigures {
  std::size_t fitted = 0;            // directions
  std::size_t glare = 0, steep = 0;  // left out of the flake: near specular, near grazing
  // |predicted - measured| / |measured| of the working-space triple: median and 95 %
  double relative_error_median = 0, relative_error_p95 = 0;
  double de00_median = 0, de00_p95 = 0;
  double spike_albedo_45 = 0;                             // what the coat's spike reflects of light at 45 deg
  std::optional<FiveAngleFigures> from_five_angles = {};  // where it has readings
  std::optional<double> albedo_error = {};                // see brdf_target.h; the caller may fill it in
};

// The gain by weights for each view: the mean color difference at the readings, or over the fitted directions of a
// measured BRDF, with these weights and with the weights for all views.
struct ViewFigures {
  double de00_mean = 0, de00_mean_without = 0;
  double gain_de00() const { return de00_mean_without - de00_mean; }
};

// The differences below which no fit for all views can come, because readings at one aspecular angle, such as those on
// both sides of specular, have different colors. All are 0 where no such readings differ.
struct ViewFloor {
  double apart_de00 = 0;             // the largest difference of two such readings
  double de00_mean = 0;              // over all readings
  std::vector<double> largest_de00;  // for each shared angle, at the worse of its readings
};

// The agreement of the readings at one angle of incidence with those at the others.
struct IncidenceFigures {
  double incidence_deg = 45;
  std::size_t readings = 0;
  double de00_mean = 0;            // of these readings, in the fit to all
  double predicted_de00_mean = 0;  // of these readings, in a fit to the readings at the other angles alone
};

// How a fit ended.
enum class FitStatus {
  kOptimal,
  kNotConverged,  // a solver gave up: the weights are the best it found
  kStalled,       // kDeltaE ended where a gap remains, as it may where hues of nearly gray colors jump
  kBounded,       // kDeltaE ended with a gap where it would have become worse than kL1
  kTimeLimit      // the paint's time was up: the weights are the best found until then
};

// "optimal" | "not_converged" | "stalled" | "bounded" | "time_limit"
const char* fit_status_name(FitStatus status);

// How good a fit is, and the proof.
struct PaintFitReport {
  FitStatus status = FitStatus::kOptimal;
  double objective = 0;        // |W(Mx-b)| over all rows and channels, in L* where weights are perceptual
  double plain_objective = 0;  // the same without weights, in reflectance factor
  double optimality_gap = 0;   // the largest of the channels; see least_squares.h
  int active_lobes = 0;        // lobes with any weight, the mirror included
  std::vector<GeometryError> de00_by_geometry;  // against the readings (or the designed curve at 15, 45 and 110 deg)
  double de00_max = 0, de00_mean = 0;
  // The readings that the lobes meet exactly without the paint's coat and not under it, with their differences under
  // it. By kDeltaE they are those that the l1 fit misses, from which it starts.
  std::vector<GeometryError> lost_to_coat;
  bool views_for_coat = false;  // weights for views meet readings that the coat would have kept from being met
  ViewFloor floor;
  std::string limit;               // why the worst reading is not met any better, in words; empty where all are met
  double gamut_de00 = 0;           // the largest color change from negative working-space channels of the target
  std::vector<double> unseen;      // exponents that no sample sees, whose K_DD is 0
  std::vector<double> dropped;     // exponents that a limit on lobes or visibility left out
  int glare_rows = 0;              // readings left out for being within kGlareAngle_deg of specular
  std::vector<GlossMisfit> gloss;  // at 20, 60 and 85 deg
  std::optional<brdf::CoatRange> coat_range = {};  // where several readings are those of a coat of two scales
  std::optional<BrdfFigures> brdf;
  std::optional<ViewFigures> views;
  std::vector<IncidenceFigures> incidences;  // where they were asked for, there are two or more, and there was time
  double time_us = 0;                        // without that
};

struct PaintFit {
  paint::LobeFit lobes;  // only lobes with weight, exponents ascending, the mirror last
  PaintFitReport report;
};

// Fits paints to one basis. Immutable: many threads may share one.
class PaintFitter {
 public:
  PaintFitter(formats::Basis basis, FitOptions options);

  // Error: the paint has neither rows beyond glare nor an appearance, its illuminant is unknown, or no gloss meter has
  // the angle of a reading.
  Result<PaintFit> fit(const paint::Paint& paint) const;

  // Fits a measured BRDF. The flake lobes are fitted to all directions beyond glare and not steeper than the options
  // say; then the gloss of a clear coat and the sharp part of the flake to what is left near specular. The gloss holds
  // at brdf::kGlossIncidence_deg. Error: no direction is left.
  Result<PaintFit> fit(const BrdfTarget& brdf) const;

  const formats::Basis& basis() const { return basis_; }
  const FitOptions& options() const { return options_; }

 private:
  Result<double> coat_index(const paint::Paint& paint) const;
  PaintFit started(double coat_index) const;
  Result<FiveAngleFigures> from_five_angles(const BrdfTarget& brdf, const Deadline& deadline) const;
  void finish(const std::vector<paint::LabReading>& readings, const color::Xyz& white, PaintFit& fit) const;
  std::string limit(const std::vector<paint::LabReading>& readings, const color::Xyz& white, const PaintFit& fit,
                    const std::function<double()>& by_color) const;
  Result<PaintFit> fit_all(const paint::Paint& paint, const Deadline& deadline) const;
  std::vector<IncidenceFigures> incidences(const paint::Paint& paint, const paint::LobeFit& together,
                                           const Deadline& deadline) const;

  formats::Basis basis_;
  FitOptions options_;
  brdf::GlossTable gloss_;
};

// Fits every paint on all cores; results stand in the order of the paints and do not depend on the number of threads.
std::vector<Result<PaintFit>> fits(const PaintFitter& fitter, const std::vector<paint::Paint>& paints);

}  // namespace goniochrome::fit
