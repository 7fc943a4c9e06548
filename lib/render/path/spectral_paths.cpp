#include "render/path/spectral_paths.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/internal/wear.h"
#include "render/path/path_loop.h"

namespace goniochrome::render {

namespace {

using color::kBands;
using rays::Float3;
using rays::Spot;
using Floats = std::array<float, kBands>;

Floats floats(const color::Bands& bands, double scale = 1) {
  Floats result;
  for (std::size_t b = 0; b < result.size(); ++b) result[b] = static_cast<float>(scale * bands[b]);
  return result;
}

void add(Floats& sum, float scale, const Floats& x) {
  for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += scale * x[b];
}

Floats product(Floats x, const Floats& y) {
  for (std::size_t b = 0; b < x.size(); ++b) x[b] *= y[b];
  return x;
}

color::Rgb gray(double value) {
  return value * color::Rgb{1, 1, 1};
}

// The scene whose paints and lamps are the means over the bands.
Scene mean_scene(const Scene& scene) {
  Scene mean = scene;
  const SceneSpectra& spectra = *scene.spectra;
  mean.spectra = nullptr;
  mean.reflection = color::component_wise();
  for (std::size_t part = 0; part < mean.paints.size(); ++part)
    mean.paints[part] = paint::mean_lobes(spectra.paints[part]);
  for (std::size_t i = 0; i < mean.lights.size(); ++i) mean.lights[i].white = gray(color::mean(spectra.lights[i]));
  return mean;
}

// True if gloss and mirror are the same in all bands, so that a rough coat can stand for them.
bool is_coat_gray(const paint::BandLobes& lobes) {
  const auto even = [](const color::Bands& bands) {
    constexpr double kEven = 1e-9;
    const double mean = color::mean(bands);
    return std::ranges::all_of(bands, [&](double v) { return std::abs(v - mean) <= kEven * std::abs(mean); });
  };
  return std::ranges::all_of(lobes.views, [&](const paint::BandWeights& view) {
    return even(view.mirror) && std::ranges::all_of(view.gloss, even);
  });
}

Result<void> check_spectra(const PathScene& path_scene) {
  const Scene& scene = *path_scene.scene;
  const SceneSpectra& spectra = *scene.spectra;
  if (spectra.paints.size() != scene.paints.size() || spectra.lights.size() != scene.lights.size())
    return input_error("{} paints and {} lights with spectra: the scene has {} and {}", spectra.paints.size(),
                       spectra.lights.size(), scene.paints.size(), scene.lights.size());
  if (path_scene.ground && path_scene.ground->kind == Ground::Kind::kShadow)
    return input_error("a floor that shows an environment has no spectra");
  if (path_scene.ground && !spectra.floor) return input_error("the paint of the floor has no spectra");
  if (scene.layer != nullptr) return input_error("textures and color maps have no spectra");
  const auto fine = [](const color::Bands& bands) {
    return std::ranges::all_of(bands, [](double v) { return std::isfinite(v) && v >= 0; });
  };
  if (!std::ranges::all_of(spectra.emission, fine) || !std::ranges::all_of(spectra.lights, fine))
    return input_error("light in bands must be finite and not negative");
  return {};
}

}  // namespace

// The numbers of lobes are those of TracedPaint: ascending exponents of the lobes with weight. A rough coat stands for
// gloss and mirror.
SpectralPaths::Paint SpectralPaths::laid_out(const paint::BandLobes& lobes, double gloss_deg, bool rough) {
  const double gloss_scale = 1 / brdf::fresnel_dielectric(std::cos(gloss_deg * kDegree), brdf::kCoatIndex);
  Paint paint;
  paint.resize(lobes.views.size());
  for (std::size_t v = 0; v < lobes.views.size(); ++v) {
    paint[v].diffuse = floats(lobes.views[v].diffuse);
    paint[v].mirror = floats(lobes.views[v].mirror, rough ? 0 : 1);
  }
  for (std::size_t j = 0; j < lobes.exponents.size(); ++j) {
    const bool any = std::ranges::any_of(lobes.views, [&](const paint::BandWeights& view) {
      return color::mean(view.directional_diffuse[j]) != 0 || color::mean(view.gloss[j]) != 0;
    });
    if (!any) continue;
    for (std::size_t v = 0; v < lobes.views.size(); ++v) {
      paint[v].directional_diffuse.push_back(floats(lobes.views[v].directional_diffuse[j]));
      paint[v].gloss.push_back(floats(lobes.views[v].gloss[j], rough ? 0 : gloss_scale));
    }
  }
  return paint;
}

Result<Transport> SpectralPaths::transport(const PathScene& path_scene) {
  GONIO_TRY(check_spectra(path_scene));
  const SceneSpectra& spectra = *path_scene.scene->spectra;
  const Scene mean = mean_scene(*path_scene.scene);
  PathScene means = path_scene;
  means.scene = &mean;
  means.rough_coats = path_scene.rough_coats && std::ranges::all_of(spectra.paints, is_coat_gray) &&
                      (!spectra.floor || is_coat_gray(*spectra.floor));
  means.emission.clear();
  for (const color::Bands& bands : spectra.emission) means.emission.push_back(gray(color::mean(bands)));
  if (means.ground) means.ground->paint = paint::mean_lobes(*spectra.floor);
  GONIO_ASSIGN(Transport transport, Transport::in_channels(means));

  auto paths = std::make_shared<SpectralPaths>();
  paths->eye_ = spectra.eye.weights();
  for (std::size_t part = 0; part < spectra.paints.size(); ++part) {
    paths->paints_.push_back(
        laid_out(spectra.paints[part], gloss_deg_of(mean, part), transport.paints_[part].has_rough_coat()));
  }
  if (spectra.floor)
    paths->paints_.push_back(
        laid_out(*spectra.floor, brdf::kGlossIncidence_deg, transport.paints_.back().has_rough_coat()));
  for (const color::Bands& bands : spectra.emission) paths->emission_.push_back(floats(bands));
  // The mean is the radiance of the transport's own lamps, which grow with nearness.
  for (const color::Bands& bands : spectra.lights) {
    const double size = color::mean(bands);
    paths->lights_.push_back(size > 0 ? floats(bands, 1 / size) : kDark);
  }
  transport.spectral_ = std::move(paths);
  return transport;
}

// Light in bands along a path, in the sum of many paths. The lamps and emitters of the transport are gray; their bands
// are those of this scene.
class SpectralPaths::Bands {
 public:
  static constexpr bool kWeighsLamps = true;
  Bands(const SpectralPaths& scene, Carrier& sum) : scene_(scene), sum_(sum) { path_.fill(1); }

