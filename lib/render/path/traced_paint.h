// Paints as paths meet them: evaluated and sampled in floats.
// goniochrome-paths(7), "PATHS" and goniochrome-lobes(7), "LOBE MODEL".
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "brdf/coat_facets.h"
#include "brdf/color_map.h"
#include "brdf/ward.h"
#include "paint/paint.h"
#include "rays/ray_scene.h"
#include "render/scene.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

// The most lobes of a paint, the mirror apart.
constexpr int kMostTracedLobes = 24;

// A paint laid out for tracing. What it shows is ExactModel's (render/exact.h) with the Fresnel reflectance on:
//   f cos_i = T(theta_i) T(theta_o) cos_i (K_D + sum K_DD cos^E) + F(theta_h)/F(gloss_deg) sum K_G cos^E,
//   mirror K_M F(theta_o)
// above the horizon, nothing below it. Of an anisotropic paint each lobe is the mean over tilted normals.
class TracedPaint {
 public:
  // `tilts`: as ward_tilts() returns them; one or none: isotropic. Error: more than kMostTracedLobes lobes, a weight
  // that is not finite, an exponent below 0.
  static Result<TracedPaint> create(const paint::LobeFit& paint, double gloss_deg, std::vector<brdf::Tilt> tilts);
  // The surface that a part of the scene has, where the layer holds one for it: the textures in the place of what they
  // cover of the paint, and the color map in the place of K_D and K_DD, so that f = map/pi + gloss lobes. The lobes of
  // the paint are still what directions are drawn by. The layer must outlive the paint.
  void put_surface(const SurfaceLayer& layer, int part);

  // Draws the rough coat that its gloss lobes and its mirror stand for, in their place; nothing where they stand for
  // none, see brdf::coat_of_lobes(), or where the paint is brushed. `paint` and `gloss_deg` are those of create().
  void put_coat(const paint::LobeFit& paint, double gloss_deg);
  bool has_rough_coat() const { return coat_.has_value(); }

  // True if it shows only its lobes, its diffuse part and its mirror, which is not so with a texture or a map.
  bool is_lobe_model() const { return map_ == nullptr && layer_ == nullptr && !coat_; }

 private:
  friend class PaintedPoint;
  struct Lobe {
    float exponent = 1, normalization = 0;  // (E + 1)/(2 pi)
    rays::Float3 directional_diffuse, gloss;
  };
  struct Weights {
    float view_deg = 0;
    rays::Float3 diffuse, mirror;
    std::vector<Lobe> lobes;  // those of all views, ascending exponents
  };
  std::vector<Weights> views_;  // one, or ascending in view_deg
  double coat_index_ = paint::kNoCoat;
  std::vector<brdf::Tilt> tilts_;         // none: isotropic
  std::optional<brdf::CoatFacets> coat_;  // in the place of gloss lobes and mirror
  const brdf::ColorMap* map_ = nullptr;
  brdf::CriticalAngle treatment_ = brdf::CriticalAngle::kSlide;
  float map_level_ = 0;                  // the mean size of the map's factors
  const SurfaceLayer* layer_ = nullptr;  // of a textured part
  int part_ = 0;
  bool hidden_ = false;  // whether no place shows the paint
};

// A direction that light may have come from, with f cos_i and the probability density that drawn() gives it.
struct Reflection {
  rays::Float3 direction;
  rays::Float3 f_cos;  // 1/sr
  float pdf = 0;       // 1/sr; 0: below the horizon, no light
};

// A paint at one point seen from one direction: the mirror lobe apart, everything that it shows.
class PaintedPoint {
 public:
  // Unit vectors with n.o > 0. The paint must outlive the point. A texture shows nothing, since its place is not known.
  PaintedPoint(const TracedPaint& paint, const rays::Float3& normal, const rays::Float3& to_viewer);
  // With the texels of the spot.
  PaintedPoint(const rays::Spot& spot, const TracedPaint& paint, const rays::Float3& to_viewer);
  // A matt point of this K_D, in 1/sr.
  PaintedPoint(const rays::Float3& diffuse, const rays::Float3& normal, const rays::Float3& to_viewer);

