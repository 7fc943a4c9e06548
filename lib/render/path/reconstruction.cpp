#include "render/path/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "render/gbuffer.h"
#include "render/path/noise.h"
#include "render/path/regression_kernel.h"

namespace goniochrome::render {

namespace {

using Predicted = std::array<float, kHalvesChannels>;

// A filter: the level of the pyramid of surfaces on which it works, and its window there.
struct Filter {
  int level;
  RegressionWindow window;
};
constexpr std::array<Filter, 5> kFilters = {{
    {0, {2, 0.1F, 0.5F}},
    {1, {2, 0.1F, 0.5F}},
    {2, {2, 0.1F, 0.5F}},
    {3, {2, 0.15F, 0.5F}},
    {3, {5, 0.25F, 0.5F}},
}};
constexpr int kLevels = 4;
// The light as it was sampled, and by each filter.
constexpr std::size_t kChoices = kFilters.size() + 1;
static_assert(kChoices == kFilterChoices);
// Errors are means over this neighborhood.
constexpr Filter kErrorMean = {2, {3, 0.25F, 0.5F}};
// A squared difference of a filter from its reference above this multiple of their common variance counts as bias.
constexpr float kSurprise = 25;
// A squared bias of the smallest filter, measured beside samples, is believed up to this multiple of that of the next
// filter beside the smallest. Without noise it was 1.7 to 2.9 times that at edges of shadows, and .2 in smooth light.
constexpr float kMostOfNext = 3;
// More is believed where it exceeds this part of the variance of the samples: lines of one pixel have 9 times that of
// the next filter.
constexpr float kOfSamples = 0.25F;
// Samples with so many times the variance of their neighborhood have a large part of it: some hundred points count in
// its mean.
constexpr float kLargePart = 16;
// The own variance of a point, divided by this, bounds its error from below: the mean over a neighborhood dilutes rare
// bright samples.
constexpr float kSpike = 4;
constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

template <class Visit>
void each_point(std::size_t count, const Visit& visit) {
  parallel_each(count, 4096, visit);
}

color::Rgb half(const Predicted& p, std::size_t which) {
  return {p[3 * which], p[3 * which + 1], p[3 * which + 2]};
}
color::Rgb mean_of(const Predicted& p) {
  return 0.5 * (half(p, 0) + half(p, 1));
}

bool at_edge(const ShownPoint& point) {
  return !point.pieces.empty();
}

// An element of a SurfaceImage, which shows nothing where its weight is 0.
template <std::size_t kChannels>
struct Element {
  float weight = 0, part = 0;
  std::array<float, 2> shift = {};
  std::array<float, 3> normal = {}, position = {};
  std::array<float, kChannels> value = {};
};

template <std::size_t kChannels>
Element<kChannels> element(const ShownPiece& piece, const std::array<float, kChannels>& value) {
  const rays::Float3 &n = piece.normal, &p = piece.position;
  return {1, static_cast<float>(piece.part), {}, {n.x, n.y, n.z}, {p.x, p.y, p.z}, value};
}

template <std::size_t kChannels>
Element<kChannels> element(const SurfaceImage& image, std::size_t i) {
  Element<kChannels> e;
  e.weight = image.weight[i], e.part = image.part[i];
  for (std::size_t c = 0; c < 2; ++c) e.shift[c] = image.shift[c][i];
  for (std::size_t c = 0; c < 3; ++c) e.normal[c] = image.normal[c][i], e.position[c] = image.position[c][i];
  for (std::size_t c = 0; c < kChannels; ++c) e.value[c] = image.value[c][i];
  return e;
}

template <std::size_t kChannels>
void put(const Element<kChannels>& e, SurfaceImage& image, std::size_t i) {
  image.weight[i] = e.weight, image.part[i] = e.part;
  for (std::size_t c = 0; c < 2; ++c) image.shift[c][i] = e.shift[c];
  for (std::size_t c = 0; c < 3; ++c) image.normal[c][i] = e.normal[c], image.position[c][i] = e.position[c];
  for (std::size_t c = 0; c < kChannels; ++c) image.value[c][i] = e.value[c];
}

// An element of the coarser image is the mean of those of its four that lie on one piece of surface.
template <std::size_t kChannels>
Element<kChannels> mean_of(const std::array<Element<kChannels>, 4>& fine) {
  const Element<kChannels>& pivot = *std::ranges::max_element(fine, {}, &Element<kChannels>::weight);
  Element<kChannels> mean;
  if (!(pivot.weight > 0)) return mean;
  mean.part = pivot.part;
  for (std::size_t k = 0; k < 4; ++k) {
    const Element<kChannels>& of = fine[k];
    float turn = 0;
    for (std::size_t c = 0; c < 3; ++c) turn += of.normal[c] * pivot.normal[c];
    if (!(of.weight > 0) || of.part != pivot.part || turn < kSamePiece) continue;
    mean.weight += of.weight;
    mean.shift[0] += of.weight * (static_cast<float>(k % 2) - 0.5F + of.shift[0]) / 2;
    mean.shift[1] += of.weight * (static_cast<float>(k / 2) - 0.5F + of.shift[1]) / 2;
    for (std::size_t c = 0; c < 3; ++c)
      mean.normal[c] += of.weight * of.normal[c], mean.position[c] += of.weight * of.position[c];
    for (std::size_t c = 0; c < kChannels; ++c) mean.value[c] += of.weight * of.value[c];
  }
  float length = 0;
  for (const float along : mean.normal) length += along * along;
  length = std::sqrt(length);
  for (float& along : mean.normal) along /= length;
  for (float& along : mean.position) along /= mean.weight;
  for (float& by : mean.shift) by /= mean.weight;
  for (float& value : mean.value) value /= mean.weight;
  return mean;
}

// Calls of(x, y) for the four elements beneath one of the coarser image.
template <class Of>
auto mean_below(int x, int y, const Of& of) {
  return mean_of(std::array{of(2 * x, 2 * y), of(2 * x + 1, 2 * y), of(2 * x, 2 * y + 1), of(2 * x + 1, 2 * y + 1)});
}

SurfaceImage coarser(const SurfaceImage& fine) {
  SurfaceImage image((fine.width + 1) / 2, (fine.height + 1) / 2, kHalvesChannels);
  for_pixels(image.width, image.height, [&](int x, int y) {
    put(mean_below(x, y, [&](int u, int v) { return element<kHalvesChannels>(fine, fine.at(u, v)); }), image,
        image.at(x, y));
  });
  return image;
}

// Linear functions of half lights, or means of errors, around each element of some rows of an image, which lies on a
// level of the pyramid.
template <class Value>
class Fits {
 public:
  Fits(const SurfaceImage& image, const Filter& filter, int begin, int end)
      : image_(image),
        filter_(filter),
        begin_(begin),
        coefficients_(kCoefficients * static_cast<std::size_t>(image.width * (end - begin))) {
    for (int y = begin; y < end; ++y) (kFeatures > 1 ? fit_row : mean_row)(image, filter.window, y, coefficients(0, y));
  }

