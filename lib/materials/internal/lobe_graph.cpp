#include "materials/internal/lobe_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "materials/internal/ggx.h"
#include "math/least_squares.h"

namespace goniochrome::materials {

namespace {

constexpr std::array kLobeAlphas = {0.02, 0.03, 0.045, 0.065, 0.09, 0.12, 0.16, 0.21, 0.28, 0.37, 0.5, 0.7, 1.0};

constexpr Facets kEven = {1, 1, 5}, kFalling = {1, 0, 0.5}, kGlossy = {0.04, 1, 5};
// Facets for paints that the others leave farther away.
constexpr std::array kMoreFacets = {Facets{1, 0, 0.25}, Facets{1, 0, 1}, Facets{1, 0, 2}, Facets{1, 0, 5}};

constexpr int kSteps = 4;  // ten lower the mean by 0.3 % more
constexpr double kLarge_de00 = 1;
constexpr double kWanted_de00 = 1;  // at compared_geometries(), in the mean

// Gloss lobes of this exponent and more are the coat's, and wider ones are fitted as lobes.
constexpr double kCoatExponent = 500;

double reflectance(const Facets& facets, double cosine) {
  if (facets.color0 == facets.color90) return facets.color0;
  return facets.color0 + (facets.color90 - facets.color0) * std::pow(1 - cosine, facets.exponent);
}

// The reflectance of a node for a reflectance F of its facets, relative to a single reflection: light that facets send
// to each other is given back.
double compensation(double all, double fresnel) {
  return 1 + fresnel * (1 - all) / all;
}

// facet_albedo() of one roughness over the cosine of the viewer.
class AlbedoTable {
 public:
  explicit AlbedoTable(double alpha) {
    for (std::size_t i = 0; i < table_.size(); ++i)
      table_[i] = facet_albedo(alpha, static_cast<double>(i) / static_cast<double>(table_.size() - 1));
  }
  FacetAlbedo at(double cosine) const {
    const double x = std::clamp(cosine, 0.0, 1.0) * static_cast<double>(table_.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), table_.size() - 2);
    const double t = x - static_cast<double>(i);
    return {std::lerp(table_[i].all, table_[i + 1].all, t), std::lerp(table_[i].grazing, table_[i + 1].grazing, t)};
  }

 private:
  std::array<FacetAlbedo, 49> table_{};
};

// The coats as their nodes show them: their reflectance, and the light that they leave to the base. The layer node
// takes away what the node above reflects to the viewer of even light.
class CoatModel {
 public:
  explicit CoatModel(const LobeGraph& graph) : layered_(graph.layered) {
    for (const CoatNode& coat : graph.coats) coats_.push_back({coat, AlbedoTable(coat.alpha)});
  }
  struct Seen {
    double reflected = 0, left = 1;  // f in 1/sr; 0..1
  };
  Seen at(const Vec3& light, const Vec3& view) const {
    Seen seen;
    for (const auto& [coat, table] : coats_) {
      const FacetAlbedo albedo = table.at(view.z);
      const double normal = (coat.index - 1) / (coat.index + 1), f0 = normal * normal;
      const double fresnel = brdf::fresnel_dielectric(half_cosine(light, view), coat.index);
      const double more = compensation(albedo.all, fresnel);
      // A smooth coat reflects along the mirror direction alone.
      if (coat.alpha > 0) seen.reflected += seen.left * coat.weight * fresnel * more * ggx(coat.alpha, light, view);
      if (layered_) seen.left *= 1 - coat.weight * more * (f0 * (albedo.all - albedo.grazing) + albedo.grazing);
    }
    return seen;
  }

