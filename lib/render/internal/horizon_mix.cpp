#include "render/internal/horizon_mix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "base/angles.h"
#include "base/kept_values.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"
#include "math/quadrature.h"

namespace goniochrome::render {

namespace {

// Light around falls with the degree l as (l + 1/2)^-2.3 [Dror2004]; what maps err by, and what is beyond the last
// degree, counts as so much of its standard deviation.
constexpr int kDegrees = 32;
constexpr double kFall = 2.3, kMapError = 0.01;

using Spectrum = std::array<double, kDegrees + 1>;

// The variance that light has in each degree, for each steradian; none is told of even light.
const Spectrum& variances() {
  static const Spectrum of_degree = [] {
    Spectrum result{};
    for (int l = 1; l <= kDegrees; ++l)
      result[static_cast<std::size_t>(l)] = (2 * l + 1) / (4 * kPi) * math::pow(l + 0.5, -kFall);
    return result;
  }();
  return of_degree;
}

double map_variance() {
  double sum = 0;
  for (const double of_degree : variances()) sum += of_degree;
  return kMapError * kMapError * sum;
}

void legendre(double x, Spectrum& p) {
  p[0] = 1, p[1] = x;
  for (std::size_t l = 2; l <= kDegrees; ++l) {
    const auto n = static_cast<double>(l);
    p[l] = ((2 * n - 1) * x * p[l - 1] - (n - 1) * p[l - 2]) / n;
  }
}

double sum_of(const Spectrum& a, const Spectrum& b) {
  double sum = 0;
  for (std::size_t l = 0; l <= kDegrees; ++l) sum += a[l] * b[l];
  return sum;
}

// Legendre coefficients of cos^E T, the first one 1.
Spectrum spectrum_of(double exponent, double coat_index) {
  static const std::vector<math::QuadraturePoint> points = math::gauss_legendre(96);
  Spectrum sums{}, p;
  for (const math::QuadraturePoint& point : points) {
    const double x = 0.5 * (1 + point.position),
                 weight = point.weight * math::pow(x, exponent) * brdf::coat_transmission(x, coat_index);
    legendre(x, p);
    for (std::size_t l = 0; l <= kDegrees; ++l) sums[l] += weight * p[l];
  }
  const double whole = sums[0];
  for (double& sum : sums) sum /= whole;
  return sums;
}

// A direction in the plane of r and n: its components along r and across it, of r + s n.
struct Toward {
  double along, across;
  double cosine_to(const Toward& other) const { return along * other.along + across * other.across; }
};
Toward shifted(double cos_o, double shift) {
  const double along = 1 + shift * cos_o, across = shift * std::sqrt(std::max(0.0, 1 - cos_o * cos_o));
  const double size = std::sqrt(along * along + across * across);
  return {along / size, across / size};
}
Toward normal(double cos_o) {
  return {cos_o, std::sqrt(std::max(0.0, 1 - cos_o * cos_o))};
}

// Solves m x = b for several b, in place; m is positive definite, n x n (Cholesky).
void solve(std::vector<double>& m, std::size_t n, std::vector<color::Rgb>& b) {
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double sum = m[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= m[i * n + k] * m[j * n + k];
      m[i * n + j] = i == j ? std::sqrt(sum) : sum / m[j * n + j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] += -m[i * n + k] * b[k];
    b[i] = (1 / m[i * n + i]) * b[i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] += -m[k * n + i] * b[k];
    b[i] = (1 / m[i * n + i]) * b[i];
  }
}

}  // namespace

// A function of the angle alone, by its cosine.
class HorizonMix::Zonal {
 public:
  explicit Zonal(const Spectrum& degrees) {
    Spectrum p;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      legendre(2.0 * static_cast<double>(i) / kPieces - 1, p);
      values_[i] = sum_of(degrees, p);
    }
  }
  double at(double cosine) const {
    const double x = std::clamp(0.5 * kPieces * (1 + cosine), 0.0, static_cast<double>(kPieces));
    const auto i = std::min(static_cast<std::size_t>(x), std::size_t{kPieces - 1});
    const double t = x - static_cast<double>(i);
    return (1 - t) * values_[i] + t * values_[i + 1];
  }

 private:
  static constexpr std::size_t kPieces = 2048;
  std::array<double, kPieces + 1> values_;
};

// A curve holds for each node the covariance of the light that a lobe sends in even light of 1 with a map, by where the
// map is looked up: where the light of flakes comes from, and where that of gloss does.
struct HorizonMix::Curve {
  struct Node {
    std::array<double, 2> cosine, plain, fresnel;
  };
  std::vector<Node> nodes;
};

// The covariance of two maps, by the angle between the directions in which they are looked up.
std::shared_ptr<const HorizonMix::Zonal> HorizonMix::covariance(const Kernel& a, const Kernel& b) {
  static KeptValues<std::pair<Kernel, Kernel>, Zonal> kept;
  return kept.get({a, b}, [&] {
    const Spectrum of_a = spectrum_of(a.exponent, a.coat_index), of_b = spectrum_of(b.exponent, b.coat_index);
    Spectrum both;
    for (std::size_t l = 0; l <= kDegrees; ++l) both[l] = variances()[l] * of_a[l] * of_b[l];
    return Zonal(both);
  });
}

