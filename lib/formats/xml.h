// Paint XML (`*.paints.xml`) as a stream in constant memory: checked while it is read, and written paint by paint.
// goniochrome-paint(5) describes the format.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/file.h"
#include "base/result.h"
#include "formats/reference.h"
#include "paint/paint.h"

namespace goniochrome::formats {

// The bounds of one paint. Larger paints are refused.
constexpr std::size_t kLargestPaint_bytes = 16 << 20;
constexpr std::size_t kMostRows = 10000;

// One `<processing tool version command>` element, which names a tool that the paints went through.
struct Processing {
  std::string tool, version, command;
};

class PaintReader {
 public:
  // Opens `path` ("-" is standard input), or FILE#NAMES for the paints of FILE that have these names; or goes on with
  // an open file. Errors name file and line.
  static Result<PaintReader> open(const std::string& path);
  explicit PaintReader(InputFile input, std::optional<NameChoice> choice = {});
  PaintReader(PaintReader&&) noexcept;
  PaintReader& operator=(PaintReader&&) noexcept;
  ~PaintReader();

  // The next paint that is wanted, or nothing at the end; a name that no paint had is an error there. A wrong value
  // loses the paint that it stands in: after such an error next() goes on behind that paint. After any other error
  // (text that is not XML, a file cut off) it returns nothing.
  Result<std::optional<paint::Paint>> next();

  // The line (from 1) of the start tag of the paint last returned.
  int line() const;

  // Reads as far as the first paint. If it meets an error, next() will return it.
  void read_prolog();

  // Provenance and foreign elements that stood before the first paint; complete once next() or read_prolog() was
  // called.
  const std::vector<Processing>& processing() const;
  const std::vector<std::string>& foreign() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class PaintWriter {
 public:
  // Begins a document on `file` with the given history and foreign elements.
  static Result<PaintWriter> begin(OutputFile file, const std::vector<Processing>& history = {},
                                   const std::vector<std::string>& foreign = {});
  // Writes one paint, and hands it on at once if the output is standard output or a pipe. Error: a text that XML cannot
  // hold (a control character, bytes that are not UTF-8), or an error of the output.
  Result<void> write(const paint::Paint& paint);
  // Ends the document and puts the file in place.
  Result<void> finish();

 private:
  explicit PaintWriter(OutputFile file) : file_(std::move(file)), is_stream_(file_.scratch_path().empty()) {}
  OutputFile file_;
  bool is_stream_;
};

}  // namespace goniochrome::formats
