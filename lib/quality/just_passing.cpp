#include <algorithm>
#include <cmath>

#include "library/index.h"
#include "paint/edit.h"
#include "quality/limits.h"

namespace goniochrome::quality {

namespace {

constexpr double kFarthest = 100;  // CIELAB units: no tolerance is so wide

std::optional<double> quantity_at(const std::string& quantity, const AngleDifference& angle,
                                  const CompareOptions& options) {
  const color::LabDifference& d = angle.lab;
  for (const auto& [name, value] : {std::pair{"dL", d.dL}, {"da", d.da}, {"db", d.db}, {"dC", d.dC}, {"dH", d.dH}})
    if (quantity == name) return value;
  for (std::size_t i = 0; i < options.formulas.size(); ++i)
    if (quantity == quantity_of(options.formulas[i]) || (i == 0 && quantity == "dE")) return angle.by_formula[i];
  return std::nullopt;
}

// The limits that bound a color at a geometry, to which those of mean and largest belong.
class AngleLimits {
 public:
  AngleLimits(const paint::LabReading& standard, const CompareOptions& options, const std::vector<Limit>& limits)
      : standard_(standard), options_(options) {
    const std::string name = paint::geometry_name(standard.geometry);
    for (const Limit& limit : limits)
      if (limit.at == "*" || limit.at == kMean || limit.at == kLargest || limit.at == name) limits_.push_back(&limit);
  }

  bool keeps(const color::Lab& sample) const {
    AngleDifference angle{standard_.geometry, standard_.lab, sample, color::lab_difference(standard_.lab, sample), {}};
    for (const color::DifferenceFormula& formula : options_.formulas)
      angle.by_formula.push_back(
          color::difference(formula, standard_.lab, sample, paint::aspecular_angle_deg(standard_.geometry)));
    return std::ranges::all_of(limits_, [&](const Limit* limit) {
      const auto value = quantity_at(limit->quantity, angle, options_);
      return !value || !((limit->low && *value < *limit->low) || (limit->high && *value > *limit->high));
    });
  }

  // The largest distance that the limits allow in a direction; nothing if no limit bounds it.
  std::optional<double> reach(const color::Lab& direction) const {
    const auto at = [&](double r) {
      const color::Lab& s = standard_.lab;
      return color::Lab{s.L + r * direction.L, s.a + r * direction.a, s.b + r * direction.b};
    };
    if (keeps(at(kFarthest))) return std::nullopt;
    double low = 0, high = kFarthest;
    for (int step = 0; step < 50; ++step) {
      const double middle = (low + high) / 2;
      (keeps(at(middle)) ? low : high) = middle;
    }
    return low;
  }

 private:
  const paint::LabReading& standard_;
  const CompareOptions& options_;
  std::vector<const Limit*> limits_;
};

}  // namespace

Result<std::vector<paint::Paint>> just_passing(const paint::Paint& standard, const CompareOptions& options,
                                               const std::vector<Limit>& limits) {
  std::vector<paint::Paint> paints = {standard};
  const std::vector<paint::LabReading> rows = library::comparable_rows(standard);
  for (const paint::Neighbor& neighbor : paint::neighbors(paint::Variation::kFace, 1)) {
    const color::Lab direction = neighbor.edit.face_shift;
    std::vector<std::optional<double>> reaches;
    for (const paint::LabReading& row : rows) {
      const AngleLimits at_angle(row, options, limits);
      if (!at_angle.keeps(row.lab))
        return input_error("paint \"{}\": its limits at {} do not hold for the standard itself", standard.name,
                           paint::geometry_name(row.geometry));
      reaches.push_back(at_angle.reach(direction));
    }
    double least = kFarthest;
    for (const auto& reach : reaches) least = std::min(least, reach.value_or(kFarthest));
    if (least == kFarthest)
      return input_error("paint \"{}\": no limit bounds the direction {}: give one of dE", standard.name,
                         neighbor.name.substr(neighbor.name.find('-') + 1));
    paint::Paint& made = paints.emplace_back();
    made.name = standard.name + "." + neighbor.name;
    made.code = standard.code, made.paint_class = standard.paint_class;
    made.gloss = standard.gloss, made.coat_index = standard.coat_index;
    made.measurement = paint::Measurement{paint::condition_of(standard), "", rows};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      color::Lab& lab = made.measurement->rows[i].lab;
      const double black = direction.L < 0 ? std::max(lab.L, 0.0) / -direction.L : kFarthest;
      const double r = std::min(reaches[i].value_or(least), black);
      lab = {lab.L + r * direction.L, lab.a + r * direction.a, lab.b + r * direction.b};
    }
  }
  return Result(std::move(paints));
}

}  // namespace goniochrome::quality
