#include "render/textures/sbrdf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <unordered_map>

#include "base/angles.h"
#include "base/parallel.h"
#include "render/internal/lobe_curves.h"
#include "render/internal/maps.h"

namespace goniochrome::render {

namespace {

constexpr double kHorizonStep = std::numbers::sqrt2;  // from exponent to exponent of the horizon table
// Lobes of coarser levels may be as much wider than the widest of the texture.
constexpr double kWider = 4;

// The faces with their borders, R G B 0 a texel.
std::vector<float> quads(const envmap::CubeMap& map) {
  const std::size_t wide = static_cast<std::size_t>(map.size) + 2, texels = wide * wide;
  std::vector<float> data(6 * texels * 4, 0.0F);
  parallel_for(6, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t face = begin; face < end; ++face) {
      const std::vector<float> texel = bordered_face(map, static_cast<int>(face));
      for (std::size_t i = 0; i < texels; ++i) std::copy_n(&texel[3 * i], 3, &data[4 * (face * texels + i)]);
    }
  });
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
    envmap::CubeMap level(size);
    for (int face = 0; face < 6; ++face)
      for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
          const Vec3 value = envmap::bilinear(lobe->map, envmap::cube_direction(face, column + 0.5, row + 0.5, size));
          for (int c = 0; c < 3; ++c) level.at(face, row, column)[c] = static_cast<float>(value[c]);
        }
    mip.levels.push_back(std::move(level));
    size = std::max(size / 2, 1);
  }
  return mip;
}

SbrdfShader::SbrdfShader(const envmap::PrefilteredEnvironment* env, const MipCube* mip,
                         const std::vector<const brdf::SbrdfTexture*>& textures) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const brdf::SbrdfTexture* texture : textures) {
    for (std::size_t i = 0; i < texture->values.size(); i += static_cast<std::size_t>(texture->stride())) {
      for (int lobe = 0; lobe < texture->lobes; ++lobe) {
        const float* values = &texture->values[i + 5 + 7 * static_cast<std::size_t>(lobe)];
        if (values[0] == 0 && values[1] == 0 && values[2] == 0) continue;
        low = std::min<double>(low, values[6]), high = std::max<double>(high, values[6]);
      }
    }
  }
  low = std::min(low, high);
  if (env != nullptr) {
    make_maps(*env, mip, low, high);
    make_horizon(low / kWider, high);
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
  std::string list;
  for (const double exponent : wanted) list += fmt::format("{}{:.6g}", list.empty() ? "" : ",", exponent);
  return list;
}

}  // namespace

Result<void> SbrdfShader::has_all_maps() const {
  if (missing_.empty()) return {};
  return input_error("{}", missing_);
}

// Of the exponents there are, those between which the textures' lie.
void SbrdfShader::make_maps(const envmap::PrefilteredEnvironment& env, const MipCube* mip, double low, double high) {
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
  const auto first = static_cast<std::size_t>(brdf::exponent_blend(low / kWider, exponents_).lower);
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
    for (const LobeIntegrals& lobe : lobe_curve(exponent, kTextureHorizonSegments, true)) {
      horizon_.push_back(static_cast<float>(lobe.cosine * (exponent + 1) / (2 * kPi)));
      horizon_.push_back(static_cast<float>(lobe.cosine_shift));
    }
    if (exponent >= high) return;
  }
}

void SbrdfShader::pack_lobe(const brdf::LafortuneLobe& lobe, double largest, float* to) const {
  to[kLobeEnergy] = to[kLobeAlbedo] = kNoLobe;
  if (largest > 0) {
    for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(lobe.albedo[c] / largest);
    to[kLobeAlbedo] = static_cast<float>(std::log(largest));
    to[kLobeEnergy] = static_cast<float>(std::log(2 * kPi / (lobe.exponent + 1) * largest));
  }
  for (int k = 0; k < 3; ++k) to[kLobeAxes + static_cast<std::size_t>(k)] = static_cast<float>(lobe.axes[k]);
  to[kLobeExponent] = static_cast<float>(lobe.exponent);
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

// The texels of a texture by the shape of their lobes: frames, axes and exponents.
class Shapes {
 public:
  explicit Shapes(const brdf::SbrdfTexture& texture) : lobes_(static_cast<std::size_t>(texture.lobes)) {
    const auto stride = static_cast<std::size_t>(texture.stride());
    std::unordered_map<std::string, int> known;
    std::string bytes, before;
    for (std::size_t i = 0; i < texture.values.size(); i += stride) {
      const float* at = &texture.values[i];
      bytes.assign(reinterpret_cast<const char*>(at + 3), 2 * sizeof(float));
      for (std::size_t lobe = 0; lobe < lobes_; ++lobe)
        bytes.append(reinterpret_cast<const char*>(at + 5 + 7 * lobe + 3), 4 * sizeof(float));
      if (!texture.turns.empty())
        bytes.append(reinterpret_cast<const char*>(&texture.turns[2 * lobes_ * of_.size()]),
                     2 * lobes_ * sizeof(float));
      if (bytes != before || of_.empty()) {
        before = bytes;
        const auto found = known.find(bytes);
        number_ = found != known.end() ? found->second : 0;
        if (found == known.end() && known.size() < kMost) {
          number_ = known[bytes] = static_cast<int>(known.size()) + 1;
          largest_.resize(known.size() * lobes_, 0.0F);
        }
      }
      of_.push_back(number_);
      for (std::size_t lobe = 0; number_ > 0 && lobe < lobes_; ++lobe) {
        float& most = largest_[(static_cast<std::size_t>(number_) - 1) * lobes_ + lobe];
        most = std::max(most, *std::max_element(at + 5 + 7 * lobe, at + 8 + 7 * lobe));
      }
    }
  }

  int of(std::size_t texel) const { return of_[texel]; }
  // The largest albedo of this lobe in texels of a shape.
  double largest(int shape, std::size_t lobe) const {
    return largest_[(static_cast<std::size_t>(shape) - 1) * lobes_ + lobe];
  }

 private:
  // A texture of more has texels that are measured one by one, of which no two are alike.
  static constexpr std::size_t kMost = 4096;
  std::size_t lobes_;
  int number_ = 0;
  std::vector<int> of_;  // 0: kOwnShape
  std::vector<float> largest_;
};

}  // namespace

