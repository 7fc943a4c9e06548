#include "render/path/traced_paint.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/angles.h"
#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"
#include "render/scene.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::float3;

using rays::kFloatPi;

// The share of a color map's mean that directions are drawn in by the cosine.
constexpr float kCosineShare = 0.25F;
// cos^E below exp(-kPowerTail) is left out: 4e-18 of the peak.
constexpr float kPowerTail = 40;

float mean_size(const Float3& c) {
  return (std::abs(c.x) + std::abs(c.y) + std::abs(c.z)) / 3;
}

bool is_finite(const color::Rgb& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// fresnel_dielectric(), in floats.
float coat_reflectance(float cosine, double index = brdf::kCoatIndex) {
  const auto n2 = static_cast<float>(index * index);
  const float contrast = n2 - 1, g = std::sqrt(contrast + cosine * cosine), s = cosine + g, p = n2 * cosine + g;
  const float r_s = contrast / (s * s), r_p = contrast * ((n2 + 1) * cosine * cosine - 1) / (p * p);
  return 0.5F * (r_s * r_s + r_p * r_p);
}

Float3 blend(const Float3& a, const Float3& b, float share) {
  return (1 - share) * a + share * b;
}

}  // namespace

Result<TracedPaint> TracedPaint::create(const paint::LobeFit& paint, double gloss_deg, std::vector<brdf::Tilt> tilts) {
  std::set<double> exponents;
  const auto gather = [&](const std::vector<paint::Lobe>& lobes) -> Result<void> {
    for (const paint::Lobe& lobe : lobes) {
      if (!(lobe.exponent >= 0)) return input_error("a lobe of exponent {}: it must be 0 or more", lobe.exponent);
      if (!is_finite(lobe.directional_diffuse) || !is_finite(lobe.gloss))
        return input_error("a weight of the lobe of exponent {} is not finite", lobe.exponent);
      if (!lobe.is_mirror() && (lobe.directional_diffuse != color::Rgb{} || lobe.gloss != color::Rgb{}))
        exponents.insert(lobe.exponent);
    }
    return {};
  };
  std::vector<paint::ViewLobes> views = paint.views;
  if (views.empty()) views.push_back({0, paint.diffuse, paint.lobes});
  for (const paint::ViewLobes& view : views) {
    GONIO_TRY(gather(view.lobes));
    if (!is_finite(view.diffuse)) return input_error("a diffuse weight is not finite");
  }
  if (exponents.size() > kMostTracedLobes)
    return input_error("a paint of {} lobes: paths trace at most {}; fit it to a smaller basis", exponents.size(),
                       kMostTracedLobes);
  TracedPaint traced;
  if (tilts.size() > 1) traced.tilts_ = std::move(tilts);
  traced.coat_index_ = paint.coat_index;
  const double gloss_scale = 1 / brdf::fresnel_dielectric(std::cos(gloss_deg * kDegree), brdf::kCoatIndex);
  for (const paint::ViewLobes& view : views) {
    Weights weights{static_cast<float>(view.view_deg), float3(view.diffuse), {}, {}};
    for (const double exponent : exponents) {
      Lobe lobe{static_cast<float>(exponent), static_cast<float>((exponent + 1) / (2 * kFloatPi)), {}, {}};
      for (const paint::Lobe& given : view.lobes) {
        if (given.exponent != exponent) continue;
        lobe.directional_diffuse = float3(given.directional_diffuse);
        lobe.gloss = float3(gloss_scale * given.gloss);
      }
      weights.lobes.push_back(lobe);
    }
    for (const paint::Lobe& given : view.lobes)
      if (given.is_mirror()) weights.mirror = float3(given.gloss);
    traced.views_.push_back(std::move(weights));
  }
  return traced;
}

void TracedPaint::put_coat(const paint::LobeFit& paint, double gloss_deg) {
  if (!tilts_.empty() || hidden_) return;
  const std::optional<brdf::RoughCoat> coat = brdf::coat_of_lobes(paint, gloss_deg);
  if (!coat) return;
  coat_.emplace(*coat, brdf::mirror_index(paint.coat_index));
  for (Weights& view : views_) {
    view.mirror = {};
    for (Lobe& lobe : view.lobes) lobe.gloss = {};
  }
}

