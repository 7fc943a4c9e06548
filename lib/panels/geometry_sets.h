// Which lights and viewers look at two panels: the lists, ranges and names that a command line spells.
// goniochrome-panels(7), "GONIOGEOMETRIC INDEX".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "panels/goniogeom.h"

namespace goniochrome::panels {

// Viewers nearer to the mirror direction than this see gloss, in which panels may differ; the index leaves them out.
constexpr double kIndexGlare_deg = 10;

// A set with a name: typical lights and viewers.
struct GeometrySet {
  const char* name;
  const char* lights;  // as --lights takes them
  const char* views;
  const char* meaning;
};
const std::vector<GeometrySet>& geometry_sets();

// Lights, views and azimuths as texts: comma-separated numbers, ranges FIRST:LAST:STEP and `set:NAME`; a view (or the
// first number of a range of views) that starts with `as` is an aspecular angle, positive toward the light.
struct GeometryTexts {
  std::string lights = "45", views = "set:instrument", azimuths = "0";
  std::vector<double> light_weights = {}, view_weights = {};  // one for each, or none: all 1
};

// All lights with all viewers, in the order given. Pairs within kIndexGlare_deg of the mirror direction, and viewers
// given by an aspecular angle that lie below the horizon, are left out and named. Error (usage): a text cannot be
// read, or nothing is left.
struct GeometryList {
  std::vector<LightView> pairs;
  std::vector<double> weights;       // of the pairs: the light's times the view's
  int glare = 0, below_horizon = 0;  // left out
  std::vector<LightView> left_out;   // those in the glare, in the order given
};
Result<GeometryList> geometry_list(const GeometryTexts& texts);

// The lights alone, in degrees.
Result<std::vector<double>> light_angles(const std::string& text);

// The unsigned aspecular angle (deg) at the first panel.
double aspecular_deg(const LightView& geometry);

}  // namespace goniochrome::panels
