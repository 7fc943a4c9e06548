// JCAMP-DX 4.24 and 5 [McDonald and Wilks 1988]: labelled records `##LABEL=value`, one block for each spectrum.
// Ordinates stand as numbers, packed by their signs, or compressed: the first character of a number tells its first
// digit and its sign (SQZ), that it is the difference from the one before (DIF), or how often that one stands (DUP).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/text.h"
#include "formats/importers.h"
#include "formats/internal/spectral_records.h"

namespace goniochrome::formats {

namespace {

// Ordinates of one spectrum, and of one file: a repeat of 9999 takes five bytes.
constexpr std::size_t kMostOrdinates = 1 << 20;

struct JcampNumber {
  enum class Kind { kValue, kDifference, kRepeat };
  Kind kind = Kind::kValue;
  double value = 0;
};

// Takes numbers off a line of ordinates. Error, without the place: what stands there is none.
class JcampNumbers {
 public:
  explicit JcampNumbers(std::string_view line) : rest_(line) {}

  Result<std::optional<JcampNumber>> next() {
    while (!rest_.empty() && std::string_view(" \t,;").find(rest_.front()) != std::string_view::npos)
      rest_.remove_prefix(1);
    if (rest_.empty()) return std::optional<JcampNumber>();
    JcampNumber number;
    std::string text;
    const char first = rest_.front();
    if (const int digit = pseudo_digit(first, number.kind); digit != kNone) {
      text = std::to_string(digit);
      rest_.remove_prefix(1);
    } else if (first == '+' || first == '-') {
      if (first == '-') text = "-";
      rest_.remove_prefix(1);
    }
    std::size_t end = 0;
    const bool is_plain = number.kind == JcampNumber::Kind::kValue && (text.empty() || text == "-");
    while (end < rest_.size() && is_part_of_number(end, is_plain)) ++end;
    text += rest_.substr(0, end);
    const auto value = parse_number(text);
    if (!value)
      return input_error("\"{}\" is no ordinate: the file is damaged", shown(first + std::string(rest_.substr(0, 20))));
    rest_.remove_prefix(end);
    number.value = *value;
    return std::optional(number);
  }

 private:
  static constexpr int kNone = 1000;

  // The first digit with its sign that a character stands for.
  static int pseudo_digit(char c, JcampNumber::Kind& kind) {
    if (c == '@') return 0;
    if (c >= 'A' && c <= 'I') return c - 'A' + 1;
    if (c >= 'a' && c <= 'i') return -(c - 'a' + 1);
    kind = JcampNumber::Kind::kDifference;
    if (c == '%') return 0;
    if (c >= 'J' && c <= 'R') return c - 'J' + 1;
    if (c >= 'j' && c <= 'r') return -(c - 'j' + 1);
    kind = JcampNumber::Kind::kRepeat;
    if (c >= 'S' && c <= 'Z') return c - 'S' + 1;
    if (c == 's') return 9;
    kind = JcampNumber::Kind::kValue;
    return kNone;
  }

  // Digits and a point, and an exponent where a number is plain: elsewhere E begins another one.
  bool is_part_of_number(std::size_t at, bool is_plain) const {
    const auto digit = [&](std::size_t i) { return i < rest_.size() && rest_[i] >= '0' && rest_[i] <= '9'; };
    const char c = rest_[at];
    if (digit(at) || c == '.') return true;
    const bool exponent = is_plain && at > 0 && (c == 'E' || c == 'e');
    const auto is_sign = [](char s) { return s == '+' || s == '-'; };
    if (exponent) return at + 2 < rest_.size() && is_sign(rest_[at + 1]) && digit(at + 2);
    return is_plain && is_sign(c) && at > 1 && (rest_[at - 1] == 'E' || rest_[at - 1] == 'e') && digit(at + 1);
  }

  std::string_view rest_;
};

// One block of a file.
class JcampBlock {
 public:
  void set(const std::string& label, std::string_view value) { values_[label] = std::string(value); }
  std::string text(const char* label) const {
    const auto found = values_.find(label);
    return found == values_.end() ? "" : found->second;
  }
  std::optional<double> number(const char* label) const { return parse_number(text(label)); }

 private:
  std::map<std::string, std::string, std::less<>> values_;
};

// An abscissa of this unit in nanometers; nothing for other units.
std::optional<double> nanometers(double x, const std::string& unit) {
  if (unit.find("NANOMETER") != std::string::npos || unit == "NM") return x;
  if (unit.find("MICROMETER") != std::string::npos || unit == "UM") return 1000 * x;
  if (unit.find("ANGSTROM") != std::string::npos) return x / 10;
  if (unit == "1/CM" && x > 0) return 1e7 / x;
  return std::nullopt;
}

// The scale of ordinates; nothing where they are not of reflected light.
std::optional<Scale> scale_of_ordinates(const std::string& unit) {
  const bool reflected = unit.find("REFLECTANCE") != std::string::npos || unit.find("REFLECTION") != std::string::npos;
  if (!reflected || unit.find("LOG") != std::string::npos) return std::nullopt;
  return scale_in(unit) == Scale::kPercent ? Scale::kPercent : Scale::kFactor;
}

class JcampParser {
 public:
  JcampParser(const std::string& file, std::string_view text, const ImportOptions& options)
      : text_(text), import_(file, "JCAMP-DX", options) {}

