// Three readings do not tell the three numbers of a coat of two scales equally well, nor how its slopes are
// distributed. Among coats with the given readings, to the accuracy of meters, the most probable one is taken: one of
// one scale where a single number explains all three readings, since that is no coincidence, and else the one nearest
// to the usual series.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "brdf/gloss.h"
#include "brdf/rough_coat.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

// The coats of one reading lie on this series. Its satin (60 GU) reads 16 and 84 GU at 20 and 85 deg.
// [MPI gloss levels] pair 60 with 85 deg: below 5 with below 10, 10 to 25 with 10 to 35, 20 to 35 with 35 and more.
constexpr double kSeriesSlope = 0.009, kSeriesPower = 1.5, kSeriesMost = 13;

RoughCoat of_series(double k) {
  const double slope = kSeriesSlope * math::pow(k, kSeriesPower);
  return {k, slope, std::max(RoughCoat::kHaze, slope)};
}

// The coat of the series that reads so much; readings fall with k.
RoughCoat series_coat(std::size_t view, double gu) {
  double low = 0, high = kSeriesMost;
  while (high - low > 1e-13 * high) {
    const double middle = 0.5 * (low + high);
    (coat_reading_at(of_series(middle), view) > gu ? low : high) = middle;
  }
  return of_series(0.5 * (low + high));
}

// The given data of a coat: readings, which have this standard deviation.
struct Wanted {
  struct Reading {
    std::size_t view;
    double gu;
  };
  std::vector<Reading> readings;
  double deviation_gu;

  double off(const RoughCoat& coat, const Reading& reading) const {
    return (coat_reading_at(coat, reading.view) - reading.gu) / deviation_gu;
  }
};
struct Found {
  RoughCoat coat;
  double cost;  // sum of squares in standard deviations
};

constexpr double kLeastHaze = 0.03;

// By how much, in squares of standard deviations, a coat of one scale may explain three readings worse than one of two
// scales, which has two more numbers to meet them by.
constexpr double kSimpler = 9;

// The coat of one scale that is nearest to the readings.
Found of_one_scale(const Wanted& wanted, Slopes slopes) {
  constexpr int kSteps = 200;
  const double low = math::log(kLeastSlope), step = (math::log(kMostSlope) - low) / kSteps;
  const auto at = [&](double place) {
    const RoughCoat coat{0, math::exp(low + step * place), RoughCoat::kHaze, slopes};
    double cost = 0;
    for (const Wanted::Reading& reading : wanted.readings)
      cost += wanted.off(coat, reading) * wanted.off(coat, reading);
    return Found{coat, cost};
  };
  int nearest = 0;
  double least = at(0).cost;
  for (int i = 1; i <= kSteps; ++i)
    if (const double cost = at(i).cost; cost < least) least = cost, nearest = i;
  double a = std::max(0, nearest - 1), b = std::min(kSteps, nearest + 1);
  constexpr double kGolden = 0.61803398874989485;
  while (b - a > 1e-9) {
    const double x = b - kGolden * (b - a), y = a + kGolden * (b - a);
    (at(x).cost < at(y).cost ? b : a) = at(x).cost < at(y).cost ? y : x;
  }
  return at(0.5 * (a + b));
}

// A coat near given readings: least squares in log slope, k and log haze, by Gauss-Newton steps that are damped
// [Marquardt]. How far a coat lies from the series counts a little, so that readings that leave something open take
// what is usual.
class CoatSearch {
 public:
  CoatSearch(const Wanted& wanted, Slopes slopes) : wanted_(wanted), slopes_(slopes) {}
  // A search among coats with this haze alone.
  CoatSearch(const Wanted& wanted, Slopes slopes, double haze)
      : wanted_(wanted), slopes_(slopes), least_(math::log(haze)), most_(least_), free_(2) {}

  // The cost of a coat as it is.
  Found at(const RoughCoat& coat) const {
    return {coat, squares(residuals({math::log(coat.slope), coat.k, math::log(coat.haze)}))};
  }

