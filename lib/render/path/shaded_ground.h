// The light that a mesh leaves to a floor that shows the environment, known beforehand on a grid: a floor is seen by
// every ray that goes down, and its soft light changes slowly. goniochrome-paths(7), "Ground".
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "color/color.h"
#include "mesh/mesh.h"
#include "rays/ray_scene.h"
#include "render/path/projected_ground.h"
#include "render/path/sequence.h"
#include "render/scene.h"

namespace goniochrome::render {

// Light of a point of the floor, relative to the irradiance of the open floor, channel by channel.
struct GroundLight {
  color::Rgb left{1, 1, 1};  // of the environment and the lamps: what the mesh leaves
  color::Rgb bounced;        // what the mesh sends there
};

struct GroundRequest {
  int directions = 256;          // at each node, a power of two
  double cell = 1.0 / 96;        // of the grid about the mesh, in lengths of the mesh; farther away cells grow
  int bounced_directions = 256;  // at each fourth node, a power of two
  std::uint64_t seed = 1;
  // Above 0 the grid is made with few directions first, and again with twice as many while that may be hoped to end
  // within so many seconds.
  double longest_s = 0;
  // The radiance that the mesh sends along a ray from the floor that meets it there, for the numbers of a sample; none:
  // black.
  std::function<color::Rgb(const rays::Hit& hit, const rays::Float3& from, const rays::Float3& direction,
                           const Sequence& sequence, std::uint32_t index)>
      sent = {};
};

// How many directions keep the error of soft light within half of a tolerance in CIEDE2000 at 95 of 100 places, as far
// as the tests tell, and that of light that the mesh sends within all of it: kFewestGroundDirections to 4096.
int ground_directions(double tolerance_de00);
constexpr int kFewestGroundDirections = 128;
// A request for a tolerance, which takes a quarter of the time that is left; 0: it takes what it needs.
GroundRequest ground_request(double tolerance_de00, std::uint64_t seed, double left_s);

// Immutable: for any number of threads at once.
class ShadedGround {
 public:
  // `lights` have no place. Bit-identical for any number of threads.
  // `box` of the mesh, in its units; `mesh_radius` as Transport has it.
  ShadedGround(std::shared_ptr<const rays::RayScene> scene, const ProjectedGround& ground,
               const std::vector<Light>& lights, const mesh::Box& box, float mesh_radius, const GroundRequest& request);

  // At a place of the floor, local, as a picture shows it. Soft light is interpolated; the brightest texels and lamps
  // that are discs get the more rays the more of them the edge of their shadow needs. There is no randomness in it.
  GroundLight seen(const rays::Float3& place) const;
  // The light where a path meets the floor, with one ray to the brightest texels and to each lamp, which `number` in
  // [0,1) draws.
  GroundLight met(const rays::Float3& place, double number) const;

 private:
  // Directions of light, eight by eight, with their shares of the irradiance.
  struct Directions {
    std::vector<rays::Fan> fans;
    std::vector<rays::Float3> shares;  // of each direction; 0 for those that fill the last fan
  };
  // A place in a cell of a grid.
  struct Place {
    std::size_t column = 0, row = 0;
    float right = 0, down = 0;
  };
  // Values at the crossings of lines; beyond the last line there are none.
  struct Grid {
    std::vector<float> x, z;
    std::vector<rays::Float3> values;
    std::optional<Place> find(const rays::Float3& place) const;
    const rays::Float3& at(std::size_t column, std::size_t row) const { return values[row * x.size() + column]; }
  };
  // A lamp, or the brightest texels together.
  struct Source {
    // A cell of occluded_ has nothing in the way of the source, or rays tell how much there is, or its nodes do.
    enum State : std::uint8_t { kFree, kAsked, kSmooth };
    Directions few, many;
    rays::Float3 share;  // of all of it
    std::vector<State> states;
    Grid nodes;  // what is occluded of it; 0 at those that are free
  };
  static Directions directions(const std::vector<ProjectedGround::SharedRay>& rays);
  static Source source(const std::function<std::vector<ProjectedGround::SharedRay>(std::uint32_t count)>& drawn);
  void add_lamp(const Light& light, const color::Rgb& irradiance);
  void shade(const std::vector<float>& x, const std::vector<float>& z);
  static void smooth(Grid& grid);
  static rays::Float3 largest_beside(const Grid& grid, std::size_t column, std::size_t row);
  void divide();
  static float bent(const Grid& grid, std::size_t column, std::size_t row);
  static float bent(const Grid& grid, std::size_t column, std::size_t row, bool across);
  void smooth(Source& source) const;
  void mark(Source& source) const;
  void mark(const rays::Fan& fan, const std::vector<mesh::Box>& boxes, std::vector<bool>& marked) const;
  void gather(const std::vector<float>& x, const std::vector<float>& z, const GroundRequest& request,
              const color::Rgb& irradiance);
  template <class Value>
  void fill(Grid& grid, const Value& value) const;
  rays::Float3 soft_occluded(std::size_t column, std::size_t row, float right, float down) const;
  static rays::Float3 between(const Grid& grid, const Place& at);
  GroundLight light(const rays::Float3& place, const Place* at) const;
  struct Cone;
  Cone cone(const rays::Float3& start) const;
  rays::Float3 occluded(const Directions& directions, const rays::Float3& start) const;
  rays::Float3 occluded(const Source& source, const rays::Float3& start) const;
  rays::Float3 start_at(float x, float z) const { return {x, height_ + rays::kLift, z}; }

  std::shared_ptr<const rays::RayScene> scene_;
  float mesh_radius_ = 0, height_ = 0;
  float bent_ = 0;  // the share of one direction, by which shadows come in steps: cells that bend more are divided
  Directions soft_;
  std::vector<Source> sources_;
  Grid occluded_, bounced_;             // of the soft light; of the open irradiance
  std::vector<std::uint32_t> divided_;  // of each cell of occluded_: its number among those that are divided, or kWhole
  std::vector<rays::Float3> fine_;      // the nodes of these, row by row
};

}  // namespace goniochrome::render
