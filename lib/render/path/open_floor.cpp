#include "render/path/open_floor.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

using rays::Float3;

constexpr int kSize = 256;
// Sums take so many blocks across the hemisphere, in tiles of so many. Parts of blocks have half of their size.
constexpr int kBlocks = 32, kOfTile = 4;
static_assert(kOfTile * kOfTile == GroundBlocks::kTile);

float size_of(const Float3& light) {
  return std::abs(light.x) + std::abs(light.y) + std::abs(light.z);
}

}  // namespace

OpenFloor::OpenFloor(const rays::RayScene& scene, const Float3& eye, const AlongDirection& hidden,
                     const AlongDirection& shown, const std::function<color::Rgb(const Float3& place)>& left)
    : scene_(&scene), eye_(eye), height_(scene.floor_distance(eye, {0, -1, 0})) {
  Texels texels;
  for (std::vector<Float3>* light : {&texels.hidden, &texels.lit})
    light->resize(static_cast<std::size_t>(kSize) * kSize);
  parallel_each(texels.lit.size(), 4 * kSize, [&](std::size_t i) {
    const auto direction = [&](float right, float down) {
      return HemisphereMap::place(static_cast<float>(i % kSize) + right, static_cast<float>(i / kSize) + down, kSize)
          .direction;
    };
    color::Rgb behind, light;
    for (const float right : {0.25F, 0.75F})
      for (const float down : {0.25F, 0.75F})
        behind += 0.25 * hidden(direction(right, down)), light += 0.25 * shown(direction(right, down));
    texels.hidden[i] = rays::float3(behind);
    texels.lit[i] = rays::float3(light * left(place(direction(0.5F, 0.5F))));
  });
  add_blocks(texels);
  hidden_ = std::make_unique<const HemisphereMap>(kSize, texels.hidden);
  lit_ = std::make_unique<const HemisphereMap>(kSize, texels.lit);
}

namespace {

void push(const Float3& a, Places& to) {
  to[0].push_back(a.x), to[1].push_back(a.y), to[2].push_back(a.z);
}

// The light of some texels of the hemisphere comes from its middle; dark texels have a middle too.
struct Middle {
  Float3 light, way;
  void add(const Float3& of, const Float3& direction) {
    constexpr float kDark = 1e-12F;  // whose square is no 0
    light = light + of, way = way + (size_of(of) + kDark) * direction;
  }
};
// A square of texels whose upper left corner is there.
Middle middle_of(const std::vector<Float3>& texels, int left, int top, int across) {
  Middle middle;
  for (int y = top; y < top + across; ++y) {
    for (int x = left; x < left + across; ++x) {
      const auto [direction, below] =
          HemisphereMap::place(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, kSize);
      if (below)
        middle.add(HemisphereMap::texel_sr(kSize) * texels[static_cast<std::size_t>(y * kSize + x)], direction);
    }
  }
  return middle;
}

}  // namespace

// Adds a square of texels to blocks, and returns its area on the floor; dark beyond the horizon.
float OpenFloor::add_block(const Texels& texels, int left, int top, int across, FloorBlocks& to) const {
  const Middle behind = middle_of(texels.hidden, left, top, across), sent = middle_of(texels.lit, left, top, across);
  const bool below = rays::length(sent.way) > 0;
  const Float3 from_eye = below ? rays::normalized(sent.way) : Float3{0, -1, 0}, at = place(from_eye), way = at - eye_;
  const float of_sr = rays::dot(way, way) / -from_eye.y;
  push(at, to.place), push(of_sr * sent.light, to.sent);
  push(below ? rays::normalized(behind.way) : from_eye, to.toward), push(behind.light, to.hidden);
  return below ? of_sr * HemisphereMap::texel_sr(kSize) * static_cast<float>(across * across) : 0;
}

void OpenFloor::add_blocks(const Texels& texels) {
  constexpr int kAcross = kSize / kBlocks, kTiles = kBlocks / kOfTile;  // texels of a block; tiles
  for (int tile = 0; tile < kTiles * kTiles; ++tile) {
    for (int i = 0; i < kOfTile * kOfTile; ++i) {
      const int left = kAcross * (tile % kTiles * kOfTile + i % kOfTile),
                top = kAcross * (tile / kTiles * kOfTile + i / kOfTile);
      blocks_.area.push_back(add_block(texels, left, top, kAcross, blocks_.whole));
      for (int part = 0; part < 4; ++part)
        add_block(texels, left + part % 2 * kAcross / 2, top + part / 2 * kAcross / 2, kAcross / 2, blocks_.parts);
    }
  }
}

bool OpenFloor::tells(const Float3& position) const {
  constexpr float kAway = 6, kAcross = 3.14159265F / (2 * kBlocks);  // rad, of a part of a block from the eye
  const float height = scene_->floor_distance(position, {0, -1, 0});
  const Float3 way = position + height * Float3{0, -1, 0} - eye_;
  return height > kAway * kAcross * rays::dot(way, way) / height_;
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
