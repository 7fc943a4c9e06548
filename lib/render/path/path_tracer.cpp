#include "render/path/path_tracer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/gathered.h"
#include "render/path/reconstruction.h"
#include "render/path/rounds.h"
#include "render/path/seen_point.h"

namespace goniochrome::render {

namespace {

// Rays look at every sample of a pixel at an edge. Where all of them show one piece of surface, rays look at the first
// and the last, and at so many where these two differ by more than this part of the tolerance without paths.
constexpr unsigned kOfOnePiece = 4;
constexpr double kAlike = 0.2;
// Where the mesh takes more than this part of the light that a point shows without it, the sum of all that is left has
// less noise than what is taken, and none of the error of maps.
constexpr double kMostlyHidden = 0.5;
constexpr std::size_t kMostOfPixel = 16;  // samples
// Points at which the shares of the first round are compared.
constexpr std::size_t kCompared = 4096;

class Picture {
 public:
  Picture(const Transport& transport, PixelSamples samples, const image::Image* base, const PathRequest& request)
      : transport_(transport),
        first_seen_(*samples.front()),
        seen_(samples),
        base_(base),
        request_(request),
        deadline_(request.time_limit_s),
        count_(samples.size()) {
    if (count_ > 1) even_ = even_pixels(samples, kSamePiece), flat_ = even_pixels(samples, kFlatPiece);
    if (count_ == 1 && request.pixel_samples > 1) {
      shifts_ = sample_shifts(request.pixel_samples);
      count_ = shifts_.size(), seen_ = {};
    }
    const Gbuffer& g = first_seen_;
    coverage_ = seen_.empty() ? coverage(transport.eye(), g.rays, g.width, g.height, shifts_) : coverage(seen_);
    add_points();
  }

  PathPicture draw() {
    std::vector<int> more = first_fours();
    TotalErrors errors;
    bool reached = false;
    bool mended = false;
    while (true) {
      const double before = drawn();
      pace_.start();
      sample(more, first_round_);
      pace_.end(drawn() - before + (first_round_ ? kFoursOfLook * static_cast<double>(points_.size()) : 0));
      if (first_round_ && is_corrected()) sum_where_hidden();
      if (!first_round_ && request_.reconstruct) mend_spikes(more);
      if (first_round_ && request_.stop_de00 > 0) stop_shares();
      first_ = {};
      first_round_ = false;  // which no time limit cuts, so that every point is seen
      const Stopwatch judging;
      errors = judge();
      judging_s_ = judging.elapsed_s();
      if (request_.progress) request_.progress(errors.all, clock_.elapsed_s());
      reached = request_.tolerance_de00 > 0 && errors.all <= request_.tolerance_de00;
      const bool ended = reached || (request_.tolerance_de00 > 0 && errors.noise <= least_aim());
      if (deadline_.passed()) break;
      bool goes_on = !ended && plan(errors, more);
      if (ended) std::ranges::fill(more, 0);
      // All specks get more with the second round, or at the end.
      if (!mended && (ended || goes_on)) mended = true, goes_on |= add_worst(more);
      if (!goes_on || !cut(pace_.left(judging_s_), more)) break;
    }
    PathPicture picture;
    picture.reached = reached && told_.all <= request_.tolerance_de00, picture.found = found_.of;
    picture.noise_p95_de00 = std::hypot(told_.noise, found_.stopped_de00), picture.error_p95_de00 = told_.all;
    const double count = std::max<double>(1, static_cast<double>(points_.size()));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const PathPoint& point = points_[i];
      picture.noise_mean_de00 += point.noise_de00;
      picture.samples_mean += point.samples;
      picture.free_share += states_[i].certain && point.samples == 0 ? 1 : 0;
      picture.dark = picture.dark && point.radiance == color::Rgb{};
    }
    picture.noise_mean_de00 /= count, picture.samples_mean /= count, picture.free_share /= count;
    picture.points = std::move(points_), picture.time_s = clock_.elapsed_s();
    return picture;
  }

 private:
  void add_points() {
    const Gbuffer& g = first_seen_;
    by_pixel_ = PixelPoints(g.width, g.height);
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) add_point(x, y);
    states_.resize(points_.size());
    if (!points_.empty()) left_ = std::ranges::min(points_, {}, &PathPoint::x).x;
    if (request_.reconstruct) shown_.assign(points_.size(), kNotShown);
    for (std::size_t i = 0; i < points_.size() && !flat_.empty(); ++i)
      if (flat_[place(points_[i])] != 0) states_[i].step = static_cast<unsigned>(count_) - 1;
    options_ = request_.options;
  }

