#include <algorithm>
#include <cmath>

#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"
#include "render/path/lobe_columns.h"

namespace goniochrome::render {

namespace {

using rays::Float3;

using rays::kFloatPi;

float coat_reflectance(float cosine) {
  return static_cast<float>(brdf::fresnel_dielectric(cosine, brdf::kCoatIndex));
}

}  // namespace

LobeKernels::LobeKernels(const LobeColumns& columns, const PaintedPoint& point)
    : columns_(columns), point_(point), frame_(rays::frame_about(point.normal())) {
  mirror_ = point.coat_mirror();
  if (!point.axes().empty()) axes_total_ = 0;
  for (const PaintedPoint::Axis& axis : point.axes()) axes_total_ += axis.share;
}

float LobeKernels::at(const Float3& to_light, float* values) const {
  const std::size_t lobes = columns_.exponents.size();
  std::fill_n(values, columns_.count(), 0.0F);
  const float cos_i = rays::dot(point_.normal(), to_light);
  if (!(cos_i > 0)) return 0;
  float powers[kMostTracedLobes] = {};
  const auto add = [&](const Float3& axis, float share) {
    add_powers(
        axis, to_light, share, lobes, [&](std::size_t j) { return static_cast<float>(columns_.exponents[j]); }, powers);
  };
  if (point_.axes().empty()) add(point_.mirrored(), 1);
  for (const PaintedPoint::Axis& axis : point_.axes()) add(axis.direction, axis.share);
  const float fresnel = coat_reflectance(std::min(1.0F, 0.5F * rays::length(to_light + point_.to_viewer())));
  const float base = cos_i * point_.passages(cos_i);
  values[LobeColumns::diffuse()] = base;
  float pdf = cos_i / kFloatPi;
  for (std::size_t j = 0; j < lobes; ++j) {
    if (!(powers[j] > 0)) continue;
    values[LobeColumns::flake(j)] = base * powers[j];
    values[LobeColumns::gloss(j)] = fresnel * powers[j];
    pdf += (static_cast<float>(columns_.exponents[j]) + 1) / (2 * kFloatPi) * powers[j] / axes_total_;
  }
  return pdf / static_cast<float>(lobes + 1);
}

bool LobeKernels::toward_disc(const Light& light, bool tabled, float* values) const {
  std::fill_n(values, columns_.count(), 0.0F);
  const Vec3 n = rays::vec3(point_.normal()), viewer = rays::vec3(point_.to_viewer());
  const double cosine = dot(n, light.direction), radius = light.radius_rad;
  if (cosine <= -std::sin(radius)) return false;
  const double irradiance = brdf::disc_irradiance(cosine, radius);
  const auto coat = [&](const Vec3& toward) {
    return coat_reflectance(static_cast<float>(std::min(1.0, 0.5 * length(toward + viewer))));
  };
  const double above = brdf::disc_above(cosine, radius), coat_l = above * coat(light.direction);
  const auto passages = [&](double cos_i) { return point_.passages(static_cast<float>(std::min(1.0, cos_i))); };
  // Through the coat at the mean cosine of what is seen, and for the rest of a lobe at that of its axis.
  const double passing = above > 0 ? irradiance * passages(irradiance / above) : 0;
  values[LobeColumns::diffuse()] = static_cast<float>(passing);
  const auto add = [&](const Float3& axis, double share) {
    const Vec3 r = rays::vec3(axis);
    const double chord = length(r - light.direction), coat_r = coat(r);
    const double cosine_r = std::max(0.0, dot(n, r)), cos_r = cosine_r * passages(cosine_r);
    for (std::size_t j = 0; j < columns_.exponents.size(); ++j) {
      const double exponent = columns_.exponents[j];
      const brdf::DiscLobeTable::Node of =
          tabled ? brdf::disc_lobe(exponent, radius, chord) : brdf::disc_lobe_node(exponent, radius, chord);
      values[LobeColumns::flake(j)] += static_cast<float>(share * (of.cosine[0] * passing + of.cosine[1] * cos_r));
      values[LobeColumns::gloss(j)] += static_cast<float>(share * (of.plain[0] * coat_l + of.plain[1] * coat_r));
    }
  };
  if (point_.axes().empty()) add(point_.mirrored(), 1);
  for (const PaintedPoint::Axis& axis : point_.axes()) add(axis.direction, axis.share);
  return true;
}

Float3 LobeKernels::direction(double choice, double u, double v) const {
  const std::size_t lobes = columns_.exponents.size();
  const auto a = static_cast<float>(u), b = static_cast<float>(v);
  const double scaled = choice * static_cast<double>(lobes + 1);
  const std::size_t which = std::min(lobes, static_cast<std::size_t>(scaled));
  if (which == 0) {
    const float r = std::sqrt(a), phi = 2 * kFloatPi * b;
    return (r * std::cos(phi)) * frame_.x + (r * std::sin(phi)) * frame_.y + std::sqrt(1 - a) * point_.normal();
  }
  const auto exponent = static_cast<float>(columns_.exponents[which - 1]);
  const auto& axes = point_.axes();
  if (axes.empty()) return PaintedPoint::drawn_about(point_.mirrored(), exponent, a, b);
  double at_axis = (scaled - static_cast<double>(which)) * axes_total_;
  std::size_t k = 0;
  while (k + 1 < axes.size() && at_axis >= axes[k].share) at_axis -= axes[k++].share;
  return PaintedPoint::drawn_about(axes[k].direction, exponent, a, b);
}

}  // namespace goniochrome::render
