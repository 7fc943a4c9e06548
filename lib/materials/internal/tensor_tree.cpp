#include "materials/internal/tensor_tree.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::materials {

namespace {

constexpr int kDeepest = 8, kSize = 1 << kDeepest;
// Subtrees of this depth are grown side by side.
constexpr int kSplit = 3;
// The largest range of lightness and of chromaticity in a leaf, in the units of CIEDE2000. The difference of a
// direction from the mean of its leaf is a quarter of that in the mean. With 1, metallic paints are a third farther
// away, and their files have half of the size.
constexpr double kMostRange = 0.5;
// One cell, at grazing incidence and exit, is black. Radiance takes the least color of a table out of it as a diffuse
// part, and to version 6.0 the chromaticities of a tree of rank 3 are lost in that; a least color of 0 keeps it from
// doing so.
constexpr std::array<int, 3> kBlackCell = {0, 0, kSize - 1};
// Cells nearer to the mirror direction than this have the mean over places within them, others the color of their
// middle.
constexpr double kNearMirror_rad = 6 * kDegree;

// The concentric map [ShirleyChiu1997] between the unit disc and the unit square; the x axis of the disc goes to the
// middle of a side.
struct DiscPlace {
  double x, y;
};
DiscPlace disc_of(const DiscPlace& square) {
  const double a = 2 * square.x - 1, b = 2 * square.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool across = std::abs(a) > std::abs(b);
  const double radius = across ? a : b, angle = across ? kPi / 4 * b / a : kPi / 2 - kPi / 4 * a / b;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}
DiscPlace square_of(const DiscPlace& disc) {
  const double radius = std::hypot(disc.x, disc.y);
  double angle = std::atan2(disc.y, disc.x);
  if (angle < -kPi / 4) angle += 2 * kPi;
  const int side = std::min(static_cast<int>((angle + kPi / 4) / (kPi / 2)), 3);
  const double along = radius * (angle - side * kPi / 2) / (kPi / 4);
  const DiscPlace sides[] = {{radius, along}, {-along, radius}, {-radius, -along}, {along, -radius}};
  return {(sides[side].x + 1) / 2, (sides[side].y + 1) / 2};
}

Vec3 above(double x, double y) {
  return {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
}

// The directions at a place of the cube. Light comes from the side of -x.
struct Pair {
  Vec3 light, view;
};
Pair pair_at(double incidence, double x, double y) {
  const DiscPlace out = disc_of({x, y});
  return {above(-(1 - 2 * incidence), 0), above(out.x, out.y)};
}

// The color of a finest cell.
color::Xyz color_of(const TensorTree::Reflection& f, const std::array<int, 3>& cell) {
  if (cell == kBlackCell) return {};
  const auto place = [&](int axis, double within) { return (cell[static_cast<std::size_t>(axis)] + within) / kSize; };
  const Pair middle = pair_at(place(0, 0.5), place(1, 0.5), place(2, 0.5));
  const Vec3 mirror{-middle.light.x, 0, middle.light.z};
  if (dot(mirror, middle.view) < std::cos(kNearMirror_rad)) return f(middle.light, middle.view);
  constexpr int kPlaces = 3;
  color::Xyz sum;
  for (int i = 0; i < kPlaces * kPlaces * kPlaces; ++i) {
    const auto within = [](int k) { return (k + 0.5) / kPlaces; };
    const Pair pair = pair_at(place(0, within(i % kPlaces)), place(1, within(i / kPlaces % kPlaces)),
                              place(2, within(i / kPlaces / kPlaces)));
    const color::Xyz here = f(pair.light, pair.view);
    sum.X += here.X, sum.Y += here.Y, sum.Z += here.Z;
  }
  constexpr double kCount = kPlaces * kPlaces * kPlaces;
  return {sum.X / kCount, sum.Y / kCount, sum.Z / kCount};
}

// Y, u' and v'; those of the illuminant E where there is no light.
std::array<double, 3> chromaticity_of(const color::Xyz& xyz) {
  const double sum = xyz.X + 15 * xyz.Y + 3 * xyz.Z;
  if (!(xyz.Y > 0) || !(sum > 0)) return {std::max(xyz.Y, 0.0), 4.0 / 19, 9.0 / 19};
  return {xyz.Y, 4 * xyz.X / sum, 9 * xyz.Y / sum};
}

// Lightness in steps of CIEDE2000: the integral of 1/S_L, with S_L = 1 + 0.015 |L* - 50|.
double lightness_of(double Y) {
  constexpr double kSlope = 0.015;
  const double L = Y > 216.0 / 24389 ? 116 * std::cbrt(Y) - 16 : Y * 24389 / 27;
  return std::copysign(std::log1p(kSlope * std::abs(L - 50)) / kSlope, L - 50);
}

// The weight of a difference of u' or v' at that color: 13 L*, less S_C = 1 + 0.045 C*.
double weight_of_chromaticity(double Y, double u, double v) {
  const double L = std::min(116 * std::cbrt(Y) - 16, 100.0);
  if (L <= 0) return 0;
  const double chroma = 13 * L * std::hypot(u - 4.0 / 19, v - 9.0 / 19);
  return 13 * L / (1 + 0.045 * chroma);
}

}  // namespace

// The contents of a cell: the sum of its finest colors, and the ends of lightness and chromaticity among them.
struct TensorTree::Range {
  color::Xyz sum;
  std::array<double, 3> low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};

