// RGL tensor files with RGB or with bands of wavelength, as Mitsuba 3 and pbrt-v4 read them, and as brdf/measured.h
// does.
//
// The format stores f cos(theta_light) = color(s) D(h) / (4 sigma(view)) [DupuyJakob2018], in which s is where the half
// vector falls in a square that was warped so that the light of the material is spread over it evenly. The direction
// that comes first in the file is that of the viewer: renderers follow light backward. D and sigma of the file need not
// be those of real facets, since color is what remains; D is taken near the shape of the paint, so that color is
// smooth, and sigma is 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/angles.h"
#include "brdf/band_lobes.h"
#include "brdf/lobe_model.h"
#include "brdf/measured.h"
#include "materials/internal/ggx.h"
#include "materials/internal/shown.h"
#include "math/cosine_power.h"

namespace goniochrome::materials {

namespace {

// Angles of the viewer, nodes of the density of half vectors, and those of D.
constexpr std::size_t kViews = 37, kRows = 48, kColumns = 192, kFine = 1024;

// The polar angle of a node: the format takes the square root of the angle, which favors the mirror direction.
double polar_of(double u) {
  return u * u * kPi / 2;
}
double part(std::size_t i, std::size_t n) {
  return static_cast<double>(i) / static_cast<double>(n - 1);
}
double view_rad(std::size_t k) {
  return (k + 1 < kViews ? 2.5 * static_cast<double>(k) : 89.0) * kDegree;
}

double luminance(const color::Rgb& rgb) {
  return color::xyz_d65_from_rgb(rgb).Y;
}

// The image of the mirror lobe has no place in a table: it is widened to an orange peel of these slopes, a Gaussian
// distribution of half vectors.
constexpr double kMirrorSlope = 0.01;

double peak(double half_rad) {
  const double t = std::tan(half_rad) / kMirrorSlope, c = std::cos(half_rad);
  return half_rad < 0.2 ? std::exp(-t * t) / (kPi * kMirrorSlope * kMirrorSlope * c * c * c * c) : 0;
}

// What of the area of such a surface a viewer sees, relative to the area of the ground: cos, and more near grazing.
double peak_area(double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine), a = cosine / (kMirrorSlope * std::max(sine, 1e-9));
  if (a > 6) return cosine;
  return cosine * (1 + std::erf(a)) / 2 + kMirrorSlope * sine * std::exp(-a * a) / (2 * std::sqrt(kPi));
}

// A paint seen from one angle, whose values are f cos(theta_light) with the widened mirror: in Rec.709, or in bands.
template <std::size_t kChannels>
class SeenPaint {
 public:
  using Values = std::array<double, kChannels>;

  SeenPaint(double coat_index, double view_rad)
      : coat_index_(coat_index), view_(direction(view_rad, 0)), mirror_scale_(1 / (4 * peak_area(view_.z))) {}
  virtual ~SeenPaint() = default;
  const Vec3& view() const { return view_; }

  // Below the horizon what stands just above it goes on, so that the cells there interpolate well.
  Values operator()(Vec3 light, const Vec3& half, double half_rad) const {
    constexpr double kLowest = 1e-3;
    if (light.z < kLowest) {
      light.z = kLowest;
      light = normalized(light);
    }
    const double fresnel =
        brdf::fresnel_dielectric(std::clamp(dot(view_, half), 0.0, 1.0), brdf::mirror_index(coat_index_));
    return values(light, mirror_scale_ * fresnel * peak(half_rad));
  }

 protected:
  // `mirror` is what a mirror of weight 1 shows.
  virtual Values values(const Vec3& light, double mirror) const = 0;

 private:
  double coat_index_;
  Vec3 view_;
  double mirror_scale_;
};

class SeenRgb final : public SeenPaint<3> {
 public:
  static constexpr std::array<double, 3> kLuminance = {0.2126, 0.7152, 0.0722};  // of Rec.709

  SeenRgb(const paint::LobeFit& lobes, double view_rad) : SeenPaint(lobes.coat_index, view_rad), lobes_(lobes) {
    for (const paint::Lobe& lobe : brdf::at_view(lobes, view_rad / kDegree).lobes)
      if (lobe.is_mirror()) mirror_ = lobe.gloss;
  }

