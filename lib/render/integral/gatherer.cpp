#include "render/integral/gatherer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/angles.h"
#include "brdf/disc_light.h"
#include "math/cosine_power.h"
#include "math/quadrature.h"

namespace goniochrome::render {

namespace {

constexpr double kTail = BlurredLobe::kTail;
// A texel is cut into pieces of at most this many standard deviations (1/sqrt E) of the sharpest lobe that reaches it.
// The midpoint rule then errs by (1/4)^2/24 of the value on a patch, and far less in the sum over smooth radiance.
constexpr double kPiece = 0.25;
constexpr double kLargestLog = 700;  // exp of it is finite
// Where blocks may be this wide, so may pieces, in standard deviations of a block's light. A square of as much variance
// would be sqrt(12) wide, but a piece counts as of one direction.
constexpr double kPieceOfBlock = 2.4;
// The variance that a block may have for the base under a coat, relative to that for a lobe of exponent 1 about its
// middle: the coat bends the cosine law.
constexpr double kBaseOfLobe = 0.47;

const ExactModel& model_of(const SurfacePoint& point) {
  static const ExactModel bare;
  return point.model != nullptr ? *point.model : bare;
}

double view_deg(const SurfacePoint& point) {
  return std::atan2(length(cross(point.normal, point.to_viewer)), dot(point.normal, point.to_viewer)) / kDegree;
}

// The most that a lobe exp(-q) bends, over all that is farther from its middle than q, relative to its bend there:
// (1 + 2q) exp(-q), in steps.
double bend_beyond(double q) {
  constexpr double kSteps[][2] = {{1.5, 1}, {3, 0.9}, {5, 0.36}, {8, 0.08}, {12, 0.006}};
  for (const auto& [end, bend] : kSteps) {
    if (q < end) return bend;
  }
  return 0;
}

}  // namespace

Grain::Grain(double texel_rad, double most_spread)
    : texel_rad_(texel_rad), most_spread_(most_spread), piece_(std::max(kPiece, kPieceOfBlock * most_spread)) {}

void Grain::add(std::vector<Vec3> middles, const std::vector<double>& exponents) {
  Bundle bundle{std::move(middles), {}, 0, {}};
  for (const Vec3& middle : bundle.middles) bundle.axis += middle;
  bundle.axis = length(bundle.axis) > 0 ? normalized(bundle.axis) : Vec3{0, 1, 0};
  for (const Vec3& middle : bundle.middles) bundle.radius = std::max(bundle.radius, length(middle - bundle.axis));
  if (bundle.middles.size() > 1) {
    // Evenly over the cap they stand radius sqrt(pi / n) apart; a quarter of it, since they lie closer in its middle.
    const double apart = 0.25 * bundle.radius * std::sqrt(kPi / static_cast<double>(bundle.middles.size()));
    apart2_ = apart * apart;
  }
  for (const double exponent : exponents) {
    // cos^E = exp(-kTail) at this angle; a texel whose center is that far and its own extent has nothing to give.
    const double reach_rad = std::acos(std::exp(-kTail / exponent)) + texel_rad_;
    const double chord = 2 * std::sin(0.5 * std::min(reach_rad, kPi));
    const int pieces = std::max(1, static_cast<int>(std::ceil(texel_rad_ * std::sqrt(exponent) / piece_)));
    bundle.reaches.push_back({1 / (1 / exponent + apart2_), pieces, chord * chord});
  }
  bundles_.push_back(std::move(bundle));
}

int Grain::pieces(const Vec3& direction) const {
  int most = 1;
  for (const Bundle& bundle : bundles_) {
    if (bundle.reaches.empty() || bundle.reaches.front().pieces == 1) continue;
    double chord2 = 4;
    for (const Vec3& middle : bundle.middles) chord2 = std::min(chord2, dot(middle - direction, middle - direction));
    for (const Reach& reach : bundle.reaches)
      if (chord2 < reach.chord2) most = std::max(most, reach.pieces);
  }
  return most;
}

bool Grain::opens(const envmap::BlockTree::Block& block, double variance) const {
  // First the diffuse part: the cosine law is a lobe of exponent 1 whose middle may be anywhere.
  const double most = most_spread_ * most_spread_;
  if (variance > kBaseOfLobe * most) return true;
  // Then each bundle of lobes, by how far the cap of the block is from the nearest lobe. A lobe bends less the farther
  // from its middle it is met, so that far blocks may be wider.
  constexpr double kHalfSphere = 0.5;  // of wider caps the sine is no measure
  if (block.cosine < kHalfSphere) return true;
  const double extent = 1.2 * block.sine;  // at least the chord of the cap's radius
  for (const Bundle& bundle : bundles_) {
    const double nearest = std::max(0.0, length(bundle.axis - vec3(block.axis)) - bundle.radius - extent);
    for (const Reach& reach : bundle.reaches) {
      if (variance * reach.exponent <= most) break;
      if (variance * reach.exponent * bend_beyond(0.5 * reach.exponent * nearest * nearest) > most) return true;
    }
  }
  return false;
}

Gatherer::Gatherer(const SurfacePoint& point, double texel_rad, double most_spread)
    : point_(point),
      model_(model_of(point)),
      paint_(brdf::at_view(*point.paint, view_deg(point))),
      cos_o_(dot(point.normal, point.to_viewer)),
      grain_(texel_rad, most_spread),
      summed_(most_spread == 0 && model_.tilts.empty()) {
  set_mirror_directions();
  if (model_.map != nullptr || model_.coat) {
    const Vec3& n = point.normal;
    frame_x_ = normalized(cross(std::abs(n.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n)), frame_y_ = cross(n, frame_x_);
    local_viewer_ = {dot(point.to_viewer, frame_x_), dot(point.to_viewer, frame_y_), cos_o_};
  }
  const double let_out = brdf::coat_transmission(std::clamp(cos_o_, 0.0, 1.0), paint_.coat_index);
  paint_.diffuse = let_out * paint_.diffuse;
  for (paint::Lobe& lobe : paint_.lobes) lobe.directional_diffuse = let_out * lobe.directional_diffuse;
  // The lobes in the order of their exponents, so that a loop over them can stop at the first that is too sharp.
  for (const paint::Lobe& lobe : paint_.lobes) {
    if (!lobe.is_mirror()) lobes_.push_back(lobe);
  }
  std::ranges::sort(lobes_, {}, &paint::Lobe::exponent);
  if (model_.fresnel) {
    const double share = 1 / brdf::fresnel_dielectric(std::cos(model_.gloss_deg * kDegree), brdf::kCoatIndex);
    for (paint::Lobe& lobe : lobes_) lobe.gloss = share * lobe.gloss;
  }
  std::vector<Vec3> middles;
  for (const Mirrored& m : mirrored_) middles.push_back(m.direction);
  std::vector<double> exponents;
  for (auto lobe = lobes_.rbegin(); lobe != lobes_.rend(); ++lobe) exponents.push_back(lobe->exponent);
  if (model_.coat) exponents.push_back(model_.coat->sharpest_exponent(cos_o_));
  std::sort(exponents.begin(), exponents.end(), std::greater<>());
  grain_.add(std::move(middles), exponents);
  if (most_spread == 0 && tilts_.size() > 1) make_bells();
}

// Each lobe stands about as many tilts as its own width asks for. Over the angle of the tilts a lobe is a bell as wide
// as its alpha, which Gauss quadrature of the tilts sums to a thousandth of its peak. Its powers are linear to 5e-6 of
// themselves between steps.
void Gatherer::make_bells() {
  constexpr double kPointsOfAlpha = 2.8;  // for each alpha of half the range; the test has the error
  constexpr int kMorePoints = 3, kSteps = 4096;
  const auto [low, high] = std::ranges::minmax(tilts_, {}, &math::QuadraturePoint::position);
  for (const paint::Lobe& lobe : lobes_) {
    const double alphas = 0.5 * (high.position - low.position) / brdf::lobe_alpha(lobe.exponent);
    Bell& bell = bells_.emplace_back();
    for (const auto& [angle, share] :
         math::fewer_points(tilts_, kMorePoints + static_cast<int>(kPointsOfAlpha * alphas)))
      bell.middles.push_back({mirrored_about(angle), share});
    const double last = -std::expm1(-kTail / lobe.exponent);
    bell.steps = kSteps / last;
    for (int i = 0; i <= kSteps; ++i) bell.power.push_back(std::exp(lobe.exponent * std::log1p(-i / bell.steps)));
  }
}

double Gatherer::Bell::toward(const Vec3& direction) const {
  double sum = 0;
  for (const Mirrored& middle : middles) {
    const Vec3 apart = middle.direction - direction;
    const double place = 0.5 * steps * dot(apart, apart);
    if (!(place < static_cast<double>(power.size() - 1))) continue;
    const auto step = static_cast<std::size_t>(place);
    sum += middle.share * std::lerp(power[step], power[step + 1], place - static_cast<double>(step));
  }
  return sum;
}

Vec3 Gatherer::mirrored_about(double tilt_rad) const {
  const Vec3 m = std::sin(tilt_rad) * tilted_along_ + std::cos(tilt_rad) * point_.normal;
  return 2 * dot(m, point_.to_viewer) * m - point_.to_viewer;
}

// About the normal, and about each tilted normal: the tangent runs level around +Y, on a level surface along +X.
void Gatherer::set_mirror_directions() {
  const Vec3& n = point_.normal;
  reflected_ = 2 * cos_o_ * n - point_.to_viewer;
  if (model_.tilts.empty()) {
    mirrored_ = {{reflected_, 1}};
    return;
  }
  const double level2 = n.x * n.x + n.z * n.z;
  const Vec3 x = level2 > 1e-12 ? normalized({n.z, 0, -n.x}) : Vec3{1, 0, 0}, y = cross(n, x);
  const bool along_x = std::ranges::any_of(model_.tilts, [](const brdf::Tilt& tilt) { return tilt.normal.x != 0; });
  tilted_along_ = along_x ? x : y;
  for (const brdf::Tilt& tilt : model_.tilts) {
    const double angle = std::atan2(along_x ? tilt.normal.x : tilt.normal.y, tilt.normal.z);
    const Vec3 r = mirrored_about(angle);
    if (!(dot(r + point_.to_viewer, n) > 0) || !(dot(r, n) > 0)) continue;
    mirrored_.push_back({r, tilt.weight}), tilts_.push_back({angle, tilt.weight});
  }
}

// The integral over the disc. Looked up, the lobes are as the kernels have them; summed, it is exact.
void Gatherer::add_light(const Light& light) {
  if (!(light.radius_rad > 0)) return add({light.direction, kPi}, light.white, true, model_.map_under_lights);
  const double cosine = dot(point_.normal, light.direction);
  if (cosine <= -std::sin(light.radius_rad)) return;
  const bool mapped = model_.map_under_lights;
  const double irradiance = brdf::disc_irradiance(cosine, light.radius_rad);
  const color::Rgb f = irradiance * (mapped ? mapped_toward(light.direction) : let_in_of(light) * paint_.diffuse) +
                       lobes_toward_disc(light, mapped);
  add_reflected(f, kPi * light.white);
  if (model_.coat) {
    const double coat = model_.coat->over_disc(local_viewer_, local(light.direction), light.radius_rad);
    add_reflected({coat, coat, coat}, kPi * light.white);
  }
  if (light.meets(reflected_)) add_mirror(light.radiance());
}

void Gatherer::add_reflected(const color::Rgb& f, const color::Rgb& light) {
  sum_ += model_.reflection != nullptr ? goniochrome::color::reflected(*model_.reflection, f, light) : f * light;
}

// Mean over the disc above the horizon, each part with its cosine.
double Gatherer::let_in_of(const Light& light) const {
  if (paint_.coat_index == paint::kNoCoat) return 1;
  double whole = 0, passed = 0;
  for (const DiscDirection& part : disc_directions(light)) {
    const double weighed = part.weight * std::max(0.0, dot(point_.normal, part.direction));
    whole += weighed, passed += weighed * let_in(weighed / part.weight);
  }
  const double above = brdf::disc_above(dot(point_.normal, light.direction), light.radius_rad);
  // Where the middle of a narrow disc is below the horizon, the mean cosine of what is above it.
  if (whole <= 0 && above > 0)
    return let_in(brdf::disc_irradiance(dot(point_.normal, light.direction), light.radius_rad) / above);
  return whole > 0 ? passed / whole : 1;
}

// f cos_i of all lobes, integrated over the disc relative to pi sin^2 of its radius.
color::Rgb Gatherer::lobes_toward_disc(const Light& light, bool mapped) const {
  const double radius = light.radius_rad, cosine = dot(point_.normal, light.direction);
  const double irradiance = brdf::disc_irradiance(cosine, radius), above = brdf::disc_above(cosine, radius);
  const auto coat = [&](const Vec3& toward) {
    return model_.fresnel
               ? brdf::fresnel_dielectric(std::min(1.0, 0.5 * length(toward + point_.to_viewer)), brdf::kCoatIndex)
               : 1;
  };
  const double coat_l = coat(light.direction), in_l = let_in_of(light);
  color::Rgb f;
  for (const Mirrored& m : mirrored_) {
    const Vec3 apart = m.direction - light.direction;
    const double chord = length(apart), cos_r = std::max(0.0, dot(point_.normal, m.direction)),
                 coat_r = coat(m.direction);
    for (const paint::Lobe& lobe : lobes_) {
      if (summed_) {
        f += m.share * lobe_over_disc(lobe, m.direction, light, mapped);
        continue;
      }
      const brdf::DiscLobeTable::Node of = brdf::disc_lobe(lobe.exponent, radius, chord);
      f += m.share *
           ((of.cosine[0] * irradiance * in_l + of.cosine[1] * cos_r * let_in(cos_r)) * lobe.directional_diffuse +
            (of.plain[0] * above * coat_l + of.plain[1] * coat_r) * lobe.gloss);
    }
  }
  return f;
}

namespace {

// The part of the arc from -half to half whose elevation above a plane is positive where it is
// level + slope cos(azimuth - middle): at most two pieces.
struct Arcs {
  int count = 0;
  double from[2] = {}, to[2] = {};
};
Arcs arcs_above(double half, double level, double slope, double middle) {
  Arcs arcs;
  const auto add = [&](double from, double to) {
    if (to > from && arcs.count < 2) arcs.from[arcs.count] = from, arcs.to[arcs.count++] = to;
  };
  if (level >= slope) add(-half, half);
  if (level >= slope || level <= -slope) return arcs;
  const double wide = std::acos(-level / slope);
  for (const double turn : {-2 * kPi, 0.0, 2 * kPi})
    add(std::max(-half, middle + turn - wide), std::min(half, middle + turn + wide));
  return arcs;
}

// Gauss-Legendre points on -1..1.
const std::vector<math::QuadraturePoint>& disc_rule() {
  constexpr int kPoints = 24;
  static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(kPoints);
  return rule;
}
const std::vector<math::QuadraturePoint>& arc_rule() {
  constexpr int kPoints = 10;
  static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(kPoints);
  return rule;
}

}  // namespace

// Ring by ring about the mirror direction, as brdf::lobe_of_disc(), each arc cut at the horizon, and each direction
// with its own cosine and coat.
color::Rgb Gatherer::lobe_over_disc(const paint::Lobe& lobe, const Vec3& r, const Light& light, bool mapped) const {
  const Vec3 &n = point_.normal, apart = r - light.direction;
  const double chord = length(apart), between = 2 * std::asin(std::min(1.0, 0.5 * chord)), radius = light.radius_rad;
  const Vec3 across = light.direction - dot(light.direction, r) * r;
  const Vec3 side = std::abs(r.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = length(across) > 1e-12 ? normalized(across) : normalized(cross(side, r)), y = cross(r, x);
  const double nx = dot(n, x), ny = dot(n, y), nr = dot(n, r), slope = std::hypot(nx, ny), middle = std::atan2(ny, nx);
  double flake = 0, gloss = 0;
  const auto add_ring = [&](double t, double half, double weight) {
    const double sine = std::sin(t), cosine = std::cos(t);
    const Arcs arcs = arcs_above(half, nr * cosine, sine * slope, middle);
    const double power = weight * sine * math::cos_power(t, lobe.exponent);
    for (int k = 0; k < arcs.count; ++k) {
      const double wide = 0.5 * (arcs.to[k] - arcs.from[k]), center = 0.5 * (arcs.to[k] + arcs.from[k]);
      for (const math::QuadraturePoint& p : arc_rule()) {
        const double phi = center + wide * p.position, c = std::cos(phi), s = std::sin(phi);
        const Vec3 w = cosine * r + sine * c * x + sine * s * y;
        const double share = power * wide * p.weight;
        const double cos_w = std::max(0.0, dot(n, w));
        flake += share * cos_w * let_in(cos_w);
        gloss += share * (model_.fresnel ? brdf::fresnel_dielectric(std::min(1.0, 0.5 * length(w + point_.to_viewer)),
                                                                    brdf::kCoatIndex)
                                         : 1);
      }
    }
  };
  const brdf::DiscRings rings = brdf::disc_rings(lobe.exponent, radius, between);
  for (const math::QuadraturePoint& p : disc_rule()) {
    if (rings.whole > 0) add_ring(0.5 * rings.whole * (1 + p.position), kPi, 0.5 * rings.whole * p.weight);
    const double at = kPi / 4 * (1 + p.position), sine = std::sin(at);
    if (rings.width > 0)
      add_ring(rings.first + rings.width * sine * sine, rings.half_arc(sine * sine),
               kPi / 4 * p.weight * rings.width * std::sin(2 * at));
  }
  const double scale = brdf::disc_radiance(radius);
  return scale * ((mapped ? 0 : flake) * lobe.directional_diffuse + gloss * lobe.gloss);
}

void Gatherer::add(const Patch& patch, const color::Rgb& radiance, bool horizon, bool mapped) {
  const double above = (1 - patch.variance) * dot(point_.normal, patch.direction);
  if (horizon && !(above > 0)) return;
  const BaseLight base(patch, point_.normal, paint_.coat_index);
  color::Rgb f;
  if (above > 0 && mapped) f = above * mapped_toward(patch.direction);
  if (above > 0 && !mapped) f = base.mean() * paint_.diffuse;
  f += lobes_toward(patch, horizon ? base : BaseLight(std::clamp(cos_o_, 0.0, 1.0), paint_.coat_index), mapped);
  if (above > 0 && model_.coat) {
    const double coat = model_.coat->sent(local(patch.direction), local_viewer_).f_cos;
    f += {coat, coat, coat};
  }
  add_reflected(f, patch.solid_angle_sr * radiance);
}

void Gatherer::add_mirror(const color::Rgb& radiance) {
  const paint::Lobe* mirror = find_lobe(paint_, paint::kMirrorExponent);
  if (mirror == nullptr) return;
  const bool fresnel = point_.model == nullptr || model_.fresnel;
  const color::Rgb k =
      brdf::fresnel_dielectric(fresnel ? cos_o_ : std::numbers::sqrt2 / 2, brdf::mirror_index(paint_.coat_index)) *
      mirror->gloss;
  add_reflected(k, radiance);
}

// A map holds reflectance factors, pi f. Isolines do not change when both directions turn about the normal.
color::Rgb Gatherer::mapped_toward(const Vec3& direction) const {
  return (1 / kPi) * brdf::reflectance_factor(*model_.map, local(direction), local_viewer_, model_.treatment);
}

Vec3 Gatherer::local(const Vec3& direction) const {
  return {dot(direction, frame_x_), dot(direction, frame_y_), dot(direction, point_.normal)};
}

color::Rgb Gatherer::lobes_toward(const Patch& patch, const BaseLight& base, bool mapped) const {
  color::Rgb flake, gloss;
  for (std::size_t j = 0; j < bells_.size(); ++j) {
    const double power = bells_[j].toward(patch.direction);
    if (!(power > 0)) continue;
    gloss += power * lobes_[j].gloss;
    flake += power * base.mean() * lobes_[j].directional_diffuse;
  }
  for (const Mirrored& m : mirrored_) {
    if (!bells_.empty()) break;
    const LobeLight light(patch, m.direction, point_.normal);
    for (std::size_t j = 0; j < lobes_.size(); ++j) {
      const paint::Lobe& lobe = lobes_[j];
      const BlurredLobe blurred = grain_.blurred(lobe.exponent, patch.variance);
      const color::Rgb power = m.share * light.mean(blurred);
      if (power == color::Rgb{}) break;  // as it is for all that are sharper
      gloss += power * lobe.gloss;
      flake += power * base.mean(light.more_cosine(blurred, base)) * lobe.directional_diffuse;
    }
  }
  if (mapped) flake = {};
  if (gloss == color::Rgb{} || !model_.fresnel) return flake + gloss;
  const double cos_half = 0.5 * length(patch.direction + point_.to_viewer);
  return flake + brdf::fresnel_dielectric(std::min(1.0, cos_half), brdf::kCoatIndex) * gloss;
}

TextureGatherer::TextureGatherer(const TexturedPoint& point, const color::ReflectionOperator* reflection,
                                 double texel_rad, double most_spread)
    : point_(point), reflection_(reflection), grain_(texel_rad, most_spread) {
  const Vec3& n = point.normal;
  for (const SurfaceLayer::Piece& piece : point.pieces) {
    const brdf::SurfaceFrame frame = brdf::surface_frame(piece.texel, n, piece.tangent);
    const Vec3 viewer = frame.local(point.to_viewer);
    diffuse_ += piece.share * piece.texel.surface.diffuse;
    for (const brdf::LafortuneLobe& lobe : piece.texel.surface.lobes)
      add_lobe(frame.world(lobe.axes * viewer), lobe.exponent, piece.share * lobe.albedo);
  }
  for (const TexelLobe& lobe : lobes_) {
    if (lobe.exponent > 0) grain_.add({lobe.middle}, {lobe.exponent});
  }
}

// Neighboring texels often hold the same lobe in another color.
void TextureGatherer::add_lobe(const Vec3& axis, double exponent, const color::Rgb& albedo) {
  const double size = length(axis);
  if (albedo == color::Rgb{} || !(size > 0)) return;
  for (TexelLobe& lobe : lobes_) {
    if (lobe.axis == axis && lobe.exponent == exponent) {
      lobe.color += albedo;
      return;
    }
  }
  TexelLobe lobe{axis, (1 / size) * axis, exponent, exponent * std::log(size), albedo};
  if (exponent > 0) lobe.least_cosine = std::exp(-kTail / exponent);
  lobes_.push_back(lobe);
}

void TextureGatherer::add(const Patch& patch, const color::Rgb& radiance) {
  const BaseLight base(patch, point_.normal, paint::kNoCoat);
  if (!(base.cosine() > 0)) return;
  color::Rgb f = base.mean() * diffuse_;
  for (const TexelLobe& lobe : lobes_) {
    if (dot(lobe.middle, patch.direction) < lobe.least_cosine - std::sqrt(3 * patch.variance)) continue;
    const LobeLight light(patch, lobe.middle, point_.normal);
    const BlurredLobe blurred = grain_.blurred(lobe.exponent, patch.variance);
    f += std::exp(std::min(lobe.log_peak, kLargestLog)) * light.mean(blurred) *
         base.mean(light.more_cosine(blurred, base)) * lobe.color;
  }
  const color::Rgb product =
      reflection_ != nullptr ? goniochrome::color::reflected(*reflection_, f, radiance) : f * radiance;
  sum_ += patch.solid_angle_sr * product;
}

void TextureGatherer::add_light(const Light& light) {
  if (!(light.radius_rad > 0)) return add({light.direction, kPi}, light.white);
  const double cosine = dot(point_.normal, light.direction);
  const double irradiance = brdf::disc_irradiance(cosine, light.radius_rad);
  color::Rgb f = irradiance * diffuse_;
  for (const TexelLobe& lobe : lobes_) {
    const double chord = length(lobe.middle - light.direction), between = 2 * std::asin(std::min(1.0, 0.5 * chord));
    const brdf::LobeOfDisc of = brdf::lobe_of_disc(lobe.exponent, light.radius_rad, between);
    const double cos_m = std::max(0.0, dot(point_.normal, lobe.middle));
    f +=
        std::exp(std::min(lobe.log_peak, kLargestLog)) * (of.by_light * irradiance + of.by_mirror * cos_m) * lobe.color;
  }
  const color::Rgb white = kPi * light.white;
  sum_ += reflection_ != nullptr ? goniochrome::color::reflected(*reflection_, f, white) : f * white;
}

}  // namespace goniochrome::render
