#include "render/path/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
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
constexpr Filter kErrorMean = {2, {3, 0.25F, 0.5F, kNoSlopes}};
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

bool at_edge(const ShownPoint& point) {
  return !point.pieces.empty();
}

// The image of the points at edges or of all others, without those that have no value.
SurfaceImage image_of(int width, int height, const std::vector<ShownPoint>& points,
                      const std::vector<Predicted>& values, bool at_edges) {
  SurfaceImage image(width, height);
  each_point(points.size(), [&](std::size_t n) {
    if (at_edge(points[n]) != at_edges || std::isnan(values[n][0])) return;
    const ShownPiece& p = points[n].piece;
    const std::size_t i = image.at(points[n].x, points[n].y);
    image.weight[i] = 1, image.part[i] = static_cast<float>(p.part);
    image.normal[0][i] = p.normal.x, image.normal[1][i] = p.normal.y, image.normal[2][i] = p.normal.z;
    image.position[0][i] = p.position.x, image.position[1][i] = p.position.y, image.position[2][i] = p.position.z;
    for (std::size_t c = 0; c < kHalvesChannels; ++c) image.value[c][i] = values[n][c];
  });
  return image;
}

// An element of the coarser image is the mean of those of its four that lie on one piece of surface.
void average(const SurfaceImage& fine, int x, int y, SurfaceImage& image) {
  std::size_t pivot = fine.at(2 * x, 2 * y);
  for (int k = 1; k < 4; ++k) {
    const std::size_t j = fine.at(2 * x + k % 2, 2 * y + k / 2);
    if (fine.weight[j] > fine.weight[pivot]) pivot = j;
  }
  if (!(fine.weight[pivot] > 0)) return;
  const std::size_t i = image.at(x, y);
  image.part[i] = fine.part[pivot];
  float sum = 0;
  for (int k = 0; k < 4; ++k) {
    const std::size_t j = fine.at(2 * x + k % 2, 2 * y + k / 2);
    const float weight = fine.weight[j];
    float turn = 0;
    for (std::size_t c = 0; c < 3; ++c) turn += fine.normal[c][j] * fine.normal[c][pivot];
    if (!(weight > 0) || fine.part[j] != fine.part[pivot] || turn < kSamePiece) continue;
    sum += weight;
    image.shift[0][i] += weight * (static_cast<float>(k % 2) - 0.5F + fine.shift[0][j]) / 2;
    image.shift[1][i] += weight * (static_cast<float>(k / 2) - 0.5F + fine.shift[1][j]) / 2;
    for (std::size_t c = 0; c < 3; ++c)
      image.normal[c][i] += weight * fine.normal[c][j], image.position[c][i] += weight * fine.position[c][j];
    for (std::size_t c = 0; c < kHalvesChannels; ++c) image.value[c][i] += weight * fine.value[c][j];
  }
  image.weight[i] = sum;
  float length = 0;
  for (std::size_t c = 0; c < 3; ++c) length += image.normal[c][i] * image.normal[c][i];
  length = std::sqrt(length);
  for (std::size_t c = 0; c < 3; ++c) image.normal[c][i] /= length, image.position[c][i] /= sum;
  for (auto& plane : image.shift) plane[i] /= sum;
  for (auto& plane : image.value) plane[i] /= sum;
}

SurfaceImage coarser(const SurfaceImage& fine) {
  SurfaceImage image((fine.width + 1) / 2, (fine.height + 1) / 2);
  for_pixels(image.width, image.height, [&](int x, int y) { average(fine, x, y, image); });
  return image;
}

// The linear functions around each element of some rows of an image, which lies on a level of the pyramid.
class Fits {
 public:
  Fits(const SurfaceImage& image, const Filter& filter, int begin, int end)
      : image_(image), filter_(filter), begin_(begin) {
    const auto width = static_cast<std::size_t>(image.width);
    const std::size_t row = (width + SurfaceImage::kLanes - 1) / SurfaceImage::kLanes * SurfaceImage::kLanes;
    coefficients_.reserve(kCoefficients * width * static_cast<std::size_t>(end - begin));
    std::vector<float> planes(kCoefficients * row);
    std::array<float*, kCoefficients> plane{};
    for (std::size_t k = 0; k < kCoefficients; ++k) plane[k] = &planes[k * row];
    for (int y = begin; y < end; ++y) {
      fit_row(image, filter.window, y, plane.data());
      for (std::size_t x = 0; x < width; ++x)
        for (std::size_t k = 0; k < kCoefficients; ++k) coefficients_.push_back(plane[k][x]);
    }
  }

