#include "sketch/sketch_light.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "envmap/open_maps.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "render/aov.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/glints.h"
#include "render/scene_effects.h"
#include "render/spots.h"
#include "render/unit_weights.h"
#include "sketch/internal/sketch_lobes.h"
#include "sketch/internal/traced_point.h"
#include "sketch/internal/view_angles.h"

namespace goniochrome::sketch {

namespace {

constexpr double kGloss_deg = 60;  // of the reading that a paint found carries
constexpr int kMostSamples = 4;    // of a pixel; their mean lies within the spread of sixteen, 3 %

bool drawn(const image::AovFile& buffers, const char* effect) {
  return std::ranges::find(buffers.drawn, effect) != buffers.drawn.end();
}

formats::Basis basis_of(const envmap::PrefilteredEnvironment& env) {
  formats::Basis basis;
  basis.name = "environment";
  for (const envmap::PrefilteredLobe& lobe : env.lobes) basis.exponents.push_back(lobe.exponent);
  basis.mirror = env.mirror.map.size > 0;
  return basis;
}

// One paint for each column, with weight 1 in it and nowhere else. All have all lobes, so that each of them is drawn.
std::vector<paint::LobeFit> unit_paints(const formats::Basis& basis, double coat_index) {
  paint::LobeFit blank;
  blank.coat_index = coat_index;
  for (const double exponent : basis.exponents) blank.lobes.push_back({exponent, {}, {}});
  blank.lobes.push_back({paint::kMirrorExponent, {}, {}});
  std::vector<paint::LobeFit> paints(search_columns(basis), blank);
  const color::Rgb one{1, 1, 1};
  paints.front().diffuse = one;
  for (std::size_t j = 0; j < basis.exponents.size(); ++j)
    paints[1 + 2 * j].lobes[j].directional_diffuse = one, paints[2 + 2 * j].lobes[j].gloss = one;
  if (basis.mirror) paints.back().lobes.back().gloss = one;
  return paints;
}

class Shading {
 public:
  // `env` is null where lamps are all the light there is.
  Shading(const image::AovFile& buffers, const envmap::PrefilteredEnvironment* env, formats::Basis basis, int normal,
          int part)
      : buffers_(buffers), env_(env), basis_(std::move(basis)), normal_(normal), part_(part) {
    // The narrow highlight of a lamp is summed over all samples, as it was drawn.
    const int most = env != nullptr ? kMostSamples : buffers.samples;
    if (buffers.samples > 1) shifts_ = render::sample_shifts(std::min(buffers.samples, most));
    render::Scene scene;
    if (drawn(buffers, "coat")) {
      coat_index_ = brdf::kCoatIndex;
      if (env != nullptr) coat_diffuse_ = envmap::coat_diffuse_map(*env);
    }
    scene.paints = unit_paints(basis_, coat_index_);
    scene.env = env;
    for (const image::AovLight& light : buffers.lights) scene.lights.push_back(render::light_of(light));
    scene.gloss_deg.assign(scene.paints.size(), kGloss_deg);
    if (!lamps_are_discs(buffers))
      for (render::Light& lamp : scene.lights) lamp.radius_rad = 0;
    render::Effects effects = render::effects_of(scene);
    effects.fresnel = fresnel_ = drawn(buffers, "fresnel");
    effects.horizon = drawn(buffers, "horizon");
    weights_ = render::UnitWeights(scene, effects, basis_.exponents, coat_index_);
    std::vector<render::Light> lights = scene.lights;
    if (env != nullptr && drawn(buffers, "spots")) take_out_spots(*env, lights);
    if (env_ != nullptr)
      for (const envmap::PrefilteredLobe& lobe : env_->lobes) maps_.push_back(&lobe.map);
    for (const render::Light& light : lights) {
      if (light.radius_rad > 0) {
        discs_.push_back(weights_.disc(light));
      } else {
        points_.push_back(light);
      }
    }
  }

  const formats::Basis& basis() const { return basis_; }
  double coat_index() const { return coat_index_; }

