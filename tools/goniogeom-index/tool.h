// goniogeom-index finds the misalignment at which two panels of one paint stop matching.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
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
  std::vector<std::string> illuminants;
  bool worst = false;
  std::vector<double> tolerance_for_deg;  // empty: not asked
  std::vector<std::string> curves;
  std::vector<double> misalignments_deg = {1, 2, 3, 5};
  panels::SeamTexts seam;
  std::string picture;
  bool advise = false;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

// The run with --mesh: the panels meet at a seam of that mesh.
Result<cli::Verdict> run_on_seam(const Options& options, cli::Session& session);

// The difference that counts.
struct DifferenceRequest {
  panels::DifferenceMetric metric = panels::DifferenceMetric::kDe76;
  paint::TargetCurve::Kind target = paint::TargetCurve::Kind::kCurve;
  double threshold = 2.3;
};

// The meaning of the options, checked.
struct IndexRequest : DifferenceRequest {
  std::vector<panels::LightView> geometries;
  int below_horizon = 0;                    // pairs left out
  std::vector<panels::LightView> in_glare;  // pairs left out
  std::vector<panels::TiltedPair> pairs;    // one for each geometry
  std::optional<double> tolerance_deg;
  bool one_row = false;                  // for each paint: its worst geometry
  std::vector<std::string> illuminants;  // under which each paint is judged; none: that of its readings
};
Result<IndexRequest> request_of(const Options& options);

// The request for a seam of a mesh.
struct SeamRequest : DifferenceRequest {
  panels::SeamWorld world;
  panels::GeometryList geometries;  // at every place of the seam, where the world says nothing
};
Result<SeamRequest> seam_request_of(const Options& options);

}  // namespace goniochrome::tool