  // The parts of f cos_i by themselves: that of the constant K_D, that of the lobes, among which a color map is, and of
  // the latter that of gloss; and the density.
  struct Parts {
    rays::Float3 diffuse, lobes, gloss;
    float pdf = 0;
  };
  Parts parts(const rays::Float3& to_light) const;
  Reflection at(const rays::Float3& to_light) const {
    const Parts all = parts(to_light);
    return {to_light, all.diffuse + all.lobes, all.pdf};
  }

  // The factor of each weight of the paint in f cos_i: K_D, then K_DD and K_G of each lobe of the paint, by its number
  // among those with weight; f cos_i of a rough coat; and the density that drawn() gives the direction. So that other
  // weights than those in three channels can be taken. Not for textures and color maps.
  struct Shares {
    float pdf = 0;  // 1/sr; 0: below the horizon, no light
    float coat = 0;
    float of[2 * kMostTracedLobes + 2] = {};  // the last one is for a mirror, and is 0

    float diffuse() const { return of[0]; }
    float directional_diffuse(std::size_t lobe) const { return of[1 + 2 * lobe]; }
    float gloss(std::size_t lobe) const { return of[2 + 2 * lobe]; }
  };
  Shares shares(const rays::Float3& to_light) const;
  // Those integrated over a disc, as toward_disc() is; the density is 0.
  Shares disc_shares(const Light& light, bool tabled = true) const;
  // A point there that has each of these lobes, ascending, the cosine and the mirror with weight 1. It draws kOwnShare
  // of its directions as the paint does, and the others evenly, for other paints. Squared error times time, the mean of
  // three scenes, was 1.66, 1.38, 1.24 and 1.18 with none, a quarter, half and three quarters.
  static constexpr float kOwnShare = 0.5F;
  PaintedPoint of_basis(std::span<const double> exponents) const;
  // Between which views of the paint the viewer is, and how far from the first to the second.
  struct Between {
    std::size_t low = 0, high = 0;
    float share = 0;
  };
  const Between& between() const { return between_; }

  // The integral of f cos_i over the disc of a lamp that has no place, relative to pi sin^2 of its radius and as if
  // nothing stood in the way; 0 below the horizon. The coat's reflectance and what the horizon takes are those of the
  // middle of the disc and of the mirror direction, in shares; render/exact.h has them for each direction.
  // `tabled`: whether many points see a disc of this radius, so that a table of its lobes is worth while.
  rays::Float3 toward_disc(const Light& light, bool tabled = true) const;

  // A direction drawn by numbers in [0,1). `choice` says which lobe. It may lie below the horizon. The point is not
  // black.
  rays::Float3 direction(double choice, double u, double v) const;
  Reflection drawn(double choice, double u, double v) const {
    return total_ > 0 ? at(direction(choice, u, v)) : Reflection{};
  }

  // A lobe cos^E about mirrored(). Its weight for flakes has the passage of the coat to the viewer, but not that of the
  // light.
  struct WideLobe {
    float exponent;
    rays::Float3 directional_diffuse, gloss;
  };
  // The first lobes of exponents up to `sharpest`, no more than `most`. Nothing where the point shows anything but
  // its diffuse part, its mirror and lobes about mirrored().
  std::optional<std::vector<WideLobe>> wide_lobes(float sharpest, std::size_t most) const;
  // This point without its diffuse part and so many of the first lobes.
  PaintedPoint without_wide(std::size_t lobes) const;

