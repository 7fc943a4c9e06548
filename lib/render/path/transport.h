// Light on its way through a scene: what one point shows, by rays. goniochrome-paths(7), "PATHS".
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/angles.h"
#include "base/result.h"
#include "render/effects.h"
#include "render/path/bright_places.h"
#include "render/path/emitters.h"
#include "render/path/environment_table.h"
#include "render/path/open_floor.h"
#include "render/path/path_product.h"
#include "render/path/projected_ground.h"
#include "render/path/sequence.h"
#include "render/path/shaded_ground.h"
#include "render/path/traced_paint.h"
#include "render/scene.h"

namespace goniochrome::render {

class SpectralPaths;

// The surfaces and lights that paths meet.
struct PathScene {
  const Scene* scene = nullptr;  // its mesh, paints, lights and product of colors; its maps are not used
  const envmap::Environment* environment = nullptr;  // none: dark
  // The environment that mirrors show where its sun is one of the scene's lights and is no part of `environment`; none:
  // that.
  const envmap::Environment* mirrored = nullptr;
  std::vector<color::Rgb> emission = {};  // radiance of each part; none where there are fewer
  std::optional<Ground> ground = {};
  // The mesh with its floor, where they are there already; else they are made.
  std::shared_ptr<const rays::RayScene> rays = nullptr;
  // The surfaces with the panes of the scene, which other rays pass: the ones that cameras see. Where there are panes
  // and it is null, it is made.
  std::shared_ptr<const rays::RayScene> eye = nullptr;
  // The table of that environment, where it is there already; else it is made.
  std::shared_ptr<const EnvironmentTable> table = nullptr;
  // True if satin coats are drawn as rough surfaces, and not by the lobes that stand for them: for pictures that are
  // drawn by paths alone.
  bool rough_coats = false;
  double tilt_tolerance = 1e-3;  // of the tilted normals of brushed paints, relative to the lobe's peak
};

// Options of the light along paths.
struct PathOptions {
  // How many surfaces may pass light on before it reaches the point that is seen: 0 lets a surface that is met be
  // black, apart from what it emits. A floor that shows the environment is light, and does not count.
  int bounces = 8;
  // True if the light that surfaces pass on reaches the lobes and the mirror of the point that is seen, and if it
  // reaches its diffuse part.
  bool into_lobes = true, into_diffuse = true;
  // Only what the mesh changes: the radiance with the mesh in the way less the radiance without it. That is 0 without
  // any noise where no ray is occluded. A floor that shows the environment is there either way, with all its radiance.
  bool correction = false;
  // The point that is seen is matt white there, whatever its paint is. Surfaces that send light to it keep theirs.
  bool white = false;
};

// The light of a point, by the way that it took. The sum is what it shows.
struct LightShares {
  // From light straight to the point; with PathOptions::correction less what the mesh blocks. A floor that shows the
  // environment is light, apart from what the mesh sends it.
  color::Rgb direct;
  color::Rgb into_lobes;    // passed on by surfaces to the lobes and the mirror of the point
  color::Rgb into_diffuse;  // passed on by surfaces to the diffuse part of the point
  // With PathOptions::correction over a floor whose ground is shaded: the light of the floor, less what the environment
  // has below the horizon.
  color::Rgb from_floor = {};

  color::Rgb sum() const { return direct + into_lobes + into_diffuse + from_floor; }
  // The part of it that pictures with these effects show.
  color::Rgb shown(const RayEffects& effects) const {
    color::Rgb shown;
    if (effects.shadow) shown += direct + from_floor;
    if (effects.shadow && effects.self) shown += into_lobes;
    if (effects.shadow && effects.bounce) shown += into_diffuse;
    return shown;
  }
  LightShares& operator+=(const LightShares& o) {
    direct += o.direct, into_lobes += o.into_lobes, into_diffuse += o.into_diffuse, from_floor += o.from_floor;
    return *this;
  }
};
constexpr LightShares operator*(double scale, const LightShares& a) {
  return {scale * a.direct, scale * a.into_lobes, scale * a.into_diffuse, scale * a.from_floor};
}
// In the order in which plans list the effects of rays.
inline constexpr color::Rgb LightShares::* kShares[] = {&LightShares::direct, &LightShares::into_lobes,
                                                        &LightShares::into_diffuse, &LightShares::from_floor};

// How many samples are drawn together from one sequence. Their mean is one independent estimate.
constexpr int kBatch = 16;
constexpr int kFan = 8;             // and how many of them are traced together
constexpr int kHalfFan = kFan / 2;  // the fewest that can be

// Immutable: for any number of threads at once.
class Transport {
 public:
  // All that the scene refers to must outlive it. Error: as RayScene, TracedPaint and Emitters have them.
  // A scene with spectra and without an environment is followed in bands, see SpectralPaths.
  static Result<Transport> create(const PathScene& scene);

