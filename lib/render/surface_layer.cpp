#include "render/surface_layer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/internal/placed_lamps.h"

namespace goniochrome::render {

namespace {

std::uint64_t next_id() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

}  // namespace

SurfaceLayer::SurfaceLayer(const Scene& scene, std::vector<PartSurface> surfaces, brdf::CriticalAngle treatment,
                           const MipCube* mip)
    : scene_(scene), surfaces_(std::move(surfaces)), treatment_(treatment), id_(next_id()) {
  surfaces_.resize(scene.mesh->parts.size());
  laid_.resize(surfaces_.size());
  std::vector<std::vector<bool>> parts;  // of each layout
  std::vector<std::vector<TextureLaying>> layings;
  for (std::size_t part = 0; part < surfaces_.size(); ++part) {
    const PartSurface& surface = surfaces_[part];
    empty_ = empty_ && surface.textures.empty() && surface.color_map == nullptr;
    mapped_ = mapped_ || (surface.color_map != nullptr && !surface.hides_paint() && !scene.lights.empty());
    dims_ = dims_ || (!surface.textures.empty() && !surface.hides_paint());
    for (const LaidTexture& laid : surface.textures) {
      const std::size_t level = laid_[part].size();
      if (level == kMostLaid) break;
      textured_ = true;
      auto known = std::ranges::find(textures_, laid.texture);
      if (known == textures_.end()) known = textures_.insert(known, laid.texture);
      laid_[part].push_back({static_cast<std::size_t>(known - textures_.begin()), laid.repeat, laid.blends});
      if (level == parts.size()) {
        parts.emplace_back(surfaces_.size());
        layings.emplace_back(surfaces_.size());
      }
      parts[level][part] = true, layings[level][part] = laid.laying;
    }
  }
  if (!textured_) return;
  for (const brdf::SbrdfTexture* texture : textures_) means_.push_back(brdf::mean_texture(*texture));
  std::vector<const brdf::SbrdfTexture*> all = textures_;
  for (const brdf::SbrdfTexture& mean : means_) all.push_back(&mean);
  shader_ = std::make_unique<const SbrdfShader>(scene.env, mip, all);
  for (std::size_t level = 0; level < parts.size(); ++level)
    layouts_.push_back(std::make_unique<const TextureLayout>(*scene.mesh, parts[level], layings[level]));
}

SurfaceLayer::~SurfaceLayer() = default;

int SurfaceLayer::lobes() const {
  int most = 0;
  for (const brdf::SbrdfTexture* texture : textures_) most = std::max(most, texture->lobes);
  return most;
}

namespace {

template <class PlacesOf>
std::vector<TexturePlace> on_all(const std::vector<std::unique_ptr<const TextureLayout>>& layouts,
                                 const PlacesOf& places_of) {
  std::vector<TexturePlace> all;
  for (const auto& layout : layouts) {
    std::vector<TexturePlace> places = places_of(*layout);
    if (all.empty()) {
      all = std::move(places);
    } else {
      all.insert(all.end(), places.begin(), places.end());
    }
  }
  return all;
}

}  // namespace

std::vector<TexturePlace> SurfaceLayer::places(const Gbuffer& gbuffer) const {
  return on_all(layouts_, [&](const TextureLayout& layout) { return layout.places(gbuffer); });
}

std::vector<TexturePlace> SurfaceLayer::filtered_places(const Gbuffer& gbuffer,
                                                        const std::array<double, 2>& middle) const {
  return on_all(layouts_, [&](const TextureLayout& layout) { return layout.filtered_places(gbuffer, middle); });
}

void SurfaceLayer::put_places(const Gbuffer& gbuffer, int x, int y, double scale, VisiblePoint& point) const {
  const int part = gbuffer.part(x, y);
  if (part < 0 || gbuffer.triangles.empty()) return;
  const std::size_t count = laid_[static_cast<std::size_t>(part)].size();
  if (count == 0) return;
  const auto place = [&](std::size_t level) {
    TexturePlace here = layouts_[level]->place(gbuffer, x, y);
    for (float* step : {here.across, here.down})
      for (int c = 0; c < 2; ++c) step[c] = static_cast<float>(scale * step[c]);
    return here;
  };
  point.place = place(0);
  for (std::size_t level = 1; level < count; ++level) point.over.push_back(place(level));
  point.placed = count > 1 || !surface(part).hides_paint();
}

void SurfaceLayer::stack(int part, const TexturePlace* places, std::size_t step, const Effects& effects, double scale,
                         Stack& result) const {
  const std::vector<Laid>& laid = laid_[static_cast<std::size_t>(part)];
  result.count = laid.size(), result.bare = laid.empty() ? 1 : 0;
  double left = 1, covered = 0;  // by the uppermost textures so far, and by those that are blended with this one
  for (std::size_t k = laid.size(); k-- > 0;) {
    Shown& shown = result.shown[k];
    shown.number = shading_of(laid[k], effects);
    shown.place = places + k * step, shown.repeat = laid[k].repeat;
    shown.repeated = repeated(*shown.place, shown.repeat);
    shown.share = left * shown.place->share;
    shown.probes = {};
    if (shown.share > 0) {
      if (effects.texture_filter) shown.probes = shader_->probes(shown.number, shown.repeated, scale);
      covered += shown.place->share * coverage(shown, scale, effects.texture_lobes);
    }
    if (laid[k].blends) continue;
    left *= std::max(1 - covered, 0.0), covered = 0;
  }
  result.bare = left;
}

double SurfaceLayer::coverage(const Shown& shown, double scale, std::uint32_t lobes) const {
  if (shader_->packed(shown.number).covers) return 1;
  double sum = 0;
  for (int i = 0; i < shown.probes.count(); ++i)
    sum +=
        shader_->coverage(shown.number, probe_place(shown.repeated, scale, shown.probes, i), shown.probes.level, lobes);
  return sum / shown.probes.count();
}

namespace {

const TexturePlace& place_on(const VisiblePoint& point, std::size_t level) {
  return level == 0 || level > point.over.size() ? point.place : point.over[level - 1];
}

}  // namespace

double SurfaceLayer::covered_texels(const VisiblePoint& point) const {
  const std::vector<Laid>& laid = laid_[static_cast<std::size_t>(point.part)];
  double most = 1;
  for (std::size_t k = 0; k < laid.size(); ++k) {
    const brdf::SbrdfTexture& texture = *textures_[laid[k].texture];
    const auto texels = [&](const float* step) {
      return std::max(1.0, laid[k].repeat * std::hypot(step[0] * texture.width, step[1] * texture.height));
    };
    most = std::max(most, texels(place_on(point, k).across) * texels(place_on(point, k).down));
  }
  return most;
}

namespace {

// The frame of isolines needs only the normal: they do not change when both directions turn about it.
struct LocalPair {
  Vec3 light, viewer;
};
LocalPair about_normal(const Vec3& normal, const Vec3& light, const Vec3& viewer) {
  const Vec3 other = std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = normalized(cross(other, normal)), y = cross(normal, x);
  return {{dot(light, x), dot(light, y), dot(light, normal)}, {dot(viewer, x), dot(viewer, y), dot(viewer, normal)}};
}

}  // namespace

// The lobe model under a light is pi W f cos_i; the flakes' part of f, K_D and K_DD, is taken out and the map's
// reflectance factor, pi f by definition, put in.
color::Rgb SurfaceLayer::mapped_difference(int part, const Vec3& normal, const Vec3& to_viewer, bool coat,
                                           const Vec3& position) const {
  color::Rgb sum;
  const auto at = static_cast<std::size_t>(part);
  for (const Light& lamp : scene_.lights) {
    const Light light = light_at(lamp, position);
    for (const DiscDirection& part_of : disc_directions(light)) {
      const auto [wi, wo] = about_normal(normal, part_of.direction, to_viewer);
      if (wi.z <= 0 || wo.z <= 0) continue;
      const double aspecular_rad = paint::aspecular_angle_rad(wi, wo, {0, 0, 1});
      const color::Rgb map = brdf::reflectance_factor(*surfaces_[at].color_map, wi, wo, treatment_);
      const paint::LobeFit& paint = scene_.paints[at];
      const color::Rgb lobes = brdf::flake_reflectance_factor(
          coat ? paint : brdf::under_coat(paint, paint::kNoCoat), aspecular_rad / kDegree,
          std::acos(std::min(wi.z, 1.0)) / kDegree, std::acos(std::min(wo.z, 1.0)) / kDegree);
      sum += part_of.weight * wi.z * color::reflected(scene_.reflection, light.white, map - lobes);
    }
  }
  return sum;
}

namespace {

SbrdfLight light_of(const Scene& scene, const Effects& effects) {
  return {effects.environment,
          lights_of(scene, effects),
          effects.reflection ? scene.reflection : color::component_wise(),
          true,
          effects.texture_lobes,
          effects.placed ? origin_of(*scene.mesh) : Vec3{}};
}

}  // namespace

std::size_t SurfaceLayer::shading_of(const Laid& laid, const Effects& effects) const {
  return effects.texture ? laid.texture : textures_.size() + laid.texture;
}

// Steps of the golden section cover a texture evenly.
std::vector<TexturePlace> SurfaceLayer::placed(const VisiblePoint& point, std::size_t number) const {
  const std::vector<Laid>& laid = laid_[static_cast<std::size_t>(point.part)];
  std::vector<TexturePlace> places;
  for (std::size_t k = 0; k < laid.size(); ++k) {
    TexturePlace& place = places.emplace_back(place_on(point, k));
    if (point.placed) continue;
    const auto step = [&](double share) {
      const double at = share * static_cast<double>(number);
      return static_cast<float>((at - std::floor(at)) / laid[k].repeat);
    };
    place.u = step(0.61803398875), place.v = step(0.7548776662);
    place.tangent = floats(cross({0, 1, 0}, point.normal));
  }
  return places;
}

namespace {

// The texels themselves at 16 x 16 places that are spread over the whole footprint, or at the one in its middle where
// the footprint lies between texels, with the lobes whose bits are set. Returns the part that they cover.
double add_seen_texels(const brdf::SbrdfTexture& texture, const TexturePlace& at, bool filtered, std::uint32_t lobes,
                       std::vector<SurfaceLayer::Piece>& pieces) {
  FilterProbes all;
  if (filtered && !is_between_texels(at, 1, texture.width, texture.height)) all.across = all.down = 16;
  const Vec3 tangent = vec3(at.tangent.data());
  const auto wide = static_cast<std::size_t>(texture.width);
  double covered = 0;
  SeenTexels seen;
  for (const TexelShare& one : seen.of(at, 1, all, texture.width, texture.height)) {
    const auto column = static_cast<int>(one.texel % wide), row = static_cast<int>(one.texel / wide);
    for (brdf::SbrdfTexel& texel : brdf::sbrdf_texels(texture, column, row)) {
      std::vector<brdf::LafortuneLobe>& of = texel.surface.lobes;
      for (std::size_t lobe = 0; lobe < of.size(); ++lobe)
        if ((lobes >> lobe & 1U) == 0) of[lobe].albedo = {};
      Vec3 normal = texture.normal(one.texel);
      if (at.mirrored) normal.y = -normal.y;
      pieces.push_back({std::move(texel), one.share, tangent, normal});
    }
    covered += texture.alpha.empty() ? one.share : one.share * texture.alpha[one.texel];
  }
  return covered;
}

}  // namespace

// The place as stack() has it, from the uppermost texture on.
SurfaceLayer::Place SurfaceLayer::place(int part, const std::vector<TexturePlace>& places,
                                        const Effects& effects) const {
  const std::vector<Laid>& laid = laid_[static_cast<std::size_t>(part)];
  Place result;
  double left = 1, covered = 0;
  for (std::size_t k = laid.size(); k-- > 0;) {
    const double share = left * places[k].share;
    if (share > 0) {
      const std::size_t which = shading_of(laid[k], effects), first = result.pieces.size();
      const brdf::SbrdfTexture& texture =
          which < textures_.size() ? *textures_[which] : means_[which - textures_.size()];
      covered += places[k].share * add_seen_texels(texture, repeated(places[k], laid[k].repeat), effects.texture_filter,
                                                   effects.texture_lobes, result.pieces);
      for (std::size_t i = first; i < result.pieces.size(); ++i) result.pieces[i].share *= share;
    }
    if (laid[k].blends) continue;
    left *= std::max(1 - covered, 0.0), covered = 0;
  }
  result.bare = left;
  return result;
}

SurfaceLayer::Place SurfaceLayer::place(const VisiblePoint& point, std::size_t number, const Effects& effects) const {
  return place(point.part, placed(point, number), effects);
}

SurfaceLayer::Place SurfaceLayer::place(int part, const MeshPoint& point, bool inside) const {
  std::vector<TexturePlace> places;
  for (std::size_t k = 0; k < laid_[static_cast<std::size_t>(part)].size(); ++k)
    places.push_back(layouts_[k]->place(part, point, inside));
  Effects all;
  all.texture = true, all.texture_filter = false, all.texture_lobes = ~0U;
  return place(part, places, all);
}

void SurfaceLayer::add_mapped(const std::vector<VisiblePoint>& points, bool coat,
                              std::vector<color::Rgb>& colors) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VisiblePoint& p = points[i];
    if (surface(p.part).color_map != nullptr)
      colors[i] += mapped_difference(p.part, p.normal, p.to_viewer, coat, p.position);
  }
}

