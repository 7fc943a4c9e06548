#include "formats.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "brdf/measured.h"
#include "foreign_formats.h"
#include "formats/cxf.h"
#include "formats/encoding.h"
#include "formats/importers.h"
#include "formats/reference.h"

namespace goniochrome::tool {

namespace {

class XmlSource : public PaintSource {
 public:
  explicit XmlSource(InputFile input) : name_(input.name()), reader_(std::move(input)) {}
  Result<std::optional<paint::Paint>> next() override { return reader_.next(); }
  std::string place() const override { return fmt::format("{}:{}", name_, reader_.line()); }
  std::string format() const override { return "paint XML"; }
  bool holds_designs() const override { return true; }
  Prolog prolog() override {
    reader_.read_prolog();
    return {reader_.processing(), reader_.foreign()};
  }

 private:
  std::string name_;
  formats::PaintReader reader_;
};

class CsvSource : public PaintSource {
 public:
  CsvSource(std::string name, formats::CsvPaintReader reader) : name_(std::move(name)), reader_(std::move(reader)) {}
  Result<std::optional<paint::Paint>> next() override { return reader_.next(); }
  std::string place() const override { return fmt::format("{}:{}", name_, reader_.line()); }
  std::string format() const override { return reader_.is_wide() ? "wide table" : "long table"; }
  std::vector<std::string> warnings() const override { return reader_.warnings(); }
  std::vector<std::string> closing_warnings() const override { return reader_.closing_warnings(); }

 private:
  std::string name_;
  formats::CsvPaintReader reader_;
};

using SourcePointer = std::unique_ptr<PaintSource>;

// The paints of a source that have certain names.
class NamedSource : public PaintSource {
 public:
  NamedSource(std::string file, SourcePointer all, formats::NameChoice choice)
      : file_(std::move(file)), all_(std::move(all)), choice_(std::move(choice)) {}
  Result<std::optional<paint::Paint>> next() override {
    for (;;) {
      GONIO_ASSIGN(std::optional<paint::Paint> paint, all_->next());
      if (paint && !choice_->takes(paint->name)) continue;
      if (!paint)
        if (const auto choice = std::exchange(choice_, std::nullopt)) GONIO_TRY(choice->check_all_met(file_));
      return paint;
    }
  }
  std::string place() const override { return all_->place(); }
  std::string format() const override { return all_->format(); }
  bool holds_designs() const override { return all_->holds_designs(); }
  Prolog prolog() override { return all_->prolog(); }
  std::vector<std::string> warnings() const override { return all_->warnings(); }
  std::vector<std::string> closing_warnings() const override { return all_->closing_warnings(); }
  Json figures() const override { return all_->figures(); }
  bool takes_condition() const override { return all_->takes_condition(); }

