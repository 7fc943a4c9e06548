#include "materials/material.h"

#include <array>

#include "base/text.h"

namespace goniochrome::materials {

std::span<const Target* const> targets() {
  static constexpr std::array<const Target*, 13> kTargets = {
      &kRgl,     &kRglSpectral, &kMdl,  &kMdlAcescg, &kRadiance,  &kOpenMaterial, &kMaterialX, &kStandardSurface,
      &kOpenPbr, &kOpenPbrUsd,  &kGltf, &kUsd,       &kEnterprise};
  return kTargets;
}

std::vector<std::string> left_out(const paint::Paint& paint, const Target& target) {
  std::vector<std::string> parts;
  if (paint.color_map) parts.push_back("its color map");
  if (paint.anisotropy) parts.push_back("its anisotropy");
  if (paint.flakes && !target.has_flakes) parts.push_back("its flakes");
  return parts;
}

std::string Identifiers::of(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  std::string word;
  bool last_other = false;
  for (const char c : name.substr(0, 16 * kLongest)) {
    const bool digit = c >= '0' && c <= '9';
    const bool plain = digit || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (word.empty() && digit) word = "_";
    // The bytes of one letter that is not ASCII, and a run of such letters, are one underscore.
    if (plain || !last_other) word += plain ? c : '_';
    last_other = !plain;
  }
  word.resize(std::min(word.size(), kLongest));
  if (word.empty()) word = "paint";
  std::string unique = word;
  for (int n = 2; !taken_.insert(lower(unique)).second; ++n) unique = word + "_" + std::to_string(n);
  return unique;
}

}  // namespace goniochrome::materials