  const rays::Float3& normal() const { return normal_; }
  // True where light may be reflected from: above the surface, or by texels whose own normals look elsewhere.
  bool faces(const rays::Float3& to_light) const { return bent_ || rays::dot(normal_, to_light) > 0; }
  bool is_bent() const { return bent_; }
  const rays::Float3& mirrored() const { return mirrored_; }  // where the mirror lobe looks
  const rays::Float3& mirror() const { return mirror_; }      // K_M F
  // K_D T(theta_o), 1/sr
  const rays::Float3& diffuse() const { return diffuse_; }
  // The coat's reflection to the viewer; without a coat that of kCoatIndex.
  float coat_mirror() const;
  double coat_index() const { return coat_index_; }
  const rays::Float3& to_viewer() const { return viewer_; }
  bool is_brushed() const { return !axes_.empty(); }
  // A direction drawn with the density (E + 1)/(2 pi) cos^E about an axis, by numbers in [0,1).
  static rays::Float3 drawn_about(const rays::Float3& axis, float exponent, float u, float v);
  // The approximate part of even light that each sends back, mean of the channels: samples are shared out by it.
  float lobes_weight() const { return total_; }
  float mirror_weight() const;
  // The share of all lobes narrower than a light of this extent in sr, as a part of lobes_weight(): lobes that find the
  // light better than the light finds them.
  float narrow_share(double light_sr) const;
  bool black() const { return !(total_ > 0) && mirror_.x == 0 && mirror_.y == 0 && mirror_.z == 0; }

 private:
  // The mirror directions about the tilted normals of a brushed paint, with their shares; none: mirrored() alone.
  struct Axis {
    rays::Float3 direction;
    float share;
  };
  struct Lobe {
    float exponent, normalization, chance;
    rays::Float3 directional_diffuse, gloss;
    int number;  // among those of the paint
  };
  // A lobe exp(log_peak) cos^exponent about its own axis, times the cosine of light to the normal of its texel. The
  // diffuse part of a texel with a normal of its own is a matt one: exponent 1 about that normal, without a cosine.
  struct TexelLobe {
    rays::Float3 axis;
    float exponent, log_peak;
    rays::Float3 color;
    float normalization, chance;
    rays::Float3 normal;
    bool matt;
    float cosine(const rays::Float3& to_light) const { return matt ? 1 : std::max(rays::dot(normal, to_light), 0.0F); }
  };
  friend class TracedPaint;
  void wear(const SurfaceLayer::Place& place);
  void dim(float share);
  void add_texel_lobe(const Vec3& axis, double exponent, const color::Rgb& albedo, const rays::Float3& normal,
                      bool matt = false);
  rays::Float3 mapped(const rays::Float3& to_light) const;
  void set_axes(const std::vector<brdf::Tilt>& tilts);
  // Above the horizon: the factor of what lies under the coat, f cos_i of a rough coat, and the density times total_.
  struct Factors {
    float base = 0, coat = 0, pdf = 0;
  };
  template <class Visit>
  Factors factors(const rays::Float3& to_light, const Visit& visit) const;
  // Likewise of a disc; returns the factor of what lies under the coat.
  template <class Visit>
  float disc_factors(const Light& light, bool tabled, const Visit& visit) const;
  template <class Visit>
  void visit_texels(const rays::Float3& to_light, const Visit& visit) const;

  float let_in(float cos_i) const;
  // A direction in the frame whose z is the normal.
  Vec3 local(const rays::Float3& direction) const;
  rays::Float3 coat_direction(double choice, float u, float v) const;

  rays::Float3 normal_, viewer_, mirrored_, mirror_, diffuse_;
  rays::Frame frame_;
  double coat_index_ = paint::kNoCoat;
  float let_out_ = 1;  // what the coat lets out to the viewer: diffuse_ and the lobes' K_DD hold it
  float cos_o_ = 1, diffuse_chance_ = 0, coat_chance_ = 0, total_ = 0;
  const brdf::CoatFacets* coat_ = nullptr;  // in the place of gloss lobes and mirror
  int count_ = 0;
  Between between_;
  Lobe lobes_[kMostTracedLobes];
  std::vector<Axis> axes_;  // of tilts; none: mirrored_ alone
  float axes_total_ = 1;
  float bare_ = 1;                      // the part of the paint that textures leave, which all of its weights hold
  rays::Float3 texel_diffuse_;          // of textures, 1/sr; no coat lies over it
  std::vector<TexelLobe> texels_;       // of textures
  bool bent_ = false;                   // whether some texels have normals of their own
  const TracedPaint* paint_ = nullptr;  // of a color map
};

}  // namespace goniochrome::render
