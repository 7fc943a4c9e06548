#include <algorithm>
#include <cmath>

#include "base/csv_records.h"
#include "base/text.h"
#include "formats/csv.h"
#include "formats/internal/csv_header.h"
#include "formats/internal/spectral_rows.h"

namespace goniochrome::formats {

namespace {

constexpr const char* kOtherColumns = ",class,code,instrument,gloss20,gloss60,gloss85,serial,date";

std::string lab_cells(const color::Lab& lab) {
  return fmt::format(",{},{},{}", shortest(lab.L), shortest(lab.a), shortest(lab.b));
}

// A heading's geometry: the aspecular angle alone in the plane of 45 deg incidence.
std::string column_name(const paint::Geometry& geometry) {
  const bool usual = geometry.incidence_deg == 45 && !geometry.out_of_plane && !geometry.reversed;
  return usual ? shortest(geometry.aspecular_deg) : paint::geometry_name(geometry);
}

// The i-th wavelength, without the last bits that adding up steps would leave.
double nm_of(const paint::SpectrumReading& spectrum, std::size_t i) {
  constexpr double kUnits = 1e9;
  return std::round((spectrum.from_nm + spectrum.step_nm * static_cast<double>(i)) * kUnits) / kUnits;
}

std::string listed_names(const std::vector<paint::Geometry>& geometries) {
  std::string text;
  for (const paint::Geometry& geometry : geometries) text += (text.empty() ? "" : " ") + paint::geometry_name(geometry);
  return text;
}

std::string other_cells(const paint::Paint& paint) {
  std::string text = fmt::format(",{},{},{}", paint::paint_class_name(paint.paint_class), csv_cell(paint.code),
                                 csv_cell(paint.measurement->instrument));
  for (const double angle_deg : {20.0, 60.0, 85.0}) {
    const auto gloss = std::ranges::find(paint.gloss, angle_deg, &paint::GlossReading::angle_deg);
    text += "," + (gloss == paint.gloss.end() ? "" : shortest(gloss->gloss_units));
  }
  return text + "," + csv_cell(paint.measurement->serial) + "," + csv_cell(paint.measurement->date);
}

}  // namespace

Result<CsvPaintWriter> CsvPaintWriter::begin(OutputFile file, const CsvLayout& layout) {
  CsvPaintWriter writer(std::move(file), layout);
  if (!layout.spectra) GONIO_TRY(writer.write_header());
  return writer;
}

Result<void> CsvPaintWriter::write_header() {
  has_header_ = true;
  std::string head = layout_.wide.empty() ? kLongHeader : "sample,illuminant,observer";
  for (const paint::Geometry& geometry : layout_.wide) {
    const std::string name = column_name(geometry);
    head += fmt::format(",L{},a{},b{}", name, name, name);
  }
  if (layout_.all_columns) head += kOtherColumns;
  for (std::size_t i = 0; i < wavelength_count_; ++i) head += "," + shortest(nm_of(*wavelengths_, i));
  if (layout_.origin) head += ",origin";
  return file_.write(head + "\n");
}

// Those that the reader takes for wavelengths again.
void CsvPaintWriter::choose_wavelengths(const paint::Measurement& measurement) {
  for (const paint::SpectrumReading& spectrum : measurement.spectra) {
    const std::size_t count = spectrum.factors.size();
    if (count < kFewestWavelengths || !wavelength_in(shortest(nm_of(spectrum, 0))) ||
        !wavelength_in(shortest(nm_of(spectrum, count - 1))))
      continue;
    wavelengths_ = {spectrum.geometry, spectrum.from_nm, spectrum.step_nm, {}};
    wavelength_count_ = count;
    return;
  }
}

bool CsvPaintWriter::has_columns_for(const paint::SpectrumReading& spectrum) const {
  return wavelengths_ && spectrum.from_nm == wavelengths_->from_nm && spectrum.step_nm == wavelengths_->step_nm &&
         spectrum.factors.size() == wavelength_count_;
}

std::string CsvPaintWriter::spectrum_cells(const paint::Paint& paint, const paint::Geometry& geometry) const {
  const auto& spectra = paint.measurement->spectra;
  const auto spectrum = std::ranges::find(spectra, geometry, &paint::SpectrumReading::geometry);
  const bool there = spectrum != spectra.end() && has_columns_for(*spectrum);
  std::string text;
  for (std::size_t i = 0; i < wavelength_count_; ++i) text += "," + (there ? shortest(spectrum->factors[i]) : "");
  return text;
}

void CsvPaintWriter::note_spectra_left_out(const paint::Paint& paint) {
  for (const paint::SpectrumReading& spectrum : paint.measurement->spectra) {
    const std::string place = fmt::format("{} at {}", paint.name, paint::geometry_name(spectrum.geometry));
    if (!wavelengths_)
      remarks_.note(
          fmt::format(
              "spectra are left out: the table has the wavelengths of its first paint, and that has no spectrum "
              "of {} or more from 300 to 1100 nm: put a paint with one first",
              kFewestWavelengths),
          place);
    else if (!has_columns_for(spectrum))
      remarks_.note("spectra are left out that have other wavelengths than the first paint of the table", place);
    else if (std::ranges::find(paint.measurement->rows, spectrum.geometry, &paint::LabReading::geometry) ==
             paint.measurement->rows.end())
      remarks_.note("spectra without L*, a* and b* beside them are left out", place);
  }
}

Result<void> CsvPaintWriter::write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve) {
  if (!paint.measurement || paint.measurement->rows.empty())
    return input_error("paint \"{}\" has no Lab values: a table cannot hold it", shown(paint.name));
  GONIO_TRY(check_writable(paint));
  const color::ViewingCondition& condition = paint.measurement->condition;
  const std::vector<paint::LabReading>& rows = paint.measurement->rows;
  if (!has_header_) {
    choose_wavelengths(*paint.measurement);
    GONIO_TRY(write_header());
  }
  if (layout_.spectra) note_spectra_left_out(paint);
  const std::string viewing = fmt::format(",{},{}", csv_cell(condition.illuminant), condition.observer_deg);
  const std::string others = layout_.all_columns ? other_cells(paint) : "";
  std::string text;
  if (layout_.wide.empty()) {
    for (const paint::LabReading& row : rows) {
      const bool curve = std::ranges::find(from_curve, row.geometry) != from_curve.end();
      text += csv_cell(paint.name) + "," + paint::geometry_name(row.geometry) + viewing + lab_cells(row.lab) + others +
              spectrum_cells(paint, row.geometry);
      text += layout_.origin ? curve ? ",curve\n" : ",row\n" : "\n";
    }
  } else {
    std::size_t placed = 0;
    text = csv_cell(paint.name) + viewing;
    for (const paint::Geometry& geometry : layout_.wide) {
      const auto row = std::ranges::find(rows, geometry, &paint::LabReading::geometry);
      placed += row != rows.end();
      text += row == rows.end() ? ",,," : lab_cells(row->lab);
    }
    if (placed < rows.size())
      return input_error("paint \"{}\" has rows at geometries that the table has no columns for", shown(paint.name));
    text += others + (layout_.origin ? "," + listed_names(from_curve) : "") + "\n";
  }
  GONIO_TRY(file_.write(text));
  return is_stream_ ? file_.flush() : Result<void>();
}

Result<void> CsvPaintWriter::finish() {
  if (!has_header_) GONIO_TRY(write_header());
  return file_.commit();
}

}  // namespace goniochrome::formats
