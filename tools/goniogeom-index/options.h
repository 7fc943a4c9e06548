// What goniogeom-index takes.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "panels/geometry_sets.h"
#include "panels/goniogeom.h"
#include "panels/seam.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs, only;
  std::string output = "-";
  panels::GeometryTexts geometries;
  double seam_deg = 90;
  double threshold = 2.3;
  std::string metric = "de76", target = "curve";
  bool worst = false;
  std::vector<double> tolerance_for_deg;  // empty: not asked
  std::vector<std::string> curves;
  std::vector<double> misalignments_deg = {1, 2, 3, 5};
  panels::SeamTexts seam;
  std::string picture;
  bool advise = false;
};

cli::ToolSpec tool_spec(Options& options);

// What the words mean, checked.
struct IndexRequest {
  std::vector<panels::LightView> geometries;
  int glare = 0, below_horizon = 0;       // pairs left out
  std::vector<panels::TiltedPair> pairs;  // one for each geometry
  panels::DifferenceMetric metric = panels::DifferenceMetric::kDe76;
  paint::TargetCurve::Kind target = paint::TargetCurve::Kind::kCurve;
  double threshold = 2.3;
  std::optional<double> tolerance_deg;
  bool one_row = false;  // for each paint: its worst geometry
};
Result<IndexRequest> request_of(const Options& options);

// The same for a seam of a mesh.
struct SeamRequest {
  panels::SeamWorld world;
  panels::GeometryList geometries;  // at every place of the seam, where the world says nothing
  panels::DifferenceMetric metric = panels::DifferenceMetric::kDe76;
  paint::TargetCurve::Kind target = paint::TargetCurve::Kind::kCurve;
  double threshold = 2.3;
};
Result<SeamRequest> seam_request_of(const Options& options);

}  // namespace goniochrome::tool