  PaintedPoint::Shares reflected(const Transport::Vertex& vertex, const Float3& to_light) const {
    return vertex.painted.shares(to_light);
  }
  void add_reflected(const Transport::Vertex& vertex, const PaintedPoint::Shares& f, double scale,
                     const PathLight& light) {
    const Light of = light_of(light);
    render::add(sum_, static_cast<float>(scale * of.size), product(product(path_, f_cos(vertex, f)), of.bands));
  }
  void add(double scale, const PathLight& light) {
    const Light of = light_of(light);
    render::add(sum_, static_cast<float>(scale * of.size), product(path_, of.bands));
  }
  void reflect(const Transport::Vertex& vertex, const PaintedPoint::Shares& f, double scale) {
    path_ = product(path_, f_cos(vertex, f));
    this->scale(scale);
  }
  void mirror(const Transport::Vertex& vertex, double scale) {
    Carrier sum{};
    const float coat = vertex.painted.coat_mirror();
    blend(vertex, [&](const View& view, float part) { render::add(sum, part * coat, view.mirror); });
    path_ = product(path_, sum);
    this->scale(scale);
  }
  void scale(double factor) {
    for (float& band : path_) band *= static_cast<float>(factor);
  }
  double size() const { return std::ranges::max(path_); }

 private:
  struct Light {
    double size;
    const Carrier& bands;
  };
  Light light_of(const PathLight& light) const {
    if (light.source == PathLight::Source::kEmitter) return {1, scene_.emission(light.number)};
    return {light.rgb.y, scene_.lights_[static_cast<std::size_t>(light.number)]};
  }
  Carrier f_cos(const Transport::Vertex& vertex, const PaintedPoint::Shares& shares) const {
    Carrier sum{};
    if (vertex.is_white) {
      sum.fill(rays::kInversePi * shares.diffuse());
      return sum;
    }
    sum.fill(shares.coat);
    blend(vertex, [&](const View& view, float part) {
      render::add(sum, part * shares.diffuse(), view.diffuse);
      for (std::size_t j = 0; j < view.gloss.size(); ++j) {
        if (shares.directional_diffuse(j) > 0)
          render::add(sum, part * shares.directional_diffuse(j), view.directional_diffuse[j]);
        if (shares.gloss(j) > 0) render::add(sum, part * shares.gloss(j), view.gloss[j]);
      }
    });
    return sum;
  }
  template <class Visit>
  void blend(const Transport::Vertex& vertex, const Visit& visit) const {
    const Paint& paint = scene_.paints_[static_cast<std::size_t>(vertex.spot.part)];
    const PaintedPoint::Between& between = vertex.painted.between();
    if (between.share < 1) visit(paint[between.low], 1 - between.share);
    if (between.share > 0) visit(paint[between.high], between.share);
  }

  const SpectralPaths& scene_;
  Carrier& sum_;
  Carrier path_;
};

color::Rgb SpectralPaths::emitted(const Spot& spot) const {
  const Carrier& bands = emission(spot.part);
  color::Rgb sum;
  for (std::size_t b = 0; b < bands.size(); ++b) sum += bands[b] * eye_[b];
  return sum;
}

void SpectralPaths::add_path(const Transport& transport, const PathOptions& options, const Spot& spot,
                             const Float3& to_viewer, const Sequence& sequence, std::uint32_t index,
                             Carrier& sum) const {
  const Transport::Vertex seen =
      options.white ? Transport::Vertex(spot, to_viewer) : Transport::Vertex(transport, spot, to_viewer);
  if (seen.painted.black()) return;
  Bands light(*this, sum);
  const Transport::Next next = transport.step(seen, sequence.point(index, 0), sequence.point(index, 1), light);
  if (next.goes_on() && next.hit.any() && options.bounces > 0)
    transport.follow(next.hit, next.start, next.direction, options.bounces, sequence, index, 2, light);
}

color::Rgb SpectralPaths::shown(const Transport& transport, const PathOptions& options, const Spot& spot,
                                const Float3& to_viewer, const Sequence& sequence, std::uint32_t first,
                                std::uint32_t count) const {
  Carrier sum{};
  for (std::uint32_t i = first; i < first + count; ++i) add_path(transport, options, spot, to_viewer, sequence, i, sum);
  color::Rgb shown;
  for (std::size_t b = 0; b < sum.size(); ++b) shown += sum[b] * eye_[b];
  return (1.0 / count) * shown;
}

Result<Transport> Transport::create(const PathScene& path_scene) {
  const Scene& scene = *path_scene.scene;
  if (scene.mesh == nullptr) return input_error("a scene without a mesh: there is nothing to trace");
  const bool in_bands = scene.spectra != nullptr && path_scene.environment == nullptr;
  return in_bands ? SpectralPaths::transport(path_scene) : in_channels(path_scene);
}

}  // namespace goniochrome::render
