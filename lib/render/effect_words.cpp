#include "render/effect_words.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "base/text.h"

namespace goniochrome::render {

namespace {

struct Word {
  const char* word;
  std::vector<std::string> effects;  // of the plan
  const char* meaning;
};

const std::vector<Word>& all_words() {
  static const std::vector<Word> words = {
      {"diffuse", {"diffuse"}, "of paints"},
      {"lobes", {"lobes"}, "flakes; lobe-20 is one"},
      {"gloss", {"gloss"}, "blurred images in the coat"},
      {"mirror", {"mirror"}, "sharp images in the coat"},
      {"fresnel", {"fresnel"}, "coats reflect more at grazing angles"},
      {"coat", {"coat"}, "coats take light from the base"},
      {"horizon", {"horizon", "spots"}, "no light from below it, spots like the sun each by itself"},
      {"sums", {"sums"}, "the same for wide lobes by sums"},
      {"brushed", {"anisotropy"}, "brushed paint"},
      {"travel", {"travel", "tilts"}, "weights by view, and color maps; travel-2 is one set"},
      {"satin", {"satin", "stretch"}, "rough coats"},
      {"texture", {"texture", "texture-lobes"}, "else the mean texel"},
      {"texture-filter", {"texture-filter"}, "the mean in a pixel"},
      {"operator", {"operator"}, "see --operator"},
      {"lights", {"lights", "extent"}, "lamps"},
      {"sparkle", {"sparkle"}, "flakes one by one near by"},
      {"shadow", {"shadow"}, "the mesh blocks light"},
      {"rays", {"rays"}, "shadow, the body in itself, bounced light"},
  };
  return words;
}

// Words that a plan has and --effects has no more, and what to write instead.
constexpr std::pair<std::string_view, const char*> kGone[] = {
    {"spots", "horizon has it"},
    {"anisotropy", "write brushed"},
    {"stretch", "write satin"},
    {"tilts", "write travel or, for a single set, travel-2"},
    {"texture-lobes", "write texture"},
    {"self", "write rays or, for shadows alone, -rays,+shadow"},
    {"bounce", "write rays or, for shadows alone, -rays,+shadow; --bounces says how often light bounces"},
    {"floor", "give --floor shadow or --floor none"},
    {"panes", "leave out --part PART=glass"},
    {"extent", "@0 behind a lamp makes it a point"},
};

// Beginnings of a word with the number of a single lobe or set behind it, as travel-2, and of that effect of the plan.
constexpr std::pair<std::string_view, std::string_view> kNumbered[] = {
    {"lobe-", "lobe-"}, {"gloss-", "gloss-"}, {"travel-", "tilts-"}, {"texture-", "texture-"}};

// The number behind this beginning, as text; empty where the name is another.
std::string_view number_behind(std::string_view name, std::string_view beginning) {
  if (!name.starts_with(beginning)) return {};
  name.remove_prefix(beginning.size());
  return parse_number(name) ? name : std::string_view();
}

Result<std::vector<std::string>> effects_of_word(const std::string& name) {
  for (const auto& [word, effect] : kNumbered)
    if (const auto number = number_behind(name, word); !number.empty())
      return std::vector{std::string(effect).append(number)};
  const std::string_view old = number_behind(name, "tilts-").empty() ? name : std::string_view("tilts");
  const auto gone = std::ranges::find(kGone, old, [](const auto& pair) { return pair.first; });
  if (gone != std::end(kGone)) return usage_error("--effects names \"{}\", which is gone: {}", name, gone->second);
  const auto known = std::ranges::find(all_words(), name, &Word::word);
  if (known != all_words().end()) return known->effects;
  return usage_error("--effects names \"{}\": there are {}, and single lobes such as lobe-20 or gloss-900", name,
                     joined(all_words(), ", ", &Word::word));
}

}  // namespace

std::optional<bool> EffectWords::forced_on(const std::string& name, const std::string& group) const {
  std::optional<bool> result;
  for (const auto& [named, on] : forced)
    if (named == name || named == group) result = on;
  return result;
}

bool EffectWords::leave_out_rays() const {
  bool shadow = start != Start::kNone, named = false;
  for (const auto& [name, on] : forced) {
    if (name == "rays" || name == "shadow") shadow = on, named = true;
    if ((name == "self" || name == "bounce") && on && !named) shadow = true;
  }
  return !shadow;
}

Result<EffectWords> words_of(const std::string& text) {
  static constexpr std::pair<std::string_view, Start> kStarts[] = {
      {"auto", Start::kAuto}, {"all", Start::kAll}, {"none", Start::kNone}};
  EffectWords words;
  for (const std::string_view piece : split(text, ',')) {
    const std::string word(trimmed(piece));
    const auto start = std::ranges::find(kStarts, word, [](const auto& known) { return known.first; });
    if (start != std::end(kStarts)) {
      words.start = start->second;
    } else if (word.size() > 1 && (word[0] == '+' || word[0] == '-')) {
      GONIO_ASSIGN(const std::vector<std::string> effects, effects_of_word(word.substr(1)));
      for (const std::string& effect : effects) words.forced.emplace_back(effect, word[0] == '+');
    } else {
      return usage_error("--effects is \"{}\": write auto, all or none, then +NAME or -NAME, as in \"auto,-fresnel\"",
                         text);
    }
  }
  return words;
}

std::string effect_items() {
  std::string text;
  for (const Word& word : all_words()) text += fmt::format("\n- {}: {}.", word.word, word.meaning);
  return text;
}

std::string word_of_effect(const std::string& effect) {
  for (const auto& [word, numbered] : kNumbered)
    if (const auto number = number_behind(effect, numbered); !number.empty()) return std::string(word).append(number);
  for (const Word& word : all_words())
    if (std::ranges::find(word.effects, effect) != word.effects.end()) return word.word;
  return effect;
}

}  // namespace goniochrome::render
