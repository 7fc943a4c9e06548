#include "render/path/open_floor.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

using rays::Float3;

constexpr int kSize = 256;
// Sums take so many blocks across the hemisphere; points that are lower than a part of the eye's height take the finer.
// In a test they are within 3 % of 50,000 directions at 95 of 100 points.
constexpr int kCoarse = 32, kFine = 64;
constexpr float kLow = 0.4F;

float size_of(const Float3& light) {
  return std::abs(light.x) + std::abs(light.y) + std::abs(light.z);
}

}  // namespace

OpenFloor::OpenFloor(const rays::RayScene& scene, const Float3& eye, const AlongDirection& hidden,
                     const AlongDirection& shown, const std::function<color::Rgb(const Float3& place)>& left)
    : scene_(&scene), eye_(eye), height_(scene.floor_distance(eye, {0, -1, 0})) {
  std::vector<Float3> hidden_texels(static_cast<std::size_t>(kSize) * kSize), lit_texels = hidden_texels;
  parallel_each(hidden_texels.size(), 4 * kSize, [&](std::size_t i) {
    const auto direction = [&](float right, float down) {
      return HemisphereMap::place(static_cast<float>(i % kSize) + right, static_cast<float>(i / kSize) + down, kSize)
          .direction;
    };
    color::Rgb behind, light;
    for (const float right : {0.25F, 0.75F})
      for (const float down : {0.25F, 0.75F})
        behind += 0.25 * hidden(direction(right, down)), light += 0.25 * shown(direction(right, down));
    hidden_texels[i] = rays::float3(behind);
    lit_texels[i] = rays::float3(light * left(place(direction(0.5F, 0.5F))));
  });
  coarse_ = blocks(kCoarse, hidden_texels, lit_texels), fine_ = blocks(kFine, hidden_texels, lit_texels);
  hidden_ = std::make_unique<const HemisphereMap>(kSize, hidden_texels);
  lit_ = std::make_unique<const HemisphereMap>(kSize, lit_texels);
}

// A block's light comes from its middle by the light; a dark one has a middle too.
GroundBlocks OpenFloor::blocks(int across, const std::vector<Float3>& hidden, const std::vector<Float3>& lit) const {
  GroundBlocks blocks;
  const int texels = kSize / across;
  const float texel_sr = HemisphereMap::texel_sr(kSize);
  constexpr float kDark = 1e-12F;  // whose square is no 0
  struct Middle {
    Float3 light, way;
    void add(const Float3& of, const Float3& direction) {
      light = light + of, way = way + (size_of(of) + kDark) * direction;
    }
  };
  for (int row = 0; row < across; ++row) {
    for (int column = 0; column < across; ++column) {
      Middle behind, sent;
      for (int y = row * texels; y < (row + 1) * texels; ++y) {
        for (int x = column * texels; x < (column + 1) * texels; ++x) {
          const auto [direction, below] =
              HemisphereMap::place(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, kSize);
          if (!below) continue;
          const std::size_t i = static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x);
          behind.add(texel_sr * hidden[i], direction), sent.add(texel_sr * lit[i], direction);
        }
      }
      if (!(rays::length(behind.way) > 0)) continue;
      const Float3 from_eye = rays::normalized(sent.way), at = place(from_eye), way = at - eye_;
      blocks.add(at, (rays::dot(way, way) / -from_eye.y) * sent.light, rays::normalized(behind.way), behind.light);
    }
  }
  blocks.fill();
  return blocks;
}

GroundColumns OpenFloor::columns(const GroundReceiver& point) const {
  const float height = scene_->floor_distance(point.position, {0, -1, 0});
  return sum_ground(height > kLow * height_ ? coarse_ : fine_, point);
}

bool OpenFloor::tells(const Float3& position) const {
  constexpr float kBlocks = 6, kAcross = 3.14159265F / kFine;  // rad, of a block from the eye
  const float height = scene_->floor_distance(position, {0, -1, 0});
  const Float3 way = position + height * Float3{0, -1, 0} - eye_;
  return height > kBlocks * kAcross * rays::dot(way, way) / height_;
}

Float3 OpenFloor::lit(const Float3& from, const Float3& direction, float extent_sr, float number) const {
  const float distance = scene_->floor_distance(from, direction);
  const Float3 seen = from + distance * direction - eye_;
  const float eye_distance = rays::length(seen);
  constexpr float kFarthest = 1e15F;
  if (!(eye_distance > 0 && eye_distance < kFarthest)) return {};
  // The ratio of the solid angles of a piece of the floor.
  const Float3 from_eye = (1 / eye_distance) * seen;
  const float ratio = distance / eye_distance;
  return lit_->at(from_eye, extent_sr * ratio * ratio * (from_eye.y / direction.y), number);
}

}  // namespace goniochrome::render
