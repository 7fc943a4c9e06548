#include "formats/reference.h"

#include <string_view>
#include <utility>

#include "base/paths.h"
#include "base/text.h"

namespace goniochrome::formats {

namespace {

// Whether the whole of `text` is what `pattern` says. The last * is the only one that is ever tried again, so that the
// time is at most the product of the lengths.
bool matches(std::string_view pattern, std::string_view text) {
  constexpr std::size_t kNone = std::string_view::npos;
  std::size_t p = 0, t = 0, star = kNone, resumed = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++, resumed = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p, ++t;
    } else if (star != kNone) {
      p = star + 1, t = ++resumed;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == kNone;
}

}  // namespace

PaintReference paint_reference(const std::string& text) {
  const auto last = text.rfind('#');
  if (last == std::string::npos || is_there(text)) return {text, std::nullopt};
  for (auto hash = last; hash != std::string::npos && hash > 0; hash = text.rfind('#', hash - 1))
    if (is_there(text.substr(0, hash))) return {text.substr(0, hash), text.substr(hash + 1)};
  return {text.substr(0, last), text.substr(last + 1)};
}

NameChoice::NameChoice(std::string names) : whole_(std::move(names)) {
  for (const std::string_view name : split(whole_, ',')) patterns_.push_back({std::string(trimmed(name))});
}

bool NameChoice::takes(const std::string& name) {
  bool taken = name == whole_;
  whole_met_ = whole_met_ || taken;
  for (Pattern& pattern : patterns_) {
    if (!matches(pattern.text, name)) continue;
    pattern.met = true;
    taken = true;
  }
  return taken;
}

Result<void> NameChoice::check_all_met(const std::string& file) const {
  if (whole_met_) return {};
  for (const Pattern& pattern : patterns_)
    if (!pattern.met)
      return input_error("{}: no paint is named \"{}\": names are taken letter by letter", file, pattern.text);
  return {};
}

}  // namespace goniochrome::formats
