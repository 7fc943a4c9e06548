#include "sketch/sketch_light.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"
#include "render/aov.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/glints.h"
#include "render/light_transport.h"
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

class Shading {
 public:
  // `env` is null where lamps are all the light there is. Error: as OpenLight::create().
  static Result<Shading> create(const image::AovFile& buffers, const envmap::PrefilteredEnvironment* env,
                                formats::Basis basis, int normal, int part) {
    Shading shading(buffers, std::move(basis), normal, part);
    // The narrow highlight of a lamp is summed over all samples, as it was drawn.
    const int most = env != nullptr ? kMostSamples : buffers.samples;
    if (buffers.samples > 1) shading.shifts_ = render::sample_shifts(std::min(buffers.samples, most));
    if (drawn(buffers, "coat")) shading.coat_index_ = brdf::kCoatIndex;
    render::Scene scene;
    scene.env = env;
    for (const image::AovLight& light : buffers.lights) scene.lights.push_back(render::light_of(light));
    if (!lamps_are_discs(buffers))
      for (render::Light& lamp : scene.lights) lamp.radius_rad = 0;
    shading.lamps_ = scene.lights;
    shading.fresnel_ = drawn(buffers, "fresnel");
    const render::LobeColumns columns{shading.basis_.exponents};
    GONIO_ASSIGN(auto open, render::OpenLight::create(scene, columns, {shading.coat_index_},
                                                      {shading.fresnel_, drawn(buffers, "horizon"),
                                                       drawn(buffers, "spots"), shading.basis_.mirror}));
    shading.open_ = std::move(open);
    return shading;
  }

  const formats::Basis& basis() const { return basis_; }
  double coat_index() const { return coat_index_; }

  // The mean over the samples of the pixel, whose normals follow from those of the pixels around.
  void shade(std::uint32_t place, Vec3* column) const {
    const int x = static_cast<int>(place) % buffers_.image.width, y = static_cast<int>(place) / buffers_.image.width;
    const Vec3 n = normal(x, y), right = change(x - 1, y, x + 1, y), down = change(x, y - 1, x, y + 1);
    const std::size_t columns = search_columns(basis_);
    const double spread = mirror_spread(x, y) / std::sqrt(static_cast<double>(shifts_.size()));
    std::vector<render::OpenView> views;
    for (const auto& [dx, dy] : shifts_)
      views.push_back({normalized(n + dx * right + dy * down), buffers_.to_viewer(x + dx, y + dy)});
    std::vector<color::Rgb> light(columns + 1);
    open_->mean(views, 0, light.data());
    // Gloss of the search is relative to the coat at the angle of its reading.
    const double gloss_deg = fresnel_ ? kGloss_deg : brdf::kGlossIncidence_deg,
                 gloss = 1 / brdf::fresnel_dielectric(std::cos(gloss_deg * kDegree), brdf::kCoatIndex);
    for (std::size_t k = 0; k < columns; ++k)
      column[k] = ((k > 0 && k % 2 == 0 ? gloss : 1) / buffers_.white_luminance) * light[k];
    for (const render::OpenView& view : views) add_images(view, spread, column[columns - 1]);
  }

 private:
  Shading(const image::AovFile& buffers, formats::Basis basis, int normal, int part)
      : buffers_(buffers), basis_(std::move(basis)), normal_(normal), part_(part) {}

  Vec3 normal(int x, int y) const { return vec3(buffers_.image.pixel(x, y) + normal_); }

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

  // The mirror shows the lamps themselves.
  void add_images(const render::OpenView& view, double spread, Vec3& mirror) const {
    if (!basis_.mirror) return;
    const double cos_o = std::clamp(dot(view.normal, view.to_viewer), 0.0, 1.0);
    const double coat = fresnel_ ? brdf::fresnel_dielectric(cos_o, brdf::kCoatIndex) : 1;
    const Vec3 mirrored = 2 * dot(view.normal, view.to_viewer) * view.normal - view.to_viewer;
    for (const render::Light& lamp : lamps_)
      if (lamp.radius_rad > 0)
        mirror += (coat * render::mirrored_share(lamp, mirrored, spread) /
                   (buffers_.white_luminance * static_cast<double>(shifts_.size()))) *
                  lamp.radiance();
  }

  const image::AovFile& buffers_;
  formats::Basis basis_;
  int normal_, part_;                                     // channels
  std::vector<std::array<double, 2>> shifts_ = {{0, 0}};  // of the samples of a pixel from its center
  std::vector<render::Light> lamps_;
  double coat_index_ = paint::kNoCoat;
  bool fresnel_ = false;
  std::optional<render::OpenLight> open_;
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
  GONIO_ASSIGN(auto made, Shading::create(buffers, env, basis, normal, part));
  const auto shading = std::make_shared<const Shading>(std::move(made));
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
  image::Image picture = image::even_image(t.width, t.height, 4, {"R", "G", "B", "A"});
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
