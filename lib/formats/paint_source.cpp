#include "formats/paint_source.h"

#include <algorithm>
#include <utility>

#include "base/encoding.h"
#include "base/text.h"
#include "formats/csv.h"
#include "formats/cxf.h"
#include "formats/importers.h"

namespace goniochrome::formats {

namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::vector<std::string> in_file(const std::string& name, std::vector<std::string> lines) {
  for (std::string& line : lines) line = fmt::format("{}: {}", name, line);
  return lines;
}

class XmlSource : public PaintSource {
 public:
  explicit XmlSource(InputFile input) : name_(input.name()), reader_(std::move(input)) {}
  Result<std::optional<paint::Paint>> next() override { return reader_.next(); }
  std::string place() const override { return fmt::format("{}:{}", name_, reader_.line()); }
  std::string format() const override { return "paint XML"; }
  bool holds_designs() const override { return true; }
  std::vector<Processing> processing() override {
    reader_.read_prolog();
    return reader_.processing();
  }
  std::vector<std::string> foreign() override {
    reader_.read_prolog();
    return reader_.foreign();
  }

 private:
  std::string name_;
  PaintReader reader_;
};

class CsvSource : public PaintSource {
 public:
  CsvSource(std::string name, CsvPaintReader reader) : name_(std::move(name)), reader_(std::move(reader)) {}
  Result<std::optional<paint::Paint>> next() override { return reader_.next(); }
  std::string place() const override { return fmt::format("{}:{}", name_, reader_.line()); }
  std::string format() const override { return reader_.is_wide() ? "wide table" : "long table"; }
  std::vector<std::string> warnings() const override { return reader_.warnings(); }
  std::vector<std::string> closing_warnings() const override { return reader_.closing_warnings(); }

 private:
  std::string name_;
  CsvPaintReader reader_;
};

// A format that is read as a whole at the first call of next(). It gives paints, and tells what was left out.
class ImportedSource : public PaintSource {
 public:
  ImportedSource(InputFile input, const ImportOptions& options, const Importer& importer)
      : name_(input.name()), importer_(importer), options_(options), input_(std::move(input)) {}

  Result<std::optional<paint::Paint>> next() override {
    if (input_) {
      InputFile input = std::move(*input_);
      input_.reset();
      GONIO_ASSIGN(imported_, importer_.read(std::move(input), options_));
    }
    if (skipped_ < imported_.skipped.size()) return input_error("{}", imported_.skipped[skipped_++]);
    if (given_ == imported_.paints.size()) return std::optional<paint::Paint>();
    return std::optional(std::move(imported_.paints[given_++]));
  }
  std::string place() const override { return name_; }
  std::string format() const override { return importer_.title; }
  std::vector<std::string> closing_warnings() const override { return in_file(name_, imported_.warnings); }

 private:
  std::string name_;
  const Importer& importer_;
  ImportOptions options_;
  std::optional<InputFile> input_;
  ImportedPaints imported_;
  std::size_t skipped_ = 0, given_ = 0;
};

// CxF is read for its specifications at the first call of next(), and then paint by paint.
class CxfSource : public PaintSource {
 public:
  CxfSource(InputFile input, const ImportOptions& options)
      : name_(input.name()), options_(options), input_(std::move(input)) {}

  Result<std::optional<paint::Paint>> next() override {
    if (input_) {
      InputFile input = std::move(*input_);
      input_.reset();
      GONIO_ASSIGN(CxfReader reader, CxfReader::open(std::move(input), options_));
      reader_.emplace(std::move(reader));
    }
    return reader_ ? reader_->next() : std::optional<paint::Paint>();
  }
  std::string place() const override { return name_; }
  std::string format() const override { return "CxF3"; }
  std::vector<std::string> closing_warnings() const override {
    return reader_ ? in_file(name_, reader_->warnings()) : std::vector<std::string>();
  }

 private:
  std::string name_;
  ImportOptions options_;
  std::optional<InputFile> input_;
  std::optional<CxfReader> reader_;
};

class NamedSource : public PaintSource {
 public:
  NamedSource(std::string file, PaintSourcePointer all, NameChoice choice)
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
  std::vector<Processing> processing() override { return all_->processing(); }
  std::vector<std::string> foreign() override { return all_->foreign(); }
  std::vector<std::string> warnings() const override { return all_->warnings(); }
  std::vector<std::string> closing_warnings() const override { return all_->closing_warnings(); }
  Json figures() const override { return all_->figures(); }

