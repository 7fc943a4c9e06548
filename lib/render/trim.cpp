#include "render/trim.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render {

namespace {

constexpr std::array<std::string_view, 4> kGlass = {"glass", "window", "windshield", "windscreen"};
constexpr std::array<std::string_view, 9> kBlack = {"tire", "tires", "tyre",      "tyres",    "rubber",
                                                    "seam", "seams", "underbody", "underside"};
constexpr std::array<std::string_view, 6> kMetal = {"rim", "rims", "wheel", "wheels", "chrome", "metal"};

template <std::size_t Count>
bool has_word_of(const std::string& text, const std::array<std::string_view, Count>& words) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const std::string small = lower(text);
  for (auto at = small.begin(); at != small.end();) {
    const auto begin = std::find_if(at, small.end(), is_letter), end = std::find_if_not(begin, small.end(), is_letter);
    if (std::ranges::find(words, std::string_view(begin, end)) != words.end()) return true;
    at = end;
  }
  return false;
}

std::optional<paint::LobeFit> finish_of(const std::string& text, bool with_mirror) {
  paint::LobeFit finish;
  const auto wear = [&](double reflectance, bool coated) {
    finish.diffuse = (reflectance / kPi) * color::Rgb{1, 1, 1};
    if (!coated || !with_mirror) return finish;
    finish.lobes.push_back({paint::kMirrorExponent, {}, {1, 1, 1}});
    return brdf::under_coat(finish, brdf::kCoatIndex);
  };
  if (has_word_of(text, kGlass)) return wear(0.005, true);
  if (has_word_of(text, kBlack)) return wear(0.03, false);
  if (has_word_of(text, kMetal)) return wear(0.2, true);
  return std::nullopt;
}

}  // namespace

std::optional<paint::LobeFit> trim_of(const mesh::MeshPart& part, bool with_mirror) {
  const auto finish = finish_of(part.name, with_mirror);
  return finish ? finish : finish_of(part.material, with_mirror);
}

}  // namespace goniochrome::render
