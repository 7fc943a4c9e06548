// MIF and XTF say the same in two ways. Of MIF each angle is a line `ANGL=15 13.2 13.4 ...`, whose first word is the
// aspecular angle or, of a sphere, In or Ex. Of XTF it is a line REFL=0`13.2`13.4`..., whose first word is the number
// of the angle, of which ANGLES says how many there are.
#include <algorithm>
#include <array>

#include "base/text.h"
#include "formats/importers.h"
#include "formats/internal/sections.h"
#include "formats/internal/spectral_records.h"

namespace goniochrome::formats {

namespace {

constexpr std::size_t kMifValues = 31;
constexpr double kMifFirst_nm = 400, kMifStep_nm = 10;

bool is_sample_section(std::string_view name) {
  return name == "STANDARD" || name == "ALT STANDARD" || name == "SAMPLE" || name == "TRIAL" || name == "BATCH";
}

// The viewing of an angle of XTF by its number: instruments of one angle measure 45/0 and those of two are spheres;
// those of three measure 25, 45 and 75 degrees from specular, and those of five 15 and 110 as well. Nothing for others.
std::optional<std::string> xtf_viewing(std::int64_t angles, std::int64_t number) {
  using Words = std::vector<const char*>;
  const Words words = angles == 1   ? Words{"45/0"}
                      : angles == 2 ? Words{"In", "Ex"}
                      : angles == 3 ? Words{"25", "45", "75"}
                      : angles == 5 ? Words{"15", "25", "45", "75", "110"}
                                    : Words{};
  if (number < 0 || number >= static_cast<std::int64_t>(words.size())) return std::nullopt;
  return words[static_cast<std::size_t>(number)];
}

enum class Dialect { kMif, kXtf };

class MifParser {
 public:
  MifParser(const std::string& file, std::string_view text, Dialect dialect, const ImportOptions& options)
      : dialect_(dialect), lines_(text), import_(file, dialect == Dialect::kMif ? "MIF" : "XTF", options) {}

  Result<ImportedPaints> parse() {
    for (;;) {
      const auto more = lines_.next();
      if (more.ok() && !*more) break;
      const Result<void> taken = !more.ok()                  ? Result<void>(more.error())
                                 : lines_.begins_section()   ? begin()
                                 : dialect_ == Dialect::kMif ? take_mif_key()
                                                             : take_xtf_key();
      if (!taken.ok()) GONIO_TRY(import_.refuse(lines_.line(), taken.error().message));
    }
    if (lines_.is_unfinished() && (lines_.key() == "ANGL" || lines_.key() == "REFL"))
      import_.remarks().note(
          fmt::format("the file ends within line {}, a spectrum, whose last value may be cut off", lines_.line()), "");
    return import_.finish();
  }

 private:
  Result<void> begin() {
    if (is_sample_section(lines_.section()))
      record_ = {}, has_name_ = false, in_sample_ = true;
    else if (lines_.section() != "MEASUREMENT")
      in_sample_ = false;
    else if (dialect_ == Dialect::kMif)
      record_.date.clear();  // each measurement states its own
    is_measured_ = false;
    return {};
  }

  Result<void> take_mif_key() {
    const std::string& key = lines_.key();
    if (!in_sample_) return {};
    if (lines_.section() != "MEASUREMENT") {
      if (key == "NAME") record_.name = lines_.value(), has_name_ = true;
      if (key == "CODE") record_.code = lines_.value();
      return {};
    }
    if (key == "INST") record_.instrument = lines_.value();
    if (key == "TIME" && lines_.value() != "0") record_.date = lines_.value();
    if (key != "ANGL") return {};
    const std::string_view value = lines_.value();
    const std::size_t blank = std::min(value.find_first_of(" \t"), value.size());
    record_.viewing = value.substr(0, blank);
    return add_spectrum(value.substr(blank), ' ');
  }

  // The first key of a section of a sample has its name; description, day and time follow it. Nothing says what the
  // numbers of day and time count, here and in MIF: they are kept as they stand.
  Result<void> take_xtf_key() {
    const std::string& key = lines_.key();
    const std::string_view value = lines_.value();
    if (key == "ANGLES") angles_ = parse_integer(value);
    if (!in_sample_) return {};
    const std::size_t tick = std::min(value.find('`'), value.size());
    const std::string_view first = trimmed(value.substr(0, tick));
    if (key != "REFL") {
      if (has_name_ || key == "MEAS") return {};
      record_.name = first, has_name_ = true;
      if (const auto words = split(value, '`'); words.size() > 3)
        record_.date = trimmed(fmt::format("{} {}", trimmed(words[2]), trimmed(words[3])));
      return {};
    }
    const auto number = parse_integer(first);
    const auto viewing = number && angles_ ? xtf_viewing(*angles_, *number) : std::nullopt;
    if (!number || !angles_)
      return input_error(
          "REFL begins with \"{}\", and ANGLES is {}: write the number of the angle, and how many there are",
          shown(first), angles_ ? std::to_string(*angles_) : "not stated");
    record_.viewing = viewing ? *viewing : fmt::format("angle {} of {}", *number, *angles_);
    return add_spectrum(value.substr(std::min(tick + 1, value.size())), '`');
  }

  Result<void> add_spectrum(std::string_view text, char separator) {
    if (!has_name_)
      return input_error("{} stands before the name of a sample: begin with a section such as [STANDARD]",
                         lines_.key());
    auto values = listed_values(text, separator);
    if (!values.ok()) return input_error("{} {}: {}", lines_.key(), record_.viewing, values.error().message);
    if (values->size() != kMifValues)
      return input_error("{} {} has {} values, and {} are from {} to 700 nm by {}: the file is damaged, or was cut off",
                         lines_.key(), record_.viewing, values->size(), kMifValues, kMifFirst_nm, kMifStep_nm);
    SpectralRecord record = record_;
    record.values = *std::move(values);
    record.first_nm = kMifFirst_nm, record.step_nm = kMifStep_nm, record.scale = Scale::kPercent;
    record.joins = is_measured_;
    is_measured_ = true;
    import_.add(std::move(record));
    return {};
  }

  Dialect dialect_;
  SectionLines lines_;
  RecordImport import_;
  std::optional<std::int64_t> angles_;
  SpectralRecord record_;  // what the open sample says of itself
  bool in_sample_ = false, has_name_ = false;
  bool is_measured_ = false;  // the section has a spectrum already
};

Result<ImportedPaints> read_dialect(InputFile input, Dialect dialect, const ImportOptions& options) {
  return import_text(std::move(input), [&](const std::string& name, std::string_view text) {
    return MifParser(name, text, dialect, options).parse();
  });
}

}  // namespace

bool looks_mif(std::string_view head) {
  const std::string text = upper(head);
  return text.find("[FILE INFO]") != std::string::npos && text.find("\nANGLE=") != std::string::npos;
}

Result<ImportedPaints> read_mif(InputFile input, const ImportOptions& options) {
  return read_dialect(std::move(input), Dialect::kMif, options);
}

bool looks_xtf(std::string_view head) {
  const std::string text = upper(head);
  return text.find("[FILE INFO]") != std::string::npos && text.find("\nANGLES=") != std::string::npos;
}

Result<ImportedPaints> read_xtf(InputFile input, const ImportOptions& options) {
  return read_dialect(std::move(input), Dialect::kXtf, options);
}

}  // namespace goniochrome::formats
