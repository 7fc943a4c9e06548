// Text: numbers that are read whole or refused and written in as few digits as possible, whatever the locale; words and
// lines taken apart; and what may stand in a file or a message that others read.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace goniochrome {

// The finite number that the whole of `text` spells (with a decimal point, and a sign or an exponent if need be), or
// nothing. "64abc", "", "1,5", "inf" and "nan" are not numbers here.
std::optional<double> parse_number(std::string_view text);

// The whole number that the whole of `text` spells, or nothing.
std::optional<std::int64_t> parse_integer(std::string_view text);

// The shortest decimal text that reads back as the same double.
std::string shortest(double value);

// `text` without the white space before and after it, no-break and other typographic spaces included.
std::string_view trimmed(std::string_view text);

// The pieces of `text` between the separators. Empty pieces are kept, so that an error can count them.
std::vector<std::string_view> split(std::string_view text, char separator);

// The words with the separator between each two of them.
std::string joined(const std::vector<std::string>& words, std::string_view separator);
// The words that `word` makes of these items, likewise.
template <class Items, class Word>
std::string joined(const Items& items, std::string_view separator, const Word& word) {
  std::vector<std::string> words;
  for (const auto& item : items) words.emplace_back(std::invoke(word, item));
  return joined(words, separator);
}

// `text` in ASCII lower case, and in upper case.
std::string lower(std::string_view text);
std::string upper(std::string_view text);

// How many letters must be added, removed or replaced to turn one word into the other: for "did you mean".
std::size_t edit_distance(std::string_view a, std::string_view b);

// True if XML can hold `text`: it is valid UTF-8 and has no control characters except tabs and ends of lines.
bool is_plain_utf8(std::string_view text);

// `text` with a "?" in place of every byte that is_plain_utf8() objects to.
std::string plain_utf8(std::string_view text);

// `text` as a message can quote it: on one line, with spaces that look like a blank named (<U+00A0>), and cut off after
// 60 bytes.
std::string shown(std::string_view text);

// `text` with &, <, > and " written as XML entities. The characters in `as_numbers` are written as their numbers
// (&#10;), because XML does not keep tabs and ends of lines in an attribute, nor carriage returns anywhere.
std::string xml_escaped(std::string_view text, std::string_view as_numbers = "\t\n\r");

}  // namespace goniochrome
