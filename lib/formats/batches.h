// The paints of several inputs in batches, for tools that work on many at once and still keep up with a slow pipe.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "formats/paint_source.h"
#include "formats/reference.h"

namespace goniochrome::formats {

class PaintBatches {
 public:
  // Opens all inputs, in any format that open_paints() reads (`-`, or no input at all, is standard input). If `only`
  // has names, paints of other names are passed over. Error: the first input that cannot be opened.
  static Result<PaintBatches> open(std::vector<std::string> paths, const std::vector<std::string>& only = {});

  // The steps before the first paint of each input, in the order of the inputs.
  std::vector<Processing> processing() const;
  std::vector<std::string> foreign() const;

  // The next paints, in order; none at the end. A batch holds one paint at first, and twice as many each time, up to
  // 1024, while paints arrive quickly. `left_out`, if given, is told of each paint that cannot be read, and reading
  // goes on behind it; without it, such a paint is the error. Error at the end: a name of `only` that no paint has.
  Result<std::vector<paint::Paint>> next(const std::function<void(const Error&)>& left_out = {});

  // The warnings of the sources since the last call.
  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

 private:
  bool is_wanted(const std::string& name);

  std::vector<PaintSourcePointer> sources_;
  std::vector<std::string> warnings_;
  std::set<std::string> only_;
  std::map<std::string, WantedName> unmet_;
  std::size_t current_ = 0, size_ = 1;
};

}  // namespace goniochrome::formats
