#include "render/textures/texture_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::render {

namespace {

using Uv = std::array<double, 2>;

// The texture coordinates of a triangle's corners.
class Unwrapped {
 public:
  explicit Unwrapped(const mesh::Mesh& mesh) : mesh_(mesh), box_(mesh::bounding_box(mesh)) {
    middle_ = box_.middle();
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
    const double turn = 2 * kPi;
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

// Corners that run clockwise on the texture.
bool is_mirrored(const std::array<std::array<float, 2>, 3>& uv) {
  return (uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) < (uv[2][0] - uv[0][0]) * (uv[1][1] - uv[0][1]);
}

}  // namespace

TextureLayout::TextureLayout(const mesh::Mesh& mesh, const std::vector<bool>& parts, std::vector<TextureLaying> layings)
    : mesh_(mesh), layings_(std::move(layings)), faces_(mesh.parts.size()), tangents_(2 * mesh.positions.size()) {
  const Unwrapped unwrapped(mesh);
  layings_.resize(mesh.parts.size());
  for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
    if (part >= parts.size() || !parts[part]) continue;
    for (std::size_t i = mesh.parts[part].first; i < mesh.parts[part].first + mesh.parts[part].count; ++i) {
      const auto& triangle = mesh.triangles[i];
      const auto uv = unwrapped.of(triangle);
      const Vec3 tangent =
          along_u({mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]}, uv);
      Corners corners{};
      for (std::size_t k = 0; k < 3; ++k) corners[k] = {static_cast<float>(uv[k][0]), static_cast<float>(uv[k][1])};
      for (const std::uint32_t vertex : triangle) tangents_[2 * vertex + is_mirrored(corners)] += tangent;
      faces_[part].push_back(corners);
    }
  }
  for (Vec3& tangent : tangents_) {
    const double size = length(tangent);
    tangent = size > 0 ? (1 / size) * tangent : Vec3{1, 0, 0};
  }
}

TexturePlace TextureLayout::place(const MeshPoint& point, const Corners& corners) const {
  double u = 0, v = 0;
  Vec3 t;
  const bool mirrored = is_mirrored(corners);
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = point.shares[k];
    u += share * corners[k][0], v += share * corners[k][1];
    t += share * tangents_[2 * mesh_.triangles[point.triangle][k] + mirrored];
  }
  TexturePlace place;
  place.u = static_cast<float>(u), place.v = static_cast<float>(v), place.mirrored = mirrored;
  place.tangent = floats(t);
  return place;
}

TexturePlace TextureLayout::place(int part, const MeshPoint& point, bool inside) const {
  TexturePlace result = place(part, point);
  result.mirrored = result.mirrored != inside;
  return result;
}

TexturePlace TextureLayout::place(int part, const MeshPoint& point) const {
  const auto at = static_cast<std::size_t>(part);
  if (layings_[at].projection != Projection::kOwn) {
    Vec3 position, normal;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh_.triangles[point.triangle][k];
      position += point.shares[k] * mesh_.positions[vertex], normal += point.shares[k] * mesh_.normals[vertex];
    }
    return projected(layings_[at], position, normal);
  }
  return place(point, faces_[at][point.triangle - mesh_.parts[at].first]);
}

// The differences of u and v across a pixel, from the rays through the middles of its sides, which meet the plane of
// the triangle. Beyond the horizon of that plane the footprint has no end.
void TextureLayout::add_footprint(const Gbuffer& gbuffer, int x, int y, const MeshPoint& point,
                                  TexturePlace& place) const {
  constexpr float kEndless = 1e3F;
  const auto part = static_cast<std::size_t>(gbuffer.part(x, y));
  const auto& corners = mesh_.triangles[point.triangle];
  const bool own = layings_[part].projection == Projection::kOwn;
  Vec3 normal;
  for (std::size_t k = 0; k < 3; ++k) normal += point.shares[k] * mesh_.normals[corners[k]];
  const std::array<Vec3, 3> plane{mesh_.positions[corners[0]], mesh_.positions[corners[1]],
                                  mesh_.positions[corners[2]]};
  // The place toward (x, y), or nothing.
  const auto met = [&](double at_x, double at_y, Uv& uv) {
    const PlaneHit hit = plane_hit(plane, gbuffer.rays.eye, gbuffer.rays.direction(at_x, at_y));
    if (!hit.ahead) return false;
    if (own) {
      const Corners& corner = faces_[part][point.triangle - mesh_.parts[part].first];
      for (std::size_t c = 0; c < 2; ++c)
        uv[c] = hit.shares[0] * corner[0][c] + hit.shares[1] * corner[1][c] + hit.shares[2] * corner[2][c];
      return true;
    }
    Vec3 position;
    for (std::size_t k = 0; k < 3; ++k) position += hit.shares[k] * mesh_.positions[corners[k]];
    const TexturePlace there = projected(layings_[part], position, normal);
    uv = {there.u, there.v};
    return true;
  };
  const auto step = [&](double dx, double dy, float* to) {
    Uv low{}, high{};
    const bool whole = met(x + 0.5 - dx, y + 0.5 - dy, low) && met(x + 0.5 + dx, y + 0.5 + dy, high);
    for (std::size_t c = 0; c < 2; ++c) {
      const auto wide = whole ? static_cast<float>(high[c] - low[c]) : kEndless;
      to[c] = std::isfinite(wide) ? std::clamp(wide, -kEndless, kEndless) : kEndless;
    }
    // Around an axis, u may go on at the other edge.
    const Projection by = layings_[part].projection;
    if (whole && (by == Projection::kCylinder || by == Projection::kSphere))
      to[0] -= static_cast<float>(layings_[part].around * std::round(to[0] / layings_[part].around));
  };
  step(0.5, 0, place.across), step(0, 0.5, place.down);
}

TexturePlace TextureLayout::place(const Gbuffer& gbuffer, int x, int y, bool footprint) const {
  const MeshPoint point = mesh_point(mesh_, gbuffer, x, y);
  TexturePlace result = place(gbuffer.part(x, y), point, gbuffer.at(x, y)[3] < 0);
  if (footprint) add_footprint(gbuffer, x, y, point, result);
  return result;
}

template <class PlaceAt>
std::vector<TexturePlace> TextureLayout::each_pixel(const Gbuffer& gbuffer, const PlaceAt& place_at) const {
  std::vector<TexturePlace> places(gbuffer.triangles.size());
  for_pixels(gbuffer.width, gbuffer.height, [&](int x, int y) {
    const int part = gbuffer.part(x, y);
    if (part < 0 || faces_[static_cast<std::size_t>(part)].empty()) return;
    places[gbuffer.index(x, y)] = place_at(x, y);
  });
  return places;
}

std::vector<TexturePlace> TextureLayout::places(const Gbuffer& gbuffer) const {
  return each_pixel(gbuffer, [&](int x, int y) { return place(gbuffer, x, y, false); });
}

std::vector<TexturePlace> TextureLayout::filtered_places(const Gbuffer& gbuffer,
                                                         const std::array<double, 2>& middle) const {
  return each_pixel(gbuffer, [&](int x, int y) {
    TexturePlace result = place(gbuffer, x, y);
    result.u += static_cast<float>(middle[0] * result.across[0] + middle[1] * result.down[0]);
    result.v += static_cast<float>(middle[0] * result.across[1] + middle[1] * result.down[1]);
    return result;
  });
}

}  // namespace goniochrome::render
