// ASAM OpenMATERIAL 3D 1.1.0: a material (.xomp) and its BRDF (_brdf.xompt), a table of wavelength, incidence, exit,
// azimuth and f, for simulations of sensors.
#include <fmt/format.h>

#include <cstdint>

#include "base/json.h"
#include "brdf/band_lobes.h"
#include "materials/internal/angle_table.h"
#include "materials/internal/shown.h"

namespace goniochrome::materials {

namespace {

constexpr const char* kVersion = "1.1.0";

// Two sums of FNV-1a as a UUID of version 8, whose bits an application chooses. The same paint has the same, always.
std::string uuid_of(std::string_view name, std::string_view rows) {
  const auto sum = [&](std::uint64_t hash) {
    for (const std::string_view text : {name, rows})
      for (const char byte : text) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    return hash;
  };
  const std::uint64_t high = sum(0xcbf29ce484222325), low = sum(0x84222325cbf29ce4);
  return fmt::format("{:08x}-{:04x}-8{:03x}-{:04x}-{:012x}", high >> 32, (high >> 16) & 0xffff, high & 0xfff,
                     0x8000 | ((low >> 48) & 0x3fff), low & 0xffffffffffff);
}

std::string schema(const char* name) {
  return fmt::format("https://raw.githubusercontent.com/asam-ev/OpenMATERIAL-3D/refs/tags/v{}/schemas/{}.json",
                     kVersion, name);
}

// Nobody has told who owns a paint, so that the fields which the format demands say that.
Json metadata(const Naming& naming, const std::string& uuid, const char* description) {
  return {{"name", naming.display},
          {"description", description + std::string(" ") + naming.provenance},
          {"uuid", uuid},
          {"materialVersion", "1.0.0"},
          {"openMaterial3dVersion", kVersion},
          {"copyrights", {"not stated"}},
          {"license", "NOASSERTION"},
          {"authors", {"not stated"}}};
}

// The schema has to be in the second line.
std::string table_file(const std::string& rows, const std::string& uuid, const Naming& naming) {
  Json about = metadata(naming, uuid,
                        "The paint with its coat, linear between the rows in each angle. An azimuth of 0 goes back to "
                        "the light, and the other half of the circle is the mirror image.");
  about["sources"] = "lobes fitted to readings of multi-angle instruments";
  about["typicalSensorTechnology"] = "camera";
  std::string wavelengths;
  for (int band = 0; band < color::kBands; ++band) wavelengths += (band > 0 ? ", " : "") + meters(band);
  return "{\n\"$schema\": " + json_text(Json(schema("material_brdf_schema"))) +
         ",\n\"metadata\": " + json_text(about, 1) + ",\n\"brdf\": {\n\"wavelengths\": [" + wavelengths +
         "],\n\"lookupTable\": [\n" + rows + "]}}\n";
}

Result<Material> openmaterial_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  GONIO_ASSIGN(const color::BandObserver eye, color::BandObserver::make(paint::condition_of(paint).observer_deg));
  const auto bands = brdf::band_lobes(paint, eye);
  if (!bands.ok()) return input_error("paint \"{}\": {}", paint.name, bands.error().message);
  const AngleTable table(*bands);
  Material material;
  material.shown = shown(paint, [&](const Vec3& light, const Vec3& view) { return eye.rgb(table.at(light, view)); });
  const std::string rows = table.rows(), uuid = uuid_of(naming.display, rows);
  material.companion = table_file(rows, uuid, naming);
  const Json file = {{"$schema", schema("material_schema")},
                     {"metadata", metadata(naming, uuid, "A paint and its coat.")},
                     {"materialProperties", {{"brdfUris", {naming.file_stem + kOpenMaterial.companion}}}}};
  material.bytes = json_text(file, 1) + "\n";
  return material;
}

}  // namespace

const Target kOpenMaterial = {"openmaterial",
                              ".xomp",
                              "a material of ASAM OpenMATERIAL 3D and its BRDF in bands of wavelength (_brdf.xompt), "
                              "of paints with spectra, for simulations of sensors",
                              openmaterial_material,
                              "_brdf.xompt",
                              4};

}  // namespace goniochrome::materials
