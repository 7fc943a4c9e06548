#include "ground.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "color/color.h"

namespace goniochrome::tool {

namespace {

constexpr int kSize = 192;
constexpr int kTurns = 8;
constexpr std::size_t kRays = 320;  // from each point; each takes less than a step of a byte
constexpr std::size_t kFan = 8;

// A direction from which the ground is lit, and the share of each channel's irradiance that it stands for.
struct Beam {
  Vec3 toward;
  color::Rgb share;
};

// Directions that lie evenly in the irradiance of a level surface (inversion of its distribution function).
std::vector<Beam> beams(const envmap::PrefilteredLobe& mirror) {
  const envmap::SphereGrid grid = envmap::map_grid(mirror.layout, mirror.map.size);
  const auto texels = static_cast<std::size_t>(grid.width()) * grid.height();
  std::vector<double> sums(texels);
  double sum = 0;
  const auto light = [&](std::size_t i) {
    const float* rgb = &mirror.map.texels[3 * i];
    return color::Rgb{rgb[0], rgb[1], rgb[2]};
  };
  for (std::size_t i = 0; i < texels; ++i) {
    const int column = static_cast<int>(i) % grid.width(), row = static_cast<int>(i) / grid.width();
    const double cosine = std::max(0.0, grid.direction(column, row).y);
    sums[i] = sum += cosine * grid.solid_angle(column, row) * std::max(0.0, color::xyz_d65_from_rgb(light(i)).Y);
  }
  std::vector<Beam> list;
  color::Rgb whole;
  for (std::size_t k = 0; k < kRays && sum > 0; ++k) {
    const double wanted = sum * (static_cast<double>(k) + 0.5) / kRays;
    const auto i = static_cast<std::size_t>(std::ranges::upper_bound(sums, wanted) - sums.begin());
    const color::Rgb rgb = light(i);
    const color::Rgb share = (1 / color::xyz_d65_from_rgb(rgb).Y) * rgb;
    list.push_back({grid.direction(static_cast<int>(i) % grid.width(), static_cast<int>(i) / grid.width()), share});
    whole += share;
  }
  for (Beam& beam : list)
    for (int c = 0; c < 3; ++c) beam.share[c] = whole[c] > 0 ? beam.share[c] / whole[c] : 0;
  return list;
}

}  // namespace

Json packed_ground(const rays::RayScene& scene, const mesh::Mesh& mesh, const envmap::PrefilteredEnvironment& env,
                   studio::PackedNumbers& numbers) {
  if (env.mirror.map.size == 0) return {};
  const std::vector<Beam> list = beams(env.mirror);
  if (list.empty()) return {};
  const mesh::Box box = mesh::bounding_box(mesh);
  const Vec3 size = box.high - box.low, middle = 0.5 * (box.low + box.high);
  const double side = std::max(size.x, size.z) + 3 * size.y;
  const Vec3 low = {middle.x - side / 2, box.low.y, middle.z - side / 2};
  std::vector<std::uint8_t> texels(static_cast<std::size_t>(kTurns) * kSize * kSize * 4, 255);
  parallel_for(static_cast<std::size_t>(kTurns) * kSize, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t line = begin; line < end; ++line) {
      const double turn = 2 * kPi * static_cast<double>(line / kSize) / kTurns, c = std::cos(turn), s = std::sin(turn);
      for (int column = 0; column < kSize; ++column) {
        const auto row = static_cast<double>(line % kSize);
        color::Rgb kept;
        for (std::size_t first = 0; first < list.size(); first += kFan) {
          rays::Fan fan;
          // Places in the texel, so that its value is a mean: the additive recurrence of the plastic number (Roberts
          // 2018).
          const double fans = static_cast<double>(first / kFan) + 0.5;
          const double x = column + std::fmod(0.7548776662466927 * fans, 1),
                       z = row + std::fmod(0.5698402909980532 * fans, 1);
          fan.origin = scene.local(low + side * Vec3{x / kSize, 1e-4, z / kSize});
          const std::size_t count = std::min(kFan, list.size() - first);
          for (std::size_t k = 0; k < count; ++k) {
            const Vec3& d = list[first + k].toward;  // turned with the environment, as the page turns it
            fan.x[k] = static_cast<float>(c * d.x + s * d.z);
            fan.y[k] = static_cast<float>(d.y);
            fan.z[k] = static_cast<float>(c * d.z - s * d.x);
            fan.wanted |= 1U << k;
          }
          const unsigned met = scene.occluded(fan);
          for (std::size_t k = 0; k < count; ++k)
            if (!(met & (1U << k))) kept += list[first + k].share;
        }
        for (int channel = 0; channel < 3; ++channel)
          texels[4 * (line * kSize + static_cast<std::size_t>(column)) + static_cast<std::size_t>(channel)] =
              static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, static_cast<double>(kept[channel]))));
      }
    }
  });
  const Vec3 origin = mesh::float_origin(box);
  return {{"size", kSize},
          {"turns", kTurns},
          {"low", {low.x - origin.x, low.z - origin.z}},
          {"side", side},
          {"texels", numbers.add(texels)}};
}

}  // namespace goniochrome::tool