  // The mean over the samples of the pixel, whose normals follow from those of the pixels around.
  void shade(std::uint32_t place, Vec3* column) const {
    const int x = static_cast<int>(place) % buffers_.image.width, y = static_cast<int>(place) / buffers_.image.width;
    const Vec3 n = normal(x, y), right = change(x - 1, y, x + 1, y), down = change(x, y - 1, x, y + 1);
    const std::size_t columns = search_columns(basis_);
    std::fill_n(column, columns, Vec3{});
    const double share = 1 / (buffers_.white_luminance * static_cast<double>(shifts_.size()));
    const double spread = mirror_spread(x, y) / std::sqrt(static_cast<double>(shifts_.size()));
    for (const auto& [dx, dy] : shifts_)
      add_sample(normalized(n + dx * right + dy * down), buffers_.to_viewer(x + dx, y + dy), spread, share, column);
  }

 private:
  struct View {
    Vec3 normal, to_viewer, mirrored;
    double cos_o;
    double spread = 0;  // of the mirror directions of a sample, as render/glints.h has it
  };

  Vec3 normal(int x, int y) const {
    const float* pixel = buffers_.image.pixel(x, y) + normal_;
    return {pixel[0], pixel[1], pixel[2]};
  }

  // The change of the normal for each pixel, from one to the other beyond a pixel; none where they lie on two parts.
  Vec3 change(int x0, int y0, int x1, int y1) const {
    if (x0 < 0 || y0 < 0 || x1 >= buffers_.image.width || y1 >= buffers_.image.height) return {};
    if (buffers_.image.pixel(x0, y0)[part_] != buffers_.image.pixel(x1, y1)[part_]) return {};
    return 0.5 * (normal(x1, y1) - normal(x0, y0));
  }

  // The spread of the pixel, as the renderer has it.
  double mirror_spread(int x, int y) const {
    const auto mirrored = [&](int i, int j) {
      const Vec3 n = normal(i, j), viewer = buffers_.to_viewer(i, j);
      return 2 * dot(n, viewer) * n - viewer;
    };
    const auto same = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < buffers_.image.width && j < buffers_.image.height &&
             buffers_.image.pixel(i, j)[part_] == buffers_.image.pixel(x, y)[part_];
    };
    return render::mirror_spread(render::change_beside(mirrored, same, x, y, 1, 0),
                                 render::change_beside(mirrored, same, x, y, 0, 1));
  }

  void add_sample(const Vec3& n, const Vec3& wo, double spread, double scale, Vec3* column) const {
    const View view{n, wo, 2 * dot(n, wo) * n - wo, std::clamp(dot(n, wo), 0.0, 1.0), spread};
    if (env_ != nullptr) add_environment(*env_, view, scale, column);
    for (const render::Light& light : points_) add_light(light, view, scale, column);
    for (std::size_t i = 0; i < discs_.size(); ++i) add_disc(i, view, scale, column);
  }

  void add_environment(const envmap::PrefilteredEnvironment& env, const View& view, double scale, Vec3* column) const {
    const std::size_t last = search_columns(basis_) - 1;
    const bool bare = coat_index_ == paint::kNoCoat;
    const double c = view.cos_o;
    const color::Rgb at_normal = envmap::bilinear(bare ? env.diffuse.map : *coat_diffuse_, view.normal);
    weights_.add_diffuse(at_normal, c, scale, column);
    weights_.add_lobes(maps_, at_normal, view.normal, view.mirrored, c, scale, column);
    if (basis_.mirror)
      column[last] += scale * weights_.at(last, weights_.table().mirror_slot(), c) *
                      envmap::bilinear(env.mirror.map, view.mirrored);
  }

  // Lamps take the place of the spots in the maps, as in the engines.
  void take_out_spots(const envmap::PrefilteredEnvironment& env, std::vector<render::Light>& lights) {
    rest_ = env;
    rest_.diffuse.map = *envmap::open_diffuse_map(env, env.spots.size());
    if (coat_diffuse_ != nullptr) coat_diffuse_ = envmap::open_coat_diffuse_map(env, env.spots.size());
    for (std::size_t i = 0; i < env.lobes.size(); ++i)
      rest_.lobes[i].map = *envmap::open_map(env, env.lobes[i], env.spots.size());
    for (const envmap::Spot& spot : env.spots) lights.push_back(render::light_of(spot));
    env_ = &rest_;
  }