  void add(const Range& part) {
    sum.X += part.sum.X, sum.Y += part.sum.Y, sum.Z += part.sum.Z;
    for (std::size_t i = 0; i < 3; ++i)
      low[i] = std::min(low[i], part.low[i]), high[i] = std::max(high[i], part.high[i]);
  }
  double lightness() const { return high[0] - low[0]; }
  // `mean` is Y of the perfect diffuser 1, u' and v'.
  double chromaticity(const std::array<double, 3>& mean) const {
    return weight_of_chromaticity(mean[0], mean[1], mean[2]) * std::max(high[1] - low[1], high[2] - low[2]);
  }
};

// Fills nodes[at], and puts its children behind all others.
TensorTree::Range TensorTree::grow(const Reflection& f, const std::array<int, 3>& cell, int depth,
                                   std::vector<Node>& nodes, std::size_t at) const {
  Range range;
  if (depth == kDeepest) {
    range.sum = color_of(f, cell);
    const auto [Y, u, v] = chromaticity_of(range.sum);
    range.low = range.high = {lightness_of(kPi * Y), u, v};
    nodes[at] = {{static_cast<float>(Y), static_cast<float>(u), static_cast<float>(v)}, -1, true};
    return range;
  }
  const std::size_t child = nodes.size();
  nodes.resize(child + 8);
  for (std::size_t n = 0; n < 8; ++n) {
    std::array<int, 3> part{};
    for (std::size_t axis = 0; axis < 3; ++axis) part[axis] = 2 * cell[axis] + static_cast<int>(n >> axis & 1);
    range.add(grow(f, part, depth + 1, nodes, child + n));
  }
  const double cells = std::exp2(3 * (kDeepest - depth));
  const auto [Y, u, v] = chromaticity_of({range.sum.X / cells, range.sum.Y / cells, range.sum.Z / cells});
  Node& node = nodes[at];
  node.value = {static_cast<float>(Y), static_cast<float>(u), static_cast<float>(v)};
  node.even_hue = range.chromaticity({kPi * Y, u, v}) <= kMostRange;
  if (node.even_hue && range.lightness() <= kMostRange)
    nodes.resize(child);
  else
    node.child = static_cast<std::int32_t>(child);
  return range;
}