  const rays::RayScene& rays() const { return *rays_; }
  // The surfaces that cameras see: those of rays(), and panes as well. Their triangles are those of rays().
  const rays::RayScene& eye() const { return eye_ != nullptr ? *eye_ : *rays_; }
  // True if a ray of a camera meets a pane there.
  bool meets_pane(const rays::Hit& hit) const {
    return eye_ != nullptr && hit.triangle < rays::kFloor && panes_[static_cast<std::size_t>(eye_->part(hit.triangle))];
  }
  // The part of what lies behind the scene that is seen there: 1 beside the scene, less through panes, 0 before others.
  double clear_share(const rays::Float3& from, const rays::Float3& direction) const;
  const Emitters& emitters() const { return emitters_; }
  color::ReflectionOperator reflection() const {
    return reflection_ != nullptr ? *reflection_ : color::component_wise();
  }
  // The light of a floor that shows the environment, where nothing occludes it.
  color::Rgb open_ground(const rays::Spot& spot) const;
  // From here on paths that meet such a floor read its light from a grid, and go no farther. They lose what little
  // noise they had from there, and are no longer exact: ShadedGround says by how much. Not for scenes with emitters.
  // Without such a floor it does nothing.
  void shade_ground(GroundRequest request, int bounces);
  // The grid, null without one, and the light of the floor then.
  const ShadedGround* shaded() const { return shaded_.get(); }
  LightShares shaded_ground(const rays::Spot& spot) const;
  // The places that surfaces get most of the light from that they pass on, each of which so many bounces may light;
  // null where directions toward them are not worth while, as in all scenes without emitters. Bit-identical for any
  // number of threads.
  std::shared_ptr<const BrightPlaces> find_bright_places(int bounces, std::uint64_t seed) const;
  // From here on paths go on toward these places as well as by the lobes of paints, with the same expectation. They are
  // those of a transport whose mesh and emitting parts are the same, and which outlives this one; null: by lobes alone.
  void draw_toward(std::shared_ptr<const BrightPlaces> places) { places_ = std::move(places); }
  const BrightPlaces* bright_places() const { return places_.get(); }

 private:
  friend class PointSampler;
  friend class PointTransport;
  friend class LobePoint;
  friend class SpectralPaths;
  explicit Transport(std::shared_ptr<const rays::RayScene> rays) : rays_(std::move(rays)) {}
  // Creates one without spectra.
  static Result<Transport> in_channels(const PathScene& scene);
  color::Rgb bounced(const rays::Hit& hit, const rays::Float3& origin, const rays::Float3& direction, int bounces,
                     const Sequence& sequence, std::uint32_t index, std::uint32_t set) const;
  // Light off a floor that shows the environment, in two parts. `fixed` depends on no paint of the mesh: it is that of
  // the unoccluded floor less what the mesh occludes. `bounced` is what the mesh sends to the floor.
  struct FloorLight {
    color::Rgb fixed, bounced;
  };
  FloorLight off_floor(const rays::Hit& hit, const rays::Float3& origin, const rays::Float3& direction, int bounces,
                       const Sequence& sequence, std::uint32_t index, std::uint32_t set) const;
  LightShares shown_ground(const rays::Spot& spot, const GroundLight& light) const;
  // The light of a floor whose light is on a grid, as a ray sees it, without samples; none where it meets no such
  // floor.
  std::optional<LightShares> seen_floor(const rays::Hit& hit, const rays::Float3& origin,
                                        const rays::Float3& direction) const;
  // The light of the floor where a path meets it, by a number in [0,1); nothing from below.
  LightShares met_ground(const rays::Hit& hit, const rays::Float3& origin, const rays::Float3& direction,
                         double number) const;
  // A ray to a point of an emitter ends this part of the way short of it.
  static constexpr float kShort = 1 - 1e-4F;
  // The one loop of paths and its step, see path_loop.h.
  struct Vertex;
  struct Next;
  class Channels;
  template <class Carrier>
  void add_direct(const Vertex& vertex, const std::array<double, 4>& numbers, double choice, Carrier& carrier) const;
  template <class Carrier>
  Next next_ray(const Vertex& vertex, const std::array<double, 4>& numbers, Carrier& carrier) const;
  template <class Carrier>
  void add_found(const Vertex& vertex, const Next& next, Carrier& carrier) const;
  template <class Carrier>
  Next step(const Vertex& vertex, const std::array<double, 4>& to_light, const std::array<double, 4>& onward,
            Carrier& carrier) const;
  template <class Carrier>
  void send(const Vertex& vertex, int further, const Sequence& sequence, std::uint32_t index, std::uint32_t set,
            Carrier& carrier) const;
  template <class Carrier>
  void follow(rays::Hit hit, rays::Float3 origin, rays::Float3 direction, int bounces, const Sequence& sequence,
              std::uint32_t index, std::uint32_t set, Carrier& carrier) const;
  // Narrow lobes find what they show better than places do.
  BrightPlaces::Receiver receiver(const rays::Spot& spot, const PaintedPoint& painted) const {
    if (places_ == nullptr || is_projected(spot)) return {};
    return places_->receiver(spot.triangle, spot.u, spot.v, 1 - painted.narrow_share(BrightPlaces::kNarrow_sr));
  }
  // The factor of the chance of a path to go on from there.
  double brightness(const rays::Hit& hit) const { return places_ != nullptr ? places_->brightness(hit) : 1; }
  // A direction in which a path goes on from a surface by its lobes or toward a bright place, and what is met there.
  struct Onward {
    rays::Float3 direction;
    rays::Hit hit;
    double lobes_chance = 0;  // 0: the direction comes to nothing
    double places_pdf = 0;    // 1/sr; to be added to the lobes' density times their chance
  };
  Onward onward(const rays::Spot& spot, const BrightPlaces::Receiver& receiver, const PaintedPoint& painted,
                double choice, double u, double v) const;
  // A lamp as the point sees it, and how far a ray to it goes (local).
  struct SeenLamp {
    Light light;
    float reach = std::numeric_limits<float>::infinity();
    bool is_placed = false;
    double versine = 0;  // 1 - cos of its radius

