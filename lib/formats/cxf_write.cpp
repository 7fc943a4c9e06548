#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "formats/cxf.h"
#include "formats/internal/xml_stream.h"
#include "paint/date.h"

namespace goniochrome::formats {

namespace {

// The illuminants that CxF3 has a word for.
bool has_word(const std::string& illuminant) {
  static const std::vector<std::string> kWords = {"A",    "B",    "C",    "D50",  "D55",  "D60", "D65", "D75",
                                                  "E",    "F2",   "F3",   "F7",   "F9",   "F10", "F11", "F12",
                                                  "9300", "TL84", "TL83", "UL30", "UL35", "UL50"};
  return std::ranges::find(kWords, illuminant) != kWords.end();
}

// True if the schema of CxF3 allows the spectrum.
bool allowed(const paint::SpectrumReading& spectrum) {
  constexpr std::array kSteps_nm = {1.0, 2.0, 5.0, 10.0, 20.0};
  return spectrum.from_nm >= 360 && spectrum.from_nm <= 400 && spectrum.from_nm == std::floor(spectrum.from_nm) &&
         std::ranges::find(kSteps_nm, spectrum.step_nm) != kSteps_nm.end() &&
         std::ranges::all_of(spectrum.factors, [](double factor) { return factor > -0.1 && factor < 3; });
}

// XML Schema takes a text for date and time only if it has seconds.
bool is_date_time(std::string_view date) {
  constexpr std::size_t kWithSeconds = 19, kOffset = 6;
  if (date.find("..") != std::string_view::npos || !paint::seconds_of_date(date) || date.size() < kWithSeconds ||
      date[kWithSeconds - 3] != ':')
    return false;
  std::string_view zone = date.substr(kWithSeconds);
  if (zone.starts_with('.')) zone.remove_prefix(std::min(zone.find_first_not_of("0123456789", 1), zone.size()));
  return zone.empty() || zone == "Z" || zone.size() == kOffset;
}

}  // namespace

Result<CxfWriter> CxfWriter::begin(OutputFile file, const Info& info) {
  CxfWriter writer(std::move(file), info);
  GONIO_TRY(
      writer.file_.write(fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                                     "<cc:CxF xmlns:cc=\"http://colorexchangeformat.com/CxF3-core\">\n"
                                     "  <cc:FileInformation>\n"
                                     "    <cc:Creator>{}</cc:Creator>\n    <cc:CreationDate>{}</cc:CreationDate>\n"
                                     "    <cc:Description>{}</cc:Description>\n"
                                     "  </cc:FileInformation>\n"
                                     "  <cc:Resources>\n",
                                     xml_escaped(plain_utf8(info.creator)), xml_escaped(plain_utf8(info.created)),
                                     xml_escaped(plain_utf8(info.description)))));
  return writer;
}

std::size_t CxfWriter::number_of(const Specification& specification) {
  const auto known = std::ranges::find(specifications_, specification);
  const auto number = static_cast<std::size_t>(known - specifications_.begin()) + 1;
  if (known == specifications_.end()) specifications_.push_back(specification);
  return number;
}

// Lab, and the spectrum behind it under the same specification.
std::string CxfWriter::color_values(const paint::Measurement& measurement, const paint::LabReading& row) {
  const auto spectrum = std::ranges::find_if(measurement.spectra, [&](const paint::SpectrumReading& candidate) {
    return candidate.geometry == row.geometry && allowed(candidate);
  });
  const bool spectral = spectrum != measurement.spectra.end();
  const std::size_t number = number_of({measurement.condition, measurement.instrument, measurement.serial, row.geometry,
                                        spectral ? spectrum->from_nm : 0, spectral ? spectrum->step_nm : 0});
  std::string text = fmt::format(
      "          <cc:ColorCIELab "
      "ColorSpecification=\"cs{}\"><cc:L>{}</cc:L><cc:A>{}</cc:A><cc:B>{}</cc:B></cc:ColorCIELab>\n",
      number, shortest(row.lab.L), shortest(row.lab.a), shortest(row.lab.b));
  if (!spectral) return text;
  text += fmt::format("          <cc:ReflectanceSpectrum ColorSpecification=\"cs{}\" StartWL=\"{}\">", number,
                      shortest(spectrum->from_nm));
  for (std::size_t i = 0; i < spectrum->factors.size(); ++i) text += (i ? " " : "") + shortest(spectrum->factors[i]);
  return text + "</cc:ReflectanceSpectrum>\n";
}

void CxfWriter::note_spectra_left_out(const paint::Paint& paint) {
  for (const paint::SpectrumReading& spectrum : paint.measurement->spectra) {
    const std::string place = fmt::format("{} at {}", paint.name, paint::geometry_name(spectrum.geometry));
    if (!allowed(spectrum))
      remarks_.note(
          "spectra are left out that CxF3 does not allow: it has factors from -0.1 to 3, in steps of 1, 2, 5, 10 or 20 "
          "nm from 360 to 400 nm on",
          place);
    else if (std::ranges::find(paint.measurement->rows, spectrum.geometry, &paint::LabReading::geometry) ==
             paint.measurement->rows.end())
      remarks_.note("spectra without L*, a* and b* beside them are left out", place);
  }
}