  void add_disc(std::size_t number, const View& view, double scale, Vec3* column) const {
    const render::UnitWeights::Disc& disc = discs_[number];
    if (dot(view.normal, disc.light.direction) <= -std::sin(disc.light.radius_rad)) return;
    weights_.add_diffuse(disc, view.normal, view.cos_o, scale, column);
    weights_.add_lobes(disc, view.normal, view.to_viewer, view.mirrored, scale, column);
    const std::size_t last = search_columns(basis_) - 1;
    const bool shown = basis_.mirror && disc.light.mirrored;
    const double mirrored = shown ? render::mirrored_share(disc.light, view.mirrored, view.spread) : 0;
    if (mirrored > 0)
      column[last] += weights_.at(last, weights_.table().lamp_mirror_slot(), view.cos_o) *
                      (mirrored * scale * disc.light.radiance());
  }

  void add_light(const render::Light& light, const View& view, double scale, Vec3* column) const {
    const double cos_i = dot(view.normal, light.direction), c = view.cos_o;
    if (cos_i <= 0) return;
    const Vec3 apart = view.mirrored - light.direction, white = scale * kPi * light.white;
    const double cos_half = std::sqrt(0.5 + 0.5 * dot(light.direction, view.to_viewer));
    const double coat = fresnel_ ? brdf::fresnel_dielectric(cos_half, brdf::kCoatIndex) : 1;
    const double base = cos_i * brdf::coat_transmission(std::min(cos_i, 1.0), coat_index_);
    const render::WeightTable& table = weights_.table();
    column[0] += base * weights_.at(0, table.light_slot(), c) * white;
    for (std::size_t j = 0; j < basis_.exponents.size(); ++j) {
      const double power = math::cos_power_from_versine(0.5 * dot(apart, apart), basis_.exponents[j]);
      const std::size_t flake = 1 + 2 * j, gloss = flake + 1;
      column[flake] += base * power * weights_.at(flake, table.directional_diffuse_slot(j), c) * white;
      column[gloss] += coat * power * weights_.at(gloss, table.gloss_slot(j), c) * white;
    }
  }

  const image::AovFile& buffers_;
  const envmap::PrefilteredEnvironment* env_;
  envmap::PrefilteredEnvironment rest_;       // without bright spots
  std::vector<const envmap::CubeMap*> maps_;  // of the lobes of the basis
  formats::Basis basis_;
  int normal_, part_;                                     // channels
  std::vector<std::array<double, 2>> shifts_ = {{0, 0}};  // of the samples of a pixel from its center
  std::vector<render::Light> points_;                     // lamps without extent, and with it
  std::vector<render::UnitWeights::Disc> discs_;
  double coat_index_ = paint::kNoCoat;
  envmap::MapPointer coat_diffuse_;
  bool fresnel_ = false;
  render::UnitWeights weights_;
};

}  // namespace

namespace {

Result<SketchLight> light_by(const image::AovFile& buffers, const envmap::PrefilteredEnvironment* env,
                             const formats::Basis& basis) {
  GONIO_ASSIGN(const int normal, buffers.channel("normal.X"));
  GONIO_ASSIGN(const int part, buffers.channel("part"));
  if (!buffers.has_rays)
    return input_error("{}: its header lacks goniochrome:rays: render the buffers again", buffers.path);
  if (std::ranges::any_of(buffers.lights, [](const image::AovLight& light) { return light.is_placed; }))
    return input_error(
        "{}: it was drawn with a lamp at a place, and the buffers hold no places: give the buffers of a lamp far away, "
        "or of render-osmesa --aov transport",
        buffers.path);
  const auto shading = std::make_shared<const Shading>(buffers, env, basis, normal, part);
  SketchLight light{shading->basis(),
                    {},
                    [shading](std::uint32_t place, Vec3* out) { shading->shade(place, out); },
                    shading->coat_index()};
  if (drawn(buffers, "operator")) light.reflection = buffers.reflection;
  return light;
}

}  // namespace

