// For tests: a rough dielectric from the equations of its own paper, integrated by directions that are drawn from its
// facets. Nothing of rough_coat.cpp is in it.
#pragma once

#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "base/angles.h"
#include "base/random_for_test.h"
#include "base/vec3.h"
#include "brdf/internal/gloss_meter_for_test.h"

namespace goniochrome::brdf {

// One or two scales of facets: exp(-k cos^2) of the light is sent by facets of slope `slope`, the rest by `haze`.
struct TrueCoat {
  double k, slope, haze;
  bool beckmann = false;  // the slopes of both are Gaussian

  // From the amplitudes of both polarizations.
  static double fresnel(double c, double index) {
    const double t = std::sqrt(std::max(0.0, 1 - (1 - c * c) / (index * index)));
    const double s = (c - index * t) / (c + index * t), p = (index * c - t) / (index * c + t);
    return (s * s + p * p) / 2;
  }
  static double tangent(const Vec3& w) { return std::hypot(w.x, w.y) / w.z; }
  double lambda(const Vec3& w, double a) const {
    const double x = 1 / (a * tangent(w));
    if (!beckmann) return (std::sqrt(1 + 1 / (x * x)) - 1) / 2;
    return (std::erf(x) - 1) / 2 + std::exp(-x * x) / (2 * x * std::sqrt(kPi));
  }

  // f cos_i, for directions above the horizon.
  double f_cos(const Vec3& light, const Vec3& out) const {
    const Vec3 half = normalized(light + out);
    const double cosine = dot(light, half), share = std::exp(-k * cosine * cosine), t2 = std::pow(tangent(half), 2);
    double sum = 0;
    for (const auto& [part, a] : {std::pair{share, slope}, std::pair{1 - share, haze}}) {
      const double spread = beckmann ? std::exp(-t2 / (a * a)) / (a * a) : a * a / std::pow(a * a + t2, 2);
      sum += part * spread / (kPi * std::pow(half.z, 4)) / (1 + lambda(light, a) + lambda(out, a));
    }
    return fresnel(cosine, 1.5) * sum / (4 * out.z);
  }

  // Normals of `count` facets of each scale, evenly spread. Those of the last coat are kept, as many views ask for
  // them.
  const std::vector<Vec3>& facets(int count) const {
    struct Kept {
      TrueCoat coat{};
      int count = 0;
      std::vector<Vec3> normals;
    };
    thread_local Kept kept;
    const TrueCoat& last = kept.coat;
    if (count == kept.count &&
        std::tie(k, slope, haze, beckmann) == std::tie(last.k, last.slope, last.haze, last.beckmann))
      return kept.normals;
    kept = {*this, count, {}};
    constexpr double kGolden = 1.32471795724474602596;  // evenly spread pairs [Roberts]
    for (int i = 0; i < count; ++i) {
      const double u = std::fmod(0.5 + i / kGolden, 1), p = 2 * kPi * std::fmod(0.5 + i / (kGolden * kGolden), 1);
      for (int scale = 0; scale < scales(); ++scale) {
        const double t =
            (scale == 0 ? slope : haze) * (beckmann ? std::sqrt(-std::log(1 - u)) : std::sqrt(u / (1 - u)));
        const double c = 1 / std::sqrt(1 + t * t);
        kept.normals.push_back({c * t * std::cos(p), c * t * std::sin(p), c});
      }
    }
    return kept.normals;
  }
  int scales() const { return k > 0 ? 2 : 1; }

  // Calls see(light, weight) for the `wanted` of `count` directions that send light to `out`; the weights are what each
  // of them adds to an even light of 1.
  template <class Wanted, class See>
  void each_light(const Vec3& out, int count, const Wanted& wanted, const See& see) const {
    const std::vector<Vec3>& normals = facets(count);
    const double hidden[] = {lambda(out, slope), lambda(out, haze)};
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const Vec3& half = normals[i];
      const double cosine = dot(out, half);
      if (cosine <= 0) continue;
      const Vec3 light = 2 * cosine * half - out;
      if (light.z <= 0 || !wanted(light)) continue;
      const bool second = scales() == 2 && i % 2 == 1;
      const double share = std::exp(-k * cosine * cosine), part = second ? 1 - share : share;
      const double seen = 1 / (1 + lambda(light, second ? haze : slope) + hidden[second ? 1 : 0]);
      see(light, part * fresnel(cosine, 1.5) * seen * cosine / (out.z * half.z) / count);
    }
  }
  template <class See>
  void each_light(const Vec3& out, int count, const See& see) const {
    each_light(
        out, count, [](const Vec3&) { return true; }, see);
  }
};

// The windows of the meters [ASTM D523].
// What the meter reads: the light of each point of the source, counted where it enters the receptor.
inline double true_reading(const TrueCoat& coat, const TestMeter& meter, int count) {
  const double sine = std::sin(meter.angle_deg * kDegree), cosine = std::cos(meter.angle_deg * kDegree);
  const auto window = [](double deg) { return std::tan(deg / 2 * kDegree); };
  const double half_par = window(meter.receptor_par_deg), half_perp = window(meter.receptor_perp_deg);
  double read = 0, standard = 0;
  constexpr int kPoints = 6;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      const double p = window(0.75) * ((2 * i + 1.0) / kPoints - 1), q = window(2.5) * ((2 * j + 1.0) / kPoints - 1);
      const Vec3 from = {-sine - p * cosine, q, cosine - p * sine};
      const double size = length(from), weight = 1 / (size * size * size);
      const Vec3 in = (1 / size) * from;
      standard += weight * in.z * TrueCoat::fresnel(in.z, 1.567);
      const auto is_received = [&](const Vec3& out) {
        const double along = out.x * sine + out.z * cosine;
        return along > 0 && std::abs(out.x * cosine - out.z * sine) <= along * half_par &&
               std::abs(out.y) <= along * half_perp;
      };
      coat.each_light(in, count, is_received, [&](const Vec3&, double energy) { read += weight * in.z * energy; });
    }
  return 100 * read / standard;
}

// Forty coats: twenty of one scale, twenty of two.
inline std::vector<TrueCoat> true_coats() {
  TestNumbers next(20);
  std::vector<TrueCoat> coats;
  for (int i = 0; i < 40; ++i) {
    const double slope = std::exp(std::lerp(std::log(0.003), std::log(i % 2 == 0 ? 0.3 : 0.05), next()));
    const double k = 0.1 + 2.9 * next(), haze = 0.15 + 0.35 * next();
    coats.push_back({i % 2 == 0 ? 0 : k, slope, haze});
  }
  return coats;
}

}  // namespace goniochrome::brdf
