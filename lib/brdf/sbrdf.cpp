#include "brdf/sbrdf.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::brdf {

void LobeRange::add(const SbrdfTexture& texture) {
  for (std::size_t i = 0; i < texture.values.size(); i += static_cast<std::size_t>(texture.stride()))
    for (int lobe = 0; lobe < texture.lobes; ++lobe) {
      const float* values = &texture.values[i + 5 + 7 * static_cast<std::size_t>(lobe)];
      if (vec3(values) == Vec3{}) continue;
      low = std::min<double>(low, values[6]), high = std::max<double>(high, values[6]);
    }
}

// The half of an angle -180..180 deg lies at -90..90: its cosine is not negative, its sine has the sign of the whole.
SbrdfAxis sbrdf_axis(const float* frame) {
  const double size = std::hypot(frame[0], frame[1]), cosine = size > 0 ? frame[0] / size : 1;
  return {std::sqrt(std::max(0.5 * (1 + cosine), 0.0)),
          std::copysign(std::sqrt(std::max(0.5 * (1 - cosine), 0.0)), frame[1])};
}

namespace {

void turn_to(const float* frame, SbrdfTexel& texel) {
  const SbrdfAxis axis = sbrdf_axis(frame);
  texel.x_tangent = axis.tangent, texel.x_bitangent = axis.bitangent;
}

}  // namespace

SbrdfTexel sbrdf_texel(const SbrdfTexture& texture, int column, int row) {
  const float* at = texture.texel(column, row);
  SbrdfTexel texel;
  texel.surface.diffuse = {at[0], at[1], at[2]};
  turn_to(at + 3, texel);
  texel.surface.lobes.reserve(static_cast<std::size_t>(texture.lobes));
  for (int lobe = 0; lobe < texture.lobes; ++lobe) {
    const float* l = at + 5 + 7 * lobe;
    texel.surface.lobes.push_back({{l[0], l[1], l[2]}, {l[3], l[4], l[5]}, l[6]});
  }
  return texel;
}

std::vector<SbrdfTexel> sbrdf_texels(const SbrdfTexture& texture, int column, int row) {
  SbrdfTexel whole = sbrdf_texel(texture, column, row);
  std::vector<SbrdfTexel> texels;
  if (texture.turns.empty()) {
    texels.push_back(std::move(whole));
    return texels;
  }
  std::vector<bool> done(whole.surface.lobes.size(), false);
  for (int lobe = 0; lobe < texture.lobes; ++lobe) {
    if (done[static_cast<std::size_t>(lobe)]) continue;
    const float* frame = texture.frame(column, row, lobe);
    SbrdfTexel& texel = texels.emplace_back(whole);
    if (texels.size() > 1) texel.surface.diffuse = {};
    turn_to(frame, texel);
    for (int other = 0; other < texture.lobes; ++other) {
      const auto at = static_cast<std::size_t>(other);
      const float* its = texture.frame(column, row, other);
      if (other >= lobe && its[0] == frame[0] && its[1] == frame[1]) {
        done[at] = true;
      } else {
        texel.surface.lobes[at].albedo = {};
      }
    }
  }
  return texels;
}