bool lamps_are_discs(const image::AovFile& buffers) {
  return std::ranges::any_of(buffers.lights, [](const image::AovLight& light) { return light.extent_deg > 0; }) &&
         std::ranges::find(buffers.left_out, "extent") == buffers.left_out.end();
}

Result<SketchLight> sketch_light(const image::AovFile& buffers, const envmap::PrefilteredEnvironment& env) {
  return light_by(buffers, &env, basis_of(env));
}

Result<SketchLight> lamp_light(const image::AovFile& buffers, const formats::Basis& basis) {
  return light_by(buffers, nullptr, basis);
}

namespace {

// The variance of the samples of a pixel about its center, along a row.
double half_variance(int samples) {
  double sum = 0;
  for (const auto& [dx, dy] : render::sample_shifts(samples)) sum += 0.5 * dx * dx / samples;
  return sum;
}

// The factor of the light of a transport for paints under another coat, at one point.
struct CoatChange {
  double base = 1, mirror = 1;
};

// Adds to the columns what a point gathers, times its share; `factors` of each point's bounced light, or null.
void add_point(const render::LobeTransport& t, std::size_t point, const std::vector<color::Rgb>* factors,
               const CoatChange& coat, double share, Vec3* columns) {
  const double gloss = 1 / brdf::fresnel_dielectric(std::cos(kGloss_deg * kDegree), brdf::kCoatIndex);
  for (std::size_t k = 0; k < t.columns.count(); ++k) {
    const color::Rgb direct = t.light(point, k, false);
    color::Rgb bounced = t.light(point, k) - direct;
    if (factors != nullptr) bounced = (*factors)[point] * bounced;
    const bool scaled = t.columns.is_gloss(k) && k != t.columns.mirror();
    const double change = k == t.columns.mirror() ? coat.mirror : scaled ? gloss : coat.base;
    columns[k] += share * change * (direct + bounced);
  }
}

}  // namespace

Result<std::optional<SketchTransport>> SketchTransport::of(const image::AovFile& buffers) {
  GONIO_ASSIGN(auto read, render::transport_of(buffers));
  if (!read) return std::optional<SketchTransport>();
  SketchTransport transport;
  transport.transport_ = std::make_shared<const render::LobeTransport>(*std::move(read));
  if (buffers.reflection.k != color::component_wise().k) transport.reflection_ = buffers.reflection;
  if (const ViewAngles views(buffers); views.are_known()) {
    std::vector<float> cosines;
    for (const std::uint32_t place : transport.transport_->places)
      cosines.push_back(static_cast<float>(math::cos(views.at(place) * kDegree)));
    transport.cosines_ = std::make_shared<const std::vector<float>>(std::move(cosines));
  }
  return std::optional<SketchTransport>(std::move(transport));
}

int SketchTransport::samples() const {
  return transport_->samples;
}

double SketchTransport::coat_index() const {
  const std::vector<double>& coats = transport_->worn.coats;
  return coats.empty() ? paint::kNoCoat : *std::ranges::max_element(coats);
}