  Predicted at(const ShownPoint& point) const {
    if (!at_edge(point)) return of_piece(point);
    Predicted sum{};
    for (const ShownPiece& piece : point.pieces) {
      const Predicted one = about(point.x, point.y, piece, kFarReach);
      for (std::size_t c = 0; c < kHalvesChannels; ++c) sum[c] += piece.share * one[c];
    }
    return sum;
  }
  // The light of its one piece, as if it were at no edge.
  Predicted of_piece(const ShownPoint& point) const {
    if (filter_.level == 0 && image_.weight[image_.at(point.x, point.y)] > 0) return own(point);
    return about(point.x, point.y, point.piece, filter_.level == 0 ? kFarReach : kNearReach);
  }

 private:
  static constexpr std::size_t kCoefficients = kSurfaceFeatures * kHalvesChannels;

  // By feature and channel.
  const float* coefficients(int x, int y) const {
    const auto width = static_cast<std::size_t>(image_.width);
    return &coefficients_[kCoefficients * (static_cast<std::size_t>(y - begin_) * width + static_cast<std::size_t>(x))];
  }
  Predicted own(const ShownPoint& point) const {
    Predicted result;
    std::copy_n(coefficients(point.x, point.y), kHalvesChannels, result.begin());
    return result;
  }

  // Elements that lie nearer, each way, tell a pixel, and those that lie further off where the nearest may be of
  // another piece or without samples.
  static constexpr float kNearReach = 1, kFarReach = 1.5F;

  // The mean of what the elements about a pixel tell of a piece of surface in it; not a number where none does.
  Predicted about(int pixel_x, int pixel_y, const ShownPiece& piece, float reach) const {
    const int count = static_cast<int>(2 * reach);
    const auto size = static_cast<float>(1 << filter_.level);
    const float u = (static_cast<float>(pixel_x) + 0.5F) / size - 0.5F,
                v = (static_cast<float>(pixel_y) + 0.5F) / size - 0.5F;
    const int left = static_cast<int>(std::ceil(u - reach)), top = static_cast<int>(std::ceil(v - reach));
    Predicted sum{};
    float weights = 0;
    for (int y = std::max(0, top); y < std::min(image_.height, top + count); ++y)
      for (int x = std::max(0, left); x < std::min(image_.width, left + count); ++x)
        weights += add(x, y, u - static_cast<float>(x), v - static_cast<float>(y), piece, reach, sum);
    for (float& value : sum) value = weights > 1e-3F ? value / weights : kNowhere;
    return sum;
  }

  // Adds what the fit of an element tells, and returns the weight of that.
  float add(int x, int y, float right, float down, const ShownPiece& piece, float reach, Predicted& sum) const {
    const std::size_t i = image_.at(x, y);
    if (!(image_.weight[i] > 0) || image_.part[i] != static_cast<float>(piece.part)) return 0;
    const RegressionWindow& window = filter_.window;
    const rays::Float3 normal{image_.normal[0][i], image_.normal[1][i], image_.normal[2][i]},
        position{image_.position[0][i], image_.position[1][i], image_.position[2][i]};
    const rays::Float3 turned = piece.normal - normal, way = piece.position - position;
    const float across = right - image_.shift[0][i], below = down - image_.shift[1][i];
    // The direction of the way tells nothing at the middle of the element's points, which on a bent surface lies off
    // it.
    const float off = rays::dot(way, normal), off_plane = off * off / (rays::dot(way, way) + 1e-20F);
    const float far = rays::dot(turned, turned) / (window.normal * window.normal) +
                      std::min(1.0F, across * across + below * below) * off_plane / (window.plane * window.plane);
    if (far >= 1) return 0;
    const float weight = (reach - std::abs(right)) * (reach - std::abs(down)) * (1 - far) * (1 - far);
    if (!(weight > 0)) return 0;
    const float scale = 1.0F / (static_cast<float>(window.reach) + 0.5F);
    const rays::Frame tangents = rays::frame_about(normal);
    const std::array<float, kSurfaceFeatures> feature = {1, scale * across, scale * below,
                                                         rays::dot(turned, tangents.x) / window.normal,
                                                         rays::dot(turned, tangents.y) / window.normal};
    const float* fitted = coefficients(x, y);
    for (std::size_t f = 0; f < kSurfaceFeatures; ++f)
      for (std::size_t c = 0; c < kHalvesChannels; ++c) sum[c] += weight * feature[f] * *fitted++;
    return weight;
  }

