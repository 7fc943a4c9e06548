// The elements of paint XML, for the reader. goniochrome-paint(5), "PAINT XML".
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/text.h"

namespace goniochrome::formats {

inline constexpr std::string_view kPaintNamespace = "urn:goniochrome:paint:1",
                                  kBasisNamespace = "urn:goniochrome:basis:1";

enum class Node {
  kDocument,
  kPaints,
  kProcessing,
  kPaint,
  kMeasurement,
  kLab,
  kSpectrum,
  kTexture,
  kGloss,
  kAppearance,
  kFace,
  kFlop,
  kAnisotropy,
  kColorMap,
  kCoat,
  kFlakes,
  kLobes,
  kDiffuse,
  kLobe,
  kView,
  kViewDiffuse,
  kViewLobe
};

// The elements of paint XML: where each stands and what attributes it takes ("?" marks those that may be missing). The
// schema says the same, which a test holds.
struct ElementRule {
  Node node, parent;
  std::string_view name, attributes;
};
constexpr std::array kRules = {
    ElementRule{Node::kPaints, Node::kDocument, "paints", "version"},
    ElementRule{Node::kProcessing, Node::kPaints, "processing", "tool version command"},
    ElementRule{Node::kPaint, Node::kPaints, "paint", "name class? code?"},
    ElementRule{Node::kMeasurement, Node::kPaint, "measurement", "illuminant observer instrument? serial? date?"},
    ElementRule{Node::kLab, Node::kMeasurement, "lab", "geometry L a b"},
    ElementRule{Node::kSpectrum, Node::kMeasurement, "spectrum", "geometry from to step"},
    ElementRule{Node::kTexture, Node::kMeasurement, "texture", "quantity geometry version? value"},
    ElementRule{Node::kGloss, Node::kPaint, "gloss", "angle"},
    ElementRule{Node::kAppearance, Node::kPaint, "appearance", "travel residual_de00?"},
    ElementRule{Node::kFace, Node::kAppearance, "face", "L a b"},
    ElementRule{Node::kFlop, Node::kAppearance, "flop", "L a b"},
    ElementRule{Node::kAnisotropy, Node::kPaint, "anisotropy", "alphaX alphaY"},
    ElementRule{Node::kColorMap, Node::kPaint, "colorMap", "href index?"},
    ElementRule{Node::kCoat, Node::kPaint, "coat", "index"},
    ElementRule{Node::kFlakes, Node::kPaint, "flakes", "diameter_um coverage spread_deg"},
    ElementRule{Node::kLobes, Node::kPaint, "lobes", "space basis method max_de00 mean_de00"},
    ElementRule{Node::kDiffuse, Node::kLobes, "diffuse", "r g b"},
    ElementRule{Node::kLobe, Node::kLobes, "lobe", "exponent ddr ddg ddb gr gg gb"},
    ElementRule{Node::kView, Node::kLobes, "view", "angle"},
    ElementRule{Node::kViewDiffuse, Node::kView, "diffuse", "r g b"},
    ElementRule{Node::kViewLobe, Node::kView, "lobe", "exponent ddr ddg ddb gr gg gb"},
};

// True for elements whose children stand in the order of the table.
constexpr bool is_sequence(Node node) {
  return node == Node::kMeasurement || node == Node::kLobes || node == Node::kView;
}

inline std::string_view name_of(Node node) {
  return std::ranges::find(kRules, node, &ElementRule::node)->name;
}

inline std::string children_of(Node parent) {
  std::string names;
  for (const ElementRule& rule : kRules)
    if (rule.parent == parent) names += fmt::format("{}<{}>", names.empty() ? "" : ", ", rule.name);
  return names.empty() ? "nothing" : names;
}

}  // namespace goniochrome::formats
