#include "render/internal/sparkle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/text.h"
#include "brdf/flakes.h"
#include "brdf/lobe_model.h"
#include "envmap/open_maps.h"
#include "math/elementary.h"
#include "mesh/unit.h"
#include "render/internal/lobe_curves.h"
#include "render/path/ray_points.h"
#include "render/path/sequence.h"
#include "render/scene_effects.h"
#include "render/spots.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// Deviations of less than this part of a pixel's luminance are not drawn.
constexpr double kLeast = 0.004;
// So many lamps and lobes stay single, and so do all that no more flakes show than these.
constexpr int kSingle = 2;
constexpr double kManyShown = 16;
// Maps of the root mean square and of the mean differ by rounding and filtering alone up to this relative variance.
constexpr double kMapVariance = 6e-3;
// A surface that is seen at a smaller cosine has no footprint.
constexpr double kGrazing = 0.02;

double seen_luminance(const color::Rgb& rgb) {
  return color::xyz_d65_from_rgb(rgb).Y;
}

std::array<int, 2> other_axes(int axis) {
  return {(axis + 1) % 3, (axis + 2) % 3};
}

Vec3 unit_axis(int axis) {
  return {axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0};
}

}  // namespace

// The surface that a pixel shows: its flakes are those of a box in the plane of two axes of the mesh, onto which the
// surface is projected along the third, which is nearest to its normal.
struct Sparkle::Footprint {
  Vec3 normal, to_viewer, mirrored, across, position;
  int axis = 0;
  double steep = 1;  // the cosine between the normal of the triangle and the axis
  double area_m2 = 0;
  brdf::FlakeBox box;
};

// Trees of the projections along each axis. They hold the flakes of the steepest surface, sqrt(3) times as many as
// those of a level one, of which the others show a part.
struct Sparkle::Source {
  std::array<brdf::FlakeTree, 3> trees;
};

struct Sparkle::Lobe {
  double exponent = 1, per_m2 = 0;
  std::vector<brdf::FlakeLamp> shown;    // each lamp, which has one radius: those at a place are points
  std::vector<Source> lamps;             // of the same
  envmap::MapPointer mean;               // without the bright spots; null where no deviation from it is known
  const envmap::CubeMap* rms = nullptr;  // the root of the mean square of the same
};

struct Sparkle::Part {
  paint::LobeFit paint;
  paint::Flakes flakes;
  std::vector<Lobe> lobes;
  std::vector<Source> rest;  // one, of all flakes
};

// Light that varies: of one lamp by one lobe, or of the rest of the light by all lobes.
struct Sparkle::Grain {
  const Lobe* lobe = nullptr;  // null: the rest
  std::size_t lamp = 0;
  Light light;  // as seen from the point
  color::Rgb mean;
  double variance = 0;        // relative
  double flake_variance = 0;  // relative, of the light that one flake shows; of the rest

  double deviation() const { return std::sqrt(variance) * seen_luminance(mean); }
};

namespace {

std::array<brdf::FlakeTree, 3> trees_of(double per_m2, double exponent, std::uint64_t source, double tilts) {
  const std::uint64_t seed = mixed(std::bit_cast<std::uint64_t>(exponent), source);
  const auto tree = [&](std::uint64_t axis) {
    return brdf::FlakeTree(std::numbers::sqrt3 * per_m2, mixed(seed, axis), tilts);
  };
  return {tree(0), tree(1), tree(2)};
}

// Why a part has no sparkle although its paint has flakes; "" where it has.
std::string hindrance(const Scene& scene, std::size_t part) {
  const auto is_on = [&](const auto& list) { return part < list.size(); };
  if (is_on(scene.anisotropy) && scene.anisotropy[part].alpha_x != scene.anisotropy[part].alpha_y) return "brushed";
  if (!scene.paints[part].tilts.empty()) return "mapped";
  if (scene.layer == nullptr) return "";
  const PartSurface& surface = scene.layer->surface(static_cast<int>(part));
  return surface.texture != nullptr ? "textured" : surface.color_map != nullptr ? "mapped" : "";
}

}  // namespace

