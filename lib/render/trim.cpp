#include "render/trim.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render {

namespace {

using Words = std::vector<std::string>;

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool is_capital(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}

// The words of a name in lower case. Words begin at a capital behind a small letter (carWindow), and at the last of
// several capitals before a small letter (RIMFront).
Words words_in(const std::string& name) {
  Words words;
  bool inside = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool letter = is_letter(name[i]);
    const bool small_next = i + 1 < name.size() && is_letter(name[i + 1]) && !is_capital(name[i + 1]);
    const bool begins = letter && (!inside || (is_capital(name[i]) && (!is_capital(name[i - 1]) || small_next)));
    if (begins) words.emplace_back();
    if (letter) words.back() += name[i];
    inside = letter;
  }
  for (std::string& word : words) word = lower(word);
  return words;
}

bool has_any(const Words& words, std::initializer_list<std::string_view> wanted) {
  return std::ranges::any_of(words,
                             [&](const std::string& word) { return std::ranges::find(wanted, word) != wanted.end(); });
}

bool has_glass(Words words) {
  for (std::size_t i = 1; i < words.size(); ++i)
    if (words[i] == "glass" && (words[i - 1] == "fiber" || words[i - 1] == "fibre")) words[i].clear();
  return has_any(words, {"glass", "window", "windows", "windshield", "windscreen"});
}

std::optional<TrimKind> kind_by(const Words& words) {
  if (has_glass(words)) return TrimKind::kGlass;
  if (has_any(words, {"tire", "tires", "tyre", "tyres", "rubber", "seam", "seams", "underbody", "underside"}))
    return TrimKind::kBlack;
  if (has_any(words, {"rim", "rims", "wheel", "wheels", "chrome", "metal"})) return TrimKind::kMetal;
  return std::nullopt;
}

}  // namespace

std::optional<TrimKind> trim_kind(const mesh::MeshPart& part) {
  const Words name = words_in(part.name), material = words_in(part.material);
  for (const Words& words : {name, material})
    if (const auto kind = kind_by(words)) return kind;
  for (const Words& words : {name, material})
    if (has_any(words, {"paint", "painted", "carpaint", "body"})) return std::nullopt;
  if (part.look == mesh::Look::kClear) return TrimKind::kGlass;
  if (part.look == mesh::Look::kPolishedMetal) return TrimKind::kMetal;
  return std::nullopt;
}

paint::LobeFit trim_finish(TrimKind kind, bool with_mirror) {
  paint::LobeFit finish;
  const double reflectance = kind == TrimKind::kGlass ? 0.005 : kind == TrimKind::kBlack ? 0.03 : 0.2;
  finish.diffuse = (reflectance / kPi) * color::Rgb{1, 1, 1};
  if (kind == TrimKind::kBlack || !with_mirror) return finish;
  finish.lobes.push_back({paint::kMirrorExponent, {}, {1, 1, 1}});
  return brdf::under_coat(finish, brdf::kCoatIndex);
}

std::optional<paint::LobeFit> trim_of(const mesh::MeshPart& part, bool with_mirror) {
  const auto kind = trim_kind(part);
  return kind ? std::optional(trim_finish(*kind, with_mirror)) : std::nullopt;
}

}  // namespace goniochrome::render
