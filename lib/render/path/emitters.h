// Parts of a mesh that shine by themselves. goniochrome-paths(7), "Emitters".
#pragma once

#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "rays/ray_scene.h"

namespace goniochrome::render {

// A point on an emitter as another point sees it.
struct EmitterSample {
  rays::Float3 direction;  // to it, unit
  float distance = 0;      // local
  float pdf = 0;           // 1/sr; 0: nothing was drawn
  color::Rgb radiance;
  int part = 0;  // that it is on
};

// Where light is looked for: a point, local, and the unit normal of its surface. Nothing that lies below it is drawn.
struct LitPoint {
  rays::Float3 position, normal;
};
inline LitPoint lit_point(const rays::Spot& spot) {
  return {spot.start, spot.shading};
}

// The shining triangles. One is drawn by about what it sends to a point: its area times the mean of the channels of its
// radiance, by the square of the distance where it is near; then a direction to it. Both sides shine.
class Emitters {
 public:
  Emitters() = default;
  // `radiance` for each part of the scene; none where there are fewer. The scene must outlive the emitters. Error: a
  // radiance that is negative or not finite, or a part that shines and has no area.
  static Result<Emitters> create(const rays::RayScene& scene, std::vector<color::Rgb> radiance);

  bool empty() const { return nodes_.empty(); }
  const color::Rgb& radiance(int part) const {
    static constexpr color::Rgb kDark;
    return static_cast<std::size_t>(part) < radiance_.size() ? radiance_[static_cast<std::size_t>(part)] : kDark;
  }

  // By numbers in [0,1).
  EmitterSample drawn(const LitPoint& at, double choice, double u, double v) const;
  // The density by which drawn() gives the direction of a ray that meets this triangle first, at that distance.
  float pdf(const LitPoint& at, std::uint32_t triangle, const rays::Float3& direction, float distance) const;

 private:
  static constexpr std::uint32_t kNone = ~0U;
  // Triangles in a ball; those of an inner node are the ones of two others, which follow each other.
  struct Node {
    rays::Float3 middle;
    float radius = 0;
    float power = 0;                 // area times radiance, relative to all
    std::uint32_t triangle = kNone;  // of a leaf
    std::uint32_t first = 0;         // of an inner node's two
    std::uint32_t parent = kNone;
  };
  struct Bunch;
  void split(std::uint32_t node, std::vector<Node>& leaves, std::size_t begin, std::size_t end);
  static float importance(const Node& node, const LitPoint& at);
  // The part of what is drawn from an inner node that its first child gets; negative where both get nothing.
  float first_share(const Node& node, const LitPoint& at) const;
  // The density by solid angle of what is even over a triangle that is met at this distance.
  double even_by_area(std::uint32_t triangle, const rays::Float3& direction, float distance) const;
  static bool is_far(const Node& node, const rays::Float3& from);

  const rays::RayScene* scene_ = nullptr;
  std::vector<color::Rgb> radiance_;
  std::vector<Node> nodes_;             // the root first
  std::vector<std::uint32_t> leaf_of_;  // the node of each triangle
};

}  // namespace goniochrome::render