 private:
  Values values(const Vec3& light, double mirror) const override {
    const color::Rgb rgb =
        color::rec709_from_rec2020(light.z * brdf::coated_brdf(lobes_, light, view(), {0, 0, 1}) + mirror * mirror_);
    return {rgb.x, rgb.y, rgb.z};
  }

  const paint::LobeFit& lobes_;
  color::Rgb mirror_;
};

class SeenBands final : public SeenPaint<color::kBands> {
 public:
  SeenBands(const paint::BandLobes& lobes, double view_rad)
      : SeenPaint(lobes.coat_index, view_rad), lobes_(lobes), weights_(weights_at(lobes, view_rad / kDegree)) {}

 private:
  // Linear between two views, and constant beyond the ends.
  static paint::BandWeights weights_at(const paint::BandLobes& lobes, double view_deg) {
    const auto above = std::ranges::upper_bound(lobes.views, view_deg, {}, &paint::BandWeights::view_deg);
    if (above == lobes.views.begin()) return lobes.views.front();
    if (above == lobes.views.end()) return lobes.views.back();
    const paint::BandWeights &low = above[-1], &high = above[0];
    const double share = (view_deg - low.view_deg) / (high.view_deg - low.view_deg);
    paint::BandWeights mixed = low;
    const auto mix = [share](color::Bands& a, const color::Bands& b) {
      for (std::size_t k = 0; k < a.size(); ++k) a[k] = std::lerp(a[k], b[k], share);
    };
    mix(mixed.diffuse, high.diffuse);
    mix(mixed.mirror, high.mirror);
    for (std::size_t e = 0; e < lobes.exponents.size(); ++e) {
      mix(mixed.directional_diffuse[e], high.directional_diffuse[e]);
      mix(mixed.gloss[e], high.gloss[e]);
    }
    return mixed;
  }

  // f cos(theta_light) = cos T T (K_D + sum K_DD cos^E) + F(theta_h)/F(45) sum K_G cos^E, band by band.
  Values values(const Vec3& light, double mirror) const override {
    const double base = light.z * brdf::coat_passages(lobes_.coat_index, std::min(light.z, 1.0), view().z);
    const double gloss = brdf::coat_fresnel(half_cosine(light, view()));
    const double log_cos = math::log_cosine(paint::aspecular_angle_rad(light, view(), {0, 0, 1}));
    Values sum{};
    const auto add = [&sum](double scale, const color::Bands& weights) {
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += scale * weights[k];
    };
    add(base, weights_.diffuse);
    add(mirror, weights_.mirror);
    for (std::size_t e = 0; e < lobes_.exponents.size(); ++e) {
      const double power = math::power_of_cosine(log_cos, lobes_.exponents[e]);
      add(base * power, weights_.directional_diffuse[e]);
      add(gloss * power, weights_.gloss[e]);
    }
    return sum;
  }

