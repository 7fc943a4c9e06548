#include "selection.h"

#include <algorithm>
#include <optional>
#include <set>

#include "base/text.h"
#include "paint/curve.h"

namespace goniochrome::tool {

namespace {

// The geometries of common five- and six-angle instruments: the columns of a wide table unless --geometry says
// otherwise.
const std::vector<paint::Geometry> kUsual = {{.aspecular_deg = -15}, {.aspecular_deg = 15}, {.aspecular_deg = 25},
                                             {.aspecular_deg = 45},  {.aspecular_deg = 75}, {.aspecular_deg = 110}};

std::string listed(const std::vector<paint::Geometry>& geometries) {
  return joined(geometries, ", ", paint::geometry_name);
}

}  // namespace

Result<Selection> Selection::make(const Options& options, const OutputFormat& format) {
  Selection selection(options, format);
  for (const std::string& list : options.geometry)
    for (const std::string_view text : split(list, ',')) {
      const auto geometry = paint::parse_geometry(text);
      if (!geometry.ok()) return usage_error("--geometry: {}", geometry.error().message);
      if (std::ranges::find(selection.chosen_, *geometry) != selection.chosen_.end())
        return usage_error("--geometry names {} twice: give it once", paint::geometry_name(*geometry));
      selection.chosen_.push_back(*geometry);
    }
  if (selection.chosen_.empty() && format.is_wide) selection.chosen_ = kUsual;
  return selection;
}

formats::CsvLayout Selection::layout() const {
  const bool all = options_.columns == "all";
  return {format_.is_wide ? chosen_ : std::vector<paint::Geometry>(), all,
          !options_.geometry.empty() || options_.fit_appearance, all && format_.has_spectra};
}

std::vector<paint::Geometry> Selection::requested() const {
  return options_.geometry.empty() ? std::vector<paint::Geometry>() : chosen_;
}

// The geometries at which a paint is handed over: those of --geometry, or for a design both sets of the industry.
std::vector<paint::Geometry> Selection::wanted(const paint::Paint& paint) const {
  if (!options_.geometry.empty()) return chosen_;
  std::vector<paint::Geometry> sets;
  if (paint.appearance)
    for (const double angle : paint::kExportAngles_deg) sets.push_back({.aspecular_deg = angle});
  return sets;
}

namespace {

// The curve of a paint: its own, or the one nearest to its rows, if these stand at the three angles that fix one.
std::optional<paint::Appearance> curve_of(const paint::Paint& paint) {
  if (paint.appearance) return paint.appearance;
  std::set<double> angles;
  for (const paint::LabReading& row : paint.measurement->rows)
    if (!row.geometry.out_of_plane) angles.insert(paint::aspecular_angle_deg(row.geometry));
  if (angles.size() < 3) return std::nullopt;
  const auto fit = paint::appearance_from_rows(paint.measurement->rows);
  return fit.ok() ? std::optional(fit->appearance) : std::nullopt;
}

}  // namespace

// Adds the rows that are wanted and missing, each before the first row that lies farther from specular.
void Selection::add_missing(paint::Paint& paint, std::vector<paint::Geometry>& from_curve,
                            formats::Remarks& remarks) const {
  auto& rows = paint.measurement->rows;
  std::vector<paint::Geometry> missing = wanted(paint);
  std::erase_if(missing, [&](const paint::Geometry& geometry) {
    return std::ranges::find(rows, geometry, &paint::LabReading::geometry) != rows.end();
  });
  if (missing.empty()) return;
  const auto curve = curve_of(paint);
  if (!curve) return;
  for (const paint::Geometry& geometry : missing) {
    const auto farther = std::ranges::find_if(rows, [&](const paint::LabReading& row) {
      return !row.geometry.out_of_plane && row.geometry.aspecular_deg > geometry.aspecular_deg;
    });
    rows.insert(farther, {geometry, paint::lab_at(*curve, paint::aspecular_angle_deg(geometry))});
    if (!paint.appearance)
      remarks.note(fmt::format("{} is not measured: it comes from the curve that is nearest to the rows",
                               paint::geometry_name(geometry)),
                   paint.name);
  }
  from_curve = std::move(missing);
}

// Leaves the rows at the chosen geometries, in the order of the choice.
void Selection::keep_chosen(paint::Paint& paint, formats::Remarks& remarks) const {
  std::vector<paint::LabReading> kept;
  std::size_t chosen_rows = 0;
  for (const paint::Geometry& geometry : chosen_) {
    const auto row = std::ranges::find(paint.measurement->rows, geometry, &paint::LabReading::geometry);
    if (row != paint.measurement->rows.end())
      kept.push_back(*row), ++chosen_rows;
    else if (!options_.geometry.empty())
      remarks.note(fmt::format("{} is not measured", paint::geometry_name(geometry)), paint.name);
  }
  if (options_.geometry.empty() && chosen_rows < paint.measurement->rows.size())
    remarks.note("rows beside the usual six geometries are left out: name the columns with --geometry", paint.name);
  paint.measurement->rows = std::move(kept);
  std::erase_if(paint.measurement->spectra, [&](const paint::SpectrumReading& spectrum) {
    return std::ranges::find(chosen_, spectrum.geometry) == chosen_.end();
  });
}

void Selection::note_losses(const paint::Paint& paint, bool designed, formats::Remarks& remarks) const {
  const auto lost = [&](bool there, const char* what) {
    if (there) remarks.note(fmt::format("{} left out: only paint XML holds them", what), paint.name);
  };
  lost(paint.lobes.has_value(), "lobes are");
  const bool spectral = paint.measurement && !paint.measurement->spectra.empty();
  if (spectral && !format_.has_spectra)
    remarks.note("spectra are left out: paint XML, CxF and long tables with --columns all hold them", paint.name);
  else if (spectral && !format_.has_gloss && options_.columns != "all")
    remarks.note("spectra are left out: --columns all keeps them", paint.name);
  lost(paint.measurement && !paint.measurement->textures.empty(), "values of texture are");
  lost(paint.appearance.has_value() && !designed, "face, flop and travel are");
  lost(paint.anisotropy || paint.color_map, "anisotropy and color maps are");
  lost(!paint.foreign.empty(), "elements of other vocabularies are");
  const bool more = !paint.gloss.empty() || !paint.code.empty() || paint.paint_class != paint::PaintClass::kUnknown ||
                    (paint.measurement && (!paint.measurement->instrument.empty() ||
                                           !paint.measurement->serial.empty() || !paint.measurement->date.empty()));
  if (more && !format_.has_gloss && options_.columns != "all")
    remarks.note("gloss, class, code, instrument, serial and date are left out: --columns all keeps them", paint.name);
}

Result<void> Selection::apply(paint::Paint& paint, std::vector<paint::Geometry>& from_curve,
                              formats::Remarks& remarks) const {
  const bool measured = paint.measurement && !paint.measurement->rows.empty();
  const bool needs_rows = format_.only_rows || !options_.geometry.empty();
  if (measured && options_.fit_appearance) {
    GONIO_ASSIGN(paint::AppearanceFit fit, paint::appearance_from_rows(paint.measurement->rows));
    if (paint::extrapolation_at_specular(fit.appearance) > 4)
      remarks.note("the fitted travel is below 30 deg: nearer to specular than 15 deg the curve is a guess",
                   paint.name);
    paint.appearance = fit.appearance;
  }
  if (format_.only_rows && measured) add_missing(paint, from_curve, remarks);
  if (needs_rows && measured && !chosen_.empty()) keep_chosen(paint, remarks);
  if (needs_rows && !measured && paint.appearance) {
    paint.measurement = paint::Measurement{paint::condition_of(paint), "", paint::rows_of(*paint.appearance)};
    if (!options_.geometry.empty()) {
      paint.measurement->rows.clear();
      for (const paint::Geometry& geometry : chosen_)
        paint.measurement->rows.push_back(
            {geometry, paint::lab_at(*paint.appearance, paint::aspecular_angle_deg(geometry))});
    }
    for (const paint::LabReading& row : paint.measurement->rows) from_curve.push_back(row.geometry);
  }
  if (!format_.only_rows) return {};
  if (!paint.measurement)
    return input_error("paint \"{}\" has neither readings nor face and flop: a {} cannot hold it", paint.name,
                       format_.title);
  if (paint.measurement->rows.empty())
    return input_error("paint \"{}\" is not measured at {}: choose other geometries", paint.name, listed(chosen_));
  note_losses(paint, !measured || options_.geometry.empty(), remarks);
  return {};
}

std::string Selection::explanation() const {
  std::string text = fmt::format("output: {}\n", format_.title);
  if (!options_.geometry.empty())
    text += fmt::format("rows: only {}; {}\n", listed(chosen_),
                        format_.only_rows ? "those that are missing come from the curve, as the column origin says"
                                          : "designed paints are evaluated there");
  else if (format_.is_wide)
    text += fmt::format("rows: {}, the usual six; others need --geometry\n", listed(chosen_));
  else
    text += fmt::format(
        "rows: all that were measured{}\n",
        format_.only_rows ? "; paints with face and flop also at 15, 25, 45, 75 and 110 deg, from the curve" : "");
  if (options_.fit_appearance) text += "face, flop and travel: fitted to the rows, about 20 microseconds a paint\n";
  if (format_.only_rows)
    text += fmt::format("left out: lobes, face and flop, maps and foreign elements{}\n",
                        options_.columns == "all" || format_.has_gloss
                            ? ""
                            : "; gloss, class, code, instrument, serial and date (--columns all keeps them)");
  return text;
}

}  // namespace goniochrome::tool