PaintedPoint::PaintedPoint(const TracedPaint& paint, const Float3& normal, const Float3& to_viewer)
    : normal_(normal), viewer_(to_viewer), frame_(rays::frame_about(normal)) {
  cos_o_ = std::max(rays::dot(normal, to_viewer), 1e-6F);
  mirrored_ = 2 * cos_o_ * normal - to_viewer;
  const TracedPaint::Weights *low = &paint.views_.front(), *high = low;
  float share = 0;
  if (paint.views_.size() > 1) {
    const Float3 across = rays::cross(normal, to_viewer);
    const float view_deg = std::atan2(rays::length(across), cos_o_) * (180 / kFloatPi);
    const auto above = std::ranges::upper_bound(paint.views_, view_deg, {}, &TracedPaint::Weights::view_deg);
    high = above == paint.views_.end() ? &paint.views_.back() : &*above;
    low = above == paint.views_.begin() ? high : &above[-1];
    if (high != low && high->view_deg > low->view_deg)
      share = std::clamp((view_deg - low->view_deg) / (high->view_deg - low->view_deg), 0.0F, 1.0F);
    between_ = {static_cast<std::size_t>(low - paint.views_.data()),
                static_cast<std::size_t>(high - paint.views_.data()), share};
  }
  coat_index_ = paint.coat_index_;
  let_out_ = let_in(cos_o_);
  diffuse_ = let_out_ * blend(low->diffuse, high->diffuse, share);
  const float fresnel = coat_reflectance(cos_o_);
  mirror_ = coat_mirror() * blend(low->mirror, high->mirror, share);
  diffuse_chance_ = kFloatPi * mean_size(diffuse_);
  if (paint.map_ != nullptr) {
    // The lobes stand for the map where directions are drawn. What they miss the cosine finds.
    paint_ = &paint;
    diffuse_chance_ = std::max(diffuse_chance_, kCosineShare * paint.map_level_);
    diffuse_ = {};
  }
  if (paint.coat_) coat_ = &*paint.coat_, coat_chance_ = coat_mirror();
  total_ = diffuse_chance_ + coat_chance_;
  for (std::size_t j = 0; j < low->lobes.size(); ++j) {
    Lobe& lobe = lobes_[count_];
    lobe.number = static_cast<int>(j);
    lobe.exponent = low->lobes[j].exponent, lobe.normalization = low->lobes[j].normalization;
    lobe.directional_diffuse =
        let_out_ * blend(low->lobes[j].directional_diffuse, high->lobes[j].directional_diffuse, share);
    lobe.gloss = blend(low->lobes[j].gloss, high->lobes[j].gloss, share);
    // A wide lobe looks where cosines are larger than that of the mirror direction.
    const float wide = 1 / std::sqrt(lobe.exponent + 2), cosine = cos_o_ + (1 - cos_o_) * wide;
    lobe.chance = (cosine * mean_size(lobe.directional_diffuse) + fresnel * mean_size(lobe.gloss)) / lobe.normalization;
    if (!(lobe.chance > 0)) continue;
    if (paint_ != nullptr) lobe.directional_diffuse = {};
    total_ += lobe.chance;
    ++count_;
  }
  set_axes(paint.tilts_);
}

PaintedPoint::PaintedPoint(const Float3& diffuse, const Float3& normal, const Float3& to_viewer)
    : normal_(normal), viewer_(to_viewer), diffuse_(diffuse), frame_(rays::frame_about(normal)) {
  cos_o_ = std::max(rays::dot(normal, to_viewer), 1e-6F);
  mirrored_ = 2 * cos_o_ * normal - to_viewer;
  total_ = diffuse_chance_ = kPi * mean_size(diffuse_);
}

