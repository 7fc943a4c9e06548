// The graph of MaterialX before it is text: nodes of diffuse light and of microfacets, each with a tint, under a
// mirror. What the nodes show, and which of them come nearest to a paint. goniochrome-export(7), "EXPORT".
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "color/color.h"
#include "materials/internal/color_space.h"
#include "materials/internal/shown.h"

namespace goniochrome::materials {

// A tint is made of Bernstein's four cubic polynomials of the cosine of the viewer: c^3, 3 c^2 (1 - c), 3 c (1 - c)^2
// and (1 - c)^3.
constexpr std::size_t kTintParts = 4;
std::array<double, kTintParts> tint_parts(double cosine);

// The facets of a lobe reflect color0 + (color90 - color0) (1 - cos(theta_d))^exponent, in all channels alike.
struct Facets {
  double color0, color90, exponent;
};

constexpr double kLeastCosine = 0.05;  // of the viewer, below which a lobe is no longer widened

struct BaseNode {
  enum class Kind { kFlat, kBurley, kLobe } kind = Kind::kFlat;
  double alpha = 0;      // of a lobe
  Facets facets = {};    // of a lobe
  bool widened = false;  // a lobe that is wider by 1/cosine beside the plane of the viewer
  std::array<color::Rgb, kTintParts> tints = {};

  // f of the node before its tint, 1/sr, as MaterialX defines it.
  double value(const Vec3& light, const Vec3& view) const;
  color::Rgb tint(double cosine) const;
  // The largest channel that the tint reaches for any viewer.
  double brightest() const;
};

struct CoatNode {
  double weight, alpha, index;
};

struct LobeGraph {
  ColorSpace space = ColorSpace::kRec709;
  std::vector<BaseNode> base;
  std::vector<CoatNode> coats;  // from the outside inward
  bool layered = true;          // coats take light from what is below them
};

// The graph that comes nearest to a paint with lobes, by the color differences of what it shows. A paint with a color
// outside of Rec.709 is in ACEScg, which has them all.
LobeGraph nearest_graph(const paint::Paint& paint);

// The color of the graph, in the working space.
Reflection seen_of(const LobeGraph& graph);

}  // namespace goniochrome::materials
