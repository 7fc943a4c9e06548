#include "paint/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/angles.h"
#include "base/text.h"
#include "math/elementary.h"
#include "paint/curve.h"

namespace goniochrome::paint {

namespace {

constexpr double kNone = PaintMetrics::kNone;

double signed_flop(double difference, double L45) {
  return std::copysign(2.69 * math::pow(std::abs(difference), 1.11) / math::pow(L45, 0.86), difference);
}

// The distance of the origin from the step between two points of the a*b* plane.
double least_chroma(const color::Lab& from, const color::Lab& to) {
  const double da = to.a - from.a, db = to.b - from.b;
  const double length2 = da * da + db * db;
  const double along = length2 > 0 ? std::clamp(-(from.a * da + from.b * db) / length2, 0.0, 1.0) : 0;
  return math::hypot(from.a + along * da, from.b + along * db);
}

// A row on the curve's own path: light at 45 deg, in plane, on the normal's side of specular.
bool on_path(const Geometry& geometry) {
  return geometry.incidence_deg == 45 && !geometry.out_of_plane && !geometry.reversed &&
         geometry.aspecular_deg >= kFaceAngle_deg;
}

// The colors of the path, by ascending aspecular angle.
std::vector<LabReading> path_rows(const Paint& paint) {
  std::vector<LabReading> rows;
  if (!paint.measurement) return rows;
  std::ranges::copy_if(paint.measurement->rows, std::back_inserter(rows),
                       [](const LabReading& row) { return on_path(row.geometry); });
  std::ranges::stable_sort(rows, {}, [](const LabReading& row) { return row.geometry.aspecular_deg; });
  return rows;
}

std::optional<color::Lab> row_at(std::span<const LabReading> rows, double aspecular_deg) {
  for (const LabReading& row : rows)
    if (row.geometry.aspecular_deg == aspecular_deg) return row.lab;
  return std::nullopt;
}

// dE00 between a color and what is left of it when negative channels of the working space are cut off.
double gamut_loss(const color::Lab& lab, const color::Xyz& white) {
  const color::Rgb rgb = color::rgb_from_lab(lab, white);
  if (rgb.x >= 0 && rgb.y >= 0 && rgb.z >= 0) return 0;
  return color::delta_e_2000(
      lab, color::lab_from_rgb({std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)}, white));
}

void add_gloss(const Paint& paint, PaintMetrics& result) {
  if (paint.gloss.empty()) return;
  const auto at_60 = std::ranges::find(paint.gloss, 60.0, &GlossReading::angle_deg);
  const GlossReading& reading = at_60 != paint.gloss.end() ? *at_60 : paint.gloss.front();
  result.gloss = reading.gloss_units;
  result.gloss_angle_deg = reading.angle_deg;
}

// Adds the numbers that depend on face, middle and flop.
void add_indices(const std::array<color::Lab, 3>& at, PaintMetrics& result) {
  const FlopIndex flop = flop_index(at[0].L, at[1].L, at[2].L);
  result.flop_index = flop.value;
  result.flop_sensitivity = flop.sensitivity;
  if (flop.unstable()) result.flags.push_back("dark");
  result.chroma_index = chroma_index(at[0], at[2]);
  result.hue_shift_index = hue_shift_index(at[0], at[2]);
  result.L15 = at[0].L, result.L45 = at[1].L, result.L110 = at[2].L;
  result.chroma15 = color::chroma(at[0]);
  if (result.chroma15 >= kLeastChroma)
    result.hue15_deg = color::hue_deg(at[0]);
  else
    result.flags.push_back("achromatic");
}

}  // namespace

FlopIndex flop_index(double L15, double L45, double L110) {
  constexpr double kStep = 0.1;
  const double difference = L15 - L110;
  if (!(L45 > 0)) return {kNone, std::numeric_limits<double>::infinity()};
  const FlopIndex plain{signed_flop(difference, L45), 0};
  if (L45 <= kStep) return {plain.value, std::numeric_limits<double>::infinity()};
  // Monotone in the difference, and in L45 on either side of zero difference: the extremes are at the corners.
  double sensitivity = 0;
  for (const double d : {-2 * kStep, 2 * kStep})
    for (const double m : {-kStep, kStep})
      sensitivity = std::max(sensitivity, std::abs(signed_flop(difference + d, L45 + m) - plain.value));
  return {plain.value, sensitivity};
}