    explicit SeenLamp(const Light& light);
    double extent_sr() const { return 2 * kPi * versine; }
  };
  SeenLamp seen_lamp(std::size_t lamp, const rays::Float3& from) const;
  // The sphere about the mesh, as the point sees it; none from within.
  std::optional<SeenLamp> mesh_disc(const rays::Spot& spot) const;
  bool is_under_mesh(const rays::Spot& spot) const;
  // A direction to a lamp, drawn evenly from its disc by numbers in [0,1), and the radiance times solid angle of the
  // lamp in units of f cos_i: what a sample adds with the mean over samples.
  struct LampSample {
    rays::Float3 direction;
    float reach = 0;
    color::Rgb light;
    int number = 0;        // of the lamp, where one of them was drawn
    double extent_sr = 0;  // 1 over the density of the direction
  };
  static LampSample drawn_from(const SeenLamp& lamp, double u, double v);
  // The sample of any one lamp.
  LampSample drawn_lamp(const rays::Float3& from, double choice, double v) const;
  // The light of the environment in a mirror; there is one.
  color::Rgb mirrored_environment(const rays::Float3& direction) const;
  // The light of lamps in a mirror in that direction, where a ray meets `hit`.
  color::Rgb mirrored_lamps(const rays::Float3& from, const rays::Float3& toward, const rays::Hit& hit) const;
  bool is_projected(const rays::Spot& spot) const;
  bool is_projected(const rays::Hit& hit) const { return ground_ && hit.triangle == rays::kFloor; }
  PaintedPoint painted(const rays::Spot& spot, const rays::Float3& to_viewer) const;

  std::shared_ptr<const rays::RayScene> rays_;   // stays where it is when the transport is moved
  std::shared_ptr<const rays::RayScene> eye_;    // of a scene with panes
  std::vector<bool> panes_;                      // of its parts
  std::vector<TracedPaint> paints_;              // of the parts, then of the floor
  std::optional<ProjectedGround> ground_;        // of a floor that shows the environment
  std::shared_ptr<const ShadedGround> shaded_;   // see shade_ground()
  std::shared_ptr<const OpenFloor> open_floor_;  // of a shaded ground
  rays::Float3 ground_eye_;                      // local: where such a floor's environment was seen from
  mesh::Box mesh_box_;
  float mesh_radius_ = 0;  // local, of a sphere about the origin that holds the mesh
  std::shared_ptr<const EnvironmentTable> environment_;
  const envmap::Environment* mirrored_ = nullptr;  // in its place in mirrors
  Emitters emitters_;
  std::shared_ptr<const BrightPlaces> places_;  // see draw_toward()
  std::vector<Light> lights_;
  const color::ReflectionOperator* reflection_ = nullptr;  // null: channel by channel
  // The paths of a scene with spectra: all light of its points. Paints, emitters and lights are then gray, and what
  // directions and lamps are drawn by.
  std::shared_ptr<const SpectralPaths> spectral_;
};

// The point over an open floor, without lobes.
GroundReceiver ground_receiver(const rays::Spot& spot, const PaintedPoint& painted);

}  // namespace goniochrome::render
