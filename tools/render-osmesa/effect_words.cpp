#include "effect_words.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/text.h"
#include "render/scene_effects.h"

namespace goniochrome::tool {

namespace {

struct EffectWord {
  const char* word;
  std::vector<std::string> effects;  // of the plan
  const char* meaning;
};

const std::vector<EffectWord>& effect_words() {
  static const std::vector<EffectWord> words = {
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
      {"shadow", {"shadow"}, "the mesh blocks light"},
      {"rays", {"rays"}, "shadow, the body in itself, bounced light"},
  };
  return words;
}

// Words that a plan has and --effects has no more, and what to write instead.
constexpr std::array<std::pair<const char*, const char*>, 10> kGone = {{
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
}};

// A word with the number of a single lobe or set behind it, as travel-2: the word, and the effect of the plan.
struct Numbered {
  const char *word, *single, *effect;
};
constexpr std::array<Numbered, 4> kNumbered = {{{"lobes", "lobe-", "lobe-"},
                                                {"gloss", "gloss-", "gloss-"},
                                                {"travel", "travel-", "tilts-"},
                                                {"texture", "texture-", "texture-"}}};

bool is_numbered(const std::string& name, const char* single) {
  return name.starts_with(single) && parse_number(name.substr(std::string(single).size()));
}

Result<std::vector<std::string>> effects_of(const std::string& name) {
  for (const Numbered& numbered : kNumbered)
    if (is_numbered(name, numbered.single))
      return std::vector{numbered.effect + name.substr(std::string(numbered.single).size())};
  const std::string old = is_numbered(name, "tilts-") ? "tilts" : name;
  const auto gone = std::ranges::find(kGone, old, [](const auto& pair) { return std::string(pair.first); });
  if (gone != kGone.end()) return usage_error("--effects names \"{}\", which is gone: {}", name, gone->second);
  const auto known = std::ranges::find(effect_words(), name, &EffectWord::word);
  if (known != effect_words().end()) return known->effects;
  std::string words;
  for (const EffectWord& word : effect_words()) words += (words.empty() ? "" : ", ") + std::string(word.word);
  return usage_error("--effects names \"{}\": there are {}, and single lobes such as lobe-20 or gloss-900", name,
                     words);
}

}  // namespace

std::string effect_items() {
  std::string text;
  for (const EffectWord& word : effect_words()) text += fmt::format("\n- {}: {}.", word.word, word.meaning);
  return text;
}

Result<std::string> effects_of_words(const std::string& text) {
  std::string effects;
  for (const std::string_view piece : split(text, ',')) {
    const std::string word(trimmed(piece));
    const bool switches = word.size() > 1 && (word[0] == '+' || word[0] == '-');
    std::vector<std::string> names = {word};
    if (switches) {
      GONIO_ASSIGN(names, effects_of(word.substr(1)));
      for (std::string& name : names) name.insert(0, 1, word[0]);
    } else if (word != "auto" && word != "all" && word != "none") {
      return usage_error("--effects is \"{}\": write auto, all or none, then +NAME or -NAME, as in \"auto,-fresnel\"",
                         text);
    }
    effects += (effects.empty() ? "" : ",") + joined(names, ",");
  }
  return effects;
}

std::string word_of_effect(const std::string& effect) {
  for (const Numbered& numbered : kNumbered)
    if (is_numbered(effect, numbered.effect))
      return numbered.single + effect.substr(std::string(numbered.effect).size());
  for (const EffectWord& word : effect_words())
    if (std::ranges::find(word.effects, effect) != word.effects.end()) return word.word;
  return effect;
}

}  // namespace goniochrome::tool
