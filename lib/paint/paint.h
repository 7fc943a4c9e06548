// One paint in its three representations: rows measured at aspecular angles, a curve, and a face and a flop; and the
// lobes that were fitted to it. [Shimizu2009] 3.3; goniochrome-paint(7), "PAINT REPRESENTATIONS"; goniochrome-paint(5)
// describes the file format.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "color/color.h"
#include "paint/geometry.h"

namespace goniochrome::paint {

enum class PaintClass { kUnknown, kSolid, kMetallic, kPearl, kInterference };

struct LabReading {
  Geometry geometry;
  color::Lab lab;
};

// Reflectance factors (1 = perfect diffuser) at equal steps of wavelength.
struct SpectrumReading {
  Geometry geometry;
  double from_nm = 400, step_nm = 10;
  std::vector<double> factors;

  double to_nm() const { return from_nm + step_nm * (static_cast<double>(factors.size()) - 1); }
};

// A reading of the texture of a paint by an instrument, such as its sparkle. Such values are on the instrument's own
// scale: they compare only with those of the same instrument and version, and nothing computes them from others.
struct TextureReading {
  std::string quantity;  // as the instrument calls it: "Sparkle Grade"
  std::string
      geometry;  // of its light: the name of a geometry, or the instrument's own word, such as "15d" or "diffuse"
  std::string version;  // of the scale, where it is stated
  double value = 0;
};

// Statements of an instrument or a designer: Lab at several geometries, all under one viewing condition; and the
// spectra behind them, where they are known. Whoever changes rows removes the spectra.
struct Measurement {
  color::ViewingCondition condition;
  std::string instrument;
  std::vector<LabReading> rows;
  std::vector<SpectrumReading> spectra = {};
  std::vector<TextureReading> textures = {};
  std::string date = {};    // paint/date.h; of a mean, the span of its readings
  std::string serial = {};  // of the instrument
};

struct GlossReading {
  double angle_deg = 60;  // 20 | 60 | 85
  double gloss_units = 0;
};

// Face at 15 deg, flop, and the aspecular angle where the color stops changing (15 < travel <= 180).
struct Appearance {
  color::Lab face, flop;
  double travel_deg = 60;
  std::optional<double> residual_de00;  // of the fit that made it, where it came from a measurement
};

struct Anisotropy {
  double alpha_x = 0, alpha_y = 0;
  bool operator==(const Anisotropy&) const = default;
};

// The flat mirrors in the base of a paint. goniochrome-flakes(7)
struct Flakes {
  double diameter_um = 30;
  double coverage = 0.5;    // in (0,1]: the part of the surface that they cover
  double spread_deg = 0.5;  // of the light that one flake reflects from a point, one standard deviation
  bool operator==(const Flakes&) const = default;

  double per_m2() const;
};
inline constexpr double kMostFlake_um = 1000, kMostFlakeSpread_deg = 30;

struct ColorMapReference {
  std::string href;
  double index = 1.5;
};

// The exponent that stands for the mirror: a lobe without width, whose weight is a share of what Fresnel's equations
// reflect.
inline constexpr double kMirrorExponent = std::numeric_limits<double>::infinity();
constexpr bool is_mirror(double exponent) {
  return exponent == kMirrorExponent;
}

// One lobe's weights, in 1/sr per working-space channel; of the mirror, the weight times Fresnel.
struct Lobe {
  double exponent = 1;
  color::Rgb directional_diffuse;
  color::Rgb gloss;
  bool operator==(const Lobe&) const = default;

  bool is_mirror() const { return paint::is_mirror(exponent); }
};

// The weights at one angle of the viewer from the normal.
struct ViewLobes {
  double view_deg = 0;  // 0..90
  color::Rgb diffuse;
  std::vector<Lobe> lobes;
  bool operator==(const ViewLobes&) const = default;
};

// A lobe cos^E about an axis that stands beside the mirror direction: turned by `tilt_deg` away from the normal within
// the plane of incidence, then by `out_deg` out of that plane. Where out_deg is not 0 there are two such lobes, one on
// either side of the plane. goniochrome-interference(7), "TILTED LOBES".
struct TiltedLobe {
  double exponent = 1;
  double tilt_deg = 0, out_deg = 0;
  bool operator==(const TiltedLobe&) const = default;