 private:
  std::string file_;
  SourcePointer all_;
  std::optional<formats::NameChoice> choice_;  // until the end was met
};
using SinkPointer = std::unique_ptr<PaintSink>;

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// The formats look at the first bytes without a byte order mark, and at those of UTF-16 as UTF-8.
bool looks_xml(std::string_view, std::string_view head) {
  return trimmed(head).starts_with('<');
}

bool looks_cxf_document(std::string_view, std::string_view head) {
  return formats::looks_cxf(head);
}

bool looks_table(std::string_view, std::string_view head) {
  const std::string_view line = head.substr(0, head.find_first_of("\r\n", head.find_first_not_of("\r\n \t")));
  return line.find_first_of(",;\t") != std::string_view::npos;
}

Result<SourcePointer> open_xml(InputFile input, const SourceSetup&) {
  return SourcePointer(std::make_unique<XmlSource>(std::move(input)));
}

Result<SourcePointer> open_csv(InputFile input, const SourceSetup& setup) {
  std::string name = input.name();
  GONIO_ASSIGN(formats::CsvPaintReader reader, formats::CsvPaintReader::open(std::move(input), setup.import.scale));
  return SourcePointer(std::make_unique<CsvSource>(std::move(name), std::move(reader)));
}

Result<SinkPointer> begin_xml(OutputFile file, const SinkSetup& setup) {
  GONIO_ASSIGN(formats::PaintWriter writer,
               formats::PaintWriter::begin(std::move(file), setup.prolog.processing, setup.prolog.foreign));
  return SinkPointer(std::make_unique<SinkOf<formats::PaintWriter>>(std::move(writer)));
}

Result<SinkPointer> begin_csv(OutputFile file, const SinkSetup& setup) {
  GONIO_ASSIGN(formats::CsvPaintWriter writer, formats::CsvPaintWriter::begin(std::move(file), setup.layout));
  return SinkPointer(std::make_unique<SinkOf<formats::CsvPaintWriter>>(std::move(writer)));
}

struct InputFormat {
  const char* name;
  bool (*looks)(std::string_view path, std::string_view head);
  Result<SourcePointer> (*open)(InputFile input, const SourceSetup& setup);
};
template <const formats::Importer& importer>
constexpr InputFormat imported() {
  return {importer.name, [](std::string_view, std::string_view head) { return importer.looks(head); },
          [](InputFile input, const SourceSetup& setup) { return open_imported(std::move(input), setup, importer); }};
}

// In the order in which they are tried.
constexpr std::array kInputs = {
    InputFormat{"measured", brdf::looks_measured, open_measured},
    imported<formats::kWorkbook>(),
    InputFormat{"cxf", looks_cxf_document, open_cxf},
    InputFormat{"xml", looks_xml, open_xml},
    imported<formats::kJcamp>(),
    imported<formats::kCgats>(),
    imported<formats::kXtf>(),
    imported<formats::kMif>(),
    imported<formats::kQtx>(),
    imported<formats::kMtf>(),
    InputFormat{"csv", looks_table, open_csv},
};

const std::array kOutputs = {
    OutputFormat{"xml", "paint XML", false, false, true, true, begin_xml},
    OutputFormat{"csv", "long table", true, false, true, false, begin_csv},
    OutputFormat{"wide", "wide table", true, true, false, false, begin_csv},
    OutputFormat{"cxf", "CxF3", true, false, true, true, begin_cxf},
    OutputFormat{"cgats", "CGATS text", true, false, false, true, begin_cgats},
};

}  // namespace

std::vector<std::string> input_format_names() {
  std::vector<std::string> names = {"auto"};
  for (const InputFormat& format : kInputs) names.emplace_back(format.name);
  return names;
}

std::vector<std::string> output_format_names() {
  std::vector<std::string> names = {"auto"};
  for (const OutputFormat& format : kOutputs) names.push_back(format.name);
  return names;
}

Result<SourcePointer> open_source(const std::string& reference, const std::string& format, const SourceSetup& setup) {
  auto [path, names] = formats::paint_reference(reference);
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::string_view bytes, input.peek());
  std::string head = formats::as_utf8(bytes);
  if (head.starts_with(kByteOrderMark)) head.erase(0, kByteOrderMark.size());
  if (head.empty()) return input_error("{}: is empty: give it paints", input.name());
  const auto* known = std::ranges::find_if(kInputs, [&](const InputFormat& candidate) {
    return format == "auto" ? candidate.looks(input.name(), head) : candidate.name == format;
  });
  if (known == kInputs.end())
    return input_error(
        "{}: is neither paint XML nor a table, CxF, CGATS, workbook, file of an instrument or measured BRDF: name its "
        "format by --from if it is one",
        input.name());
  GONIO_ASSIGN(SourcePointer source, known->open(std::move(input), setup));
  if (!names) return source;
  return SourcePointer(std::make_unique<NamedSource>(path, std::move(source), formats::NameChoice(std::move(*names))));
}

Result<const OutputFormat*> output_format(const std::string& path, const std::string& format) {
  std::string wanted = format;
  if (format == "auto") {
    const std::string name = lower(path);
    const bool is_stream = path == "-" || path.starts_with("/dev/");
    wanted = is_stream || name.ends_with(".xml")                  ? "xml"
             : name.ends_with(".csv")                             ? "csv"
             : name.ends_with(".cxf")                             ? "cxf"
             : name.ends_with(".cgats") || name.ends_with(".txt") ? "cgats"
                                                                  : "";
  }
  const auto* known = std::ranges::find(kOutputs, wanted, &OutputFormat::name);
  if (known == kOutputs.end())
    return usage_error(
        "the format of {} cannot be told from its name: end it in .xml, .csv, .cxf or .cgats, or give --to", path);
  return known;
}

}  // namespace goniochrome::tool
