#include "render/textures/sbrdf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <unordered_map>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/text.h"
#include "render/internal/lobe_curves.h"

namespace goniochrome::render {

namespace {

constexpr double kHorizonStep = std::numbers::sqrt2;  // from exponent to exponent of the horizon table
// Lobes of coarser levels may be as much wider than the widest of the texture.
constexpr double kWider = 4;

// The faces with their borders, R G B 0 a texel.
std::vector<float> quads(const envmap::CubeMap& map) {
  std::vector<float> data(4 * bordered_texels(map.size));
  put_bordered(map, 4, data.data());
  return data;
}

}  // namespace

Result<MipCube> mip_cube(const envmap::PrefilteredEnvironment& env) {
  if (env.lobes.empty()) return input_error("{}: holds no lobes", env.source);
  MipCube mip;
  mip.finest_exponent = env.lobes.back().exponent;
  int size = env.lobes.back().map.size;
  for (double exponent = mip.finest_exponent; exponent > 0.9; exponent /= 4) {
    const envmap::PrefilteredLobe* lobe = std::abs(exponent - 1) < 1e-6 ? &env.diffuse : env.lobe(exponent);
    if (lobe == nullptr)
      return input_error(
          "{}: lacks the lobe of exponent {:g}: prefilter with quarters of the sharpest, such as --exponents "
          "4,16,64,256",
          env.source, exponent);
    mip.levels.push_back(envmap::resized(lobe->map, size));
    size = std::max(size / 2, 1);
  }
  return mip;
}

SbrdfShader::SbrdfShader(const envmap::PrefilteredEnvironment* env, const MipCube* mip,
                         const std::vector<const brdf::SbrdfTexture*>& textures) {
  brdf::LobeRange range;
  for (const brdf::SbrdfTexture* texture : textures) range.add(*texture);
  const double high = range.high, low = std::min(range.low, high);
  // Lobes about normals that vary may become as wide as there are maps.
  const bool bent = std::ranges::any_of(textures, [](const auto* texture) { return !texture->normals.empty(); });
  if (env != nullptr) {
    make_maps(*env, mip, low, high, bent ? 0 : low / kWider);
    make_horizon(bent ? std::min(low, 1.0) : low / kWider, high);
  }
  given_ = textures;
  for (const brdf::SbrdfTexture* texture : textures) textures_.push_back(pack(*texture)), levels_.emplace_back();
}

namespace {

// The exponents at which maps have to be there for lobes from `low` to `high`: those that are, and what lies beyond
// them; for one cube with levels, which end with exponent 1, the sharpest and its quarters.
std::string wanted_exponents(const std::vector<double>& there, double low, double high, bool levels) {
  std::vector<double> wanted = there;
  if (levels) {
    wanted = {std::pow(4.0, std::ceil(std::log2(high) / 2))};
    while (wanted.front() > 4) wanted.insert(wanted.begin(), wanted.front() / 4);
  } else {
    if (low < there.front()) wanted.insert(wanted.begin(), low);
    if (high > there.back()) wanted.push_back(high);
  }
  return joined(wanted, ",", [](double exponent) { return fmt::format("{:.6g}", exponent); });
}

}  // namespace

Result<void> SbrdfShader::has_all_maps() const {
  if (missing_.empty()) return {};
  return input_error("{}", missing_);
}

// Maps are made of the exponents between which those of the textures lie.
void SbrdfShader::make_maps(const envmap::PrefilteredEnvironment& env, const MipCube* mip, double low, double high,
                            double widest) {
  std::vector<const envmap::CubeMap*> all;
  const auto add = [&](double exponent, const envmap::CubeMap& map) {
    exponents_.push_back(exponent), all.push_back(&map);
  };
  if (mip != nullptr) {
    double exponent = mip->finest_exponent / std::pow(4.0, static_cast<double>(mip->levels.size()) - 1);
    for (auto level = mip->levels.rbegin(); level != mip->levels.rend(); ++level, exponent *= 4) add(exponent, *level);
  } else {
    bool diffuse = false;  // the diffuse map is the lobe of exponent 1
    for (const envmap::PrefilteredLobe& lobe : env.lobes) {
      if (!diffuse && lobe.exponent > 1) add(1, env.diffuse.map), diffuse = true;
      if (lobe.exponent == 1) diffuse = true;
      add(lobe.exponent, lobe.map);
    }
    if (!diffuse) add(1, env.diffuse.map);
  }
  // Files hold exponents in half precision.
  constexpr double kSame = 1e-3;
  const bool too_sharp = high > exponents_.back() * (1 + kSame), too_wide = low < exponents_.front() * (1 - kSame);
  if (high > 0 && (too_sharp || too_wide)) {
    const bool levels = mip != nullptr && !too_wide;
    missing_ = fmt::format(
        "a texture has lobes of exponents from {:.6g} to {:.6g}, but the maps of the environment reach from {:.6g} to "
        "{:.6g}: make them with `prefilter-envmap {} --exponents {} -o ENV.env.exr`{}",
        low, high, exponents_.front(), exponents_.back(), env.source.empty() ? "SOURCE" : env.source,
        wanted_exponents(exponents_, low, high, levels),
        mip != nullptr && too_wide ? ", and look them up in cubes: levels of one cube end with exponent 1" : "");
  }
  const auto first = static_cast<std::size_t>(brdf::exponent_blend(widest, exponents_).lower);
  const brdf::ExponentBlend top = brdf::exponent_blend(high, exponents_);
  const std::size_t last = static_cast<std::size_t>(top.lower) + (top.upper_weight > 0 ? 1 : 0);
  for (std::size_t i = first; i <= last; ++i) texels_.push_back(quads(*all[i]));
  texels_.push_back(quads(env.diffuse.map));
  for (std::size_t i = first; i <= last; ++i) maps_.push_back({all[i]->size, texels_[i - first].data()});
  diffuse_ = {env.diffuse.map.size, texels_.back().data()};
  exponents_ = {exponents_.begin() + static_cast<std::ptrdiff_t>(first),
                exponents_.begin() + static_cast<std::ptrdiff_t>(last) + 1};
}

// The mean of n.w over the part of a lobe above the surface, relative to the whole lobe, and where that light comes
// from.
void SbrdfShader::make_horizon(double low, double high) {
  for (double exponent = std::max(low, 0.1);; exponent *= kHorizonStep) {
    horizon_exponents_.push_back(exponent);
    const auto curve = lobe_curve(exponent, kTextureHorizonSegments, true);
    for (const LobeIntegrals& lobe : *curve) {
      horizon_.push_back(static_cast<float>(lobe.cosine * (exponent + 1) / (2 * kPi)));
      horizon_.push_back(static_cast<float>(lobe.cosine_shift));
    }
    if (exponent >= high) return;
  }
}

void SbrdfShader::pack_lobe(const brdf::LafortuneLobe& lobe, double largest, const brdf::SbrdfAxis& axis,
                            float* to) const {
  to[kLobeEnergy] = to[kLobeAlbedo] = kNoLobe;
  if (largest > 0) {
    to[kLobeAlbedo] = static_cast<float>(std::log(largest));
    to[kLobeEnergy] = static_cast<float>(std::log(2 * kPi / (lobe.exponent + 1) * largest));
  }
  for (int k = 0; k < 3; ++k) to[kLobeAxes + static_cast<std::size_t>(k)] = static_cast<float>(lobe.axes[k]);
  to[kLobeExponent] = static_cast<float>(lobe.exponent);
  to[kLobeTurn] = static_cast<float>(axis.tangent), to[kLobeTurn + 1] = static_cast<float>(axis.bitangent);
  if (exponents_.empty()) return;
  const brdf::ExponentBlend map = brdf::exponent_blend(lobe.exponent, exponents_);
  const brdf::ExponentBlend horizon = brdf::exponent_blend(lobe.exponent, horizon_exponents_);
  to[kLobeMap] = static_cast<float>(map.lower), to[kLobeMap + 1] = static_cast<float>(map.upper_weight);
  to[kLobeHorizon] = static_cast<float>(horizon.lower);
  to[kLobeHorizon + 1] = static_cast<float>(horizon.upper_weight);
}

namespace {

double largest_channel(const brdf::LafortuneLobe& lobe) {
  return std::max({lobe.albedo.x, lobe.albedo.y, lobe.albedo.z});
}

void put_color(const color::Rgb& color, double relative_to, float* to) {
  for (int c = 0; c < 3; ++c) to[c] = relative_to > 0 ? static_cast<float>(color[c] / relative_to) : 0.0F;
}

// The texels of a texture by the shape of their lobes: frames, axes and exponents.
class Shapes {
 public:
  explicit Shapes(const brdf::SbrdfTexture& texture) : lobes_(static_cast<std::size_t>(texture.lobes)) {
    const auto stride = static_cast<std::size_t>(texture.stride());
    std::unordered_map<std::string, std::uint32_t> known;
    std::string bytes, before;
    for (std::size_t i = 0; i < texture.values.size(); i += stride) {
      const float* at = &texture.values[i];
      bytes.assign(reinterpret_cast<const char*>(at + 3), 2 * sizeof(float));
      for (std::size_t lobe = 0; lobe < lobes_; ++lobe)
        bytes.append(reinterpret_cast<const char*>(at + 5 + 7 * lobe + 3), 4 * sizeof(float));
      if (!texture.normals.empty())
        bytes.append(reinterpret_cast<const char*>(&texture.normals[3 * of.size()]), 3 * sizeof(float));
      if (!texture.turns.empty())
        bytes.append(reinterpret_cast<const char*>(&texture.turns[2 * lobes_ * of.size()]), 2 * lobes_ * sizeof(float));
      if (bytes != before || of.empty()) {
        before = bytes;
        const auto number = static_cast<std::uint32_t>(first.size());
        const auto found = known.find(bytes);
        of.push_back(found != known.end() ? found->second : number);
        if (found == known.end()) {
          if (known.size() < kMost) known[bytes] = number;
          first.push_back(of.size() - 1), largest.resize(largest.size() + lobes_);
        }
      } else {
        of.push_back(of.back());
      }
      for (std::size_t lobe = 0; lobe < lobes_; ++lobe) {
        float& most = largest[of.back() * lobes_ + lobe];
        most = std::max(most, *std::max_element(at + 5 + 7 * lobe, at + 8 + 7 * lobe));
      }
    }
  }