  Result<ImportedPaints> parse() {
    for (; !text_.empty();) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = trimmed(text_.substr(0, end));
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      line = trimmed(line.substr(0, line.find("$$")));
      if (line.empty()) continue;
      const Result<void> taken = line.starts_with("##") ? take_label(line.substr(2)) : take_ordinates(line);
      if (!taken.ok()) {
        form_ = Form::kNone;
        GONIO_TRY(import_.refuse(line_, taken.error().message));
      }
    }
    if (form_ != Form::kNone)
      GONIO_TRY(import_.refuse(line_, "the file ends within a spectrum, without ##END=: it was cut off"));
    return import_.finish();
  }

 private:
  enum class Form { kNone, kSteps, kPairs };  // (X++(Y..Y)) and (XY..XY)

  Result<void> take_label(std::string_view text) {
    GONIO_TRY(close_spectrum());
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos)
      return input_error("\"##{}\" has no =: the file is damaged, or was cut off", shown(text));
    // Blanks, hyphens, slashes and underscores do not tell labels apart.
    std::string label = upper(text.substr(0, equals));
    std::erase_if(label, [](char c) { return std::string_view(" -/_").find(c) != std::string_view::npos; });
    const std::string_view value = trimmed(text.substr(equals + 1));
    if (label == "TITLE") block_ = {};
    if (label == "NTUPLES") import_.remarks().note("blocks of NTUPLES are not read", shown(block_.text("TITLE")));
    if (label == "XYDATA" || label == "XYPOINTS" || label == "PEAKTABLE") return begin_spectrum(value);
    block_.set(label, value);
    return {};
  }

  Result<void> begin_spectrum(std::string_view form) {
    const std::string name = shown(block_.text("TITLE"));
    scale_ = scale_of_ordinates(upper(block_.text("YUNITS")));
    if (!scale_) {
      import_.remarks().note(
          fmt::format("spectra of \"{}\" are of no reflectance and were left out", shown(block_.text("YUNITS"))), name);
      return {};
    }
    if (!nanometers(1, upper(block_.text("XUNITS"))))
      return input_error("XUNITS is \"{}\": spectra are read in nanometers, micrometers or 1/cm",
                         shown(block_.text("XUNITS")));
    x_.clear(), y_.clear(), differs_ = false, check_.reset();
    form_ = form.starts_with("(X++") ? Form::kSteps : form.starts_with("(XY") ? Form::kPairs : Form::kNone;
    if (form_ == Form::kNone)
      return input_error("the form \"{}\" is not known: (X++(Y..Y)) and (XY..XY) are", shown(form));
    for (const char* label : {"FIRSTX", "LASTX", "NPOINTS", "XFACTOR", "YFACTOR"}) {
      const bool is_optional = form_ == Form::kPairs || label[1] == 'F';
      if (!block_.number(label) && !(is_optional && block_.text(label).empty()))
        return input_error("{} is \"{}\": write a number", label, shown(block_.text(label)));
    }
    return {};
  }

  Result<void> take_ordinates(std::string_view line) {
    if (form_ == Form::kNone) return {};  // goes on with a text, or with what is not read
    JcampNumbers numbers(line);
    bool is_first = true;
    for (;;) {
      GONIO_ASSIGN(const auto number, numbers.next());
      if (!number) return {};
      if (x_.size() + y_.size() > 2 * kMostOrdinates)
        return input_error("a spectrum has more than {} points", kMostOrdinates);
      if (form_ == Form::kPairs) {
        (x_.size() == y_.size() ? x_ : y_).push_back(number->value);
      } else if (is_first) {
        GONIO_TRY(check_abscissa(number->value));
      } else {
        GONIO_TRY(take_ordinate(*number));
      }
      is_first = false;
    }
  }

  // A line begins with the abscissa of its first ordinate; where that repeats the last one as a check, of that one.
  Result<void> check_abscissa(double x) {
    const double first = *block_.number("FIRSTX"), last = *block_.number("LASTX"), points = *block_.number("NPOINTS");
    const double step = points > 1 ? (last - first) / (points - 1) : 0;
    if (differs_) check_ = y_.back(), y_.pop_back();
    differs_ = false;
    const double expected = first + step * static_cast<double>(y_.size());
    const double stated = x * block_.number("XFACTOR").value_or(1);
    if (std::abs(stated - expected) > 1.5 * std::abs(step))
      return input_error("the line begins at {}, and after {} of {} values from {} to {} comes {}: {}",
                         shortest(stated), y_.size(), shortest(points), shortest(first), shortest(last),
                         shortest(expected),
                         (stated - expected) * step > 0 ? "lines are missing"
                                                        : "lines have too many values; commas stand between values");
    return {};
  }

