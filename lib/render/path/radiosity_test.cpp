// The Cornell box of testdata by paths and by radiosity: patches, their direct light by quadrature over the lamp, and
// the light between them by rays that meet patches.
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/testdata_for_test.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::radiosity_test {
namespace {

using rays::Float3;

// The value of an index in base 2 or 3 with its digits mirrored about the point: even over [0,1).
double mirrored_digits(std::uint32_t index, std::uint32_t base) {
  double value = 0, place = 1.0 / base;
  for (; index > 0; index /= base, place /= base) value += place * (index % base);
  return value;
}

struct Rectangle {
  Vec3 corner, a, b;
};

class Radiosity {
 public:
  // Triangles are cut into equal ones with edges of at most `size`. The lamp is one of the parts, and black.
  Radiosity(const mesh::Mesh& mesh, const rays::RayScene& scene, const std::vector<color::Rgb>& reflectance,
            std::size_t lamp, const Rectangle& lamp_area, const color::Rgb& emission,
            const color::ReflectionOperator& op, double size)
      : scene_(scene), reflectance_(reflectance), lamp_area_(lamp_area), emission_(emission), op_(op) {
    for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
      for (std::size_t i = mesh.parts[part].first; i < mesh.parts[part].first + mesh.parts[part].count; ++i) {
        Corners c;
        for (std::size_t k = 0; k < 3; ++k) c.at[k] = mesh.positions[mesh.triangles[i][k]];
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, length(c.at[k] - c.at[(k + 1) % 3]));
        c.normal = normalized(cross(c.at[1] - c.at[0], c.at[2] - c.at[0]));
        c.part = part;
        c.cuts = part == lamp ? 0 : static_cast<int>(std::ceil(longest / size));
        c.first = patches_;
        patches_ += static_cast<std::size_t>(c.cuts * c.cuts);
        triangles_.push_back(c);
      }
    }
    solve();
  }

  // The light of a point of a wall. `rays`: how many look at other walls, where the lamp's light is taken at the very
  // point, and that of patches as the patch there has it; the lamp is cut into grid * grid points.
  color::Rgb shown(const Vec3& point, const Vec3& normal, std::size_t part, int rays, int grid) const {
    color::Rgb light = direct(point, normal, grid);
    for (int k = 0; k < rays; ++k) {
      const auto index = static_cast<std::uint32_t>(k);
      const Met met = seen(point, normal, (k + 0.5) / rays, mirrored_digits(index, 2));
      if (met.patch < 0) continue;
      const Corners& c = triangles_[met.triangle];
      const color::Rgb there = direct(met.point, c.normal, kGatherGrid) + between_[static_cast<std::size_t>(met.patch)];
      light += (1.0 / rays) * reflected(op_, there, reflectance_[c.part]);
    }
    return reflected(op_, light, reflectance_[part]);
  }

 private:
  static constexpr int kGatherGrid = 4;
  struct Corners {
    Vec3 at[3], normal;
    std::size_t part = 0, first = 0;
    int cuts = 0;
    Vec3 point(double u, double v) const { return at[0] + u * (at[1] - at[0]) + v * (at[2] - at[0]); }
  };

  // Irradiance over pi from the lamp.
  color::Rgb direct(const Vec3& point, const Vec3& normal, int grid) const {
    const Vec3 lamp_normal = cross(lamp_area_.a, lamp_area_.b);  // its length is the area
    double sum = 0;
    for (int i = 0; i < grid; ++i) {
      for (int j = 0; j < grid; ++j) {
        const Vec3 way = lamp_area_.corner + (i + 0.5) / grid * lamp_area_.a + (j + 0.5) / grid * lamp_area_.b - point;
        const double d = length(way), cos_here = dot(normal, way) / d, cos_there = -dot(lamp_normal, way) / d;
        if (cos_here <= 0 || cos_there <= 0) continue;
        if (!scene_.occluded(scene_.local(point + 1e-5 * normal), rays::float3((1 / d) * way),
                             static_cast<float>(0.9999 * d * scene_.scale())))
          sum += cos_here * cos_there / (d * d);
      }
    }
    return sum / (grid * grid * kPi) * emission_;
  }

  // The surface in the direction of these numbers, which has the density cos / pi; the patch is -1 where it is none.
  struct Met {
    std::int64_t patch = -1;
    std::size_t triangle = 0;
    Vec3 point;
  };
  Met seen(const Vec3& point, const Vec3& normal, double a, double b) const {
    const rays::Frame frame = rays::frame_about(rays::float3(normal));
    const double r = std::sqrt(a), phi = 2 * kPi * b;
    const Vec3 d =
        r * std::cos(phi) * rays::vec3(frame.x) + r * std::sin(phi) * rays::vec3(frame.y) + std::sqrt(1 - a) * normal;
    const rays::Float3 from = scene_.local(point + 1e-5 * normal), toward = rays::float3(normalized(d));
    const rays::Hit hit = scene_.closest(from, toward);
    if (!hit.any()) return {};
    const rays::Spot spot = scene_.spot(hit, from, toward);
    if (spot.inside) return {};
    const Corners& c = triangles_[hit.triangle];
    if (c.cuts == 0) return {};
    const double u = static_cast<double>(hit.u) * c.cuts, v = static_cast<double>(hit.v) * c.cuts;
    const int i = std::clamp(static_cast<int>(u), 0, c.cuts - 1),
              j = std::clamp(static_cast<int>(v), 0, c.cuts - 1 - i);
    const int upper = u - i + v - j > 1 && i + j < c.cuts - 1 ? 1 : 0;
    // Row i holds 2 (cuts - i) - 1 triangles.
    return {static_cast<std::int64_t>(c.first) + i * (2 * c.cuts - i) + 2 * j + upper, hit.triangle,
            scene_.world(spot.position)};
  }

  void solve() {
    constexpr int kRays = 400, kLampGrid = 6, kPoints = 4;
    std::vector<color::Rgb> emitted;
    std::vector<std::size_t> parts;
    std::vector<std::int32_t> met;
    TestNumbers next(8);
    for (const Corners& c : triangles_) {
      for (int i = 0; i < c.cuts; ++i) {
        for (int k = 0; k < 2 * (c.cuts - i) - 1; ++k) {
          const int j = k / 2, upper = k % 2;
          // Even over the patch: a number pair beyond the diagonal is folded back.
          const auto place = [&](double s, double t) {
            if (s + t > 1) s = 1 - s, t = 1 - t;
            if (upper != 0) s = 1 - s, t = 1 - t;
            return c.point((i + s) / c.cuts, (j + t) / c.cuts);
          };
          color::Rgb light;
          for (int n = 0; n < kPoints; ++n) light += 1.0 / kPoints * direct(place(next(), next()), c.normal, kLampGrid);
          emitted.push_back(reflected(op_, light, reflectance_[c.part]));
          parts.push_back(c.part);
          const double turn_a = next(), turn_b = next();
          for (int n = 0; n < kRays; ++n) {
            const auto turned = [](double x, double by) { return x + by - std::floor(x + by); };
            const auto index = static_cast<std::uint32_t>(n);
            const Vec3 from = place(next(), next());
            met.push_back(static_cast<std::int32_t>(
                seen(from, c.normal, turned((n + 0.5) / kRays, turn_a), turned(mirrored_digits(index, 2), turn_b))
                    .patch));
          }
        }
      }
    }
    ASSERT_EQ(emitted.size(), patches_);
    // The part of a reflectance of .75 that is left after so many bounces is 1e-5.
    std::vector<color::Rgb> radiance = emitted;
    between_.resize(patches_);
    for (int bounce = 0; bounce < 40; ++bounce) {
      std::vector<color::Rgb> after = emitted;
      for (std::size_t p = 0; p < patches_; ++p) {
        color::Rgb light;
        for (std::size_t n = 0; n < kRays; ++n)
          if (met[p * kRays + n] >= 0) light += radiance[static_cast<std::size_t>(met[p * kRays + n])];
        between_[p] = (1.0 / kRays) * light;
        after[p] += reflected(op_, between_[p], reflectance_[parts[p]]);
      }
      radiance = std::move(after);
    }
  }

  const rays::RayScene& scene_;
  std::vector<color::Rgb> reflectance_;
  Rectangle lamp_area_;
  color::Rgb emission_;
  color::ReflectionOperator op_;
  std::vector<Corners> triangles_;
  std::size_t patches_ = 0;
  std::vector<color::Rgb> between_;  // irradiance over pi that patches get from patches
};