  int lookups() const { return out_deg != 0 ? 2 : 1; }
};

// Their weights at one angle of the viewer from the normal: the share of even light that each lobe, or each pair, sends
// to the viewer. All are 0 or more.
struct TiltedView {
  double view_deg = 0;  // 0..90
  color::Rgb diffuse;   // K_D, 1/sr
  std::vector<color::Rgb> weights;
  bool operator==(const TiltedView&) const = default;
};

// Lobes that stand for the color map of a paint in image light, in the place of K_D and K_DD.
struct TiltedLobes {
  double mean_de00 = 0;  // from the map, in the lights that the lobes were fitted in
  std::vector<TiltedLobe> lobes;
  std::vector<TiltedView> views;  // two or more, ascending; weights are linear between two of them
  bool operator==(const TiltedLobes&) const = default;

  // In prefiltered maps, beside the diffuse map.
  int lookups() const {
    int sum = 0;
    for (const TiltedLobe& lobe : lobes) sum += lobe.lookups();
    return sum;
  }
};

// The coat index of a paint without a coat: it neither reflects nor takes light away.
inline constexpr double kNoCoat = 1;
// Other coats have an index from here to there. brdf::kCoatIndex is the usual one.
inline constexpr double kLeastCoatIndex = 1.5, kMostCoatIndex = 1.7;

// A paint fitted to a basis: f = T(theta_i) T(theta_o) (K_D + sum K_DD cos^E(theta_as)) + (1/cos_i) sum K_G
// cos^E(theta_as), where T is what the coat lets through.
struct LobeFit {
  std::string basis, method;
  double max_de00 = 0, mean_de00 = 0;
  double coat_index = kNoCoat;  // K_D and K_DD hold under such a coat
  color::Rgb diffuse;           // K_D, 1/sr
  std::vector<Lobe> lobes;
  // Weights that change with the view, ascending in view_deg, each set complete; linear between two of them and
  // constant beyond the ends. Where there are none, `diffuse` and `lobes` hold for every view; where there are, these
  // remain the best weights for all views together.
  std::vector<ViewLobes> views = {};
  // Approximations of the color map with more and more lobes; none: the lobes above stand for all light.
  std::vector<TiltedLobes> tilts = {};
};

struct Paint {
  std::string name;
  std::string code;
  PaintClass paint_class = PaintClass::kUnknown;
  std::optional<Measurement> measurement;
  std::vector<GlossReading> gloss;
  std::optional<Appearance> appearance;
  std::optional<Anisotropy> anisotropy;
  std::optional<ColorMapReference> color_map;
  std::optional<Flakes> flakes;      // that the paint states
  std::optional<double> coat_index;  // that the paint states; where it has lobes, theirs
  std::optional<LobeFit> lobes;
  // Elements of other vocabularies, kept as they came (serialized XML), in order.
  std::vector<std::string> foreign;
};

// The flakes that a paint states, or usual ones of its class; nothing for solids and unknown classes.
struct KnownFlakes {
  Flakes flakes;
  bool assumed = false;  // by class
};
std::optional<KnownFlakes> known_flakes(const Paint& paint);

// "30 um, coverage 0.5, spread 0.5 deg", with "assumed for class metallic" where the paint does not state them.
std::string flakes_text(const Paint& paint, const KnownFlakes& known);

const char* paint_class_name(PaintClass paint_class);

// The class of that name, or nothing: "solid", "metallic", "pearl", "interference", "unknown".
std::optional<PaintClass> paint_class_of(std::string_view name);

// The condition the Lab values of `paint` are relative to: its measurement's, or the default D65/10.
color::ViewingCondition condition_of(const Paint& paint);

}  // namespace goniochrome::paint
