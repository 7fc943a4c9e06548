#include "fit/internal/color_floor.h"

#include <algorithm>
#include <cmath>

#include "base/vec3.h"

namespace goniochrome::fit {

namespace {

using color::Lab;

// Up to these differences the middle of the straight line is good to 0.3 %; see color_floor().
constexpr double kStraightForSum_de00 = 2, kStraightForLargest_de00 = 4;
constexpr int kSteps = 32;  // of a search, which begins beside the minimum

double sum_to(const Lab& x, const std::vector<Lab>& colors) {
  double sum = 0;
  for (const Lab& lab : colors) sum += color::delta_e_2000(lab, x);
  return sum;
}

double largest_to(const Lab& x, const std::vector<Lab>& colors) {
  double largest = 0;
  for (const Lab& lab : colors) largest = std::max(largest, color::delta_e_2000(lab, x));
  return largest;
}

Lab between(const Lab& a, const Lab& b, double t) {
  return {a.L + t * (b.L - a.L), a.a + t * (b.a - a.a), a.b + t * (b.b - a.b)};
}

// The least cost that steps along the axes from x find, in at most `most` of them.
template <class Cost>
double least(Lab x, double step, int most, const Cost& cost) {
  double value = cost(x);
  for (const double last = step / 24; step > last && most > 0;) {
    bool moved = false;
    for (double Lab::*const channel : {&Lab::L, &Lab::a, &Lab::b})
      for (const double move : {step, -step}) {
        Lab next = x;
        next.*channel += move;
        const double next_value = cost(next);
        --most;
        if (!(next_value < value)) continue;
        x = next, value = next_value, moved = true;
        break;
      }
    if (!moved) step /= 4;
  }
  return value;
}

// The point of the straight line from a to b that is as far from a as from b, by the Illinois variant of the false
// position.
Lab middle(const Lab& a, const Lab& b, double apart_de00) {
  double low = 0, high = 1, at_low = -apart_de00, at_high = apart_de00;
  Lab x = between(a, b, 0.5);
  int side = 0;
  for (int step = 0; step < 12; ++step) {
    const double t = (low * at_high - high * at_low) / (at_high - at_low);
    x = between(a, b, t);
    const double value = color::delta_e_2000(a, x) - color::delta_e_2000(b, x);
    if (std::abs(value) <= 1e-4 * apart_de00) break;
    if (value < 0) {
      if (side < 0) at_high /= 2;
      low = t, at_low = value, side = -1;
    } else {
      if (side > 0) at_low /= 2;
      high = t, at_high = value, side = 1;
    }
  }
  return x;
}

// Colors as points around a color m: the length of a point's vector is the CIEDE2000 difference to m.
class Chart {
 public:
  Chart(const Lab& m, const std::vector<Lab>& colors) : m_(m) {
    constexpr double kStep = 1e-3;
    for (const Lab& lab : colors) points_.push_back(color::delta_e_2000_vector(m, lab));
    const Lab along[] = {{m.L + kStep, m.a, m.b}, {m.L, m.a + kStep, m.b}, {m.L, m.a, m.b + kStep}};
    for (int k = 0; k < 3; ++k) slope_[k] = (1 / kStep) * color::delta_e_2000_vector(m, along[k]);
  }
  const std::vector<Vec3>& points() const { return points_; }

  // The color whose point is p, to first order in p; m where the chart is singular.
  Lab color_at(const Vec3& p) const {
    const Vec3 bc = cross(slope_[1], slope_[2]), ca = cross(slope_[2], slope_[0]), ab = cross(slope_[0], slope_[1]);
    const double volume = dot(slope_[0], bc);
    if (!(std::abs(volume) > 1e-9)) return m_;
    return {m_.L + dot(p, bc) / volume, m_.a + dot(p, ca) / volume, m_.b + dot(p, ab) / volume};
  }

 private:
  Lab m_;
  std::vector<Vec3> points_;
  Vec3 slope_[3];
};

// The point whose distances to the others have the least sum, by Weiszfeld's iteration.
Vec3 median(const std::vector<Vec3>& points) {
  Vec3 x;
  for (int step = 0; step < 60; ++step) {
    Vec3 sum;
    double weights = 0;
    for (const Vec3& p : points) {
      const double weight = 1 / std::max(length(p - x), 1e-9);
      sum += weight * p, weights += weight;
    }
    x = (1 / weights) * sum;
  }
  return x;
}

// The center of the smallest ball around the points: steps toward the farthest one, each shorter than the last.
Vec3 center(const std::vector<Vec3>& points) {
  Vec3 x;
  for (int step = 1; step <= 200; ++step) {
    const Vec3& farthest = *std::ranges::max_element(points, {}, [&](const Vec3& p) { return length(p - x); });
    x += (1.0 / (step + 1)) * (farthest - x);
  }
  return x;
}

}  // namespace

// If CIEDE2000 were the length of the shortest path between two colors, the sum would be `apart` for every color on
// that path, and the largest difference would be half of it in the middle. Its weights depend on the mean of the two
// colors and vary slowly, so this holds nearly for small differences. The middle of the straight line was compared with
// long searches for random pairs: for 200 pairs that are 2 apart, the least sum is below both `apart` and the sum of
// the middle by at most 0.2 %; for 200 that are 4 apart, the least largest difference is below that of the middle by at
// most 0.3 %. The detour of the straight line grows with its length, so a short search follows for pairs that are
// farther apart.
ColorFloor color_floor(const std::vector<Lab>& colors, double apart_de00) {
  const auto sum = [&](const Lab& x) { return sum_to(x, colors); };
  const auto largest = [&](const Lab& x) { return largest_to(x, colors); };
  if (colors.size() == 2) {
    const Lab x = middle(colors[0], colors[1], apart_de00);
    const double step = apart_de00 / 16;
    return {std::min(apart_de00, apart_de00 > kStraightForSum_de00 ? least(x, step, kSteps, sum) : sum(x)),
            apart_de00 > kStraightForLargest_de00 ? least(x, step, kSteps, largest) : largest(x)};
  }
  // Several colors: around their mean, CIEDE2000 is the length of a vector, so the flat problem is solved there.
  Lab mean;
  for (const Lab& lab : colors) {
    const double share = 1 / static_cast<double>(colors.size());
    mean = {mean.L + share * lab.L, mean.a + share * lab.a, mean.b + share * lab.b};
  }
  const Chart chart(mean, colors);
  const double step = apart_de00 / 16;
  return {least(chart.color_at(median(chart.points())), step, kSteps, sum),
          least(chart.color_at(center(chart.points())), step, kSteps, largest)};
}

}  // namespace goniochrome::fit
