// The color maps of a run: one file for each paint, in one folder.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "brdf/measured.h"
#include "cli/tool.h"
#include "fit/color_map_fit.h"
#include "tool.h"

namespace goniochrome::tool {

struct MadeMap {
  brdf::ColorMap map;
  bool supported = true;  // isolines were asked for, or predict left-out readings better by two standard errors
};

class ColorMaps {
 public:
  ColorMaps(const Options& options, cli::Session& session);

  // Makes the folder, if maps are asked for. Error: it cannot be made.
  Result<void> begin() const;

  // Makes the map of a paint from its readings or, where it has one, from its measured BRDF, and names it in the paint.
  // A paint that cannot have one is left as it is, and a warning says so. Returns the map, if one was made. Error: the
  // file cannot be written.
  Result<std::optional<MadeMap>> add(paint::Paint& paint, const brdf::MeasuredBrdf* brdf, const std::string& where);

  // Puts the number of maps into the report and the summary.
  void finish();

 private:
  std::string file_name(const std::string& paint);
  void tell_model(const fit::ColorMapFit& fit, const std::string& name);

  const Options& options_;
  cli::Session& session_;
  std::set<std::string> names_;
  int made_ = 0, without_ = 0, aspecular_ = 0, told_ = 0;
  double sum_held_out_ = 0;
};

}  // namespace goniochrome::tool