  // Light on a surface does not change with the resolution: a first round leaves points out that neighbors tell.
  std::vector<int> first_fours() {
    std::vector<int> fours(points_.size(), kFirstFours);
    if (!request_.reconstruct || even_.empty()) return fours;
    spacing_ = first_spacing(points_.size(), request_.first_points);
    const PixelFlags told = told_by_corners(first_seen_, even_, spacing_);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (told[place(points_[i])] != 0) fours[i] = 0;
    return fours;
  }

  // Visits the points about one on its part or, at an edge, all about it.
  template <class Visit>
  void visit_alike(std::size_t i, const Visit& visit) const {
    const bool even = is_even(i);
    const auto part_of = [this](std::size_t k) { return first_seen_.at(points_[k].x, points_[k].y)[3]; };
    // Far enough that several points are sampled there: by one or two it would be decided by chance.
    by_pixel_.visit_within(std::max(PixelPoints::kReach, spacing_), points_[i].x, points_[i].y, [&](std::size_t k) {
      if (!even || (is_even(k) && part_of(k) == part_of(i))) visit(k);
    });
  }

  // A sum takes the place of the light of the mesh alone, which must be known. A pane shows what is behind it as well,
  // of which the sum knows nothing.
  bool can_be_summed(std::size_t i) const {
    const auto meets_pane = [&](const Gbuffer* sample) {
      return transport_.meets_pane({sample->triangles[place(points_[i])]});
    };
    return !states_[i].certain && (points_[i].coverage == 1 || request_.beside_mesh) &&
           std::ranges::none_of(seen_, meets_pane);
  }

  // True where the mesh takes most of the light about a point; at an edge, about it or in its own pixel.
  bool is_hidden(std::size_t i) const {
    const auto taken_at = [this](std::size_t k) { return -(first_shares(k).direct + first_shares(k).from_floor).y; };
    double base = 0, taken = 0;
    visit_alike(i, [&](std::size_t k) {
      if (!is_unknown(k)) base += base_at(points_[k]).y, taken += taken_at(k);
    });
    return taken > kMostlyHidden * base || (!is_even(i) && taken_at(i) > kMostlyHidden * base_at(points_[i]).y);
  }

  // Hidden points begin anew, by other numbers than those that decided it. Most of the points about one decide again:
  // filters would leave out one that is not like its neighbors.
  void sum_where_hidden() {
    std::vector<int> more(points_.size(), 0);
    std::vector<char> hidden(points_.size());
    each_point([&](std::size_t i) { hidden[i] = can_be_summed(i) && is_hidden(i) ? 1 : 0; });
    each_point([&](std::size_t i) {
      PointState& state = states_[i];
      int most = hidden[i];
      if (is_even(i)) visit_alike(i, [&](std::size_t k) { most += 2 * hidden[k] - 1; });
      state.hidden = most > 0 && can_be_summed(i);
      if (!state.hidden) return;
      state.looked = false;
      if (request_.reconstruct) shown_[i] = kNotShown;
      if (state.sampled == PointState::kNotSampled) return;
      sampled_[state.sampled] = {}, more[i] = kFirstFours;
    });
    sample(more, true);
  }

  // Samples of this round that err so much, beside those about them, that filters would spread them as a disc get more.
  void mend_spikes(const std::vector<int>& drawn) {
    std::vector<double> squares(points_.size(), 0);
    each_point([&](std::size_t i) { squares[i] = std::pow(own_noise(i), 2); });
    const double least = std::pow(kBlotch * tolerance(), 2);
    std::vector<int> more(points_.size(), 0);
    each_point([&](std::size_t i) {
      const int fours = sums(i).fours();
      if (drawn[i] > 0 && squares[i] > least && is_rare(by_pixel_, points_[i].x, points_[i].y, squares, squares[i]))
        more[i] = std::clamp(request_.most_samples / kOfFour - fours, 0, static_cast<int>(kMostOfSpeck) * fours);
    });
    if (cut_specks(more) && cut(pace_.left(judging_s_), more)) sample(more, false);
  }

