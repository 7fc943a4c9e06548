// The output of tools that write a table, JSON lines or paints, whichever --format names.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "base/file.h"
#include "cli/tool.h"
#include "formats/batches.h"
#include "formats/xml.h"
#include "paint_stream.h"
#include "table_output.h"

namespace goniochrome::tool {

class PaintSink {
 public:
  // Begins the output: a table with its head, paints with the history of the inputs and of this run.
  static Result<PaintSink> begin(const std::string& format, const std::string& output, const std::string& head,
                                 formats::PaintBatches& inputs, const cli::Session& session) {
    PaintSink sink;
    sink.format_ = format_of(format, output);
    Prolog prolog;
    prolog.take(inputs);
    GONIO_ASSIGN(OutputFile file, OutputFile::create(output));
    if (sink.format_ == Format::kPaints) {
      GONIO_ASSIGN(formats::PaintWriter writer, begin_paints(std::move(file), std::move(prolog), session));
      sink.writer_.emplace(std::move(writer));
      return Result(std::move(sink));
    }
    sink.file_.emplace(std::move(file));
    if (sink.format_ == Format::kTable) GONIO_TRY(sink.file_->write(head));
    return Result(std::move(sink));
  }

  Format format() const { return format_; }
  Result<void> write(const paint::Paint& paint) { return writer_->write(paint); }
  Result<void> write(const std::string& text) { return file_->write(text); }
  Result<void> flush() { return file_ ? file_->flush() : Result<void>(); }
  Result<void> finish() { return writer_ ? writer_->finish() : file_->commit(); }

 private:
  Format format_ = Format::kTable;
  std::optional<OutputFile> file_;
  std::optional<formats::PaintWriter> writer_;
};

}  // namespace goniochrome::tool
