#include "paint/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/angles.h"
#include "paint/curve.h"

namespace goniochrome::paint {

namespace {

constexpr double kNone = PaintMetrics::kNone;

double signed_flop(double difference, double L45) {
  return std::copysign(2.69 * std::pow(std::abs(difference), 1.11) / std::pow(L45, 0.86), difference);
}

// The distance of the origin from the step between two points of the a*b* plane.
double least_chroma(const color::Lab& from, const color::Lab& to) {
  const double da = to.a - from.a, db = to.b - from.b;
  const double length2 = da * da + db * db;
  const double along = length2 > 0 ? std::clamp(-(from.a * da + from.b * db) / length2, 0.0, 1.0) : 0;
  return std::hypot(from.a + along * da, from.b + along * db);
}

// A row on the curve's own path: light at 45 deg, in plane, on the normal's side of specular.
bool on_path(const Geometry& geometry) {
  return geometry.incidence_deg == 45 && !geometry.out_of_plane && !geometry.reversed &&
         geometry.aspecular_deg >= kFaceAngle_deg;
}

// The colors of the path, by ascending aspecular angle.
std::vector<LabReading> path_rows(const Paint& paint) {
  std::vector<LabReading> rows;
  if (!paint.measurement) return rows;
  std::ranges::copy_if(paint.measurement->rows, std::back_inserter(rows),
                       [](const LabReading& row) { return on_path(row.geometry); });
  std::ranges::stable_sort(rows, {}, [](const LabReading& row) { return row.geometry.aspecular_deg; });
  return rows;
}

std::optional<color::Lab> row_at(std::span<const LabReading> rows, double aspecular_deg) {
  for (const LabReading& row : rows)
    if (row.geometry.aspecular_deg == aspecular_deg) return row.lab;
  return std::nullopt;
}

// dE00 between a color and what is left of it when negative channels of the working space are cut off.
double gamut_loss(const color::Lab& lab, const color::Xyz& white) {
  const color::Rgb rgb = color::rgb_from_lab(lab, white);
  if (rgb.x >= 0 && rgb.y >= 0 && rgb.z >= 0) return 0;
  return color::delta_e_2000(
      lab, color::lab_from_rgb({std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)}, white));
}

void add_gloss(const Paint& paint, PaintMetrics& result) {
  if (paint.gloss.empty()) return;
  const auto at_60 = std::ranges::find(paint.gloss, 60.0, &GlossReading::angle_deg);
  const GlossReading& reading = at_60 != paint.gloss.end() ? *at_60 : paint.gloss.front();
  result.gloss = reading.gloss_units;
  result.gloss_angle_deg = reading.angle_deg;
}

// What rests on face, middle and flop.
void add_indices(const std::array<color::Lab, 3>& at, PaintMetrics& result) {
  const FlopIndex flop = flop_index(at[0].L, at[1].L, at[2].L);
  result.flop_index = flop.value;
  result.flop_sensitivity = flop.sensitivity;
  if (flop.unstable()) result.flags.push_back("dark");
  result.chroma_index = chroma_index(at[0], at[2]);
  result.hue_shift_index = hue_shift_index(at[0], at[2]);
  result.L15 = at[0].L, result.L45 = at[1].L, result.L110 = at[2].L;
  result.chroma15 = color::chroma(at[0]);
  if (result.chroma15 >= kLeastChroma)
    result.hue15_deg = color::hue_deg(at[0]);
  else
    result.flags.push_back("achromatic");
}

}  // namespace

FlopIndex flop_index(double L15, double L45, double L110) {
  constexpr double kStep = 0.1;
  const double difference = L15 - L110;
  if (!(L45 > 0)) return {kNone, std::numeric_limits<double>::infinity()};
  const FlopIndex plain{signed_flop(difference, L45), 0};
  if (L45 <= kStep) return {plain.value, std::numeric_limits<double>::infinity()};
  // Monotone in the difference, and in L45 on either side of zero difference: the extremes are at the corners.
  double sensitivity = 0;
  for (const double d : {-2 * kStep, 2 * kStep})
    for (const double m : {-kStep, kStep})
      sensitivity = std::max(sensitivity, std::abs(signed_flop(difference + d, L45 + m) - plain.value));
  return {plain.value, sensitivity};
}

double chroma_index(const color::Lab& at_15, const color::Lab& at_110) {
  return std::abs(color::chroma(at_15) - color::chroma(at_110));
}

double hue_shift_index(const color::Lab& at_15, const color::Lab& at_110) {
  const double face = color::chroma(at_15);
  if (face < kLeastChroma) return kNone;
  return std::abs(at_110.a * at_15.b - at_15.a * at_110.b) / face;
}

HueTravel hue_travel(std::span<const color::Lab> path) {
  if (path.size() < 2 || color::chroma(path.front()) < kLeastChroma || color::chroma(path.back()) < kLeastChroma)
    return {kNone, false};
  HueTravel travel;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const color::Lab &from = path[i - 1], &to = path[i];
    travel.degrees += std::atan2(from.a * to.b - from.b * to.a, from.a * to.a + from.b * to.b) * (180 / kPi);
    if (least_chroma(from, to) < kLeastChroma) travel.through_gray = true;
  }
  return travel;
}