double chroma_index(const color::Lab& at_15, const color::Lab& at_110) {
  return std::abs(color::chroma(at_15) - color::chroma(at_110));
}

double hue_shift_index(const color::Lab& at_15, const color::Lab& at_110) {
  const double face = color::chroma(at_15);
  if (face < kLeastChroma) return kNone;
  return std::abs(at_110.a * at_15.b - at_15.a * at_110.b) / face;
}

HueTravel hue_travel(std::span<const color::Lab> path) {
  if (path.size() < 2 || color::chroma(path.front()) < kLeastChroma || color::chroma(path.back()) < kLeastChroma)
    return {kNone, false};
  HueTravel travel;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const color::Lab &from = path[i - 1], &to = path[i];
    travel.degrees += math::atan2(from.a * to.b - from.b * to.a, from.a * to.a + from.b * to.b) * (180 / kPi);
    if (least_chroma(from, to) < kLeastChroma) travel.through_gray = true;
  }
  return travel;
}

Result<PaintMetrics> metrics(const Paint& paint, CurveFit fit) {
  PaintMetrics result;
  add_gloss(paint, result);
  const std::vector<LabReading> rows = path_rows(paint);
  const std::array measured = {row_at(rows, 15), row_at(rows, 45), row_at(rows, 110)};
  const bool complete = measured[0] && measured[1] && measured[2];
  std::optional<Appearance> curve = paint.appearance;
  bool fitted = false;
  if (curve) {
    if (rows.empty())
      result.residual_de00 = curve->residual_de00.value_or(kNone);
    else
      result.residual_de00 = 0;
    for (const LabReading& row : rows)
      result.residual_de00 =
          std::max(result.residual_de00, color::delta_e_2000(row.lab, lab_at(*curve, row.geometry.aspecular_deg)));
  } else if (rows.size() >= 2 && (fit == CurveFit::kAlways || !complete)) {
    if (const auto nearest = appearance_from_rows(rows); nearest.ok()) {
      curve = nearest->appearance;
      fitted = true;
      result.residual_de00 = curve->residual_de00.value_or(kNone);
    }
  }
  if (curve) result.travel_deg = curve->travel_deg;

  std::vector<color::Lab> path;
  if (complete) {
    result.source = PaintMetrics::Source::kRows;
    add_indices({*measured[0], *measured[1], *measured[2]}, result);
    for (const LabReading& row : rows) path.push_back(row.lab);
  } else if (curve) {
    result.source = fitted ? PaintMetrics::Source::kFitted : PaintMetrics::Source::kCurve;
    path = {lab_at(*curve, 15), lab_at(*curve, 45), lab_at(*curve, 110)};
    add_indices({path[0], path[1], path[2]}, result);
  } else {
    result.flags.push_back("no_color");
    return result;
  }
  const HueTravel travel = hue_travel(path);
  result.hue_travel_deg = travel.degrees;
  if (travel.through_gray) result.flags.push_back("through_gray");

  GONIO_ASSIGN(const color::Xyz white, color::white_point(condition_of(paint)));
  result.gamut_de00 = 0;
  for (const color::Lab& lab : path) result.gamut_de00 = std::max(result.gamut_de00, gamut_loss(lab, white));
  if (result.gamut_de00 > 1) result.flags.push_back("gamut");
  return result;
}

const char* source_name(PaintMetrics::Source source) {
  switch (source) {
    case PaintMetrics::Source::kRows:
      return "rows";
    case PaintMetrics::Source::kCurve:
      return "curve";
    case PaintMetrics::Source::kFitted:
      return "fitted";
    case PaintMetrics::Source::kNone:
      break;
  }
  return "none";
}