PackedTexture SbrdfShader::pack(const brdf::SbrdfTexture& texture) const {
  PackedTexture result{texture.width, texture.height, texture.lobes, {}, texture.alpha.empty()};
  const Shapes shapes(texture);
  const std::size_t size = result.stride();
  const auto texels = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
  result.texels.assign(size * texels, 0.0F);
  parallel_for(texels, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto wide = static_cast<std::size_t>(texture.width);
      const auto column = static_cast<int>(i % wide), row = static_cast<int>(i / wide);
      const brdf::SbrdfTexel texel = brdf::sbrdf_texel(texture, column, row);
      float* to = &result.texels[size * i];
      for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(texel.surface.diffuse[c]);
      to[kTexelAlpha] = result.covers ? 1 : texture.alpha[i];
      to[4] = static_cast<float>(texel.x_tangent), to[5] = static_cast<float>(texel.x_bitangent);
      const int shape = shapes.of(i);
      to[kTexelShape] = shape > 0 ? static_cast<float>(shape) : kOwnShape;
      to += kTexelFloats;
      for (std::size_t k = 0; k < texel.surface.lobes.size(); ++k) {
        const brdf::LafortuneLobe& lobe = texel.surface.lobes[k];
        pack_lobe(lobe, shape > 0 ? shapes.largest(shape, k) : largest_channel(lobe), to);
        const brdf::SbrdfAxis axis = brdf::sbrdf_axis(texture.frame(column, row, static_cast<int>(k)));
        to[kLobeTurn] = static_cast<float>(axis.tangent), to[kLobeTurn + 1] = static_cast<float>(axis.bitangent);
        to += kTexelLobeFloats;
      }
    }
  });
  return result;
}

