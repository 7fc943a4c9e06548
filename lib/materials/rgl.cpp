// RGL tensor files with RGB or with bands of wavelength, as Mitsuba 3 and pbrt-v4 read them, and as brdf/measured.h
// does.
//
// The format stores f cos(theta_light) = color(s) D(h) / (4 sigma(view)) [DupuyJakob2018], in which s is where the half
// vector falls in a square that was warped so that the light of the material is spread over it evenly. The direction
// that comes first in the file is that of the viewer: renderers follow light backward. D and sigma of the file need not
// be those of real facets, since color is what remains; both are taken so that color is smooth. D is near the shape of
// the paint about its mirror direction. sigma is the cosine of the viewer, because the image of the mirror grows by
// 1/cosine toward grazing angles, and a line between two tabulated views would pass far above that: with sigma = 1, a
// mirror was 12 % too bright halfway from 85 to 87.5 deg.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/angles.h"
#include "brdf/band_lobes.h"
#include "brdf/lobe_model.h"
#include "brdf/measured.h"
#include "materials/internal/ggx.h"
#include "materials/internal/seen_paint.h"
#include "materials/internal/shown.h"
#include "materials/internal/widened_mirror.h"
#include "math/cosine_power.h"

namespace goniochrome::materials {

namespace {

// Angles of the viewer, nodes of the density of half vectors, and those of D and sigma. The rows of the density stand
// at even steps of the azimuth, and two of them at a right angle to the plane of the viewer, to which the half vectors
// of a cosine lobe are confined near grazing.
constexpr std::size_t kViews = 37, kRows = 49, kColumns = 192, kFine = 1024;

// The polar angle of a node: the format takes the square root of the angle, which favors the mirror direction.
double polar_of(double u) {
  return u * u * kPi / 2;
}
double part(std::size_t i, std::size_t n) {
  return static_cast<double>(i) / static_cast<double>(n - 1);
}

// Near grazing the steps are even in the logarithm of the cosine, in which the shape of a lobe over half vectors
// changes: with steps of 0.3 a sharp lobe was 2 % too bright between two views.
double view_rad(std::size_t k) {
  constexpr std::array<double, 20> kGrazing_deg = {62.5, 65,   67.5, 70,   72.5, 75,   77.2, 79.2, 81,   82.6,
                                                   84,   85.1, 86,   86.7, 87.3, 87.8, 88.2, 88.6, 89.0, 89.5};
  constexpr std::size_t kEven = kViews - kGrazing_deg.size();
  return (k < kEven ? 3.75 * static_cast<double>(k) : kGrazing_deg[k - kEven]) * kDegree;
}

// Shapes of the tables: a paint as a diffuse ground and lobes, in luminance.
struct Shapes {
  struct Lobe {
    double weight, exponent;  // of the luminance along the mirror direction, 1/sr; mirror: of the light
  };
  double ground = 0;  // 1/sr
  std::vector<Lobe> lobes;
  std::vector<double> facets = std::vector<double>(kFine);  // D at kFine nodes of u
};

// A lobe has a wide tail in D, since near grazing its half vectors reach far to both sides of the plane of the viewer,
// where a narrow D would leave color steep.
Shapes shapes_of(const paint::LobeFit& lobes) {
  Shapes shapes;
  shapes.ground = std::max(color::luminance(lobes.diffuse), 1e-4);
  for (const paint::Lobe& lobe : lobes.lobes)
    shapes.lobes.push_back({color::luminance(lobe.directional_diffuse + lobe.gloss), lobe.exponent});
  constexpr double kTail = 0.3;
  for (std::size_t i = 0; i < kFine; ++i) {
    const double t = polar_of(part(i, kFine));
    double sum = shapes.ground;
    for (const auto& [weight, exponent] : shapes.lobes) {
      if (paint::is_mirror(exponent)) {
        sum += weight * 0.01 * mirror_peak(t);  // a coat reflects some 4 %, and D is 4 f
        continue;
      }
      if (t < kPi / 4) sum += weight * std::pow(std::cos(2 * t), exponent);
      sum += kTail * weight / (1 + 2 * exponent * t * t);
    }
    shapes.facets[i] = 4 * sum;
  }
  return shapes;
}

// The density of half vectors by which the square of one view is warped, at kRows x kColumns nodes; `smooth` is the
// same without the factors that it has at the pole and toward grazing half vectors.
struct Density {
  std::vector<double> smooth = std::vector<double>(kRows * kColumns);
  std::vector<float> visible = std::vector<float>(kRows * kColumns);
};

// Each half vector counts by the light that it stands for, so that the nodes follow a lobe where it is: near grazing,
// its half vectors lie in a narrow band at a right angle to the plane of the viewer. Every part of the paint has a
// least share of the nodes, so that weak and sharp ones get some as well. Two parts more have no light: they hold nodes
// for the skirts of sharp lobes, where one part takes over from another, evenly over the logarithm of the angle of the
// half vector, and over that off the mirror direction. Without them a white under a smooth coat was 6 dE00 off in a
// cell that reached from one to the other; with a share of 0.1 a sharp lobe reflected 5 % too much at 85 deg, with 0.3
// one percent.
constexpr std::size_t kWideParts = 3;
constexpr double kLeastShareOfWide = 0.3, kLeastShareOfLobe = 0.1;

double light_of_part(const Shapes& shapes, std::size_t part) {
  if (part == 0) return shapes.ground;
  if (part < kWideParts) return 0;
  const Shapes::Lobe& lobe = shapes.lobes[part - kWideParts];
  return lobe.weight * (paint::is_mirror(lobe.exponent) ? 0.01 : 1);
}

// The parts at a half vector: the ground, the two for skirts, the lobes.
void fill_parts(const Shapes& shapes, const Vec3& view, const Vec3& half, double half_rad, double* values) {
  constexpr double kLowest = 0.05, kSlope2 = kMirrorSlope * kMirrorSlope;
  const Vec3 light = 2 * std::max(dot(view, half), 0.0) * half - view;
  const double cos_off = std::clamp(light.z * view.z - light.x * view.x - light.y * view.y, 1e-9, 1.0);
  const double off_rad = 2 * std::asin(std::sqrt((1 - cos_off) / 2)), log_cos = std::log(cos_off);
  *values++ = std::max(light.z, kLowest);
  *values++ = 1 / (half_rad * half_rad + kSlope2);
  *values++ = 1 / (off_rad * off_rad + 4 * kSlope2);
  for (const Shapes::Lobe& lobe : shapes.lobes)
    *values++ = paint::is_mirror(lobe.exponent) ? mirror_peak(half_rad) : std::exp(lobe.exponent * log_cos);
}

Density density_of(const Shapes& shapes, const Vec3& view) {
  constexpr std::size_t kHalf = kRows / 2 + 1;  // the other rows mirror these
  const std::size_t parts = shapes.lobes.size() + kWideParts;
  std::vector<double> values(kHalf * kColumns * parts), factors(kHalf * kColumns), sums(parts), scales(parts);
  for (std::size_t j = 0; j < kHalf; ++j)
    for (std::size_t i = 0; i < kColumns; ++i) {
      const double u = part(i, kColumns), t = polar_of(u);
      const Vec3 half = direction(t, (2 * part(j, kRows) - 1) * kPi);
      double* at = &values[(j * kColumns + i) * parts];
      fill_parts(shapes, view, half, t, at);
      const double factor = std::max(dot(view, half), 0.0) * std::sin(t) * u;
      factors[j * kColumns + i] = factor;
      for (std::size_t k = 0; k < parts; ++k) sums[k] += factor * (j + 1 < kHalf ? 2 : 1) * at[k];
    }
  double total = 0;
  for (std::size_t k = 0; k < parts; ++k) total += light_of_part(shapes, k) * sums[k];
  for (std::size_t k = 0; k < parts; ++k) {
    const double light = light_of_part(shapes, k);
    if (sums[k] > 0 && (k < kWideParts || light > 0))
      scales[k] = (k < kWideParts ? kLeastShareOfWide : kLeastShareOfLobe) / sums[k] + light / total;
  }
  Density density;
  for (std::size_t j = 0; j < kHalf; ++j)
    for (std::size_t i = 0; i < kColumns; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < parts; ++k) sum += scales[k] * values[(j * kColumns + i) * parts + k];
      for (const std::size_t row : {j, kRows - 1 - j}) {
        density.smooth[row * kColumns + i] = sum;
        density.visible[row * kColumns + i] = static_cast<float>(sum * factors[j * kColumns + i]);
      }
    }
  return density;
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

// One view of a paint at a grid of places in the square: the values that the file has for color, the light that a value
// of 1 stands for, and the luminance. The surface is the same on both sides of the plane of the viewer, so that the
// grid has the first `rows` of its `nodes` rows alone.
template <std::size_t kChannels>
struct Grid {
  std::size_t nodes, rows;
  std::vector<std::array<double, kChannels>> colors;
  std::vector<double> lights, luminances;
};

// The square is inverted place by place, and the paint looked up at the light that each half vector stands for.
// `weights` make a luminance of its values.
template <std::size_t kChannels>
Grid<kChannels> grid_of(const SeenPaint<kChannels>& paint, const std::array<double, kChannels>& weights,
                        const Shapes& shapes, const Density& density, std::size_t nodes) {
  Grid<kChannels> grid{nodes, (nodes + 1) / 2, {}, {}, {}};
  std::vector<double> rows(kRows), row(kColumns), smooth(kColumns);
  for (std::size_t j = 0; j < kRows; ++j)
    for (std::size_t i = 1; i < kColumns; ++i)
      rows[j] += (static_cast<double>(density.visible[j * kColumns + i - 1]) + density.visible[j * kColumns + i]) / 2;
  for (std::size_t j = 0; j < grid.rows; ++j) {
    const double y = gathered(rows.data(), kRows, part(j, nodes));
    const std::size_t low = std::min(static_cast<std::size_t>(y), kRows - 2);
    const double share = y - static_cast<double>(low);
    for (std::size_t i = 0; i < kColumns; ++i) {
      const std::size_t here = low * kColumns + i, next = here + kColumns;
      row[i] = std::lerp(static_cast<double>(density.visible[here]), density.visible[next], share);
      smooth[i] = std::lerp(density.smooth[here], density.smooth[next], share);
    }
    const double azimuth = (2 * y / (kRows - 1) - 1) * kPi;
    for (std::size_t i = 0; i < nodes; ++i) {
      const double u = gathered(row.data(), kColumns, part(i, nodes)) / (kColumns - 1), t = polar_of(u);
      const Vec3 half = direction(t, azimuth);
      auto values = paint(2 * dot(paint.view(), half) * half - paint.view(), half, t);
      const double facets = linear_at(shapes.facets, u), at_place = linear_at(smooth, u);
      const double scale = 4 * mirror_area(paint.view().z) / facets;
      double luminance = 0;
      for (std::size_t c = 0; c < kChannels; ++c) {
        luminance += weights[c] * values[c];
        values[c] *= scale;
      }
      grid.colors.push_back(values);
      grid.lights.push_back(facets / at_place);
      grid.luminances.push_back(luminance / at_place);
    }
  }
  return grid;
}

// The colors at the nodes of a table, from a grid that has a place between each two of its nodes. Lines between the
// nodes pass above a curve that is hollow there: of a sharp lobe near grazing, a table of 80 nodes had 7 % too much
// light. So each node takes what is too much around it, and the light of the whole is kept: with p the hat function of
// a node, I the interpolation, and the light of a place for weights, the node gets f + int p (f - If) / int p. The
// integrals are by Simpson's rule, and no node loses more than half.
template <std::size_t kChannels>
std::array<double, kChannels> kept_light(const Grid<kChannels>& fine, std::size_t i, std::size_t j) {
  const std::size_t columns = fine.nodes, x = 2 * i, y = 2 * j;
  const auto color = [&](std::size_t column, std::size_t row) -> const auto& {
    return fine.colors[std::min(row, columns - 1 - row) * columns + column];
  };
  const auto& here = color(x, y);
  std::array<double, kChannels> excess{}, kept = here;
  double whole = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if ((x == 0 && dx < 0) || (y == 0 && dy < 0) || x + dx >= columns || y + dy >= columns) continue;
      const std::size_t column = x + dx, row = y + dy;
      // Simpson's weight times the hat function is the same at a node, 2 by 1, and between two, 4 by 1/2.
      const double weight = fine.lights[std::min(row, columns - 1 - row) * columns + column];
      whole += weight;
      if (dx == 0 && dy == 0) continue;
      const auto& between = color(column, row);
      for (std::size_t c = 0; c < kChannels; ++c) {
        // The place has two nodes beside it, or four around it.
        const double line =
            dx == 0 ? (here[c] + color(x, y + 2 * dy)[c]) / 2
            : dy == 0
                ? (here[c] + color(x + 2 * dx, y)[c]) / 2
                : (here[c] + color(x, y + 2 * dy)[c] + color(x + 2 * dx, y)[c] + color(x + 2 * dx, y + 2 * dy)[c]) / 4;
        excess[c] += weight * (line - between[c]);
      }
    }
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double least = std::min(here[c], here[c] / 2);
    kept[c] = std::max(here[c] - excess[c] / whole, least);
  }
  return kept;
}

