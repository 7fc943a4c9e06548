// Cornell's gonioreflectometer files: text, scattered direction pairs, a spectrum for each.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/internal/measured_formats.h"
#include "brdf/internal/scattered_brdf.h"

namespace goniochrome::brdf {

namespace {

class CornellParser {
 public:
  CornellParser(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  Result<MeasuredPointer> parse() {
    GONIO_TRY(wavelengths());
    while (next_line()) GONIO_TRY(row());
    if (rows_.empty()) return input_error("{}: holds no measured directions", path_);
    if (traits_.negative) traits_.negative_rms = std::sqrt(negative_square_ / static_cast<double>(traits_.negative));
    return scattered_brdf(std::move(traits_), std::move(rows_));
  }

 private:
  // The numbers of the next line that has any; comments go to the description until the numbers begin.
  bool next_line() {
    words_.clear();
    while (words_.empty() && !text_.empty()) {
      const auto end = std::min(text_.find('\n'), text_.size());
      std::string_view line = trimmed(text_.substr(0, end));
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (line.starts_with('#')) {
        const auto words = trimmed(line.substr(1));
        if (traits_.wavelengths_nm.empty() && !counted_ && !words.empty() && words != "num wls")
          traits_.description += (traits_.description.empty() ? "" : "; ") + std::string(words);
        continue;
      }
      for (std::size_t at = 0; at < line.size();) {
        const auto stop = std::min(line.find_first_of(" \t", at), line.size());
        if (stop > at) words_.push_back(line.substr(at, stop - at));
        at = stop + 1;
      }
    }
    return !words_.empty();
  }

  Error error(std::string_view what) const { return input_error("{}:{}: {}", path_, line_, what); }

  Result<double> number(std::string_view word) const {
    const auto value = parse_number(word);
    if (!value) return error(fmt::format("\"{}\" is not a number", word.substr(0, 40)));
    return *value;
  }

  Result<void> wavelengths() {
    if (!next_line()) return input_error("{}: is empty", path_);
    const auto count = words_.size() == 1 ? parse_integer(words_[0]) : std::nullopt;
    if (!count || *count < 2 || *count > 10000)
      return error("a spectral .brdf begins with the number of its wavelengths alone on a line");
    counted_ = true;
    while (traits_.wavelengths_nm.size() < static_cast<std::size_t>(*count)) {
      if (!next_line()) return error("the file ends within the list of wavelengths");
      for (const auto word : words_) {
        GONIO_ASSIGN(const double nm, number(word));
        if (nm < 100 || nm > 5000) return error(fmt::format("wavelength {}: give nanometers", word));
        if (!traits_.wavelengths_nm.empty() && nm <= traits_.wavelengths_nm.back())
          return error(fmt::format("wavelength {} does not ascend", word));
        traits_.wavelengths_nm.push_back(nm);
      }
    }
    if (traits_.wavelengths_nm.size() > static_cast<std::size_t>(*count))
      return error(fmt::format("there are more wavelengths than the {} announced", *count));
    return {};
  }

  Result<void> row() {
    const std::size_t channels = traits_.wavelengths_nm.size();
    if (words_.size() != 4 + channels)
      return error(
          fmt::format("{} numbers where 4 angles and {} wavelengths make {}", words_.size(), channels, 4 + channels));
    std::array<double, 4> angles{};
    for (std::size_t k = 0; k < 4; ++k) {
      GONIO_ASSIGN(angles[k], number(words_[k]));
    }
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}})
      if (angles[k] < 0 || angles[k] > kPi / 2 + 1e-6)
        return error(fmt::format("theta is {}: give radians from the normal, 0 to 1.5708", words_[k]));
    ScatteredRow row{{direction(angles[0], angles[1]), direction(angles[2], angles[3])}, {}};
    for (std::size_t k = 0; k < channels; ++k) {
      GONIO_ASSIGN(const double f, number(words_[4 + k]));
      count_sample(f, traits_, negative_square_);
      row.f.push_back(f);
    }
    rows_.push_back(std::move(row));
    return {};
  }

  const std::string& path_;
  std::string_view text_;
  std::vector<std::string_view> words_;
  int line_ = 0;
  bool counted_ = false;
  MeasuredTraits traits_{.format = "cornell", .scattered = true};
  double negative_square_ = 0;
  std::vector<ScatteredRow> rows_;
};

bool looks_cornell(std::string_view path, std::string_view) {
  return lower(path).ends_with(".brdf");
}

Result<MeasuredPointer> read_cornell(const std::string& path, std::string_view text) {
  return CornellParser(path, text).parse();
}

}  // namespace

const MeasuredFormat kCornell = {looks_cornell, read_cornell, "Cornell .brdf"};

}  // namespace goniochrome::brdf
