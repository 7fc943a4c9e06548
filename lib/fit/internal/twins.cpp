#include "fit/internal/twins.h"

#include <algorithm>
#include <cmath>

#include "fit/internal/target_rows.h"
#include "fit/paint_fit.h"

namespace goniochrome::fit {

namespace {

template <class Cost>
double least(color::Lab x, double step, const Cost& cost) {
  constexpr double kSmallestStep = 1e-3;
  double value = cost(x);
  while (step > kSmallestStep) {
    bool moved = false;
    for (double color::Lab::*const channel : {&color::Lab::L, &color::Lab::a, &color::Lab::b})
      for (const double move : {step, -step}) {
        color::Lab next = x;
        next.*channel += move;
        const double next_value = cost(next);
        if (!(next_value < value)) continue;
        x = next, value = next_value, moved = true;
        break;
      }
    if (!moved) step /= 4;
  }
  return value;
}

// One angle's readings: the least sum of their differences to one color, and the least of the largest, both by a search
// from their mean and from each of them.
void add_floor(const std::vector<const paint::LabReading*>& same, double apart, Twins& twins) {
  const auto sum_to = [&](const color::Lab& x) {
    double sum = 0;
    for (const paint::LabReading* r : same) sum += color::delta_e_2000(r->lab, x);
    return sum;
  };
  const auto largest_to = [&](const color::Lab& x) {
    double largest = 0;
    for (const paint::LabReading* r : same) largest = std::max(largest, color::delta_e_2000(r->lab, x));
    return largest;
  };
  color::Lab mean;
  const auto count = static_cast<double>(same.size());
  for (const paint::LabReading* r : same)
    mean = {mean.L + r->lab.L / count, mean.a + r->lab.a / count, mean.b + r->lab.b / count};
  const double step = apart / 4;
  double sum = least(mean, step, sum_to), largest = least(mean, step, largest_to);
  for (const paint::LabReading* r : same)
    sum = std::min(sum, least(r->lab, step, sum_to)), largest = std::min(largest, least(r->lab, step, largest_to));
  twins.sum_de00 += sum;
  twins.largest_de00.push_back(largest);
}

}  // namespace

Twins twins_of(const std::vector<paint::LabReading>& readings) {
  constexpr double kSame_deg = 1e-6;
  Twins twins;
  std::vector<char> taken(readings.size(), 0);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double angle = paint::aspecular_angle_deg(readings[i].geometry);
    std::vector<const paint::LabReading*> same;
    for (std::size_t k = i; k < readings.size(); ++k)
      if (!taken[k] && std::abs(paint::aspecular_angle_deg(readings[k].geometry) - angle) <= kSame_deg)
        same.push_back(&readings[k]), taken[k] = 1;
    double apart = 0;
    for (const paint::LabReading* a : same)
      for (const paint::LabReading* b : same) {
        const double de00 = color::delta_e_2000(a->lab, b->lab);
        apart = std::max(apart, de00);
        if (de00 > kVisible_de00) twins.views_deg.push_back(std::round(1e6 * view_angle_deg(a->geometry)) / 1e6);
      }
    twins.apart_de00 = std::max(twins.apart_de00, apart);
    if (apart > 0) add_floor(same, apart, twins);
  }
  std::ranges::sort(twins.views_deg);
  twins.views_deg.erase(std::ranges::unique(twins.views_deg).begin(), twins.views_deg.end());
  return twins;
}

}  // namespace goniochrome::fit