  std::vector<std::uint32_t> of;   // each texel
  std::vector<std::size_t> first;  // texel of each
  std::vector<float> largest;      // albedo of each lobe in texels of each shape

 private:
  // A texture of more has texels that are measured one by one, of which no two are alike: those that are not known are
  // each of a shape of its own.
  static constexpr std::size_t kMost = 4096;
  std::size_t lobes_;
};

}  // namespace

PackedTexture SbrdfShader::pack(const brdf::SbrdfTexture& texture) const {
  Shapes shapes(texture);
  PackedTexture result{texture.width, texture.height, texture.lobes, {}, {}, {}, {}, texture.alpha.empty()};
  const auto lobes = static_cast<std::size_t>(texture.lobes), texels = shapes.of.size();
  const auto at = [&](std::size_t texel) {
    const auto wide = static_cast<std::size_t>(texture.width);
    return std::pair(static_cast<int>(texel % wide), static_cast<int>(texel / wide));
  };
  result.shapes.assign(result.shape_floats() * shapes.first.size(), 0.0F);
  for (std::size_t number = 0; number < shapes.first.size(); ++number) {
    const auto [column, row] = at(shapes.first[number]);
    const Vec3 normal = texture.normal(shapes.first[number]);
    for (int c = 0; c < 3 && !texture.normals.empty(); ++c) result.normals.push_back(static_cast<float>(normal[c]));
    const brdf::SbrdfTexel texel = brdf::sbrdf_texel(texture, column, row);
    for (std::size_t k = 0; k < lobes; ++k)
      pack_lobe(texel.surface.lobes[k], shapes.largest[number * lobes + k],
                brdf::sbrdf_axis(texture.frame(column, row, static_cast<int>(k))),
                &result.shapes[(number * lobes + k) * kShapeFloats]);
  }
  result.colors.assign(result.color_floats() * texels, 0.0F);
  parallel_each(texels, 4096, [&](std::size_t i) {
    const auto [column, row] = at(i);
    const brdf::SbrdfTexel texel = brdf::sbrdf_texel(texture, column, row);
    float* to = &result.colors[result.color_floats() * i];
    put_color(texel.surface.diffuse, 1, to);
    to[kTexelAlpha] = result.covers ? 1 : texture.alpha[i];
    for (std::size_t k = 0; k < lobes; ++k)
      put_color(texel.surface.lobes[k].albedo, shapes.largest[shapes.of[i] * lobes + k], to += 4);
  });
  result.shape = std::move(shapes.of);
  return result;
}

// No two texels of a level have one shape.
PackedTexture SbrdfShader::pack(const TextureLevel& level) const {
  PackedTexture result{level.width, level.height, 0, {}, {}, {}, level.normals, level.alpha.empty()};
  for (const brdf::LobeSurface& texel : level.texels)
    result.lobes = std::max(result.lobes, static_cast<int>(texel.lobes.size()));
  result.colors.assign(result.color_floats() * level.texels.size(), 0.0F);
  result.shapes.assign(result.shape_floats() * level.texels.size(), 0.0F);
  for (std::size_t i = 0; i < level.texels.size(); ++i) {
    float *to = &result.colors[result.color_floats() * i], *shape = &result.shapes[result.shape_floats() * i];
    put_color(level.texels[i].diffuse, 1, to);
    to[kTexelAlpha] = result.covers ? 1 : level.alpha[i];
    for (std::size_t lobe = 0; lobe < static_cast<std::size_t>(result.lobes); ++lobe, shape += kShapeFloats) {
      const bool there = lobe < level.texels[i].lobes.size();
      const brdf::TurnedLobe turned = there ? level.texels[i].lobes[lobe] : brdf::TurnedLobe{};
      const double largest = largest_channel(turned.lobe);
      put_color(turned.lobe.albedo, largest, to += 4);
      pack_lobe(turned.lobe, largest, {std::cos(turned.turn_rad), std::sin(turned.turn_rad)}, shape);
    }
    result.shape.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

void sort_by_shape(const PackedTexture& texture, std::span<TexelShare> texels) {
  const auto key = [&](const TexelShare& one) { return std::pair(texture.shape[one.texel], one.texel); };
  std::ranges::sort(texels, {}, key);
}

const PackedTexture& SbrdfShader::packed(std::size_t texture, int level, std::uint32_t lobes) const {
  if (level == 0) return textures_[texture];
  Levels& levels = levels_[texture];
  if (textures_[texture].lobes < 32) lobes &= (1U << textures_[texture].lobes) - 1;
  const std::lock_guard<std::mutex> lock(levels.mutex);
  std::vector<PackedTexture>& made = levels.packed[lobes];
  if (made.empty())
    with_no_other_work([&] {
      for (const TextureLevel& of : texture_levels(*given_[texture], lobes)) made.push_back(pack(of));
    });
  return made[static_cast<std::size_t>(level) - 1];
}

namespace {

std::size_t texel_number(const PackedTexture& texture, const brdf::TextureTap& tap) {
  return static_cast<std::size_t>(tap.row) * static_cast<std::size_t>(texture.width) +
         static_cast<std::size_t>(tap.column);
}

}  // namespace

double SbrdfShader::coverage(std::size_t texture, const TexturePlace& place, int level, std::uint32_t lobes) const {
  const PackedTexture& of = packed(texture, level, lobes);
  if (of.covers) return 1;
  double sum = 0;
  for (const brdf::TextureTap& tap : brdf::texture_taps(of.width, of.height, place.u, place.v))
    sum += tap.weight * of.colors_of(texel_number(of, tap))[kTexelAlpha];
  return sum;
}

FilterProbes SbrdfShader::probes(std::size_t texture, const TexturePlace& place, double scale) const {
  return filter_probes(place, scale, textures_[texture].width, textures_[texture].height, levels(texture));
}

int SbrdfShader::levels(std::size_t texture) const {
  const PackedTexture& packed = textures_[texture];
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(packed.width, packed.height)))) - 1;
}