// The frame of Gatherer::set_mirror_directions(): the tangent runs level around +Y, on a level surface along +X.
void PaintedPoint::set_axes(const std::vector<brdf::Tilt>& tilts) {
  if (tilts.empty()) return;
  const Vec3 n = rays::vec3(normal_), viewer = rays::vec3(viewer_);
  const double level2 = n.x * n.x + n.z * n.z;
  const Vec3 x = level2 > 1e-12 ? normalized({n.z, 0, -n.x}) : Vec3{1, 0, 0}, y = cross(n, x);
  axes_total_ = 0;
  for (const brdf::Tilt& tilt : tilts) {
    const Vec3 m = tilt.normal.x * x + tilt.normal.y * y + tilt.normal.z * n;
    const double cos_m = dot(m, viewer);
    const Vec3 r = 2 * cos_m * m - viewer;
    if (cos_m <= 0 || dot(r, n) <= 0) continue;
    axes_.push_back({float3(r), static_cast<float>(tilt.weight)});
    axes_total_ += static_cast<float>(tilt.weight);
  }
  if (axes_.empty()) {  // every tilt looks down: the lobes show nothing
    count_ = 0;
    total_ = diffuse_chance_;
  }
}

float PaintedPoint::let_in(float cos_i) const {
  return coat_index_ == paint::kNoCoat ? 1 : 1 - coat_reflectance(cos_i, coat_index_);
}

float PaintedPoint::coat_mirror() const {
  return coat_reflectance(cos_o_, brdf::mirror_index(coat_index_));
}

Vec3 PaintedPoint::local(const Float3& direction) const {
  return {rays::dot(direction, frame_.x), rays::dot(direction, frame_.y), rays::dot(direction, normal_)};
}

Float3 PaintedPoint::coat_direction(double choice, float u, float v) const {
  const Float3 drawn = float3(coat_->drawn(local(viewer_), choice, u, v));
  return drawn.x * frame_.x + drawn.y * frame_.y + drawn.z * normal_;
}

float PaintedPoint::mirror_weight() const {
  return mean_size(mirror_);
}

float PaintedPoint::narrow_share(double light_sr) const {
  if (!(total_ > 0)) return 0;
  const auto narrow = [light_sr](float normalization) {
    return static_cast<float>(light_sr / (light_sr + 1 / normalization));
  };
  float sum = diffuse_chance_ * narrow(1 / kFloatPi);
  if (coat_ != nullptr) sum += coat_chance_ * static_cast<float>(coat_->narrow_share(light_sr, cos_o_));
  for (int j = 0; j < count_; ++j) sum += lobes_[j].chance * narrow(lobes_[j].normalization);
  for (const TexelLobe& lobe : texels_) sum += lobe.chance * narrow(lobe.normalization);
  return sum / total_;
}

// Calls visit(lobe, factor of its K_DD, factor of its K_G) for lobes whose sum over axes of share cos^E is not 0.
template <class Visit>
PaintedPoint::Factors PaintedPoint::factors(const Float3& to_light, const Visit& visit) const {
  Factors factors;
  const float cos_i = rays::dot(normal_, to_light);
  if (!(cos_i > 0)) return factors;
  factors.base = let_in(cos_i) * cos_i;
  factors.pdf = diffuse_chance_ * cos_i / kFloatPi;
  if (coat_ != nullptr) {
    const brdf::CoatFacets::Sent sent = coat_->sent(local(to_light), local(viewer_));
    factors.coat = static_cast<float>(sent.f_cos);
    factors.pdf += coat_chance_ * static_cast<float>(sent.pdf);
  }
  if (count_ == 0) return factors;
  const float fresnel = coat_reflectance(std::min(1.0F, 0.5F * rays::length(to_light + viewer_)));
  float powers[kMostTracedLobes] = {};
  const auto add = [&](const Float3& axis, float share) {
    const Float3 apart = axis - to_light;
    const float versine = 0.5F * rays::dot(apart, apart);
    if (versine >= 1) return;
    const float log_cos = std::log1p(-versine);
    for (int j = 0; j < count_; ++j) {  // ascending exponents
      const float power = lobes_[j].exponent * log_cos;
      if (power < -kPowerTail) break;
      powers[j] += share * std::exp(power);
    }
  };
  if (axes_.empty()) add(mirrored_, 1);
  for (const Axis& axis : axes_) add(axis.direction, axis.share);
  for (int j = 0; j < count_; ++j) {
    if (!(powers[j] > 0)) continue;
    visit(lobes_[j], powers[j] * factors.base, powers[j] * fresnel);
    factors.pdf += lobes_[j].chance * lobes_[j].normalization * powers[j] / axes_total_;
  }
  return factors;
}

