#include "brdf/measured.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/file.h"
#include "base/text.h"
#include "brdf/internal/measured_formats.h"
#include "math/statistics.h"

namespace goniochrome::brdf {

namespace {

// The k-th point of van der Corput's sequence in a base: even coverage without chance.
double radical_inverse(int base, int k) {
  double result = 0, place = 1;
  for (; k > 0; k /= base) result += (place /= base) * (k % base);
  return result;
}

// f(a,b) and f(b,a), each the mean over the channels.
struct Swapped {
  double there, back, cos_there, cos_back;  // the cosine of the viewer's angle belongs to each
};

// |there - back| over their mean size, 0..2.
double disagreement(double there, double back) {
  const double size = (std::abs(there) + std::abs(back)) / 2;
  return size > 0 ? std::abs(there - back) / size : 0;
}

std::vector<Swapped> swapped_pairs(const MeasuredBrdf& brdf) {
  std::vector<Swapped> pairs;
  for (const paint::DirectionPair& pair : brdf.probes()) {
    const MeasuredValue there = brdf.value(pair.light, pair.view), back = brdf.value(pair.view, pair.light);
    if (!there.measured || !back.measured || there.outside_deg > 0 || back.outside_deg > 0) continue;
    pairs.push_back({math::mean(there.f), math::mean(back.f), pair.view.z, pair.light.z});
  }
  return pairs;
}

// Half the variance of f(a,b) - f(b,a) is the variance of either; among the darkest tenth of the pairs the signal is
// small, and what is left is noise (and any systematic error there, which a reading cannot be told from either).
double dark_noise(std::vector<Swapped> pairs) {
  const std::size_t darkest = pairs.size() / 10;
  if (darkest == 0) return 0;
  std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(darkest), pairs.end(),
                   [](const Swapped& a, const Swapped& b) { return a.there + a.back < b.there + b.back; });
  double sum = 0;
  for (std::size_t i = 0; i < darkest; ++i) sum += (pairs[i].there - pairs[i].back) * (pairs[i].there - pairs[i].back);
  return std::sqrt(sum / 2 / static_cast<double>(darkest));
}

// integral f cos(theta_o) d omega for light at 45 deg, the midpoint rule on equal cosine-weighted areas; the 10 deg
// about specular hold the gloss, which no such grid resolves.
double albedo_without_gloss(const MeasuredBrdf& brdf) {
  constexpr int kRowsOfDisc = 24, kSpokes = 48;
  const Vec3 light = {std::sin(45 * kDegree), 0, std::cos(45 * kDegree)};
  double sum = 0;
  for (int i = 0; i < kRowsOfDisc; ++i)
    for (int j = 0; j < kSpokes; ++j) {
      const double sine = std::sqrt((i + 0.5) / kRowsOfDisc), azimuth = 2 * kPi * (j + 0.5) / kSpokes;
      const Vec3 view = {sine * std::cos(azimuth), sine * std::sin(azimuth), std::sqrt(1 - sine * sine)};
      if (paint::aspecular_angle_rad(light, view, {0, 0, 1}) < 10 * kDegree) continue;
      sum += math::mean(brdf.value(light, view).f);
    }
  return sum * kPi / (kRowsOfDisc * kSpokes);
}

}  // namespace

Cell cell_at(double coordinate, std::size_t n) {
  const double held = std::clamp(coordinate, 0.0, static_cast<double>(n - 1));
  const auto low = std::min(static_cast<std::size_t>(held), n - 2);
  return {low, held - static_cast<double>(low)};
}

double polar_angle(const Vec3& direction) {
  return std::atan2(std::hypot(direction.x, direction.y), direction.z);
}

double azimuth_between(const Vec3& a, const Vec3& b) {
  return std::atan2(std::abs(a.x * b.y - a.y * b.x), a.x * b.x + a.y * b.y);
}

std::vector<paint::DirectionPair> MeasuredBrdf::probes() const {
  constexpr int kProbes = 1000;
  const double most = std::sin(75 * kDegree);
  std::vector<paint::DirectionPair> result;
  for (int k = 1; k <= kProbes; ++k) {
    const auto direction = [&](int polar_base, int azimuth_base) -> Vec3 {
      const double sine = most * std::sqrt(radical_inverse(polar_base, k));
      const double azimuth = 2 * kPi * radical_inverse(azimuth_base, k);
      return {sine * std::cos(azimuth), sine * std::sin(azimuth), std::sqrt(1 - sine * sine)};
    };
    const paint::DirectionPair pair{direction(2, 3), direction(5, 7)};
    if (paint::aspecular_angle_rad(pair.light, pair.view, {0, 0, 1}) > 15 * kDegree) result.push_back(pair);
  }
  return result;
}