  // Points that were left out and of which no neighbor tells get samples, which they show as they are.
  void fill_gaps() {
    std::vector<int> more(points_.size(), 0);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (std::isinf(points_[i].noise_de00)) more[i] = kFirstFours;
    sample(more, true);
    each_point([&](std::size_t i) {
      if (more[i] == 0) return;
      show_own(i);
      points_[i].noise_de00 = own_noise(i);
    });
  }

  // The first samples of a point are of all shares.
  PathOptions options_of(std::size_t i) const {
    PathOptions options = sums(i).fours() == 0 || states_[i].all_shares ? request_.options : options_;
    options.correction = options.correction && !states_[i].hidden;
    return options;
  }

  // Light that samples tell, of which there are none yet.
  bool is_unknown(std::size_t i) const { return !states_[i].certain && sums(i).fours() == 0; }

  void add_point(int x, int y) {
    const std::size_t at = place(x, y);
    PathPoint point;
    point.x = x, point.y = y;
    const unsigned any = coverage_.any[at];
    point.coverage = static_cast<float>(std::popcount(any)) / static_cast<float>(count_);
    point.floor = coverage_.floor[at] == any;
    if (point.coverage == 0) return;
    by_pixel_.add(x, y);
    points_.push_back(point);
  }

  inline static const ShownPoint kNotShown{0, 0, {-1, {}, {}}};

  const Gathered& sums(std::size_t i) const {
    static const Gathered none;
    return states_[i].sampled == PointState::kNotSampled ? none : sampled_[states_[i].sampled].sums;
  }
  Halves kept(std::size_t i) const {
    return states_[i].sampled == PointState::kNotSampled ? Halves{} : sampled_[states_[i].sampled].kept;
  }

