#include <algorithm>

#include "base/text.h"
#include "formats/csv.h"
#include "formats/imported.h"
#include "formats/internal/csv_records.h"

namespace goniochrome::formats {

namespace {

constexpr const char* kOtherColumns = ",class,code,instrument,gloss20,gloss60,gloss85";

std::string lab_cells(const color::Lab& lab) {
  return fmt::format(",{},{},{}", shortest(lab.L), shortest(lab.a), shortest(lab.b));
}

// A heading's geometry: the aspecular angle alone in the plane of 45 deg incidence.
std::string column_name(const paint::Geometry& geometry) {
  const bool usual = geometry.incidence_deg == 45 && !geometry.out_of_plane && !geometry.reversed;
  return usual ? shortest(geometry.aspecular_deg) : paint::geometry_name(geometry);
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
  return text;
}

}  // namespace

Result<CsvPaintWriter> CsvPaintWriter::begin(OutputFile file, const CsvLayout& layout) {
  std::string head = layout.wide.empty() ? kLongHeader : "sample,illuminant,observer";
  for (const paint::Geometry& geometry : layout.wide) {
    const std::string name = column_name(geometry);
    head += fmt::format(",L{},a{},b{}", name, name, name);
  }
  if (layout.all_columns) head += kOtherColumns;
  if (layout.origin) head += ",origin";
  CsvPaintWriter writer(std::move(file), layout);
  GONIO_TRY(writer.file_.write(head + "\n"));
  return writer;
}

Result<void> CsvPaintWriter::write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve) {
  if (!paint.measurement || paint.measurement->rows.empty())
    return input_error("paint \"{}\" has no Lab values: a table cannot hold it", shown(paint.name));
  GONIO_TRY(check_writable(paint));
  const auto& [condition, instrument, rows, spectra, textures] = *paint.measurement;
  const std::string viewing = fmt::format(",{},{}", csv_cell(condition.illuminant), condition.observer_deg);
  const std::string others = layout_.all_columns ? other_cells(paint) : "";
  std::string text;
  if (layout_.wide.empty()) {
    for (const paint::LabReading& row : rows) {
      const bool curve = std::ranges::find(from_curve, row.geometry) != from_curve.end();
      text += csv_cell(paint.name) + "," + paint::geometry_name(row.geometry) + viewing + lab_cells(row.lab) + others;
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
  return file_.commit();
}

}  // namespace goniochrome::formats
