#include "render/plan/sampled_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

// Points that are alike are looked for among so many of the list to either side.
constexpr std::size_t kReachInOrder = 48;

using Share = color::Rgb LightShares::*;
constexpr std::array<Share, 3> kShares = {&LightShares::direct, &LightShares::into_lobes, &LightShares::into_diffuse};

// How far normals are apart that count as much as places that are the larger half of the mesh's bounding box apart,
// which is 1/2 to 1 long here.
constexpr float kNormalsApart = 2;

// Squared.
float apart(const RayPoint& a, const RayPoint& b) {
  const rays::Float3 place = a.spot.position - b.spot.position,
                     normal = (1 / kNormalsApart) * (a.spot.shading - b.spot.shading);
  return rays::dot(place, place) + rays::dot(normal, normal);
}

// Points of one part whose light is told in the same way.
bool comparable(const RayPoint& a, const SampledLight& of_a, const RayPoint& b, const SampledLight& of_b) {
  return a.spot.part == b.spot.part && a.spot.inside == b.spot.inside && of_a.hidden == of_b.hidden && !of_b.certain;
}

void find_alike(const std::vector<RayPoint>& points, std::size_t step, std::vector<SampledLight>& lights,
                std::size_t light) {
  SampledLight& of = lights[light];
  std::array<float, kAlike> distances{};
  of.alike_count = 0;
  const std::size_t first = light - std::min(light, kReachInOrder),
                    last = std::min(lights.size() - 1, light + kReachInOrder);
  for (std::size_t j = first; j <= last; ++j) {
    if (!comparable(points[light * step], of, points[j * step], lights[j])) continue;
    const float distance = apart(points[light * step], points[j * step]);
    std::uint32_t at = of.alike_count;
    if (at == kAlike) {
      if (!(distance < distances[kAlike - 1])) continue;
      --at;
    } else {
      ++of.alike_count;
    }
    for (; at > 0 && distances[at - 1] > distance; --at)
      distances[at] = distances[at - 1], of.alike[at] = of.alike[at - 1];
    distances[at] = distance, of.alike[at] = static_cast<std::uint32_t>(j);
  }
}

// What is known of a light by itself: its mean, and how a fan scatters about that.
struct Own {
  LightShares mean;
  std::array<Covariance, 3> scatter = {};
};

Own own_of(const SampledLight& light) {
  Own own{light.mean(), {}};
  if (light.certain) return own;
  for (std::size_t k = 0; k < 3; ++k) {
    Estimates values;
    for (const LightShares& fan : light.fans) values.add(fan.*kShares[k]);
    own.scatter[k] = values.covariance();
  }
  return own;
}

double trace(const Covariance& c) {
  return c[0] + c[1] + c[2];
}

void tell(SampledLight& light, std::size_t number, std::size_t share, const std::vector<SampledLight>& lights,
          const std::vector<Own>& own) {
  const std::uint32_t count = light.alike_count;
  const Share of = kShares[share];
  color::Rgb mean;
  double noise = 0, fans = 0, squares = 0;
  Covariance scatter{};
  for (std::uint32_t a = 0; a < count; ++a) {
    const std::size_t j = light.alike[a];
    const auto n = static_cast<double>(lights[j].fans.size());
    mean += n * (own[j].mean.*of), fans += n, noise += trace(own[j].scatter[share]) / (n * count);
    for (std::size_t c = 0; c < scatter.size(); ++c) scatter[c] += own[j].scatter[share][c] / count;
  }
  light.scatter[share] = scatter;
  mean = (1 / fans) * mean;
  if (count < 2 || !(noise > 0)) return;
  for (std::uint32_t a = 0; a < count; ++a) {
    const color::Rgb off = own[light.alike[a]].mean.*of - mean;
    squares += dot(off, off) / (count - 1);
  }
  const double kept = std::sqrt(std::max(0.0, 1 - noise / squares));
  light.told.*of = mean + kept * (own[number].mean.*of - mean);
}

}  // namespace

LightShares SampledLight::mean() const {
  LightShares sum;
  for (const LightShares& fan : fans) sum += fan;
  if (!fans.empty()) sum = (1.0 / static_cast<double>(fans.size())) * sum;
  return sum += sure;
}

// The means scatter about their own mean with the variance of the light and that of the noise, S^2 = V + N. Those that
// are moved toward it by the root of V/S^2 have the variance V.
void tell_lights(const std::vector<RayPoint>& points, std::size_t step, std::vector<SampledLight>& lights) {
  constexpr std::size_t kTogether = 64;
  std::vector<Own> own(lights.size());
  parallel_for(lights.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) own[i] = own_of(lights[i]);
  });
  parallel_for(lights.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SampledLight& light = lights[i];
      light.told = own[i].mean;
      if (light.certain) continue;
      if (light.alike_count == 0) find_alike(points, step, lights, i);
      for (std::size_t k = 0; k < 3; ++k) tell(light, i, k, lights, own);
    }
  });
}

Covariance covariance(const SampledLight& light, const RayEffects& with, const RayEffects& without) {
  Covariance sum{};
  if (light.certain) return sum;
  const color::Rgb one = {1, 1, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    LightShares share;
    share.*kShares[k] = one;
    if (share.shown(with) == share.shown(without)) continue;
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += light.scatter[k][c] / static_cast<double>(light.fans.size());
  }
  return sum;
}

}  // namespace goniochrome::render