Sparkle::Sparkle(const Scene& scene, const Effects& effects)
    : scene_(scene), reflection_(effects.reflection), unit_m_(mesh::length_unit(*scene.mesh).meters) {
  lamps_ = lights_of(scene, effects);
  if (scene.env != nullptr)
    for (const envmap::Spot& spot : scene.env->spots) lamps_.push_back(light_of(spot));
  std::set<std::string> left_out, told;
  bool squares = false;
  parts_.resize(scene.paints.size());
  for (std::size_t i = 0; i < scene.paints.size() && i < scene.flakes.size(); ++i) {
    if (!scene.flakes[i]) continue;
    if (const std::string why = hindrance(scene, i); !why.empty()) {
      left_out.insert(why);
      continue;
    }
    auto part = std::make_shared<Part>();
    part->paint = with_effects(scene.paints[i], effects);
    part->flakes = scene.flakes[i]->flakes;
    const std::vector<double> shares = brdf::flake_shares(part->paint);
    for (std::size_t j = 0; j < shares.size(); ++j) {
      if (shares[j] == 0) continue;
      Lobe lobe{part->paint.lobes[j].exponent, shares[j] * part->flakes.per_m2(), {}, {}, nullptr, nullptr};
      for (std::size_t k = 0; k < lamps_.size(); ++k) {
        lobe.shown.emplace_back(lobe.exponent, lamps_[k].place ? 0 : lamps_[k].radius_rad, part->flakes.spread_deg);
        const double tilts = std::max(1e-6, lobe.shown.back().part_that_shows(0));
        lobe.lamps.push_back({trees_of(lobe.per_m2, lobe.exponent, k, tilts)});
      }
      const envmap::PrefilteredLobe* filtered = scene.env != nullptr ? scene.env->lobe(lobe.exponent) : nullptr;
      if (filtered != nullptr && filtered->rms != nullptr) {
        lobe.rms = filtered->rms.get(), squares = true;
        lobe.mean = envmap::open_map(*scene.env, *filtered, scene.env->spots.size());
      }
      part->lobes.push_back(std::move(lobe));
    }
    if (part->lobes.empty()) continue;
    part->rest.push_back({trees_of(part->flakes.per_m2(), 0, lamps_.size(), 0.5)});
    told.insert(fmt::format("{} um, coverage {}{}", shortest(part->flakes.diameter_um), shortest(part->flakes.coverage),
                            scene.flakes[i]->assumed ? " (assumed by class)" : ""));
    parts_[i] = std::move(part);
  }
  const std::string without =
      left_out.empty() ? ""
                       : fmt::format("; left out on {} parts", joined({left_out.begin(), left_out.end()}, " and "));
  if (told.empty()) {
    absent_ = "no visible paint has flakes" + without;
    return;
  }
  if (lamps_.empty() && !squares) {
    absent_ = scene.env != nullptr ? "no lamp and no bright spot, and the environment has no part rms, which "
                                     "prefilter-envmap --sparkle makes"
                                   : "no light";
    return;
  }
  reason_ = fmt::format("flakes of {}{}{}", joined({told.begin(), told.end()}, ", "), without,
                        scene.env != nullptr && !squares
                            ? "; lamps and bright spots alone, since the environment was made without --sparkle"
                            : "");
}

std::optional<Sparkle::Footprint> Sparkle::footprint(const Gbuffer& g, int x, int y) const {
  const MeshPoint point = mesh_point(*scene_.mesh, g, x, y);
  Footprint at;
  at.normal = g.normal(x, y), at.to_viewer = g.to_viewer(x, y), at.position = point.position;
  const auto reached = [&](double dx, double dy) -> std::optional<Vec3> {
    const Vec3 direction = g.rays.direction(x + 0.5 + dx, y + 0.5 + dy);
    const double along = dot(direction, point.face), away = dot(point.position - g.rays.eye, point.face);
    if (std::abs(along) < kGrazing || !(away / along > 0)) return std::nullopt;
    return (away / along) * direction;
  };
  const auto here = reached(0, 0), right = reached(1, 0), down = reached(0, 1);
  if (!here || !right || !down) return std::nullopt;
  const Vec3 a = unit_m_ * (*right - *here), b = unit_m_ * (*down - *here);
  at.area_m2 = length(cross(a, b));
  for (int axis = 1; axis < 3; ++axis)
    if (std::abs(point.face[axis]) > std::abs(point.face[at.axis])) at.axis = axis;
  at.steep = std::abs(point.face[at.axis]);
  const std::array<int, 2> axes = other_axes(at.axis);
  for (std::size_t i = 0; i < 2; ++i) at.box.size[i] = std::abs(a[axes[i]]) + std::abs(b[axes[i]]);
  const double covered = at.box.area();
  if (!(covered > 0) || !(at.area_m2 > 0) || !std::isfinite(covered)) return std::nullopt;
  const double scale = std::sqrt(at.area_m2 * at.steep / covered);
  for (std::size_t i = 0; i < 2; ++i) {
    at.box.size[i] *= scale;
    at.box.place[i] = unit_m_ * point.position[axes[i]] - 0.5 * at.box.size[i];
  }
  at.mirrored = 2 * dot(at.normal, at.to_viewer) * at.normal - at.to_viewer;
  at.across = unit_axis(axes[0]);
  return at;
}

