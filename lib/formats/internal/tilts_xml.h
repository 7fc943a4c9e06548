// The element <tilts> of a paint: tilted lobes that stand for its color map. It has a namespace of its own, so that
// readers that do not know it keep it as they keep every other vocabulary. goniochrome-paint(5), "TILTED LOBES".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "formats/internal/xml_stream.h"
#include "paint/paint.h"

namespace goniochrome::formats {

inline constexpr std::string_view kTiltsNamespace = "urn:goniochrome:tilts:1";

// Limits of one paint. Larger counts are refused.
inline constexpr std::size_t kMostTiltSets = 8, kMostTiltedLobes = 64, kMostTiltedViews = 91;

// Hears of one <tilts> element from beginning to end. Errors name file and line.
class TiltsReader {
 public:
  explicit TiltsReader(std::string file) : file_(std::move(file)) {}

  bool active() const { return depth_ > 0; }
  Result<void> start(const XmlTag& tag);
  Result<void> text(std::string_view text, int line);
  // After the end of <tilts> itself, the reader is no longer active.
  Result<void> end(int line);
  std::vector<paint::TiltedLobes> take() { return std::move(sets_); }

 private:
  Result<void> begin_set(const XmlValues& values);
  Result<void> begin_lobe(const XmlValues& values);
  Result<void> begin_view(const XmlValues& values);
  Result<void> finish_view();

  std::string file_, text_;
  int depth_ = 0, line_ = 0;
  bool in_view_ = false;
  std::vector<paint::TiltedLobes> sets_;
};

// The element with all its sets, indented to stand in a paint; "" where there are none.
std::string tilts_element(const std::vector<paint::TiltedLobes>& sets);

}  // namespace goniochrome::formats