  Found from(const RoughCoat& start) const {
    Point x = clamped({math::log(start.slope), start.k, math::log(start.haze)});
    std::vector<double> r = residuals(x);
    double cost = squares(r), damping = 1e-3;
    for (int round = 0; round < 60 && damping < 1e9; ++round) {
      const Point next = clamped(step(x, r, damping));
      const std::vector<double> tried = residuals(next);
      const double now = squares(tried);
      if (!(now < cost)) {
        damping *= 8;
        continue;
      }
      const bool done = cost - now < 1e-12 * cost;
      x = next, r = tried, cost = now, damping /= 4;
      if (done) break;
    }
    return {coat(x), cost};
  }

 private:
  using Point = std::array<double, 3>;
  static constexpr double kApart[] = {2, 0.7};  // standard deviations of k and log haze

  RoughCoat coat(const Point& x) const { return {x[1], math::exp(x[0]), math::exp(x[2]), slopes_}; }
  Point clamped(const Point& x) const {
    return {std::clamp(x[0], math::log(kLeastSlope), math::log(kMostSlope)), std::clamp(x[1], 0.0, kSeriesMost),
            std::clamp(x[2], least_, most_)};
  }
  static double squares(const std::vector<double>& r) {
    double sum = 0;
    for (const double x : r) sum += x * x;
    return sum;
  }
  std::vector<double> residuals(const Point& x) const {
    const RoughCoat here = coat(x);
    std::vector<double> r;
    for (const Wanted::Reading& reading : wanted_.readings) r.push_back(wanted_.off(here, reading));
    r.push_back((here.k - math::pow(here.slope / kSeriesSlope, 1 / kSeriesPower)) / kApart[0]);
    r.push_back((x[2] - math::log(RoughCoat::kHaze)) / kApart[1]);
    return r;
  }
  // The solution of (J'J + d diag) s = -J'r, by elimination: three unknowns, or two.
  Point step(const Point& x, const std::vector<double>& r, double damping) const {
    constexpr double kDifference = 1e-5;
    std::array<std::vector<double>, 3> j;
    for (std::size_t c = 0; c < free_; ++c) {
      Point moved = x;
      moved[c] += kDifference;
      j[c] = residuals(moved);
      for (std::size_t i = 0; i < r.size(); ++i) j[c][i] = (j[c][i] - r[i]) / kDifference;
    }
    double a[3][4] = {};
    for (std::size_t c = 0; c < free_; ++c)
      for (std::size_t i = 0; i < r.size(); ++i) {
        for (std::size_t d = 0; d < free_; ++d) a[c][d] += j[c][i] * j[d][i];
        a[c][3] -= j[c][i] * r[i];
      }
    for (std::size_t c = 0; c < free_; ++c) a[c][c] *= 1 + damping;
    for (std::size_t c = 0; c < free_; ++c)
      for (std::size_t row = 0; row < free_; ++row)
        if (row != c && a[c][c] > 0) {
          const double part = a[row][c] / a[c][c];
          for (std::size_t d = c; d < 4; ++d) a[row][d] -= part * a[c][d];
        }
    Point next = x;
    for (std::size_t c = 0; c < free_; ++c) next[c] += a[c][c] > 0 ? a[c][3] / a[c][c] : 0;
    return next;
  }

  const Wanted& wanted_;
  Slopes slopes_;
  double least_ = math::log(kLeastHaze), most_ = math::log(kMostSlope);  // log haze
  std::size_t free_ = 3;                                                 // numbers
};

Found of_two_scales(const Wanted& wanted, Slopes slopes) {
  const CoatSearch search(wanted, slopes);
  std::optional<Found> best;
  for (const Wanted::Reading& w : wanted.readings) {
    const RoughCoat usual = series_coat(w.view, w.gu);
    for (const RoughCoat& start :
         {usual, RoughCoat{0, std::max(usual.slope, 2 * kLeastSlope)}, RoughCoat{usual.k, 2 * kLeastSlope}}) {
      const Found found = search.from(start);
      if (!best || found.cost < best->cost) best = found;
    }
  }
  return *best;
}