std::shared_ptr<const HorizonMix::Curve> HorizonMix::curve(double exponent, std::size_t map) const {
  static KeptValues<std::tuple<double, double, int, bool, Kernel>, Curve> kept;
  const bool is_lobe = map < exponents_.size();
  const Kernel& kernel = maps_[map];
  return kept.get({exponent, coat_index_, segments_, is_lobe, kernel}, [&] {
    Spectrum degrees = spectrum_of(kernel.exponent, kernel.coat_index);
    for (std::size_t l = 0; l <= kDegrees; ++l) degrees[l] *= variances()[l];
    const Zonal seen(degrees);
    Curve result;
    for (int node = 0; node <= segments_; ++node) {
      const double x = static_cast<double>(node) / segments_, cos_o = x * x;
      std::array toward{normal(cos_o), normal(cos_o)};
      if (is_lobe) {
        const LobeIntegrals& looks = (*looks_[map])[static_cast<std::size_t>(node)];
        toward = {shifted(cos_o, looks.cosine_shift), shifted(cos_o, looks.plain_shift)};
      }
      Curve::Node& sums = result.nodes.emplace_back();
      LobeIntegrals whole;
      for (const LobeSample& sample : lobe_samples(exponent, cos_o, coat_index_)) {
        whole.cosine += sample.cosine, whole.plain += sample.plain, whole.fresnel += sample.fresnel;
        for (std::size_t k = 0; k < 2; ++k) {
          const double here = seen.at(toward[k].cosine_to({sample.along, sample.across}));
          sums.cosine[k] += sample.cosine * here, sums.plain[k] += sample.plain * here;
          sums.fresnel[k] += sample.fresnel * here;
        }
      }
      for (std::size_t k = 0; k < 2; ++k) {
        sums.cosine[k] /= std::max(whole.cosine, 1e-300);
        sums.plain[k] /= whole.plain, sums.fresnel[k] /= whole.fresnel;
      }
    }
    return result;
  });
}

HorizonMix::HorizonMix(const std::vector<double>& exponents, int segments, double coat_index, Diffuse diffuse,
                       bool fresnel)
    : exponents_(exponents), segments_(segments), coat_index_(coat_index), fresnel_(fresnel) {
  for (const double exponent : exponents) {
    maps_.push_back({exponent, paint::kNoCoat});
    looks_.push_back(lobe_curve(exponent, segments, true, coat_index));
  }
  if (diffuse != Diffuse::kNone) maps_.push_back({1, diffuse == Diffuse::kCoated ? brdf::kCoatIndex : paint::kNoCoat});
  for (std::size_t j = 0; j < maps_.size(); ++j)
    for (std::size_t k = 0; k <= j; ++k) covariances_.push_back(covariance(maps_[j], maps_[k]));
  for (const double exponent : exponents)
    for (std::size_t j = 0; j < maps_.size(); ++j) curves_.push_back(curve(exponent, j));
}

// Even light comes out exact where the weights have the sum of the sent light: the weight of the last map is the rest,
// so that the differences of the others from it are solved for.
HorizonMix::Weights HorizonMix::at(const std::vector<Sent>& sent, int node) const {
  const double x = static_cast<double>(node) / segments_, cos_o = x * x;
  const auto sum = [](const color::Rgb& c) { return std::abs(c.x) + std::abs(c.y) + std::abs(c.z); };
  const std::size_t lobes = exponents_.size(), maps = maps_.size(), last = maps - 1;
  Weights weights;
  std::vector<double> shares(maps, 0.0);
  std::vector<Toward> toward(maps, normal(cos_o));
  color::Rgb all;
  for (std::size_t j = 0; j < lobes; ++j) {
    const double flake = sum(sent[j].flake), gloss = sum(sent[j].gloss);
    if (flake + gloss > 0) shares[j] = gloss / (flake + gloss);
    const LobeIntegrals& looks = (*looks_[j])[static_cast<std::size_t>(node)];
    weights.shifts.push_back(looks.cosine_shift + shares[j] * (looks.plain_shift - looks.cosine_shift));
    toward[j] = shifted(cos_o, weights.shifts.back());
    all += sent[j].flake + sent[j].gloss;
  }
  std::vector<double> between(maps * maps);
  std::vector<color::Rgb> wanted(maps);
  for (std::size_t j = 0; j < maps; ++j) {
    for (std::size_t k = 0; k <= j; ++k)
      between[j * maps + k] = between[k * maps + j] =
          covariances_[j * (j + 1) / 2 + k]->at(toward[j].cosine_to(toward[k])) + (j == k ? map_variance() : 0);
    for (std::size_t i = 0; i < lobes; ++i) {
      const Curve::Node& of = curves_[i * maps + j]->nodes[static_cast<std::size_t>(node)];
      const auto here = [&](const std::array<double, 2>& ends) { return ends[0] + shares[j] * (ends[1] - ends[0]); };
      wanted[j] += here(of.cosine) * sent[i].flake + here(fresnel_ ? of.fresnel : of.plain) * sent[i].gloss;
    }
  }
  std::vector<double> differences(last * last);
  std::vector<color::Rgb> solved(last);
  for (std::size_t j = 0; j < last; ++j) {
    solved[j] = wanted[j] - wanted[last] - (between[j * maps + last] - between[last * maps + last]) * all;
    for (std::size_t k = 0; k < last; ++k)
      differences[j * last + k] =
          between[j * maps + k] - between[j * maps + last] - between[last * maps + k] + between[last * maps + last];
  }
  solve(differences, last, solved);
  color::Rgb rest = all;
  for (const color::Rgb& of_map : solved) rest = rest - of_map;
  solved.push_back(rest);
  weights.lobes.assign(solved.begin(), solved.begin() + static_cast<std::ptrdiff_t>(lobes));
  if (maps > lobes) weights.diffuse = solved.back();
  return weights;
}

}  // namespace goniochrome::render
