#include "studio/paint_json.h"

#include "color/illuminant.h"
#include "studio/internal/json_reader.h"

namespace goniochrome::studio {

namespace {

Json measurement_json(const paint::Measurement& measurement) {
  Json json = {{"illuminant", measurement.condition.illuminant}, {"observer", measurement.condition.observer_deg}};
  if (!measurement.instrument.empty()) json["instrument"] = measurement.instrument;
  if (!measurement.serial.empty()) json["serial"] = measurement.serial;
  if (!measurement.date.empty()) json["date"] = measurement.date;
  json["rows"] = Json::array();
  for (const paint::LabReading& row : measurement.rows)
    json["rows"].push_back({{"geometry", paint::geometry_name(row.geometry)}, {"lab", lab_json(row.lab)}});
  for (const paint::SpectrumReading& spectrum : measurement.spectra)
    json["spectra"].push_back({{"geometry", paint::geometry_name(spectrum.geometry)},
                               {"from", spectrum.from_nm},
                               {"step", spectrum.step_nm},
                               {"factors", spectrum.factors}});
  for (const paint::TextureReading& texture : measurement.textures)
    json["textures"].push_back({{"quantity", texture.quantity},
                                {"geometry", texture.geometry},
                                {"version", texture.version},
                                {"value", texture.value}});
  return json;
}

Result<paint::Measurement> measurement_of(const Json& json) {
  JsonReader reader(json);
  paint::Measurement measurement;
  const double observer_deg = reader.number("observer", 10);
  if (observer_deg != 2 && observer_deg != 10) reader.fail("2 or 10", "observer");
  measurement.condition = color::condition_of(reader.text("illuminant", "D65"), observer_deg == 2 ? 2 : 10);
  measurement.instrument = reader.text("instrument", "");
  measurement.serial = reader.text("serial", "");
  measurement.date = reader.text("date", "");
  for (const Json& element : reader.list("rows")) {
    JsonReader row(element);
    GONIO_ASSIGN(const paint::Geometry geometry, paint::parse_geometry(row.text("geometry")));
    measurement.rows.push_back({geometry, row.lab("lab")});
    GONIO_TRY(row.status());
  }
  for (const Json& element : reader.list("spectra")) {
    JsonReader row(element);
    GONIO_ASSIGN(const paint::Geometry geometry, paint::parse_geometry(row.text("geometry")));
    measurement.spectra.push_back({geometry, row.number("from"), row.number("step"), row.numbers("factors")});
    GONIO_TRY(row.status());
  }
  for (const Json& element : reader.list("textures")) {
    JsonReader of(element);
    measurement.textures.push_back(
        {of.text("quantity"), of.text("geometry", ""), of.text("version", ""), of.number("value")});
    GONIO_TRY(of.status());
  }
  GONIO_TRY(reader.status());
  return Result(std::move(measurement));
}

}  // namespace

Json lab_json(const color::Lab& lab) {
  return Json::array({json_number(lab.L), json_number(lab.a), json_number(lab.b)});
}

Json paint_json(const paint::Paint& paint) {
  Json json = {{"name", paint.name}};
  if (!paint.code.empty()) json["code"] = paint.code;
  if (paint.paint_class != paint::PaintClass::kUnknown) json["class"] = paint::paint_class_name(paint.paint_class);
  if (paint.measurement) json["measurement"] = measurement_json(*paint.measurement);
  for (const paint::GlossReading& gloss : paint.gloss)
    json["gloss"].push_back(Json::array({gloss.angle_deg, gloss.gloss_units}));
  if (paint.appearance) {
    json["appearance"] = {{"face", lab_json(paint.appearance->face)},
                          {"flop", lab_json(paint.appearance->flop)},
                          {"travel", paint.appearance->travel_deg}};
    if (paint.appearance->residual_de00) json["appearance"]["residual"] = *paint.appearance->residual_de00;
  }
  if (paint.anisotropy) json["anisotropy"] = Json::array({paint.anisotropy->alpha_x, paint.anisotropy->alpha_y});
  if (paint.color_map) json["color_map"] = {{"href", paint.color_map->href}, {"index", paint.color_map->index}};
  if (paint.coat_index) json["coat"] = *paint.coat_index;
  if (const auto& flakes = paint.flakes)
    json["flakes"] = Json::array({flakes->diameter_um, flakes->coverage, flakes->spread_deg});
  if (!paint.foreign.empty()) json["foreign"] = paint.foreign;
  return json;
}

Result<paint::Paint> paint_of_json(const Json& json) {
  JsonReader reader(json);
  paint::Paint paint;
  paint.name = reader.text("name");
  paint.code = reader.text("code", "");
  if (const auto known = paint::paint_class_of(reader.text("class", "unknown"))) paint.paint_class = *known;
  if (reader.has("measurement")) {
    GONIO_ASSIGN(paint.measurement, measurement_of(reader.member("measurement")));
  }
  for (const Json& reading : reader.list("gloss")) {
    if (!reading.is_array() || reading.size() != 2 || !reading[0].is_number() || !reading[1].is_number()) {
      reader.fail("pairs of angle and gloss units", "gloss");
      break;
    }
    paint.gloss.push_back({reading[0].get<double>(), reading[1].get<double>()});
  }
  if (reader.has("appearance")) {
    JsonReader of(reader.member("appearance"));
    paint.appearance = paint::Appearance{of.lab("face"), of.lab("flop"), of.number("travel"), std::nullopt};
    if (of.has("residual")) paint.appearance->residual_de00 = of.number("residual");
    GONIO_TRY(of.status());
  }
  if (reader.has("anisotropy")) {
    const std::vector<double> alpha = reader.numbers("anisotropy", 2);
    paint.anisotropy = paint::Anisotropy{alpha[0], alpha[1]};
  }
  if (reader.has("color_map")) {
    JsonReader of(reader.member("color_map"));
    paint.color_map = paint::ColorMapReference{of.text("href"), of.number("index")};
    GONIO_TRY(of.status());
  }
  if (reader.has("coat")) paint.coat_index = reader.number("coat");
  if (reader.has("flakes")) {
    const std::vector<double> flakes = reader.numbers("flakes", 3);
    paint.flakes = paint::Flakes{flakes[0], flakes[1], flakes[2]};
  }
  for (const Json& element : reader.list("foreign"))
    if (element.is_string()) paint.foreign.push_back(element.get<std::string>());
  GONIO_TRY(reader.status());
  return Result(std::move(paint));
}

}  // namespace goniochrome::studio
