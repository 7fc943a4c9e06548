// Radiance: a BSDF in the XML format of WINDOW 6, whose data are a tensor tree of rank 3 for Y and for the chromaticity
// u'v'. A surface with the material BSDF shows it on the side of its normal. Radiance turns "Reflection Back" of the
// file to that side.
//
// The white of Radiance is the illuminant E, so that a gray paint has the chromaticity of E. What a table has no place
// for, the mirror of the coat, is widened as in a table for Mitsuba.
#include <cmath>
#include <vector>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "materials/internal/ggx.h"
#include "materials/internal/shown.h"
#include "materials/internal/tensor_tree.h"
#include "materials/internal/widened_mirror.h"

namespace goniochrome::materials {

namespace {

const color::Xyz kEqualEnergy{1, 1, 1};

color::Xyz white_of_space() {
  return color::xyz_d65_from_rgb({1, 1, 1});
}

// The weight of the mirror for a viewer at each degree from the normal.
std::vector<color::Rgb> mirror_weights(const paint::LobeFit& lobes) {
  std::vector<color::Rgb> weights;
  for (int deg = 0; deg <= 90; ++deg) {
    color::Rgb& weight = weights.emplace_back();
    for (const paint::Lobe& lobe : brdf::at_view(lobes, deg).lobes)
      if (lobe.is_mirror()) weight = lobe.gloss;
  }
  return weights;
}

// f with the widened mirror, in the working space.
class PaintInRadiance {
 public:
  explicit PaintInRadiance(const paint::LobeFit& lobes) : lobes_(lobes), weights_(mirror_weights(lobes)) {}

  color::Rgb operator()(const Vec3& light, const Vec3& view) const {
    color::Rgb f = brdf::coated_brdf(lobes_, light, view, {0, 0, 1});
    const Vec3 sum = light + view;
    const double half_rad = std::acos(std::min(1.0, sum.z / length(sum)));
    const double peak = mirror_peak(half_rad);
    if (peak <= 0 || light.z <= 0) return f;
    const double fresnel = brdf::fresnel_dielectric(half_cosine(light, view), brdf::mirror_index(lobes_.coat_index));
    const auto deg = static_cast<std::size_t>(std::lround(std::acos(std::min(1.0, view.z)) / kDegree));
    return f + fresnel * peak / (4 * mirror_area(view.z) * light.z) * weights_[deg];
  }

 private:
  const paint::LobeFit& lobes_;
  std::vector<color::Rgb> weights_;
};

std::string block(const char* wavelength, const char* detector, const std::string& data) {
  return fmt::format(
             "<WavelengthData>\n<LayerNumber>System</LayerNumber>\n<Wavelength unit=\"Integral\">{}</Wavelength>\n"
             "<SourceSpectrum>CIE Illuminant E</SourceSpectrum>\n<DetectorSpectrum>{}</DetectorSpectrum>\n"
             "<WavelengthDataBlock>\n<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n"
             "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n<ScatteringDataType>BRDF</ScatteringDataType>\n"
             "<ScatteringData>\n",
             wavelength, detector) +
         data + "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n";
}

std::string document(const TensorTree& tree, const Naming& naming) {
  std::string provenance = naming.provenance;
  for (auto at = provenance.find("?>"); at != std::string::npos; at = provenance.find("?>", at + 2))
    provenance.insert(at + 1, " ");
  return fmt::format(
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<?goniochrome {}?>\n"
             "<WindowElement xmlns=\"http://windows.lbl.gov\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
             "xsi:schemaLocation=\"http://windows.lbl.gov/BSDF-v1.4.xsd\">\n"
             "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>\n<Optical>\n<Layer>\n"
             "<Material>\n<Name>{}</Name>\n<Manufacturer></Manufacturer>\n<DeviceType>Other</DeviceType>\n</Material>\n"
             "<DataDefinition>\n<IncidentDataStructure>TensorTree3</IncidentDataStructure>\n</DataDefinition>\n",
             provenance, xml_escaped(naming.display)) +
         block("Visible", "ASTM E308 1931 Y.dsp", tree.text(0)) + block("CIE-u", "CIE-u", tree.text(1)) +
         block("CIE-v", "CIE-v", tree.text(2)) + "</Layer>\n</Optical>\n</WindowElement>\n";
}

Result<Material> radiance_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const PaintInRadiance seen(*paint.lobes);
  const color::Xyz white = white_of_space();
  const TensorTree tree([&](const Vec3& light, const Vec3& view) {
    return color::adapted(color::xyz_d65_from_rgb(seen(light, view)), white, kEqualEnergy);
  });
  Material material;
  material.shown = shown(paint, [&](const Vec3& light, const Vec3& view) {
    return color::rgb_from_xyz_d65(color::adapted(tree.at(light, view), kEqualEnergy, white));
  });
  material.bytes = document(tree, naming);
  return material;
}

}  // namespace

const Target kRadiance = {"radiance",        ".xml",  "a BSDF with a tensor tree in color, for Radiance",
                          radiance_material, nullptr, 4};

}  // namespace goniochrome::materials