Result<PaintMetrics> metrics(const Paint& paint, CurveFit fit) {
  PaintMetrics result;
  add_gloss(paint, result);
  const std::vector<LabReading> rows = path_rows(paint);
  const std::array measured = {row_at(rows, 15), row_at(rows, 45), row_at(rows, 110)};
  const bool complete = measured[0] && measured[1] && measured[2];
  std::optional<Appearance> curve = paint.appearance;
  bool fitted = false;
  if (curve) {
    if (rows.empty())
      result.residual_de00 = curve->residual_de00.value_or(kNone);
    else
      result.residual_de00 = 0;
    for (const LabReading& row : rows)
      result.residual_de00 =
          std::max(result.residual_de00, color::delta_e_2000(row.lab, lab_at(*curve, row.geometry.aspecular_deg)));
  } else if (rows.size() >= 2 && (fit == CurveFit::kAlways || !complete)) {
    if (const auto nearest = appearance_from_rows(rows); nearest.ok()) {
      curve = nearest->appearance;
      fitted = true;
      result.residual_de00 = curve->residual_de00.value_or(kNone);
    }
  }
  if (curve) result.travel_deg = curve->travel_deg;

  std::vector<color::Lab> path;
  if (complete) {
    result.source = PaintMetrics::Source::kRows;
    add_indices({*measured[0], *measured[1], *measured[2]}, result);
    for (const LabReading& row : rows) path.push_back(row.lab);
  } else if (curve) {
    result.source = fitted ? PaintMetrics::Source::kFitted : PaintMetrics::Source::kCurve;
    path = {lab_at(*curve, 15), lab_at(*curve, 45), lab_at(*curve, 110)};
    add_indices({path[0], path[1], path[2]}, result);
  } else {
    result.flags.push_back("no_color");
    return result;
  }
  const HueTravel travel = hue_travel(path);
  result.hue_travel_deg = travel.degrees;
  if (travel.through_gray) result.flags.push_back("through_gray");

  GONIO_ASSIGN(const color::Xyz white, color::white_point(condition_of(paint)));
  result.gamut_de00 = 0;
  for (const color::Lab& lab : path) result.gamut_de00 = std::max(result.gamut_de00, gamut_loss(lab, white));
  if (result.gamut_de00 > 1) result.flags.push_back("gamut");
  return result;
}

const char* source_name(PaintMetrics::Source source) {
  switch (source) {
    case PaintMetrics::Source::kRows:
      return "rows";
    case PaintMetrics::Source::kCurve:
      return "curve";
    case PaintMetrics::Source::kFitted:
      return "fitted";
    case PaintMetrics::Source::kNone:
      break;
  }
  return "none";
}

std::span<const MetricColumn> metric_columns() {
  static constexpr std::array kColumns = {
      MetricColumn{"flop_index", &PaintMetrics::flop_index, "lightness travel: 2.69 (L15 - L110)^1.11 / L45^0.86"},
      MetricColumn{"flop_sensitivity", &PaintMetrics::flop_sensitivity, "its largest change for 0.1 in each L*"},
      MetricColumn{"chroma_index", &PaintMetrics::chroma_index, "change of chroma from face to flop"},
      MetricColumn{"hue_shift_index", &PaintMetrics::hue_shift_index, "distance of the flop from the face's hue line"},
      MetricColumn{"hue_travel_deg", &PaintMetrics::hue_travel_deg, "turn of the hue from face to flop"},
      MetricColumn{"gloss", &PaintMetrics::gloss, "gloss units, at 60 deg where there is a choice"},
      MetricColumn{"gloss_angle_deg", &PaintMetrics::gloss_angle_deg, "the angle of that gloss"},
      MetricColumn{"gamut_de00", &PaintMetrics::gamut_de00, "worst loss to the working space, dE00"},
      MetricColumn{"L15", &PaintMetrics::L15, "L* of the face"},
      MetricColumn{"L45", &PaintMetrics::L45, "L* at 45 deg"},
      MetricColumn{"L110", &PaintMetrics::L110, "L* of the flop"},
      MetricColumn{"chroma15", &PaintMetrics::chroma15, "chroma of the face"},
      MetricColumn{"hue15_deg", &PaintMetrics::hue15_deg, "hue angle of the face"},
      MetricColumn{"travel_deg", &PaintMetrics::travel_deg, "aspecular angle where the color stops changing"},
      MetricColumn{"residual_de00", &PaintMetrics::residual_de00, "worst miss of the curve at a measured angle, dE00"},
  };
  return kColumns;
}

std::span<const MetricColumn> metric_columns_without_fit() {
  return metric_columns().first(metric_columns().size() - 2);
}

const MetricColumn* find_metric(std::string_view name) {
  for (const MetricColumn& column : metric_columns())
    if (name == column.name) return &column;
  return nullptr;
}

}  // namespace goniochrome::paint
