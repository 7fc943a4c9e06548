#include "fit/surface_refit.h"

#include <ceres/tiny_solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "base/angles.h"

namespace goniochrome::fit {

namespace {

using brdf::LafortuneLobe;
using brdf::LobeSurface;
using brdf::TurnedLobe;

constexpr int kViewers = 24, kOfHemisphere = 12, kOfLobe = 10;
constexpr std::size_t kMostSources = 12;  // lobes from which directions are drawn
constexpr int kMostSteps = 40;
constexpr double kGoodEnough = 0.01;  // an error that spares the second start
constexpr double kLeastExponent = 0.02, kMostExponent = 1e6;

// A pair of directions, the reflectance of the target there and the root of the weight of an error there.
struct Sample {
  Vec3 to_light, to_viewer;
  color::Rgb target;
  double root_weight = 0;
};

// The fractional part of `first` + i times the share that covers an interval evenly in one dimension.
double spread(double first, double share, int i) {
  const double at = first + share * i;
  return at - std::floor(at);
}

Vec3 about(const Vec3& middle, double cosine, double azimuth) {
  const Vec3 other = std::abs(middle.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = normalized(cross(other, middle)), y = cross(middle, x);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return sine * std::cos(azimuth) * x + sine * std::sin(azimuth) * y + cosine * middle;
}

// The middle of a lobe for a viewer; below the surface where it has none.
Vec3 middle_of(const TurnedLobe& turned, const Vec3& to_viewer) {
  const double c = std::cos(turned.turn_rad), s = std::sin(turned.turn_rad);
  const Vec3 local =
      turned.lobe.axes * Vec3{c * to_viewer.x + s * to_viewer.y, c * to_viewer.y - s * to_viewer.x, to_viewer.z};
  const double size = std::hypot(local.x, local.y, local.z);
  if (!(size > 0)) return {0, 0, -1};
  return (1 / size) * Vec3{c * local.x - s * local.y, s * local.x + c * local.y, local.z};
}

// The lobe as it is in another frame, without what its matrix has beside the diagonal there.
LafortuneLobe seen_in(const TurnedLobe& turned, double turn_rad) {
  LafortuneLobe lobe = turned.lobe;
  const double even = 0.5 * (lobe.axes.x + lobe.axes.y);
  const double odd = 0.5 * (lobe.axes.x - lobe.axes.y) * std::cos(2 * (turned.turn_rad - turn_rad));
  lobe.axes.x = even + odd, lobe.axes.y = even - odd;
  return lobe;
}

// The mean of two lobes: of log(n+1) and of the axes, by what they reflect; together they reflect as much.
// brdf::merged() gives each union a frame of its own, of which a texel has one for all lobes: as the start for mixtures
// of two brushed metals it leaves 0.16 of them, and this 0.12.
LafortuneLobe merged(const LafortuneLobe& a, const LafortuneLobe& b) {
  const double share = brdf::lobe_energy(a) / (brdf::lobe_energy(a) + brdf::lobe_energy(b));
  const double log_n1 = share * std::log1p(a.exponent) + (1 - share) * std::log1p(b.exponent);
  LafortuneLobe lobe{{}, share * a.axes + (1 - share) * b.axes, std::expm1(log_n1)};
  lobe.albedo = (lobe.exponent + 1) * ((1 / (a.exponent + 1)) * a.albedo + (1 / (b.exponent + 1)) * b.albedo);
  return lobe;
}

double merging_cost(const LafortuneLobe& a, const LafortuneLobe& b) {
  const double ea = brdf::lobe_energy(a), eb = brdf::lobe_energy(b);
  if (!(ea + eb > 0)) return 0;
  const double wide = std::log1p(a.exponent) - std::log1p(b.exponent);
  const Vec3 apart = normalized(a.axes) - normalized(b.axes);
  return ea * eb / (ea + eb) * (wide * wide + (1 + std::min(a.exponent, b.exponent)) * dot(apart, apart));
}

// Lobes that are nearly alike as one, where there are many: the means of a map's texels have hundreds.
std::vector<LafortuneLobe> bundled(const std::vector<LafortuneLobe>& lobes) {
  if (lobes.size() <= kMostSources) return lobes;
  std::map<std::array<long, 4>, LafortuneLobe> bundles;
  for (const LafortuneLobe& lobe : lobes) {
    const std::array<long, 4> place = {std::lround(3 * std::log1p(lobe.exponent)), std::lround(5 * lobe.axes.x),
                                       std::lround(5 * lobe.axes.y), std::lround(5 * lobe.axes.z)};
    const auto [entry, is_new] = bundles.try_emplace(place, lobe);
    if (!is_new) entry->second = merged(entry->second, lobe);
  }
  std::vector<LafortuneLobe> result;
  for (const auto& [place, lobe] : bundles) result.push_back(lobe);
  return result;
}

// So many lobes in the frame of the lobe that reflects most, made by merging the two that are most alike, again and
// again; or the strongest of them.
LobeSurface start_of(const LobeSurface& target, std::size_t lobes, bool merge) {
  double turn = 0, most = -1;
  for (const TurnedLobe& lobe : target.lobes) {
    const double energy = brdf::lobe_energy(lobe.lobe);
    if (lobe.lobe.axes.x != lobe.lobe.axes.y && energy > most) most = energy, turn = lobe.turn_rad;
  }
  std::vector<LafortuneLobe> all;
  for (const TurnedLobe& lobe : target.lobes) all.push_back(seen_in(lobe, turn));
  if (merge) all = bundled(all);
  if (!merge && all.size() > lobes) {
    std::ranges::stable_sort(all, std::greater(), brdf::lobe_energy);
    all.resize(lobes);
  }
  while (all.size() > lobes) {
    std::size_t first = 0, second = 1;
    double least = merging_cost(all[0], all[1]);
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const double cost = merging_cost(all[i], all[j]);
        if (cost < least) least = cost, first = i, second = j;
      }
    }
    all[first] = merged(all[first], all[second]);
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(second));
  }
  LobeSurface start{target.diffuse, {}};
  for (const LafortuneLobe& lobe : all) start.lobes.push_back(brdf::turned_lobe(lobe, turn));
  return start;
}

