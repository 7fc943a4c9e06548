// For tests: a rough dielectric from the equations of its own paper, integrated by directions that are drawn from its
// facets. Nothing of rough_coat.cpp is in it.
#pragma once

#include <cmath>
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

  // Calls see(light, weight) for `count` directions that send light to `out`; the weights are what each of them adds to
  // an even light of 1.
  template <class See>
  void each_light(const Vec3& out, int count, const See& see) const {
    constexpr double kGolden = 1.32471795724474602596;  // evenly spread pairs [Roberts]
    for (int i = 0; i < 2 * count; ++i) {
      const double a = i % 2 == 0 ? slope : haze;
      const double u = std::fmod(0.5 + (i / 2) / kGolden, 1), v = std::fmod(0.5 + (i / 2) / (kGolden * kGolden), 1);
      const double t = a * (beckmann ? std::sqrt(-std::log(1 - u)) : std::sqrt(u / (1 - u))), p = 2 * kPi * v;
      const double c = 1 / std::sqrt(1 + t * t);
      const Vec3 half = {c * t * std::cos(p), c * t * std::sin(p), c};
      const double cosine = dot(out, half);
      if (cosine <= 0) continue;
      const Vec3 light = 2 * cosine * half - out;
      if (light.z <= 0) continue;
      const double share = std::exp(-k * cosine * cosine), part = i % 2 == 0 ? share : 1 - share;
      const double seen = 1 / (1 + lambda(light, a) + lambda(out, a));
      see(light, part * fresnel(cosine, 1.5) * seen * cosine / (out.z * c) / count);
    }
  }
};

// The windows of the meters [ASTM D523].
// What the meter reads: the light of each point of the source, counted where it enters the receptor.
inline double true_reading(const TrueCoat& coat, const TestMeter& meter, int count) {
  const double t = meter.angle_deg * kDegree;
  const auto window = [](double deg) { return std::tan(deg / 2 * kDegree); };
  double read = 0, standard = 0;
  constexpr int kPoints = 6;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      const double p = window(0.75) * ((2 * i + 1.0) / kPoints - 1), q = window(2.5) * ((2 * j + 1.0) / kPoints - 1);
      const Vec3 from = {-std::sin(t) - p * std::cos(t), q, std::cos(t) - p * std::sin(t)};
      const double size = length(from), weight = 1 / (size * size * size);
      const Vec3 in = (1 / size) * from;
      standard += weight * in.z * TrueCoat::fresnel(in.z, 1.567);
      coat.each_light(in, count, [&](const Vec3& out, double energy) {
        const double along = out.x * std::sin(t) + out.z * std::cos(t);
        if (along <= 0) return;
        const double p_out = (out.x * std::cos(t) - out.z * std::sin(t)) / along, q_out = out.y / along;
        if (std::abs(p_out) <= window(meter.receptor_par_deg) && std::abs(q_out) <= window(meter.receptor_perp_deg))
          read += weight * in.z * energy;
      });
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
