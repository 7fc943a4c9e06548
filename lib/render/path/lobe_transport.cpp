#include "render/path/lobe_transport.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/effects.h"
#include "render/internal/seen.h"
#include "render/internal/wear.h"
#include "render/path/rounds.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

constexpr int kFirstBatches = 2, kMostAtOnce = 512;
constexpr int kDirections = kFan;  // of a batch
// Later rounds draw as few sequences as tell a variance, each of as many directions as it takes: the longer a sequence,
// the more evenly it covers the hemisphere.
constexpr int kSequences = 8;
// Directions at a probe; scaling is judged by ratios, in which the noise of a probe stands on both sides.
constexpr int kProbeSequences = 4, kProbeDirections = 256;

class Tracing {
 public:
  Tracing(const Transport& transport, const Gbuffer& surface, const LobeColumns& columns, const WornPaints& worn,
          const OpenLight* open, const LobeTransportRequest& request)
      : transport_(transport), surface_(surface), open_(open), request_(request), deadline_(request.time_limit_s) {
    LobeTransport& t = result_.transport;
    const Gbuffer& g = surface;
    t.width = g.width, t.height = g.height, t.columns = columns, t.worn = worn;
    t.white_luminance = request.white_luminance, t.bounces = request.bounces, t.samples = request.pixel_samples;
    for (const auto& [dx, dy] : sample_shifts(request.pixel_samples)) {
      if (request.pixel_samples == 1) break;
      samples_.push_back(visible_surface(transport.rays(), g.rays.shifted(dx, dy), g.width, g.height));
    }
    by_pixel_ = PixelPoints(g.width, g.height);
    for (std::size_t i = 0; i < g.triangles.size(); ++i) {
      if (g.triangles[i] == kNoTriangle) continue;
      by_pixel_.add(static_cast<int>(i) % g.width, static_cast<int>(i) / g.width);
      t.places.push_back(static_cast<std::uint32_t>(i));
      t.part.push_back(std::abs(static_cast<int>(g.data[4 * i + 3])) - 1);
    }
    const std::size_t points = t.places.size();
    t.direct.assign(points * t.floats(), 0), t.bounced.assign(points * t.floats(), 0);
    t.classes.assign(points * worn.groups.classes() * 3, 0);
    t.noise_de00.assign(points, 0);
    if (open != nullptr) open_light_.assign(points * t.floats(), 0);
    variance_.assign(points * (columns.count() + 1), 0), shown_noise_.assign(points, 0);
    batches_.assign(points, 0), freedom_.assign(points, 0), needed_.assign(points, 0);
    for (std::size_t k = 0; k < columns.count(); ++k) nominal_.push_back(nominal_weight(columns, k));
    fewest_ = request.pixel_samples > 1 ? 2 * request.pixel_samples : kFirstBatches;
  }

  TracedLobes trace() {
    std::vector<int> more(batches_.size(), fewest_);
    while (true) {
      const double before = drawn();
      pace_.start();
      sample(more);
      pace_.end(drawn() - before);
      judge();
      if (request_.progress) request_.progress(result_.error_de00(), clock_.elapsed_s());
      result_.reached = result_.error_de00() <= request_.tolerance_de00;
      if (result_.reached || deadline_.passed() || !plan(more) || !cut(more)) break;
    }
    const double count = std::max<double>(1, static_cast<double>(batches_.size()));
    for (std::size_t i = 0; i < batches_.size(); ++i) {
      result_.noise_mean_de00 += result_.transport.noise_de00[i] / count;
      result_.samples_mean += kDirections * batches_[i] / count;
    }
    result_.free_share = static_cast<double>(std::ranges::count(batches_, 0)) / count;
    if (request_.bounces > 0) probe();
    result_.time_s = clock_.elapsed_s();
    return std::move(result_);
  }

 private:
  double drawn() const { return std::accumulate(batches_.begin(), batches_.end(), 0.0); }

  // No more than there is time for; whether any.
  bool cut(std::vector<int>& more) const {
    return cut_round(pace_.left(), more, [this](int batches) { return batches / fewest_ * fewest_; });
  }

  void sample(const std::vector<int>& more) {
    std::vector<std::uint32_t> wanted;
    for (std::size_t i = 0; i < more.size(); ++i)
      if (more[i] > 0) wanted.push_back(static_cast<std::uint32_t>(i));
    // The first round is whole.
    draw_round(wanted, round_ > 0 ? &deadline_ : nullptr, [&](std::size_t i) { sample(i, more[i]); });
    ++round_;
  }

