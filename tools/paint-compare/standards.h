// The standards of a run, and which of them a sample is compared with.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "library/search.h"
#include "quality/comparison.h"
#include "quality/limits.h"
#include "tool.h"

namespace goniochrome::tool {

struct Standard {
  quality::Subject subject;
  std::vector<quality::Limit> limits;
};

class Standards {
 public:
  // Reads the standards and their limits: those of --limits, or else those that each standard carries. Error: a file
  // that cannot be read, no standard, two that cannot be told apart, a standard without color.
  static Result<Standards> open(const Options& options, cli::Session& session);

  const std::vector<Standard>& all() const { return standards_; }
  bool has_limits() const;

  // The standard of a sample. Several threads may call it at once. Error: there is none.
  Result<const Standard*> of(const paint::Paint& sample) const;

 private:
  enum class Pair { kOne, kName, kCode, kNearest };
  Result<void> read(const Options& options, cli::Session& session);
  Result<void> prepare_names(const Options& options);
  Result<void> prepare_search();

  Pair pair_ = Pair::kOne;
  std::vector<Standard> standards_;
  std::unordered_map<std::string, std::size_t> places_;  // by name or code
  std::unique_ptr<library::LibraryIndex> index_;
  std::unique_ptr<library::LibrarySearch> search_;
};

}  // namespace goniochrome::tool