  const paint::BandLobes& lobes_;
  paint::BandWeights weights_;
};

// D over u, and the density of half vectors by which the square is warped. D follows the luminance of the paint about
// its mirror direction. In the density no lobe has less than a tenth of the half vectors, so that weak and sharp ones
// get nodes as well.
struct Shapes {
  std::vector<double> facets = std::vector<double>(kFine);      // at kFine nodes
  std::vector<double> density = std::vector<double>(kColumns);  // at kColumns nodes
};

Shapes shapes_of(const paint::LobeFit& lobes) {
  Shapes shapes;
  struct Lobe {
    double weight, exponent;  // of the luminance along the mirror direction, 1/sr; mirror: of the light
  };
  std::vector<Lobe> parts;
  for (const paint::Lobe& lobe : lobes.lobes)
    parts.push_back({luminance(lobe.directional_diffuse + lobe.gloss), lobe.exponent});
  const auto value = [](const Lobe& lobe, double half_rad) {
    if (paint::is_mirror(lobe.exponent)) return 0.01 * peak(half_rad);  // a coat reflects some 4 %, and D is 4 f
    return half_rad < kPi / 4 ? std::pow(std::cos(2 * half_rad), lobe.exponent) : 0;
  };
  const auto shared = [&](auto&& of) {  // the integral over half vectors, cos dw
    double sum = 0;
    for (std::size_t i = 0; i < kFine; ++i) {
      const double u = part(i, kFine), t = polar_of(u);
      sum += of(t) * std::sin(t) * std::cos(t) * kPi * u * 2 * kPi / (kFine - 1);
    }
    return sum;
  };
  const double ground = std::max(luminance(lobes.diffuse), 1e-4);
  for (std::size_t i = 0; i < kFine; ++i) {
    const double t = polar_of(part(i, kFine));
    double sum = ground;
    for (const Lobe& lobe : parts) sum += lobe.weight * value(lobe, t);
    shapes.facets[i] = 4 * sum;
  }
  double total = kPi * ground;
  for (const Lobe& lobe : parts) total += lobe.weight * shared([&](double t) { return value(lobe, t); });
  const auto add = [&](double share, auto&& of) {
    const double scale = (0.1 + share / total) / shared(of);
    for (std::size_t i = 0; i < kColumns; ++i) shapes.density[i] += scale * of(polar_of(part(i, kColumns)));
  };
  add(kPi * ground, [](double t) { return std::cos(t); });
  // Nodes for the skirts of sharp lobes, where one part of the paint takes over from another: evenly over the logarithm
  // of the angle. Without them a white under a smooth coat was 6 dE00 off in a cell that reached from one to the other.
  add(0, [](double t) { return 1 / (t * t + kMirrorSlope * kMirrorSlope); });
  for (const Lobe& lobe : parts) {
    const auto of = [&](double t) { return value(lobe, t); };
    if (lobe.weight > 0) add(lobe.weight * shared(of), of);
  }
  return shapes;
}

double linear_at(const std::vector<double>& table, double u) {
  const double x = std::clamp(u, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(x), table.size() - 2);
  return std::lerp(table[low], table[low + 1], x - static_cast<double>(low));
}

// Where in cells 0..n-1 a density that is linear between its nodes has gathered `share` of its integral.
double gathered(const double* density, std::size_t n, double share) {
  double total = 0;
  for (std::size_t i = 1; i < n; ++i) total += (density[i - 1] + density[i]) / 2;
  double left = share * total;
  for (std::size_t i = 1; i < n; ++i) {
    const double a = density[i - 1], b = density[i], cell = (a + b) / 2;
    if (left > cell && i + 1 < n) {
      left -= cell;
      continue;
    }
    // a t + (b - a) t^2/2 = left, in the form that does not cancel.
    const double root = std::sqrt(std::max(0.0, a * a + 2 * left * (b - a)));
    const double t = a + root > 0 ? 2 * left / (a + root) : 0;
    return static_cast<double>(i - 1) + std::clamp(t, 0.0, 1.0);
  }
  return static_cast<double>(n - 1);
}

// The square has `nodes` by `nodes` places, with `channels` values at each.
struct Tables {
  Tables(std::size_t node_count, std::size_t channel_count)
      : nodes(node_count),
        channels(channel_count),
        visible(kViews * kRows * kColumns),
        colors(kViews * channels * nodes * nodes),
        luminance(kViews * nodes * nodes) {}
  std::size_t nodes, channels;
  std::vector<float> visible, colors, luminance;
};

// The density of visible half vectors over the square, rows of equal azimuth.
void fill_visible(const Shapes& shapes, const Vec3& view, float* out) {
  for (std::size_t j = 0; j < kRows; ++j)
    for (std::size_t i = 0; i < kColumns; ++i) {
      const double u = part(i, kColumns), t = polar_of(u);
      const Vec3 half = direction(t, (2 * part(j, kRows) - 1) * kPi);
      out[j * kColumns + i] = static_cast<float>(shapes.density[i] * std::max(dot(view, half), 0.0) * std::sin(t) * u);
    }
}

// One view: the square is inverted node by node, and the paint looked up at the light that each half vector stands for.
// `weights` make a luminance of its values.
template <std::size_t kChannels>
void fill_view(const SeenPaint<kChannels>& paint, const std::array<double, kChannels>& weights, const Shapes& shapes,
               std::size_t k, Tables& tables) {
  const std::size_t nodes = tables.nodes, square = nodes * nodes;
  float* visible = &tables.visible[k * kRows * kColumns];
  fill_visible(shapes, paint.view(), visible);
  std::vector<double> rows(kRows), row(kColumns);
  for (std::size_t j = 0; j < kRows; ++j)
    for (std::size_t i = 1; i < kColumns; ++i)
      rows[j] += (static_cast<double>(visible[j * kColumns + i - 1]) + visible[j * kColumns + i]) / 2;
  for (std::size_t j = 0; j < nodes; ++j) {
    const double y = gathered(rows.data(), kRows, part(j, nodes));
    const std::size_t low = std::min(static_cast<std::size_t>(y), kRows - 2);
    for (std::size_t i = 0; i < kColumns; ++i)
      row[i] = std::lerp(static_cast<double>(visible[low * kColumns + i]), visible[(low + 1) * kColumns + i],
                         y - static_cast<double>(low));
    const double azimuth = (2 * y / (kRows - 1) - 1) * kPi;
    for (std::size_t i = 0; i < nodes; ++i) {
      const double u = gathered(row.data(), kColumns, part(i, nodes)) / (kColumns - 1), t = polar_of(u);
      const Vec3 half = direction(t, azimuth);
      const auto f_cos = paint(2 * dot(paint.view(), half) * half - paint.view(), half, t);
      const double scale = 4 / linear_at(shapes.facets, u);
      const std::size_t at = j * nodes + i;
      double luminance = 0;
      // A color outside of Rec.709 has a value below 0, which Mitsuba carries through to its picture.
      for (std::size_t c = 0; c < kChannels; ++c) {
        tables.colors[(k * kChannels + c) * square + at] = static_cast<float>(scale * f_cos[c]);
        luminance += weights[c] * f_cos[c];
      }
      tables.luminance[k * square + at] = static_cast<float>(std::max(luminance / linear_at(shapes.density, u), 1e-6));
    }
  }
}

// The named arrays of a tensor file.
class TensorFile {
 public:
  void add(const std::string& name, const std::vector<std::size_t>& shape, const std::vector<float>& values) {
    fields_.push_back({name, 10, shape, std::string(reinterpret_cast<const char*>(values.data()), 4 * values.size())});
  }
  void add(const std::string& name, const std::string& bytes) { fields_.push_back({name, 1, {bytes.size()}, bytes}); }