// The coat at the end of the range of hazes, upward or downward from a found one. The haze is what readings tell least:
// with each haze, the other two numbers are the most probable ones.
RoughCoat end_of_range(const Wanted& wanted, const Found& found, bool up) {
  constexpr double kRise = 4;      // two standard deviations
  constexpr double kStep = 0.005;  // of log haze
  const double end = math::log(up ? kMostSlope : kLeastHaze);
  double inside = math::log(found.coat.haze), outside = end;
  RoughCoat last = found.coat;
  const auto try_haze = [&](double log_haze) {
    const Found with = CoatSearch(wanted, found.coat.slopes, math::exp(log_haze)).from(last);
    if (with.cost > found.cost + kRise) return false;
    last = with.coat, inside = log_haze;
    return true;
  };
  if (try_haze(end)) return last;
  while (std::abs(outside - inside) > kStep) {
    const double middle = 0.5 * (inside + outside);
    if (!try_haze(middle)) outside = middle;
  }
  return last;
}

// The readings of the coat alone, relative to black glass as a coat of the usual index would read; none where they are
// those of a smooth coat, or too dull for any.
Result<std::optional<Wanted>> wanted_of(const std::vector<paint::GlossReading>& readings, double index,
                                        double deviation_gu) {
  constexpr double kSmooth_gu = 1;
  Wanted wanted{{}, deviation_gu};
  bool smooth = true;
  for (const paint::GlossReading& reading : readings) {
    GONIO_ASSIGN(const double of_index, smooth_gloss(reading.angle_deg, index));
    GONIO_ASSIGN(const double usual, smooth_gloss(reading.angle_deg, kCoatIndex));
    smooth = smooth && reading.gloss_units > of_index - kSmooth_gu;
    wanted.readings.push_back(
        {*view_of_meter(reading.angle_deg), std::max(0.0, reading.gloss_units) * usual / of_index});
  }
  const auto matt = [](const Wanted::Reading& w) { return w.gu <= coat_reading_at(of_series(kSeriesMost), w.view); };
  if (smooth || std::ranges::all_of(wanted.readings, matt)) return std::optional<Wanted>();
  return std::optional(std::move(wanted));
}

}  // namespace

Result<std::optional<RoughCoat>> rough_coat_of(const std::vector<paint::GlossReading>& readings, double index,
                                               double deviation_gu) {
  GONIO_ASSIGN(const std::optional<Wanted> known, wanted_of(readings, index, deviation_gu));
  if (!known) return std::optional<RoughCoat>();
  const Wanted& wanted = *known;
  if (wanted.readings.size() == 1) return std::optional(series_coat(wanted.readings[0].view, wanted.readings[0].gu));
  Found best = of_two_scales(wanted, Slopes::kGgx);
  if (wanted.readings.size() < std::size(kGlossAngles_deg)) return std::optional(best.coat);
  const auto take = [&](const Found& found, double simpler) {
    if (found.cost - simpler < best.cost) best = {found.coat, found.cost - simpler};
  };
  take(of_two_scales(wanted, Slopes::kGaussian), 0);
  for (const Slopes slopes : {Slopes::kGgx, Slopes::kGaussian}) take(of_one_scale(wanted, slopes), kSimpler);
  return std::optional(best.coat);
}

Result<std::optional<CoatRange>> rough_coat_range(const std::vector<paint::GlossReading>& readings, double index,
                                                  double deviation_gu) {
  GONIO_ASSIGN(const std::optional<RoughCoat> coat, rough_coat_of(readings, index, deviation_gu));
  if (!coat || coat->k == 0) return std::optional<CoatRange>();
  GONIO_ASSIGN(const std::optional<Wanted> wanted, wanted_of(readings, index, deviation_gu));
  const Found found = CoatSearch(*wanted, coat->slopes).at(*coat);
  return std::optional(CoatRange{end_of_range(*wanted, found, false), found.coat, end_of_range(*wanted, found, true)});
}

}  // namespace goniochrome::brdf
