// trompe-fit finds the paint that hides a misaligned panel.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/tool.h"
#include "panels/geometry_sets.h"
#include "panels/seam.h"
#include "panels/trompe.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs, only;
  std::string output = "-";
  std::vector<double> angle_deg;
  panels::GeometryTexts geometries;
  double seam_deg = 90;
  std::string vary = "face_l,face_ab,flop_l,flop_ab,travel";
  std::string objective = "rms", mode = "all";
  std::vector<double> at;
  std::vector<std::string> bounds;
  std::string suffix = "_b", picture;
  panels::SeamTexts seam;
  std::vector<std::string> dark;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

// The run with --mesh: the panels meet at a seam of that mesh.
Result<cli::Verdict> run_on_seam(const Options& options, cli::Session& session);

// A light and a viewer, with what both panels show there.
struct TrompeGeometry {
  panels::LightView geometry;
  panels::PanelView view;
};

enum class TrompeMode { kAll, kSingle, kRows };

// The meaning of the options, checked.
struct TrompeRequest {
  double angle_deg = 0;
  std::vector<TrompeGeometry> geometries;
  int below_horizon = 0, hidden = 0;  // pairs left out; hidden are those whose viewer does not see the second panel
  std::vector<panels::LightView> in_glare;  // pairs left out
  TrompeMode mode = TrompeMode::kAll;
  std::optional<TrompeGeometry> single;
  panels::TrompeOptions fit;
};
Result<TrompeRequest> request_of(const Options& options);

// The request for a seam of a mesh.
struct TrompeSeamRequest {
  panels::SeamWorld world;
  panels::GeometryList geometries;  // at every place of the seam, where the world says nothing
  panels::TrompeOptions fit;
};
Result<TrompeSeamRequest> seam_request_of(const Options& options);

}  // namespace goniochrome::tool
