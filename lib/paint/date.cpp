#include "paint/date.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "base/text.h"

namespace goniochrome::paint {

namespace {

constexpr std::string_view kSpan = "..";

// The number that the first `digits` characters of the text are, which are taken off it.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int value = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    value = 10 * value + (text[i] - '0');
  }
  text.remove_prefix(digits);
  return value;
}

bool take_char(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

// Both numbers behind a separator, as in `:54` or `-26`.
std::optional<int> take_behind(std::string_view& text, char separator) {
  return take_char(text, separator) ? take_digits(text, 2) : std::nullopt;
}

// Seconds after midnight, UTC, of `07:54`, `07:54:25.5` or `07:54:25+01:00`, which is the whole text.
std::optional<double> time_of_day_s(std::string_view text) {
  const auto hour = take_digits(text, 2), minute = take_behind(text, ':');
  if (!hour || !minute || *hour > 24 || *minute > 59) return std::nullopt;
  double seconds = *hour * 3600.0 + *minute * 60.0;
  if (text.starts_with(':')) {
    const auto second = take_behind(text, ':');
    if (!second || *second > 60) return std::nullopt;
    seconds += *second;
    if (text.starts_with('.')) {
      const std::string_view fraction = text.substr(0, text.find_first_not_of("0123456789", 1));
      if (fraction.size() < 2) return std::nullopt;
      seconds += *parse_number("0" + std::string(fraction));
      text.remove_prefix(fraction.size());
    }
  }
  if (text == "Z" || text.empty()) return seconds;
  const double sign = text.starts_with('-') ? 1 : -1;
  if (!take_char(text, '-') && !take_char(text, '+')) return std::nullopt;
  const auto hours = take_digits(text, 2);
  if (!hours) return std::nullopt;
  take_char(text, ':');
  const auto minutes = text.empty() ? std::optional(0) : take_digits(text, 2);
  if (!minutes || !text.empty()) return std::nullopt;
  return seconds + sign * (*hours * 3600.0 + *minutes * 60.0);
}

std::optional<double> seconds_of(std::string_view date) {
  using namespace std::chrono;
  const auto year_is = take_digits(date, 4), month_is = take_behind(date, '-'), day_is = take_behind(date, '-');
  if (!year_is || !month_is || !day_is) return std::nullopt;
  const year_month_day ymd{year(*year_is), month(static_cast<unsigned>(*month_is)),
                           day(static_cast<unsigned>(*day_is))};
  if (!ymd.ok()) return std::nullopt;
  const double midnight = 86400.0 * static_cast<double>(sys_days(ymd).time_since_epoch().count());
  if (date.empty()) return midnight;
  if (!take_char(date, 'T')) return std::nullopt;
  const auto time = time_of_day_s(date);
  return time ? std::optional(midnight + *time) : std::nullopt;
}

// The first and the last date of a span, which are the same of a single date.
std::pair<std::string_view, std::string_view> ends_of(std::string_view date) {
  const std::size_t at = date.find(kSpan);
  if (at == std::string_view::npos) return {date, date};
  return {date.substr(0, at), date.substr(at + kSpan.size())};
}

}  // namespace

std::string plain_date(std::string_view text) {
  text = trimmed(text);
  std::string_view rest = text;
  std::string date;
  if (const auto year = take_digits(rest, 4)) {
    const char separator = rest.starts_with('/') ? '/' : '-';
    const auto month = take_behind(rest, separator), day = take_behind(rest, separator);
    if (month && day) date = fmt::format("{:04}-{:02}-{:02}", *year, *month, *day);
  } else if (const auto words = split(text.substr(0, text.find(' ')), '.'); words.size() == 3) {
    const auto day = parse_integer(words[0]), month = parse_integer(words[1]);
    rest = words[2];
    const auto stated_year = take_digits(rest, 4);
    if (day && month && stated_year && rest.empty())
      date = fmt::format("{:04}-{:02}-{:02}", *stated_year, *month, *day),
      rest = text.substr(words[2].end() - text.begin());
  }
  if (date.empty()) return std::string(text);
  if (take_char(rest, ' ') || take_char(rest, 'T')) date += "T" + std::string(trimmed(rest)), rest = {};
  return rest.empty() && seconds_of(date) ? date : std::string(text);
}

std::string date_of_seconds(double seconds) {
  using namespace std::chrono;
  constexpr double kFirst = -2208988800, kLast = 32503680000;  // the beginnings of 1900 and 3000
  if (!(seconds >= kFirst && seconds < kLast)) return "";
  const sys_seconds time{std::chrono::seconds(static_cast<std::int64_t>(std::floor(seconds)))};
  const year_month_day date(floor<days>(time));
  const hh_mm_ss clock(time - floor<days>(time));
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", int(date.year()), unsigned(date.month()),
                     unsigned(date.day()), clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

std::optional<double> seconds_of_date(std::string_view date) {
  return seconds_of(ends_of(date).first);
}

std::optional<std::string> day_of_date(std::string_view date) {
  if (!seconds_of_date(date)) return std::nullopt;
  return std::string(date.substr(0, 10));
}

std::string span_of_dates(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == b) return a.empty() ? b : a;
  const auto [a_first, a_last] = ends_of(a);
  const auto [b_first, b_last] = ends_of(b);
  const auto is_later = [](std::string_view x, std::string_view y) {
    const auto of_x = seconds_of(x), of_y = seconds_of(y);
    return of_x && of_y && *of_x > *of_y;
  };
  const std::string_view first = is_later(a_first, b_first) ? b_first : a_first,
                         last = is_later(a_last, b_last) ? a_last : b_last;
  return first == last ? std::string(first) : fmt::format("{}{}{}", first, kSpan, last);
}

}  // namespace goniochrome::paint