void SurfaceLayer::add(const std::vector<VisiblePoint>& points, const Effects& effects,
                       std::vector<color::Rgb>& colors) const {
  if (effects.maps) add_mapped(points, effects.coat, colors);
  // Those of one texture and one of its levels, with the shares of the points that they are probes of.
  struct Probes {
    std::vector<VisiblePoint> points;
    std::vector<std::pair<std::size_t, double>> shares;
  };
  std::map<std::pair<std::size_t, int>, Probes> all;
  Stack seen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<TexturePlace> places = placed(points[i], i);
    if (places.empty()) continue;
    stack(points[i].part, places.data(), 1, effects, 1, seen);
    colors[i] = seen.bare * colors[i];
    for (std::size_t level = 0; level < seen.count; ++level) {
      const Shown& shown = seen.shown[level];
      if (!(shown.share > 0)) continue;
      for (int k = 0; k < shown.probes.count(); ++k) {
        Probes& into = all[{shown.number, shown.probes.level}];
        into.points.push_back({points[i].normal,
                               points[i].to_viewer,
                               points[i].part,
                               true,
                               probe_place(shown.repeated, 1, shown.probes, k),
                               {},
                               points[i].position});
        into.shares.emplace_back(i, shown.share / shown.probes.count());
      }
    }
  }
  const SbrdfLight light = light_of(scene_, effects);
  for (const auto& [of, probes] : all) {
    const std::vector<color::Rgb> shown = shader_->shade(of.first, light, probes.points, of.second);
    for (std::size_t i = 0; i < shown.size(); ++i) colors[probes.shares[i].first] += probes.shares[i].second * shown[i];
  }
}