 private:
  struct Coat {
    CoatNode node;
    AlbedoTable table;
  };
  std::vector<Coat> coats_;
  bool layered_;
};

// The coats of a paint: its mirror, and its sharp lobes of gloss as one of a GGX. The other lobes are the base's.
void set_coats(const paint::LobeFit& lobes, LobeGraph& graph) {
  paint::LobeFit sharp = lobes;
  std::erase_if(sharp.lobes, [](const paint::Lobe& lobe) { return lobe.exponent < kCoatExponent; });
  graph.layered = lobes.coat_index > paint::kNoCoat;
  const CoatGloss gloss = coat_gloss(sharp);
  const double index = brdf::mirror_index(lobes.coat_index);
  if (gloss.mirror > 0) graph.coats.push_back({gloss.mirror, 0, index});
  if (gloss.satin > 0) graph.coats.push_back({gloss.satin, gloss.satin_alpha, index});
}

// The directions of fit_samples() as a picture under even light counts them: each light by its cosine and its part of
// the hemisphere, each viewer likewise. The other half of the weight is on compared_geometries().
std::vector<FitSample> picture_samples(const paint::LobeFit& lobes) {
  static const std::vector<FitSample> directions = [] {
    std::vector<FitSample> list;
    constexpr double kGlare_deg = 12, kViews_deg[] = {0, 15, 30, 45, 60, 72}, kLights_deg[] = {5, 20, 35, 50, 65, 78};
    constexpr double kLeastPart = 0.15;  // of viewers near the normal, which are few
    for (const double view : kViews_deg)
      for (const double light : kLights_deg)
        for (const double azimuth : {0, 45, 90, 120, 150, 180}) {
          if (azimuth > 0 && view == 0) continue;
          FitSample sample{direction(light * kDegree, azimuth * kDegree), direction(view * kDegree, 0), 1, {}};
          if (paint::aspecular_angle_rad(sample.light, sample.view, {0, 0, 1}) < kGlare_deg * kDegree) continue;
          sample.weight = sample.light.z * std::sin(light * kDegree) * sample.view.z *
                          std::max(kLeastPart, std::sin(view * kDegree));
          list.push_back(sample);
        }
    return with_geometries(std::move(list));
  }();
  return reflected(directions, lobes);
}

// All nodes that a base may have, and what each is at the directions of picture_samples(), sample by sample. Nodes of
// gloss are for paints that have gloss beside the coat's.
struct Offered {
  std::vector<BaseNode> nodes;  // the first `usual` of them for every paint, the others where these do not do
  std::size_t usual = 0;
  std::vector<double> values;
};

Offered offers_at(const std::vector<FitSample>& samples, bool glossy) {
  Offered list;
  list.nodes.push_back({BaseNode::Kind::kFlat, 0, {}, false, {}});
  list.nodes.push_back({BaseNode::Kind::kBurley, 0, {}, false, {}});
  for (const bool widened : {false, true})
    for (const Facets& facets : {kEven, kFalling, kGlossy})
      for (const double alpha : kLobeAlphas)
        if (glossy || facets.color0 > 0.5) list.nodes.push_back({BaseNode::Kind::kLobe, alpha, facets, widened, {}});
  list.usual = list.nodes.size();
  for (const bool widened : {false, true})
    for (const Facets& facets : kMoreFacets)
      for (const double alpha : kLobeAlphas) list.nodes.push_back({BaseNode::Kind::kLobe, alpha, facets, widened, {}});
  for (const FitSample& sample : samples)
    for (const BaseNode& node : list.nodes) list.values.push_back(node.value(sample.light, sample.view));
  return list;
}

const Offered& offered(const std::vector<FitSample>& samples, bool glossy) {
  static const Offered plain = offers_at(samples, false), all = offers_at(samples, true);
  return glossy ? all : plain;
}

bool has_broad_gloss(const paint::LobeFit& lobes) {
  return std::ranges::any_of(lobes.lobes, [](const paint::Lobe& lobe) {
    return !lobe.is_mirror() && lobe.exponent < kCoatExponent && !(lobe.gloss == color::Rgb{});
  });
}

// The problem of least squares for one paint: columns are the parts of the tints of the nodes, as the coat leaves them.
class Problem {
 public:
  Problem(const paint::Paint& paint, const CoatModel& coats, LobeGraph& graph)
      : samples_(picture_samples(*paint.lobes)),
        offers_(offered(samples_, has_broad_gloss(*paint.lobes))),
        graph_(graph) {
    const auto known = color::white_point(paint::condition_of(paint));
    white_ = known.ok() ? *known : color::Xyz{1, 1, 1};
    constexpr double kOutside = -1e-4;
    for (const FitSample& sample : samples_) {
      const color::Rgb rgb = kPi * color::rec709_from_rec2020(sample.f);
      if (std::min({rgb.x, rgb.y, rgb.z}) < kOutside) graph_.space = ColorSpace::kAcescg;
    }
    for (const FitSample& sample : samples_) {
      const CoatModel::Seen coat = coats.at(sample.light, sample.view);
      target_.push_back(into_space(graph_.space, sample.f) -
                        color::Rgb{coat.reflected, coat.reflected, coat.reflected});
      reflected_.push_back(coat.reflected);
      left_.push_back(coat.left);
    }
    for (const FitSample& sample : samples_) wanted_.push_back(color::lab_from_rgb(kPi * sample.f, white_));
  }