// For each viewer, directions that are drawn from the hemisphere and from each lobe (where there are many, from a few
// in their place); an error is weighted by the density of all of these (the balance heuristic), so that the sum over
// samples is the integral over directions.
std::vector<Sample> samples_of(const LobeSurface& target) {
  std::vector<Sample> samples;
  const bool few = target.lobes.size() <= kMostSources;
  const LobeSurface about_these = few ? target : start_of(target, kMostSources, true);
  constexpr double kGolden = 0.61803398874989485, kSecond = 0.75487766624669276, kThird = 0.56984029099805327;
  for (int v = 0; v < kViewers; ++v) {
    const double cosine = std::sqrt(1 - (v + 0.5) / kViewers);
    const Vec3 to_viewer = about({0, 0, 1}, cosine, 2 * kPi * spread(0.13, kGolden, v));
    struct Source {
      Vec3 middle;
      double exponent;
      int count;
    };
    std::vector<Source> sources = {{{0, 0, 1}, 1, kOfHemisphere}};
    for (const TurnedLobe& lobe : about_these.lobes) {
      const Vec3 middle = middle_of(lobe, to_viewer);
      if (middle.z > -0.2) sources.push_back({middle, lobe.lobe.exponent, kOfLobe});
    }
    int number = 37 * v;
    for (const Source& source : sources) {
      for (int i = 0; i < source.count; ++i, ++number) {
        const double share = (i + spread(0.5, kThird, number)) / source.count;
        const double cosine_to = std::pow(share, 1 / (source.exponent + 1));
        const Vec3 to_light = about(source.middle, cosine_to, 2 * kPi * spread(0.31, kSecond, number));
        if (to_light.z <= 1e-3) continue;
        double density = 0;
        for (const Source& other : sources) {
          const double at = dot(other.middle, to_light);
          if (at > 0) density += other.count * brdf::scaled_power((other.exponent + 1) / (2 * kPi), at, other.exponent);
        }
        const color::Rgb f = brdf::brdf(target, to_light, to_viewer);
        if (!(color::mean(f) > 0) || !(density > 0)) continue;
        samples.push_back({to_light, to_viewer, f, std::sqrt(to_light.z / (density * kViewers * color::mean(f)))});
      }
    }
  }
  return samples;
}

