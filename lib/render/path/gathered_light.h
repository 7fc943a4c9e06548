// Light of smooth surface is gathered at few visible points, all lobes from one set of directions, and interpolated
// between them. What that errs by is measured at points that are held out, and told. goniochrome-theory(7), PATHS,
// Gathered light.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/clock.h"
#include "render/path/noise.h"
#include "render/path/open_shading.h"
#include "render/path/transport.h"
#include "render/path/visible_surface.h"

namespace goniochrome::render {

struct GatherRequest {
  PathOptions options;
  double tolerance_de00 = 0.5;  // of the picture; sums over the open environment are a quarter of that off
  double white_luminance = 1;
  std::uint64_t seed = 1;
  // What points show with nothing in the way: then only what the mesh changes is sampled. Null: all is.
  const OpenShading* open = nullptr;
  // With PathOptions::correction, the picture that is corrected, in its first channels; it tells how visible noise is.
  const image::Image* base = nullptr;
};

// What the diffuse part and the lobes of visible points show beyond `open`'s maps. Mirror lobe, directional lights, own
// emission and, on a floor that shows the environment, its open radiance are not in it. Of that floor the light is
// relative to Transport::laid_paint(). The arguments must outlive it. Bit-identical for any number of threads
// while no deadline passes.
class GatheredLight {
 public:
  GatheredLight(const Transport& transport, const VisibleSurface& centers, const GatherRequest& request);

  // Gathers at the points of a first lattice and at those that are held out.
  void begin();
  // One round: more directions where noise is most, more points where interpolation errs most, for pixels whose error
  // is above the target (one standard deviation). False: 95 % of the pixels are within it, or nothing more can be done.
  bool improve(double target_de00, const Deadline& deadline);

  // Of a visible point near pixel (x, y), whose center is at whole numbers.
  struct Light {
    bool known = false;  // false where no point of the same surface is near
    color::Rgb light;
    Covariance covariance{};  // of noise and interpolation together
    int samples = 0;          // of the points that it was interpolated from, the mean
  };
  Light at(double x, double y, const rays::Spot& spot) const;

  // Over some of the pixels, at the last round.
  double noise_p95_de00() const { return noise_p95_; }
  std::size_t points() const { return points_.size(); }
  double directions() const;  // in all

 private:
  struct Point {
    int x = 0, y = 0, part = 0;
    rays::Float3 position, normal;
    Vec3 to_viewer;
    color::Rgb scale{1, 1, 1};  // of the floor's paint
    color::Rgb certain;         // what needs no samples
    color::Rgb seen;            // all that the pixel shows beside this light
    float shelter = 0;          // the share of directions along which a surface is near
    Estimates sums;
    bool sampled = false;  // else all is certain
    Covariance variance{}, error{};
    int wanted = 0;  // sequences in the next round
    color::Rgb value() const { return certain + sums.mean(); }
    color::Rgb shown() const { return seen + scale * value(); }
  };
  struct Near {
    std::int32_t point;
    float weight, u, v;  // of the kernel, and the place in steps
    float share;         // of its value in the interpolated one; together 1
  };
  static constexpr int kFirstLevel = 3;  // the first lattice has a point in every eighth pixel of every eighth row
  static constexpr int kOffset = 1 << (kFirstLevel - 1);
  static constexpr std::uint32_t kDirections = 64;  // of a sequence
  static constexpr int kTrusted = 4;                // the fewest sequences whose scatter is believed
  static constexpr double kMostUnlike = 0.49;       // of shelters: beyond the chance of 1 in 100
  static constexpr float kNotSeen = -1e30F;         // in the place of a radiance
  static constexpr int kMostNear = 25;
  // Interpolated light.
  struct Mix {
    int count = 0;  // of `points`; 0: none are near
    color::Rgb light, shown;
    Covariance noise{}, error{};
    double samples = 0;
    double shelter = 0;
    bool single = false;  // a point's own light, which is not interpolated
    std::int32_t points[kMostNear];
  };
  struct Judged {
    bool known = false;
    double noise2 = 0, error2 = 0;  // CIEDE2000 squared, of noise and of interpolation
    double de00() const { return std::sqrt(std::max(0.0, noise2 + error2)); }
  };
  struct Looked {
    int x, y, weight;
    bool floor;
    Judged judged;
  };

  std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x); }
  bool gatherable(int x, int y) const;
  bool is_floor(int part) const { return transport_.rays().has_floor() && part + 1 == transport_.rays().parts(); }
  int near(double x, double y, const rays::Float3& position, const rays::Float3& normal, int part, int step,
           std::int32_t without, Near* found) const;
  Mix mixed_at(double x, double y, const rays::Float3& position, const rays::Float3& normal, int part, int step,
               std::int32_t without) const;
  float shelter(const rays::Spot& spot, std::size_t at) const;
  Mix best_at(double x, double y, const rays::Spot& spot, int step) const;
  double told_scale(bool single, int part) const { return single ? 1 : error_scale_[is_floor(part) ? 1 : 0]; }
  std::vector<Point> made(const std::vector<std::size_t>& pixels, bool all_exact) const;
  void add_open(std::vector<Point>& points, bool all_exact) const;
  bool take_open_of_neighbors(Point& point) const;
  void draw(std::vector<Point>& points, const Deadline* deadline) const;
  void add_points(const std::vector<std::size_t>& pixels, const Deadline* deadline);
  void judge_points();
  void calibrate();
  Judged judged(int x, int y) const;
  std::vector<Looked> looked_at();
  void see(const std::vector<Looked>& looked);
  static double percentile(const std::vector<Looked>& looked, bool floor, double share);
  void want_more(const Looked& looked, double target_de00);
  double seen2(const color::Rgb& radiance, const Covariance& covariance) const;
  void refine(int x, int y, std::vector<std::uint8_t>& asked) const;
  int step_at(int x, int y) const { return 1 << level_[pixel(x, y)]; }

  const Transport& transport_;
  const VisibleSurface& surface_;
  GatherRequest request_;
  PathOptions sampled_;  // the options of what is sampled
  int width_, height_;
  std::vector<std::uint8_t> level_;   // of each pixel, the binary logarithm of the lattice's step there
  std::vector<std::int32_t> number_;  // of the point in each pixel, or -1
  std::vector<rays::Float3> beside_;  // what pixels show beside this light, where that was asked for
  std::vector<Point> points_, held_out_;
  double error_scale_[2] = {1, 1};  // of what is told, as held-out points of mesh and floor have it
  double noise_p95_ = 0;
};

}  // namespace goniochrome::render
