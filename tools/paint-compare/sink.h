// Sinks of judgements: a table, JSON lines, or the samples with their verdicts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/json.h"
#include "cli/tool.h"
#include "paint_stream.h"
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

class Sink {
 public:
  static Result<Sink> begin(Format format, const quality::CompareOptions& compare, OutputFile file, Prolog prolog,
                            const cli::Session& session);

  // The text of a judgement, which several threads may make at once; "" where paints are written.
  std::string text(const Judgement& judgement) const;
  Result<void> write(const Judgement& judgement, const std::string& text, const paint::Paint& sample);
  Result<void> flush() { return file_ ? file_->flush() : Result<void>(); }
  Result<void> finish() { return writer_ ? writer_->finish() : file_->commit(); }

 private:
  Format format_ = Format::kTable;
  quality::CompareOptions compare_;
  std::optional<OutputFile> file_;
  std::optional<formats::PaintWriter> writer_;
};

}  // namespace goniochrome::tool