SbrdfShader::Batch::Batch(const SbrdfShader& shader, std::size_t texture, const SbrdfLight& light, int level)
    : packed_(shader.packed(texture, level, light.lobes)) {
  shading_.colors = packed_.colors.data(), shading_.lobes = packed_.lobes;
  shading_.lobes_on = level == 0 ? light.lobes : ~0U;
  if (light.environment) {
    shading_.diffuse = shader.diffuse_;
    shading_.maps = shader.maps_.data();
    if (light.horizon && !shader.horizon_.empty()) shading_.horizon = shader.horizon_.data();
    shading_.horizon_segments = kTextureHorizonSegments;
  }
  for (const Light& l : light.lights) {
    for (int c = 0; c < 3; ++c) lights_.push_back(static_cast<float>(l.direction[c]));
    lights_.push_back(static_cast<float>(0.25 * l.radius_rad * l.radius_rad));
    for (int c = 0; c < 3; ++c) lights_.push_back(static_cast<float>(kPi * l.white[c]));
    lights_.push_back(0);
  }
  shading_.lights = static_cast<int>(light.lights.size());
  shading_.light = lights_.data();
  placed_ = placed_lamps(light.lights, light.origin);
  if (!placed_.empty()) shading_.placed = placed_.data();
  product_ = product_columns(light.reflection);
  shading_.product = product_.data();
  constexpr std::array<float, 3> kUp = {0, 0, 1};
  while (!full()) put(kUp.data(), kUp, {}, {}, {}, {});
  count_ = 0;
}

