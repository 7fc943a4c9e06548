
#include "base/text.h"
#include "formats/internal/paint_elements.h"
#include "formats/internal/tilts_xml.h"
#include "formats/internal/xml_stream.h"
#include "formats/xml.h"

namespace goniochrome::formats {

namespace {

// ` name="text"`, escaped.
std::string attribute(std::string_view name, std::string_view text) {
  return fmt::format(" {}=\"{}\"", name, xml_escaped(text));
}
std::string attribute(std::string_view name, double value) {
  return fmt::format(" {}=\"{}\"", name, shortest(value));
}
// The attribute, or nothing if the text is empty.
std::string optional_attribute(std::string_view name, std::string_view text) {
  return text.empty() ? "" : attribute(name, text);
}

std::string lab_attributes(const color::Lab& lab) {
  return attribute("L", lab.L) + attribute("a", lab.a) + attribute("b", lab.b);
}
std::string rgb_attributes(const std::string& prefix, const color::Rgb& rgb) {
  return attribute(prefix + "r", rgb.x) + attribute(prefix + "g", rgb.y) + attribute(prefix + "b", rgb.z);
}

std::string measurement_element(const paint::Measurement& measurement) {
  std::string text = "    <measurement" + attribute("illuminant", measurement.condition.illuminant) +
                     attribute("observer", measurement.condition.observer_deg) +
                     optional_attribute("instrument", measurement.instrument) +
                     optional_attribute("serial", measurement.serial) + optional_attribute("date", measurement.date) +
                     ">\n";
  for (const paint::LabReading& row : measurement.rows)
    text += "      <lab" + attribute("geometry", paint::geometry_name(row.geometry)) + lab_attributes(row.lab) + "/>\n";
  for (const paint::SpectrumReading& spectrum : measurement.spectra) {
    text += "      <spectrum" + attribute("geometry", paint::geometry_name(spectrum.geometry)) +
            attribute("from", spectrum.from_nm) + attribute("to", spectrum.to_nm()) +
            attribute("step", spectrum.step_nm) + ">";
    for (std::size_t i = 0; i < spectrum.factors.size(); ++i)
      text += (i == 0 ? "" : " ") + shortest(spectrum.factors[i]);
    text += "</spectrum>\n";
  }
  for (const paint::TextureReading& texture : measurement.textures)
    text += "      <texture" + attribute("quantity", texture.quantity) + attribute("geometry", texture.geometry) +
            optional_attribute("version", texture.version) + attribute("value", texture.value) + "/>\n";
  return text + "    </measurement>\n";
}

std::string appearance_element(const paint::Appearance& appearance) {
  std::string text = "    <appearance" + attribute("travel", appearance.travel_deg);
  if (appearance.residual_de00) text += attribute("residual_de00", *appearance.residual_de00);
  return text + ">\n      <face" + lab_attributes(appearance.face) + "/>\n      <flop" +
         lab_attributes(appearance.flop) + "/>\n    </appearance>\n";
}

// <diffuse> and the <lobe> elements.
std::string weights(const std::string& indent, const color::Rgb& diffuse, const std::vector<paint::Lobe>& lobes) {
  std::string text = indent + "<diffuse" + rgb_attributes("", diffuse) + "/>\n";
  for (const paint::Lobe& lobe : lobes)
    text += indent + "<lobe" +
            (lobe.is_mirror() ? attribute("exponent", "mirror") : attribute("exponent", lobe.exponent)) +
            rgb_attributes("dd", lobe.directional_diffuse) + rgb_attributes("g", lobe.gloss) + "/>\n";
  return text;
}

std::string lobes_element(const paint::LobeFit& lobes) {
  std::string text = "    <lobes" + attribute("space", "lin_rec2020_scene") + attribute("basis", lobes.basis) +
                     attribute("method", lobes.method) + attribute("max_de00", lobes.max_de00) +
                     attribute("mean_de00", lobes.mean_de00) + ">\n" + weights("      ", lobes.diffuse, lobes.lobes);
  for (const paint::ViewLobes& view : lobes.views)
    text += "      <view" + attribute("angle", view.view_deg) + ">\n" + weights("        ", view.diffuse, view.lobes) +
            "      </view>\n";
  return text + "    </lobes>\n";
}

std::string paint_element(const paint::Paint& paint) {
  std::string text = "  <paint" + attribute("name", paint.name);
  if (paint.paint_class != paint::PaintClass::kUnknown)
    text += attribute("class", paint::paint_class_name(paint.paint_class));
  text += optional_attribute("code", paint.code) + ">\n";
  if (paint.measurement && !paint.measurement->rows.empty()) text += measurement_element(*paint.measurement);
  for (const paint::GlossReading& gloss : paint.gloss)
    text += fmt::format("    <gloss angle=\"{}\">{}</gloss>\n", shortest(gloss.angle_deg), shortest(gloss.gloss_units));
  if (paint.appearance) text += appearance_element(*paint.appearance);
  if (paint.anisotropy)
    text += "    <anisotropy" + attribute("alphaX", paint.anisotropy->alpha_x) +
            attribute("alphaY", paint.anisotropy->alpha_y) + "/>\n";
  if (paint.color_map)
    text += "    <colorMap" + attribute("href", paint.color_map->href) + attribute("index", paint.color_map->index) +
            "/>\n";
  std::optional<double> coat_index = paint.coat_index;
  if (paint.lobes && (coat_index || paint.lobes->coat_index != paint::kNoCoat)) coat_index = paint.lobes->coat_index;
  if (coat_index) text += "    <coat" + attribute("index", *coat_index) + "/>\n";
  if (paint.flakes)
    text += "    <flakes" + attribute("diameter_um", paint.flakes->diameter_um) +
            attribute("coverage", paint.flakes->coverage) + attribute("spread_deg", paint.flakes->spread_deg) + "/>\n";
  if (paint.lobes) text += lobes_element(*paint.lobes) + tilts_element(paint.lobes->tilts);
  for (const std::string& element : paint.foreign) text += "    " + element + "\n";
  return text + "  </paint>\n";
}

// Error: a text that XML cannot hold, or that a reader would refuse. It is found before anything is written.
Result<void> check_texts(const paint::Paint& paint) {
  const std::string* texts[] = {&paint.name,
                                &paint.code,
                                paint.measurement ? &paint.measurement->instrument : nullptr,
                                paint.measurement ? &paint.measurement->serial : nullptr,
                                paint.measurement ? &paint.measurement->date : nullptr,
                                paint.measurement ? &paint.measurement->condition.illuminant : nullptr,
                                paint.color_map ? &paint.color_map->href : nullptr,
                                paint.lobes ? &paint.lobes->basis : nullptr,
                                paint.lobes ? &paint.lobes->method : nullptr};
  if (paint.name.empty()) return input_error("a paint has no name: XML cannot hold it");
  for (const std::string* text : texts)
    if (text && !is_plain_utf8(*text))
      return input_error("paint \"{}\" holds a text that is not valid UTF-8 or has a control character: \"{}\"",
                         shown(paint.name), shown(*text));
  return {};
}

}  // namespace

Result<PaintWriter> PaintWriter::begin(OutputFile file, const std::vector<Processing>& history,
                                       const std::vector<std::string>& foreign) {
  std::string head =
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<paints xmlns=\"{}\" version=\"1\">\n", kPaintNamespace);
  for (const Processing& step : history)
    head += "  <processing" + attribute("tool", plain_utf8(step.tool)) +
            attribute("version", plain_utf8(step.version)) + attribute("command", plain_utf8(step.command)) + "/>\n";
  for (const std::string& element : foreign) head += "  " + element + "\n";
  PaintWriter writer(std::move(file));
  GONIO_TRY(writer.file_.write(head));
  return writer;
}

Result<void> PaintWriter::write(const paint::Paint& paint) {
  GONIO_TRY(check_texts(paint));
  GONIO_TRY(check_writable(paint));
  GONIO_TRY(file_.write(paint_element(paint)));
  return is_stream_ ? file_.flush() : Result<void>();
}

Result<void> PaintWriter::finish() {
  GONIO_TRY(file_.write("</paints>\n"));
  return file_.commit();
}

}  // namespace goniochrome::formats