  // The nodes for every paint first, then more of them one by one, and where neither is near enough all at once.
  void solve() {
    attempt(kTintParts * offers_.usual);
    constexpr double kWithinReach_de00 = 1.5;  // from farther away, a second attempt does not get to kWanted_de00
    if (const double mean = mean_compared(); mean <= kWanted_de00 || mean > kWithinReach_de00) return;
    const double first = best_;
    const auto weights = x_;
    attempt(kTintParts * offers_.nodes.size());
    if (best_ >= first) x_ = weights;
  }

  void write() {
    std::vector<BaseNode> nodes = offers_.nodes;
    for (int c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < x_[c].size(); ++k) nodes[k / kTintParts].tints[k % kTintParts][c] = x_[c][k];
    constexpr double kLeast = 1e-5;
    for (const BaseNode& node : nodes)
      if (node.brightest() > kLeast) graph_.base.push_back(node);
    if (graph_.base.empty())
      graph_.base.push_back(nodes.front());  // a black one, since a surface has to have some node
  }

 private:
  using Column = std::array<std::size_t, 2>;  // channel, column

  // Weights for the first columns channel by channel, then steps of Gauss and Newton toward the least sum of Huber's
  // function of the color difference, which is its square up to kLarge_de00 and a straight line beyond: so the mean
  // counts, and a few directions that no graph can reach do not spoil the others.
  void attempt(std::size_t columns) {
    choose(columns);
    active_.clear();
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < x_[c].size(); ++k)
        if (x_[c][k] > 0) active_.push_back({c, k});
    best_ = sum();
    if (active_.empty()) return;
    descend(kSteps);
    widen();
  }

  // Weights for so many columns, each channel by itself.
  void choose(std::size_t columns) {
    add_values(columns);
    const int rows = static_cast<int>(samples_.size());
    math::Matrix m(rows, static_cast<int>(columns));
    std::array<std::vector<double>, 3> b;
    for (int row = 0; row < rows; ++row) {
      const auto i = static_cast<std::size_t>(row);
      const double weight = lightness_weight(i);
      for (std::size_t c = 0; c < columns; ++c) m(row, static_cast<int>(c)) = weight * value(i, c);
      for (int c = 0; c < 3; ++c) b[c].push_back(weight * target_[i][c]);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      x_[c] = math::nnls(m, b[c]).x;
      x_[c].resize(values_.size());
    }
  }

  // Gives a graph that is still farther away than kWanted_de00 more columns out of all that are offered: again and
  // again those that bring it nearer most quickly, until it is near enough or that helps no more.
  void widen() {
    constexpr double kLeastGain = 0.005;
    constexpr int kRounds = 12, kStepsOfRound = 2;
    for (int round = 0; round < kRounds && mean_compared() > kWanted_de00; ++round) {
      add_values(kTintParts * offers_.nodes.size());
      const double before = best_;
      add_columns();
      descend(kStepsOfRound);
      if (best_ > (1 - kLeastGain) * before) break;
    }
  }

  // The value of a column of weight 1 at a sample.
  double value(std::size_t sample, std::size_t column) const { return values_[column][sample]; }

