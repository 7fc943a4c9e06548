// What the readers of other people's formats share: options, remarks, and the rule that a paint has one viewing
// condition and one reading at each geometry.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/input.h"
#include "base/result.h"
#include "color/color.h"
#include "paint/paint.h"

namespace goniochrome::formats {

struct ImportOptions {
  std::string illuminant;   // the readings to take, or what is meant where the file does not say; empty: the file's own
  int observer_deg = 0;     // likewise; 0: the file's own
  bool keep_going = false;  // leave out samples that cannot be read and say so, instead of stopping at the first
};

// Remarks of one kind count as one, with the first case named.
class Remarks {
 public:
  void note(const std::string& what, std::string_view example);
  // `what (example and 11 more)`, in the order of first appearance.
  std::vector<std::string> lines() const;

 private:
  struct Kind {
    std::string what, example;
    std::size_t count = 0;
  };
  std::vector<Kind> kinds_;
};

struct ImportedPaints {
  std::vector<paint::Paint> paints;
  std::vector<std::string> warnings;
  std::vector<std::string> skipped;  // errors passed over, with file and line
};

struct SeenReading {
  color::ViewingCondition condition;
  paint::LabReading reading;
};

// Whether `options` want readings under `condition`.
bool is_wanted(const color::ViewingCondition& condition, const ImportOptions& options);

// The readings as one measurement: those under the first wanted condition, the first at each geometry; what is left out
// is remarked with the paint's name. Nothing where none is wanted.
std::optional<paint::Measurement> measurement_of(const std::vector<SeenReading>& readings, const ImportOptions& options,
                                                 std::string_view paint, Remarks& remarks);

// All that `input` has left. Error: more than `most` bytes.
Result<std::string> whole_content(InputFile& input, std::size_t most);

// Gives each paint a name of its own: a name that was there before gets " (2)", " (3)", ...
class UniqueNames {
 public:
  std::string own(const std::string& name, Remarks& remarks);

 private:
  std::unordered_set<std::string> used_;
};

}  // namespace goniochrome::formats
