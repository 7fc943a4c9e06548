#include "render/internal/sparkle.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ranges>
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
#include "render/internal/wear.h"
#include "render/path/sequence.h"
#include "render/path/visible_surface.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// Deviations of less than this part of a pixel's luminance are not drawn.
constexpr double kLeast = 0.004;
// Lamps that more flakes show than these vary together with the rest of the light.
constexpr double kManyShown = 8;
// Lamps whose variance together is less than this part of what varies more vary with the rest of the light.
constexpr double kLesser = 0.2;
// Light whose variance is less than this part of what varies more is not seen beside it.
constexpr double kMasked = 0.01;
// Maps of the root mean square and of the mean differ by rounding and filtering alone up to this relative variance.
constexpr double kMapVariance = 6e-3;
// The light of flakes is computed once in a block of so many pixels across and down.
constexpr int kBlock = 4;
// A surface that is seen at a smaller cosine has no footprint.
constexpr double kGrazing = 0.02;

std::array<int, 2> other_axes(int axis) {
  return {(axis + 1) % 3, (axis + 2) % 3};
}

int steepest_axis(const Vec3& face) {
  int steepest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::abs(face[axis]) > std::abs(face[steepest])) steepest = axis;
  return steepest;
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

  Source(double per_m2, std::uint64_t number)
      : trees{tree(per_m2, number, 0), tree(per_m2, number, 1), tree(per_m2, number, 2)} {}
  static brdf::FlakeTree tree(double per_m2, std::uint64_t number, std::uint64_t axis) {
    return {std::numbers::sqrt3 * per_m2, mixed(number, axis)};
  }
};

// Each lamp has one radius: those at a place are points.
struct Sparkle::Lamp {
  brdf::FlakeLamp shown;
  Source source;
};

struct Sparkle::Part {
  // The light of a lobe without the bright spots, where its deviation is known.
  struct Maps {
    envmap::MapPointer mean;
    const envmap::CubeMap* rms = nullptr;  // the root of the mean square of the same
  };
  paint::LobeFit paint;
  double per_m2 = 0;
  std::vector<brdf::FlakeLamp::Lobe> lobes;
  std::vector<Maps> maps;  // of each lobe
  std::vector<Lamp> lamps;
  Source rest;  // all flakes
};

// Light that varies: of one lamp, or the rest.
struct Sparkle::Grain {
  std::optional<std::size_t> lamp;  // none: the rest
  Light light;                      // of the lamp, as seen from the point
  color::Rgb mean;
  double variance_m2 = 0;  // over patches of a square meter, relative to the mean squared
  double further_m2 = 0;   // the variance of its luminance and of all further light of the place together
  bool is_seen = false;    // at the last pixel

  double deviation_m() const { return std::sqrt(variance_m2) * color::luminance(mean); }
};

void Sparkle::add_further(std::vector<Grain>& grains) {
  double further = 0;
  for (Grain& grain : grains | std::views::reverse) grain.further_m2 = further += std::pow(grain.deviation_m(), 2);
}

// The light of flakes at a place, from which that at the pixels around it hardly differs.
struct Sparkle::Place {
  int part = -1;
  Footprint at;
  std::vector<Grain> grains;
  color::Rgb steady;  // light that hardly varies
};