SurfaceFrame surface_frame(const SbrdfTexel& texel, const Vec3& normal, const Vec3& tangent) {
  const auto level = [&](const Vec3& d) { return d - dot(d, normal) * normal; };
  Vec3 t = level(tangent);
  if (!(dot(t, t) >= 1e-12)) t = level(std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  t = normalized(t);
  const Vec3 x = texel.x_tangent * t + texel.x_bitangent * cross(normal, t);
  return {x, cross(normal, x), normal};
}

Vec3 texel_normal(const Vec3& own, const Vec3& normal, const Vec3& tangent, const Vec3& to_viewer) {
  if (own.x == 0 && own.y == 0) return normal;
  constexpr double kLeast = 1e-3;  // the cosine to the viewer
  const Vec3 turned = normalized(surface_frame({}, normal, tangent).world(own));
  const double cosine = dot(turned, to_viewer);
  return cosine < kLeast ? normalized(turned + (kLeast - cosine) * to_viewer) : turned;
}

namespace {

int wrapped(double index, int n) {
  if (index >= 0 && index < n) return static_cast<int>(index);
  const double rest = std::fmod(index, n);
  return static_cast<int>(rest < 0 ? rest + n : rest) % n;
}

}  // namespace

std::array<TextureTap, 4> texture_taps(int width, int height, double u, double v) {
  // A place that is too far away for a number is taken for the corner.
  const auto numbered = [](double place) { return std::isfinite(place) ? place : 0; };
  const double x = numbered(u * width) - 0.5, y = numbered((1 - v) * height) - 0.5;
  const double left = std::floor(x), top = std::floor(y), s = x - left, t = y - top;
  const int x0 = wrapped(left, width), x1 = wrapped(left + 1, width);
  const int y0 = wrapped(top, height), y1 = wrapped(top + 1, height);
  return {{{x0, y0, (1 - s) * (1 - t)}, {x1, y0, s * (1 - t)}, {x0, y1, (1 - s) * t}, {x1, y1, s * t}}};
}

std::vector<std::pair<int, double>> covered_texels(int at, int to, int from) {
  if (from == to) return {{at, 1.0}};
  std::vector<std::pair<int, double>> result;
  const double scale = static_cast<double>(from) / to;
  if (from < to) {
    const double place = (at + 0.5) * scale - 0.5, low = std::floor(place);
    const int first = (static_cast<int>(low) + from) % from;
    result = {{first, 1 - (place - low)}, {(first + 1) % from, place - low}};
  } else {
    for (int i = static_cast<int>(at * scale); i < from && i < (at + 1) * scale; ++i)
      result.emplace_back(i, std::min(i + 1.0, (at + 1) * scale) / scale - std::max<double>(i, at * scale) / scale);
  }
  std::erase_if(result, [](const auto& part) { return part.second < 1e-9; });
  return result;
}

namespace {

// Sums over texels of one lobe. Its axes in the tangent frame are the matrix even I + odd (cos 2a, sin 2a; sin 2a,
// -cos 2a), the frame turned by a.
struct LobeSums {
  double weight = 0, log_exponent = 0, even = 0, normal = 0;
  std::array<double, 2> odd{};
  color::Rgb energy;

  void add(const float* lobe, const float* frame, double share) {
    const double scale = share / (lobe[6] + 1.0), size = std::hypot(frame[0], frame[1]);
    const color::Rgb here = scale * color::Rgb{lobe[0], lobe[1], lobe[2]};
    const double w = std::max(here.x + here.y + here.z, 1e-30), half = 0.5 * (lobe[3] - lobe[4]);
    energy += here;
    weight += w;
    log_exponent += w * std::log1p(lobe[6]);
    even += w * 0.5 * (lobe[3] + lobe[4]), normal += w * lobe[5];
    odd[0] += w * half * (size > 0 ? frame[0] / size : 1), odd[1] += w * half * (size > 0 ? frame[1] / size : 0);
  }
};

std::array<double, 2> direction_of(const std::array<double, 2>& odd) {
  const double size = std::hypot(odd[0], odd[1]);
  if (!(size > 0)) return {1, 0};
  return {odd[0] / size, odd[1] / size};
}

}  // namespace

SbrdfTexture mean_texture(const SbrdfTexture& texture) {
  SbrdfTexture mean{1, 1, texture.lobes, std::vector<float>(static_cast<std::size_t>(texture.stride()), 0.0F)};
  const auto texels = static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height);
  const double share = 1 / static_cast<double>(texels);
  std::vector<LobeSums> sums(static_cast<std::size_t>(texture.lobes));
  color::Rgb diffuse;
  double covered = 0;
  Vec3 normal;
  for (std::size_t i = 0; i < texels; ++i) {
    const float* at = &texture.values[i * static_cast<std::size_t>(texture.stride())];
    diffuse += share * color::Rgb{at[0], at[1], at[2]};
    const int column = static_cast<int>(i) % texture.width, row = static_cast<int>(i) / texture.width;
    for (std::size_t lobe = 0; lobe < sums.size(); ++lobe)
      sums[lobe].add(at + 5 + 7 * lobe, texture.frame(column, row, static_cast<int>(lobe)), share);
    covered += texture.alpha.empty() ? share : share * texture.alpha[i];
    normal += share * texture.normal(i);
  }
  const double mean_length = length(normal);
  const bool bent = !texture.normals.empty() && mean_length > 0;
  for (int k = 0; k < 3 && bent; ++k) mean.normals.push_back(static_cast<float>(normal[k] / mean_length));
  if (!texture.alpha.empty()) mean.alpha = {static_cast<float>(covered)};
  std::array<double, 2> all{};
  for (const LobeSums& lobe : sums) all[0] += lobe.odd[0], all[1] += lobe.odd[1];
  const std::array<double, 2> common = direction_of(all);
  float* to = mean.values.data();
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(diffuse[k]);
  to[3] = static_cast<float>(common[0]), to[4] = static_cast<float>(common[1]), to += 5;
  for (const LobeSums& lobe : sums) {
    const auto [c, s] = texture.turns.empty() ? common : direction_of(lobe.odd);
    if (!texture.turns.empty())
      mean.turns.push_back(static_cast<float>(c)), mean.turns.push_back(static_cast<float>(s));
    const double n1 = std::exp(lobe.log_exponent / lobe.weight), even = lobe.even / lobe.weight;
    const double odd = (c * lobe.odd[0] + s * lobe.odd[1]) / lobe.weight;
    LafortuneLobe all_of = {n1 * lobe.energy, {even + odd, even - odd, lobe.normal / lobe.weight}, n1 - 1};
    if (bent) widen_by_normals(all_of, mean_length);
    for (int k = 0; k < 3; ++k)
      to[k] = static_cast<float>(all_of.albedo[k]), to[3 + k] = static_cast<float>(all_of.axes[k]);
    to[6] = static_cast<float>(all_of.exponent), to += 7;
  }
  return mean;
}

}  // namespace goniochrome::brdf
