// The paints of --paint as they come, fitted on the way.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "brdf/color_map.h"
#include "formats/paint_source.h"
#include "paints.h"
#include "tool.h"

namespace goniochrome::tool {

// A paint that came, or why one did not.
struct SourcePaint {
  std::size_t number = 0;                     // from 1, failed ones included
  paint::Paint paint;                         // with lobes, unless it failed
  std::shared_ptr<const brdf::ColorMap> map;  // of the paint, or null
  std::string follower;                       // the name of the paint behind it, where next() was asked for that
  std::optional<Error> failure;               // names the paint or the place in the file
};

class PaintSource {
 public:
  // Opens --paint, which may be "-", FILE or FILE#NAMES, in any format of paints, and reads --basis. Error: either
  // cannot be read.
  static Result<PaintSource> open(const Options& options);

  // The next paint; false at the end. With `look_ahead`, its follower is told, for which it waits. A paint that cannot
  // be read, that has no lobes and cannot be fitted, or whose color map cannot be read has a failure.
  bool next(bool look_ahead, SourcePaint& paint);

  // Remarks about the file, complete at its end.
  std::vector<std::string> remarks() const;

 private:
  PaintSource(formats::PaintSourcePointer reader, Fitting fitting, std::string file)
      : reader_(std::move(reader)), fitting_(std::move(fitting)), file_(std::move(file)) {}
  using Read = Result<std::optional<paint::Paint>>;

  formats::PaintSourcePointer reader_;
  Fitting fitting_;
  std::string file_;
  std::optional<Read> ahead_;
  std::size_t count_ = 0;
};

}  // namespace goniochrome::tool
