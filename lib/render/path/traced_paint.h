// Paints as paths meet them: evaluated and sampled in floats. goniochrome-theory(7), PATHS and LOBE MODEL.
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "brdf/ward.h"
#include "paint/paint.h"
#include "rays/float3.h"

namespace goniochrome::render {

// The most lobes of a paint, the mirror apart.
constexpr int kMostTracedLobes = 24;

// A paint laid out for tracing. What it shows is ExactModel's (render/reference.h) with the Fresnel reflectance on:
//   f cos_i = cos_i (K_D + sum K_DD cos^E) + F(theta_h)/F(gloss_deg) sum K_G cos^E,  mirror K_M F(theta_o)
// above the horizon, nothing below it. Of an anisotropic paint each lobe is the mean over tilted normals.
class TracedPaint {
 public:
  // `tilts`: as ward_tilts() returns them; one or none: isotropic. Error: more than kMostTracedLobes lobes, a weight
  // that is not finite, an exponent below 0.
  static Result<TracedPaint> create(const paint::LobeFit& paint, double gloss_deg, std::vector<brdf::Tilt> tilts);

  // Whether it sends back more light than it gets, in some channel to some viewer. Its diffuse part is known exactly,
  // that of its lobes by quadrature to 1 %: a paint is told whose sum is beyond 1 by more than that.
  bool gains_light() const;

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
  std::vector<Weights> views_;     // one, or ascending in view_deg
  std::vector<brdf::Tilt> tilts_;  // none: isotropic
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
  // Unit vectors with n.o > 0. The paint must outlive the point.
  PaintedPoint(const TracedPaint& paint, const rays::Float3& normal, const rays::Float3& to_viewer);
  // A matt point of this K_D, in 1/sr.
  PaintedPoint(const rays::Float3& diffuse, const rays::Float3& normal, const rays::Float3& to_viewer);

  // f cos_i and the density.
  Reflection at(const rays::Float3& to_light) const;
  // The parts of f cos_i by themselves: that of the constant K_D, and that of the lobes.
  struct Parts {
    rays::Float3 diffuse, lobes;
  };
  Parts parts(const rays::Float3& to_light) const;

  // A direction drawn by numbers in [0,1). `choice` says which lobe. It may lie below the horizon. The point is not
  // black.
  rays::Float3 direction(double choice, double u, double v) const;
  Reflection drawn(double choice, double u, double v) const {
    return total_ > 0 ? at(direction(choice, u, v)) : Reflection{};
  }

  const rays::Float3& normal() const { return normal_; }
  const rays::Float3& mirrored() const { return mirrored_; }  // where the mirror lobe looks
  const rays::Float3& mirror() const { return mirror_; }      // K_M F
  const rays::Float3& diffuse() const { return diffuse_; }    // K_D, 1/sr
  // About what part of even light each sends back, mean of the channels: what samples are shared out by.
  float lobes_weight() const { return total_; }
  float mirror_weight() const;
  // The same for all lobes narrower than a light of this extent in sr, as a part of lobes_weight(): lobes that find the
  // light better than the light finds them.
  float narrow_share(double light_sr) const;
  bool black() const { return !(total_ > 0) && mirror_.x == 0 && mirror_.y == 0 && mirror_.z == 0; }

 private:
  struct Lobe {
    float exponent, normalization, chance;
    rays::Float3 directional_diffuse, gloss;
  };
  struct Axis {
    rays::Float3 direction;
    float share;
  };
  static rays::Float3 drawn_about(const rays::Float3& axis, float exponent, float u, float v);
  void set_axes(const std::vector<brdf::Tilt>& tilts);
  template <class Visit>
  void visit_lobes(const rays::Float3& to_light, const Visit& visit) const;

  rays::Float3 normal_, viewer_, mirrored_, mirror_, diffuse_;
  rays::Frame frame_;
  float cos_o_ = 1, diffuse_chance_ = 0, total_ = 0;
  int count_ = 0;
  Lobe lobes_[kMostTracedLobes];
  std::vector<Axis> axes_;  // of tilts; none: mirrored_ alone
  float axes_total_ = 1;
};

}  // namespace goniochrome::render