void SurfaceLayer::see(const Gbuffer& gbuffer, int first_row, int end_row, const std::vector<TexturePlace>& places,
                       const Effects& effects, double scale, bool all, SeenBand& band) const {
  const std::size_t pixels = static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height);
  band.clear();
  Stack stacked;
  SeenTexels texels;
  for (std::size_t i = gbuffer.index(0, first_row); i < gbuffer.index(0, end_row); ++i) {
    const int part = static_cast<int>(std::abs(gbuffer.data[4 * i + 3])) - 1;
    const bool asked = all || gbuffer.wanted.empty() || gbuffer.wanted[i] != 0;
    const bool worn = part >= 0 && asked && !surfaces_[static_cast<std::size_t>(part)].textures.empty();
    if (worn) stack(part, &places[i], pixels, effects, scale, stacked);
    if (dims_) band.bare.push_back(worn ? static_cast<float>(stacked.bare) : 1.0F);
    for (std::size_t level = 0; worn && level < stacked.count; ++level) {
      const Shown& shown = stacked.shown[level];
      if (!(shown.share > 0)) continue;
      const PackedTexture& packed = shader_->packed(shown.number, shown.probes.level, effects.texture_lobes);
      const std::span<TexelShare> seen = texels.of(shown.repeated, scale, shown.probes, packed.width, packed.height);
      sort_by_shape(packed, seen);
      SeenBand::Bin& bin = band.bin(shown.number, shown.probes.level);
      for (TexelShare& one : seen) one.share *= static_cast<float>(shown.share);
      bin.texels.insert(bin.texels.end(), seen.begin(), seen.end());
      bin.points.push_back(
          {static_cast<std::uint32_t>(&places[i] - places.data() + static_cast<std::ptrdiff_t>(level * pixels)),
           static_cast<std::uint32_t>(bin.texels.size())});
    }
  }
}

