#include "formats/reference.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/paths.h"
#include "base/text.h"

namespace goniochrome::formats {

namespace {

// True if the whole of `text` fits `pattern`. The last * is the only one that is ever tried again, so that the time is
// at most the product of the lengths.
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

// Nobody mistypes a longer name, and comparing two names takes the product of their lengths.
constexpr std::size_t kLongestCompared = 100;

// A third of the letters may differ, and no more than three; upper and lower case are alike.
WantedName::WantedName(std::string name)
    : name_(std::move(name)), lower_(lower(name_)), distance_(std::min<std::size_t>(name_.size() / 3, 3) + 1) {}

void WantedName::see(std::string_view other) {
  const std::size_t longer = std::max(other.size(), name_.size()), shorter = std::min(other.size(), name_.size());
  if (longer - shorter >= distance_ || longer > kLongestCompared) return;
  const std::size_t distance = edit_distance(lower(other), lower_);
  if (distance < distance_) distance_ = distance, nearest_ = other;
}

std::string WantedName::not_found() const {
  return fmt::format("no paint is named \"{}\": names are taken letter by letter{}", name_,
                     nearest_.empty() ? "" : fmt::format("; did you mean \"{}\"?", shown(nearest_)));
}

NameChoice::NameChoice(std::string names) : whole_(std::move(names)) {
  for (const std::string_view piece : split(whole_, ',')) {
    const std::string name(trimmed(piece));
    patterns_.push_back({name, WantedName(name)});
  }
}

bool NameChoice::takes(const std::string& name) {
  bool taken = name == whole_;
  whole_met_ = whole_met_ || taken;
  for (Pattern& pattern : patterns_) {
    if (matches(pattern.text, name)) {
      pattern.met = true;
      taken = true;
    } else if (!pattern.met) {
      pattern.wanted.see(name);
    }
  }
  return taken;
}

Result<void> NameChoice::check_all_met(const std::string& file) const {
  if (whole_met_) return {};
  for (const Pattern& pattern : patterns_)
    if (!pattern.met) return input_error("{}: {}", file, pattern.wanted.not_found());
  return {};
}

}  // namespace goniochrome::formats
