#include "render/path/lobe_transport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/effects.h"
#include "render/internal/seen.h"
#include "render/internal/wear.h"
#include "render/path/noise.h"
#include "render/path/pixel_pieces.h"
#include "render/path/reconstruction.h"
#include "render/path/rounds.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

constexpr int kDirections = kFan;  // of a batch
// Two sequences of one batch tell how light scatters. Later rounds draw as few sequences as start from several samples
// of a pixel, each of as many directions as it takes: the longer a sequence, the more evenly it covers the hemisphere.
constexpr int kFirstBatches = 2, kSequences = 8, kMostAtOnce = 512;
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
    for (std::size_t i = 0; i < g.triangles.size(); ++i) {
      if (g.triangles[i] == kNoTriangle) continue;
      t.places.push_back(static_cast<std::uint32_t>(i));
      t.part.push_back(std::abs(static_cast<int>(g.data[4 * i + 3])) - 1);
    }
    const std::size_t points = t.places.size();
    t.make_room();
    t.noise_de00.assign(points, 0);
    exact_.assign(points, 0), batches_.assign(points, 0), slot_.assign(points, kNotSampled);
    smooth_.resize(columns.count());
    of_slot_ = 18 * columns.count() + 3 * worn.groups.classes();
    const color::ReflectionOperator reflection = transport.reflection();
    for (const std::vector<color::Rgb>& weights : worn.weights) {
      matrices_.emplace_back();
      for (const color::Rgb& weight : weights) matrices_.back().push_back(color::reflection_matrix(reflection, weight));
    }
  }

  TracedLobes trace() {
    look();
    std::vector<int> more = first_batches();
    bool is_first = true;
    while (true) {
      const double before = drawn();
      pace_.start();
      sample(more, is_first);
      pace_.end(drawn() - before);
      is_first = false;  // which no time limit cuts
      const Stopwatch judging;
      judge();
      if (request_.progress) request_.progress(result_.error_p95_de00, clock_.elapsed_s());
      result_.reached = result_.error_p95_de00 <= request_.tolerance_de00;
      const double columns_s = kColumnCost * judging.elapsed_s() * static_cast<double>(smooth_.size());
      if (result_.reached || !plan(more) || !cut(columns_s, more)) break;
    }
    smooth_columns();
    add_smooth();
    const double count = std::max<double>(1, static_cast<double>(batches_.size()));
    for (std::size_t i = 0; i < batches_.size(); ++i) {
      result_.noise_mean_de00 += result_.transport.noise_de00[i] / count;
      result_.samples_mean += kDirections * batches_[i] / count;
    }
    result_.free_share = static_cast<double>(std::ranges::count(exact_, 1)) / count;
    if (request_.bounces > 0) probe();
    result_.time_s = clock_.elapsed_s();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kNotSampled = ~0U;
  // The time to smooth a column, in that to judge a picture of the paints that are worn.
  static constexpr double kColumnCost = 1.5;

  double drawn() const { return std::accumulate(batches_.begin(), batches_.end(), 0.0); }
  static int whole(int batches) { return batches / 2 * 2; }

  // No more than there is time for; whether any.
  bool cut(double reserved_s, std::vector<int>& more) const { return cut_round(pace_.left(reserved_s), more, whole); }

  // Finds what needs no samples, at all points.
  void look() {
    const std::size_t points = batches_.size();
    draw_round(all_points(), nullptr, [&](std::size_t i) { look(i); });
    for (std::size_t i = 0; i < points; ++i)
      if (exact_[i] == 0 || !is_projected(i)) kept_.push_back(static_cast<std::uint32_t>(i));
    int left = surface_.width;
    for (const std::uint32_t i : kept_) left = std::min(left, pixel(i)[0]);
    shown_.resize(kept_.size());
    each_kept([&](std::size_t n, std::size_t i) {
      const auto [x, y] = pixel(i);
      const rays::Spot spot = spot_at(transport_.rays(), surface_, x, y);
      shown_[n] = {x - left, y - pixel(kept_.front())[1], {spot.part, spot.shading, spot.position}};
    });
  }
  std::vector<std::uint32_t> all_points() const {
    std::vector<std::uint32_t> all(batches_.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }
  std::array<int, 2> pixel(std::size_t i) const { return result_.transport.pixel(i); }

  // Light on a surface does not change with the resolution: points are left out that their neighbors tell.
  std::vector<int> first_batches() const {
    std::vector<const Gbuffer*> samples;
    for (const Gbuffer& sample : samples_) samples.push_back(&sample);
    if (samples.empty()) samples.push_back(&surface_);
    const int spacing = filters() == Filters::kNone ? 1 : first_spacing(kept_.size(), kFirstPoints);
    const PixelFlags told = told_by_corners(surface_, even_pixels(samples, kSamePiece), spacing);
    std::vector<int> more(batches_.size(), 0);
    for (const std::uint32_t i : kept_)
      if (exact_[i] == 0 && (spacing == 1 || told[result_.transport.places[i]] == 0)) more[i] = kFirstBatches;
    return more;
  }

  void sample(const std::vector<int>& more, bool is_needed) {
    std::vector<std::uint32_t> wanted;
    std::uint32_t slots = static_cast<std::uint32_t>(sampled_.size() / of_slot_);
    for (const std::uint32_t i : kept_) {
      if (more[i] == 0) continue;
      wanted.push_back(i);
      if (slot_[i] == kNotSampled) slot_[i] = slots++;
    }
    sampled_.resize(slots * of_slot_, 0.0F);
    draw_round(wanted, is_needed ? nullptr : &deadline_, [&](std::size_t i) { sample(i, more[i]); });
  }

  // The point in the center of a pixel.
  LobePoint point_at(std::size_t i) const {
    const LobeTransport& t = result_.transport;
    const auto [x, y] = pixel(i);
    return {transport_,
            t.columns,
            t.worn.groups,
            request_.bounces,
            spot_at(transport_.rays(), surface_, x, y),
            rays::float3(surface_.to_viewer(x, y))};
  }

  // The samples of a pixel that a point is the mean of.
  struct Seen {
    std::vector<LobePoint> points;
    std::vector<OpenView> views;
  };
  Seen seen_at(std::size_t i) const {
    const LobeTransport& t = result_.transport;
    const auto [x, y] = pixel(i);
    Seen seen;
    for (const Gbuffer* sample : samples_of(i)) {
      const Vec3 to_viewer = sample->to_viewer(x, y);
      const rays::Spot spot = spot_at(transport_.rays(), *sample, x, y);
      seen.views.push_back({rays::vec3(spot.shading), to_viewer});
      seen.points.emplace_back(transport_, t.columns, t.worn.groups, request_.bounces, spot, rays::float3(to_viewer));
    }
    return seen;
  }
  // The samples of its pixel that show the part of a point from its side.
  std::vector<const Gbuffer*> samples_of(std::size_t i) const {
    const std::size_t place = 4 * static_cast<std::size_t>(result_.transport.places[i]) + 3;
    std::vector<const Gbuffer*> shown;
    for (const Gbuffer& sample : samples_)
      if (sample.data[place] == surface_.data[place]) shown.push_back(&sample);
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
        probes[i].once.resize(3 * pairs.once.size()), probes[i].deeper.resize(3 * pairs.deeper.size());
        put(pairs.once, probes[i].once.data()), put(pairs.deeper, probes[i].deeper.data());
      }
    });
    t.probed = static_cast<int>(count);
    for (BounceProbe& probe : probes) {
      const auto lit = [](float value) { return value != 0; };
      if (std::ranges::any_of(probe.once, lit) || std::ranges::any_of(probe.deeper, lit))
        t.probes.push_back(std::move(probe));
    }
  }

  static void put(const std::vector<color::Rgb>& from, float* to) {
    for (const color::Rgb& light : from)
      for (int c = 0; c < 3; ++c) *to++ = static_cast<float>(light[c]);
  }

  bool is_projected(std::size_t i) const { return result_.transport.worn.is_projected(result_.transport.part[i]); }
  bool has_open_light(std::size_t i) const { return open_ != nullptr && !is_projected(i); }

  // Adds to open light that is looked up what takes long and changes slowly over a surface: what maps err by, and the
  // floor, which hardly differs between samples of one part.
  void complete(std::size_t i, const Seen& seen, std::vector<color::Rgb>& open) const {
    open_->add_sums(seen.views.front(), result_.transport.part[i], open.data());
    seen.points.front().add_open_floor(open.data());
  }

  // A floor whose ground is shaded shows light that needs no samples.
  void look_at_floor(std::size_t i) {
    const std::vector<const Gbuffer*> samples = samples_of(i);
    const auto [x, y] = pixel(i);
    LightShares sum;
    for (const Gbuffer* sample : samples) sum += transport_.shaded_ground(spot_at(transport_.rays(), *sample, x, y));
    const LightShares light = (1.0 / static_cast<double>(samples.size())) * sum;
    add_light(i, LobeColumns::diffuse(), light.direct, light.into_lobes + light.into_diffuse);
    exact_[i] = 1;
  }

  void look(std::size_t i) {
    if (is_projected(i) && transport_.shaded() != nullptr) return look_at_floor(i);
    LobeTransport& t = result_.transport;
    const Seen seen = seen_at(i);
    std::vector<color::Rgb> open(t.columns.count()), mirrors;
    if (has_open_light(i)) mirrors = open_->mean(seen.views, t.part[i], open.data());
    exact_[i] = LobePoint::is_known(seen.points, open_ != nullptr) ? 1 : 0;
    if (has_open_light(i) && exact_[i] != 0) complete(i, seen, open);
    LobeEstimate known =
        LobePoint::known(seen.points, mirrors.empty() ? nullptr : mirrors.data(), worn_by(t.part[i]).data());
    for (std::size_t k = 0; k < t.columns.mirror(); ++k) known.direct[k] += open[k];
    for (std::size_t k = 0; k < t.columns.count(); ++k) add_light(i, k, known.direct[k], known.bounced[k]);
    for (std::size_t k = 0; k < t.classes.size() && t.has_lobes(i); ++k) add_class(i, k, known.classes[k]);
  }
  void add_light(std::size_t i, std::size_t k, const color::Rgb& direct, const color::Rgb& bounced) {
    LobeTransport& t = result_.transport;
    const auto at = t.at(i, k);
    for (std::size_t c = 0; at && c < 3; ++c) {
      t.direct[k][*at + c] += static_cast<float>(direct[static_cast<int>(c)]);
      if (t.bounces > 0) t.bounced[k][*at + c] += static_cast<float>(bounced[static_cast<int>(c)]);
    }
  }
  void add_class(std::size_t i, std::size_t k, const color::Rgb& light) {
    float* to = &result_.transport.classes[k][std::size_t{3} * result_.transport.with_lobes[i]];
    for (int c = 0; c < 3; ++c) to[c] += static_cast<float>(light[c]);
  }

  // The open light of a point that is sampled is kept, and what completed it.
  std::vector<color::Rgb> open_light(std::size_t i, const Seen& seen) {
    const LobeTransport& t = result_.transport;
    const std::size_t count = t.columns.count();
    float* kept = &sampled_[slot_[i] * of_slot_];
    std::vector<color::Rgb> open(count);
    if (batches_[i] > 0) {
      for (color::Rgb& light : open)
        for (int c = 0; c < 3; ++c) light[c] = *kept++;
      return open;
    }
    open_->mean(seen.views, t.part[i], open.data());
    std::vector<color::Rgb> more = open;
    complete(i, seen, open);
    for (std::size_t k = 0; k < count; ++k) more[k] = k < t.columns.mirror() ? open[k] - more[k] : color::Rgb{};
    put(open, kept), put(more, kept + 3 * count);
    return open;
  }

  // Rounds are independent estimates, and count by their batches.
  void sample(std::size_t i, int batches) {
    const LobeTransport& t = result_.transport;
    const Seen seen = seen_at(i);
    std::vector<color::Rgb> open;
    if (has_open_light(i)) open = open_light(i, seen);
    const int sequences = std::min(batches, kSequences);
    int of_each = 1;  // batches
    while (of_each * sequences < batches) of_each *= 2;
    const std::array<LobeEstimate, 2> found = LobePoint::sampled(
        seen.points, open.empty() ? nullptr : open.data(), sequences, of_each * kDirections,
        mixed(mixed(request_.seed, i), static_cast<std::uint64_t>(batches_[i])), worn_by(t.part[i]).data());
    const int added = sequences * of_each;
    const double share = static_cast<double>(added) / (batches_[i] + added);
    float* to = &sampled_[slot_[i] * of_slot_ + 6 * t.columns.count()];
    const auto mix = [&](const color::Rgb& light) {
      for (int c = 0; c < 3; ++c, ++to) *to = static_cast<float>((1 - share) * *to + share * light[c]);
    };
    for (const LobeEstimate& half : found)
      for (std::size_t k = 0; k < t.columns.count(); ++k) mix(half.direct[k]), mix(half.bounced[k]);
    for (std::size_t k = 0; k < t.worn.groups.classes(); ++k) mix(0.5 * (found[0].classes[k] + found[1].classes[k]));
    batches_[i] += added;
  }

  // The light of a column that one half of the samples tells.
  struct ColumnLight {
    color::Rgb direct, bounced;
    color::Rgb sum() const { return direct + bounced; }
  };
  ColumnLight sampled(std::size_t i, std::size_t half, std::size_t column) const {
    if (slot_[i] == kNotSampled) return exact_[i] != 0 ? ColumnLight{} : ColumnLight{kUnknown, kUnknown};
    const std::size_t floats = 3 * smooth_.size();
    const float *more = &sampled_[slot_[i] * of_slot_ + floats + 3 * column],
                *f = &sampled_[slot_[i] * of_slot_ + (2 + 2 * half) * floats + 6 * column];
    return {{more[0] + f[0], more[1] + f[1], more[2] + f[2]}, {f[3], f[4], f[5]}};
  }

  const std::vector<color::Rgb>& worn_by(int part) const {
    const WornPaints& worn = result_.transport.worn;
    return worn.weights[static_cast<std::size_t>(group_of(part))];
  }
  int group_of(int part) const { return result_.transport.worn.groups.of_part[static_cast<std::size_t>(part)]; }

  template <class Visit>
  void each_kept(const Visit& visit) const {
    parallel_each(kept_.size(), 1024, [&](std::size_t n) { visit(n, std::size_t{kept_[n]}); });
  }

  // Judges the light of the paints that are worn. Points of which no neighbor tells get samples first.
  void judge() {
    Reconstruction found = shown_in_paints();
    std::vector<int> gaps(batches_.size(), 0);
    for (std::size_t n = 0; n < kept_.size(); ++n)
      if (exact_[kept_[n]] == 0 && std::isinf(found.error_de00[n])) gaps[kept_[n]] = kFirstBatches;
    if (std::ranges::any_of(gaps, [](int batches) { return batches > 0; }))
      sample(gaps, true), found = shown_in_paints();
    std::vector<double> errors(batches_.size(), 0);
    needed_.assign(batches_.size(), 0);
    for (std::size_t n = 0; n < kept_.size(); ++n) {
      const std::size_t i = kept_[n];
      if (exact_[i] != 0) continue;
      errors[i] = found.error_de00[n];
      needed_[i] = needed_samples(counted(i), errors[i], found.spike_de00[n], request_.tolerance_de00);
    }
    shares_ = std::move(found.shares);
    result_.error_p95_de00 = worse([&](std::size_t i) { return errors[i]; },
                                   [](const std::vector<double>& of) { return largest_errors(of); });
  }
  int counted(std::size_t i) const { return slot_[i] == kNotSampled ? kFirstBatches : batches_[i]; }

  Reconstruction shown_in_paints() const {
    const LobeTransport& t = result_.transport;
    std::vector<Halves> halves(kept_.size());
    std::vector<color::Rgb> beside(kept_.size());
    each_kept([&](std::size_t n, std::size_t i) {
      const std::vector<color::Matrix3>& matrices = matrices_[static_cast<std::size_t>(group_of(t.part[i]))];
      for (std::size_t k = 0; k < matrices.size(); ++k) {
        beside[n] += color::product(matrices[k], t.light(i, k));
        for (std::size_t half = 0; half < 2; ++half)
          halves[n][half] += color::product(matrices[k], sampled(i, half, k).sum());
      }
    });
    return reconstruction(shown_, halves, beside, request_.white_luminance, sample_counts(), filters());
  }
  std::vector<float> sample_counts() const {
    std::vector<float> counts(kept_.size());
    each_kept([&](std::size_t n, std::size_t i) { counts[n] = static_cast<float>(batches_[i]); });
    return counts;
  }
  // Rays alone are a reference, and are shown as they were sampled.
  Filters filters() const { return open_ != nullptr ? Filters::kChosen : Filters::kNone; }

  // The light of a column that samples tell at the points that are kept, smoothed.
  struct SmoothColumn {
    std::vector<color::Rgb> sum, bounced;
  };

  // Smooths the samples of every column as the gray paint of nominal_weight() shows them, and tells their errors.
  void smooth_columns() {
    LobeTransport& t = result_.transport;
    std::vector<FilterShares> before;
    for (std::size_t k = 0; k < smooth_.size(); ++k) {
      Reconstruction found = in_gray_paint(k);
      each_kept([&](std::size_t n, std::size_t i) {
        if (exact_[i] == 0) t.noise_de00[i] = std::max(t.noise_de00[i], found.error_de00[n]);
        found.light[n] = (1 / nominal(i, k)) * found.light[n];
      });
      smooth_[k].sum = std::move(found.light);
      if (k % 2 == 1) smooth_bounced(k, before, found.shares);
      before = std::move(found.shares);
    }
    result_.noise_p95_de00 = worse([&](std::size_t i) { return t.noise_de00[i]; },
                                   [](std::vector<double> noise) { return percentile_95(std::move(noise)); });
  }

  // A figure of the mesh or of the floor, whichever is larger: a large floor that is easy to draw hides no mesh.
  template <class Value, class Figure>
  double worse(const Value& value, const Figure& figure) const {
    std::vector<double> mesh, floor;
    for (std::size_t i = 0; i < batches_.size(); ++i) (is_projected(i) ? floor : mesh).push_back(value(i));
    return std::max(figure(std::move(mesh)), figure(std::move(floor)));
  }
  double nominal(std::size_t i, std::size_t k) const {
    const LobeTransport& t = result_.transport;
    return is_projected(i) ? 1 : nominal_weight(t.columns, k);
  }

  Reconstruction in_gray_paint(std::size_t k) const {
    const LobeTransport& t = result_.transport;
    std::vector<Halves> halves(kept_.size());
    std::vector<color::Rgb> beside(kept_.size());
    each_kept([&](std::size_t n, std::size_t i) {
      const double weight = nominal(i, k);
      beside[n] = weight * t.light(i, k);
      if (t.columns.is_gloss(k)) {
        const color::Rgb& diffuse = smooth_[LobeColumns::diffuse()].sum[n];
        beside[n] += (kNominalGray / kPi) * (t.light(i, LobeColumns::diffuse()) + diffuse);
      }
      for (std::size_t half = 0; half < 2; ++half) halves[n][half] = weight * sampled(i, half, k).sum();
    });
    return reconstruction(shown_, halves, beside, request_.white_luminance, sample_counts(), filters());
  }

  // Smooths the bounced light of a column and of the one before it, by the filters of both.
  void smooth_bounced(std::size_t k, const std::vector<FilterShares>& before, const std::vector<FilterShares>& own) {
    std::vector<Halves> bounced(kept_.size());
    each_kept([&](std::size_t n, std::size_t i) {
      for (std::size_t which = 0; which < 2; ++which)
        bounced[n][which] = 0.5 * (sampled(i, 0, k - 1 + which).bounced + sampled(i, 1, k - 1 + which).bounced);
    });
    const std::vector<Halves> smooth = smoothed(shown_, bounced, {&before, &own});
    for (std::size_t which = 0; which < 2; ++which) {
      std::vector<color::Rgb>& to = smooth_[k - 1 + which].bounced;
      for (const Halves& light : smooth) to.push_back(light[which]);
    }
  }

  void add_smooth() {
    LobeTransport& t = result_.transport;
    for (std::size_t k = 0; k < smooth_.size(); ++k)
      each_kept([&](std::size_t n, std::size_t i) {
        if (exact_[i] == 0) add_light(i, k, smooth_[k].sum[n] - smooth_[k].bounced[n], smooth_[k].bounced[n]);
      });
    // Classes are smoothed as the paints show them, two at a time.
    const std::size_t classes = t.classes.size();
    for (std::size_t k = 0; k < classes; k += 2) {
      std::vector<Halves> light(kept_.size());
      each_kept([&](std::size_t n, std::size_t i) {
        light[n] = exact_[i] != 0 ? Halves{} : Halves{kUnknown, kUnknown};
        if (slot_[i] == kNotSampled) return;
        const float* f = &sampled_[slot_[i] * of_slot_ + 18 * t.columns.count() + 3 * k];
        light[n][0] = {f[0], f[1], f[2]};
        if (k + 1 < classes) light[n][1] = {f[3], f[4], f[5]};
      });
      const std::vector<Halves> smooth = smoothed(shown_, light, {&shares_, &shares_});
      each_kept([&](std::size_t n, std::size_t i) {
        if (exact_[i] != 0 || !t.has_lobes(i)) return;
        for (std::size_t which = 0; which < 2 && k + which < classes; ++which)
          add_class(i, k + which, smooth[n][which]);
      });
    }
    each_kept([&](std::size_t, std::size_t i) {
      if (exact_[i] == 0 && t.has_lobes(i)) fit_classes(i);
    });
  }

  // Scales the classes of a point so that together they are its bounced light in the paint that is worn.
  void fit_classes(std::size_t i) {
    LobeTransport& t = result_.transport;
    const std::vector<color::Matrix3>& matrices = matrices_[static_cast<std::size_t>(group_of(t.part[i]))];
    color::Rgb bounced, sum;
    for (std::size_t k = 0; k < matrices.size(); ++k)
      bounced += color::product(matrices[k], t.light(i, k) - t.light(i, k, false));
    const std::size_t at = std::size_t{3} * t.with_lobes[i];
    for (std::vector<float>& light : t.classes)
      for (int c = 0; c < 3; ++c)
        sum[c] += light[at + static_cast<std::size_t>(c)] = std::max(0.0F, light[at + static_cast<std::size_t>(c)]);
    for (std::vector<float>& light : t.classes)
      for (int c = 0; c < 3; ++c)
        if (sum[c] > 0 && bounced[c] > 0)
          light[at + static_cast<std::size_t>(c)] *= static_cast<float>(bounced[c] / sum[c]);
  }

  // Plans the batches of the next round, and returns true if there are any.
  bool plan(std::vector<int>& more) const {
    RoundLimits limits;
    limits.of_point = request_.most_batches, limits.at_once = kMostAtOnce;
    limits.typical = worse([this](std::size_t i) { return needed_[i]; },
                           [](std::vector<double> needed) { return percentile_95(std::move(needed)); });
    limits.lacking = result_.error_p95_de00 / request_.tolerance_de00;
    limits.least = std::max(1.0, kLeastRound * drawn());
    const bool any = plan_round(
        limits, [this](std::size_t i) { return needed_[i]; }, [this](std::size_t i) { return counted(i); }, more);
    for (int& batches : more) batches = whole(batches + 1);
    return any;
  }

  const Transport& transport_;
  const Gbuffer& surface_;
  const OpenLight* open_;
  const LobeTransportRequest& request_;
  Deadline deadline_;
  Pace pace_{deadline_};
  Stopwatch clock_;
  TracedLobes result_;                                 // whose light is at first what needs no samples
  std::vector<Gbuffer> samples_;                       // of the pixels; none: their centers
  std::vector<std::vector<color::Matrix3>> matrices_;  // of the paints that are worn, by group and column
  std::vector<std::uint8_t> exact_;                    // points that nothing is left to samples of
  std::vector<int> batches_;
  std::vector<std::uint32_t> kept_;  // points but those of a floor without noise
  std::vector<ShownPoint> shown_;    // these
  std::vector<std::uint32_t> slot_;  // of points that have samples
  // Floats of a slot: the open light of columns, what completed it, of each half the direct and bounced light of
  // columns, and the classes.
  std::size_t of_slot_ = 0;
  std::vector<float> sampled_;        // by slot
  std::vector<double> needed_;        // batches
  std::vector<FilterShares> shares_;  // in the paints that are worn
  std::vector<SmoothColumn> smooth_;  // by column
};

}  // namespace