// Shades the part of a band that shows one texture or level.
void SurfaceLayer::shade(const Gbuffer& gbuffer, const SeenBand::Bin& bin, const std::vector<TexturePlace>& places,
                         const SbrdfLight& light, bool placed, float weight, image::Image& rgba) const {
  SbrdfShader::Batch batch(*shader_, bin.texture, light, bin.level);
  float* pixel[kPointsAtOnce];
  const auto flush = [&] {
    const int count = batch.count();
    const float* shown = batch.shade();
    for (int i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c) pixel[i][c] += weight * shown[4 * i + c];
  };
  const auto wide = static_cast<std::uint32_t>(gbuffer.width),
             pixels = wide * static_cast<std::uint32_t>(gbuffer.height);
  std::uint32_t first = 0, row = 0;
  for (const SeenBand::Point& point : bin.points) {
    const std::uint32_t at = point.place < pixels ? point.place : point.place % pixels;
    if (at - row * wide >= wide) row = at / wide;
    const auto x = static_cast<int>(at - row * wide), y = static_cast<int>(row);
    const auto texels = std::span(bin.texels).subspan(first, point.end - first);
    first = point.end;
    if (!gbuffer.wants(x, y)) continue;
    const std::array<float, 3> toward = floats(gbuffer.to_viewer(x, y)),
                               position = floats((placed ? mesh_point(*scene_.mesh, gbuffer, x, y).position : Vec3{}) -
                                                 light.origin);
    each_shape(batch.texture(), texels, [&](std::span<const TexelShare> lobed, std::span<const TexelShare> diffuse) {
      pixel[batch.count()] = rgba.pixel(x, y);
      batch.put(gbuffer.at(x, y), toward, position, places[point.place], lobed, diffuse);
      if (batch.full()) flush();
    });
  }
  if (batch.count() > 0) flush();
}

