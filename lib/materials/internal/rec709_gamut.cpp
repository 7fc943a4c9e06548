#include "materials/internal/rec709_gamut.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "materials/internal/nearest.h"

namespace goniochrome::materials {

namespace {

double least(const color::Rgb& rgb) {
  return std::min({rgb.x, rgb.y, rgb.z});
}

// Near the surface of Rec.709 the lattice is coarser than the loss: a color that loses up to kCut by setting its
// channels below 0 to 0 gets that, one that loses kFound and more gets the value of the lattice.
constexpr double kCut = 0.5, kFound = 1.5;

// The search starts from the color whose channels below 0 are 0, and from the gray of its lightness mixed in until none
// is below 0: one keeps the brightest channels, the other the hue.
color::Lab searched(const color::Lab& wanted, const color::Xyz& white) {
  const color::Rgb outside = color::rec709_from_rec2020(color::rgb_from_lab(wanted, white));
  if (least(outside) >= 0) return wanted;
  const auto lab_of = [&](const color::Rgb& rec709) {
    return color::lab_from_rgb(color::rec2020_from_rec709(rec709), white);
  };
  const double gray = std::max(0.0, color::luminance(color::rec2020_from_rec709(outside))),
               share = gray / std::max(gray - least(outside), 1e-12);
  const color::Rgb starts[] = {outside,
                               color::Rgb{gray, gray, gray} + share * (outside - color::Rgb{gray, gray, gray})};
  double best = 0;
  color::Lab found;
  for (const color::Rgb& start : starts) {
    std::vector<Parameter> channels;
    const double most = 1.5 * std::max({start.x, start.y, start.z, 1e-4});
    for (int c = 0; c < 3; ++c) channels.push_back({std::clamp(start[c], 0.0, most), 0, most});
    const double sum = descend(channels, [&](const std::vector<Parameter>& at, std::vector<double>& residuals) {
      const Vec3 apart = color::delta_e_2000_vector(wanted, lab_of({at[0].value, at[1].value, at[2].value}));
      residuals = {apart.x, apart.y, apart.z};
    });
    if (&start == starts || sum < best) {
      best = sum;
      found = lab_of({channels[0].value, channels[1].value, channels[2].value});
    }
  }
  return found;
}

}  // namespace

NearestInRec709::NearestInRec709(const color::Xyz& white) : white_(white), corners_(kLightness * kHue * kHue) {}

Vec3 NearestInRec709::corner(std::size_t lightness, std::size_t a, std::size_t b) {
  Corner& corner = corners_[(lightness * kHue + a) * kHue + b];
  if (!corner.known) {
    constexpr double kMiddle = kStep * kHue / 2;
    const color::Lab at = {kStep * static_cast<double>(lightness), kStep * static_cast<double>(a) - kMiddle,
                           kStep * static_cast<double>(b) - kMiddle};
    const color::Lab found = searched(at, white_);
    corner = {
        {static_cast<float>(found.L - at.L), static_cast<float>(found.a - at.a), static_cast<float>(found.b - at.b)},
        true};
  }
  return {corner.difference[0], corner.difference[1], corner.difference[2]};
}

// Colors brighter than white are moved as those of white are.
color::Rgb NearestInRec709::operator()(const color::Rgb& f) {
  const color::Rgb rec709 = color::rec709_from_rec2020(f);
  if (least(rec709) >= 0) return f;
  const color::Rgb cut =
      color::rec2020_from_rec709({std::max(rec709.x, 0.0), std::max(rec709.y, 0.0), std::max(rec709.z, 0.0)});
  constexpr double kBrightest = kStep * (kLightness - 2);
  color::Lab lab = color::lab_from_rgb(kPi * f, white_);
  const double lost = color::delta_e_2000(lab, color::lab_from_rgb(kPi * cut, white_));
  if (lost <= kCut) return cut;
  double scale = 1;
  if (lab.L > kBrightest) {
    scale = std::pow((lab.L + 16) / (kBrightest + 16), -3);
    lab = color::lab_from_rgb(scale * kPi * f, white_);
  }
  const std::array<double, 3> place = {lab.L / kStep, lab.a / kStep + kHue / 2.0, lab.b / kStep + kHue / 2.0};
  if (!(place[0] >= 0) || std::min(place[1], place[2]) < 0 || std::max(place[1], place[2]) >= kHue - 1) return cut;
  std::array<std::size_t, 3> low{};
  Vec3 within;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    low[i] = static_cast<std::size_t>(place[i]);
    within[k] = place[i] - static_cast<double>(low[i]);
  }
  Vec3 moved;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::size_t l = k & 1, a = k >> 1 & 1, b = k >> 2;
    const double weight = (l ? within.x : 1 - within.x) * (a ? within.y : 1 - within.y) * (b ? within.z : 1 - within.z);
    moved += weight * corner(low[0] + l, low[1] + a, low[2] + b);
  }
  const color::Rgb nearest =
      color::rec709_from_rec2020(color::rgb_from_lab({lab.L + moved.x, lab.a + moved.y, lab.b + moved.z}, white_));
  const color::Rgb found =
      (1 / (scale * kPi)) *
      color::rec2020_from_rec709({std::max(nearest.x, 0.0), std::max(nearest.y, 0.0), std::max(nearest.z, 0.0)});
  const double share = std::min((lost - kCut) / (kFound - kCut), 1.0);
  return share * found + (1 - share) * cut;
}

}  // namespace goniochrome::materials