  // The point in the center of a pixel.
  LobePoint point_at(std::size_t i) const {
    const LobeTransport& t = result_.transport;
    const int x = static_cast<int>(t.places[i]) % t.width, y = static_cast<int>(t.places[i]) / t.width;
    return {transport_,
            t.columns,
            t.worn.groups,
            request_.bounces,
            spot_at(transport_.rays(), surface_, x, y),
            rays::float3(surface_.to_viewer(x, y))};
  }

  // The samples of a pixel that a point is the mean of.
  std::vector<const Gbuffer*> samples_of(std::size_t i) const {
    const std::uint32_t place = result_.transport.places[i];
    const float part = surface_.data[4 * static_cast<std::size_t>(place) + 3];
    std::vector<const Gbuffer*> shown;
    for (const Gbuffer& sample : samples_)
      if (sample.data[4 * static_cast<std::size_t>(place) + 3] == part) shown.push_back(&sample);
    if (shown.empty()) shown.push_back(&surface_);
    return shown;
  }

  void probe() {
    LobeTransport& t = result_.transport;
    const std::size_t points = t.places.size(),
                      count = std::min<std::size_t>(points, static_cast<std::size_t>(request_.probes));
    std::vector<BounceProbe> probes(count);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t number = (2 * i + 1) * points / (2 * count);
        const LobePoint point = point_at(number);
        if (point.open()) continue;
        const LobePoint::Pairs pairs =
            point.pairs(kProbeSequences, kProbeDirections, mixed(request_.seed, 0xB0BEU + i));
        probes[i].point = static_cast<std::uint32_t>(number);
        const auto keep = [](const std::vector<color::Rgb>& from, std::vector<float>& to) {
          for (const color::Rgb& light : from)
            for (int c = 0; c < 3; ++c) to.push_back(static_cast<float>(light[c]));
        };
        keep(pairs.once, probes[i].once), keep(pairs.deeper, probes[i].deeper);
      }
    });
    t.probed = static_cast<int>(count);
    for (BounceProbe& probe : probes) {
      const auto lit = [](float value) { return value != 0; };
      if (std::ranges::any_of(probe.once, lit) || std::ranges::any_of(probe.deeper, lit))
        t.probes.push_back(std::move(probe));
    }
  }

  // Rounds are independent estimates, and count by their batches.
  void sample(std::size_t i, int batches) {
    LobeTransport& t = result_.transport;
    const std::uint32_t place = t.places[i];
    const int x = static_cast<int>(place) % t.width, y = static_cast<int>(place) / t.width;
    const int part = t.part[i];
    std::vector<LobePoint> points;
    std::vector<OpenView> views;
    for (const Gbuffer* sample : samples_of(i)) {
      const rays::Spot spot = spot_at(transport_.rays(), *sample, x, y);
      const Vec3 to_viewer = sample->to_viewer(x, y);
      views.push_back({rays::vec3(spot.shading), to_viewer});
      points.emplace_back(transport_, t.columns, t.worn.groups, request_.bounces, spot, rays::float3(to_viewer));
    }
    // Looked up or summed in the first round, and kept for the others; what mirrors see is not.
    std::vector<color::Rgb> open(t.columns.count()), mirrors(points.size());
    if (open_ != nullptr && !t.worn.is_projected(part)) {
      float* kept = &open_light_[i * t.floats()];
      if (round_ == 0) {
        open_->mean(views, part, open.data());
        points.front().add_open_floor(open.data());  // which hardly differs between samples of one part
        for (const color::Rgb& light : open)
          for (int c = 0; c < 3; ++c) *kept++ = static_cast<float>(light[c]);
      } else {
        for (color::Rgb& light : open)
          for (int c = 0; c < 3; ++c) light[c] = *kept++;
      }
      mirrors = open_->mirrors(views, part);
    }
    const int sequences = std::min(batches, std::max(kSequences, fewest_));
    int of_each = 1;  // batches
    while (of_each * sequences < batches) of_each *= 2;
    const LobeEstimate estimate = LobePoint::estimate(
        points, open_ != nullptr ? open.data() : nullptr, mirrors.data(), sequences, of_each * kDirections,
        mixed(mixed(request_.seed, i), static_cast<std::uint64_t>(batches_[i])), worn_by(part).data());
    const double before = batches_[i], added = estimate.sequences * of_each;
    const double share = added > 0 ? added / (before + added) : 1;
    const auto mix = [share](float& into, double value) {
      into = static_cast<float>((1 - share) * into + share * value);
    };
    for (std::size_t k = 0; k < t.columns.count(); ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = i * t.floats() + 3 * k + c;
        mix(t.direct[at], estimate.direct[k][static_cast<int>(c)]);
        mix(t.bounced[at], estimate.bounced[k][static_cast<int>(c)]);
      }
    for (std::size_t k = 0; k < estimate.classes.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c)
        mix(t.classes[(i * estimate.classes.size() + k) * 3 + c], estimate.classes[k][static_cast<int>(c)]);
    batches_[i] += estimate.sequences * of_each;
    freedom_[i] += estimate.freedom + (before > 0 ? 1 : 0);
    // The variance of the mean of both rounds, kept as that of one batch.
    for (std::size_t k = 0; added > 0 && k <= t.columns.count(); ++k) {
      float& variance = variance_[i * (t.columns.count() + 1) + k];
      const double old = before > 0 ? (1 - share) * (1 - share) * variance / before : 0,
                   now = share * share *
                         (k < t.columns.count() ? nominal_variance(i, k, estimate.covariance[k])
                                                : shown_variance(i, estimate.shown)) /
                         estimate.sequences;
      variance = static_cast<float>((before + added) * (old + now));
    }
  }

  // dE00^2
  double nominal_variance(std::size_t i, std::size_t k, Covariance covariance) const {
    const LobeTransport& t = result_.transport;
    const double weight = t.worn.is_projected(t.part[i]) ? 1 : nominal_[k];
    color::Rgb shown = weight * t.light(i, k);
    if (t.columns.is_gloss(k)) shown += (kNominalGray / kPi) * t.light(i, 0);
    for (double& element : covariance) element *= weight * weight;
    const double noise = noise_de00(shown, covariance, request_.white_luminance);
    return noise * noise;
  }

  // dE00^2, in the paint that is worn there
  double shown_variance(std::size_t i, const Covariance& covariance) const {
    const LobeTransport& t = result_.transport;
    const std::vector<color::Rgb>& weights = worn_by(t.part[i]);
    color::Rgb shown;
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (int c = 0; c < 3; ++c) shown[c] += weights[k][c] * t.light(i, k)[c];
    const double noise = noise_de00(shown, covariance, request_.white_luminance);
    return noise * noise;
  }

  const std::vector<color::Rgb>& worn_by(int part) const {
    const WornPaints& worn = result_.transport.worn;
    return worn.weights[static_cast<std::size_t>(worn.groups.of_part[static_cast<std::size_t>(part)])];
  }

  void judge() {
    const std::size_t points = batches_.size();
    parallel_for(points, 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) judge(i);
    });
    result_.noise_p95_de00 = worse_percentile(result_.transport.noise_de00);
    result_.shown_p95_de00 =
        worse(shown_noise_, [](const std::vector<double>& noise) { return largest_errors(noise); });
  }

  // The larger of the 95th percentiles over the mesh and over a floor that shows the environment.
  template <class Value>
  double worse_percentile(const std::vector<Value>& of) const {
    return worse(of, [](const std::vector<double>& values) { return percentile_95(values); });
  }
  template <class Value, class Figure>
  double worse(const std::vector<Value>& of, const Figure& figure) const {
    const LobeTransport& t = result_.transport;
    std::vector<double> mesh, floor;
    for (std::size_t i = 0; i < of.size(); ++i) (t.worn.is_projected(t.part[i]) ? floor : mesh).push_back(of[i]);
    return std::max(figure(mesh), figure(floor));
  }

  // The neighbors alone decide the number of samples of a point, so that no point stops where its own sums happen to be
  // bright.
  void judge(std::size_t i) {
    LobeTransport& t = result_.transport;
    t.noise_de00[i] = shown_noise_[i] = 0, needed_[i] = 0;
    const int n = batches_[i];
    if (n < 2) return;
    const std::size_t columns = t.columns.count(), kinds = columns + 1;
    const int x = static_cast<int>(t.places[i]) % t.width, y = static_cast<int>(t.places[i]) / t.width;
    double around[2 * kMostTracedLobes + 3] = {};
    int count = 0;
    by_pixel_.visit_around(x, y, [&](std::size_t other) {
      if (other == i || batches_[other] < 2) return;
      ++count;
      for (std::size_t k = 0; k < kinds; ++k) around[k] += variance_[other * kinds + k];
    });
    const double freedom = freedom_[i];
    double worst = 0, needed = 0;
    for (std::size_t k = 0; k < kinds; ++k) {
      const double own = variance_[i * kinds + k], found = smoothed_variance(own, freedom, around[k], count) / n;
      const double expected = count > 0 ? around[k] / count : own;
      if (k == columns) {
        shown_noise_[i] = static_cast<float>(std::sqrt(found));
        needed = std::max(needed, kDeviations * kDeviations * expected);
        continue;
      }
      worst = std::max(worst, found);
      needed = std::max(needed, expected / (TracedLobes::kColumnTolerances * TracedLobes::kColumnTolerances));
    }
    t.noise_de00[i] = static_cast<float>(std::sqrt(worst));
    needed_[i] = needed / (request_.tolerance_de00 * request_.tolerance_de00);
  }

  // Plans the batches of the next round, and returns true if there are any.
  bool plan(std::vector<int>& more) const {
    RoundLimits limits;
    limits.of_point = request_.most_batches, limits.at_once = kMostAtOnce;
    limits.typical = worse_percentile(needed_);
    limits.lacking = result_.error_de00() / request_.tolerance_de00;
    const bool any = plan_round(
        limits, [this](std::size_t i) { return needed_[i]; }, [this](std::size_t i) { return batches_[i]; }, more);
    for (int& batches : more) batches = (batches + fewest_ - 1) / fewest_ * fewest_;
    return any;
  }

  const Transport& transport_;
  const Gbuffer& surface_;
  const OpenLight* open_;
  const LobeTransportRequest& request_;
  Deadline deadline_;
  Pace pace_{deadline_};
  Stopwatch clock_;
  TracedLobes result_;
  std::vector<Gbuffer> samples_;  // of the pixels; none: their centers
  PixelPoints by_pixel_;
  std::vector<float> open_light_;   // point, column, channel
  std::vector<float> variance_;     // of one batch: point, column, and the paint that is worn last; dE00^2
  std::vector<float> shown_noise_;  // of each point, in that paint
  std::vector<int> batches_, freedom_;
  int fewest_ = kFirstBatches;  // of a round; of several samples each gets two sequences
  std::vector<double> needed_, nominal_;
  int round_ = 0;
};

}  // namespace

