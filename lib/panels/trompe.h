// Inverse trompe l'oeil: the paint for the second panel that hides its misalignment. [Shimizu2009] 4.4
// goniochrome-panels(7), "INVERSE TROMPE L'OEIL".
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "panels/goniogeom.h"

namespace goniochrome::panels {

// The view of both panels by one viewer under one light: the aspecular angles, the cosines to the light, and the
// cosines to the viewer.
struct PanelView {
  double aspecular_a_deg = 45, cos_a = 1;
  double aspecular_b_deg = 45, cos_b = 1;
  double weight = 1;
  double cos_view_a = 1, cos_view_b = 1;

  // The view of panels under a coat of that index: each cosine to the light times the transmission of the coat, see
  // brdf::coat_passages_to_reading(). Without a coat it is the same.
  PanelView under_coat(double coat_index) const;
};
std::vector<PanelView> under_coat(std::vector<PanelView> views, double coat_index);
// The view where the second panel is turned by b (deg); none where that panel is not seen.
std::optional<PanelView> panel_view(const LightView& geometry, double seam_deg, double b_deg);

// The seven numbers of an appearance, in this order.
enum TrompeParameter { kFaceL, kFaceA, kFaceB, kFlopL, kFlopA, kFlopB, kTravel, kTrompeParameters };
using TrompeValues = std::array<double, kTrompeParameters>;
const char* parameter_name(int parameter);  // "face_l", ..., "travel"
TrompeValues values_of(const paint::Appearance& appearance);
paint::Appearance appearance_of(const TrompeValues& values);

struct TrompeOptions {
  std::array<bool, kTrompeParameters> vary = {true, true, true, true, true, true, true};
  TrompeValues low = {0, -150, -150, 0, -150, -150, 15.5}, high = {160, 150, 150, 160, 150, 150, 180};
  bool least_maximum = false;  // minimize the largest difference, else the weighted RMS
};

// Where face and flop differ by less than this, noise would decide the travel. Such a paint counts as solid: its face
// and flop move together, and its travel stays.
constexpr double kSolidContrast = 1;

// The views leave a parameter open where it may move by one unit (Lab or degree) and the others make up for it to
// within this RMS difference.
constexpr double kDeterminedBy = 0.02;

struct TrompeErrors {
  std::vector<double> de;  // dE76 for each view
  double rms = 0, max = 0;
};

struct TrompeFit {
  paint::Appearance b;
  TrompeErrors before, after;             // with both panels in paint A, and with the second one in paint B
  std::vector<std::string> undetermined;  // parameters that the views leave open; they stay near those of paint A
  std::vector<std::string> at_bound;      // parameters that a bound holds back
  bool solid = false;                     // face and flop were moved together
  bool converged = true;                  // from every start
  int starts = 0;
  double time_ms = 0;
};

// The paint for the second panel. Color differences are CIE 1976. Deterministic. Error: no views, nothing to vary, a
// bound that excludes every value, or paint A outside its domain.
Result<TrompeFit> trompe_fit(const paint::Appearance& a, bool is_solid, const std::vector<PanelView>& views,
                             const TrompeOptions& options);

// Variant for colors from anywhere, such as an environment: `colors` gives the colors of the second panel in every view
// for an appearance, and `target` holds those of the first panel in paint A. Derivatives are found by differences.
using PanelColors = std::function<Result<std::vector<color::Lab>>(const paint::Appearance&)>;
Result<TrompeFit> trompe_fit(const paint::Appearance& a, bool is_solid, const std::vector<color::Lab>& target,
                             const std::vector<double>& weights, const PanelColors& colors,
                             const TrompeOptions& options);

// The differences between what both panels show. The RMS is weighted.
TrompeErrors trompe_errors(const std::vector<color::Lab>& a, const std::vector<color::Lab>& b,
                           const std::vector<double>& weights);

// The differences that a paint B leaves.
TrompeErrors trompe_errors(const paint::Appearance& a, const paint::Appearance& b, const std::vector<PanelView>& views);

}  // namespace goniochrome::panels