  Value at(const ShownPoint& point) const {
    if (!at_edge(point)) return of_piece(point);
    Value sum{};
    for (const ShownPiece& piece : point.pieces) {
      const Value one = about(point.x, point.y, piece, kFarReach);
      for (std::size_t c = 0; c < kChannels; ++c) sum[c] += piece.share * one[c];
    }
    return sum;
  }
  // The light of its one piece, as if it were at no edge.
  Value of_piece(const ShownPoint& point) const {
    if (filter_.level == 0 && image_.weight[image_.at(point.x, point.y)] > 0) return own(point);
    return about(point.x, point.y, point.piece, filter_.level == 0 ? kFarReach : kNearReach);
  }

 private:
  static constexpr std::size_t kChannels = std::tuple_size_v<Value>,
                               kFeatures = kChannels == kHalvesChannels ? kSurfaceFeatures : 1,
                               kCoefficients = kFeatures * kChannels;

  // By feature and channel.
  const float* coefficients(int x, int y) const { return &coefficients_[kCoefficients * place(x, y)]; }
  float* coefficients(int x, int y) { return &coefficients_[kCoefficients * place(x, y)]; }
  std::size_t place(int x, int y) const { return static_cast<std::size_t>((y - begin_) * image_.width + x); }
  Value own(const ShownPoint& point) const {
    Value result;
    std::copy_n(coefficients(point.x, point.y), kChannels, result.begin());
    return result;
  }

