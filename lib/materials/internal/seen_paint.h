// A paint as a table holds it, seen from one angle: in three channels or in bands of wavelength.
#pragma once

#include <algorithm>
#include <array>

#include "brdf/lobe_model.h"
#include "materials/internal/shown.h"
#include "materials/internal/widened_mirror.h"
#include "paint/band_lobes.h"

namespace goniochrome::materials {

// A direction below the horizon, raised to it; others stay.
Vec3 raised(const Vec3& light);

// A paint seen from one angle, whose values are f cos(theta_light) with the widened mirror: in Rec.709, or in bands.
template <std::size_t kChannels>
class SeenPaint {
 public:
  using Values = std::array<double, kChannels>;

  SeenPaint(double coat_index, double view_rad)
      : coat_index_(coat_index), view_(direction(view_rad, 0)), mirror_scale_(1 / (4 * mirror_area(view_.z))) {}
  virtual ~SeenPaint() = default;
  const Vec3& view() const { return view_; }

  // Below the horizon what stands just above it goes on, so that the cells there interpolate well.
  Values operator()(Vec3 light, const Vec3& half, double half_rad) const {
    light = raised(light);
    const double fresnel =
        brdf::fresnel_dielectric(std::clamp(dot(view_, half), 0.0, 1.0), brdf::mirror_index(coat_index_));
    return values(light, mirror_scale_ * fresnel * mirror_peak(half_rad));
  }

 protected:
  // `mirror` is what a mirror of weight 1 shows.
  virtual Values values(const Vec3& light, double mirror) const = 0;

 private:
  double coat_index_;
  Vec3 view_;
  double mirror_scale_;
};

class SeenRgb final : public SeenPaint<3> {
 public:
  static constexpr std::array<double, 3> kLuminance = {0.2126, 0.7152, 0.0722};  // of Rec.709

  SeenRgb(const paint::LobeFit& lobes, double view_rad);

 private:
  Values values(const Vec3& light, double mirror) const override;

  const paint::LobeFit& lobes_;
  color::Rgb mirror_;
};

class SeenBands final : public SeenPaint<color::kBands> {
 public:
  SeenBands(const paint::BandLobes& lobes, double view_rad);

  // f without the mirror, and the weight of the mirror.
  color::Bands without_mirror(const Vec3& light) const;
  const color::Bands& mirror() const { return weights_.mirror; }

 private:
  Values values(const Vec3& light, double mirror) const override;

  const paint::BandLobes& lobes_;
  paint::BandWeights weights_;
};

}  // namespace goniochrome::materials
