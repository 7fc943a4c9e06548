// The weights of a view are those x >= 0 for which sum x_j lobe_j differs least from the light of the coat, as seen by
// photographed light, whose power falls with the square of the frequency: the covariance of such light at two
// directions falls with the logarithm of their distance d, C - ln d. With the difference e as a density of energy,
//
//   least    E(e) = int int e(w) e(w') (C - ln |w - w'|) dw dw'.
//
// A lobe cos^E is taken as a Gaussian of the variance 1/(E + 2) along each axis, that of its chord. The distance of two
// points that are drawn from Gaussians at a distance d has a Gaussian of both variances together, s^2, and the mean
//
//   -2 <ln |w - w'|> = -(ln d^2 + E1(d^2/(2 s^2)))        [AbramowitzStegun] 5.1.1
//
// is known in closed form, so that E is a quadratic form of x. The light of the coat itself is drawn at random.
#include "brdf/coat_tilts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "brdf/coat_facets.h"
#include "brdf/tilted_lobes.h"
#include "math/elementary.h"
#include "math/least_squares.h"

namespace goniochrome::brdf {

namespace {

constexpr double kEuler = 0.57721566490153286;

// ln x + E1(x) for x >= 0, to 2e-7 [AbramowitzStegun] 5.1.53, 5.1.56.
double log_and_e1(double x) {
  if (x <= 1)
    return -kEuler + x * (0.99999193 + x * (-0.24991055 + x * (0.05519968 + x * (-0.00976004 + x * 0.00107857))));
  if (x > 30) return math::log(x);
  const double above = 0.2677737343 + x * (8.6347608925 + x * (18.0590169730 + x * (8.5733287401 + x))),
               below = 3.9584969228 + x * (21.0996530827 + x * (25.6329561486 + x * (9.5733223454 + x)));
  return math::log(x) + math::exp(-x) / x * above / below;
}

// C - <ln |w - w'|> where the middles are `chord2` apart in squares and the variances are together `variance`. C makes
// the whole energy count more than where it goes.
double likeness(double chord2, double variance) {
  constexpr double kWhole = 30;
  return kWhole - 0.5 * (math::log(2 * variance) + log_and_e1(chord2 / (2 * variance)));
}

double variance_of(double exponent) {
  return 1 / (exponent + 2);
}

double squared_chord(const Vec3& a, const Vec3& b) {
  const Vec3 apart = a - b;
  return dot(apart, apart);
}

struct Drawn {
  Vec3 light;
  double energy;
};

// The light that the coat sends to a viewer, in the frame of tilted_axis().
std::vector<Drawn> drawn_light(const CoatFacets& facets, double view_deg) {
  constexpr int kDirections = 768;
  constexpr double kGolden = 1.22074408460575947536;  // evenly spread triples [Roberts]
  const double view = view_deg * kDegree;
  const Vec3 out = {-math::sin(view), 0, math::cos(view)};
  std::vector<Drawn> light;
  for (int i = 0; i < kDirections; ++i) {
    const auto number = [&](int power) { return std::fmod(0.5 + i / math::pow(kGolden, power), 1); };
    const Vec3 to = facets.drawn(out, number(1), number(2), number(3));
    const CoatFacets::Sent sent = facets.sent(to, out);
    if (sent.f_cos > 0 && sent.pdf > 0) light.push_back({to, sent.f_cos / sent.pdf / kDirections});
  }
  return light;
}

// Lobes about the mirror direction, and beside it by steps of their own width.
std::vector<paint::TiltedLobe> candidates(const std::vector<double>& exponents) {
  constexpr int kSteps = 5;
  constexpr double kStep = 0.9, kMost_deg = 60;
  std::vector<paint::TiltedLobe> lobes;
  for (const double exponent : exponents) {
    const double width_deg = std::sqrt(variance_of(exponent)) / kDegree;
    for (int k = -kSteps; k <= kSteps; ++k)
      if (std::abs(k * kStep * width_deg) <= kMost_deg) lobes.push_back({exponent, k * kStep * width_deg, 0});
  }
  return lobes;
}

// The triangle L of A = L L', by Cholesky, with a little more on the diagonal so that lobes may be nearly alike.
math::Matrix triangle_of(const std::vector<paint::TiltedLobe>& lobes, double view_deg) {
  constexpr double kMore = 1e-7;
  const int n = static_cast<int>(lobes.size());
  math::Matrix l(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) {
      const double chord2 = squared_chord(tilted_axis(lobes[i], view_deg), tilted_axis(lobes[j], view_deg));
      double sum = likeness(chord2, variance_of(lobes[i].exponent) + variance_of(lobes[j].exponent));
      if (i == j) sum += kMore * sum;
      for (int k = 0; k < j; ++k) sum -= l(i, k) * l(j, k);
      l(i, j) = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / l(j, j);
    }
  return l;
}

// x >= 0 for which x'Ax - 2 x'b is least.
std::vector<double> least_energy(const math::Matrix& l, std::vector<double> b) {
  const int n = l.rows;
  math::Matrix transposed(n, n);
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k) b[j] -= l(j, k) * b[k];
    b[j] /= l(j, j);
    for (int i = j; i < n; ++i) transposed(j, i) = l(i, j);
  }
  return math::nnls(transposed, b).x;
}

