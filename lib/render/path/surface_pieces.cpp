#include "render/path/surface_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::Hit;

// The most lines across a triangle: its edges are at most 2 sqrt(3) long.
constexpr float kMostCuts = 42;

}  // namespace

SurfacePieces::SurfacePieces(const rays::RayScene& scene) : scene_(scene) {
  const auto triangles = static_cast<std::uint32_t>(scene.triangles());
  first_.reserve(triangles), cuts_.reserve(triangles);
  for (std::uint32_t triangle = 0; triangle < triangles; ++triangle) {
    const std::array<Float3, 3> corner = scene.corners(triangle);
    float longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, rays::length(corner[k] - corner[(k + 1) % 3]));
    const auto cuts = static_cast<std::uint16_t>(std::clamp(std::ceil(longest / kPiece), 1.0F, kMostCuts));
    first_.push_back(count());
    cuts_.push_back(cuts);
    triangle_.insert(triangle_.end(), static_cast<std::size_t>(cuts) * cuts, triangle);
  }
}

// Row i, from 0, holds 2 (n - i) - 1 pieces, of which every second one is upside down.
std::uint32_t SurfacePieces::at(std::uint32_t triangle, float u, float v) const {
  if (triangle >= rays::kFloor) return kNone;
  const int n = cuts_[triangle];
  const float s = u * static_cast<float>(n), t = v * static_cast<float>(n);
  const int i = std::clamp(static_cast<int>(s), 0, n - 1), j = std::clamp(static_cast<int>(t), 0, n - 1 - i);
  const bool upper = s - static_cast<float>(i) + t - static_cast<float>(j) > 1 && i + j < n - 1;
  return first_[triangle] + static_cast<std::uint32_t>(i * (2 * n - i) + 2 * j + (upper ? 1 : 0));
}

double SurfacePieces::area(std::uint32_t piece) const {
  const std::uint32_t triangle = triangle_[piece];
  const double n = cuts_[triangle];
  return 0.5 * length(scene_.doubled_area(triangle)) / (n * n);
}

SurfacePieces::Placed SurfacePieces::placed(std::uint32_t piece) const {
  const Vec3 area = scene_.doubled_area(triangle_[piece]);
  const double size = length(area);
  // The numbers of the middle: sqrt(4/9) and 1/2.
  return {position(drawn(piece, 4.0 / 9, 0.5)), size > 0 ? rays::float3((1 / size) * area) : Float3{}};
}

Hit SurfacePieces::drawn(std::uint32_t piece, double u, double v) const {
  const std::uint32_t triangle = triangle_[piece];
  const int n = cuts_[triangle], place = static_cast<int>(piece - first_[triangle]);
  const int i = n - static_cast<int>(std::ceil(std::sqrt(static_cast<double>(n * n - place))));
  const int along = place - i * (2 * n - i), j = along / 2;
  // Even over the triangle: the square folded along its diagonal by way of the root.
  const double root = std::sqrt(u);
  double b = root * (1 - v), c = root * v;
  if (along % 2 != 0) b = 1 - b, c = 1 - c;
  return {triangle, static_cast<float>((i + b) / n), static_cast<float>((j + c) / n), 0};
}

Float3 SurfacePieces::position(const Hit& hit) const {
  const std::array<Float3, 3> corner = scene_.corners(hit.triangle);
  return corner[0] + hit.u * (corner[1] - corner[0]) + hit.v * (corner[2] - corner[0]);
}

}  // namespace goniochrome::render