std::vector<paint::DirectionPair> MeasuredBrdf::samples() const {
  constexpr double kCones_deg[] = {0,  1,  2,  3.5, 5,  7,  9,  11, 13, 15, 17.5, 20, 22.5, 25,  27.5,
                                   30, 35, 40, 45,  50, 55, 60, 65, 70, 75, 80,   90, 100,  110, 120};
  constexpr double kLightStep_deg = 10, kSteepestLight_deg = 70, kSteepestView_deg = 80, kTurn_deg = 22.5;
  std::vector<paint::DirectionPair> result;
  for (double light = 0; light <= kSteepestLight_deg; light += kLightStep_deg)
    for (const double cone : kCones_deg)
      for (double turn = 0; turn <= 180; turn += kTurn_deg) {
        const paint::DirectionPair pair = paint::directions(
            {.incidence_deg = light, .aspecular_deg = cone, .out_of_plane = true, .azimuth_deg = turn});
        // About the normal every turn of the cone is the same pair, and so is every turn of a cone without width.
        if ((cone == 0 || light == 0) && turn > 0) break;
        if (polar_angle(pair.view) <= kSteepestView_deg * kDegree) result.push_back(pair);
      }
  return result;
}

std::string measured_formats() {
  std::string names;
  for (const MeasuredFormat* format : kMeasuredFormats)
    names += (names.empty() ? "" : format == kMeasuredFormats.back() ? " and " : ", ") + std::string(format->name);
  return names;
}

bool looks_measured(std::string_view path, std::string_view head) {
  return std::ranges::any_of(kMeasuredFormats,
                             [&](const MeasuredFormat* format) { return format->recognizes(path, head); });
}

Result<std::unique_ptr<MeasuredBrdf>> read_measured(const std::string& path) {
  GONIO_ASSIGN(const std::string bytes, file_content(path));
  return read_measured(path, bytes);
}

Result<std::unique_ptr<MeasuredBrdf>> read_measured(const std::string& name, std::string_view bytes) {
  for (const MeasuredFormat* format : kMeasuredFormats)
    if (format != kMeasuredFormats.back() && format->recognizes(name, bytes)) return format->read(name, bytes);
  if (bytes.find('\0') == std::string_view::npos) return kMeasuredFormats.back()->read(name, bytes);
  return input_error("{}: is none of {}", name, measured_formats());
}

MeasuredChecks checks(const MeasuredBrdf& brdf, const color::ViewingCondition& condition) {
  const MeasuredTraits& traits = brdf.traits();
  MeasuredChecks result;
  result.negative_share = static_cast<double>(traits.negative) / static_cast<double>(traits.samples);
  result.zero_share = static_cast<double>(traits.zero) / static_cast<double>(traits.samples);
  result.warnings = traits.findings;

  const auto pairs = swapped_pairs(brdf);
  std::vector<double> as_f, as_f_cos;
  for (const Swapped& pair : pairs) {
    as_f.push_back(disagreement(pair.there, pair.back));
    as_f_cos.push_back(disagreement(pair.there / pair.cos_there, pair.back / pair.cos_back));
  }
  if (!pairs.empty()) {
    result.reciprocity_error = math::median(as_f);
    result.reciprocity_if_f_cos = math::median(as_f_cos);
  }
  result.values = traits.symmetric                                          ? "symmetric"
                  : result.reciprocity_error <= result.reciprocity_if_f_cos ? "f"
                                                                            : "f_cos";
  result.noise_floor = kPi * std::max(traits.negative_rms, traits.symmetric ? 0.0 : dark_noise(pairs));
  result.albedo_45 = albedo_without_gloss(brdf);

  if (traits.negative > 0)
    result.warnings.push_back(fmt::format("{:.1f} % of the samples are negative", 100 * result.negative_share));
  constexpr double kPoorReciprocity = 0.05;
  if (result.reciprocity_error > kPoorReciprocity)
    result.warnings.push_back(fmt::format(
        "with light and viewer swapped the values differ by {:.0f} % (median): take that for their uncertainty",
        100 * result.reciprocity_error));
  if (result.values == "f_cos" && result.reciprocity_if_f_cos < 0.8 * result.reciprocity_error)
    result.warnings.push_back(
        "the values fit f cos(theta_o) better than f: colors far from the normal may be too dark");
  if (result.albedo_45 > 1)
    result.warnings.push_back(
        fmt::format("reflects {:.2f} of the light at 45 deg: more than there is", result.albedo_45));
  const auto meter = ChannelColorimeter::make(traits, condition);
  if (meter.ok() && meter->held_share() > color::kToldHeldShare)
    result.warnings.push_back(
        fmt::format("its spectra leave out {:.0f} % of what the observer sees, and were taken to go on as they end",
                    100 * meter->held_share()));
  return result;
}

}  // namespace goniochrome::brdf