std::vector<double> view_weights(const CoatFacets& facets, const std::vector<paint::TiltedLobe>& lobes, double view_deg,
                                 double mirrored) {
  const std::vector<Drawn> light = drawn_light(facets, view_deg);
  const Vec3 mirror = tilted_axis({1, 0, 0}, view_deg);
  std::vector<double> like;
  for (const paint::TiltedLobe& lobe : lobes) {
    const Vec3 axis = tilted_axis(lobe, view_deg);
    const double variance = variance_of(lobe.exponent);
    double sum = -mirrored * likeness(squared_chord(axis, mirror), variance);
    for (const Drawn& drawn : light) sum += drawn.energy * likeness(squared_chord(axis, drawn.light), variance);
    like.push_back(sum);
  }
  constexpr double kLeast = 0.004;  // of the light: less is not looked up
  std::vector<double> weights(lobes.size(), 0.0);
  std::vector<std::size_t> of;
  for (std::size_t j = 0; j < lobes.size(); ++j)
    if (view_deg > 0 || lobes[j].tilt_deg == 0) of.push_back(j);
  while (!of.empty()) {
    std::vector<paint::TiltedLobe> few;
    std::vector<double> b;
    for (const std::size_t j : of) few.push_back(lobes[j]), b.push_back(like[j]);
    const std::vector<double> x = least_energy(triangle_of(few, view_deg), b);
    double all = 0;
    for (const double w : x) all += w;
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < of.size(); ++k)
      if (x[k] > kLeast * all) kept.push_back(of[k]);
    if (kept.size() == of.size()) {
      for (std::size_t k = 0; k < of.size(); ++k) weights[of[k]] = x[k];
      break;
    }
    of = std::move(kept);
  }
  return weights;
}

}  // namespace

paint::TiltedLobes coat_tilts(const RoughCoat& coat, double index, const std::vector<double>& exponents,
                              const std::vector<double>& mirrored) {
  const CoatFacets facets(coat, index);
  paint::TiltedLobes set;
  set.lobes = candidates(exponents);
  for (std::size_t v = 0; v < std::size(kCoatViews_deg); ++v) {
    paint::TiltedView& view = set.views.emplace_back();
    view.view_deg = kCoatViews_deg[v];
    for (const double weight : view_weights(facets, set.lobes, view.view_deg, mirrored[v]))
      view.weights.push_back({weight, weight, weight});
  }
  return set;
}

}  // namespace goniochrome::brdf