  // The first `count` columns, as far as they are not there.
  void add_values(std::size_t count) {
    const std::size_t from = values_.size();
    if (count <= from) return;
    values_.resize(count, std::vector<double>(samples_.size()));
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const auto parts = tint_parts(samples_[i].view.z);
      for (std::size_t c = from; c < count; ++c)
        values_[c][i] = left_[i] * parts[c % kTintParts] * offers_.values[i * offers_.nodes.size() + c / kTintParts];
    }
    for (std::vector<double>& weights : x_) weights.resize(count);
  }

  // An error of this light counts by what it makes of the lightness.
  double lightness_weight(std::size_t sample) const {
    constexpr double kDarkest = 0.003;  // L* of 3: below, differences are of the instruments
    const double luminance = kPi * color::luminance(samples_[sample].f);
    return std::sqrt(samples_[sample].weight) * std::pow(std::max(luminance, kDarkest), -2.0 / 3);
  }

  // Steps of Gauss and Newton over the active columns.
  void descend(int steps) {
    for (int step = 0; step < steps; ++step) {
      const std::vector<double> found = step_from_here();
      const auto old = x_;
      double now = best_;
      for (double share = 1; share > 0.1 && now >= best_; share /= 2) {
        for (std::size_t k = 0; k < active_.size(); ++k) {
          const auto [c, column] = active_[k];
          x_[c][column] = std::lerp(old[c][column], found[k], share);
        }
        now = sum();
      }
      if (now >= best_) {
        x_ = old;
        break;
      }
      best_ = now;
    }
  }

  // The mean difference at compared_geometries(), which are the last samples.
  double mean_compared() const {
    const std::size_t count = compared_geometries().size();
    double total = 0;
    for (std::size_t i = samples_.size() - count; i < samples_.size(); ++i) total += length(apart_at(i, shown(i)));
    return total / static_cast<double>(count);
  }

  // Active columns without weight give way to the kAdded ones along which the sum falls most steeply, relative to what
  // they do to the lightness.
  void add_columns() {
    constexpr std::size_t kAdded = 8;
    std::erase_if(active_, [&](const Column& at) { return !(x_[at[0]][at[1]] > 0); });
    std::array<std::vector<double>, 3> slopes;
    std::vector<double> square;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const color::Rgb now = shown(i);
      const Vec3 apart = apart_at(i, now);
      for (int c = 0; c < 3; ++c)
        slopes[static_cast<std::size_t>(c)].push_back(huber_weight(i, apart) * dot(apart, slope_at(i, now, apart, c)));
      square.push_back(lightness_weight(i) * lightness_weight(i));
    }
    std::vector<std::pair<double, Column>> offers;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      double size = 0;
      std::array<double, 3> slope{};
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        const double v = value(i, k);
        size += square[i] * v * v;
        for (std::size_t c = 0; c < 3; ++c) slope[c] += slopes[c][i] * v;
      }
      for (std::size_t c = 0; c < 3; ++c)
        if (slope[c] < 0 && size > 0 && !(x_[c][k] > 0)) offers.push_back({slope[c] / std::sqrt(size), {c, k}});
    }
    std::ranges::sort(offers);
    for (std::size_t n = 0; n < std::min(kAdded, offers.size()); ++n) active_.push_back(offers[n].second);
  }

  // The weights of the active columns for which the differences, taken as straight in the colors from here, are least.
  std::vector<double> step_from_here() const {
    const int rows = static_cast<int>(3 * samples_.size());
    math::Matrix m(rows, static_cast<int>(active_.size()));
    std::vector<double> b(static_cast<std::size_t>(rows));
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const color::Rgb now = shown(i);
      const Vec3 apart = apart_at(i, now);
      std::array<Vec3, 3> slopes;
      for (int c = 0; c < 3; ++c) slopes[static_cast<std::size_t>(c)] = slope_at(i, now, apart, c);
      const double weight = std::sqrt(huber_weight(i, apart));
      for (int e = 0; e < 3; ++e) {
        const int row = static_cast<int>(3 * i) + e;
        double at_zero = -apart[e];
        for (std::size_t k = 0; k < active_.size(); ++k) {
          const auto [c, column] = active_[k];
          const double slope = slopes[c][e] * value(i, column);
          m(row, static_cast<int>(k)) = weight * slope;
          at_zero += slope * x_[c][column];
        }
        b[static_cast<std::size_t>(row)] = weight * at_zero;
      }
    }
    return math::nnls(m, b).x;
  }

  // The weight of the square of a difference in Huber's function.
  double huber_weight(std::size_t sample, const Vec3& apart) const {
    return samples_[sample].weight * kLarge_de00 / std::max(kLarge_de00, length(apart));
  }

  // How apart_at() changes with one channel of what the base shows.
  Vec3 slope_at(std::size_t sample, const color::Rgb& now, const Vec3& apart, int channel) const {
    color::Rgb moved = now;
    const double d = 1e-4 * (now.x + now.y + now.z) + 1e-7;
    moved[channel] += d;
    return (1 / d) * (apart_at(sample, moved) - apart);
  }

  // The color of the base of the graph, in its own space.
  color::Rgb shown(std::size_t sample) const {
    color::Rgb f;
    for (const auto& [c, k] : active_) f[static_cast<int>(c)] += x_[c][k] * value(sample, k);
    return f;
  }
  Vec3 apart_at(std::size_t sample, const color::Rgb& base) const {
    const double r = reflected_[sample];
    return color::delta_e_2000_vector(
        wanted_[sample], color::lab_from_rgb(kPi * from_space(graph_.space, base + color::Rgb{r, r, r}), white_));
  }
  double sum() const {
    double total = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double d = length(apart_at(i, shown(i)));
      total += samples_[i].weight * (d > kLarge_de00 ? kLarge_de00 * (2 * d - kLarge_de00) : d * d);
    }
    return total;
  }

  std::vector<FitSample> samples_;
  const Offered& offers_;
  LobeGraph& graph_;
  color::Xyz white_;
  std::vector<std::vector<double>> values_;  // column by column
  std::vector<double> left_, reflected_;     // of the coat
  std::vector<color::Rgb> target_;
  std::vector<color::Lab> wanted_;
  std::array<std::vector<double>, 3> x_;
  std::vector<Column> active_;  // all columns that have a weight, and some that may get one
  double best_ = 0;
};

}  // namespace