  const SurfaceImage& image_;
  const Filter& filter_;
  int begin_;                        // the first row
  std::vector<float> coefficients_;  // by element
};

// Calls visit(fits, n) for each point, where the fits have the rows about it: bands of rows are fitted one by one,
// because the functions of a whole image fill more memory than all else.
template <class Visit>
void each_fit(const Filter& filter, const SurfaceImage& image, const std::vector<ShownPoint>& points,
              const Visit& visit) {
  constexpr int kAround = 1;  // rows on each side of those in which points lie
  const int rows = std::max(16, 64 >> filter.level), bands = (image.height + rows - 1) / rows;
  parallel_for(static_cast<std::size_t>(bands), 1, [&](std::size_t first, std::size_t last) {
    for (int band = static_cast<int>(first); band < static_cast<int>(last); ++band) {
      const int begin = band * rows, end = std::min(image.height, begin + rows);
      const Fits fits(image, filter, std::max(0, begin - kAround), std::min(image.height, end + kAround));
      auto point = std::ranges::lower_bound(points, begin << filter.level, {}, &ShownPoint::y);
      for (; point != points.end() && point->y >> filter.level < end; ++point)
        visit(fits, static_cast<std::size_t>(point - points.begin()));
    }
  });
}

// The variance of the mean of two halves, whose difference is noise alone.
double variance(const SeenRows& seen, const Predicted& halves) {
  return 0.25 * seen.square(half(halves, 0) - half(halves, 1));
}

// The squared bias of a filter beside a reference: each filtered half differs from the other half of the reference by
// the bias, by the noise that the filter leaves of one, and by that of the other. Its expectation is exact, and it may
// be negative.
double squared_bias(const SeenRows& seen, const Predicted& reference, const Predicted& filtered) {
  return 0.5 * (seen.square(half(filtered, 0) - half(reference, 1)) +
                seen.square(half(filtered, 1) - half(reference, 0))) -
         2 * (variance(seen, reference) + variance(seen, filtered));
}

using Values = std::array<float, kChoices>;
static_assert(kChoices == kHalvesChannels);

// The reference of the wider filters is the smallest one, whose noise is less than that of the samples.
std::size_t reference_of(std::size_t choice) {
  return choice > 1 ? 1 : 0;
}

// Measurements at each point from which the errors of all choices follow.
struct Measured {
  std::vector<SeenRows> seen;
  std::vector<Values> variances, mean_variances, mean_biases;
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
  SurfaceImage image = image_of(width, height, points, predicted[0], false);
  for (int level = 0; level < kLevels; ++level) {
    if (level > 0) image = coarser(image);
    for (std::size_t f = 0; f < kFilters.size(); ++f) {
      if (kFilters[f].level != level) continue;
      predicted[f + 1].resize(points.size());
      each_fit(kFilters[f], image, points,
               [&](const Fits& fits, std::size_t n) { predicted[f + 1][n] = fits.at(points[n]); });
    }
  }
  return predicted;
}

// Values at points become means over their neighborhoods. Errors at edges are no mean of those beside them, so that
// each kind has an image of its own, in which the few points at edges are not lost among the others.
void take_neighborhood_means(const std::vector<ShownPoint>& points, std::vector<Values>& values) {
  const auto [width, height] = size_of(points);
  for (const bool at_edges : {false, true}) {
    SurfaceImage image = image_of(width, height, points, values, at_edges);
    for (int level = 0; level < kErrorMean.level; ++level) image = coarser(image);
    each_fit(kErrorMean, image, points, [&](const Fits& fits, std::size_t n) {
      if (at_edge(points[n]) != at_edges) return;
      if (const Values mean = fits.of_piece(points[n]); !std::isnan(mean[0])) values[n] = mean;
    });
  }
}

