// The paints that a command line names: FILE, or FILE#NAMES for some of those in a file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace goniochrome::formats {

struct PaintReference {
  std::string file;
  std::optional<std::string> name;  // of the paints that are meant
};

// FILE or FILE#NAMES, taken apart at the last # before which a file's name stands, or else at the last #. If there is a
// file of the whole name, it is meant.
PaintReference paint_reference(const std::string& text);

// A name that a paint is to have, and the most similar name of those that were seen. It keeps one of them alone.
class WantedName {
 public:
  explicit WantedName(std::string name);

  const std::string& name() const { return name_; }
  void see(std::string_view other);

  // The message that no paint has the name, and which name may have been meant.
  std::string not_found() const;

 private:
  std::string name_, lower_, nearest_;
  std::size_t distance_;  // of the nearest name; at the beginning the least one that is too large
};

// Which paints NAMES means: the one of this very name; or several names, separated by commas, in which * stands for any
// text and ? for any character.
class NameChoice {
 public:
  explicit NameChoice(std::string names);

  // True if the paint of this name is meant. Names are taken letter by letter.
  bool takes(const std::string& name);

  // Checks, at the end of a file, that some paint had each of the names. Error: names it.
  Result<void> check_all_met(const std::string& file) const;

 private:
  struct Pattern {
    std::string text;
    WantedName wanted;
    bool met = false;
  };
  std::string whole_;
  bool whole_met_ = false;
  std::vector<Pattern> patterns_;
};

}  // namespace goniochrome::formats
