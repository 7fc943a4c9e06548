// Parts of a mesh that shine by themselves. goniochrome-theory(7), PATHS.
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

// The shining triangles, drawn by their area times the mean of the channels of their radiance. Both sides shine.
class Emitters {
 public:
  Emitters() = default;
  // `radiance` for each part of the scene; none where there are fewer. The scene must outlive the emitters. Error: a
  // radiance that is negative or not finite, or a part that shines and has no area.
  static Result<Emitters> create(const rays::RayScene& scene, std::vector<color::Rgb> radiance);

  bool empty() const { return cumulative_.empty(); }
  const color::Rgb& radiance(int part) const {
    static constexpr color::Rgb kDark;
    return static_cast<std::size_t>(part) < radiance_.size() ? radiance_[static_cast<std::size_t>(part)] : kDark;
  }

  // By numbers in [0,1).
  EmitterSample drawn(const rays::Float3& from, double choice, double u, double v) const;
  // The density by which drawn() gives the direction of a ray that meets this triangle first, at that distance.
  float pdf(std::uint32_t triangle, const rays::Float3& direction, float distance) const;

 private:
  double part_density(int part) const;  // by area

  const rays::RayScene* scene_ = nullptr;
  std::vector<color::Rgb> radiance_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> cumulative_;  // share of the triangles up to each
  double total_ = 0;
};

}  // namespace goniochrome::render
