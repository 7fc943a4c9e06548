#include "formats.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "brdf/measured.h"
#include "foreign_formats.h"
#include "formats/reference.h"

namespace goniochrome::tool {

namespace {

using formats::PaintSourcePointer;
using SinkPointer = std::unique_ptr<PaintSink>;

Result<SinkPointer> begin_xml(OutputFile file, const SinkSetup& setup) {
  GONIO_ASSIGN(formats::PaintWriter writer,
               formats::PaintWriter::begin(std::move(file), setup.prolog.processing, setup.prolog.foreign));
  return SinkPointer(std::make_unique<SinkOf<formats::PaintWriter>>(std::move(writer)));
}

Result<SinkPointer> begin_csv(OutputFile file, const SinkSetup& setup) {
  GONIO_ASSIGN(formats::CsvPaintWriter writer, formats::CsvPaintWriter::begin(std::move(file), setup.layout));
  return SinkPointer(std::make_unique<SinkOf<formats::CsvPaintWriter>>(std::move(writer)));
}

constexpr const char* kMeasured = "measured";

const std::array kOutputs = {
    OutputFormat{"xml", "paint XML", false, false, true, true, begin_xml},
    OutputFormat{"csv", "long table", true, false, true, false, begin_csv},
    OutputFormat{"wide", "wide table", true, true, false, false, begin_csv},
    OutputFormat{"cxf", "CxF3", true, false, true, true, begin_cxf},
    OutputFormat{"cgats", "CGATS text", true, false, false, true, begin_cgats},
};

}  // namespace

std::vector<std::string> input_format_names() {
  std::vector<std::string> names = {"auto", kMeasured};
  for (const formats::PaintFormat& format : formats::paint_formats()) names.emplace_back(format.name);
  return names;
}

std::vector<std::string> output_format_names() {
  std::vector<std::string> names = {"auto"};
  for (const OutputFormat& format : kOutputs) names.push_back(format.name);
  return names;
}

Result<PaintSourcePointer> open_source(const std::string& reference, const std::string& format,
                                       const SourceSetup& setup) {
  auto [path, names] = formats::paint_reference(reference);
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::string head, formats::head_of(input));
  const bool measured = format == kMeasured || (format == "auto" && brdf::looks_measured(input.name(), head));
  const auto known = std::ranges::find_if(formats::paint_formats(), [&](const formats::PaintFormat& candidate) {
    return format == "auto" ? candidate.looks(head) : candidate.name == format;
  });
  if (!measured && known == formats::paint_formats().end())
    return input_error(
        "{}: is neither paint XML nor a table, CxF, CGATS, workbook, file of an instrument or measured BRDF: name its "
        "format by --from if it is one",
        input.name());
  GONIO_ASSIGN(PaintSourcePointer source,
               measured ? open_measured(std::move(input), setup) : known->open(std::move(input), setup.import));
  if (!names) return source;
  return formats::named_paints(path, std::move(source), formats::NameChoice(std::move(*names)));
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
