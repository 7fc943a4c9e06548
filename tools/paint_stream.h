// Parts that the tools that take paints in and give paints out share. They open all inputs, carry the history and the
// foreign elements of these over to the output, and write each paint as soon as it is done, so that a library of any
// size passes in constant memory.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/json.h"
#include "cli/tool.h"
#include "formats/batches.h"
#include "formats/xml.h"

namespace goniochrome::tool {

// The head of a stream before its first paint: the steps that made it, and elements of other vocabularies.
struct Prolog {
  std::vector<formats::Processing> processing;
  std::vector<std::string> foreign;

  // Appends what a PaintSource, PaintReader, PaintBatches or another Prolog has.
  template <class Source>
  void take(Source& source) {
    const auto& steps = source.processing();
    const auto& others = source.foreign();
    processing.insert(processing.end(), steps.begin(), steps.end());
    foreign.insert(foreign.end(), others.begin(), others.end());
  }
};

inline void add_only_option(cli::ToolSpec& spec, std::vector<std::string>& only, const std::string& help) {
  spec.option("only", "NAME", "silver_fine", &only, help);
}

// L*, a*, b* as reports have them.
inline Json lab_json(const color::Lab& lab) {
  return {json_number(lab.L), json_number(lab.a), json_number(lab.b)};
}

// This run as a step in the history of a file.
inline formats::Processing step_of(const cli::Session& session) {
  return {session.tool(), cli::Session::version(), session.command_line()};
}

// Begins a document of paints on `file`. Its history is that of `prolog`, and this run.
inline Result<formats::PaintWriter> begin_paints(OutputFile file, Prolog prolog, const cli::Session& session) {
  prolog.processing.push_back(step_of(session));
  return formats::PaintWriter::begin(std::move(file), prolog.processing, prolog.foreign);
}
inline Result<formats::PaintWriter> begin_paints(const std::string& output, Prolog prolog,
                                                 const cli::Session& session) {
  GONIO_ASSIGN(OutputFile file, OutputFile::create(output));
  return begin_paints(std::move(file), std::move(prolog), session);
}

// Writes paints that come from no stream.
inline Result<void> write_paints(const std::string& output, const std::vector<paint::Paint>& paints,
                                 const cli::Session& session) {
  GONIO_ASSIGN(formats::PaintWriter writer, begin_paints(output, {}, session));
  for (const paint::Paint& paint : paints) GONIO_TRY(writer.write(paint));
  return writer.finish();
}

// Tells what sources found in their files.
inline void tell_warnings(const std::vector<std::string>& warnings, cli::Session& session) {
  for (const std::string& warning : warnings) session.warn(warning);
}

// All paints of a file, whose warnings are told.
inline Result<std::vector<paint::Paint>> all_paints(formats::PaintSource& source, cli::Session& session) {
  std::vector<std::string> warnings;
  auto paints = formats::read_paints(source, &warnings);
  tell_warnings(warnings, session);
  return paints;
}
inline Result<std::vector<paint::Paint>> all_paints(const std::string& reference, cli::Session& session) {
  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(reference));
  return all_paints(*source, session);
}

// Hands the paints to `take` in batches until they end. `left_out` is that of PaintBatches::next().
template <class Take>
Result<void> for_each_batch(formats::PaintBatches& paints, cli::Session& session, Take&& take,
                            const std::function<void(const Error&)>& left_out = {}) {
  for (std::size_t count = 0;;) {
    GONIO_ASSIGN(const std::vector<paint::Paint> batch, paints.next(left_out));
    tell_warnings(paints.take_warnings(), session);
    if (batch.empty()) return {};
    GONIO_TRY(take(batch));
    count += batch.size();
    session.progress(fmt::format("{}: {} paints", session.tool(), count));
  }
}

// The whole way from inputs to output: `take` gets a batch and the writer for what it makes of it.
template <class Take>
Result<void> stream_paints(const std::vector<std::string>& inputs, const std::vector<std::string>& only,
                           const std::string& output, cli::Session& session, Take&& take) {
  GONIO_ASSIGN(formats::PaintBatches paints, formats::PaintBatches::open(inputs, only));
  Prolog prolog;
  prolog.take(paints);
  GONIO_ASSIGN(formats::PaintWriter writer, begin_paints(output, std::move(prolog), session));
  GONIO_TRY(
      for_each_batch(paints, session, [&](const std::vector<paint::Paint>& batch) { return take(batch, writer); }));
  return writer.finish();
}

}  // namespace goniochrome::tool