  // Elements that lie nearer, each way, tell a pixel, and those that lie further off where the nearest may be of
  // another piece or without samples.
  static constexpr float kNearReach = 1, kFarReach = 1.5F;

  // The mean of what the elements about a pixel tell of a piece of surface in it; not a number where none does.
  Value about(int pixel_x, int pixel_y, const ShownPiece& piece, float reach) const {
    const int count = static_cast<int>(2 * reach);
    const auto size = static_cast<float>(1 << filter_.level);
    const float u = (static_cast<float>(pixel_x) + 0.5F) / size - 0.5F,
                v = (static_cast<float>(pixel_y) + 0.5F) / size - 0.5F;
    const int left = static_cast<int>(std::ceil(u - reach)), top = static_cast<int>(std::ceil(v - reach));
    Value sum{};
    float weights = 0;
    for (int y = std::max(0, top); y < std::min(image_.height, top + count); ++y)
      for (int x = std::max(0, left); x < std::min(image_.width, left + count); ++x)
        weights += add(x, y, u - static_cast<float>(x), v - static_cast<float>(y), piece, reach, sum);
    const float per_weight = weights > 1e-3F ? 1 / weights : kNowhere;
    for (float& value : sum) value *= per_weight;
    return sum;
  }

  // Adds what the fit of an element tells, and returns the weight of that.
  float add(int x, int y, float right, float down, const ShownPiece& piece, float reach, Value& sum) const {
    const std::size_t i = image_.at(x, y);
    if (!(image_.weight[i] > 0) || image_.part[i] != static_cast<float>(piece.part)) return 0;
    const rays::Float3 normal{image_.normal[0][i], image_.normal[1][i], image_.normal[2][i]},
        position{image_.position[0][i], image_.position[1][i], image_.position[2][i]};
    const rays::Float3 turned = piece.normal - normal, way = piece.position - position;
    const float across = right - image_.shift[0][i], below = down - image_.shift[1][i];
    // The direction of the way tells nothing at the middle of the element's points, which on a bent surface lies off
    // it.
    const float off = rays::dot(way, normal), off_plane = off * off / (rays::dot(way, way) + 1e-20F);
    const float far = per_normal_ * per_normal_ * rays::dot(turned, turned) +
                      std::min(1.0F, across * across + below * below) * per_plane_ * per_plane_ * off_plane;
    if (far >= 1) return 0;
    const float weight = (reach - std::abs(right)) * (reach - std::abs(down)) * (1 - far) * (1 - far);
    if (!(weight > 0)) return 0;
    std::array<float, kFeatures> feature = {weight};
    if constexpr (kFeatures > 1) {
      const float place = weight * per_reach_, turn = weight * per_normal_;
      const rays::Frame tangents = rays::frame_about(normal);
      feature = {weight, place * across, place * below, turn * rays::dot(turned, tangents.x),
                 turn * rays::dot(turned, tangents.y)};
    }
    const float* fitted = coefficients(x, y);
    for (std::size_t f = 0; f < kFeatures; ++f)
      for (std::size_t c = 0; c < kChannels; ++c) sum[c] += feature[f] * *fitted++;
    return weight;
  }