// A color outside of Rec.709 has a value below 0, which Mitsuba carries through to its picture.
template <std::size_t kChannels>
void fill_view(const SeenPaint<kChannels>& paint, const std::array<double, kChannels>& weights, const Shapes& shapes,
               std::size_t k, Tables& tables) {
  const std::size_t nodes = tables.nodes, square = nodes * nodes;
  const Density density = density_of(shapes, paint.view());
  std::ranges::copy(density.visible, &tables.visible[k * kRows * kColumns]);
  const Grid<kChannels> fine = grid_of(paint, weights, shapes, density, 2 * nodes - 1);
  for (std::size_t j = 0; j < (nodes + 1) / 2; ++j)
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto colors = kept_light(fine, i, j);
      const double luminance = fine.luminances[2 * j * fine.nodes + 2 * i];
      for (const std::size_t row : {j, nodes - 1 - j}) {
        const std::size_t at = row * nodes + i;
        for (std::size_t c = 0; c < kChannels; ++c)
          tables.colors[(k * kChannels + c) * square + at] = static_cast<float>(colors[c]);
        tables.luminance[k * square + at] = static_cast<float>(std::max(luminance, 1e-6));
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
  std::vector<float> theta(kViews), facets, sigma;
  for (std::size_t k = 0; k < kViews; ++k) theta[k] = static_cast<float>(view_rad(k));
  for (int row = 0; row < 2; ++row)
    for (std::size_t i = 0; i < kFine; ++i) {
      facets.push_back(static_cast<float>(shapes.facets[i]));
      sigma.push_back(static_cast<float>(mirror_area(std::max(std::cos(polar_of(part(i, kFine))), 0.0))));
    }
  TensorFile file;
  file.add("description", naming.display + "\n" + naming.provenance);
  file.add("jacobian", std::string(1, '\1'));
  file.add("phi_i", {1}, {0});
  file.add("theta_i", {kViews}, theta);
  file.add("sigma", {2, kFine}, sigma);
  file.add("ndf", {2, kFine}, facets);
  file.add("vndf", {1, kViews, kRows, kColumns}, tables.visible);
  file.add("luminance", {1, kViews, tables.nodes, tables.nodes}, tables.luminance);
  const bool is_rgb = wavelengths_nm.empty();
  if (!is_rgb) file.add("wavelengths", {wavelengths_nm.size()}, wavelengths_nm);
  file.add(is_rgb ? "rgb" : "spectra", {1, kViews, tables.channels, tables.nodes, tables.nodes}, tables.colors);
  return file.bytes();
}

// The contents of the file, by our own reader of measured BRDFs. `color_of` makes a color of the values at a direction.
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
  constexpr std::size_t kNodes = 80;
  Tables tables(kNodes, 3);
  for (std::size_t k = 0; k < kViews; ++k)
    fill_view(SeenRgb(lobes, view_rad(k)), SeenRgb::kLuminance, shapes, k, tables);
  return with_shown(file_of(shapes, tables, {}, naming), paint, naming.identifier + kRgl.ending,
                    [](const std::vector<double>& f) { return color::rec2020_from_rec709({f[0], f[1], f[2]}); });
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
    luminances[static_cast<std::size_t>(band)] = color::luminance(eye.weights()[static_cast<std::size_t>(band)]);
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
