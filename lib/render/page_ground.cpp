#include "render/page_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/parallel.h"
#include "render/path/transport.h"
#include "render/trim.h"

namespace goniochrome::render {

namespace {

constexpr int kSize = 512, kTurns = 8;
constexpr int kBouncedDirections = 64;
// Below this deviation of all texels from the mean of their four, of 1023 steps, the means stand for them: .001 to .003
// dE00 of a page's picture in three lights. A sunny place has more, and would lose .05.
constexpr double kEvenSteps = 8;

// In even light a lobe a cos^E reflects about a 2 pi/(E + 1) c to a view of cosine c, and 2/3 of that on average.
paint::LobeFit white_metallic() {
  constexpr double kDiffuse = 0.3;
  const auto gray = [](double value) { return color::Rgb{value, value, value}; };
  paint::LobeFit paint;
  paint.diffuse = gray(kDiffuse / kPi);
  for (const double exponent : {12.0, 60.0})
    paint.lobes.push_back({exponent, gray(0.5 * (1 - kDiffuse) * 1.5 * (exponent + 1) / (2 * kPi)), {}});
  return paint;
}

// The mesh as the environment sees it when it is turned about the vertical axis through the middle.
mesh::Mesh turned(mesh::Mesh mesh, const Vec3& middle, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](const Vec3& d) { return Vec3{c * d.x - s * d.z, d.y, s * d.x + c * d.z}; };
  for (Vec3& p : mesh.positions) p = middle + turn(p - middle);
  for (Vec3& n : mesh.normals) n = turn(n);
  return mesh;
}

// Texels of half as many a side, unless edges of shadows are too sharp for them.
void halve_if_even(PageGroundLight& light) {
  PageGroundLight half{light.size / 2, light.turns, light.reach, {}};
  const std::size_t width = 4UL * light.size;
  double squares = 0;
  for (std::size_t row = 0; row < light.texels.size(); row += 2 * width) {
    for (std::size_t i = row; i < row + width; i += 8) {
      for (std::size_t c = i; c < i + 4; ++c) {
        const std::array<int, 4> four{light.texels[c], light.texels[c + 4], light.texels[c + width],
                                      light.texels[c + width + 4]};
        const int mean = (four[0] + four[1] + four[2] + four[3] + 2) / 4;
        for (const int one : four) squares += (one - mean) * (one - mean);
        half.texels.push_back(static_cast<std::uint16_t>(mean));
      }
    }
  }
  if (squares < kEvenSteps * kEvenSteps * static_cast<double>(light.texels.size())) light = std::move(half);
}

}  // namespace

Result<PageGroundLight> page_ground_light(const mesh::Mesh& mesh, const envmap::Environment& environment) {
  const mesh::Box box = mesh::bounding_box(mesh);
  const Vec3 size = box.high - box.low;
  PageGroundLight light{kSize, kTurns, 0.6 * std::max(size.x, size.z) + 2 * size.y, {}};
  Scene scene;
  for (const mesh::MeshPart& part : mesh.parts) {
    paint::LobeFit& paint = scene.paints.emplace_back();
    if (!trim_kind(part)) paint = white_metallic();
  }
  PathScene paths{.scene = &scene, .environment = &environment, .ground = ground_below(mesh)};
  paths.table = std::make_shared<const EnvironmentTable>(environment);
  const Vec3 eye = paths.ground->probe_eye;
  std::vector<double> lines;  // two in each texel
  for (int i = 0; i < 2 * kSize; ++i) {
    const double u = (i + 0.5) / kSize - 1;
    lines.push_back(light.reach * u / std::sqrt(1 - u * u));
  }
  for (int turn = 0; turn < kTurns; ++turn) {
    const double angle = 2 * kPi * turn / kTurns, c = std::cos(angle), s = std::sin(angle);
    const mesh::Mesh seen = turned(mesh, eye, angle);
    scene.mesh = &seen;
    GONIO_ASSIGN(Transport transport, Transport::create(paths));
    transport.shade_ground({.directions = kFewestGroundDirections, .bounced_directions = kBouncedDirections}, 1);
    const std::size_t first = light.texels.size();
    light.texels.resize(first + 4UL * kSize * kSize);
    parallel_for(kSize, 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        for (std::size_t column = 0; column < kSize; ++column) {
          GroundLight at{{}, {}};  // the mean of two places
          for (const std::size_t i : {0, 1}) {
            const double x = lines[2 * column + i], z = lines[2 * row + 1 - i];
            const Vec3 place{eye.x + c * x - s * z, box.low.y, eye.z + s * x + c * z};
            const GroundLight one = transport.shaded()->seen(transport.rays().local(place));
            at.left += 0.5 * one.left, at.bounced += 0.5 * one.bounced;
          }
          std::uint16_t* texel = &light.texels[first + 4 * (row * kSize + column)];
          for (const double share : {at.left.x, at.left.y, at.left.z, color::xyz_d65_from_rgb(at.bounced).Y})
            *texel++ = static_cast<std::uint16_t>(std::lround(kGroundSteps * std::clamp(share, 0.0, 1.0)));
        }
      }
    });
  }
  halve_if_even(light);
  return Result(std::move(light));
}

}  // namespace goniochrome::render
