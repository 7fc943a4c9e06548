// MERL 100 tables: 90 x 90 x 180 bins of half and difference angles, red, green and blue one after the other.
#include <array>
#include <cmath>

#include "base/angles.h"
#include "brdf/internal/measured_formats.h"

namespace goniochrome::brdf {

namespace {

constexpr std::size_t kHalf = 90, kDifference = 90, kAzimuth = 180, kBins = kHalf * kDifference * kAzimuth;
constexpr std::size_t kHeader = 3 * sizeof(std::int32_t);
// Factors that turn the stored doubles into 1/sr ([Matusik2003], the data's own reader).
constexpr std::array<double, 3> kScale = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

// Rusinkiewicz's angles of a pair: half vector from the normal; light from the half vector, and its azimuth about it,
// where a swap of light and viewer adds pi.
struct HalfDifference {
  double half, difference, azimuth;  // radians; azimuth 0..pi
};

HalfDifference half_difference(const Vec3& light, const Vec3& view) {
  const Vec3 sum = light + view, across = light - view;
  const double horizontal = std::hypot(sum.x, sum.y);
  const Vec3 ahead = horizontal > 0 ? Vec3{sum.x / horizontal, sum.y / horizontal, 0} : Vec3{1, 0, 0};
  const Vec3 beside = {-ahead.y, ahead.x, 0};
  const Vec3 half = normalized(sum);
  const Vec3 down = half.z * ahead - Vec3{0, 0, std::hypot(half.x, half.y)};
  double azimuth = std::atan2(dot(across, beside), dot(across, down));
  if (azimuth < 0) azimuth += kPi;
  return {std::atan2(horizontal, sum.z), std::atan2(length(across), length(sum)), azimuth};
}

class MerlBrdf final : public MeasuredBrdf {
 public:
  MerlBrdf(MeasuredTraits traits, std::vector<double> bins) : MeasuredBrdf(std::move(traits)), bins_(std::move(bins)) {}

  MeasuredValue value(const Vec3& light, const Vec3& view) const override {
    HalfDifference angles = half_difference(light, view);
    MeasuredValue result = interpolated(angles);
    angles.azimuth = kPi - angles.azimuth;  // the mirror image
    const MeasuredValue mirrored = interpolated(angles);
    if (!result.measured) return mirrored;
    if (mirrored.measured)
      for (std::size_t c = 0; c < 3; ++c) result.f[c] = (result.f[c] + mirrored.f[c]) / 2;
    return result;
  }

 private:
  // Bin i covers [i, i+1) of its angle's index, so its value stands at i + 1/2; the half angle's index grows with the
  // square root. A negative bin marks a pair that was not measured and takes no part.
  MeasuredValue interpolated(const HalfDifference& angles) const {
    constexpr double kQuarter = kPi / 2;
    const double half_index = std::sqrt(angles.half / kQuarter) * kHalf - 0.5;
    const double difference_index = angles.difference / kQuarter * kDifference - 0.5;
    const double azimuth_index = angles.azimuth / kPi * kAzimuth - 0.5;
    const Cell half = cell_at(half_index, kHalf), difference = cell_at(difference_index, kDifference);
    const double turn = azimuth_index - std::floor(azimuth_index);
    const auto first = static_cast<std::size_t>(std::floor(azimuth_index) + kAzimuth) % kAzimuth;

    MeasuredValue result{.f = {0, 0, 0}};
    std::array<double, 3> total{};
    for (int corner = 0; corner < 8; ++corner) {
      const std::size_t h = half.low + (corner & 1), d = difference.low + (corner >> 1 & 1);
      const std::size_t a = (first + (corner >> 2)) % kAzimuth;
      const double weight = (corner & 1 ? half.weight : 1 - half.weight) *
                            (corner & 2 ? difference.weight : 1 - difference.weight) * (corner & 4 ? turn : 1 - turn);
      for (std::size_t c = 0; weight > 0 && c < 3; ++c) {
        const double f = bins_[c * kBins + (h * kDifference + d) * kAzimuth + a];
        if (f < 0) continue;
        result.f[c] += weight * f;
        total[c] += weight;
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      result.measured = result.measured && total[c] > 0;
      if (total[c] > 0) result.f[c] *= kScale[c] / total[c];
    }
    if (!result.measured) result.f.assign(3, 0.0);
    const auto off_center = [](double index) { return std::abs(index - std::round(index)) > 1e-6; };
    if (off_center(half_index) || off_center(difference_index) || off_center(azimuth_index)) {
      // The coarsest step: one degree of difference angle, or that of the half angle, which widens with its root.
      const double index = half_index + 0.5;
      result.gap_deg = std::max(1.0, (2 * index + 1) / kHalf);
    }
    return result;
  }

  std::vector<double> bins_;
};

bool looks_merl(std::string_view, std::string_view head) {
  ByteReader reader(head);
  return reader.next<std::int32_t>() == 90 && reader.next<std::int32_t>() == 90 && reader.next<std::int32_t>() == 180;
}

Result<MeasuredPointer> read_merl(const std::string& path, std::string_view bytes) {
  if (bytes.size() != kHeader + 3 * kBins * sizeof(double))
    return input_error("{}: {} bytes where a MERL table of 90 x 90 x 180 bins has {}: the file is cut or not MERL",
                       path, bytes.size(), kHeader + 3 * kBins * sizeof(double));
  MeasuredTraits traits{.format = "merl"};
  traits.symmetric = true;
  double negative_square = 0;
  std::vector<double> bins(3 * kBins);
  std::memcpy(bins.data(), bytes.data() + kHeader, bins.size() * sizeof(double));
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (!std::isfinite(bins[i])) return input_error("{}: value {} is not finite", path, i);
    count_sample(bins[i], traits, negative_square);
  }
  if (traits.negative == traits.samples) return input_error("{}: every value is negative: nothing was measured", path);
  return MeasuredPointer(std::make_unique<MerlBrdf>(std::move(traits), std::move(bins)));
}

}  // namespace

const MeasuredFormat kMerl = {looks_merl, read_merl, "MERL .binary"};

}  // namespace goniochrome::brdf
