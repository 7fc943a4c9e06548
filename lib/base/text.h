// Numbers as text: parsed whole or refused, printed shortest, whatever the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace goniochrome {

// The number that the whole of `text` spells (decimal point, optional sign, exponent), or nothing: "64abc", "", "1,5"
// are no numbers. "inf" and "nan" are refused; finite only.
std::optional<double> parse_number(std::string_view text);

// The whole number that the whole of `text` spells, or nothing.
std::optional<std::int64_t> parse_integer(std::string_view text);

// The shortest decimal text that reads back as the same double.
std::string shortest(double value);

// `text` without leading and trailing white space.
std::string_view trimmed(std::string_view text);

// The pieces of `text` between the separators; empty pieces are kept, so that an error can count them.
std::vector<std::string_view> split(std::string_view text, char separator);

// `text` in ASCII lower case.
std::string lower(std::string_view text);

// The number of single-letter edits between two words: for "did you mean".
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace goniochrome