std::span<const MetricColumn> metric_columns() {
  static constexpr std::array kColumns = {
      MetricColumn{"flop_index", &PaintMetrics::flop_index, "lightness travel: 2.69 (L15 - L110)^1.11 / L45^0.86"},
      MetricColumn{"flop_sensitivity", &PaintMetrics::flop_sensitivity, "its largest change for 0.1 in each L*"},
      MetricColumn{"chroma_index", &PaintMetrics::chroma_index, "change of chroma from face to flop"},
      MetricColumn{"hue_shift_index", &PaintMetrics::hue_shift_index, "distance of the flop from the face's hue line"},
      MetricColumn{"hue_travel_deg", &PaintMetrics::hue_travel_deg, "turn of the hue from face to flop"},
      MetricColumn{"gloss", &PaintMetrics::gloss, "gloss units, at 60 deg where there is a choice"},
      MetricColumn{"gloss_angle_deg", &PaintMetrics::gloss_angle_deg, "the angle of that gloss"},
      MetricColumn{"gamut_de00", &PaintMetrics::gamut_de00, "worst loss to the working space, dE00"},
      MetricColumn{"L15", &PaintMetrics::L15, "L* of the face"},
      MetricColumn{"L45", &PaintMetrics::L45, "L* at 45 deg"},
      MetricColumn{"L110", &PaintMetrics::L110, "L* of the flop"},
      MetricColumn{"chroma15", &PaintMetrics::chroma15, "chroma of the face"},
      MetricColumn{"hue15_deg", &PaintMetrics::hue15_deg, "hue angle of the face"},
      MetricColumn{"travel_deg", &PaintMetrics::travel_deg, "aspecular angle where the color stops changing"},
      MetricColumn{"residual_de00", &PaintMetrics::residual_de00, "worst miss of the curve at a measured angle, dE00"},
  };
  return kColumns;
}

std::span<const MetricColumn> metric_columns_without_fit() {
  return metric_columns().first(metric_columns().size() - 2);
}

const MetricColumn* find_metric(std::string_view name) {
  for (const MetricColumn& column : metric_columns())
    if (name == column.name) return &column;
  return nullptr;
}

namespace {

using Test = PaintFilter::Test;

constexpr std::array<std::string_view, 5> kTexts = {"name", "code", "class", "source", "flags"};

enum class Kind { kNumber, kWord, kQuoted, kSign, kEnd };

struct Token {
  Kind kind = Kind::kEnd;
  std::string_view text;  // without quotes
  std::size_t at = 0;     // from 1
};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-';
}

bool holds(const std::string& op, double x, double y) {
  if (op == "<") return x < y;
  if (op == "<=") return x <= y;
  if (op == ">") return x > y;
  if (op == ">=") return x >= y;
  if (op == "==") return x == y;
  return x < y || x > y;  // != between numbers that are both applicable
}

// The sign that says of b and a what `op` says of a and b.
std::string mirrored(std::string op) {
  if (op[0] == '<')
    op[0] = '>';
  else if (op[0] == '>')
    op[0] = '<';
  return op;
}

bool text_equals(std::string_view field, std::string_view wanted, const Paint& paint, const PaintMetrics& numbers) {
  if (field == "name") return paint.name == wanted;
  if (field == "code") return paint.code == wanted;
  if (field == "class") return paint_class_name(paint.paint_class) == wanted;
  if (field == "source") return source_name(numbers.source) == wanted;
  return std::ranges::any_of(numbers.flags, [&](const char* flag) { return flag == wanted; });
}