Result<WornPaints> worn_paints(const LobeColumns& columns, const PathScene& path) {
  const Scene& scene = *path.scene;
  WornPaints worn;
  std::vector<std::size_t> first;  // part of each group
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    if (scene.layer != nullptr) {
      const PartSurface& surface = scene.layer->surface(static_cast<int>(part));
      if (surface.texture != nullptr || surface.color_map != nullptr)
        return usage_error("part {} wears a {}, whose light is no sum of the lobes of a paint: trace without it",
                           scene.mesh->parts[part].name, surface.texture != nullptr ? "texture" : "color map");
    }
    int group = scene.paints.size() <= kMostOwnGroups ? static_cast<int>(first.size()) : 0;
    while (group < static_cast<int>(first.size()) && !same_wear(scene, first[static_cast<std::size_t>(group)], part))
      ++group;
    if (group == static_cast<int>(first.size())) {
      const double gloss_deg = part < scene.gloss_deg.size() ? scene.gloss_deg[part] : brdf::kGlossIncidence_deg;
      GONIO_ASSIGN(auto weights,
                   column_weights(columns, scene.paints[part].diffuse, scene.paints[part].lobes, gloss_deg));
      worn.weights.push_back(std::move(weights));
      first.push_back(part);
    }
    worn.groups.of_part.push_back(group);
    worn.emission.push_back(part < path.emission.size() ? path.emission[part] : color::Rgb{});
    worn.coats.push_back(scene.paints[part].coat_index);
    worn.brushed.push_back(part < scene.anisotropy.size() ? scene.anisotropy[part] : paint::Anisotropy{});
  }
  if (path.ground) {
    worn.floor_is_projected = path.ground->kind == Ground::Kind::kShadow;
    GONIO_ASSIGN(auto weights, column_weights(columns, path.ground->paint.diffuse, path.ground->paint.lobes,
                                              brdf::kGlossIncidence_deg));
    if (worn.floor_is_projected) {
      weights.assign(columns.count(), color::Rgb{});
      weights[LobeColumns::diffuse()] = {1, 1, 1};
    }
    worn.groups.of_part.push_back(static_cast<int>(first.size()));
    worn.coats.push_back(worn.floor_is_projected ? paint::kNoCoat : path.ground->paint.coat_index);
    worn.has_floor = true;
    worn.weights.push_back(std::move(weights));
  }
  worn.groups.count = static_cast<int>(worn.weights.size());
  return worn;
}

TracedLobes traced_lobes(const Transport& transport, const Gbuffer& surface, const LobeColumns& columns,
                         const WornPaints& worn, const OpenLight* open, const LobeTransportRequest& request) {
  return Tracing(transport, surface, columns, worn, open, request).trace();
}

}  // namespace goniochrome::render