// Calls visit(lobe, factor of its K_DD, factor of its K_G) for each lobe and axis.
template <class Visit>
float PaintedPoint::disc_factors(const Light& light, bool tabled, const Visit& visit) const {
  const Vec3 n = rays::vec3(normal_), viewer = rays::vec3(viewer_);
  const double cosine = dot(n, light.direction), radius = light.radius_rad;
  const double irradiance = brdf::disc_irradiance(cosine, radius), above = brdf::disc_above(cosine, radius);
  // Through the coat at the mean cosine of what is seen, and for the rest of a lobe at that of its axis.
  const auto passing =
      static_cast<float>(above > 0 ? irradiance * let_in(static_cast<float>(std::min(1.0, irradiance / above))) : 0);
  const auto coat = [&](const Vec3& toward) {
    return coat_reflectance(static_cast<float>(std::min(1.0, 0.5 * length(toward + viewer))));
  };
  const auto coat_l = static_cast<float>(above) * coat(light.direction);
  const auto visit_lobes = [&](const Float3& axis, float share) {
    const Vec3 r = rays::vec3(axis);
    const double chord = length(r - light.direction);
    const auto cosine_r = static_cast<float>(std::max(0.0, dot(n, r)));
    const float cos_r = cosine_r * let_in(std::min(1.0F, cosine_r)), coat_r = coat(r);
    for (int j = 0; j < count_; ++j) {
      const double exponent = lobes_[j].exponent;
      const brdf::DiscLobeTable::Node of =
          tabled ? brdf::disc_lobe(exponent, radius, chord) : brdf::disc_lobe_node(exponent, radius, chord);
      visit(lobes_[j], share * (of.cosine[0] * passing + of.cosine[1] * cos_r),
            share * (of.plain[0] * coat_l + of.plain[1] * coat_r));
    }
  };
  if (axes_.empty()) visit_lobes(mirrored_, 1);
  for (const Axis& axis : axes_) visit_lobes(axis.direction, axis.share);
  return passing;
}

// Calls visit(lobe, cos^E).
template <class Visit>
void PaintedPoint::visit_texels(const Float3& to_light, const Visit& visit) const {
  for (const TexelLobe& lobe : texels_) {
    const Float3 apart = lobe.axis - to_light;
    const float versine = 0.5F * rays::dot(apart, apart);
    if (versine >= 1) continue;
    const float power = lobe.exponent * std::log1p(-versine);
    if (power >= -kPowerTail) visit(lobe, std::exp(power));
  }
}

PaintedPoint::Parts PaintedPoint::parts(const Float3& to_light) const {
  Parts parts;
  if (!faces(to_light) || !(total_ > 0)) return parts;
  const Factors factors = this->factors(to_light, [&](const Lobe& lobe, float base, float coat) {
    parts.lobes = parts.lobes + base * lobe.directional_diffuse;
    parts.gloss = parts.gloss + coat * lobe.gloss;
  });
  const float cos_i = std::max(rays::dot(normal_, to_light), 0.0F), off_coat = bare_ * factors.coat;
  parts.pdf = factors.pdf;
  parts.diffuse = factors.base * diffuse_ + cos_i * texel_diffuse_;
  parts.gloss = parts.gloss + Float3{off_coat, off_coat, off_coat};
  parts.lobes = parts.lobes + parts.gloss;
  if (paint_ != nullptr && cos_i > 0) parts.lobes = parts.lobes + mapped(to_light);
  visit_texels(to_light, [&](const TexelLobe& lobe, float power) {
    parts.lobes = parts.lobes + (std::exp(lobe.log_peak) * power * lobe.cosine(to_light)) * lobe.color;
    parts.pdf += lobe.chance * lobe.normalization * power;
  });
  parts.pdf /= total_;
  return parts;
}

