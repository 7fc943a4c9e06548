#include "render/textures/texture_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

using Uv = std::array<double, 2>;

// OpenGL rounds corners to a fraction of a pixel: a pixel that it gave to a triangle may be this far outside of it, in
// pixels.
constexpr double kMargin = 1.0 / 64;

// So many rows are drawn at a time.
constexpr std::size_t kRowsAtOnce = 96;

// The texture coordinates of a triangle's corners.
class Unwrapped {
 public:
  explicit Unwrapped(const mesh::Mesh& mesh) : mesh_(mesh), box_(mesh::bounding_box(mesh)) {
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
    return uv;
  }

 private:
  Uv corner(std::uint32_t vertex) const {
    if (!mesh_.texture.empty()) return {mesh_.texture[vertex][0], mesh_.texture[vertex][1]};
    const Vec3 p = mesh_.positions[vertex] - middle_;
    const double turn = 2 * std::numbers::pi;
    return {std::atan2(p.x, p.z) / turn, (mesh_.positions[vertex].y - box_.low.y) / (turn * std::max(radius_, 1e-300))};
  }

  const mesh::Mesh& mesh_;
  mesh::Box box_;
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

std::array<Vec3, 3> corners_of(const mesh::Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  return {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]};
}

// The pixels whose centers lie between the least and the largest of three coordinates, within first and last.
std::array<int, 2> pixels(double a, double b, double c, int first, int last) {
  const double low = std::min({a, b, c}) - kMargin, high = std::max({a, b, c}) + kMargin;
  return {static_cast<int>(std::clamp<double>(std::ceil(low - 0.5), first, last)),
          static_cast<int>(std::clamp<double>(std::floor(high - 0.5) + 1, first, last))};
}

}  // namespace

// The triangles of some rows of a picture, drawn one by one. Where the G-buffer shows another part than a triangle's,
// it draws nothing; of the same part the nearest is kept.
class TextureLayout::Canvas {
 public:
  Canvas(const TextureLayout& layout, const Gbuffer& gbuffer, const std::vector<Vec3>& projected, int first, int last,
         std::vector<TexturePlace>& places)
      : layout_(layout),
        gbuffer_(gbuffer),
        projected_(projected),
        first_(first),
        last_(last),
        places_(places),
        nearness_(static_cast<std::size_t>(last - first) * static_cast<std::size_t>(gbuffer.width), 0.0) {}

  // 1/t is linear in the picture, and so is what is linear on the triangle, divided by t. A triangle around the eye is
  // not drawn.
  void draw(const Face& face) {
    const Vec3 &p = projected_[face.vertex[0]], &q = projected_[face.vertex[1]], &r = projected_[face.vertex[2]];
    if (p.z <= 0 || q.z <= 0 || r.z <= 0) return;
    const auto [y0, y1] = pixels(p.y, q.y, r.y, first_, last_);
    if (y0 >= y1) return;
    const auto [x0, x1] = pixels(p.x, q.x, r.x, 0, gbuffer_.width);
    const Vec3 a = q - p, b = r - p;
    const double area = a.x * b.y - b.x * a.y;
    if (x0 >= x1 || area == 0) return;
    // A weight falls from 1 to 0 over the height of its corner.
    const auto margin = [&](const Vec3& edge) { return -kMargin * std::hypot(edge.x, edge.y) / std::abs(area); };
    const double m0 = margin(r - q), m1 = margin(b), m2 = margin(a);
    for (int row = y0; row < y1; ++row) {
      for (int column = x0; column < x1; ++column) {
        const double x = column + 0.5 - p.x, y = row + 0.5 - p.y;
        const double w1 = (x * b.y - b.x * y) / area, w2 = (a.x * y - x * a.y) / area, w0 = 1 - w1 - w2;
        if (w0 < m0 || w1 < m1 || w2 < m2 || gbuffer_.part(column, row) != face.part) continue;
        put(column, row, {w0 * p.z, w1 * q.z, w2 * r.z}, face);
      }
    }
  }

 private:
  void put(int column, int row, const Vec3& weights, const Face& face) {
    const double nearness = weights.x + weights.y + weights.z;
    double& nearest = nearness_[static_cast<std::size_t>(row - first_) * gbuffer_.width + column];
    if (nearness <= nearest) return;
    nearest = nearness;
    double u = 0, v = 0;
    Vec3 t;
    for (int k = 0; k < 3; ++k) {
      const double share = weights[k] / nearness;
      u += share * face.uv[k].u, v += share * face.uv[k].v;
      t += share * layout_.tangents_[face.vertex[k]];
    }
    places_[static_cast<std::size_t>(row) * gbuffer_.width + column] = {
        static_cast<float>(u),
        static_cast<float>(v),
        {static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z)}};
  }

  const TextureLayout& layout_;
  const Gbuffer& gbuffer_;
  const std::vector<Vec3>& projected_;
  int first_, last_;
  std::vector<TexturePlace>& places_;
  std::vector<double> nearness_;
};

TextureLayout::TextureLayout(const mesh::Mesh& mesh, const std::vector<bool>& parts)
    : mesh_(mesh), tangents_(mesh.positions.size()) {
  const Unwrapped unwrapped(mesh);
  for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
    if (part >= parts.size() || !parts[part]) continue;
    for (std::size_t i = mesh.parts[part].first; i < mesh.parts[part].first + mesh.parts[part].count; ++i) {
      const auto& triangle = mesh.triangles[i];
      const auto uv = unwrapped.of(triangle);
      const Vec3 tangent = along_u(corners_of(mesh, triangle), uv);
      Face face{{triangle[0], triangle[1], triangle[2]}, {}, static_cast<int>(part)};
      for (std::size_t k = 0; k < 3; ++k) {
        face.uv[k] = {static_cast<float>(uv[k][0]), static_cast<float>(uv[k][1])};
        tangents_[triangle[k]] += tangent;
      }
      faces_.push_back(face);
    }
  }
  for (Vec3& tangent : tangents_) {
    const double size = length(tangent);
    tangent = size > 0 ? (1 / size) * tangent : Vec3{1, 0, 0};
  }
}

std::vector<TexturePlace> TextureLayout::places(const Gbuffer& gbuffer) const {
  const Projection project(gbuffer.rays);
  std::vector<Vec3> projected(mesh_.positions.size());  // x, y in pixels and 1/t
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const Vec3 from_eye = mesh_.positions[i] - gbuffer.rays.eye;
    const double t = dot(project.t, from_eye);
    if (t > 0) projected[i] = {dot(project.x, from_eye) / t, dot(project.y, from_eye) / t, 1 / t};
  }
  std::vector<TexturePlace> places(static_cast<std::size_t>(gbuffer.width) * gbuffer.height);
  parallel_for(static_cast<std::size_t>(gbuffer.height), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    Canvas canvas(*this, gbuffer, projected, static_cast<int>(begin), static_cast<int>(end), places);
    for (const Face& face : faces_) canvas.draw(face);
  });
  return places;
}

}  // namespace goniochrome::render