// Recursive descent: `or` over `and` over `not` over comparisons.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Result<Test> whole() {
    GONIO_TRY(advance());
    GONIO_ASSIGN(Test test, any_of());
    if (token_.kind != Kind::kEnd) return wrong("\"and\", \"or\" or the end");
    return test;
  }

 private:
  Error wrong(std::string_view expected) const {
    if (token_.kind == Kind::kEnd) return usage_error("condition \"{}\" ends where {} is needed", text_, expected);
    return usage_error("condition \"{}\": \"{}\" at character {} where {} is needed", text_, token_.text, token_.at,
                       expected);
  }

  bool is_word(std::string_view word) const { return token_.kind == Kind::kWord && token_.text == word; }
  bool is_sign(std::string_view sign) const { return token_.kind == Kind::kSign && token_.text == sign; }

  Result<void> advance() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
    const std::size_t begin = at_;
    token_ = {Kind::kEnd, {}, begin + 1};
    if (at_ == text_.size()) return {};
    const char c = text_[at_];
    if (c == '\'' || c == '"') {
      const auto close = text_.find(c, at_ + 1);
      if (close == std::string_view::npos)
        return usage_error("condition \"{}\": the quote at character {} is not closed", text_, begin + 1);
      token_ = {Kind::kQuoted, text_.substr(begin + 1, close - begin - 1), begin + 1};
      at_ = close + 1;
      return {};
    }
    if (is_letter(c) || c == '+') {
      ++at_;
      // A sign belongs to a number's exponent: 1e+3.
      while (at_ < text_.size() &&
             (is_letter(text_[at_]) || (text_[at_] == '+' && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E'))))
        ++at_;
      const std::string_view word = text_.substr(begin, at_ - begin);
      token_ = {parse_number(word) ? Kind::kNumber : Kind::kWord, word, begin + 1};
      return {};
    }
    for (const std::string_view sign : {"<=", ">=", "==", "!=", "&&", "||", "<", ">", "!", "(", ")"})
      if (text_.substr(at_).starts_with(sign)) {
        token_ = {Kind::kSign, text_.substr(begin, sign.size()), begin + 1};
        at_ += sign.size();
        return {};
      }
    if (c == '=') return usage_error("condition \"{}\": \"=\" at character {}: write \"==\"", text_, begin + 1);
    if (c == '&' || c == '|')
      return usage_error("condition \"{}\": \"{}\" at character {}: write it twice", text_, c, begin + 1);
    return usage_error("condition \"{}\": \"{}\" at character {} has no meaning here", text_, c, begin + 1);
  }

  Result<Test> any_of() { return chain("or", "||", true, &Parser::all_of); }
  Result<Test> all_of() { return chain("and", "&&", false, &Parser::negated); }

  // Parts joined by a word or a sign. A part that is `decisive` decides.
  Result<Test> chain(std::string_view word, std::string_view sign, bool decisive, Result<Test> (Parser::*part)()) {
    GONIO_ASSIGN(Test left, (this->*part)());
    while (is_word(word) || is_sign(sign)) {
      GONIO_TRY(advance());
      GONIO_ASSIGN(Test right, (this->*part)());
      left = [decisive, a = std::move(left), b = std::move(right)](const Paint& p, const PaintMetrics& n) {
        return a(p, n) == decisive ? decisive : b(p, n);
      };
    }
    return left;
  }

  Result<Test> negated() {
    if (++depth_ > 200) return usage_error("condition \"{}\" is nested too deeply", text_);
    if (is_word("not") || is_sign("!")) {
      GONIO_TRY(advance());
      GONIO_ASSIGN(Test inner, negated());
      --depth_;
      return Test([a = std::move(inner)](const Paint& p, const PaintMetrics& n) { return !a(p, n); });
    }
    if (is_sign("(")) {
      GONIO_TRY(advance());
      GONIO_ASSIGN(Test inner, any_of());
      if (!is_sign(")")) return wrong("\")\"");
      GONIO_TRY(advance());
      --depth_;
      return inner;
    }
    --depth_;
    return comparison();
  }

  Result<Test> comparison() {
    const Token left = token_;
    if (left.kind == Kind::kEnd || left.kind == Kind::kSign) return wrong("a name or a number");
    GONIO_TRY(advance());
    const std::string op(token_.text);
    if (token_.kind != Kind::kSign || op == "(" || op == ")" || op == "!" || op == "&&" || op == "||")
      return wrong("a comparison (< <= > >= == !=)");
    GONIO_TRY(advance());
    const Token right = token_;
    if (right.kind == Kind::kEnd || right.kind == Kind::kSign) return wrong("a name or a number");
    GONIO_TRY(advance());
    if (is_text(left)) return text_comparison(left, op, right);
    if (is_text(right)) return text_comparison(right, op, left);
    if (is_na(right)) return na_comparison(left, op);
    if (is_na(left)) return na_comparison(right, mirrored(op));
    GONIO_ASSIGN(const auto x, number(left));
    GONIO_ASSIGN(const auto y, number(right));
    return Test([x, y, op](const Paint&, const PaintMetrics& n) { return holds(op, x(n), y(n)); });
  }

  static bool is_text(const Token& token) {
    return token.kind == Kind::kWord && std::ranges::find(kTexts, token.text) != kTexts.end();
  }
  static bool is_na(const Token& token) { return token.kind == Kind::kWord && token.text == "na"; }

  Result<Test> text_comparison(const Token& field, const std::string& op, const Token& wanted) {
    if (op != "==" && op != "!=")
      return usage_error("condition \"{}\": {} is a text: compare it by == or !=", text_, field.text);
    if (field.text == "class" && !paint_class_of(wanted.text))
      return usage_error(
          "condition \"{}\": there is no class \"{}\": use solid, metallic, pearl, interference or unknown", text_,
          wanted.text);
    return Test([name = field.text, text = std::string(wanted.text), equal = op == "=="](
                    const Paint& p, const PaintMetrics& n) { return text_equals(name, text, p, n) == equal; });
  }

  Result<Test> na_comparison(const Token& token, const std::string& op) {
    if (op != "==" && op != "!=") return usage_error("condition \"{}\": na has no order: use == or !=", text_);
    GONIO_ASSIGN(const auto x, number(token));
    return Test([x, equal = op == "=="](const Paint&, const PaintMetrics& n) { return std::isnan(x(n)) == equal; });
  }

  Result<std::function<double(const PaintMetrics&)>> number(const Token& token) {
    using Number = std::function<double(const PaintMetrics&)>;
    if (token.kind == Kind::kNumber)
      return Number([value = *parse_number(token.text)](const PaintMetrics&) { return value; });
    if (const MetricColumn* column = token.kind == Kind::kWord ? find_metric(token.text) : nullptr)
      return Number([value = column->value](const PaintMetrics& n) { return n.*value; });
    return usage_error("condition \"{}\": \"{}\" at character {} is no metric{}", text_, token.text, token.at,
                       metric_advice(token.text));
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Token token_;
};

}  // namespace

Result<PaintFilter> PaintFilter::parse(std::string_view expression) {
  GONIO_ASSIGN(Test test, Parser(expression).whole());
  return PaintFilter(std::move(test));
}

Result<MetricRange> parse_metric_range(std::string_view text) {
  const auto equals = text.find('=');
  const auto colon = text.find(':', equals == std::string_view::npos ? 0 : equals);
  if (equals == std::string_view::npos || colon == std::string_view::npos)
    return usage_error("filter \"{}\": write NAME=LOW:HIGH, as in flop_index=3:10", text);
  const std::string_view name = trimmed(text.substr(0, equals));
  MetricRange range{find_metric(name), -std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  if (!range.column) return usage_error("filter \"{}\": \"{}\" is no metric{}", text, name, metric_advice(name));
  const auto read = [&](std::string_view bound, double& target) -> Result<void> {
    if (bound.empty()) return {};
    const auto value = parse_number(bound);
    if (!value) return usage_error("filter \"{}\": \"{}\" is no number", text, bound);
    target = *value;
    return {};
  };
  GONIO_TRY(read(trimmed(text.substr(equals + 1, colon - equals - 1)), range.low));
  GONIO_TRY(read(trimmed(text.substr(colon + 1)), range.high));
  if (range.low > range.high) return usage_error("filter \"{}\": the lower bound is above the upper one", text);
  return range;
}

std::string metric_advice(std::string_view unknown) {
  const MetricColumn* nearest = nullptr;
  std::size_t distance = std::max<std::size_t>(3, unknown.size() / 2);
  for (const MetricColumn& column : metric_columns()) {
    if (const std::size_t d = edit_distance(unknown, column.name); d < distance) nearest = &column, distance = d;
  }
  if (nearest) return fmt::format("; did you mean {}?", nearest->name);
  return fmt::format("; there are {}", joined(metric_columns(), ", ", &MetricColumn::name));
}

}  // namespace goniochrome::paint
