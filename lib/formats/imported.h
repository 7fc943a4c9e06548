// Parts that all readers of paints share: numbers and words as files spell them, remarks about the file, names that are
// given only once, and the rule that a paint has one viewing condition and one reading at each geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "paint/geometry.h"
#include "paint/paint.h"

namespace goniochrome::formats {

// Every domain ends at 1e12 in size, beyond which no quantity of a paint lies and sums of squares lose their sense.
enum class Domain { kAny, kNotNegative, kPositive, kRefractiveIndex, kLab };

// The largest size of a CIELAB coordinate: fifty times that of any color that was ever measured.
constexpr double kMostLab = 1e4;

// The number, paint class or observer (2 or 10 deg) that `text` spells. The errors lack the place and the name of the
// value: `is "12,5": write a decimal point`.
Result<double> number_in(std::string_view text, Domain domain = Domain::kAny);
Result<paint::PaintClass> class_in(std::string_view text);
Result<int> observer_in(std::string_view text);

// Checks that L*, a* and b* are numbers of a color. The error lacks the place: `L* is 1e+50: ...`.
Result<void> check_lab(const color::Lab& lab);

// Checks that every reading and number of the paint can be written: it is finite, and a CIELAB coordinate is within its
// domain. The error names the paint. An exponent may be infinite, which is a mirror.
Result<void> check_writable(const paint::Paint& paint);

// The unit of reflectances in a file: factors, where 1 is the perfect diffuser, or percent.
enum class Scale { kUnstated, kFactor, kPercent };

// A geometry that stands for readings of which a file names none that has an aspecular angle, such as a sphere: of all,
// or of those whose viewing has these words.
struct Viewing {
  std::string words;
  paint::Geometry geometry;
};

struct ImportOptions {
  std::string illuminant;          // of the readings to take, and of files that do not state it; empty: the file's own
  int observer_deg = 0;            // likewise; 0: the file's own
  bool keep_going = false;         // leave out samples that cannot be read and say so, instead of stopping at the first
  Scale scale = Scale::kUnstated;  // of the reflectances of files that do not state it
  std::vector<Viewing> viewings = {};
};

// The condition of an illuminant in any name and of an observer, 0 where none is stated beside it. An illuminant that
// is not known keeps its name. Error, without the place: both name an observer, and not the same.
Result<color::ViewingCondition> stated_condition(std::string_view illuminant, int observer_deg);

// `stated` completed by the options where it is silent, and by `assumed` where they are silent too.
color::ViewingCondition completed(color::ViewingCondition stated, const ImportOptions& options,
                                  const color::ViewingCondition& assumed);

// Remarks about a file. Those of one kind count as one, which names the first case.
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

// The remark on a statement of a file that changes what its readings are and has no place in a paint.
std::string unheard(std::string_view key, std::string_view value);

// The geometry that a file's words on light and detector name (`45/0`, `15`, `45as15`), or that an option has for them;
// nothing for any other, such as a sphere, which is remarked.
std::optional<paint::Geometry> geometry_in_words(std::string_view words, const ImportOptions& options,
                                                 Remarks& remarks);

struct ImportedPaints {
  std::vector<paint::Paint> paints;
  std::vector<std::string> warnings;
  std::vector<std::string> skipped;  // errors that were passed over, with file and line
};

struct SeenReading {
  color::ViewingCondition condition;
  paint::LabReading reading;
};

// A paint whose readings are still being gathered.
struct OpenPaint {
  paint::Paint paint;
  std::string instrument, serial, date;  // the date as the file spells it
  std::vector<SeenReading> readings;
  std::vector<paint::SpectrumReading> spectra;  // the first at a geometry counts
  std::vector<paint::TextureReading> textures;

  // Makes the readings into one measurement: those under the first condition that the options want, and of these the
  // first at each geometry. What is left out is remarked with the paint's name. Returns whether the paint holds
  // anything then: a measurement or a gloss.
  bool complete(const ImportOptions& options, Remarks& remarks);
};

// Gives each paint a name of its own: a name that came before gets " (2)", " (3)", ...
class UniqueNames {
 public:
  std::string own(const std::string& name, Remarks& remarks);

 private:
  std::unordered_set<std::string> used_;
};

// Finds a name that comes twice among millions, in 24 bytes a name. Names are kept as hashes of 128 bits: the chance
// that two different names among 10^7 are taken for one is 10^-25.
class NameLedger {
 public:
  // Notes `name` at `line`, or returns the line where it was noted before.
  std::optional<int> note(std::string_view name, int line);

 private:
  struct Entry {
    std::uint64_t hash[2] = {0, 0};
    int line = 0;  // 0 where the slot is free
  };
  Entry& slot(const Entry& wanted);

  std::vector<Entry> slots_ = std::vector<Entry>(1024);  // open addressing, a power of two, at most half full
  std::size_t used_ = 0;
};

// The paints of one name, which their dates and codes tell apart.
class PaintLedger {
 public:
  // Gives a paint whose name was noted with another date or code a number behind its name, which is remarked. `line`,
  // from 1, is where it stands. Returns the line where its name, date and code were noted before, if they were.
  std::optional<int> note(paint::Paint& paint, int line, Remarks& remarks);

 private:
  NameLedger names_;
};

}  // namespace goniochrome::formats