// Measures all choices. The visibility of an error is taken at filtered light, which has less noise than its samples.
Measured measured(const std::vector<ShownPoint>& points, const Predictions& predicted,
                  const std::vector<color::Rgb>& beside, double white_luminance) {
  Measured result;
  result.seen.resize(points.size()), result.variances.resize(points.size()), result.mean_biases.resize(points.size());
  std::vector<Values>& biases = result.mean_biases;
  each_point(points.size(), [&](std::size_t n) {
    std::size_t finest = 2;  // of the filters that tell this point
    while (finest < kChoices && std::isnan(predicted[finest][n][0])) ++finest;
    const Predicted& smooth = predicted[finest < kChoices ? finest : 0][n];
    const color::Rgb shown = beside[n] + 0.5 * (half(smooth, 0) + half(smooth, 1));
    const SeenRows seen({std::max(0.0, shown.x), std::max(0.0, shown.y), std::max(0.0, shown.z)}, white_luminance);
    for (std::size_t k = 0; k < kChoices; ++k) {
      const Predicted &one = predicted[k][n], &reference = predicted[reference_of(k)][n];
      const bool known = !std::isnan(one[0]) && !std::isnan(reference[0]);
      result.variances[n][k] = static_cast<float>(variance(seen, known ? one : predicted[0][n]));
      biases[n][k] = known ? static_cast<float>(squared_bias(seen, reference, one)) : 0;
    }
    // A point without samples is no part of neighborhoods. Its filters have variances that neighbors tell.
    if (std::isnan(predicted[0][n][0])) {
      result.variances[n][0] = biases[n][0] = kNowhere;
      for (std::size_t k = 1; k < kChoices; ++k)
        if (!std::isnan(predicted[k][n][0]))
          result.variances[n][k] = static_cast<float>(variance(seen, predicted[k][n]));
    }
    result.seen[n] = seen;
  });
  take_neighborhood_means(points, biases);
  result.mean_variances = result.variances;
  take_neighborhood_means(points, result.mean_variances);
  each_point(points.size(), [&](std::size_t n) {
    float& smallest = biases[n][1];
    const float believed = kMostOfNext * std::max(0.0F, biases[n][2]);
    smallest = std::min(smallest, std::max(believed, smallest - kOfSamples * result.mean_variances[n][0]));
  });
  return result;
}

// The squared error of a choice at a point, where it is a number.
float squared_error(const Predictions& predicted, const Measured& measured, std::size_t n, std::size_t choice) {
  const Values& mean = measured.mean_variances[n];
  if (std::isnan(mean[0])) return HUGE_VALF;
  const Values& own = measured.variances[n];
  const std::size_t reference = reference_of(choice);
  float bias = std::max(0.0F, measured.mean_biases[n][choice]);
  if (reference > 0) bias += std::max(0.0F, measured.mean_biases[n][reference]);
  const Predicted &one = predicted[choice][n], &other = predicted[reference][n];
  if (choice > 0 && !std::isnan(other[0])) {
    const color::Rgb apart = 0.5 * (half(one, 0) + half(one, 1) - half(other, 0) - half(other, 1));
    const float noise = std::max(mean[choice], own[choice]) + std::max(mean[reference], own[reference]);
    bias = std::max(bias, static_cast<float>(measured.seen[n].square(apart)) - kSurprise * noise);
  }
  return std::max({mean[choice], own[choice] / kSpike, 1e-6F}) + bias;
}

}  // namespace

Reconstruction reconstruction(const std::vector<ShownPoint>& points, const std::vector<Halves>& halves,
                              const std::vector<color::Rgb>& beside, double white_luminance, Filters filters) {
  const Predictions predicted = all_predictions(points, halves);
  const Measured errors = measured(points, predicted, beside, white_luminance);
  Reconstruction result;
  result.light.resize(points.size()), result.error_de00.resize(points.size());
  result.spike_de00.resize(points.size()), result.shares.resize(points.size());
  each_point(points.size(), [&](std::size_t n) {
    Values error{};
    for (std::size_t k = 0; k < kChoices; ++k)
      error[k] = std::isnan(predicted[k][n][0]) ? HUGE_VALF : squared_error(predicted, errors, n, k);
    if (filters == Filters::kNone) {
      error.fill(HUGE_VALF);
      if (!std::isnan(predicted[0][n][0])) error[0] = std::max(errors.mean_variances[n][0], 1e-6F);
    }
    const float own = errors.variances[n][0];
    if (filters == Filters::kChosen && own > kLargePart * errors.mean_variances[n][0])
      result.spike_de00[n] = std::sqrt(own);
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
      result.light[n] += weight * 0.5 * (half(predicted[k][n], 0) + half(predicted[k][n], 1));
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
