// What trompe-fit takes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "fit/goniogeom_sets.h"
#include "fit/trompe.h"
#include "render/seam_view.h"

namespace goniochrome {

struct Options {
  cli::CommonOptions common;
  std::vector<std::string> inputs, only;
  std::string output = "-";
  std::vector<double> angle_deg;
  GeometryTexts geometries;
  double seam_deg = 90;
  std::string vary = "face_l,face_ab,flop_l,flop_ab,travel";
  std::string objective = "rms", mode = "all";
  std::vector<double> at;
  std::vector<std::string> bounds;
  std::string suffix = "_b", picture;
  SeamTexts seam;
  std::vector<std::string> dark;
};

cli::ToolSpec tool_spec(Options& options);

// A light and viewer with what both panels show there.
struct TrompeGeometry {
  LightView geometry;
  PanelView view;
};

enum class TrompeMode { kAll, kSingle, kRows };

// What the words mean, checked.
struct TrompeRequest {
  double angle_deg = 0;
  std::vector<TrompeGeometry> geometries;
  int glare = 0, below_horizon = 0, hidden = 0;  // pairs left out; hidden: the second panel faces away
  TrompeMode mode = TrompeMode::kAll;
  std::optional<TrompeGeometry> single;
  TrompeOptions fit;
};
Result<TrompeRequest> request_of(const Options& options);

// The same for a seam of a mesh.
struct TrompeSeamRequest {
  SeamWorld world;
  GeometryList geometries;  // at every place of the seam, where the world says nothing
  TrompeOptions fit;
};
Result<TrompeSeamRequest> seam_request_of(const Options& options);

}  // namespace goniochrome
