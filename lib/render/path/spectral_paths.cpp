#include "render/path/spectral_paths.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render {

namespace {

using color::kBands;
using rays::Float3;
using rays::Hit;
using rays::Spot;
using Floats = std::array<float, kBands>;

// As paths of three channels end, see transport.cpp.
constexpr int kRouletteFrom = 3, kEndlessFrom = 64, kMostBounces = 4096;
constexpr float kEndlessChance = 0.9F, kLeastChance = 0.05F;

Floats floats(const color::Bands& bands, double scale = 1) {
  Floats result;
  for (std::size_t b = 0; b < result.size(); ++b) result[b] = static_cast<float>(scale * bands[b]);
  return result;
}

void add(Floats& sum, float scale, const Floats& x) {
  for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += scale * x[b];
}

void add_product(Floats& sum, float scale, const Floats& x, const Floats& y, const Floats& z) {
  for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += scale * x[b] * y[b] * z[b];
}

void multiply(Floats& path, float scale, const Floats& x) {
  for (std::size_t b = 0; b < path.size(); ++b) path[b] *= scale * x[b];
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

// Whether gloss and mirror are the same in all bands, so that a rough coat can stand for them.
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
  paint.views.resize(lobes.views.size());
  for (std::size_t v = 0; v < lobes.views.size(); ++v) {
    paint.views[v].diffuse = floats(lobes.views[v].diffuse);
    paint.views[v].mirror = floats(lobes.views[v].mirror, rough ? 0 : 1);
  }
  for (std::size_t j = 0; j < lobes.exponents.size(); ++j) {
    const bool any = std::ranges::any_of(lobes.views, [&](const paint::BandWeights& view) {
      return color::mean(view.directional_diffuse[j]) != 0 || color::mean(view.gloss[j]) != 0;
    });
    if (!any) continue;
    for (std::size_t v = 0; v < lobes.views.size(); ++v) {
      paint.views[v].directional_diffuse.push_back(floats(lobes.views[v].directional_diffuse[j]));
      paint.views[v].gloss.push_back(floats(lobes.views[v].gloss[j], rough ? 0 : gloss_scale));
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
  GONIO_ASSIGN(Transport transport, Transport::create(means));

  auto paths = std::make_shared<SpectralPaths>();
  paths->eye_ = spectra.eye.weights();
  for (std::size_t part = 0; part < spectra.paints.size(); ++part) {
    const double gloss_deg = part < mean.gloss_deg.size() ? mean.gloss_deg[part] : brdf::kGlossIncidence_deg;
    paths->paints_.push_back(laid_out(spectra.paints[part], gloss_deg, transport.paints_[part].has_rough_coat()));
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

// A surface on the way of a path: its paint as it is drawn from, and in bands.
class SpectralPaths::Vertex {
 public:
  Vertex(const Transport& transport, const std::vector<Paint>& paints, const Spot& at, const Float3& to_viewer)
      : spot(at),
        painted(transport.painted(at, to_viewer)),
        receiver(transport.receiver(at, painted)),
        paint_(&paints[static_cast<std::size_t>(at.part)]),
        between_(painted.between()) {
    const double mirror = painted.mirror_weight(), lobes = painted.lobes_weight();
    mirror_chance = mirror > 0 ? mirror / (mirror + lobes) : 0;
    lobes_chance = (1 - mirror_chance) * (1 - receiver.chance());
  }
  // Matt white.
  Vertex(const Spot& at, const Float3& to_viewer)
      : spot(at), painted(Float3{rays::kInversePi, rays::kInversePi, rays::kInversePi}, at.shading, to_viewer) {}

  // f cos_i.
  Carrier reflected(const PaintedPoint::Shares& shares) const {
    Carrier sum{};
    if (paint_ == nullptr) {
      sum.fill(rays::kInversePi * shares.diffuse);
      return sum;
    }
    sum.fill(shares.coat);
    blend([&](const View& view, float part) {
      add(sum, part * shares.diffuse, view.diffuse);
      for (std::size_t j = 0; j < view.gloss.size(); ++j) {
        if (shares.directional_diffuse[j] > 0)
          add(sum, part * shares.directional_diffuse[j], view.directional_diffuse[j]);
        if (shares.gloss[j] > 0) add(sum, part * shares.gloss[j], view.gloss[j]);
      }
    });
    return sum;
  }
  Carrier mirrored() const {
    Carrier sum{};
    const float coat = painted.coat_mirror();
    blend([&](const View& view, float part) { add(sum, part * coat, view.mirror); });
    return sum;
  }

  Spot spot;
  PaintedPoint painted;
  double mirror_chance = 0;  // that the path goes on along the mirror direction
  BrightPlaces::Receiver receiver;
  double lobes_chance = 1;  // that it goes on by the lobes

 private:
  template <class Visit>
  void blend(const Visit& visit) const {
    if (between_.share < 1) visit(paint_->views[between_.low], 1 - between_.share);
    if (between_.share > 0) visit(paint_->views[between_.high], between_.share);
  }
  const Paint* paint_ = nullptr;
  PaintedPoint::Between between_;
};

// Where a path goes on.
struct SpectralPaths::Next {
  Float3 start, direction;
  // By the lobes, which are what finds light that was drawn for itself as well. 0: nowhere; infinite along the mirror
  // direction.
  double pdf = 0;
  Hit hit;
};

color::Rgb SpectralPaths::emitted(const Spot& spot) const {
  const Carrier& bands = emission(spot.part);
  color::Rgb sum;
  for (std::size_t b = 0; b < bands.size(); ++b) sum += bands[b] * eye_[b];
  return sum;
}

// A point on an emitter and one on a lamp, each weighed against the next ray, which may find it too (the balance
// heuristic, [Veach1995] 3.1).
void SpectralPaths::add_direct(const Transport& transport, const Vertex& vertex, const Carrier& path,
                               const std::array<double, 4>& emitter, const std::array<double, 4>& lamp,
                               Carrier& sum) const {
  const rays::RayScene& rays = transport.rays();
  const Float3& start = vertex.spot.start;
  if (!transport.emitters_.empty()) {
    const EmitterSample light = transport.emitters_.drawn(lit_point(vertex.spot), emitter[0], emitter[1], emitter[2]);
    if (light.pdf > 0) {
      const PaintedPoint::Shares shares = vertex.painted.shares(light.direction);
      if (shares.pdf > 0 && !rays.blocked(start, light.direction, Transport::kShort * light.distance))
        add_product(sum, static_cast<float>(1 / (light.pdf + vertex.lobes_chance * shares.pdf)), path,
                    vertex.reflected(shares), emission(light.part));
    }
  }
  if (transport.lights_.empty()) return;
  const auto count = static_cast<double>(transport.lights_.size());
  const double at = lamp[0] * count;
  const std::size_t number = std::min(transport.lights_.size() - 1, static_cast<std::size_t>(at));
  const Transport::SeenLamp seen = transport.seen_lamp(number, start);
  const Transport::LampSample sample = Transport::drawn_from(seen, at - static_cast<double>(number), lamp[1]);
  const PaintedPoint::Shares shares = vertex.painted.shares(sample.direction);
  if (!(shares.pdf > 0) || rays.blocked(start, sample.direction, sample.reach)) return;
  const double half_sine = std::sin(0.5 * seen.light.radius_rad), extent_sr = 4 * kPi * half_sine * half_sine;
  const double share = 1 / (1 + extent_sr * count * vertex.lobes_chance * shares.pdf);
  add_product(sum, static_cast<float>(share * count * sample.light.y), path, vertex.reflected(shares), lights_[number]);
}

SpectralPaths::Next SpectralPaths::next_ray(const Transport& transport, const Vertex& vertex,
                                            const std::array<double, 4>& numbers, Carrier& path) const {
  Next next;
  next.start = vertex.spot.start;
  const double others = 1 - vertex.mirror_chance;
  if (numbers[0] < vertex.mirror_chance) {
    multiply(path, static_cast<float>(1 / vertex.mirror_chance), vertex.mirrored());
    next.direction = vertex.painted.mirrored();
    next.pdf = std::numeric_limits<double>::infinity();
    next.hit = transport.rays().closest(next.start, next.direction);
    return next;
  }
  if (!(vertex.painted.lobes_weight() > 0)) return next;
  const Transport::Onward onward =
      transport.onward(vertex.spot, vertex.receiver, vertex.painted, (numbers[0] - vertex.mirror_chance) / others,
                       numbers[1], numbers[2]);
  if (!(onward.lobes_chance > 0)) return next;
  const PaintedPoint::Shares shares = vertex.painted.shares(onward.direction);
  if (!(shares.pdf > 0)) return next;
  next.direction = onward.direction, next.hit = onward.hit;
  next.pdf = vertex.lobes_chance * shares.pdf;
  multiply(path, static_cast<float>(1 / (next.pdf + others * onward.places_pdf)), vertex.reflected(shares));
  return next;
}

// The emitter and the lamps that the next ray found.
void SpectralPaths::add_found(const Transport& transport, const Vertex& vertex, const Next& next, const Carrier& path,
                              Carrier& sum) const {
  static constexpr Carrier kWhole = [] {
    Carrier ones{};
    ones.fill(1);
    return ones;
  }();
  const bool mirrored = std::isinf(next.pdf);
  const auto count = static_cast<double>(transport.lights_.size());
  for (std::size_t i = 0; i < transport.lights_.size(); ++i) {
    const Transport::SeenLamp lamp = transport.seen_lamp(i, next.start);
    if (!(lamp.light.radius_rad > 0) || !lamp.light.meets(rays::vec3(next.direction)) ||
        (next.hit.any() && next.hit.distance < lamp.reach))
      continue;
    const double half_sine = std::sin(0.5 * lamp.light.radius_rad), extent_sr = 4 * kPi * half_sine * half_sine;
    const double share = mirrored ? 1 : next.pdf / (next.pdf + 1 / (count * extent_sr));
    add_product(sum, static_cast<float>(share * lamp.light.radiance().y), path, kWhole, lights_[i]);
  }
  if (!next.hit.any() || next.hit.triangle == rays::kFloor) return;
  const int part = transport.rays().part(next.hit.triangle);
  if (transport.emitters_.radiance(part) == color::Rgb{}) return;
  const double light_pdf =
      transport.emitters_.pdf(lit_point(vertex.spot), next.hit.triangle, next.direction, next.hit.distance);
  const double share = mirrored ? 1 : next.pdf / (next.pdf + light_pdf);
  add_product(sum, static_cast<float>(share), path, kWhole, emission(part));
}

void SpectralPaths::add_path(const Transport& transport, const PathOptions& options, const Spot& spot,
                             const Float3& to_viewer, const Sequence& sequence, std::uint32_t index,
                             Carrier& sum) const {
  Carrier path;
  path.fill(1);
  Spot at = spot;
  Float3 viewer = to_viewer;
  const int most = std::min(options.bounces, kMostBounces);
  std::uint32_t set = 0;
  for (int surfaces = 0;; ++surfaces) {
    const Vertex vertex = surfaces == 0 && options.white ? Vertex(at, viewer) : Vertex(transport, paints_, at, viewer);
    if (vertex.painted.black()) return;
    const std::array<double, 4> onward = sequence.point(index, set++), emitter = sequence.point(index, set++),
                                lamp = transport.lights_.empty() ? emitter : sequence.point(index, set++);
    add_direct(transport, vertex, path, emitter, lamp, sum);
    const Next next = next_ray(transport, vertex, onward, path);
    if (!(next.pdf > 0)) return;
    add_found(transport, vertex, next, path, sum);
    if (!next.hit.any() || surfaces == most) return;
    if (surfaces >= kRouletteFrom) {
      const float worth = std::ranges::max(path) * static_cast<float>(transport.brightness(next.hit)),
                  chance = std::clamp(worth, kLeastChance, surfaces >= kEndlessFrom ? kEndlessChance : 1.0F);
      if (onward[3] >= chance) return;
      for (float& band : path) band /= chance;
    }
    at = transport.rays().spot(next.hit, next.start, next.direction);
    viewer = -next.direction;
  }
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

}  // namespace goniochrome::render
