// The tilted lobes of a run: for each paint that has a color map, sets of lobes that stand for it in image light.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/tool.h"
#include "color_maps.h"
#include "formats/basis.h"
#include "paint/paint.h"
#include "tool.h"

namespace goniochrome::tool {

// The counts of look-ups that --tilts lists; none for "none". Error: not such a list.
Result<std::vector<int>> tilt_lookups(const std::string& text);

class Tilts {
 public:
  Tilts(const Options& options, const formats::Basis& basis, cli::Session& session);

  // Error: as tilt_lookups().
  Result<void> begin();

  // Fits the tilted lobes of a paint that has lobes: to the map that was made for it in this run or, where there is
  // none, to the one that the paint names, which lies beside the file `input`. A map that cannot be read is told by a
  // warning, and the paint gets no tilted lobes. Nor does one whose new map its readings do not support.
  void add(paint::Paint& paint, const std::optional<MadeMap>& made, const std::string& input, const std::string& where);

  // Puts the number of paints with tilted lobes into the summary.
  void finish();

 private:
  const Options& options_;
  const formats::Basis& basis_;
  cli::Session& session_;
  std::vector<int> lookups_;
  int maps_ = 0, tilted_ = 0, unsupported_ = 0;
  double time_s_ = 0;
};

}  // namespace goniochrome::tool