void SbrdfShader::Batch::put(const float* normal, const std::array<float, 3>& to_viewer,
                             const std::array<float, 3>& position, const TexturePlace& place,
                             std::span<const TexelShare> lobed, std::span<const TexelShare> diffuse) {
  SbrdfPoints& p = points_;
  const std::uint32_t texel = lobed.empty() ? 0 : lobed.front().texel;
  const std::array<float, 3>& tangent = place.tangent;
  std::array<float, 3> turned;
  if (!packed_.normals.empty()) {
    const float* own = &packed_.normals[std::size_t{3} * packed_.shape[texel]];
    turned = floats(brdf::texel_normal({own[0], place.mirrored ? -own[1] : own[1], own[2]}, vec3(normal),
                                       vec3(tangent.data()), normalized(vec3(to_viewer.data()))));
    normal = turned.data();
  }
  p.nx[count_] = normal[0], p.ny[count_] = normal[1], p.nz[count_] = normal[2];
  p.vx[count_] = to_viewer[0], p.vy[count_] = to_viewer[1], p.vz[count_] = to_viewer[2];
  p.tx[count_] = tangent[0], p.ty[count_] = tangent[1], p.tz[count_] = tangent[2];
  p.px[count_] = position[0], p.py[count_] = position[1], p.pz[count_] = position[2];
  p.shape[count_] = packed_.shape_of(texel);
  p.lobed[count_] = lobed, p.diffuse[count_] = diffuse;
  ++count_;
}

