// Judgements as they are written: lines of a table, JSON, or the samples with their verdicts.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "quality/limits.h"
#include "standards.h"
#include "table_output.h"

namespace goniochrome::tool {

// One sample beside its standard.
struct Judgement {
  const Standard* standard = nullptr;
  quality::Comparison comparison;
  quality::Judged judged;

  std::string verdict() const { return judged.verdict(); }
  // All that fails, in words; beyond `most` their number.
  std::vector<std::string> words(std::size_t most = std::string::npos) const;
};

// The samples of each verdict.
struct VerdictCount {
  std::size_t passed = 0, failed = 0, incomplete = 0, without = 0;

  void add(const Judgement& judgement);
  std::size_t judged() const { return passed + failed + incomplete; }
  std::size_t negative() const { return failed + incomplete; }
  // "3 pass, 1 fail", and what else there is.
  std::string words() const;
};

Json judgement_json(const Judgement& judgement, const quality::CompareOptions& compare);

// The text of a judgement, which several threads may make at once; "" where paints are written.
std::string text_of(const Judgement& judgement, const quality::CompareOptions& compare, Format format);
std::string table_head(const quality::CompareOptions& compare);
// The sample with this verdict in the place of the one that it had.
paint::Paint with_verdict(paint::Paint sample, const Judgement& judgement);

}  // namespace goniochrome::tool