PaintedPoint::Shares PaintedPoint::shares(const Float3& to_light) const {
  Shares shares;
  if (!(total_ > 0)) return shares;
  const Factors factors = this->factors(to_light, [&](const Lobe& lobe, float base, float coat) {
    shares.of[1 + 2 * lobe.number] = let_out_ * base;
    shares.of[2 + 2 * lobe.number] = coat;
  });
  shares.of[0] = let_out_ * factors.base, shares.coat = factors.coat;
  shares.pdf = factors.pdf / total_;
  return shares;
}

PaintedPoint::Shares PaintedPoint::disc_shares(const Light& light, bool tabled) const {
  Shares shares;
  if (dot(rays::vec3(normal_), light.direction) <= -std::sin(light.radius_rad)) return shares;
  shares.of[0] = let_out_ * disc_factors(light, tabled, [&](const Lobe& lobe, float base, float coat) {
                   shares.of[1 + 2 * lobe.number] += let_out_ * base;
                   shares.of[2 + 2 * lobe.number] += coat;
                 });
  return shares;
}

PaintedPoint PaintedPoint::of_basis(std::span<const double> exponents) const {
  PaintedPoint basis({1, 1, 1}, normal_, viewer_);
  const float chance = coat_mirror();
  basis.coat_index_ = coat_index_, basis.let_out_ = let_out_;
  basis.diffuse_ = {let_out_, let_out_, let_out_}, basis.mirror_ = {chance, chance, chance};
  basis.axes_ = axes_, basis.axes_total_ = axes_.empty() ? 1 : axes_total_;
  const float even = (1 - kOwnShare) * chance,
              own = total_ > 0 ? kOwnShare * chance * static_cast<float>(exponents.size() + 1) / total_ : 0;
  basis.diffuse_chance_ = basis.total_ = even + own * diffuse_chance_;
  int j = 0;
  for (const double exponent : exponents) {
    const auto e = static_cast<float>(exponent);
    float both = even;
    if (j < count_ && lobes_[j].exponent == e) both += own * lobes_[j++].chance;
    basis.lobes_[basis.count_] = {e, (e + 1) / (2 * kFloatPi), both, basis.diffuse_, {1, 1, 1}, basis.count_};
    ++basis.count_, basis.total_ += both;
  }
  return basis;
}

std::optional<std::vector<PaintedPoint::WideLobe>> PaintedPoint::wide_lobes(float sharpest, std::size_t most) const {
  const bool textured = !texels_.empty() || mean_size(texel_diffuse_) > 0;
  if (!axes_.empty() || coat_ != nullptr || paint_ != nullptr || textured) return std::nullopt;
  std::vector<WideLobe> wide;
  for (int j = 0; j < count_ && wide.size() < most && lobes_[j].exponent <= sharpest; ++j)
    wide.push_back({lobes_[j].exponent, lobes_[j].directional_diffuse, lobes_[j].gloss});
  return wide;
}

PaintedPoint PaintedPoint::without_wide(std::size_t lobes) const {
  PaintedPoint rest = *this;
  rest.diffuse_ = {}, rest.diffuse_chance_ = rest.total_ = 0;
  rest.count_ -= static_cast<int>(lobes);
  std::copy(lobes_ + lobes, lobes_ + count_, rest.lobes_);
  for (int j = 0; j < rest.count_; ++j) rest.total_ += rest.lobes_[j].chance;
  return rest;
}