// `part` is the ending of the object's name where an angle has its own; the `first` of them carries class, code, gloss
// and the names of geometries from the curve. Our tags join the parts again.
std::string CxfWriter::object(const paint::Paint& paint, const std::vector<paint::LabReading>& rows,
                              const std::string& part, bool first, const std::string& curve) {
  // The schema wants date and time, and readers take the date of the file for none of a reading.
  const std::string& date = paint.measurement->date;
  const bool fits = is_date_time(date) && date != info_.created;
  std::string text = fmt::format(
      "      <cc:Object ObjectType=\"Standard\" Name=\"{}\" Id=\"o{}\">\n        "
      "<cc:CreationDate>{}</cc:CreationDate>\n"
      "        <cc:ColorValues>\n",
      xml_escaped(paint.name + part), ++objects_, xml_escaped(fits ? date : info_.created));
  for (const paint::LabReading& row : rows) text += color_values(*paint.measurement, row);
  text += "        </cc:ColorValues>\n";

  std::string tags;
  const auto tag = [&](const char* name, std::string_view value) {
    tags += fmt::format("          <cc:Tag Name=\"{}\" Value=\"{}\"/>\n", name, xml_escaped(value));
  };
  if (!part.empty()) tag("paint", paint.name);
  if (first && paint.paint_class != paint::PaintClass::kUnknown)
    tag("class", paint::paint_class_name(paint.paint_class));
  if (first && !paint.code.empty()) tag("code", paint.code);
  if (first && !date.empty() && !fits) tag("date", date);
  if (first && !curve.empty()) tag("curve", curve);
  if (!tags.empty())
    text += "        <cc:TagCollection Name=\"goniochrome\">\n" + tags + "        </cc:TagCollection>\n";

  if (first && !paint.gloss.empty()) {
    text += "        <cc:PhysicalAttributes>\n";
    for (const paint::GlossReading& gloss : paint.gloss)
      text += fmt::format("          <cc:Gloss Method=\"{} deg\">{}</cc:Gloss>\n", shortest(gloss.angle_deg),
                          shortest(gloss.gloss_units));
    text += "        </cc:PhysicalAttributes>\n";
  }
  return text + "      </cc:Object>\n";
}

Result<void> CxfWriter::write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve) {
  if (!paint.measurement || paint.measurement->rows.empty())
    return input_error("paint \"{}\" has no readings: CxF holds readings only", paint.name);
  GONIO_TRY(check_writable(paint));
  for (const paint::LabReading& row : paint.measurement->rows)
    if (row.lab.L < 0)
      return input_error("paint \"{}\" at {}: L* is {}: CxF3 allows none below 0", paint.name,
                         paint::geometry_name(row.geometry), shortest(row.lab.L));
  std::string text = objects_ == 0 ? "    <cc:ObjectCollection>\n" : "", curve;
  for (const paint::Geometry& geometry : from_curve)
    curve += (curve.empty() ? "" : " ") + paint::geometry_name(geometry);
  note_spectra_left_out(paint);
  if (!info_.one_object_per_angle) {
    text += object(paint, paint.measurement->rows, "", true, curve);
  } else {
    for (const paint::LabReading& row : paint.measurement->rows)
      text += object(paint, {row}, " " + paint::geometry_name(row.geometry), &row == &paint.measurement->rows.front(),
                     curve);
  }
  return file_.write(text);
}

Result<void> CxfWriter::finish() {
  std::string text = objects_ ? "    </cc:ObjectCollection>\n    <cc:ColorSpecificationCollection>\n" : "";
  for (const Specification& specification : specifications_) {
    const paint::Geometry& geometry = specification.geometry;
    const std::string& illuminant = specification.condition.illuminant;
    text += fmt::format(
        "      <cc:ColorSpecification Id=\"cs{}\">\n        <cc:TristimulusSpec>\n          {}\n"
        "          <cc:Observer>{}_Degree</cc:Observer>\n          <cc:Method>unknown</cc:Method>\n"
        "        </cc:TristimulusSpec>\n        <cc:MeasurementSpec>\n"
        "          <cc:MeasurementType>{}</cc:MeasurementType>\n"
        "          <cc:GeometryChoice>\n            <cc:MultiAngle>\n"
        "              <cc:BRDFAngle Notation=\"{}\">\n"
        "                <cc:IlluminationAngle>{}</cc:IlluminationAngle>\n"
        "                <cc:Aspecular>{}</cc:Aspecular>\n",
        number_of(specification),
        has_word(illuminant)
            ? fmt::format("<cc:Illuminant>{}</cc:Illuminant>", illuminant)
            : fmt::format("<cc:Illuminant Name=\"{}\">Custom</cc:Illuminant>", xml_escaped(illuminant)),
        specification.condition.observer_deg,
        specification.step_nm > 0 ? "Spectrum_Reflectance" : "Colorimetric_Reflectance", paint::geometry_name(geometry),
        shortest(geometry.incidence_deg), shortest(geometry.aspecular_deg));
    if (geometry.out_of_plane)
      text += fmt::format("                <cc:Azimuth>{}</cc:Azimuth>\n", shortest(geometry.azimuth_deg));
    text += "              </cc:BRDFAngle>\n            </cc:MultiAngle>\n          </cc:GeometryChoice>\n";
    if (specification.step_nm > 0)
      text += fmt::format("          <cc:WavelengthRange StartWL=\"{}\" Increment=\"{}\"/>\n",
                          shortest(specification.from_nm), shortest(specification.step_nm));
    if (!specification.instrument.empty() || !specification.serial.empty()) {
      text += "          <cc:Device>\n";
      for (const auto& [element, value] :
           {std::pair("Model", &specification.instrument), {"SerialNumber", &specification.serial}})
        if (!value->empty()) text += fmt::format("            <cc:{0}>{1}</cc:{0}>\n", element, xml_escaped(*value));
      text += "          </cc:Device>\n";
    }
    text += "        </cc:MeasurementSpec>\n      </cc:ColorSpecification>\n";
  }
  if (objects_) text += "    </cc:ColorSpecificationCollection>\n";
  GONIO_TRY(file_.write(text + "  </cc:Resources>\n</cc:CxF>\n"));
  return file_.commit();
}

}  // namespace goniochrome::formats
