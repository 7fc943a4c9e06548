// The light of a floor that shows the environment where nothing is in the way of it, less that of the environment below
// the horizon, in the place of which it stands. goniochrome-paths(7), "Open floor".
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "color/color.h"
#include "rays/ray_scene.h"
#include "render/path/ground_kernel.h"
#include "render/path/hemisphere_map.h"

namespace goniochrome::render {

// Immutable: for any number of threads at once.
class OpenFloor {
 public:
  // Radiance along directions below the horizon: `hidden` from the environment, and `shown` by the open floor where the
  // environment's eye sees it, of which `left` is there at a place. The scene must outlive it. Places are local.
  using AlongDirection = std::function<color::Rgb(const rays::Float3& direction)>;
  OpenFloor(const rays::RayScene& scene, const rays::Float3& eye, const AlongDirection& hidden,
            const AlongDirection& shown, const std::function<color::Rgb(const rays::Float3& place)>& left);

  // True if the point is high above the floor beside the blocks below it. Nearer ones are no single lights to it: on
  // the underside of a teapot the diffuse part missed 6 % of its light.
  bool tells(const rays::Float3& position) const;

  // The light that the diffuse part and wide lobes gather, of weight 1.
  GroundColumns columns(const GroundReceiver& point) const { return sum_ground(blocks_, point); }
  // The means about a direction below the horizon, over about so much of the hemisphere; `number` in [0,1).
  rays::Float3 lit(const rays::Float3& from, const rays::Float3& direction, float extent_sr, float number) const;
  rays::Float3 hidden(const rays::Float3& direction, float extent_sr, float number) const {
    return hidden_->at(direction, extent_sr, number);
  }

 private:
  rays::Float3 place(const rays::Float3& from_eye) const {
    return eye_ + scene_->floor_distance(eye_, from_eye) * from_eye;
  }
  struct Texels {
    std::vector<rays::Float3> hidden, lit;
  };
  void add_blocks(const Texels& texels);
  float add_block(const Texels& texels, int left, int top, int across, FloorBlocks& to) const;

  const rays::RayScene* scene_;
  rays::Float3 eye_;
  float height_ = 0;  // of the eye above the floor
  std::unique_ptr<const HemisphereMap> hidden_, lit_;
  GroundBlocks blocks_;
};

}  // namespace goniochrome::render
