// Light that comes from a small part of all around, and what lobes and matt bases make of it.
// goniochrome-plan(7), "Sums over blocks".
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brdf/lobe_model.h"
#include "color/color.h"

namespace goniochrome::render {

// The piece of a texel, or all that a block of texels holds.
struct Patch {
  Vec3 direction;  // of its light in the mean, unit
  double solid_angle_sr;
  double variance = 0;  // of its directions, along each axis (rad^2)
  // How far the mean directions of R, G and B are from `direction`, as vectors across it; null: all are there.
  const std::array<Vec3, 3>* of_channels = nullptr;

  // The light along an axis.
  color::Rgb along(const Vec3& axis) const {
    if (of_channels == nullptr) return {};
    return {dot((*of_channels)[0], axis), dot((*of_channels)[1], axis), dot((*of_channels)[2], axis)};
  }
};

inline color::Rgb at_least_0(const color::Rgb& c) {
  return {std::max(0.0, c.x), std::max(0.0, c.y), std::max(0.0, c.z)};
}

// A lobe cos^E as a patch of this variance blurs it: peak cos^exponent (1 + bend (1/cos^2 - 1 + 2 ln cos)). It is right
// to the first order in the variance and, for a sharp lobe, which is a Gaussian, beyond. Variance 0: the lobe as it is.
struct BlurredLobe {
  static constexpr double kTail = 25;  // cos^E below exp(-kTail) is left out: 1e-11 of the peak

  BlurredLobe(double sharpness, double patch_variance)
      : peak(1 / (1 + sharpness * patch_variance)),
        exponent(peak * sharpness + (1 - peak)),
        variance(patch_variance),
        bend(0.5 * sharpness * (sharpness - 1) * patch_variance) {}
  double peak, exponent, variance, bend;
};

// The light of a patch on a matt base under a coat, with its cosine; nothing where the patch lies below the horizon.
class BaseLight {
 public:
  // Light of one direction of this cosine everywhere.
  BaseLight(double cosine, double coat_index) : mean_(cosine * brdf::coat_transmission(cosine, coat_index)) {}
  BaseLight(const Patch& patch, const Vec3& normal, double coat_index) : cosine_(dot(normal, patch.direction)) {
    if (!(cosine_ > 0)) return;
    if (patch.variance == 0) {
      mean_ = cosine_ * brdf::coat_transmission(std::min(cosine_, 1.0), coat_index);
      return;
    }
    const brdf::CoatedCosine at = brdf::coated_cosine(std::min(cosine_, 1.0), coat_index);
    mean_ = at.value + patch.variance * (0.5 * at.bend * (1 - cosine_ * cosine_) - at.slope * cosine_);
    slope_ = at.slope;
    along_ = patch.along(normal);
  }

  double cosine() const { return cosine_; }
  // The mean for light whose cosine is more by so much.
  color::Rgb mean(double more = 0) const {
    const double mean = mean_ + slope_ * more;
    return at_least_0(color::Rgb{mean, mean, mean} + slope_ * along_);
  }

 private:
  double cosine_ = 0, mean_ = 0, slope_ = 0;
  color::Rgb along_;
};

// A patch as the lobes about one middle meet it.
class LobeLight {
 public:
  LobeLight(const Patch& patch, const Vec3& middle, const Vec3& normal)
      : normal_to_middle_(dot(normal, middle)), spread_(std::sqrt(patch.variance)) {
    // By the versine, which keeps its digits where the angle is small.
    const Vec3 apart = middle - patch.direction;
    const double versine = 0.5 * dot(apart, apart);
    cosine_ = 1 - versine;
    if (cosine_ > 0) log_cos_ = std::log1p(-versine);
    if (spread_ == 0) return;
    // Where the lobe is farther off than the patch is wide, it does not change evenly over the patch.
    secant_ = 1 / std::max(cosine_, spread_);
    far_ = secant_ * secant_ - 1 + 2 * log_cos_;
    along_ = secant_ * patch.along(middle);
  }

  // The lobe's mean. A patch that reaches to where the lobe ends is even along the way there.
  color::Rgb mean(const BlurredLobe& lobe) const {
    if (lobe.variance == 0) {
      const double mean =
          cosine_ > 0 && lobe.exponent * log_cos_ > -BlurredLobe::kTail ? std::exp(lobe.exponent * log_cos_) : 0;
      return {mean, mean, mean};
    }
    const double reach = std::numbers::sqrt3 * spread_, last = cosine_ + reach;
    double mean = 0;
    if (cosine_ >= reach) {
      const double log = lobe.exponent * log_cos_;
      if (log < -BlurredLobe::kTail) return {};
      mean = lobe.peak * std::exp(log) * (1 + lobe.bend * far_);
    } else if (last > 0) {
      mean = lobe.peak * std::pow(last, lobe.exponent + 1) / (2 * reach * (lobe.exponent + 1));
    }
    return mean * at_least_0(color::Rgb{1, 1, 1} + lobe.exponent * along_);
  }

  // How much the mean cosine of the light that the lobe takes is more than that of the patch: it takes more where it is
  // larger.
  double more_cosine(const BlurredLobe& lobe, const BaseLight& base) const {
    return lobe.variance * lobe.exponent * (normal_to_middle_ * secant_ - base.cosine());
  }

 private:
  double normal_to_middle_, spread_, cosine_ = 0, log_cos_ = 0, secant_ = 0, far_ = 0;
  color::Rgb along_;
};

}  // namespace goniochrome::render