namespace {

// Why a part has no sparkle although its paint has flakes; "" where it has.
std::string hindrance(const Scene& scene, std::size_t part) {
  if (is_anisotropic(anisotropy_of(scene, part))) return "brushed";
  if (!scene.paints[part].tilts.empty()) return "mapped";
  if (scene.layer == nullptr) return "";
  const PartSurface& surface = scene.layer->surface(static_cast<int>(part));
  return !surface.textures.empty() ? "textured" : surface.color_map != nullptr ? "mapped" : "";
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
    const paint::Flakes& flakes = scene.flakes[i]->flakes;
    Part part{with_effects(scene.paints[i], effects), flakes.per_m2(), {}, {}, {}, {flakes.per_m2(), 0}};
    const std::vector<double> shares = brdf::flake_shares(part.paint);
    for (std::size_t j = 0; j < shares.size(); ++j) {
      if (shares[j] == 0) continue;
      part.lobes.push_back({part.paint.lobes[j].exponent, shares[j], nullptr, nullptr});
      const envmap::PrefilteredLobe* filtered =
          scene.env != nullptr ? scene.env->lobe(part.lobes.back().exponent) : nullptr;
      const bool has_square = filtered != nullptr && filtered->rms != nullptr;
      part.maps.emplace_back();
      if (has_square)
        part.maps.back() = {open_map(*scene.env, *filtered, scene.env->spots.size()), filtered->rms.get()};
      squares |= has_square;
    }
    if (part.lobes.empty()) continue;
    for (std::size_t k = 0; k < lamps_.size(); ++k) {
      brdf::FlakeLamp shown(part.lobes, lamps_[k].place ? 0 : lamps_[k].radius_rad, flakes.spread_deg);
      part.lamps.push_back({std::move(shown), {part.per_m2, k + 1}});
    }
    told.insert(fmt::format("{} um, coverage {}{}", shortest(flakes.diameter_um), shortest(flakes.coverage),
                            scene.flakes[i]->assumed ? " (assumed by class)" : ""));
    parts_[i] = std::make_shared<const Part>(std::move(part));
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

void Sparkle::move(Footprint& to, const Gbuffer& g, int x, int y, const Vec3& position) const {
  const std::array<int, 2> axes = other_axes(to.axis);
  to.normal = g.normal(x, y), to.to_viewer = g.to_viewer(x, y), to.position = position;
  to.mirrored = 2 * dot(to.normal, to.to_viewer) * to.normal - to.to_viewer;
  for (std::size_t i = 0; i < 2; ++i) to.box.place[i] = unit_m_ * position[axes[i]] - 0.5 * to.box.size[i];
}

std::optional<Sparkle::Footprint> Sparkle::footprint(const Gbuffer& g, int x, int y, const MeshPoint& point) const {
  const auto reached = [&](double dx, double dy) -> std::optional<Vec3> {
    const Vec3 direction = g.rays.direction(x + 0.5 + dx, y + 0.5 + dy);
    const double along = dot(direction, point.face), away = dot(point.position - g.rays.eye, point.face);
    if (std::abs(along) < kGrazing || !(away / along > 0)) return std::nullopt;
    return (away / along) * direction;
  };
  const auto here = reached(0, 0), right = reached(1, 0), down = reached(0, 1);
  if (!here || !right || !down) return std::nullopt;
  const Vec3 a = unit_m_ * (*right - *here), b = unit_m_ * (*down - *here);
  Footprint at;
  at.axis = steepest_axis(point.face);
  at.area_m2 = length(cross(a, b));
  at.steep = std::abs(point.face[at.axis]);
  const std::array<int, 2> axes = other_axes(at.axis);
  at.across = unit_axis(axes[0]);
  for (std::size_t i = 0; i < 2; ++i) at.box.size[i] = std::abs(a[axes[i]]) + std::abs(b[axes[i]]);
  const double covered = at.box.area();
  if (!(covered > 0) || !(at.area_m2 > 0) || !std::isfinite(covered)) return std::nullopt;
  const double scale = std::sqrt(at.area_m2 * at.steep / covered);
  for (double& size : at.box.size) size *= scale;
  move(at, g, x, y, point.position);
  return at;
}

// Lists the light that varies enough to be seen, what varies most first. Lamps that many flakes show are near normal
// and vary with the rest of the light, and so do the lesser ones, of which only those that are lit.
Sparkle::Place Sparkle::place(const Part& part, const Footprint& at, const Lit& lit) const {
  const double cos_o = std::clamp(dot(at.normal, at.to_viewer), 0.0, 1.0);
  const paint::LobeFit paint =
      part.paint.views.empty() ? part.paint : brdf::at_view(part.paint, math::acos(cos_o) / kDegree);
  const double let_out = brdf::coat_transmission(cos_o, paint.coat_index);
  const auto met = [&](const color::Rgb& weight, const color::Rgb& light) {
    return reflection_ ? color::reflected(scene_.reflection, weight, light) : weight * light;
  };
  Place place;
  place.at = at;
  Grain rest;
  for (std::size_t k = 0; k < lamps_.size(); ++k) {
    const brdf::FlakeLamp& shown = part.lamps[k].shown;
    Grain grain{k, light_at(lamps_[k], at.position), {}, 0};
    grain.variance_m2 = brdf::disc_variance(shown, at.normal, at.mirrored, grain.light.direction) / part.per_m2;
    if (!std::isfinite(grain.variance_m2)) continue;
    color::Rgb weight;
    for (std::size_t j = 0; j < part.lobes.size(); ++j)
      if (const paint::Lobe* worn = find_lobe(paint, part.lobes[j].exponent))
        weight += brdf::disc_light(shown, j, at.normal, at.mirrored, grain.light.direction, paint.coat_index) *
                  worn->directional_diffuse;
    grain.mean = let_out * met(weight, grain.light.white);
    place.grains.push_back(std::move(grain));
  }
  double rest_variance = 0;
  for (std::size_t j = 0; j < part.lobes.size(); ++j) {
    const paint::Lobe* worn = find_lobe(paint, part.lobes[j].exponent);
    if (worn == nullptr || part.maps[j].rms == nullptr) continue;
    const LobeIntegrals whole = lobe_integrals(worn->exponent, cos_o, false, paint.coat_index);
    const Vec3 mean = envmap::bilinear(*part.maps[j].mean, at.mirrored),
               rms = envmap::bilinear(*part.maps[j].rms, at.mirrored);
    const color::Rgb light = let_out * whole.cosine * met(worn->directional_diffuse, mean);
    const double of_mean = color::luminance(mean), of_rms = color::luminance(rms);
    const double variance = of_mean > 0 ? of_rms * of_rms / (of_mean * of_mean) - 1 : 0;
    rest.mean += light;
    if (variance > kMapVariance)
      rest_variance += variance * std::pow(color::luminance(light), 2) / (part.lobes[j].share * part.per_m2);
  }
  std::ranges::stable_sort(place.grains, std::greater<>(), &Grain::deviation_m);
  add_further(place.grains);
  double greater = 0;
  std::erase_if(place.grains, [&](const Grain& grain) {
    if (grain.variance_m2 * kManyShown > at.area_m2 && grain.further_m2 > kLesser * greater) {
      greater += std::pow(grain.deviation_m(), 2);
      return false;
    }
    if (lit(grain)) rest.mean += grain.mean, rest_variance += std::pow(grain.deviation_m(), 2);
    return true;
  });
  // Lobes share out the flakes, and their variances add.
  if (const double light = color::luminance(rest.mean); light > 0) rest.variance_m2 = rest_variance / (light * light);
  place.grains.push_back(std::move(rest));
  color::Rgb sum;
  for (const Grain& grain : place.grains) sum += grain.mean;
  const double least_m = kLeast * color::luminance(sum) * std::sqrt(at.area_m2);
  std::erase_if(place.grains, [&](const Grain& grain) {
    if (grain.deviation_m() > least_m) return false;
    place.steady += grain.mean;
    return true;
  });
  std::ranges::stable_sort(place.grains, std::greater<>(), &Grain::deviation_m);
  add_further(place.grains);
  return place;
}

// The light of all flakes is no more than what the pixel shows.
template <class See>
void Sparkle::visit_seen(Place& place, const color::Rgb& shown, const Lit& lit, const See& see) {
  const double least_m = kLeast * color::luminance(shown) * std::sqrt(place.at.area_m2);
  color::Rgb sum = place.steady;
  double seen_m2 = 0;
  for (Grain& grain : place.grains) {
    const bool varies = grain.deviation_m() > least_m && grain.further_m2 > kMasked * seen_m2;
    grain.is_seen = varies && (!grain.lamp || lit(grain));
    if (grain.is_seen) seen_m2 += std::pow(grain.deviation_m(), 2);
    if (grain.is_seen || !varies) sum += grain.mean;
  }
  color::Rgb part{1, 1, 1};
  for (int c = 0; c < 3; ++c)
    if (sum[c] > shown[c]) part[c] = std::max(0.0, shown[c]) / sum[c];
  for (const Grain& grain : place.grains)
    if (grain.is_seen) see(grain, part * grain.mean);
}

color::Rgb Sparkle::deviation(const Gbuffer& gbuffer, int x, int y, const color::Rgb& shown) const {
  const int number = gbuffer.part(x, y);
  const Part* part = number < 0 ? nullptr : parts_[static_cast<std::size_t>(number)].get();
  if (part == nullptr) return {};
  const std::optional<Footprint> at = footprint(gbuffer, x, y, mesh_point(*scene_.mesh, gbuffer, x, y));
  if (!at) return {};
  color::Rgb variance;
  const auto lit = [](const Grain&) { return true; };
  Place seen = place(*part, *at, lit);
  visit_seen(seen, shown, lit, [&](const Grain& grain, const color::Rgb& mean) {
    variance += (grain.variance_m2 / at->area_m2) * (mean * mean);
  });
  return {std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)};
}

// The relative change of light that the flakes of a pixel make: those that show the lamp or, of the rest of the light,
// those that are brighter than the others, or all of them. They are Poisson with a mean of `expected`.
double Sparkle::change(const Part& part, const Footprint& at, const Grain& grain) const {
  const auto axis = static_cast<std::size_t>(at.axis);
  brdf::FlakeBox box = at.box;
  box.shown = 1 / (std::numbers::sqrt3 * at.steep);
  double varying = 1;
  if (grain.lamp) {
    const Vec3& toward = grain.light.direction;
    const brdf::FlakeBox tilts = brdf::tilts_that_show(part.lamps[*grain.lamp].shown, at.mirrored, at.across, toward);
    box.tilt = tilts.tilt, box.tilts = tilts.tilts;
    box.shown *= std::clamp(dot(at.normal, toward), 0.0, 1.0);
  } else {
    const double of_flake = grain.variance_m2 * part.per_m2, bright = std::min(1.0, 1 / of_flake);
    box.shown *= bright;
    varying = std::sqrt(bright * of_flake);
  }
  const double expected = std::numbers::sqrt3 * part.per_m2 * box.area() * box.part();
  const Source& source = grain.lamp ? part.lamps[*grain.lamp].source : part.rest;
  return expected > 0 ? varying * (source.trees[axis].count(box) / expected - 1) : 0;
}

void Sparkle::add(const Gbuffer& g, const rays::RayScene* blockers, image::Image& picture) const {
  parallel_for(static_cast<std::size_t>(g.height), kBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<Place> places(static_cast<std::size_t>(g.width) / kBlock + 1);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < g.width; ++x) {
        const int number = g.part(x, y);
        float* pixel = picture.pixel(x, y);
        const double covered = pixel[3];
        if (number < 0 || !(covered > 0)) continue;
        const Part* part = parts_[static_cast<std::size_t>(number)].get();
        if (part == nullptr) continue;
        const MeshPoint point = mesh_point(*scene_.mesh, g, x, y);
        const auto lit = [&](const Grain& grain) {
          if (blockers == nullptr) return true;
          const auto& from = lamps_[*grain.lamp].place;
          const double reach = from ? length(from->position - point.position) * blockers->scale() : 1e30;
          return !blockers->occluded(spot_at(*blockers, g, x, y).start, rays::float3(grain.light.direction),
                                     static_cast<float>(reach));
        };
        Place& place = places[static_cast<std::size_t>(x) / kBlock];
        if (place.part == number && place.at.axis == steepest_axis(point.face)) {
          move(place.at, g, x, y, point.position);
        } else {
          const std::optional<Footprint> at = footprint(g, x, y, point);
          place = at ? this->place(*part, *at, lit) : Place();
          if (!at) continue;
          place.part = number;
        }
        visit_seen(place, {pixel[0] / covered, pixel[1] / covered, pixel[2] / covered}, lit,
                   [&](const Grain& grain, const color::Rgb& mean) {
                     const double change = covered * this->change(*part, place.at, grain);
                     for (int c = 0; c < 3; ++c) pixel[c] += static_cast<float>(change * mean[c]);
                   });
      }
    }
  });
}

}  // namespace goniochrome::render
