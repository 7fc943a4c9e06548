#include "capture/internal/rectify.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace goniochrome::capture {

namespace {

constexpr std::array<const char*, 4> kNames = {"upper left", "upper right", "lower right", "lower left"};

// Error: corners that no plate has that is seen from its front.
Result<void> check(const std::array<ImagePlace, 4>& at, int width, int height) {
  for (std::size_t k = 0; k < at.size(); ++k)
    if (!(at[k].x >= 0 && at[k].x <= width && at[k].y >= 0 && at[k].y <= height))
      return input_error("the {} corner is at {},{}, outside of the photograph of {} x {} pixels", kNames[k],
                         shortest(at[k].x), shortest(at[k].y), width, height);
  int right = 0, left = 0;  // turns, from side to side
  for (std::size_t k = 0; k < at.size(); ++k) {
    const ImagePlace &a = at[k], &b = at[(k + 1) % 4], &c = at[(k + 2) % 4];
    const double turn = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
    constexpr double kLeast = 0.02;  // sine of the angle between sides
    if (!(std::abs(turn) > kLeast * std::hypot(b.x - a.x, b.y - a.y) * std::hypot(c.x - b.x, c.y - b.y)))
      return input_error("the {} corner is on the line through its neighbors: mark the four corners of the plate",
                         kNames[(k + 1) % 4]);
    ++(turn > 0 ? right : left);
  }
  if (right == 4) return {};
  if (left == 4)
    return input_error("the upper left corner is followed by the others against the clock: give them with the clock");
  return input_error("the upper left corner and the others make sides that cross or a dent: give them with the clock");
}

}  // namespace

// With p0 to p3 the corners, the square is mapped to them by the projective map that is linear but for its divisor
// g u + h v + 1, and p0 - p1 + p2 - p3 = g (p1 - p2) + h (p3 - p2) follows from p2 at u = v = 1.
Result<Perspective> Perspective::of(const Corners& corners, int width, int height) {
  GONIO_TRY(check(corners.at, width, height));
  Perspective view;
  view.middle_ = {0.5 * width, 0.5 * height};
  view.half_diagonal_ = 0.5 * std::hypot(width, height), view.k1_ = corners.k1;
  std::array<ImagePlace, 4> p;
  std::ranges::transform(corners.at, p.begin(), [&](const ImagePlace& seen) { return view.undistorted(seen); });
  for (std::size_t k = 0; k < p.size(); ++k) {
    const ImagePlace back = view.distorted(p[k]);
    constexpr double kSame = 0.01;  // pixels
    if (!(std::hypot(back.x - corners.at[k].x, back.y - corners.at[k].y) < kSame))
      return input_error("the {} corner is where no lens of k1 {} shows anything: check k1", kNames[k],
                         shortest(corners.k1));
  }
  const double ax = p[1].x - p[2].x, ay = p[1].y - p[2].y, bx = p[3].x - p[2].x, by = p[3].y - p[2].y;
  const double sx = p[0].x - p[1].x + p[2].x - p[3].x, sy = p[0].y - p[1].y + p[2].y - p[3].y;
  const double det = ax * by - ay * bx, g = (sx * by - sy * bx) / det, h = (ax * sy - ay * sx) / det;
  view.m_ = {p[1].x - p[0].x + g * p[1].x,
             p[3].x - p[0].x + h * p[3].x,
             p[0].x,
             p[1].y - p[0].y + g * p[1].y,
             p[3].y - p[0].y + h * p[3].y,
             p[0].y,
             g,
             h};
  return view;
}

ImagePlace Perspective::scaled(const ImagePlace& from, double factor) const {
  return {middle_.x + factor * (from.x - middle_.x), middle_.y + factor * (from.y - middle_.y)};
}

double Perspective::squared(const ImagePlace& place) const {
  const double x = (place.x - middle_.x) / half_diagonal_, y = (place.y - middle_.y) / half_diagonal_;
  return x * x + y * y;
}

ImagePlace Perspective::distorted(const ImagePlace& straight) const {
  return scaled(straight, 1 + k1_ * squared(straight));
}

ImagePlace Perspective::undistorted(const ImagePlace& seen) const {
  ImagePlace place = seen;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) place = scaled(seen, 1 / (1 + k1_ * squared(place)));
  return place;
}

ImagePlace Perspective::at(double u, double v) const {
  const double divisor = m_[6] * u + m_[7] * v + 1;
  const ImagePlace place = {(m_[0] * u + m_[1] * v + m_[2]) / divisor, (m_[3] * u + m_[4] * v + m_[5]) / divisor};
  return distorted(place);
}

int Perspective::samples(double u, double v, double wide, double high) const {
  const ImagePlace a = at(u, v), b = at(u + wide, v), c = at(u + wide, v + high), d = at(u, v + high);
  const double longest = std::max(std::hypot(c.x - a.x, c.y - a.y), std::hypot(d.x - b.x, d.y - b.y));
  constexpr double kMost = 8;
  return static_cast<int>(std::clamp(std::ceil(longest / std::sqrt(2.0) - 1e-9), 1.0, kMost));
}

}  // namespace goniochrome::capture