  bool is_corrected() const { return base_ != nullptr && request_.options.correction; }
  bool is_even(std::size_t i) const { return count_ == 1 || (!even_.empty() && even_[place(points_[i])] != 0); }
  std::size_t place(const PathPoint& point) const { return place(point.x, point.y); }
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(first_seen_.width) + static_cast<std::size_t>(x);
  }

  // No clock ends a round that is needed.
  void sample(const std::vector<int>& more, bool is_needed) {
    std::vector<std::uint32_t> wanted;
    std::uint32_t count = static_cast<std::uint32_t>(sampled_.size());
    for (std::size_t i = 0; i < more.size(); ++i) {
      if (more[i] > 0 || !states_[i].looked) wanted.push_back(static_cast<std::uint32_t>(i));
      if (more[i] > 0 && states_[i].sampled == PointState::kNotSampled) states_[i].sampled = count++;
    }
    sampled_.resize(count);
    if (first_round_ && (is_corrected() || request_.stop_de00 > 0)) first_.resize(count);
    draw_round(wanted, is_needed ? nullptr : &deadline_, [&](std::size_t i) { sample(i, more[i]); });
  }

  // Keeps what the reconstruction needs of a sample that counts by `share` in its pixel.
  void show(std::size_t i, const rays::Spot& spot, double share) {
    if (!request_.reconstruct) return;
    ShownPoint& shown = shown_[i];
    const ShownPiece piece{2 * spot.part + (states_[i].hidden ? 1 : 0), spot.shading, spot.position,
                           static_cast<float>(share)};
    if (shown.piece.part < 0) shown = {points_[i].x - left_, points_[i].y - points_.front().y, piece};
    if (share < 1 && !is_even(i)) shown.pieces.push_back(piece);
  }

  void add_round(std::size_t i, const Round& round, const LightShares (&means)[Round::kSequences]) {
    color::Rgb drawn[Round::kSequences];
    SampledPoint& sampled = sampled_[states_[i].sampled];
    const unsigned shares = states_[i].all_shares ? kAllShares : drawn_;
    for (std::size_t k = 0; k < Round::kSequences; ++k) drawn[k] = sum_of(means[k], shares);
    if (sampled.sums.fours() == 0)
      for (std::size_t k = 0; k < Round::kSequences; ++k) sampled.kept[k] = sum_of(means[k], kAllShares & ~drawn_);
    sampled.sums.add(round, drawn);
    if (!first_.empty()) std::ranges::copy(means, first_[states_[i].sampled].begin());
  }

  // The shares of a point in the first round, with the light that is known without samples.
  LightShares first_shares(std::size_t i) const {
    LightShares shares;
    if (const std::uint32_t n = states_[i].sampled; n != PointState::kNotSampled)
      shares = 0.5 * first_[n][0], shares += 0.5 * first_[n][1];
    shares.direct += states_[i].deterministic;
    return shares;
  }

  // The mean over the neighborhood of a point.
  SharedPoint mean_around(const PathPoint& point) const {
    SharedPoint sum;
    int count = 0;
    by_pixel_.visit_around(point.x, point.y, [&](std::size_t i) {
      if (is_unknown(i)) return;
      sum.shares += first_shares(i);
      sum.base += base_at(points_[i]);
      ++count;
    });
    return {(1.0 / count) * sum.shares, (1.0 / count) * sum.base};
  }

  void stop_shares() {
    std::vector<SharedPoint> own, smooth;
    const std::size_t step = points_.size() / kCompared | 1;
    for (std::size_t i = step / 2; i < points_.size(); i += step) {
      while (i < points_.size() && is_unknown(i)) ++i;
      if (i == points_.size()) break;
      own.push_back({first_shares(i), base_at(points_[i])});
      smooth.push_back(mean_around(points_[i]));
    }
    found_ = found_shares(own, smooth, request_.stop_de00, request_.white_luminance);
    if (found_.stopped != 0) draw_without(found_.stopped);
  }

  // The result of the first round stays for these shares.
  void draw_without(unsigned stopped) {
    drawn_ = kAllShares & ~stopped;
    options_.into_lobes = options_.into_lobes && (drawn_ & 2U) != 0;
    options_.into_diffuse = options_.into_diffuse && (drawn_ & 4U) != 0;
    if (!options_.into_lobes && !options_.into_diffuse) options_.bounces = 0;
    const Round round(kFirstFours);
    each_point([&](std::size_t i) {
      PointState& state = states_[i];
      if (sums(i).fours() == 0) return;
      color::Rgb drawn[Round::kSequences];
      Halves kept;
      for (std::size_t k = 0; k < Round::kSequences; ++k)
        drawn[k] = sum_of(first_[state.sampled][k], drawn_), kept[k] = sum_of(first_[state.sampled][k], stopped);
      const color::Rgb shown = base_at(points_[i]) + first_shares(i).sum(), error = 0.5 * (kept[0] - kept[1]);
      state.all_shares =
          seen_difference(shown, shown + error, request_.white_luminance) > kSpeck * request_.tolerance_de00;
      if (state.all_shares) return;
      SampledPoint& sampled = sampled_[state.sampled];
      sampled.sums = {};
      sampled.sums.add(round, drawn);
      sampled.kept = kept;
    });
  }

  struct Look {
    rays::Spot spot;
    rays::Float3 to_viewer;
    SeenPoint at;
  };
  // The point that a sample of a pixel sees, which is something.
  Look look_at(std::size_t i, std::size_t sample) const {
    const PathPoint& point = points_[i];
    const rays::RayScene& scene = transport_.eye();
    const auto look = [&](const rays::Spot& spot, const rays::Float3& to_viewer) {
      return Look{spot, to_viewer, {transport_, options_of(i), spot, to_viewer}};
    };
    if (!seen_.empty()) {
      const Gbuffer& seen = *seen_[sample];
      return look(spot_at(scene, seen, point.x, point.y), rays::float3(seen.to_viewer(point.x, point.y)));
    }
    const Rays& through = first_seen_.rays;
    const Vec3 toward = through.direction(point.x + 0.5 + shifts_[sample][0], point.y + 0.5 + shifts_[sample][1]);
    const rays::Float3 eye = scene.local(through.eye), direction = rays::float3(toward);
    return look(scene.spot(scene.closest(eye, direction), eye, direction), -direction);
  }

  bool are_alike(std::size_t i, const Look& a, const Look& b) const {
    const color::Rgb base = states_[i].hidden ? color::Rgb{} : base_at(points_[i]);
    const color::Rgb one = a.at.deterministic(), other = b.at.deterministic();
    return one == other ||
           seen_difference(base + one, base + other, request_.white_luminance) <= kAlike * request_.tolerance_de00;
  }

  // The fans take the uncertain samples of the pixel in turn from one drawn by chance: the mean over all fans has the
  // right expectation, and the differences between samples count as noise while not all have been seen.
  void sample(std::size_t i, int fours) {
    PointState& state = states_[i];
    const Round round(fours);
    std::array<std::optional<Look>, kMostOfPixel> looks;
    const auto look = [&](std::size_t sample) -> const Look& {
      return looks[sample] ? *looks[sample] : looks[sample].emplace(look_at(i, sample));
    };
    if (!state.looked && state.step > 1 && !are_alike(i, look(0), look(count_ - 1)))
      state.step = std::max(1U, static_cast<unsigned>(count_ - 1) / (kOfOnePiece - 1));
    const unsigned step = state.step, count = (static_cast<unsigned>(count_) + step - 1) / step;
    const double share = 1.0 / count;
    const unsigned covered = coverage_.any[place(points_[i])];
    const bool first_time = !state.looked;
    state.looked = true;
    if (first_time) state.uncertain = 0, state.deterministic = {};
    for (unsigned sample = 0; first_time && sample < count_; sample += step) {
      if ((covered >> sample & 1U) == 0) continue;
      const auto& [spot, to_viewer, at] = look(sample);
      state.deterministic += share * at.deterministic();
      show(i, spot, share);
      if (!at.certain()) state.uncertain = static_cast<std::uint16_t>(state.uncertain | 1U << sample);
    }
    if (first_time && state.hidden) state.deterministic += -1.0 * base_of_mesh(points_[i]);
    state.certain = state.uncertain == 0;
    if (state.certain || fours == 0) return;
    const int uncertain = std::popcount(state.uncertain);
    const auto uncertain_look = [&](int turn) -> const Look& {
      unsigned left = state.uncertain;
      for (int k = turn % uncertain; k > 0; --k) left &= left - 1;
      return look(static_cast<std::size_t>(std::countr_zero(left)));
    };
    color::Rgb& floor_light = sampled_[state.sampled].floor_light;
    const int floors = is_even(i) ? 1 : uncertain;
    for (int k = 0; sums(i).fours() == 0 && k < floors; ++k)
      floor_light += (share * uncertain / floors) * uncertain_look(k).at.floor_light();
    const int turn =
        static_cast<int>((mixed(request_.seed, i) >> 32) % static_cast<unsigned>(uncertain)) + sums(i).fours();
    LightShares means[Round::kSequences];
    for (int fan = 0; fan < round.fans(); ++fan) {
      const int which = round.sequence_of(fan), batch = sums(i).fours() + which;
      const std::uint64_t seed =
          mixed(mixed(request_.seed, i), static_cast<std::uint64_t>(state.hidden ? ~batch : batch));
      const Sequence sequence(seed, static_cast<std::uint32_t>(kOfFour * round.length));
      const auto drawn = static_cast<std::uint32_t>(kOfFour * round.together());
      means[which] += (share * uncertain * round.together() / round.length) *
                      uncertain_look(turn + fan).at.shares_of(sequence, round.first_of(fan), drawn);
    }
    for (LightShares& mean : means) mean.from_floor += floor_light;
    add_round(i, round, means);
  }

  template <class Visit>
  void each_point(const Visit& visit) const {
    parallel_each(points_.size(), 1024, visit);
  }

  // By its own samples.
  color::Rgb own_light(std::size_t i) const {
    return states_[i].deterministic + sums(i).mean() + 0.5 * (kept(i)[0] + kept(i)[1]);
  }
  double own_noise(std::size_t i) const {
    if (sums(i).fours() == 0) return 0;
    Covariance covariance = sums(i).of_four();
    for (double& element : covariance) element /= sums(i).fours();
    return noise_of(i, own_light(i), covariance);
  }
  void show_own(std::size_t i) {
    points_[i].radiance = own_light(i);
    points_[i].samples = kOfFour * sums(i).fours();
  }

  // Radiance, error and noise of every point from its sums.
  TotalErrors judge() {
    each_point([&](std::size_t i) { show_own(i); });
    if (!request_.reconstruct) {
      each_point([this](std::size_t i) { judge(i); });
      const double noise = worse_percentile([this](std::size_t i) { return points_[i].noise_de00; });
      return told_ = {noise, noise};
    }
    reconstruct();
    fill_gaps();
    PointErrors of;
    for (const PathPoint& point : points_) (point.floor ? of.floor : of.mesh).push_back(point.noise_de00);
    const TotalErrors own = told_ = total_errors(of, request_.beside_de00, found_.stopped_de00);
    if (request_.before == nullptr) return own;
    of.add(*request_.before);
    told_ = total_errors(of, request_.beside_de00, found_.stopped_de00);
    return {std::min(own.noise, told_.noise), std::min(own.all, told_.all)};
  }

  // Light that is known without samples stays sharp. What is taken and what is left are never mixed.
  void reconstruct() {
    std::vector<Halves> halves(points_.size());
    std::vector<color::Rgb> beside(points_.size());
    std::vector<float> samples(points_.size());
    each_point([&](std::size_t i) {
      samples[i] = static_cast<float>(sums(i).fours());
      beside[i] = base_at(points_[i]) + states_[i].deterministic;
      for (std::size_t k = 0; k < 2; ++k) {
        halves[i][k] = sums(i).halves()[k] + kept(i)[k];
        if (is_unknown(i)) halves[i][k] = kUnknown;
      }
    });
    const Reconstruction found = reconstruction(shown_, halves, beside, request_.white_luminance, samples);
    each_point([&](std::size_t i) {
      const bool certain = states_[i].certain && sums(i).fours() == 0;
      points_[i].radiance = states_[i].deterministic + (certain ? halves[i][0] : found.light[i]);
      points_[i].noise_de00 = certain ? 0 : found.error_de00[i];
      const double needed = needed_samples(counted(i), points_[i].noise_de00, found.spike_de00[i], tolerance());
      states_[i].needed = certain ? 0 : std::max(needed, found.shares[i][0] < 1 ? 0 : kAlone);
    });
  }

  // The larger of the 95th percentiles over the mesh and over the floor.
  template <class Value>
  double worse_percentile(const Value& value) const {
    std::vector<double> mesh, floor;
    for (std::size_t i = 0; i < points_.size(); ++i) (points_[i].floor ? floor : mesh).push_back(value(i));
    return std::max(percentile_95(std::move(mesh)), percentile_95(std::move(floor)));
  }

  void judge(std::size_t i) {
    PathPoint& point = points_[i];
    PointState& state = states_[i];
    point.covariance = {};
    point.noise_de00 = state.needed = 0;
    const int fours = sums(i).fours();
    if (fours == 0) return;
    const Covariance& own = sums(i).of_four();
    Covariance around{};
    color::Rgb light;
    int count = 0;
    by_pixel_.visit_around(point.x, point.y, [&](std::size_t other) {
      if (other == i || sums(other).fours() == 0) return;
      ++count;
      light += points_[other].radiance;
      for (std::size_t k = 0; k < 6; ++k) around[k] += sums(other).of_four()[k];
    });
    const double freedom = sums(i).freedom();
    for (std::size_t k = 0; k < 6; ++k)
      point.covariance[k] = smoothed_variance(own[k], freedom, around[k], count) / fours;
    point.noise_de00 = noise_of(i, point.radiance, point.covariance);
    // How many samples a point is to get is decided by its neighbors alone: were its own sums asked, it would stop
    // where they happen to be bright, and the mean would be too.
    if (count == 0) around = own, light = point.radiance, count = 1;
    for (double& element : around) element /= count;
    const double excess = noise_of(i, (1.0 / count) * light, around) / tolerance();
    state.needed = excess * excess;
  }

  // The fours of a point. Where its neighbors tell its light, it has as many as they got at first.
  int counted(std::size_t i) const { return is_unknown(i) ? kFirstFours : sums(i).fours(); }

  double noise_of(std::size_t i, const color::Rgb& radiance, const Covariance& covariance) const {
    return noise_de00(base_at(points_[i]) + radiance, covariance, request_.white_luminance);
  }

  color::Rgb base_at(const PathPoint& point) const {
    if (base_ == nullptr) return {};
    const float* rgb = base_->pixel(point.x, point.y);
    return {rgb[0], rgb[1], rgb[2]};
  }
  color::Rgb base_of_mesh(const PathPoint& point) const {
    return point.coverage == 1 ? base_at(point) : base_at(point) - request_.beside_mesh(point.x, point.y);
  }

  // The noise that may be left where other errors take up the tolerance.
  double least_aim() const { return 0.5 * request_.tolerance_de00; }
  // The noise that the other errors allow.
  double tolerance() const {
    const double whole = request_.tolerance_de00, other = std::hypot(beside_, found_.stopped_de00);
    return std::max({std::sqrt(std::max(0.0, whole * whole - other * other)), least_aim(), 1e-9});
  }

  // The fours of the next round, unless points that got all that they may get keep the picture from its tolerance: they
  // end with what their neighborhoods ask for. Returns true if there are any.
  bool plan(const TotalErrors& errors, std::vector<int>& more) const {
    RoundLimits limits;
    limits.of_point = request_.most_samples / kOfFour;
    limits.typical = worse_percentile([this](std::size_t i) { return states_[i].needed; });
    limits.lacking = std::min(errors.all / std::max(1e-9, request_.tolerance_de00), errors.noise / least_aim());
    limits.least = std::max(1.0, kLeastRound * drawn());
    limits.in_vain =
        request_.tolerance_de00 > 0 && tolerance() < worse_percentile([&](std::size_t i) {
                                         return sums(i).fours() >= limits.of_point ? points_[i].noise_de00 : 0;
                                       });
    return plan_round(
        limits, [&](std::size_t i) { return states_[i].needed; }, [&](std::size_t i) { return counted(i); }, more);
  }

  // No more fours for specks than their part of all; whether any.
  bool cut_specks(std::vector<int>& more) const {
    return std::ranges::any_of(more, [](int fours) { return fours > 0; }) &&
           cut(kSpecksShare * std::max(drawn(), static_cast<double>(points_.size())), more);
  }

  // A picture that is within its tolerance at 95 of 100 points may have specks at the others, most of them at edges,
  // which no neighbor tells. They get more in one round. Returns true if there are any.
  bool add_worst(std::vector<int>& more) const {
    if (!request_.reconstruct) return false;
    const double limit = request_.most_samples / kOfFour;
    std::vector<int> worst(more.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double n = counted(i), wanted = std::min(states_[i].needed / (kSpeck * kSpeck), limit) - n;
      worst[i] = static_cast<int>(std::clamp(wanted, 0.0, kMostOfSpeck * n));
    }
    if (!cut_specks(worst)) return false;
    std::ranges::transform(more, worst, more.begin(), [](int a, int b) { return std::max(a, b); });
    return true;
  }

  double drawn() const {
    double fours = 0;
    for (const SampledPoint& sampled : sampled_) fours += sampled.sums.fours();
    return fours;
  }

  // No more fours than `most`; whether any.
  static bool cut(double most, std::vector<int>& more) {
    return cut_round(most, more, [](int fours) { return fours >= Round::kSequences ? Round(fours).fours() : 0; });
  }

  const Transport& transport_;
  const Gbuffer& first_seen_;
  PathOptions options_;  // of what is drawn after a first round
  PixelSamples seen_;    // of each sample of a pixel; empty: rays find what is seen
  const image::Image* base_;
  const PathRequest& request_;
  Deadline deadline_;
  Pace pace_{deadline_};
  Stopwatch clock_;
  bool first_round_ = true;
  double judging_s_ = 0;                       // after the last round
  TotalErrors told_;                           // of all points, those that were drawn before among them
  std::size_t count_ = 1;                      // of the pixels' samples
  std::vector<std::array<double, 2>> shifts_;  // of these, where rays find what is seen
  Coverage coverage_;
  PixelFlags even_, flat_;  // empty but where surfaces of all samples are given
  PixelPoints by_pixel_;
  std::vector<PathPoint> points_;
  std::vector<PointState> states_;
  std::vector<SampledPoint> sampled_;
  unsigned drawn_ = kAllShares;  // the shares that are drawn on
  FoundShares found_;
  std::vector<std::array<LightShares, Round::kSequences>> first_;  // of those sampled first; empty: not kept
  const double beside_ = percentile_95(request_.beside_de00);      // of the errors that are no noise
  int spacing_ = 1;                                                // of points that the first round samples
  int left_ = 0;                                                   // the least x of a point
  std::vector<ShownPoint> shown_;                                  // by the points; empty: nothing is reconstructed
};

}  // namespace

PathPicture path_picture(const Transport& transport, PixelSamples samples, const image::Image* base,
                         const PathRequest& request) {
  return Picture(transport, samples, base, request).draw();
}

}  // namespace goniochrome::render