  const SurfaceImage& image_;
  const Filter& filter_;
  int begin_;  // the first row
  const float per_reach_ = 1 / (static_cast<float>(filter_.window.reach) + 0.5F),
              per_normal_ = 1 / filter_.window.normal, per_plane_ = 1 / filter_.window.plane;
  UnsetArray<float> coefficients_;  // by element
};

// Calls visit(fits, n) for each point, where the fits have the rows about it: bands of rows are fitted one by one,
// because the functions of a whole image fill more memory than all else.
template <class Value, class Visit>
void each_fit(const Filter& filter, const SurfaceImage& image, const std::vector<ShownPoint>& points,
              const Visit& visit) {
  constexpr int kAround = 1;  // rows on each side of those in which points lie
  const int rows = std::max(4, 32 >> filter.level), bands = (image.height + rows - 1) / rows;
  parallel_for(static_cast<std::size_t>(bands), 1, [&](std::size_t first, std::size_t last) {
    for (int band = static_cast<int>(first); band < static_cast<int>(last); ++band) {
      const int begin = band * rows, end = std::min(image.height, begin + rows);
      const Fits<Value> fits(image, filter, std::max(0, begin - kAround), std::min(image.height, end + kAround));
      auto point = std::ranges::lower_bound(points, begin << filter.level, {}, &ShownPoint::y);
      for (; point != points.end() && point->y >> filter.level < end; ++point)
        visit(fits, static_cast<std::size_t>(point - points.begin()));
    }
  });
}

// Two halves as they are seen, so that squares of differences are those of CIEDE2000.
using SeenHalves = std::array<Vec3, 2>;

double square(const Vec3& v) {
  return dot(v, v);
}

// The variance of the mean of two halves, whose difference is noise alone.
double variance(const SeenHalves& halves) {
  return 0.25 * square(halves[0] - halves[1]);
}

// The squared bias of a filter beside a reference: each filtered half differs from the other half of the reference by
// the bias, by the noise that the filter leaves of one, and by that of the other. Its expectation is exact, and it may
// be negative.
double squared_bias(const SeenHalves& reference, const SeenHalves& filtered) {
  return 0.5 * (square(filtered[0] - reference[1]) + square(filtered[1] - reference[0])) -
         2 * (variance(reference) + variance(filtered));
}

// Errors of all choices.
using Values = std::array<float, kChoices>;
// Variances, and then squared biases. The samples have none; their place takes the variance of a single one, since
// neighbors may have more or fewer of them.
using Errors = std::array<float, 2 * kChoices>;
constexpr std::size_t kOfOneSample = kChoices;
static_assert(kChoices == kHalvesChannels);

// The reference of the wider filters is the smallest one, whose noise is less than that of the samples.
std::size_t reference_of(std::size_t choice) {
  return choice > 1 ? 1 : 0;
}

// Measurements at each point from which the errors of all choices follow.
struct Measured {
  std::vector<Values> variances, apart;  // apart: squared differences from the references
  std::vector<Errors> means;             // over neighborhoods
};

using Predictions = std::array<std::vector<Predicted>, kChoices>;

std::array<int, 2> size_of(const std::vector<ShownPoint>& points) {
  if (points.empty()) return {0, 0};
  return {std::ranges::max(points, {}, &ShownPoint::x).x + 1, points.back().y + 1};
}

Predictions all_predictions(const std::vector<ShownPoint>& points, const std::vector<Halves>& halves) {
  const auto [width, height] = size_of(points);
  Predictions predicted;
  predicted[0].resize(points.size());
  each_point(points.size(), [&](std::size_t n) {
    for (std::size_t c = 0; c < kHalvesChannels; ++c)
      predicted[0][n][c] = static_cast<float>(halves[n][c / 3][static_cast<int>(c % 3)]);
  });
  SurfaceImage image(width, height, kHalvesChannels);
  each_point(points.size(), [&](std::size_t n) {
    if (at_edge(points[n]) || std::isnan(predicted[0][n][0])) return;
    put(element(points[n].piece, predicted[0][n]), image, image.at(points[n].x, points[n].y));
  });
  for (int level = 0; level < kLevels; ++level) {
    if (level > 0) image = coarser(image);
    for (std::size_t f = 0; f < kFilters.size(); ++f) {
      if (kFilters[f].level != level) continue;
      predicted[f + 1].resize(points.size());
      each_fit<Predicted>(kFilters[f], image, points,
                          [&](const auto& fits, std::size_t n) { predicted[f + 1][n] = fits.at(points[n]); });
    }
  }
  return predicted;
}

// Errors at points become means over their neighborhoods. Those at edges are no mean of those beside them, so that each
// kind has an image of its own, in which the few points at edges are not lost among the others.
void take_neighborhood_means(const std::vector<ShownPoint>& points, std::vector<Errors>& errors) {
  static_assert(kErrorMean.level == 2);
  const auto [width, height] = size_of(points);
  std::vector<const Errors*> by_pixel(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), nullptr);
  const auto place = [width = width](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  for (const bool at_edges : {false, true}) {
    each_point(points.size(), [&](std::size_t n) {
      const bool is_part = at_edge(points[n]) == at_edges && !std::isnan(errors[n][0]);
      by_pixel[place(points[n].x, points[n].y)] = is_part ? &errors[n] : nullptr;
    });
    const auto pixel = [&, width = width, height = height](int x, int y) {
      const Errors* const own = x < width && y < height ? by_pixel[place(x, y)] : nullptr;
      return own != nullptr ? element(points[static_cast<std::size_t>(own - errors.data())].piece, *own)
                            : Element<2 * kChoices>();
    };
    SurfaceImage image((width + 3) / 4, (height + 3) / 4, 2 * kChoices);
    for_pixels(image.width, image.height, [&](int x, int y) {
      put(mean_below(x, y, [&](int u, int v) { return mean_below(u, v, pixel); }), image, image.at(x, y));
    });
    each_fit<Errors>(kErrorMean, image, points, [&](const auto& fits, std::size_t n) {
      if (at_edge(points[n]) != at_edges) return;
      if (const Errors mean = fits.of_piece(points[n]); !std::isnan(mean[0])) errors[n] = mean;
    });
  }
}

// Measures all choices. The visibility of an error is taken at filtered light, which has less noise than its samples.
Measured measured(const std::vector<ShownPoint>& points, const Predictions& predicted,
                  const std::vector<color::Rgb>& beside, double white_luminance, const std::vector<float>& samples) {
  const auto count = [&](std::size_t n) { return samples.empty() ? 1 : samples[n]; };
  Measured result;
  result.apart.resize(points.size()), result.variances.resize(points.size()), result.means.resize(points.size());
  each_point(points.size(), [&](std::size_t n) {
    std::size_t finest = 2;  // of the filters that tell this point
    while (finest < kChoices && std::isnan(predicted[finest][n][0])) ++finest;
    const Predicted& smooth = predicted[finest < kChoices ? finest : 0][n];
    const color::Rgb shown = beside[n] + mean_of(smooth);
    const SeenRows seen({std::max(0.0, shown.x), std::max(0.0, shown.y), std::max(0.0, shown.z)}, white_luminance);
    Values &variances = result.variances[n], &apart = result.apart[n];
    Errors& errors = result.means[n];
    std::array<SeenHalves, kChoices> halves;
    for (std::size_t k = 0; k < kChoices; ++k)
      halves[k] = {seen.along(half(predicted[k][n], 0)), seen.along(half(predicted[k][n], 1))};
    const bool is_sampled = !std::isnan(predicted[0][n][0]);
    for (std::size_t k = 0; k < kChoices; ++k) {
      const SeenHalves &one = halves[k], &reference = halves[reference_of(k)];
      const bool is_known = !std::isnan(predicted[k][n][0]) && !std::isnan(predicted[reference_of(k)][n][0]);
      // A point without samples is no part of neighborhoods. Its filters have variances that neighbors tell.
      variances[k] = static_cast<float>(variance(is_known || !is_sampled ? one : halves[0]));
      errors[k] = variances[k];
      errors[kChoices + k] = is_known ? static_cast<float>(squared_bias(reference, one)) : 0;
      const Vec3 twice = one[0] + one[1] - reference[0] - reference[1];
      apart[k] = is_known ? static_cast<float>(0.25 * square(twice)) : 0;
    }
    errors[kOfOneSample] = errors[0] * count(n);
  });
  take_neighborhood_means(points, result.means);
  each_point(points.size(), [&](std::size_t n) {
    Errors& mean = result.means[n];
    float& smallest = mean[kChoices + 1];
    const float believed = kMostOfNext * std::max(0.0F, mean[kChoices + 2]);
    smallest = std::min(smallest, std::max(believed, smallest - kOfSamples * mean[0]));
    if (count(n) > 0) mean[0] = mean[kOfOneSample] / count(n);
    mean[kOfOneSample] = 0;
  });
  return result;
}

// The squared error of a choice at a point, where it is a number.
float squared_error(const Measured& measured, std::size_t n, std::size_t choice) {
  const Errors& mean = measured.means[n];
  if (std::isnan(mean[0])) return HUGE_VALF;
  const Values& own = measured.variances[n];
  const std::size_t reference = reference_of(choice);
  float bias = std::max(0.0F, mean[kChoices + choice]);
  if (reference > 0) bias += std::max(0.0F, mean[kChoices + reference]);
  const float noise = std::max(mean[choice], own[choice]) + std::max(mean[reference], own[reference]);
  bias = std::max(bias, measured.apart[n][choice] - kSurprise * noise);
  return std::max({mean[choice], own[choice] / kSpike, 1e-6F}) + bias;
}

}  // namespace

Reconstruction reconstruction(const std::vector<ShownPoint>& points, const std::vector<Halves>& halves,
                              const std::vector<color::Rgb>& beside, double white_luminance,
                              const std::vector<float>& samples, Filters filters) {
  const Predictions predicted = all_predictions(points, halves);
  const Measured errors = measured(points, predicted, beside, white_luminance, samples);
  Reconstruction result;
  result.light.resize(points.size()), result.error_de00.resize(points.size());
  result.spike_de00.resize(points.size()), result.shares.resize(points.size());
  each_point(points.size(), [&](std::size_t n) {
    Values error{};
    for (std::size_t k = 0; k < kChoices; ++k)
      error[k] = std::isnan(predicted[k][n][0]) ? HUGE_VALF : squared_error(errors, n, k);
    if (filters == Filters::kNone) {
      error.fill(HUGE_VALF);
      if (!std::isnan(predicted[0][n][0])) error[0] = std::max(errors.means[n][0], 1e-6F);
    }
    // Between samples the smallest filter, which sees few of them, follows their noise.
    if (std::isnan(predicted[0][n][0]) && std::isfinite(error[2])) error[1] = HUGE_VALF;
    const float own = errors.variances[n][0];
    if (filters == Filters::kChosen && own > kLargePart * errors.means[n][0]) result.spike_de00[n] = std::sqrt(own);
    const float least = *std::ranges::min_element(error);
    if (std::isinf(least)) {
      result.error_de00[n] = HUGE_VALF;
      return;
    }
    double weights = 0, squared = 0;
    for (std::size_t k = 0; k < kChoices; ++k) {
      if (std::isinf(error[k])) continue;
      const double ratio = least / error[k], weight = ratio * ratio * ratio * ratio;
      weights += weight, squared += weight * error[k];
      result.light[n] += weight * mean_of(predicted[k][n]);
      result.shares[n][k] = static_cast<float>(weight);
    }
    result.light[n] = (1 / weights) * result.light[n];
    for (float& share : result.shares[n]) share = static_cast<float>(share / weights);
    result.error_de00[n] = static_cast<float>(std::sqrt(squared / weights));
  });
  return result;
}

std::vector<Halves> smoothed(const std::vector<ShownPoint>& points, const std::vector<Halves>& lights,
                             const std::array<const std::vector<FilterShares>*, 2>& shares) {
  const Predictions predicted = all_predictions(points, lights);
  std::vector<Halves> result(points.size());
  each_point(points.size(), [&](std::size_t n) {
    for (std::size_t which = 0; which < 2; ++which)
      for (std::size_t k = 0; k < kChoices; ++k)
        if (const float share = (*shares[which])[n][k]; share > 0)
          result[n][which] += static_cast<double>(share) * half(predicted[k][n], which);
  });
  return result;
}

}  // namespace goniochrome::render