// The light that the target reflects: the mean of f.
double whole_of(const std::vector<Sample>& samples) {
  double whole = 0;
  for (const Sample& sample : samples) {
    const double at = sample.root_weight * color::mean(sample.target);
    whole += at * at;
  }
  return whole;
}

double error_of(const std::vector<Sample>& samples, const LobeSurface& other) {
  double squares = 0;
  for (const Sample& sample : samples) {
    const color::Rgb apart =
        sample.root_weight * (brdf::brdf(other, sample.to_light, sample.to_viewer) - sample.target);
    squares += dot(apart, apart) / 3;
  }
  const double whole = whole_of(samples);
  return whole > 0 ? std::sqrt(squares / whole) : 0;
}

LobeSurface scaled(const LobeSurface& surface, double factor) {
  LobeSurface result;
  brdf::add_surface(result, surface, factor);
  return result;
}

// The parameters of the nonlinear fit are: the roots of the diffuse part; the angle of the frame; and of each lobe the
// roots of its albedo, two axes and the logarithm of its exponent. The longest axis stays, since the length of the axes
// and the albedo are one number. Lobes of a target that is the same along x and y stay so.
class Model {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

  Model(const std::vector<Sample>& samples, const LobeSurface& start) : samples_(samples) {
    for (const TurnedLobe& lobe : start.lobes) {
      round_ = round_ && lobe.lobe.axes.x == lobe.lobe.axes.y;
      if (lobe.lobe.axes.x != lobe.lobe.axes.y) turn_ = lobe.turn_rad;
      lobes_.push_back(lobe.lobe);
    }
    for (const LafortuneLobe& lobe : lobes_) {
      const Vec3 size = {std::abs(lobe.axes.x), std::abs(lobe.axes.y), std::abs(lobe.axes.z)};
      // Round lobes keep z, since x and y go together.
      held_.push_back(round_ || (size.z >= size.x && size.z >= size.y) ? 2 : size.x >= size.y ? 0 : 1);
    }
    diffuse_ = start.diffuse;
  }

  int NumResiduals() const { return 3 * static_cast<int>(samples_.size()); }
  int NumParameters() const { return 4 + kPerLobe * static_cast<int>(lobes_.size()); }

