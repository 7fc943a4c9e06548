// The least squares behind inverse trompe l'oeil. Internal to lib/fit. goniochrome-theory(7), INVERSE TROMPE L'OEIL.
#pragma once

#include <functional>
#include <vector>

#include "fit/ceres_options.h"
#include "panels/trompe.h"

namespace goniochrome::panels {

// Adds the residuals of all views to a problem whose only parameter block is the seven values of paint B; three for
// each view (the Lab difference times the square root of the view's share of the weight), or, with a power p > 2, one
// (the difference over `scale`, to the power p/2).
struct ResidualShape {
  double power = 2, scale = 1;
  TrompeValues tie{};  // of a solid paint: flop minus face
  bool tied = false;
};
using TrompeModel = std::function<void(ceres::Problem&, double* values, const ResidualShape&)>;

// Paint B by its curve at the aspecular angle of each view; by `colors`, which may be any function of face, flop and
// travel, with `weights` as many as there are colors in `target`.
TrompeModel view_model(const std::vector<color::Lab>& target, const std::vector<PanelView>& views);
TrompeModel color_model(const std::vector<color::Lab>& target, const std::vector<double>& weights,
                        const PanelColors& colors);

// The least weighted RMS difference from one start.
struct TrompeSolution {
  TrompeValues values{};
  bool converged = true;
};
TrompeSolution least_rms(const TrompeModel& model, const TrompeValues& anchor, const TrompeValues& start,
                         const TrompeOptions& options, bool tied);

// Values on the way from there to the least maximum, the last of which need not be the best.
std::vector<TrompeValues> toward_least_maximum(const TrompeModel& model, const TrompeValues& anchor,
                                               const TrompeValues& start, const TrompeOptions& options, bool tied);

// For each parameter by how much the RMS difference grows when it moves by one unit and the others make up for it as
// far as they can; 0 for those held.
std::vector<double> parameter_grip(const TrompeModel& model, const TrompeValues& anchor, const TrompeValues& at,
                                   const TrompeOptions& options, bool tied);

}  // namespace goniochrome::panels
