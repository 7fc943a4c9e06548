// What goniogeom-index takes.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "fit/goniogeom.h"
#include "fit/goniogeom_sets.h"
#include "render/seam_view.h"

namespace goniochrome {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs, only;
  std::string output = "-";
  GeometryTexts geometries;
  double seam_deg = 90;
  double threshold = 2.3;
  std::string metric = "de76", target = "curve";
  bool worst = false;
  std::vector<double> tolerance_for_deg;  // empty: not asked
  std::vector<std::string> curves;
  std::vector<double> misalignments_deg = {1, 2, 3, 5};
  SeamTexts seam;
  std::string picture;
  bool advise = false;
};

cli::ToolSpec tool_spec(Options& options);

// What the words mean, checked.
struct IndexRequest {
  std::vector<LightView> geometries;
  int glare = 0, below_horizon = 0;  // pairs left out
  std::vector<TiltedPair> pairs;     // one for each geometry
  DifferenceMetric metric = DifferenceMetric::kDe76;
  TargetCurve::Kind target = TargetCurve::Kind::kCurve;
  double threshold = 2.3;
  std::optional<double> tolerance_deg;
  bool one_row = false;  // for each paint: its worst geometry
};
Result<IndexRequest> request_of(const Options& options);

// The same for a seam of a mesh.
struct SeamRequest {
  SeamWorld world;
  GeometryList geometries;  // at every place of the seam, where the world says nothing
  DifferenceMetric metric = DifferenceMetric::kDe76;
  TargetCurve::Kind target = TargetCurve::Kind::kCurve;
  double threshold = 2.3;
};
Result<SeamRequest> seam_request_of(const Options& options);

}  // namespace goniochrome