struct Figures {
  double mean = 0, error = 0;  // of the relative difference over all points, and its standard error by the paths' noise
  double rms = 0, noise = 0;   // of single points
};

class CornellBox : public testing::Test {
 protected:
  CornellBox() {
    auto read = mesh::read_mesh(testdata("cornell.obj"));
    EXPECT_TRUE(read.ok());
    mesh_ = *std::move(read);
    const color::Rgb white{0.75, 0.75, 0.75}, red{0.62, 0.07, 0.05}, green{0.1, 0.42, 0.09};
    for (const mesh::MeshPart& part : mesh_.parts)
      reflectance_.push_back(part.name == "Red"     ? red
                             : part.name == "Green" ? green
                             : part.name == "Lamp"  ? color::Rgb{}
                                                    : white);
  }

  void light(const color::Rgb& emission, const color::ReflectionOperator& op) {
    std::vector<paint::LobeFit> paints;
    for (const color::Rgb& r : reflectance_) paints.push_back(matt(r));
    stage_ = std::make_unique<PathStage>(mesh_, paints);
    stage_->emission.resize(mesh_.parts.size());
    stage_->emission.back() = emission;
    stage_->scene.reflection = op;
    const Transport& transport = stage_->build();
    const Rectangle lamp{{-0.3, 2, -0.25}, {0.6, 0, 0}, {0, 0, 0.5}};
    solved_ = std::make_unique<Radiosity>(mesh_, transport.rays(), reflectance_, mesh_.parts.size() - 1, lamp, emission,
                                          op, 0.1);
  }