const float* SbrdfShader::Batch::shade() {
  shade_texels(shading_, points_, count_, rgba_);
  count_ = 0;
  return rgba_;
}

std::vector<color::Rgb> SbrdfShader::shade(std::size_t texture, const SbrdfLight& light,
                                           const std::vector<VisiblePoint>& points, int level) const {
  std::vector<color::Rgb> colors(points.size());
  Batch batch(*this, texture, light, level);
  std::size_t number[kPointsAtOnce];
  const auto flush = [&] {
    const int count = batch.count();
    const float* rgba = batch.shade();
    for (int i = 0; i < count; ++i) colors[number[i]] += vec3(rgba + 4 * i);
  };
  std::vector<std::array<TexelShare, 4>> texels(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VisiblePoint& point = points[i];
    const auto taps = brdf::texture_taps(batch.texture().width, batch.texture().height, point.place.u, point.place.v);
    std::ranges::transform(taps, texels[i].begin(), [&](const brdf::TextureTap& tap) {
      return TexelShare{static_cast<std::uint32_t>(texel_number(batch.texture(), tap)), static_cast<float>(tap.weight)};
    });
    sort_by_shape(batch.texture(), texels[i]);
    const std::array<float, 3> normal = floats(point.normal), to_viewer = floats(point.to_viewer);
    each_shape(batch.texture(), texels[i], [&](std::span<const TexelShare> lobed, std::span<const TexelShare> diffuse) {
      number[batch.count()] = i;
      batch.put(normal.data(), to_viewer, floats(point.position - light.origin), point.place, lobed, diffuse);
      if (batch.full()) flush();
    });
  }
  if (batch.count() > 0) flush();
  return colors;
}

}  // namespace goniochrome::render