  Result<void> take_ordinate(const JcampNumber& number) {
    using Kind = JcampNumber::Kind;
    if (number.kind == Kind::kRepeat) {
      const double more = number.value - 1;
      if (y_.empty() || !(more >= 0) || static_cast<double>(y_.size()) + more > kMostOrdinates)
        return input_error("a value is repeated {} times", shortest(number.value));
      const double step = differs_ ? difference_ : 0;
      for (double k = 0; k < more; ++k) y_.push_back(y_.back() + step);
      return {};
    }
    if (number.kind == Kind::kDifference) {
      if (y_.empty()) return input_error("a difference stands before the first value");
      difference_ = number.value, differs_ = true;
      y_.push_back(y_.back() + number.value);
      return {};
    }
    differs_ = false;
    y_.push_back(number.value);
    if (check_ && *check_ != number.value)
      return input_error("the line begins with {}, and the line before ends with {}: the file is damaged",
                         shortest(number.value), shortest(*check_));
    check_.reset();
    return {};
  }

  Result<void> close_spectrum() {
    if (form_ == Form::kNone) return {};
    const bool has_steps = form_ == Form::kSteps;
    form_ = Form::kNone;
    const auto points = block_.number("NPOINTS");
    const std::size_t read = y_.size();
    if ((points && static_cast<double>(read) != *points) || read < 2 || (!has_steps && x_.size() != read))
      return input_error("the spectrum above has {} values, and NPOINTS is {}: the file is damaged, or was cut off",
                         read, points ? shortest(*points) : "not stated");
    SpectralRecord record;
    const std::string unit = upper(block_.text("XUNITS"));
    const double first = block_.number("FIRSTX").value_or(0), last = block_.number("LASTX").value_or(0);
    for (std::size_t i = 0; i < read; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(read - 1);
      const double x = has_steps ? std::lerp(first, last, share) : x_[i] * block_.number("XFACTOR").value_or(1);
      const auto nm = nanometers(x, unit);
      const double y = y_[i] * block_.number("YFACTOR").value_or(1);
      if (!nm || !(*nm > 0 && *nm < 1e5))
        return input_error("the abscissa {} {} is no wavelength of light", shortest(x), unit);
      if (!(std::abs(y) <= kLargestReflectance))
        return input_error("the value at {} nm is {}, which is no reflectance", shortest(*nm), shortest(y));
      record.nm.push_back(*nm), record.values.push_back(y);
    }
    if (record.nm.front() > record.nm.back()) std::ranges::reverse(record.nm), std::ranges::reverse(record.values);
    if (!std::ranges::is_sorted(record.nm, std::less_equal<>()))
      return input_error("the wavelengths of the spectrum above neither ascend nor descend");
    note_largest(record.values);
    record.name = block_.text("TITLE");
    record.code = block_.text("$CODE");
    record.instrument = block_.text("SPECTROMETERDATASYSTEM");
    record.date = block_.text("LONGDATE").empty() ? block_.text("DATE") : block_.text("LONGDATE");
    record.viewing = block_.text("$GEOMETRY").empty() ? block_.text("SAMPLINGPROCEDURE") : block_.text("$GEOMETRY");
    record.scale = *scale_;
    import_.add(std::move(record));
    return {};
  }

  // Remarks that a file states another largest value than its ordinates have.
  void note_largest(const std::vector<double>& values) {
    constexpr double kRounding = 0.02;  // of the value
    const auto stated = block_.number("MAXY");
    const double largest = *std::ranges::max_element(values);
    if (stated && std::abs(*stated - largest) > kRounding * std::abs(largest))
      import_.remarks().note(fmt::format("MAXY is {}, and the largest ordinate times YFACTOR {}: the file contradicts "
                                         "itself, and the ordinates count",
                                         shortest(*stated), shortest(largest)),
                             shown(block_.text("TITLE")));
  }

  std::string_view text_;
  int line_ = 0;
  RecordImport import_;
  JcampBlock block_;
  Form form_ = Form::kNone;  // of the spectrum whose lines come
  std::optional<Scale> scale_;
  std::vector<double> x_, y_;
  bool differs_ = false;  // the last ordinate is a difference from the one before
  double difference_ = 0;
  std::optional<double> check_;  // the ordinate with which the line has to begin
};

}  // namespace

bool looks_jcamp(std::string_view head) {
  const std::string text = upper(head);
  return trimmed(text).starts_with("##") && text.find("JCAMP") != std::string::npos;
}

Result<ImportedPaints> read_jcamp(InputFile input, const ImportOptions& options) {
  return import_text(std::move(input), [&](const std::string& name, std::string_view text) {
    return JcampParser(name, text, options).parse();
  });
}

}  // namespace goniochrome::formats
