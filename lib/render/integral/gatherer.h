// A gatherer sums, patch by patch, the light from all around that one point reflects to the viewer. It holds the
// integrand of exact_model.h and decides how finely the light must be divided.
#pragma once

#include <algorithm>
#include <vector>

#include "color/color.h"
#include "envmap/block_tree.h"
#include "math/quadrature.h"
#include "render/integral/exact_model.h"
#include "render/integral/patch.h"

namespace goniochrome::render {

// The grain is how finely the light around a point must be divided: no patch may be wider than a given part of the
// lobes that reach it.
class Grain {
 public:
  // Texels are at most `texel_rad` across. `most_spread`: the standard deviation of the directions of a block's light,
  // in those of a lobe (1/sqrt E), up to which the block is a single patch; 0 where no blocks are asked for.
  Grain(double texel_rad, double most_spread);

  // Lobes of these exponents, the sharpest first, each about every one of these directions. Many directions in one cap
  // soften each other: blocks need not be much narrower than the directions stand apart.
  void add(std::vector<Vec3> middles, const std::vector<double>& exponents);

  // The texel about this direction is to be cut into so many pieces, across and down, for the sharpest lobe that
  // reaches it.
  int pieces(const Vec3& direction) const;
  // True if the light of a block is too wide to come from one direction. `variance` of its directions, along each axis.
  bool opens(const envmap::BlockTree::Block& block, double variance) const;
  // The lobe of this exponent, blurred by a patch of this variance; far from the lobe wide patches were let through.
  BlurredLobe blurred(double exponent, double variance) const {
    const double most = most_spread_ * most_spread_ * (1 / exponent + apart2_);
    return {exponent, variance <= most ? variance : 0};
  }
  // True if a block that the horizon cuts is too wide for its mean direction to stand on one side of it.
  bool opens_at_horizon(const envmap::BlockTree::Block& block) const { return block.sine > 0.5 * most_spread_; }

 private:
  struct Reach {
    double exponent;  // softened
    int pieces;       // that a texel is cut into
    double chord2;    // within this squared distance of a middle
  };
  struct Bundle {
    std::vector<Vec3> middles;
    Vec3 axis;          // of the cap that holds them
    double radius = 0;  // its chord
    std::vector<Reach> reaches;
  };
  double texel_rad_, most_spread_, piece_;
  double apart2_ = 0;  // squared distance of the middles of a bundle, as far as it softens their lobes
  std::vector<Bundle> bundles_;
};

// The reflected radiance of one point in a paint.
class Gatherer {
 public:
  Gatherer(const SurfacePoint& point, double texel_rad, double most_spread);

  const Vec3& reflected() const { return reflected_; }
  const Grain& grain() const { return grain_; }
  // True if only what is above the horizon counts.
  bool ends_at_horizon() const { return model_.horizon; }
  const Vec3& normal() const { return point_.normal; }

  // Adds f L cos_i dw, with cos_i multiplied into f so that the gloss term needs no division.
  void add(const Patch& patch, const color::Rgb& radiance) {
    add(patch, radiance, model_.horizon, model_.map_in_image);
  }
  void add_light(const Light& light);
  // The mirror lobe, which sees this radiance.
  void add_mirror(const color::Rgb& radiance);

  const color::Rgb& sum() const { return sum_; }

 private:
  // A mirrored view, and its part of the light.
  struct Mirrored {
    Vec3 direction;
    double share;
  };
  // A lobe and the mirrored views that it stands about.
  struct Bell {
    std::vector<Mirrored> middles;
    std::vector<double> power;  // by the versine between view and light, linear between steps
    double steps = 0;           // for each unit of the versine

    double toward(const Vec3& direction) const;
  };
  void set_mirror_directions();
  // The view mirrored about a normal that is tilted by this angle.
  Vec3 mirrored_about(double tilt_rad) const;
  void make_bells();
  // With `horizon`, the direction's own cosine, and nothing from below. With `mapped`, the color map in the place of
  // the diffuse part and the flakes.
  void add(const Patch& patch, const color::Rgb& radiance, bool horizon, bool mapped);
  color::Rgb lobes_toward(const Patch& patch, const BaseLight& base, bool mapped) const;
  color::Rgb mapped_toward(const Vec3& direction) const;
  Vec3 local(const Vec3& direction) const;
  color::Rgb lobes_toward_disc(const Light& light, bool mapped) const;
  color::Rgb lobe_over_disc(const paint::Lobe& lobe, const Vec3& mirrored, const Light& light, bool mapped) const;
  void add_reflected(const color::Rgb& f, const color::Rgb& light);
  // The transmission of the coat for a disc.
  double let_in_of(const Light& light) const;
  // The transmission of the coat from there.
  double let_in(double cos_i) const {
    return paint_.coat_index == paint::kNoCoat ? 1 : brdf::coat_transmission(std::min(cos_i, 1.0), paint_.coat_index);
  }

  const SurfacePoint& point_;
  const ExactModel& model_;
  paint::LobeFit paint_;  // its base as the coat lets it out
  double cos_o_ = 1;
  Vec3 reflected_;
  Vec3 frame_x_, frame_y_, local_viewer_;  // of a color map and of facets, with the normal as z
  Vec3 tilted_along_;                      // unit: the tangent toward which tilted normals lean
  std::vector<Mirrored> mirrored_;
  std::vector<math::QuadraturePoint> tilts_;  // of each: the angle of its normal (rad) and its share
  std::vector<paint::Lobe> lobes_;            // finite exponents, ascending
  std::vector<Bell> bells_;                   // of each of lobes_; none: all of them stand about mirrored_
  Grain grain_;
  bool summed_ = false;  // whether lamps are integrated over their discs, and not looked up
  color::Rgb sum_;
};

// The reflected radiance of one point of a texture: the exact lobes of the texels around it.
class TextureGatherer {
 public:
  TextureGatherer(const TexturedPoint& point, const color::ReflectionOperator* reflection, double texel_rad,
                  double most_spread);

  const Grain& grain() const { return grain_; }
  bool ends_at_horizon() const { return true; }
  const Vec3& normal() const { return point_.normal; }
  void add(const Patch& patch, const color::Rgb& radiance);
  void add_light(const Light& light);

  const color::Rgb& sum() const { return sum_; }

 private:
  struct TexelLobe {
    Vec3 axis;    // p = C wo, in the world
    Vec3 middle;  // of length 1
    double exponent = 1, log_peak = 0;
    color::Rgb color;
    double least_cosine = 0;  // below it, nothing that counts
  };
  void add_lobe(const Vec3& axis, double exponent, const color::Rgb& albedo);

  const TexturedPoint& point_;
  const color::ReflectionOperator* reflection_;
  color::Rgb diffuse_;
  std::vector<TexelLobe> lobes_;
  Grain grain_;
  color::Rgb sum_;
};

}  // namespace goniochrome::render