  Eigen::VectorXd start() const {
    Eigen::VectorXd x(NumParameters());
    for (int c = 0; c < 3; ++c) x[c] = std::sqrt(diffuse_[c]);
    x[3] = turn_;
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
      double* p = &x[4 + kPerLobe * static_cast<Eigen::Index>(i)];
      for (int c = 0; c < 3; ++c) p[c] = std::sqrt(lobes_[i].albedo[c]);
      const std::array<int, 2> free = free_axes(i);
      p[3] = lobes_[i].axes[free[0]], p[4] = lobes_[i].axes[free[1]];
      p[5] = std::log(std::max(lobes_[i].exponent, kLeastExponent));
    }
    return x;
  }

  LobeSurface surface(const double* x) const {
    LobeSurface result{{x[0] * x[0], x[1] * x[1], x[2] * x[2]}, {}};
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
      const double* p = x + 4 + kPerLobe * i;
      result.lobes.push_back(
          brdf::turned_lobe({{p[0] * p[0], p[1] * p[1], p[2] * p[2]}, axes(i, p), exponent(p)}, round_ ? 0 : x[3]));
    }
    return result;
  }

  bool operator()(const double* x, double* residuals, double* jacobian) const {
    const auto rows = static_cast<std::size_t>(NumResiduals());
    const auto at = [&](std::size_t row, std::size_t column) -> double& { return jacobian[column * rows + row]; };
    if (jacobian != nullptr) std::fill_n(jacobian, rows * static_cast<std::size_t>(NumParameters()), 0.0);
    const double cosine = std::cos(x[3]), sine = std::sin(x[3]);
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const Sample& sample = samples_[k];
      const double w = sample.root_weight;
      const Vec3 &o = sample.to_viewer, &i = sample.to_light;
      const double ox = cosine * o.x + sine * o.y, oy = cosine * o.y - sine * o.x;
      const double ix = cosine * i.x + sine * i.y, iy = cosine * i.y - sine * i.x;
      const Vec3 product = {ox * ix, oy * iy, o.z * i.z};
      for (std::size_t c = 0; c < 3; ++c) {
        residuals[3 * k + c] = w * (x[c] * x[c] - sample.target[static_cast<int>(c)]);
        if (jacobian != nullptr) at(3 * k + c, c) = 2 * w * x[c];
      }
      for (std::size_t lobe = 0; lobe < lobes_.size(); ++lobe) {
        const std::size_t first = 4 + kPerLobe * lobe;
        const double* p = x + first;
        const Vec3 a = axes(lobe, p);
        const double s = dot(a, product), n = exponent(p);
        if (!(s > 0)) continue;
        const double log_s = std::log(s), power = std::exp(std::min(n * log_s, 300.0));
        for (std::size_t c = 0; c < 3; ++c) residuals[3 * k + c] += w * p[c] * p[c] * power;
        if (jacobian == nullptr) continue;
        const double slope = n * power / s;  // of s^n
        const std::array<int, 2> free = free_axes(lobe);
        const double by_first = round_ ? product.x + product.y : product[free[0]], by_second = product[free[1]];
        const double by_turn = (a.x - a.y) * (ox * iy + oy * ix);
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t row = 3 * k + c;
          const double scale = w * p[c] * p[c];
          at(row, first + c) = 2 * w * p[c] * power;
          at(row, first + 3) = scale * slope * by_first;
          if (!round_) at(row, first + 4) = scale * slope * by_second, at(row, 3) += scale * slope * by_turn;
          at(row, first + 5) = scale * power * log_s * n;
        }
      }
    }
    return true;
  }

 private:
  static constexpr int kPerLobe = 6;

  std::array<int, 2> free_axes(std::size_t lobe) const {
    switch (held_[lobe]) {
      case 0:
        return {1, 2};
      case 1:
        return {0, 2};
      default:
        return {0, 1};
    }
  }
  Vec3 axes(std::size_t lobe, const double* p) const {
    Vec3 a = lobes_[lobe].axes;
    if (round_) return {p[3], p[3], a.z};
    const std::array<int, 2> free = free_axes(lobe);
    a[free[0]] = p[3], a[free[1]] = p[4];
    return a;
  }
  static double exponent(const double* p) { return std::clamp(std::exp(p[5]), kLeastExponent, kMostExponent); }

  const std::vector<Sample>& samples_;
  std::vector<LafortuneLobe> lobes_;
  std::vector<int> held_;  // the axis that stays
  color::Rgb diffuse_;
  bool round_ = true;
  double turn_ = 0;
};

}  // namespace

double refit_error(const LobeSurface& target, const LobeSurface& other) {
  return error_of(samples_of(target), other);
}

// The solver's tolerances are absolute, so the target is scaled to reflect 1.
Refit refit(const LobeSurface& given, int lobes) {
  const auto most = static_cast<std::size_t>(std::max(lobes, 0));
  if (given.lobes.size() <= most && brdf::has_one_frame(given)) return {given, 0};
  std::vector<Sample> samples = samples_of(given);
  const double whole = whole_of(samples);
  if (most == 0 || !(whole > 0)) {
    const LobeSurface plain{given.diffuse, {}};
    return {plain, refit_error(given, plain)};
  }
  const LobeSurface target = scaled(given, 1 / whole);
  for (Sample& sample : samples) {
    sample.target = (1 / whole) * sample.target;
    sample.root_weight *= std::sqrt(whole);
  }
  Refit best;
  best.error = -1;
  for (const bool merge : {true, false}) {
    if (!merge && (target.lobes.size() <= most || best.error < kGoodEnough)) continue;
    const LobeSurface start = start_of(target, most, merge);
    const Model model(samples, start);
    Eigen::VectorXd x = model.start();
    ceres::TinySolver<Model> solver;
    solver.options.max_num_iterations = kMostSteps;
    solver.options.initial_trust_region_radius = 1e2;
    solver.options.parameter_tolerance = 1e-6;
    solver.options.function_tolerance = 1e-9;
    solver.options.cost_threshold = 1e-12;
    solver.Solve(model, &x);
    for (const LobeSurface& candidate : {model.surface(x.data()), start}) {
      const double error = error_of(samples, candidate);
      if (std::isfinite(error) && (best.error < 0 || error < best.error)) best = {candidate, error};
    }
  }
  best.surface = scaled(best.surface, whole);
  return best;
}

}  // namespace goniochrome::fit