PackedTexture SbrdfShader::pack(const TextureLevel& level) const {
  PackedTexture result{level.width, level.height, 0, {}, level.alpha.empty()};
  for (const brdf::LobeSurface& texel : level.texels)
    result.lobes = std::max(result.lobes, static_cast<int>(texel.lobes.size()));
  result.texels.assign(result.stride() * level.texels.size(), 0.0F);
  for (std::size_t i = 0; i < level.texels.size(); ++i) {
    float* to = &result.texels[result.stride() * i];
    for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(level.texels[i].diffuse[c]);
    to[kTexelAlpha] = result.covers ? 1 : level.alpha[i];
    to[4] = 1, to += kTexelFloats;
    for (std::size_t lobe = 0; lobe < static_cast<std::size_t>(result.lobes); ++lobe, to += kTexelLobeFloats) {
      const bool there = lobe < level.texels[i].lobes.size();
      const brdf::TurnedLobe turned = there ? level.texels[i].lobes[lobe] : brdf::TurnedLobe{};
      pack_lobe(turned.lobe, largest_channel(turned.lobe), to);
      to[kLobeTurn] = static_cast<float>(std::cos(turned.turn_rad));
      to[kLobeTurn + 1] = static_cast<float>(std::sin(turned.turn_rad));
    }
  }
  return result;
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

double SbrdfShader::coverage(std::size_t texture, const TexturePlace& place, int level, std::uint32_t lobes) const {
  const PackedTexture& of = packed(texture, level, lobes);
  if (of.covers) return 1;
  double sum = 0;
  for (const brdf::TextureTap& tap : brdf::texture_taps(of.width, of.height, place.u, place.v))
    sum += tap.weight * of.at(tap.column, tap.row)[kTexelAlpha];
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
  shading_.lobes = packed_.lobes;
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
  if (light.reflection.k != color::component_wise().k) {
    for (const auto& plane : light.reflection.k)
      for (const auto& row : plane)
        for (const double k : row) reflection_.push_back(static_cast<float>(k));
    shading_.reflection = reflection_.data();
  }
  points_.taps = packed_.width * packed_.height > 1 ? 4 : 1;
  constexpr float kUp[3] = {0, 0, 1};
  for (int i = 0; i < kPointsAtOnce; ++i) put(kUp, kUp, {}, {}, 1);
  count_ = 0, points_.groups = 0;
}

void SbrdfShader::Batch::put_frame(const float* normal, const float* to_viewer, const std::array<float, 3>& position,
                                   const float* tangent) {
  SbrdfPoints& p = points_;
  p.nx[count_] = normal[0], p.ny[count_] = normal[1], p.nz[count_] = normal[2];
  p.vx[count_] = to_viewer[0], p.vy[count_] = to_viewer[1], p.vz[count_] = to_viewer[2];
  p.tx[count_] = tangent[0], p.ty[count_] = tangent[1], p.tz[count_] = tangent[2];
  p.px[count_] = position[0], p.py[count_] = position[1], p.pz[count_] = position[2];
}

// The kernel adds as many texels of every point; those that a point lacks are in no group and have no share.
void SbrdfShader::Batch::put(const float* normal, const float* to_viewer, const std::array<float, 3>& position,
                             const float* tangent, std::span<const SeenTexels::Seen> texels) {
  put_frame(normal, to_viewer, position, tangent);
  SbrdfPoints& p = points_;
  for (std::size_t k = 0; k < static_cast<std::size_t>(p.taps); ++k) {
    const bool there = k < texels.size();
    p.texel[k][count_] = &packed_.texels[there ? texels[k].texel * packed_.stride() : 0];
    p.share[k][count_] = there ? texels[k].share : 0.0F;
  }
  group_texels(std::min(static_cast<int>(texels.size()), p.taps));
}

void SbrdfShader::Batch::put(const float* normal, const float* to_viewer, const std::array<float, 3>& position,
                             const TexturePlace& place, double repeat) {
  put_frame(normal, to_viewer, position, place.tangent);
  SbrdfPoints& p = points_;
  if (p.taps == 1) {
    p.texel[0][count_] = packed_.texels.data();
    p.share[0][count_] = 1;
    group_texels(1);
    return;
  }
  const auto taps = brdf::texture_taps(packed_.width, packed_.height, repeat * place.u, repeat * place.v);
  for (std::size_t k = 0; k < taps.size(); ++k) {
    p.texel[k][count_] = packed_.at(taps[k].column, taps[k].row);
    p.share[k][count_] = static_cast<float>(taps[k].weight);
  }
  group_texels(p.taps);
}

// Of the first so many texels of the point that was put last: each group begins with the first that is in none yet.
void SbrdfShader::Batch::group_texels(int count) {
  SbrdfPoints& p = points_;
  const auto all = (1U << static_cast<unsigned>(count)) - 1;
  float shapes[kTexelsAtOnce] = {};
  bool same = true;
  for (int k = 0; k < count; ++k) {
    shapes[k] = p.texel[k][count_][kTexelShape];
    same = same && shapes[k] == shapes[0];
  }
  int groups = 0;
  for (unsigned left = all; left != 0; ++groups) {
    const int first = std::countr_zero(left);
    unsigned members = 1U << first;
    if (same && shapes[0] != kOwnShape) {
      members = all;
    } else if (shapes[first] != kOwnShape) {
      for (int k = first + 1; k < count; ++k)
        if (shapes[k] == shapes[first]) members |= 1U << k;
    }
    p.group[groups][count_] = static_cast<std::uint8_t>(members);
    left &= ~members;
  }
  p.groups = std::max(p.groups, groups);
  for (; groups < static_cast<int>(kTexelsAtOnce); ++groups) p.group[groups][count_] = 0;
  ++count_;
}

const float* SbrdfShader::Batch::shade() {
  shade_texels(shading_, points_, count_, rgba_);
  count_ = 0, points_.groups = 0;
  return rgba_;
}

std::vector<color::Rgb> SbrdfShader::shade(std::size_t texture, const SbrdfLight& light,
                                           const std::vector<VisiblePoint>& points, int level) const {
  std::vector<color::Rgb> colors;
  Batch batch(*this, texture, light, level);
  const auto flush = [&] {
    const int count = batch.count();
    const float* rgba = batch.shade();
    for (int i = 0; i < count; ++i) colors.push_back({rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]});
  };
  for (const VisiblePoint& point : points) {
    float normal[3], to_viewer[3];
    for (int c = 0; c < 3; ++c) {
      normal[c] = static_cast<float>(point.normal[c]), to_viewer[c] = static_cast<float>(point.to_viewer[c]);
    }
    batch.put(normal, to_viewer, from_origin(point.position, light.origin), point.place, 1);
    if (batch.full()) flush();
  }
  if (batch.count() > 0) flush();
  return colors;
}

}  // namespace goniochrome::render
