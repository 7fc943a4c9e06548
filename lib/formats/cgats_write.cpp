#include <algorithm>

#include "base/text.h"
#include "formats/cgats.h"

namespace goniochrome::formats {

namespace {

std::string on_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

// A value in quotation marks, on one line.
std::string cgats_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : on_one_line(text)) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

}  // namespace

Result<CgatsWriter> CgatsWriter::begin(OutputFile file, const std::string& creator, const std::string& created) {
  return CgatsWriter(std::move(file),
                     fmt::format("CGATS.17\n\nORIGINATOR\t{}\nFILE_DESCRIPTOR\t\"multi-angle CIELAB\"\nCREATED\t{}\n",
                                 cgats_text(creator), cgats_text(created)));
}

Result<void> CgatsWriter::write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve) {
  if (!paint.measurement || paint.measurement->rows.empty())
    return input_error("paint \"{}\" has no readings: CGATS holds readings only", paint.name);
  GONIO_TRY(check_writable(paint));
  paint::Paint kept;  // what the table has columns for
  // Rows of one name are one paint, and a line holds no tabs and line ends: names must differ in what is written.
  std::string name = on_one_line(paint.name);
  for (int n = 2; !names_.insert(name).second; ++n) name = fmt::format("{} ({})", on_one_line(paint.name), n);
  kept.name = name, kept.code = paint.code, kept.paint_class = paint.paint_class;
  kept.measurement = paint.measurement, kept.gloss = paint.gloss;
  paints_.push_back(std::move(kept));
  from_curve_.push_back(from_curve);
  return {};
}

Result<void> CgatsWriter::finish() {
  std::set<double> angles;
  std::size_t rows = 0;
  bool classes = false, codes = false, instruments = false, serials = false, dates = false, one_condition = true;
  for (const paint::Paint& paint : paints_) {
    rows += paint.measurement->rows.size();
    for (const paint::GlossReading& gloss : paint.gloss) angles.insert(gloss.angle_deg);
    classes = classes || paint.paint_class != paint::PaintClass::kUnknown;
    codes = codes || !paint.code.empty();
    instruments = instruments || !paint.measurement->instrument.empty();
    serials = serials || !paint.measurement->serial.empty(), dates = dates || !paint.measurement->date.empty();
    one_condition = one_condition && paint::condition_of(paint) == paint::condition_of(paints_.front());
  }
  std::vector<std::string> own = {"GEOMETRY", "ILLUMINANT", "OBSERVER"};
  for (const double angle : angles) own.push_back("GLOSS_" + shortest(angle));
  if (classes) own.push_back("PAINT_CLASS");
  if (codes) own.push_back("PAINT_CODE");
  if (instruments) own.push_back("INSTRUMENT");
  if (serials) own.push_back("INSTRUMENT_SERIAL");
  if (dates) own.push_back("DATE");
  const bool origins = std::ranges::any_of(from_curve_, [](const auto& geometries) { return !geometries.empty(); });
  if (origins) own.push_back("ORIGIN");

  std::string text = head_;
  if (!paints_.empty() && one_condition) {
    const color::ViewingCondition condition = paint::condition_of(paints_.front());
    text += fmt::format("WEIGHTING_FUNCTION\t{}\nWEIGHTING_FUNCTION\t\"OBSERVER, {} degree\"\n",
                        cgats_text("ILLUMINANT, " + condition.illuminant), condition.observer_deg);
  }
  for (const std::string& field : own) text += fmt::format("KEYWORD\t\"{}\"\n", field);
  text += fmt::format("\nNUMBER_OF_FIELDS\t{}\nBEGIN_DATA_FORMAT\nSAMPLE_ID\tSAMPLE_NAME\tLAB_L\tLAB_A\tLAB_B",
                      own.size() + 5);
  for (const std::string& field : own) text += '\t' + field;
  text += fmt::format("\nEND_DATA_FORMAT\n\nNUMBER_OF_SETS\t{}\nBEGIN_DATA\n", rows);
  GONIO_TRY(file_.write(text));

  std::size_t id = 0;
  for (const paint::Paint& paint : paints_) {
    const auto& from_curve = from_curve_[static_cast<std::size_t>(&paint - paints_.data())];
    std::string tail = fmt::format("\t{}\t{}", cgats_text(paint::condition_of(paint).illuminant),
                                   paint::condition_of(paint).observer_deg);
    for (const double angle : angles) {
      const auto found = std::ranges::find(paint.gloss, angle, &paint::GlossReading::angle_deg);
      tail += '\t' + (found == paint.gloss.end() ? "\"\"" : shortest(found->gloss_units));
    }
    if (classes) tail += fmt::format("\t{}", paint::paint_class_name(paint.paint_class));
    if (codes) tail += '\t' + cgats_text(paint.code);
    if (instruments) tail += '\t' + cgats_text(paint.measurement->instrument);
    if (serials) tail += '\t' + cgats_text(paint.measurement->serial);
    if (dates) tail += '\t' + cgats_text(paint.measurement->date);
    for (const paint::LabReading& row : paint.measurement->rows) {
      const bool curve = std::ranges::find(from_curve, row.geometry) != from_curve.end();
      const char* origin = origins ? curve ? "\tcurve" : "\trow" : "";
      GONIO_TRY(file_.write(fmt::format("{}\t{}\t{}\t{}\t{}\t{}{}{}\n", ++id, cgats_text(paint.name),
                                        shortest(row.lab.L), shortest(row.lab.a), shortest(row.lab.b),
                                        paint::geometry_name(row.geometry), tail, origin)));
    }
  }
  GONIO_TRY(file_.write("END_DATA\n"));
  return file_.commit();
}

}  // namespace goniochrome::formats
