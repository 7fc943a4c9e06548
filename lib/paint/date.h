// Dates of readings, as text in ISO 8601: `2021-11-26`, `2021-11-26T07:54:25Z`. The date of a mean is a span of two of
// them, `2021-11-26..2021-11-28`. A date in a spelling that is not known is kept as it stands.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace goniochrome::paint {

// The date in ISO 8601, of a text that has the order year, month, day (`2021/11/26 07:54`) or has points and the order
// day, month, year (`26.11.2021 07:54:25`). Any other text is returned as it is: `11/12/2021` may be either month.
std::string plain_date(std::string_view text);

// The date so many seconds after the beginning of 1970, UTC, in the years 1900 to 2999; "" for others.
std::string date_of_seconds(double seconds);

// The time of a date in seconds after the beginning of 1970; of a span, of its first date. A date without an offset
// from UTC counts as UTC. Nothing where the text is no date in ISO 8601.
std::optional<double> seconds_of_date(std::string_view date);

// The day of a date, `2021-11-26`; of a span, of its first date. Nothing where the text is no date in ISO 8601.
std::optional<std::string> day_of_date(std::string_view date);

// The span from the earlier of both to the later, either of which may be a span or "". Dates in other spellings keep
// their order.
std::string span_of_dates(const std::string& a, const std::string& b);

}  // namespace goniochrome::paint