std::array<double, kTintParts> tint_parts(double cosine) {
  const double r = 1 - cosine;
  return {cosine * cosine * cosine, 3 * cosine * cosine * r, 3 * cosine * r * r, r * r * r};
}

// The facets have two roughnesses, along the viewer's plane and beside it, and the masking and the compensation have
// their geometric mean. Burley's diffuse node has a roughness of 0 here, whose F_90 is 1/2.
double BaseNode::value(const Vec3& light, const Vec3& view) const {
  if (kind == Kind::kFlat) return 1 / kPi;
  if (kind == Kind::kBurley) return (1 - schlick(light.z) / 2) * (1 - schlick(view.z) / 2) / kPi;
  const double beside = widened ? std::min(1.0, alpha / std::max(view.z, kLeastCosine)) : alpha;
  const double mean = std::sqrt(alpha * beside), plane = std::hypot(view.x, view.y);
  const Vec3 half = normalized(light + view), x = plane > 0 ? Vec3{view.x / plane, view.y / plane, 0} : Vec3{1, 0, 0};
  const double along = dot(half, x) / alpha, across = (half.y * x.x - half.x * x.y) / beside;
  const double fresnel = reflectance(facets, half_cosine(light, view));
  const double d = along * along + across * across + half.z * half.z;
  return fresnel / (kPi * alpha * beside * d * d) * ggx_masking(mean, light, view) *
         compensation(quick_facet_albedo(mean, view.z).all, fresnel);
}

color::Rgb BaseNode::tint(double cosine) const {
  const auto parts = tint_parts(cosine);
  color::Rgb sum;
  for (std::size_t k = 0; k < kTintParts; ++k) sum += parts[k] * tints[k];
  return sum;
}

// The parts are Bernstein's polynomials, whose sum is 1.
double BaseNode::brightest() const {
  double most = 0;
  for (const color::Rgb& tint : tints) most = std::max({most, tint.x, tint.y, tint.z});
  return most;
}

LobeGraph nearest_graph(const paint::Paint& paint) {
  LobeGraph graph;
  set_coats(*paint.lobes, graph);
  const CoatModel coats(graph);
  Problem problem(paint, coats, graph);
  problem.solve();
  problem.write();
  return graph;
}

Reflection seen_of(const LobeGraph& graph) {
  return [graph, coats = CoatModel(graph)](const Vec3& light, const Vec3& view) {
    const CoatModel::Seen coat = coats.at(light, view);
    color::Rgb base;
    for (const BaseNode& node : graph.base) base += node.value(light, view) * node.tint(view.z);
    return from_space(graph.space, coat.left * base + color::Rgb{coat.reflected, coat.reflected, coat.reflected});
  };
}

}  // namespace goniochrome::materials