void SurfaceLayer::add(const Gbuffer& gbuffer, const std::vector<TexturePlace>& places, const Effects& effects,
                       float weight, image::Image& rgba, SeenPixels* kept) const {
  if (!textured_ && !(mapped_ && effects.maps)) return;
  // A sample stands for its share of the area of the pixel.
  const double scale = std::sqrt(weight);
  const SbrdfLight light = light_of(scene_, effects);
  const auto rows = static_cast<std::size_t>(gbuffer.height);
  SeenPixels passing;
  if (kept == nullptr) kept = &passing;
  kept->begin(id_, effects, scale, (rows + kRowsOfBand - 1) / kRowsOfBand);
  parallel_for(rows, kRowsOfBand, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<int>(begin), last = static_cast<int>(end);
    if (mapped_ && effects.maps) add_mapped(gbuffer, first, last, effects, weight, rgba);
    if (!textured_) return;
    const SeenBand& band = kept->band(begin / kRowsOfBand, [&](SeenBand& unknown) {
      see(gbuffer, first, last, places, effects, scale, kept->keeps(), unknown);
    });
    float* pixel = rgba.pixel(0, first);
    for (const float bare : band.bare) {
      for (int c = 0; c < 3; ++c) pixel[c] *= bare;
      pixel += rgba.channels;
    }
    for (const SeenBand::Bin& bin : band.bins)
      if (!bin.points.empty()) shade(gbuffer, bin, places, light, effects.placed, weight, rgba);
    kept->done(begin / kRowsOfBand);
  });
}

void SurfaceLayer::add_mapped(const Gbuffer& gbuffer, int first_row, int end_row, const Effects& effects, float weight,
                              image::Image& rgba) const {
  for (int y = first_row; y < end_row; ++y) {
    for (int x = 0; x < gbuffer.width; ++x) {
      const int part = gbuffer.part(x, y);
      if (part < 0 || !gbuffer.wants(x, y)) continue;
      if (surface(part).color_map == nullptr || surface(part).hides_paint()) continue;
      const Vec3 position = effects.placed ? mesh_point(*scene_.mesh, gbuffer, x, y).position : Vec3{};
      const color::Rgb color =
          mapped_difference(part, gbuffer.normal(x, y), gbuffer.to_viewer(x, y), effects.coat, position);
      for (int c = 0; c < 3; ++c) rgba.pixel(x, y)[c] += weight * static_cast<float>(color[c]);
    }
  }
}

}  // namespace goniochrome::render
