#include "render/texture_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace goniochrome {

namespace {

using Uv = std::array<double, 2>;

// The texture coordinates of a triangle's corners.
class Unwrapped {
 public:
  Unwrapped(const Mesh& mesh, double repeat) : mesh_(mesh), repeat_(repeat), box_(bounding_box(mesh)) {
    middle_ = 0.5 * (box_.low + box_.high);
    for (const Vec3& p : mesh.positions) radius_ = std::max(radius_, std::hypot(p.x - middle_.x, p.z - middle_.z));
  }

  std::array<Uv, 3> of(const std::array<std::uint32_t, 3>& triangle) const {
    std::array<Uv, 3> uv{};
    for (std::size_t k = 0; k < 3; ++k) uv[k] = corner(triangle[k]);
    if (mesh_.texture.empty()) {
      // Across the seam at the back the azimuth goes on.
      for (std::size_t k = 1; k < 3; ++k) uv[k][0] -= std::round(uv[k][0] - uv[0][0]);
    }
    for (Uv& place : uv) place = {place[0] * repeat_, place[1] * repeat_};
    return uv;
  }

 private:
  Uv corner(std::uint32_t vertex) const {
    if (!mesh_.texture.empty()) return {mesh_.texture[vertex][0], mesh_.texture[vertex][1]};
    const Vec3 p = mesh_.positions[vertex] - middle_;
    const double turn = 2 * std::numbers::pi;
    return {std::atan2(p.x, p.z) / turn, (mesh_.positions[vertex].y - box_.low.y) / (turn * std::max(radius_, 1e-300))};
  }

  const Mesh& mesh_;
  double repeat_;
  Box box_;
  Vec3 middle_;
  double radius_ = 0;
};

// The way along which u grows and v stays, as long as the triangle is large; 0 where the mapping has no area.
Vec3 along_u(const std::array<Vec3, 3>& p, const std::array<Uv, 3>& uv) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0];
  const double ua = uv[1][0] - uv[0][0], va = uv[1][1] - uv[0][1], ub = uv[2][0] - uv[0][0], vb = uv[2][1] - uv[0][1];
  const Vec3 way = ua * vb > ub * va ? vb * a - va * b : va * b - vb * a;
  const double size = length(way);
  return size > 0 ? (length(cross(a, b)) / size) * way : Vec3{};
}

// A point relative to the eye is t (corner + x right + y down); these are the rows that give t, t x and t y.
struct Projection {
  Vec3 x, y, t;
  explicit Projection(const Rays& rays) {
    const double determinant = dot(rays.corner, cross(rays.right, rays.down));
    x = (1 / determinant) * cross(rays.down, rays.corner);
    y = (1 / determinant) * cross(rays.corner, rays.right);
    t = (1 / determinant) * cross(rays.right, rays.down);
  }
};

// What a corner of a triangle carries.
struct Carried {
  Uv uv;
  Vec3 tangent;
};

// The triangles of a picture, drawn one by one, the nearest kept.
class Canvas {
 public:
  Canvas(const Rays& rays, const Vec3& eye, int width, int height)
      : project_(rays),
        eye_(eye),
        width_(width),
        height_(height),
        places_(static_cast<std::size_t>(width) * height),
        nearness_(places_.size(), 0.0) {}

  // Every pixel center inside the projected triangle. 1/t is linear in the picture, and so is what is linear on the
  // triangle, divided by t. A triangle around the eye is not drawn.
  void draw(const std::array<Vec3, 3>& p, const std::array<Carried, 3>& corners) {
    std::array<Vec3, 3> q;  // x, y in pixels and 1/t
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 from_eye = p[k] - eye_;
      const double t = dot(project_.t, from_eye);
      if (t <= 0) return;
      q[k] = {dot(project_.x, from_eye) / t, dot(project_.y, from_eye) / t, 1 / t};
    }
    const Vec3 a = q[1] - q[0], b = q[2] - q[0];
    const double area = a.x * b.y - b.x * a.y;
    if (area == 0) return;
    const auto [x0, x1] = pixels({q[0].x, q[1].x, q[2].x}, width_);
    const auto [y0, y1] = pixels({q[0].y, q[1].y, q[2].y}, height_);
    for (int row = y0; row < y1; ++row) {
      for (int column = x0; column < x1; ++column) {
        const double x = column + 0.5 - q[0].x, y = row + 0.5 - q[0].y;
        const double w1 = (x * b.y - b.x * y) / area, w2 = (a.x * y - x * a.y) / area, w0 = 1 - w1 - w2;
        if (w0 >= 0 && w1 >= 0 && w2 >= 0) put(column, row, {w0 * q[0].z, w1 * q[1].z, w2 * q[2].z}, corners);
      }
    }
  }
  std::vector<TexturePlace> places() && { return std::move(places_); }

 private:
  // The pixels whose centers lie between the least and the largest of three coordinates.
  static std::array<int, 2> pixels(const std::array<double, 3>& at, int n) {
    const auto [low, high] = std::minmax_element(at.begin(), at.end());
    return {static_cast<int>(std::clamp(std::ceil(*low - 0.5), 0.0, static_cast<double>(n))),
            static_cast<int>(std::clamp(std::floor(*high - 0.5) + 1, 0.0, static_cast<double>(n)))};
  }

  void put(int column, int row, const Vec3& weights, const std::array<Carried, 3>& corners) {
    const double nearness = weights.x + weights.y + weights.z;
    const std::size_t at = static_cast<std::size_t>(row) * width_ + column;
    if (nearness <= nearness_[at]) return;
    nearness_[at] = nearness;
    Uv uv{};
    Vec3 t;
    for (int k = 0; k < 3; ++k) {
      const Carried& corner = corners[static_cast<std::size_t>(k)];
      const double share = weights[k] / nearness;
      uv = {uv[0] + share * corner.uv[0], uv[1] + share * corner.uv[1]};
      t += share * corner.tangent;
    }
    places_[at] = {static_cast<float>(uv[0]),
                   static_cast<float>(uv[1]),
                   {static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z)}};
  }

  Projection project_;
  Vec3 eye_;
  int width_, height_;
  std::vector<TexturePlace> places_;
  std::vector<double> nearness_;
};

std::array<Vec3, 3> corners_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  return {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]};
}

}  // namespace

// Tangents are the means over the triangles at a vertex, by area, so that a smooth surface has smooth tangents.
std::vector<TexturePlace> texture_places(const Mesh& mesh, const Rays& rays, const Vec3& eye, int width, int height,
                                         double repeat) {
  const Unwrapped unwrapped(mesh, repeat);
  std::vector<Vec3> tangents(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    const Vec3 tangent = along_u(corners_of(mesh, triangle), unwrapped.of(triangle));
    for (const std::uint32_t vertex : triangle) tangents[vertex] += tangent;
  }
  for (Vec3& tangent : tangents) {
    const double size = length(tangent);
    tangent = size > 0 ? (1 / size) * tangent : Vec3{1, 0, 0};
  }
  Canvas canvas(rays, eye, width, height);
  for (const auto& triangle : mesh.triangles) {
    const auto uv = unwrapped.of(triangle);
    std::array<Carried, 3> carried{};
    for (std::size_t k = 0; k < 3; ++k) carried[k] = {uv[k], tangents[triangle[k]]};
    canvas.draw(corners_of(mesh, triangle), carried);
  }
  return std::move(canvas).places();
}

}  // namespace goniochrome