// The columns of a transport are those of the search; its gloss has the coat's reflectance in it, the search's has it
// relative to that of the reading. A column that bends by d from pixel to pixel is, in the mean over samples of the
// variance v about the center, off by v d/2 from its value there: this corrects for the different samples of the
// picture and the transport.
SketchLight SketchTransport::light(int samples, double coat_index) const {
  formats::Basis basis;
  basis.name = "transport", basis.exponents = transport_->columns.exponents, basis.mirror = true;
  const double bend = half_variance(samples) - half_variance(transport_->samples), traced = this->coat_index();
  const bool same_coat = coat_index == traced || traced == paint::kNoCoat || cosines_ == nullptr;
  const auto shade = [transport = transport_, factors = factors_, cosines = same_coat ? nullptr : cosines_, bend,
                      traced, coat_index](std::uint32_t place, Vec3* out) {
    const render::LobeTransport& t = *transport;
    std::fill_n(out, t.columns.count(), Vec3{});
    const int x = static_cast<int>(place) % t.width, y = static_cast<int>(place) / t.width;
    const auto own = point_at(t, x, y);
    if (!own) return;
    CoatChange coat;
    if (cosines != nullptr) {
      const double cosine = (*cosines)[*own];
      coat = {brdf::base_change(cosine, traced, coat_index), brdf::mirror_change(cosine, traced, coat_index)};
    }
    double share = 1;
    const auto add_bend = [&](const std::optional<std::size_t>& before, const std::optional<std::size_t>& behind) {
      if (!before || !behind || t.part[*before] != t.part[*own] || t.part[*behind] != t.part[*own]) return;
      for (const std::size_t point : {*before, *behind}) add_point(t, point, factors.get(), coat, bend, out);
      share -= 2 * bend;
    };
    if (bend != 0) {
      add_bend(point_at(t, x - 1, y), point_at(t, x + 1, y));
      add_bend(point_at(t, x, y - 1), point_at(t, x, y + 1));
    }
    add_point(t, *own, factors.get(), coat, share, out);
  };
  return {basis, reflection_, shade, same_coat ? traced : coat_index};
}

std::vector<int> SketchTransport::mesh_parts() const {
  std::vector<int> parts(transport_->worn.brushed.size());
  std::iota(parts.begin(), parts.end(), 1);
  return parts;
}

image::Image SketchTransport::worn_picture() const {
  const render::LobeTransport& t = *transport_;
  std::vector<render::TransportPaint> paints;
  for (const int group : t.worn.groups.of_part)
    paints.push_back({{0}, {t.worn.weights[static_cast<std::size_t>(group)]}});
  render::BounceScale unscaled;
  unscaled.of_class.assign(t.worn.groups.classes(), {1, 1, 1});
  image::Image picture{t.width, t.height, 4, {}, {"R", "G", "B", "A"}};
  picture.data.assign(4 * static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height), 0);
  render::TransportShader(t, {}).shade(paints, reflection_ ? &*reflection_ : nullptr, unscaled, 1, picture);
  return picture;
}

double SketchTransport::wear(const std::vector<color::Rgb>& weights, double coat_index, const std::vector<int>& parts) {
  const render::LobeTransport& t = *transport_;
  if (t.bounces == 0) return 0;
  formats::Basis basis;
  basis.exponents = t.columns.exponents, basis.mirror = true;
  const double gloss = 1 / brdf::fresnel_dielectric(std::cos(kGloss_deg * kDegree), brdf::kCoatIndex);
  std::vector<color::Rgb> own =
      weights_of(basis, brdf::under_coat(lobes_of(basis, weights, coat_index), this->coat_index()));
  for (std::size_t k = 0; k < own.size(); ++k)
    if (t.columns.is_gloss(k) && k != t.columns.mirror()) own[k] = gloss * own[k];
  std::vector<std::vector<color::Rgb>> worn;
  for (std::size_t part = 0; part < t.worn.groups.of_part.size(); ++part) {
    const bool meant = std::ranges::find(parts, static_cast<int>(part) + 1) != parts.end();
    worn.push_back(meant ? own : t.worn.weights[static_cast<std::size_t>(t.worn.groups.of_part[part])]);
  }
  const render::BounceScale scale = render::bounce_scale(t, worn, reflection_ ? &*reflection_ : nullptr);
  std::vector<color::Rgb> factors(t.places.size());
  for (std::size_t i = 0; i < factors.size(); ++i) factors[i] = render::bounce_factor(t, i, scale);
  factors_ = std::make_shared<const std::vector<color::Rgb>>(std::move(factors));
  return scale.error_p95_de00;
}

std::vector<std::string> effects_without_light(const image::AovFile& buffers) {
  std::vector<std::string> missing;
  for (const char* effect : {"anisotropy", "travel", "texture"})
    if (drawn(buffers, effect)) missing.emplace_back(effect);
  return missing;
}

}  // namespace goniochrome::sketch