// Lists the light that varies enough to be seen. The light of all flakes is no more than what the pixel shows. The
// lamps that vary most stay single; others that many flakes show are near normal, and vary with the rest of the light.
std::vector<Sparkle::Grain> Sparkle::grains(const Part& part, const Footprint& at, const color::Rgb& shown,
                                            const Lit& lit) const {
  const double cos_o = std::clamp(dot(at.normal, at.to_viewer), 0.0, 1.0), least = kLeast * seen_luminance(shown);
  const paint::LobeFit paint =
      part.paint.views.empty() ? part.paint : brdf::at_view(part.paint, math::acos(cos_o) / kDegree);
  const double let_out = brdf::coat_transmission(cos_o, paint.coat_index);
  const auto met = [&](const color::Rgb& weight, const color::Rgb& light) {
    return reflection_ ? color::reflected(scene_.reflection, weight, light) : weight * light;
  };
  std::vector<Grain> grains;
  Grain rest;
  color::Rgb sum;
  double rest_variance = 0;
  for (const Lobe& lobe : part.lobes) {
    const paint::Lobe* worn = find_lobe(paint, lobe.exponent);
    if (worn == nullptr) continue;
    const color::Rgb weight = let_out * worn->directional_diffuse;
    for (std::size_t k = 0; k < lamps_.size(); ++k) {
      Grain grain{&lobe, k, light_at(lamps_[k], at.position), {}, 0, 0};
      const brdf::DiscGrain disc =
          brdf::disc_grain(lobe.shown[k], at.normal, at.mirrored, grain.light.direction, paint.coat_index);
      if (!(disc.mean > 0)) continue;
      grain.mean = disc.mean * met(weight, grain.light.white);
      grain.variance = disc.relative_variance / (lobe.per_m2 * at.area_m2);
      const bool varies = grain.deviation() > least;
      if (varies && !lit(k, grain.light)) continue;
      sum += grain.mean;
      if (varies) grains.push_back(std::move(grain));
    }
    if (lobe.rms == nullptr) continue;
    const LobeIntegrals whole = lobe_integrals(lobe.exponent, cos_o, false, paint.coat_index);
    const Vec3 mean = envmap::bilinear(*lobe.mean, at.mirrored), rms = envmap::bilinear(*lobe.rms, at.mirrored);
    const color::Rgb light = whole.cosine * met(weight, {mean.x, mean.y, mean.z});
    const double of_mean = seen_luminance({mean.x, mean.y, mean.z}), of_rms = seen_luminance({rms.x, rms.y, rms.z});
    const double variance = of_mean > 0 ? of_rms * of_rms / (of_mean * of_mean) - 1 : 0;
    rest.mean += light, sum += light;
    rest_variance += variance > kMapVariance ? variance * std::pow(seen_luminance(light), 2) / lobe.per_m2 : 0;
  }
  std::ranges::stable_sort(grains, std::greater<>(), &Grain::deviation);
  std::erase_if(grains, [&, number = 0](const Grain& grain) mutable {
    if (++number <= kSingle || grain.variance * kManyShown > 1) return false;
    rest.mean += grain.mean;
    rest_variance += std::pow(grain.deviation(), 2) * at.area_m2;
    return true;
  });
  // Lobes share out the flakes, and their variances add.
  if (const double light = seen_luminance(rest.mean); light > 0 && rest_variance > 0) {
    rest.variance = rest_variance / (light * light * at.area_m2);
    rest.flake_variance = rest.variance * part.flakes.per_m2() * at.area_m2;
    if (rest.deviation() > least) grains.push_back(std::move(rest));
  }
  for (Grain& grain : grains)
    for (int c = 0; c < 3; ++c)
      if (sum[c] > shown[c]) grain.mean[c] *= std::max(0.0, shown[c]) / sum[c];
  return grains;
}