// Half of the first axis is used, since the sine of the incidence is from 0 to 1, and the lower half of the third axis
// mirrors the upper one.
TensorTree::TensorTree(const Reflection& f) {
  constexpr int kParts = 1 << kSplit, kUsed = kParts / 2 * kParts * kParts / 2;
  std::vector<std::vector<Node>> subtrees(kUsed, std::vector<Node>(1));
  const auto cell_of = [](int i) {
    return std::array<int, 3>{i % (kParts / 2), i / (kParts / 2) % kParts, kParts / 2 + i / (kParts / 2) / kParts};
  };
  parallel_for(kUsed, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      grow(f, cell_of(static_cast<int>(i)), kSplit, subtrees[i], 0);
    }
  });
  // The branches above them, as a full tree whose lower half of the third axis stays empty.
  nodes_.resize(1);
  std::vector<std::pair<std::size_t, std::array<int, 3>>> level = {{0, {0, 0, 0}}};
  for (int depth = 0; depth < kSplit; ++depth) {
    std::vector<std::pair<std::size_t, std::array<int, 3>>> next;
    for (const auto& [node, cell] : level) {
      const std::size_t child = nodes_.size();
      nodes_.resize(child + 8);
      nodes_[node].child = static_cast<std::int32_t>(child);
      for (std::size_t n = 0; n < 8; ++n) {
        std::array<int, 3> part{};
        for (std::size_t axis = 0; axis < 3; ++axis) part[axis] = 2 * cell[axis] + static_cast<int>(n >> axis & 1);
        const int parts = 2 << depth;
        if (part[0] < parts / 2 && part[2] >= parts / 2) next.emplace_back(child + n, part);
      }
    }
    level = std::move(next);
  }
  for (const auto& [node, cell] : level) {
    const int i = cell[0] + kParts / 2 * (cell[1] + kParts * (cell[2] - kParts / 2));
    const std::vector<Node>& part = subtrees[static_cast<std::size_t>(i)];
    const auto shift = static_cast<std::int32_t>(nodes_.size()) - 1;
    nodes_[node] = part[0];
    if (part[0].child >= 0) nodes_[node].child += shift;
    for (std::size_t k = 1; k < part.size(); ++k) {
      nodes_.push_back(part[k]);
      if (part[k].child >= 0) nodes_.back().child += shift;
    }
  }
}

color::Xyz TensorTree::at(const Vec3& to_light, const Vec3& to_viewer) const {
  constexpr double kTiny = 1e-6;  // of Radiance, by which the normal stays in the used half
  const double sine = std::hypot(to_light.x, to_light.y);
  const double c = sine > 0 ? -to_light.x / sine : 1, s = sine > 0 ? -to_light.y / sine : 0;
  const DiscPlace out = square_of({c * to_viewer.x + s * to_viewer.y, std::abs(c * to_viewer.y - s * to_viewer.x)});
  std::array<double, 3> place = {0.5 - kTiny - sine / 2, out.x, out.y};
  std::size_t node = 0, hue = 0;
  while (!ends(node, 0)) {
    std::size_t n = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      place[axis] *= 2;
      if (place[axis] >= 1) n |= std::size_t{1} << axis, place[axis] -= 1;
    }
    node = static_cast<std::size_t>(nodes_[node].child) + n;
    if (!nodes_[hue].even_hue) hue = node;
  }
  const double Y = nodes_[node].value[0], u = nodes_[hue].value[1], v = nodes_[hue].value[2];
  return {Y * 9 * u / (4 * v), Y, Y * (12 - 3 * u - 20 * v) / (4 * v)};
}

bool TensorTree::ends(std::size_t node, int channel) const {
  return nodes_[node].child < 0 || (channel > 0 && nodes_[node].even_hue);
}

// Eight leaves are one grid, in which the last axis is the fastest; of eight branches the first axis is.
void TensorTree::append(std::string& text, std::size_t node, int channel, bool mirrored) const {
  const auto put = [&](std::size_t k) {
    const double x = nodes_[k].value[static_cast<std::size_t>(channel)];
    std::array<char, 32> digits;  // as few as any number of a tree takes
    const auto format = channel == 0 ? std::chars_format::general : std::chars_format::fixed;
    text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x, format, 4).ptr);
  };
  if (ends(node, channel)) {
    text += '{';
    put(node);
    text += '}';
    return;
  }
  const auto child = static_cast<std::size_t>(nodes_[node].child);
  const std::size_t flip = mirrored ? 4 : 0;
  bool grid = true;
  for (std::size_t n = 0; n < 8; ++n) grid = grid && ends(child + n, channel);
  text += '{';
  for (std::size_t i = 0; i < 8; ++i) {
    if (!grid) {
      append(text, child + (i ^ flip), channel, mirrored);
      continue;
    }
    if (i > 0) text += ' ';
    put(child + (((i >> 2 & 1) | (i & 2) | (i & 1) << 2) ^ flip));
  }
  text += "}\n";
}

std::string TensorTree::text(int channel) const {
  std::string text = "{\n";
  const auto child = static_cast<std::size_t>(nodes_[0].child);
  for (std::size_t n = 0; n < 8; ++n) {
    if (n & 1)
      text += "{0}\n";
    else
      append(text, child + (n | 4), channel, (n & 4) == 0);
  }
  return text + "}\n";
}

}  // namespace goniochrome::materials
