#include "ground.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "color/color.h"
#include "envmap/open_maps.h"
#include "render/trim.h"

namespace goniochrome::tool {

namespace {

constexpr int kSize = 320;
constexpr int kTurns = 8;
constexpr std::size_t kRays = 320;  // from each point; each takes less than a step of a byte
constexpr std::size_t kFan = 8;
constexpr int kCell = 4;         // texels along a cell, within which light that changes evenly is interpolated
constexpr double kBent = 0.004;  // the most that such light departs from a line
constexpr int kStep = 8;         // texels between places for which the light that the mesh sends is known
constexpr std::size_t kSent = 128, kGathered = 32;  // rays from such a place, and from each point that they meet
constexpr double kExponent = 60;                    // of the lobe by which points of the mesh see the environment

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

// Directions even by the cosine about a normal, in a spiral (Vogel 1979).
std::vector<Vec3> cosine_directions(std::size_t count, const Vec3& n) {
  const Vec3 x = normalized(cross(std::abs(n.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, n)), y = cross(n, x);
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double across = std::sqrt(part), angle = kPi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
    all.push_back(across * std::cos(angle) * x + across * std::sin(angle) * y + std::sqrt(1 - part) * n);
  }
  return all;
}

// A direction turned with the environment, as the page turns it.
Vec3 turned(const Vec3& d, int turn) {
  const double angle = 2 * kPi * turn / kTurns, c = std::cos(angle), s = std::sin(angle);
  return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

rays::Fan fan_from(const rays::Float3& origin, const std::vector<Vec3>& directions, std::size_t first) {
  rays::Fan fan;
  fan.origin = origin;
  for (std::size_t k = 0; k < std::min(kFan, directions.size() - first); ++k) {
    const rays::Float3 d = rays::float3(directions[first + k]);
    fan.x[k] = d.x, fan.y[k] = d.y, fan.z[k] = d.z;
    fan.wanted |= 1U << k;
  }
  return fan;
}

// The square around the mesh, and the texels of its light.
struct Square {
  Vec3 low;
  double side;
  std::vector<std::uint8_t> texels;

  static std::size_t index(int turn, int row, int column, int channel) {
    return 4 * ((static_cast<std::size_t>(turn) * kSize + static_cast<std::size_t>(row)) * kSize +
                static_cast<std::size_t>(column)) +
           static_cast<std::size_t>(channel);
  }
  std::uint8_t& at(int turn, int row, int column, int channel) { return texels[index(turn, row, column, channel)]; }
  // The part of its light that the ground keeps there.
  double kept(int turn, const Vec3& place) const {
    const double column = kSize * (place.x - low.x) / side, row = kSize * (place.z - low.z) / side;
    if (!(column >= 0 && column < kSize && row >= 0 && row < kSize)) return 1;
    return texels[index(turn, static_cast<int>(row), static_cast<int>(column), 1)] / 255.0;
  }
};

double luminance(const Vec3& rgb) {
  return color::xyz_d65_from_rgb({rgb.x, rgb.y, rgb.z}).Y;
}

// The luminance of white matt points of the mesh, relative to that of the open ground, in each turn of an environment.
class WhiteMesh {
 public:
  WhiteMesh(const rays::RayScene& scene, const Square& square, const Vec3& eye,
            const envmap::PrefilteredEnvironment& env, const envmap::PrefilteredLobe& lobe)
      : scene_(scene), square_(square), eye_(eye), env_(env), map_(envmap::open_map(env, lobe, env.spots.size())) {
    open_ = luminance(envmap::bilinear(env.diffuse.map, {0, 1, 0}));
  }

  std::array<double, kTurns> at(const rays::Spot& spot) const {
    const Vec3 n = rays::vec3(spot.shading), start = scene_.world(spot.start);
    std::array<double, kTurns> all{};
    if (!(open_ > 0)) return all;
    const std::vector<Vec3> list = cosine_directions(kGathered, n);
    for (std::size_t first = 0; first < list.size(); first += kFan) {
      const unsigned met = scene_.occluded(fan_from(spot.start, list, first));
      for (std::size_t k = first; k < std::min(list.size(), first + kFan); ++k) {
        if (met & (1U << (k - first))) continue;
        const Vec3& d = list[k];
        const bool down = d.y < 0;
        const Vec3 floor = down ? start + std::max(0.0, start.y - square_.low.y) / -d.y * d : Vec3{};
        for (int turn = 0; turn < kTurns; ++turn) {
          const Vec3 toward = turned(down ? normalized(floor - eye_) : d, -turn);
          all[turn] += (down ? square_.kept(turn, floor) : 1) * luminance(envmap::bilinear(*map_, toward)) / kGathered;
        }
      }
    }
    for (int turn = 0; turn < kTurns; ++turn) {
      for (const envmap::Spot& light : env_.spots) {
        const Vec3 toward = turned(light.direction, turn);
        if (dot(n, toward) > 0 && toward.y > 0 && !scene_.occluded(spot.start, rays::float3(toward)))
          all[turn] += dot(n, toward) * color::xyz_d65_from_rgb(light.white).Y;
      }
      all[turn] /= open_;
    }
    return all;
  }

 private:
  const rays::RayScene& scene_;
  const Square& square_;
  Vec3 eye_;
  const envmap::PrefilteredEnvironment& env_;
  std::shared_ptr<const envmap::CubeMap> map_;
  double open_ = 0;
};

// Fills the fourth channel: the light that painted parts send to the ground where they are matt and white.
void add_sent(const rays::RayScene& scene, const mesh::Mesh& mesh, const WhiteMesh& white, Square& square) {
  constexpr int kNodes = kSize / kStep;
  std::vector<bool> painted;
  for (const mesh::MeshPart& part : mesh.parts) painted.push_back(!render::trim_kind(part));
  std::vector<std::array<double, kTurns>> nodes(static_cast<std::size_t>(kNodes) * kNodes);
  const std::vector<Vec3> list = cosine_directions(kSent, {0, 1, 0});
  parallel_for(nodes.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      const double column = static_cast<double>(node % kNodes) + 0.5, row = static_cast<double>(node / kNodes) + 0.5;
      const rays::Float3 origin = scene.local(square.low + square.side * Vec3{column / kNodes, 1e-4, row / kNodes});
      nodes[node] = {};
      for (std::size_t first = 0; first < list.size(); first += kFan) {
        const rays::Fan fan = fan_from(origin, list, first);
        std::array<rays::Hit, kFan> hits;
        scene.closest(fan, hits.data());
        for (std::size_t k = 0; k < kFan; ++k) {
          if (!hits[k].any()) continue;
          const rays::Spot spot = scene.spot(hits[k], origin, {fan.x[k], fan.y[k], fan.z[k]});
          if (!painted[static_cast<std::size_t>(spot.part)]) continue;
          const auto sent = white.at(spot);
          for (int turn = 0; turn < kTurns; ++turn) nodes[node][turn] += sent[turn] / kSent;
        }
      }
    }
  });
  const auto node = [&](int row, int column) -> const std::array<double, kTurns>& {
    return nodes[static_cast<std::size_t>(std::clamp(row, 0, kNodes - 1)) * kNodes +
                 static_cast<std::size_t>(std::clamp(column, 0, kNodes - 1))];
  };
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = (column + 0.5) / kStep - 0.5, z = (row + 0.5) / kStep - 0.5;
      const int left = static_cast<int>(std::floor(x)), up = static_cast<int>(std::floor(z));
      for (int turn = 0; turn < kTurns; ++turn) {
        const double above = std::lerp(node(up, left)[turn], node(up, left + 1)[turn], x - left);
        const double below = std::lerp(node(up + 1, left)[turn], node(up + 1, left + 1)[turn], x - left);
        square.at(turn, row, column, 3) =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(std::lerp(above, below, z - up), 0.0, 1.0)));
      }
    }
  }
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
  Square square{low, side, std::vector<std::uint8_t>(static_cast<std::size_t>(kTurns) * kSize * kSize * 4, 0)};
  std::array<std::vector<rays::Fan>, kTurns> fans;
  for (int turn = 0; turn < kTurns; ++turn) {
    std::vector<Vec3> toward;
    for (const Beam& beam : list) toward.push_back(turned(beam.toward, turn));
    for (std::size_t first = 0; first < list.size(); first += kFan) fans[turn].push_back(fan_from({}, toward, first));
  }
  const auto kept = [&](int turn, double column, double row, double spread) {
    color::Rgb sum;
    for (std::size_t f = 0; f < fans[turn].size(); ++f) {
      // Places around this one, so that the value is a mean: the additive recurrence of the plastic number (Roberts
      // 2018).
      const double part = static_cast<double>(f) + 0.5;
      const double x = column + spread * (std::fmod(0.7548776662466927 * part, 1) - 0.5),
                   z = row + spread * (std::fmod(0.5698402909980532 * part, 1) - 0.5);
      rays::Fan fan = fans[turn][f];
      fan.origin = scene.local(low + side * Vec3{x / kSize, 1e-4, z / kSize});
      for (unsigned left = fan.wanted & ~scene.occluded(fan); left != 0; left &= left - 1)
        sum += list[kFan * f + static_cast<std::size_t>(std::countr_zero(left))].share;
    }
    return sum;
  };
  constexpr int kCells = kSize / kCell, kNodes = kCells + 1;
  std::vector<color::Rgb> nodes(static_cast<std::size_t>(kTurns) * kNodes * kNodes);
  parallel_for(nodes.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int node = static_cast<int>(i), row = node / kNodes % kNodes;
      nodes[i] = kept(node / (kNodes * kNodes), kCell * (node % kNodes), kCell * row, 0);
    }
  });
  const auto node = [&](int turn, int row, int column) -> const color::Rgb& {
    row = std::clamp(row, 0, kCells), column = std::clamp(column, 0, kCells);
    return nodes[static_cast<std::size_t>((turn * kNodes + row) * kNodes + column)];
  };
  // An eighth of the second difference is how far a parabola through three nodes departs from the line between two.
  const auto is_even = [&](int turn, int row, int column) {
    double most = 0;
    for (const auto& [r, c] : {std::pair(0, 0), {0, 1}, {1, 0}, {1, 1}}) {
      const color::Rgb twice = 2.0 * node(turn, row + r, column + c);
      const color::Rgb across = node(turn, row + r, column + c - 1) + node(turn, row + r, column + c + 1) - twice;
      const color::Rgb along = node(turn, row + r - 1, column + c) + node(turn, row + r + 1, column + c) - twice;
      most = std::max({most, std::abs(luminance(across)) / 8, std::abs(luminance(along)) / 8});
    }
    return most < kBent;
  };
  parallel_for(static_cast<std::size_t>(kTurns) * kCells, 1, [&](std::size_t begin, std::size_t end) {
    for (int line = static_cast<int>(begin); line < static_cast<int>(end); ++line) {
      const int turn = line / kCells, row = line % kCells;
      for (int column = 0; column < kCells; ++column) {
        const bool even = is_even(turn, row, column);
        for (int z = 0; z < kCell; ++z) {
          for (int x = 0; x < kCell; ++x) {
            const double right = (x + 0.5) / kCell, down = (z + 0.5) / kCell;
            const color::Rgb above = (1 - right) * node(turn, row, column) + right * node(turn, row, column + 1),
                             below =
                                 (1 - right) * node(turn, row + 1, column) + right * node(turn, row + 1, column + 1);
            const color::Rgb light = even ? (1 - down) * above + down * below
                                          : kept(turn, kCell * (column + right), kCell * (row + down), 1);
            for (int channel = 0; channel < 3; ++channel)
              square.at(turn, kCell * row + z, kCell * column + x, channel) =
                  static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, static_cast<double>(light[channel]))));
          }
        }
      }
    }
  });
  const auto off = [](const envmap::PrefilteredLobe& lobe) { return std::abs(std::log(lobe.exponent / kExponent)); };
  const auto lobe = std::ranges::min_element(env.lobes, {}, off);
  if (lobe != env.lobes.end() && env.diffuse.map.size > 0) {
    const Vec3 eye = {middle.x, box.low.y + std::max({size.x, size.y, size.z}) / 3, middle.z};
    add_sent(scene, mesh, WhiteMesh(scene, square, eye, env, *lobe), square);
  }
  const Vec3 origin = mesh::float_origin(box);
  return {{"size", kSize},
          {"turns", kTurns},
          {"low", {low.x - origin.x, low.z - origin.z}},
          {"side", side},
          {"texels", numbers.add(square.texels)}};
}

}  // namespace goniochrome::tool
