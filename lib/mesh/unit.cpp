#include "mesh/unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/text.h"

namespace goniochrome::mesh {

namespace {

constexpr LengthUnit kMeters = {"meters", 1}, kFeet = {"feet", 0.3048}, kInches = {"inches", 0.0254},
                     kCentimeters = {"centimeters", 1e-2}, kMillimeters = {"millimeters", 1e-3};

constexpr std::array<std::pair<std::string_view, LengthUnit>, 18> kWords = {{{"meters", kMeters},
                                                                             {"metres", kMeters},
                                                                             {"meter", kMeters},
                                                                             {"m", kMeters},
                                                                             {"feet", kFeet},
                                                                             {"foot", kFeet},
                                                                             {"ft", kFeet},
                                                                             {"inches", kInches},
                                                                             {"inch", kInches},
                                                                             {"in", kInches},
                                                                             {"centimeters", kCentimeters},
                                                                             {"centimetres", kCentimeters},
                                                                             {"centimeter", kCentimeters},
                                                                             {"cm", kCentimeters},
                                                                             {"millimeters", kMillimeters},
                                                                             {"millimetres", kMillimeters},
                                                                             {"millimeter", kMillimeters},
                                                                             {"mm", kMillimeters}}};

// The unit behind the word `unit` or `units` of a line in lower case, and a colon or an equals sign; 0 for other lines.
double unit_behind(std::string_view line) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const std::size_t at = line.find("unit");
  if (at == std::string_view::npos || (at > 0 && is_letter(line[at - 1]))) return 0;
  line.remove_prefix(at + 4);
  if (line.starts_with('s')) line.remove_prefix(1);
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos || (line[begin] != ':' && line[begin] != '=')) return 0;
  line = trimmed(line.substr(begin + 1));
  const std::string_view word(line.begin(), std::ranges::find_if_not(line, is_letter));
  const auto known = std::ranges::find(kWords, word, &std::pair<std::string_view, LengthUnit>::first);
  return known == kWords.end() ? 0 : known->second.meters;
}

}  // namespace

double stated_unit_m(std::string_view content) {
  constexpr std::size_t kMostComments = 1 << 14, kStlHeader = 80;
  const bool is_ply = content.starts_with("ply");
  std::string_view head = content.substr(0, kMostComments);
  if (!head.starts_with('#') && !is_ply) {
    const std::size_t line = std::min(head.find('\n'), kStlHeader);
    return unit_behind(lower(head.substr(0, line)));
  }
  for (const std::string_view line : split(head, '\n'))
    if (line.starts_with('#') || (is_ply && line.starts_with("comment")))
      if (const double meters = unit_behind(lower(line)); meters > 0) return meters;
  return 0;
}

LengthUnit likely_unit(const Box& box) {
  const double size = length(box.size());
  return size <= 30 ? kMeters : size <= 300 ? kInches : size <= 900 ? kCentimeters : kMillimeters;
}

LengthUnit length_unit(const Mesh& mesh) {
  return mesh.unit_m > 0 ? unit_of(mesh.unit_m) : likely_unit(bounding_box(mesh));
}

LengthUnit unit_of(double meters) {
  constexpr std::array kAll = {kMeters, kFeet, kInches, kCentimeters, kMillimeters};
  return *std::ranges::min_element(kAll, {}, [&](const LengthUnit& u) { return std::abs(u.meters - meters); });
}

}  // namespace goniochrome::mesh