 private:
  std::string file_;
  PaintSourcePointer all_;
  std::optional<NameChoice> choice_;  // until the end was met
};

bool looks_xml(std::string_view head) {
  return trimmed(head).starts_with('<');
}

bool looks_table(std::string_view head) {
  const std::string_view line = head.substr(0, head.find_first_of("\r\n", head.find_first_not_of("\r\n \t")));
  return line.find_first_of(",;\t") != std::string_view::npos;
}

Result<PaintSourcePointer> open_xml(InputFile input, const ImportOptions&) {
  return PaintSourcePointer(std::make_unique<XmlSource>(std::move(input)));
}

Result<PaintSourcePointer> open_csv(InputFile input, const ImportOptions& options) {
  std::string name = input.name();
  GONIO_ASSIGN(CsvPaintReader reader, CsvPaintReader::open(std::move(input), options.scale));
  return PaintSourcePointer(std::make_unique<CsvSource>(std::move(name), std::move(reader)));
}

Result<PaintSourcePointer> open_cxf(InputFile input, const ImportOptions& options) {
  return PaintSourcePointer(std::make_unique<CxfSource>(std::move(input), options));
}

template <const Importer& importer>
PaintFormat imported() {
  return {importer.name, importer.looks, [](InputFile input, const ImportOptions& options) {
            return Result<PaintSourcePointer>(std::make_unique<ImportedSource>(std::move(input), options, importer));
          }};
}

}  // namespace

const std::vector<PaintFormat>& paint_formats() {
  static const std::vector<PaintFormat> formats = {
      imported<kWorkbook>(),
      {"cxf", looks_cxf, open_cxf},
      {"xml", looks_xml, open_xml},
      imported<kJcamp>(),
      imported<kCgats>(),
      imported<kXtf>(),
      imported<kMif>(),
      imported<kQtx>(),
      imported<kMtf>(),
      {"csv", looks_table, open_csv},
  };
  return formats;
}

Result<std::string> head_of(InputFile& input) {
  GONIO_ASSIGN(const std::string_view bytes, input.peek());
  std::string head = as_utf8(bytes);
  if (head.starts_with(kByteOrderMark)) head.erase(0, kByteOrderMark.size());
  if (head.empty()) return input_error("{}: is empty: give it paints", input.name());
  return head;
}

PaintSourcePointer named_paints(std::string file, PaintSourcePointer all, NameChoice choice) {
  return std::make_unique<NamedSource>(std::move(file), std::move(all), std::move(choice));
}

Result<PaintSourcePointer> open_paints(const std::string& reference, const ImportOptions& options) {
  auto [path, names] = paint_reference(reference);
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  return open_paints(std::move(input), std::move(names), options);
}

Result<PaintSourcePointer> open_paints(InputFile input, std::optional<std::string> names,
                                       const ImportOptions& options) {
  GONIO_ASSIGN(const std::string head, head_of(input));
  const auto format =
      std::ranges::find_if(paint_formats(), [&](const PaintFormat& candidate) { return candidate.looks(head); });
  if (format == paint_formats().end())
    return input_error(
        "{}: is neither paint XML nor a table, CxF, CGATS, workbook or file of an instrument: convert it by "
        "paint-convert",
        input.name());
  std::string name = input.name();
  GONIO_ASSIGN(PaintSourcePointer source, format->open(std::move(input), options));
  if (!names) return source;
  return named_paints(std::move(name), std::move(source), NameChoice(std::move(*names)));
}

Result<std::vector<paint::Paint>> read_paints(const std::string& reference, std::vector<std::string>* warnings) {
  GONIO_ASSIGN(const PaintSourcePointer source, open_paints(reference));
  return read_paints(*source, warnings);
}

Result<std::vector<paint::Paint>> read_paints(PaintSource& source, std::vector<std::string>* warnings) {
  std::vector<paint::Paint> paints;
  for (;;) {
    GONIO_ASSIGN(std::optional<paint::Paint> paint, source.next());
    if (!paint) break;
    paints.push_back(std::move(*paint));
  }
  if (warnings)
    for (const auto& lines : {source.warnings(), source.closing_warnings()})
      warnings->insert(warnings->end(), lines.begin(), lines.end());
  return paints;
}

}  // namespace goniochrome::formats