color::Rgb Sparkle::deviation(const Gbuffer& gbuffer, int x, int y, const color::Rgb& shown) const {
  const int number = gbuffer.part(x, y);
  const Part* part = number < 0 ? nullptr : parts_[static_cast<std::size_t>(number)].get();
  if (part == nullptr) return {};
  const std::optional<Footprint> at = footprint(gbuffer, x, y);
  if (!at) return {};
  color::Rgb variance;
  const auto open = [](std::size_t, const Light&) { return true; };
  for (const Grain& grain : grains(*part, *at, shown, open)) variance += grain.variance * (grain.mean * grain.mean);
  return {std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)};
}

// Flakes that show a lamp are Poisson with a mean of `expected`. Of the rest, the flakes in one part of all tilts,
// about the brightest, show more than the mean and the others less: half of all flakes, or fewer where the others are
// black.
color::Rgb Sparkle::change(const Part& part, const Footprint& at, const std::vector<Grain>& grains) const {
  const auto axis = static_cast<std::size_t>(at.axis);
  const double projected = 1 / (std::numbers::sqrt3 * at.steep);
  color::Rgb change;
  for (const Grain& grain : grains) {
    brdf::FlakeBox box = at.box;
    if (grain.lobe != nullptr) {
      const brdf::FlakeBox tilts =
          brdf::tilts_that_show(grain.lobe->shown[grain.lamp], at.mirrored, at.across, grain.light.direction);
      box.tilt = tilts.tilt, box.tilts = tilts.tilts;
      box.shown = projected * std::min(1.0, dot(at.normal, grain.light.direction));
      const double expected = std::numbers::sqrt3 * grain.lobe->per_m2 * box.area() * box.part();
      if (expected > 0) change += (grain.lobe->lamps[grain.lamp].trees[axis].count(box) / expected - 1) * grain.mean;
      continue;
    }
    const brdf::FlakeTree& tree = part.rest.front().trees[axis];
    const Vec3 x = at.across - dot(at.across, at.mirrored) * at.mirrored, y = cross(at.mirrored, x);
    const double bright = std::min(0.5, 1 / (1 + grain.flake_variance)),
                 low = std::max(0.0, 1 - std::sqrt(grain.flake_variance)), high = (1 - (1 - bright) * low) / bright;
    box.shown = projected;
    brdf::FlakeBox brighter = box;
    brighter.tilts[1] = bright, brighter.tilt[1] = math::atan2(y.y, x.y) / (2 * kPi) - 0.5 * bright + 1;
    const brdf::FlakeCounts flakes = tree.counts(box, brighter);
    if (flakes.all > 0) change += (low + (high - low) * flakes.inner / flakes.all - 1) * grain.mean;
  }
  return change;
}

void Sparkle::add(const Gbuffer& g, const rays::RayScene* blockers, image::Image& picture) const {
  parallel_for(static_cast<std::size_t>(g.height), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < g.width; ++x) {
        const int number = g.part(x, y);
        float* pixel = picture.pixel(x, y);
        const double covered = pixel[3];
        if (number < 0 || !(covered > 0)) continue;
        const Part* part = parts_[static_cast<std::size_t>(number)].get();
        const std::optional<Footprint> at = part != nullptr ? footprint(g, x, y) : std::nullopt;
        if (!at) continue;
        std::optional<RayPoint> from;
        std::vector<std::optional<bool>> known(lamps_.size());
        const auto lit = [&](std::size_t lamp, const Light& light) {
          if (blockers == nullptr) return true;
          if (known[lamp]) return *known[lamp];
          if (!from) from = ray_point(*blockers, *scene_.mesh, g, x, y);
          const auto& place = lamps_[lamp].place;
          const double reach = place ? length(place->position - at->position) * blockers->scale() : 1e30;
          known[lamp] = !blockers->occluded(from->spot.start, rays::float3(light.direction), static_cast<float>(reach));
          return *known[lamp];
        };
        const std::vector<Grain> grains =
            this->grains(*part, *at, {pixel[0] / covered, pixel[1] / covered, pixel[2] / covered}, lit);
        if (grains.empty()) continue;
        const color::Rgb change = this->change(*part, *at, grains);
        for (int c = 0; c < 3; ++c) pixel[c] += static_cast<float>(covered * change[c]);
      }
    }
  });
}

}  // namespace goniochrome::render
