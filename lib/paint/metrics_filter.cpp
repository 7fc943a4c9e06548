#include "paint/metrics_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/text.h"

namespace goniochrome::paint {

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

// Turns `a < b` round to `b > a`.
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

  Result<Test> any_of() {
    GONIO_ASSIGN(Test left, all_of());
    while (is_word("or") || is_sign("||")) {
      GONIO_TRY(advance());
      GONIO_ASSIGN(Test right, all_of());
      left = [a = std::move(left), b = std::move(right)](const Paint& p, const PaintMetrics& n) {
        return a(p, n) || b(p, n);
      };
    }
    return left;
  }

  Result<Test> all_of() {
    GONIO_ASSIGN(Test left, negated());
    while (is_word("and") || is_sign("&&")) {
      GONIO_TRY(advance());
      GONIO_ASSIGN(Test right, negated());
      left = [a = std::move(left), b = std::move(right)](const Paint& p, const PaintMetrics& n) {
        return a(p, n) && b(p, n);
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
    if (field.text == "class") {
      const std::array classes = {PaintClass::kUnknown, PaintClass::kSolid, PaintClass::kMetallic, PaintClass::kPearl,
                                  PaintClass::kInterference};
      if (std::ranges::none_of(classes, [&](PaintClass c) { return paint_class_name(c) == wanted.text; }))
        return usage_error(
            "condition \"{}\": there is no class \"{}\": use solid, metallic, pearl, interference or unknown", text_,
            wanted.text);
    }
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
  std::vector<std::string> names;
  const MetricColumn* nearest = nullptr;
  std::size_t distance = std::max<std::size_t>(3, unknown.size() / 2);
  for (const MetricColumn& column : metric_columns()) {
    names.push_back(column.name);
    if (const std::size_t d = edit_distance(unknown, column.name); d < distance) nearest = &column, distance = d;
  }
  if (nearest) return fmt::format("; did you mean {}?", nearest->name);
  return fmt::format("; there are {}", fmt::join(names, ", "));
}

}  // namespace goniochrome::paint