  rays::Spot spot(const Vec3& target) const {
    const rays::RayScene& rays = stage_->transport->rays();
    const Float3 direction = rays::float3(normalized(target - kEye));
    return rays.spot(rays.closest(rays.local(kEye), direction), rays.local(kEye), direction);
  }

  // Over a grid of points that a camera in front of the box sees.
  Figures compared(int bounces) const {
    Figures figures;
    int count = 0;
    constexpr int kGrid = 8;
    double variance = 0;
    for (int i = 0; i < kGrid; ++i) {
      for (int j = 0; j < kGrid; ++j) {
        const Vec3 target{1.84 * (i + 0.5) / kGrid - 0.92, 1.9 * (j + 0.5) / kGrid + 0.05, 1};
        const rays::Spot at = spot(target);
        if (at.part == static_cast<int>(mesh_.parts.size()) - 1) continue;
        PathOptions options;
        options.bounces = bounces;
        const PathEstimate estimate =
            path_estimate(*stage_->transport, options, at, normalized(kEye - target), 400, 7 + i * kGrid + j);
        const color::Rgb truth = solved_->shown(stage_->transport->rays().world(at.position), rays::vec3(at.shading),
                                                static_cast<std::size_t>(at.part), 2048, 24);
        const double size = (truth.x + truth.y + truth.z) / 3;
        for (int c = 0; c < 3; ++c) {
          const double off = (estimate.radiance[c] - truth[c]) / size, noise = deviation(estimate, c) / size;
          figures.mean += off, figures.rms += off * off, variance += noise * noise;
          ++count;
        }
      }
    }
    figures.mean /= count;
    figures.rms = std::sqrt(figures.rms / count);
    figures.noise = std::sqrt(variance / count);
    // The channels of one point share their samples.
    figures.error = std::sqrt(3 * variance) / count;
    return figures;
  }

  static constexpr Vec3 kEye{0, 1, 4.2};
  mesh::Mesh mesh_;
  std::vector<color::Rgb> reflectance_;
  std::unique_ptr<PathStage> stage_;
  std::unique_ptr<Radiosity> solved_;
};

TEST_F(CornellBox, PathsShowWhatRadiosityDoes) {
  struct Case {
    color::Rgb emission;
    color::ReflectionOperator op;
  };
  for (const Case& each : {Case{{10, 10, 10}, color::component_wise()}, Case{{1, 9, 10}, color::iso_rgb_operator()}}) {
    light(each.emission, each.op);
    const Figures all = compared(1000), direct = compared(0);
    // Patches half as large move the mean by 0.0015, so that these err by about 0.003. Four times as many rays move it
    // by 0.0001.
    constexpr double kPatches = 0.004;
    EXPECT_LT(std::abs(all.mean), 4 * all.error + kPatches);
    EXPECT_LT(all.rms, 1.5 * (all.noise + kPatches));
    EXPECT_LT(direct.mean, -0.2);  // control: without bounces
  }
}

// The red wall in cyan light: channel by channel it is as gray as a white one there, with the operator it stays red.
TEST_F(CornellBox, RedStaysRedInCyanLight) {
  const color::Rgb cyan{1, 9, 10};
  color::Rgb seen[2];
  for (const bool with_operator : {false, true}) {
    light(cyan, with_operator ? color::iso_rgb_operator() : color::component_wise());
    const Vec3 target{-1, 0.9, -0.3};
    PathOptions options;
    options.bounces = 1000;
    seen[with_operator ? 1 : 0] =
        path_estimate(*stage_->transport, options, spot(target), normalized(kEye - target), 1000, 3).radiance;
  }
  const auto redness = [](const color::Rgb& c) { return c.x / std::max(c.y, c.z); };
  EXPECT_GT(redness(seen[1]), 3);
  EXPECT_LT(redness(seen[0]), 1.5);  // control: 1 by the lamp alone, .62/(.07 * 9)
}

}  // namespace
}  // namespace goniochrome::render::radiosity_test
