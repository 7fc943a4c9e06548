// Where findings go: a table, JSON lines, the matched paints themselves, or the queries with the codes of these.
#pragma once

#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "base/file.h"
#include "base/json.h"
#include "cli/tool.h"
#include "finding.h"
#include "paint_stream.h"
#include "streamed_library.h"
#include "table_output.h"

namespace goniochrome::tool {

Json finding_json(const Finding& finding, const library::LibraryIndex& index);

// Passes the queries on as paints, each with the code of the paint nearest to it, which is where a formulation starts.
class CodeSink {
 public:
  static Result<CodeSink> begin(OutputFile file, Prolog prolog, const cli::Session& session);
  // Writes the query with the code of its nearest paint, or with its own where nothing was found. Returns the name of a
  // nearest paint that has no code; its name then stands for it.
  Result<std::string> write(paint::Paint query, const Finding* finding, const library::LibraryIndex& index);
  Result<void> finish() { return writer_.finish(); }

 private:
  explicit CodeSink(formats::PaintWriter writer) : writer_(std::move(writer)) {}
  formats::PaintWriter writer_;
};

class Sink {
 public:
  // With `lights` a table tells in which light each distance is largest.
  static Result<Sink> begin(Format format, bool lights, OutputFile file);
  Result<void> write(const Finding& finding, const library::LibraryIndex& index);
  Result<void> flush() { return file_.flush(); }
  // Ends the output. The matched paints are read from the library, or taken from one that was a stream; the index knows
  // their places in it. The run joins the library's history.
  Result<void> finish(const std::string& library_path, const std::optional<StreamedLibrary>& streamed,
                      const cli::Session& session);

 private:
  Sink(Format format, bool lights, OutputFile file) : format_(format), lights_(lights), file_(std::move(file)) {}
  Result<void> write_paints(const std::string& library_path, const std::optional<StreamedLibrary>& streamed,
                            const cli::Session& session);

  Format format_;
  bool lights_;
  OutputFile file_;
  std::vector<std::uint32_t> wanted_;  // library paints, in the order they were first met
  std::unordered_set<std::uint32_t> met_;
};

}  // namespace goniochrome::tool