Result<WornPaints> worn_paints(const LobeColumns& columns, const PathScene& path) {
  const Scene& scene = *path.scene;
  WornPaints worn;
  std::vector<std::size_t> first;  // part of each group
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    if (scene.layer != nullptr) {
      const PartSurface& surface = scene.layer->surface(static_cast<int>(part));
      if (!surface.textures.empty() || surface.color_map != nullptr)
        return usage_error("part {} wears a {}, whose light is no sum of the lobes of a paint: trace without it",
                           scene.mesh->parts[part].name, surface.textures.empty() ? "color map" : "texture");
    }
    int group = scene.paints.size() <= kMostOwnGroups ? static_cast<int>(first.size()) : 0;
    while (group < static_cast<int>(first.size()) && !same_wear(scene, first[static_cast<std::size_t>(group)], part))
      ++group;
    if (group == static_cast<int>(first.size())) {
      GONIO_ASSIGN(auto weights, column_weights(columns, scene.paints[part].diffuse, scene.paints[part].lobes,
                                                gloss_deg_of(scene, part)));
      worn.weights.push_back(std::move(weights));
      first.push_back(part);
    }
    worn.groups.of_part.push_back(group);
    worn.emission.push_back(part < path.emission.size() ? path.emission[part] : color::Rgb{});
    worn.coats.push_back(scene.paints[part].coat_index);
    worn.brushed.push_back(anisotropy_of(scene, part));
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