  // "tensor_file", the version 1.0, the number of fields; of each its name, type, place and shape; then the values,
  // each field at a multiple of 8 bytes.
  std::string bytes() const {
    std::size_t place = 18;
    for (const Field& field : fields_) place += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
    std::string head("tensor_file\0\1\0", 14), body;
    put(head, static_cast<std::uint32_t>(fields_.size()));
    for (const Field& field : fields_) {
      body.append((8 - (place + body.size()) % 8) % 8, '\0');
      put(head, static_cast<std::uint16_t>(field.name.size()));
      head += field.name;
      put(head, static_cast<std::uint16_t>(field.shape.size()));
      put(head, field.type);
      put(head, static_cast<std::uint64_t>(place + body.size()));
      for (const std::size_t extent : field.shape) put(head, static_cast<std::uint64_t>(extent));
      body += field.bytes;
    }
    return head + body;
  }

 private:
  struct Field {
    std::string name;
    std::uint8_t type;  // 1: byte, 10: float of 32 bits
    std::vector<std::size_t> shape;
    std::string bytes;
  };
  template <class Number>
  static void put(std::string& bytes, Number value) {
    static_assert(std::endian::native == std::endian::little, "the format is little-endian");
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::vector<Field> fields_;
};

// The file; without wavelengths, the colors are RGB.
std::string file_of(const Shapes& shapes, const Tables& tables, const std::vector<float>& wavelengths_nm,
                    const Naming& naming) {
  std::vector<float> theta(kViews), facets;
  for (std::size_t k = 0; k < kViews; ++k) theta[k] = static_cast<float>(view_rad(k));
  for (int row = 0; row < 2; ++row)
    for (const double d : shapes.facets) facets.push_back(static_cast<float>(d));
  TensorFile file;
  file.add("description", naming.display + "\n" + naming.provenance);
  file.add("jacobian", std::string(1, '\1'));
  file.add("phi_i", {1}, {0});
  file.add("theta_i", {kViews}, theta);
  file.add("sigma", {2, 2}, {1, 1, 1, 1});
  file.add("ndf", {2, kFine}, facets);
  file.add("vndf", {1, kViews, kRows, kColumns}, tables.visible);
  file.add("luminance", {1, kViews, tables.nodes, tables.nodes}, tables.luminance);
  const bool is_rgb = wavelengths_nm.empty();
  if (!is_rgb) file.add("wavelengths", {wavelengths_nm.size()}, wavelengths_nm);
  file.add(is_rgb ? "rgb" : "spectra", {1, kViews, tables.channels, tables.nodes, tables.nodes}, tables.colors);
  return file.bytes();
}

// What the file shows, by our own reader of measured BRDFs. `color_of` makes a color of the values at a direction.
template <class ColorOf>
Result<Material> with_shown(std::string bytes, const paint::Paint& paint, const std::string& name,
                            const ColorOf& color_of) {
  GONIO_ASSIGN(const auto read, brdf::read_measured(name, bytes));
  const auto target = [&](const Vec3& light, const Vec3& view) { return color_of(read->value(view, light).f); };
  Material material{{}, shown(paint, target)};
  material.bytes = std::move(bytes);
  return material;
}

Result<Material> rgl_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const paint::LobeFit& lobes = *paint.lobes;
  const Shapes shapes = shapes_of(lobes);
  constexpr std::size_t kNodes = 64;
  Tables tables(kNodes, 3);
  for (std::size_t k = 0; k < kViews; ++k)
    fill_view(SeenRgb(lobes, view_rad(k)), SeenRgb::kLuminance, shapes, k, tables);
  return with_shown(file_of(shapes, tables, {}, naming), paint, naming.identifier + kRgl.ending,
                    [](const std::vector<double>& f) {
                      return color::rec2020_from_rec709({f[0], f[1], f[2]});
                    });
}

// The bands are those of the paint's spectra, which the color of its lobes is kept with.
Result<Material> rgl_spectral_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const paint::LobeFit& lobes = *paint.lobes;
  GONIO_ASSIGN(const color::BandObserver eye, color::BandObserver::make(paint::condition_of(paint).observer_deg));
  const auto bands = brdf::band_lobes(paint, eye);
  if (!bands.ok()) return input_error("paint \"{}\": {}", paint.name, bands.error().message);
  const Shapes shapes = shapes_of(lobes);
  constexpr std::size_t kNodes = 48;
  Tables tables(kNodes, color::kBands);
  std::vector<float> wavelengths;
  std::array<double, color::kBands> luminances{};
  for (int band = 0; band < color::kBands; ++band) {
    wavelengths.push_back(static_cast<float>(color::band_nm(band)));
    luminances[static_cast<std::size_t>(band)] = luminance(eye.weights()[static_cast<std::size_t>(band)]);
  }
  for (std::size_t k = 0; k < kViews; ++k) fill_view(SeenBands(*bands, view_rad(k)), luminances, shapes, k, tables);
  return with_shown(file_of(shapes, tables, wavelengths, naming), paint, naming.identifier + kRglSpectral.ending,
                    [&](const std::vector<double>& f) {
                      color::Bands values{};
                      std::ranges::copy(f, values.begin());
                      return eye.rgb(values);
                    });
}

}  // namespace

const Target kRgl = {"rgl", ".bsdf", "a table of the paint and its coat, RGB, for Mitsuba 3", rgl_material};
const Target kRglSpectral = {"rgl-spectral", ".bsdf",
                             "the same table in bands of wavelength, of paints with spectra, for Mitsuba 3 and pbrt",
                             rgl_spectral_material};

}  // namespace goniochrome::materials