Float3 PaintedPoint::toward_disc(const Light& light, bool tabled) const {
  const Vec3 n = rays::vec3(normal_);
  const double cosine = dot(n, light.direction), radius = light.radius_rad;
  const auto add_texels = [&](Float3 f) {
    for (const TexelLobe& lobe : texels_) {
      const Vec3 axis = rays::vec3(lobe.axis), normal = rays::vec3(lobe.normal);
      const double irradiance = brdf::disc_irradiance(dot(normal, light.direction), radius);
      const double between = 2 * std::asin(std::min(1.0, 0.5 * length(axis - light.direction)));
      const brdf::LobeOfDisc of = brdf::lobe_of_disc(lobe.exponent, radius, between);
      const double gathered =
          lobe.matt ? irradiance : of.by_light * irradiance + of.by_mirror * std::max(0.0, dot(normal, axis));
      f = f + (std::exp(lobe.log_peak) * static_cast<float>(gathered)) * lobe.color;
    }
    return f;
  };
  if (cosine <= -std::sin(radius)) return bent_ ? add_texels({}) : Float3{};
  Float3 lobes;
  const float base = disc_factors(light, tabled, [&](const Lobe& lobe, float under_coat, float coat) {
    lobes = lobes + under_coat * lobe.directional_diffuse + coat * lobe.gloss;
  });
  const auto irradiance = static_cast<float>(brdf::disc_irradiance(cosine, radius));
  Float3 f = base * diffuse_ + irradiance * texel_diffuse_ + lobes;
  if (paint_ != nullptr) {
    for (const DiscDirection& part : disc_directions(light))
      if (dot(n, part.direction) > 0) f = f + static_cast<float>(part.weight) * mapped(float3(part.direction));
  }
  if (coat_ != nullptr) {
    const Vec3 middle = local(float3(light.direction));
    const float gray = bare_ * static_cast<float>(coat_->over_disc(local(viewer_), normalized(middle), radius));
    f = f + Float3{gray, gray, gray};
  }
  return add_texels(f);
}

// cos = u^(1/(E+1)); 1 - cos without cancellation, so that lobes of any sharpness keep their shape.
Float3 PaintedPoint::drawn_about(const Float3& axis, float exponent, float u, float v) {
  const float versine = u > 0 ? -std::expm1(std::log(u) / (exponent + 1)) : 1;
  const float sine = std::sqrt(std::max(0.0F, versine * (2 - versine))), phi = 2 * kFloatPi * v;
  const rays::Frame frame = rays::frame_about(axis);
  return (sine * std::cos(phi)) * frame.x + (sine * std::sin(phi)) * frame.y + (1 - versine) * axis;
}

Float3 PaintedPoint::direction(double choice, double u, double v) const {
  const auto a = static_cast<float>(u), b = static_cast<float>(v);
  double left = choice * total_;
  if (left < diffuse_chance_ || (count_ == 0 && texels_.empty() && coat_ == nullptr)) {
    const float r = std::sqrt(a), phi = 2 * kFloatPi * b;
    return (r * std::cos(phi)) * frame_.x + (r * std::sin(phi)) * frame_.y + std::sqrt(1 - a) * normal_;
  }
  left -= diffuse_chance_;
  if (coat_ != nullptr) {
    if (left < coat_chance_ || (count_ == 0 && texels_.empty()))
      return coat_direction(std::min(left / coat_chance_, 1.0), a, b);
    left -= coat_chance_;
  }
  if (!texels_.empty()) {
    std::size_t k = 0;
    while (k < texels_.size() && left >= texels_[k].chance) left -= texels_[k++].chance;
    if (k == texels_.size() && count_ == 0) --k;
    if (k < texels_.size()) return drawn_about(texels_[k].axis, texels_[k].exponent, a, b);
  }
  int j = 0;
  while (j + 1 < count_ && left >= lobes_[j].chance) left -= lobes_[j++].chance;
  if (axes_.empty()) return drawn_about(mirrored_, lobes_[j].exponent, a, b);
  double at_axis = std::clamp(left / lobes_[j].chance, 0.0, 1.0) * axes_total_;
  std::size_t k = 0;
  while (k + 1 < axes_.size() && at_axis >= axes_[k].share) at_axis -= axes_[k++].share;
  return drawn_about(axes_[k].direction, lobes_[j].exponent, a, b);
}

}  // namespace goniochrome::render
