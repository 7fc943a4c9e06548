#include <algorithm>
#include <cmath>
#include <map>

#include "base/text.h"
#include "color/illuminant.h"
#include "formats/importers.h"
#include "formats/internal/sections.h"
#include "formats/internal/spectral_records.h"
#include "paint/date.h"

namespace goniochrome::formats {

namespace {

// A section of a standard or batch: the values of its keys without STD_ or BAT_, and their lines.
struct QtxSection {
  bool is_batch = false;
  std::map<std::string, std::pair<std::string, int>, std::less<>> fields;

  // The value without the comma that some programs put behind each; "" where it is missing.
  std::string text(std::string_view key) const {
    const auto found = fields.find(key);
    if (found == fields.end()) return "";
    std::string_view value = found->second.first;
    while (value.ends_with(',')) value.remove_suffix(1);
    return std::string(trimmed(value));
  }
  std::optional<double> number(std::string_view key) const { return parse_number(text(key)); }
  int line(std::string_view key) const {
    const auto found = fields.find(key);
    return found == fields.end() ? 0 : found->second.second;
  }
};

class QtxParser {
 public:
  QtxParser(const std::string& file, std::string_view text, const ImportOptions& options)
      : lines_(text), import_(file, "QTX", options) {}

  Result<ImportedPaints> parse() {
    for (;;) {
      const auto more = lines_.next();
      if (!more.ok()) {
        GONIO_TRY(import_.refuse(lines_.line(), more.error().message));
        is_bad_ = true;
        continue;
      }
      if (!*more) break;
      if (lines_.begins_section()) {
        GONIO_TRY(close());
        begin();
      } else if (open_) {
        GONIO_TRY(take_key());
      }
    }
    if (lines_.is_unfinished() && open_ && lines_.key().ends_with("_R"))
      import_.remarks().note(
          fmt::format("the file ends within line {}, a spectrum, whose last value may be cut off", lines_.line()), "");
    GONIO_TRY(close());
    return import_.finish();
  }

 private:
  void begin() {
    const std::string& name = lines_.section();
    is_bad_ = false;
    if (name.starts_with("STANDARD") || name.starts_with("BATCH"))
      open_.emplace().is_batch = name.starts_with("BATCH");
    else
      import_.remarks().note("sections other than STANDARD and BATCH are not read", "[" + shown(name) + "]");
  }

  // Batches name their standard by STD_NAME, and some programs write standards with the keys of batches.
  Result<void> take_key() {
    std::string key = lines_.key();
    const bool of_batch = key.starts_with("BAT_");
    if (!of_batch && !key.starts_with("STD_")) return {};
    if (open_->is_batch && !of_batch) return {};
    key.erase(0, 4);
    if (key == "NAME" && !open_->is_batch && of_batch && open_->fields.contains(key)) return {};
    const auto [found, fresh] = open_->fields.try_emplace(key, std::string(lines_.value()), lines_.line());
    if (fresh || is_bad_) return {};
    is_bad_ = true;
    return import_.refuse(
        lines_.line(), fmt::format("{} stands in this section a second time, after line {}: remove one", lines_.key(),
                                   found->second.second));
  }

  Result<void> close() {
    if (!open_) return {};
    const QtxSection section = std::move(*open_);
    open_.reset();
    if (is_bad_) return {};
    SpectralRecord record;
    record.name = section.text("NAME");
    record.code = section.text("CODE");
    record.viewing = section.text("VIEWING");
    record.date = paint::date_of_seconds(section.number("DATETIME").value_or(std::nan("")));
    record.scale = Scale::kPercent;
    if (const auto stated = color::condition_in(section.text("CORD_ILLUM"))) record.condition = *stated;
    const auto X = section.number("X"), Y = section.number("Y"), Z = section.number("Z");
    if (X && Y && Z && !record.condition.illuminant.empty()) record.xyz = color::Xyz{*X, *Y, *Z};
    if (!section.text("R").empty()) {
      const auto spectrum = take_spectrum(section, record);
      if (!spectrum.ok()) return import_.refuse(section.line("R"), spectrum.error().message);
    } else if (!record.xyz) {
      import_.remarks().note("sections without a spectrum, and without X, Y and Z under a known light, were left out",
                             shown(record.name));
      return {};
    }
    import_.add(std::move(record));
    return {};
  }

  // The error lacks the place.
  static Result<void> take_spectrum(const QtxSection& section, SpectralRecord& record) {
    const char* prefix = section.is_batch ? "BAT" : "STD";
    const std::string text = section.text("R");
    auto values = listed_values(text, text.find(';') == std::string::npos ? ',' : ';');
    if (!values.ok()) return input_error("{}_R: {}", prefix, values.error().message);
    record.values = *std::move(values);
    for (const char* key : {"REFLPOINTS", "REFLLOW", "REFLINTERVAL"})
      if (!section.number(key))
        return input_error(
            "{0}_R stands beside {0}_{1} \"{2}\": write the number of values, and the first wavelength "
            "and the step in nm",
            prefix, key, shown(section.text(key)));
    const double points = *section.number("REFLPOINTS");
    record.first_nm = *section.number("REFLLOW"), record.step_nm = *section.number("REFLINTERVAL");
    if (static_cast<double>(record.values.size()) != points)
      return input_error("{0}_R has {1} values, and {0}_REFLPOINTS is {2}: the file is damaged, or was cut off", prefix,
                         record.values.size(), shortest(points));
    if (record.values.size() < 2) return input_error("{}_R has fewer than two values", prefix);
    if (!(record.first_nm >= kFirstSpectral_nm) || !(record.step_nm > 0) ||
        !(record.first_nm + record.step_nm * (points - 1) <= kLastSpectral_nm))
      return input_error(
          "{0}_REFLLOW is {1} and {0}_REFLINTERVAL {2}, with {3} values: wavelengths lie from {4} to {5} nm", prefix,
          shortest(record.first_nm), shortest(record.step_nm), shortest(points), kFirstSpectral_nm, kLastSpectral_nm);
    return {};
  }

  SectionLines lines_;
  RecordImport import_;
  std::optional<QtxSection> open_;
  bool is_bad_ = false;  // the open section has an error that was passed over
};

}  // namespace

bool looks_qtx(std::string_view head) {
  const std::string text = upper(head);
  return (text.find("[STANDARD") != std::string::npos || text.find("[BATCH") != std::string::npos) &&
         (text.find("\nSTD_") != std::string::npos || text.find("\nBAT_") != std::string::npos);
}

Result<ImportedPaints> read_qtx(InputFile input, const ImportOptions& options) {
  return import_text(std::move(input), [&](const std::string& name, std::string_view text) {
    return QtxParser(name, text, options).parse();
  });
}

}  // namespace goniochrome::formats
