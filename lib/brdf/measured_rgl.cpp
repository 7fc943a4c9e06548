// RGL's adaptive measurements as tensor files ([DupuyJakob2018]): RGB or a spectrum over a warped square for each angle
// of incidence.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/angles.h"
#include "brdf/internal/measured_formats.h"

namespace goniochrome::brdf {

namespace {

constexpr std::string_view kTensorMagic{"tensor_file\0", 12};

struct Tensor {
  std::vector<std::size_t> shape = {};
  std::vector<double> values = {};
};

// The named arrays of a tensor file; single floats only, and `description` as text.
class TensorFile {
 public:
  static Result<TensorFile> parse(const std::string& path, std::string_view bytes);
  Result<const Tensor*> field(const std::string& name, std::size_t rank) const {
    const auto found = fields_.find(name);
    if (found == fields_.end() && unread_.contains(name))
      return input_error("{}: field \"{}\" does not hold floats of 32 bits, as the format has them", path_, name);
    if (found == fields_.end()) return input_error("{}: has no field \"{}\"", path_, name);
    if (found->second.shape.size() != rank)
      return input_error("{}: field \"{}\" has {} dimensions, not {}", path_, name, found->second.shape.size(), rank);
    return &found->second;
  }
  bool has(const std::string& name) const { return fields_.contains(name) || unread_.contains(name); }
  const std::string& description() const { return description_; }

 private:
  std::string path_, description_;
  std::map<std::string, Tensor> fields_;
  std::set<std::string> unread_;  // fields of other types
};

Result<TensorFile> TensorFile::parse(const std::string& path, std::string_view bytes) {
  constexpr std::uint8_t kUint8 = 1, kFloat32 = 10;
  TensorFile file;
  file.path_ = path;
  const auto cut = [&] { return input_error("{}: the tensor file is cut within its header", path); };
  ByteReader reader(bytes.substr(kTensorMagic.size()));
  const auto version = reader.next<std::uint16_t>();
  const auto count = reader.next<std::uint32_t>();
  if (!count) return cut();
  if (*version != 1) return input_error("{}: tensor file of an unknown version", path);
  std::size_t used = 0;
  for (std::uint32_t i = 0; i < *count; ++i) {
    const auto name_length = reader.next<std::uint16_t>();
    const auto name = name_length ? reader.text(*name_length) : std::nullopt;
    const auto rank = reader.next<std::uint16_t>();
    const auto type = reader.next<std::uint8_t>();
    const auto offset = reader.next<std::uint64_t>();
    if (!name || !offset) return cut();
    Tensor tensor;
    std::size_t size = 1;
    for (std::uint16_t k = 0; k < *rank; ++k) {
      const auto extent = reader.next<std::uint64_t>();
      if (!extent) return cut();
      if (*extent == 0 || *extent > bytes.size() || size > bytes.size() / *extent)
        return input_error("{}: field \"{}\" is larger than the file", path, *name);
      size *= *extent;
      tensor.shape.push_back(*extent);
    }
    if (*type != kFloat32) file.unread_.insert(std::string(*name));
    if (*type != kFloat32 && *type != kUint8) continue;
    const std::size_t length = size * (*type == kFloat32 ? sizeof(float) : 1);
    if (*offset > bytes.size() || length > bytes.size() - *offset)
      return input_error("{}: field \"{}\" ends beyond the file: the file is cut", path, *name);
    // Fields that share their bytes would make arrays out of all proportion to the file.
    used += length;
    if (used > bytes.size()) return input_error("{}: its fields overlap: the file is damaged", path);
    const auto data = bytes.substr(*offset, length);
    if (*type == kUint8 && *name == "description") file.description_ = std::string(data);
    if (*type != kFloat32) continue;
    ByteReader values(data);
    for (std::size_t k = 0; k < size; ++k) {
      const double value = *values.next<float>();
      if (!std::isfinite(value)) return input_error("{}: field \"{}\" holds a value that is not finite", path, *name);
      tensor.values.push_back(value);
    }
    file.fields_[std::string(*name)] = std::move(tensor);
  }
  return file;
}

// A height x width table over the unit square, nodes on its border, bilinear between them.
struct Patch {
  Cell x, y;
  std::size_t width;

  Patch(std::size_t height, std::size_t w, double u, double v)
      : x(cell_at(u * static_cast<double>(w - 1), w)),
        y(cell_at(v * static_cast<double>(height - 1), height)),
        width(w) {}
  double of(std::span<const double> table) const {
    const auto row = [&](std::size_t j) {
      return std::lerp(table[j * width + x.low], table[j * width + x.low + 1], x.weight);
    };
    return std::lerp(row(y.low), row(y.low + 1), y.weight);
  }
};

// A density over the unit square and its integrals, in units of cells: along each row up to a node, and over rows.
struct Density {
  std::vector<double> value, along_row, over_rows;
};

Density density(std::span<const double> value, std::size_t height, std::size_t width) {
  Density result{{value.begin(), value.end()}, std::vector<double>(value.size()), std::vector<double>(height)};
  for (std::size_t j = 0; j < height; ++j)
    for (std::size_t i = 1; i < width; ++i) {
      const std::size_t k = j * width + i;
      result.along_row[k] = result.along_row[k - 1] + (value[k - 1] + value[k]) / 2;
    }
  const auto whole_row = [&](std::size_t j) { return result.along_row[(j + 1) * width - 1]; };
  for (std::size_t j = 1; j < height; ++j)
    result.over_rows[j] = result.over_rows[j - 1] + (whole_row(j - 1) + whole_row(j)) / 2;
  const double total = result.over_rows.back();
  for (auto* values : {&result.value, &result.along_row, &result.over_rows})
    for (double& v : *values) v /= total;
  return result;
}

// The integral to `t` of a line that starts at a and reaches b at t = 1.
double line_integral(double a, double b, double t) {
  return t * (a + t * (b - a) / 2);
}

struct RglTables {
  std::vector<double> theta_rad;      // angles of incidence, ascending
  Tensor sigma, ndf, colors;          // colors: of RGB, or of each wavelength
  std::size_t height = 0, width = 0;  // of the density of visible normals
  std::vector<Density> visible;       // one per angle of incidence
};

class RglBrdf final : public MeasuredBrdf {
 public:
  RglBrdf(MeasuredTraits traits, RglTables tables) : MeasuredBrdf(std::move(traits)), tables_(std::move(tables)) {}

  // The file's tables give f cos(theta_o); this is f.
  MeasuredValue value(const Vec3& light, const Vec3& view) const override {
    const Vec3 half = normalized(light + view);
    const double theta_i = polar_angle(light);
    const double turn = std::atan2(half.y, half.x) - std::atan2(light.y, light.x);
    const double u = std::sqrt(polar_angle(half) * 2 / kPi);
    double v = turn / (2 * kPi) + 0.5;
    v -= std::floor(v);
    MeasuredValue result{.f = std::vector<double>(tables_.colors.shape[2])};
    const auto above = std::upper_bound(tables_.theta_rad.begin(), tables_.theta_rad.end(), theta_i);
    const auto slice = std::clamp<std::ptrdiff_t>(above - tables_.theta_rad.begin() - 1, 0,
                                                  static_cast<std::ptrdiff_t>(tables_.theta_rad.size()) - 2);
    const double from = tables_.theta_rad[static_cast<std::size_t>(slice)];
    const double to = tables_.theta_rad[static_cast<std::size_t>(slice) + 1];
    const Cell incidence{static_cast<std::size_t>(slice), std::clamp((theta_i - from) / (to - from), 0.0, 1.0)};
    for (const double side : {v, 1 - v}) add(incidence, theta_i, u, side, 0.5 / view.z, result.f);
    if (std::min(incidence.weight, 1 - incidence.weight) > 1e-6) result.gap_deg = (to - from) / kDegree;
    return result;
  }

 private:
  // [DupuyJakob2018] and its data format: f cos(theta_o) = D(h) / (4 sigma(wi)) * color(s), where s is where the half
  // vector (u, v) falls after the density of visible normals has been flattened: row first, then within the row.
  void add(const Cell& incidence, double theta_i, double u, double v, double scale, std::vector<double>& f) const {
    const std::size_t w = tables_.width;
    const Patch at(tables_.height, w, u, v);
    const Density& a = tables_.visible[incidence.low];
    const Density& b = tables_.visible[incidence.low + 1];
    const auto mixed = [&](const std::vector<double> Density::*which, std::size_t k) {
      return std::lerp((a.*which)[k], (b.*which)[k], incidence.weight);
    };
    const auto between_rows = [&](const std::vector<double> Density::*which, std::size_t column) {
      return std::lerp(mixed(which, at.y.low * w + column), mixed(which, (at.y.low + 1) * w + column), at.y.weight);
    };
    const double in_row = between_rows(&Density::along_row, at.x.low) +
                          line_integral(between_rows(&Density::value, at.x.low),
                                        between_rows(&Density::value, at.x.low + 1), at.x.weight);
    const double whole = between_rows(&Density::along_row, w - 1);
    const double s = whole > 0 ? in_row / whole : at.x.weight;
    const double t = mixed(&Density::over_rows, at.y.low) +
                     line_integral(mixed(&Density::along_row, at.y.low * w + w - 1),
                                   mixed(&Density::along_row, (at.y.low + 1) * w + w - 1), at.y.weight);

    const auto of_square = [](const Tensor& table, double x, double y) {
      return Patch(table.shape[0], table.shape[1], x, y).of(table.values);
    };
    const double facets =
        of_square(tables_.ndf, u, v) / (4 * of_square(tables_.sigma, std::sqrt(theta_i * 2 / kPi), 0.5));
    const std::size_t rows = tables_.colors.shape[3], columns = tables_.colors.shape[4], size = rows * columns;
    const Patch texel(rows, columns, std::clamp(s, 0.0, 1.0), std::clamp(t, 0.0, 1.0));
    for (std::size_t c = 0; c < f.size(); ++c) {
      const auto table = [&](std::size_t slice) {
        return texel.of(std::span(tables_.colors.values).subspan((slice * f.size() + c) * size, size));
      };
      f[c] += scale * facets * std::lerp(table(incidence.low), table(incidence.low + 1), incidence.weight);
    }
  }

  RglTables tables_;
};

bool looks_rgl(std::string_view, std::string_view head) {
  return head.starts_with(kTensorMagic);
}

Result<MeasuredPointer> read_rgl(const std::string& path, std::string_view bytes) {
  GONIO_ASSIGN(const TensorFile file, TensorFile::parse(path, bytes));
  GONIO_ASSIGN(const Tensor* phi, file.field("phi_i", 1));
  if (phi->values.size() > 2)
    return input_error("{}: is anisotropic ({} incident azimuths): aspecular color needs an isotropic sample", path,
                       phi->values.size());
  GONIO_ASSIGN(const Tensor* theta, file.field("theta_i", 1));
  GONIO_ASSIGN(const Tensor* sigma, file.field("sigma", 2));
  GONIO_ASSIGN(const Tensor* ndf, file.field("ndf", 2));
  GONIO_ASSIGN(const Tensor* visible, file.field("vndf", 4));
  const bool is_spectral = !file.has("rgb") && file.has("spectra");
  GONIO_ASSIGN(const Tensor* colors, file.field(is_spectral ? "spectra" : "rgb", 5));
  std::vector<double> wavelengths;
  if (is_spectral) {
    GONIO_ASSIGN(const Tensor* nm, file.field("wavelengths", 1));
    wavelengths = nm->values;
    if (wavelengths.size() < 2 || !std::ranges::is_sorted(wavelengths, std::less_equal<>()))
      return input_error("{}: its wavelengths do not ascend", path);
  }
  const std::size_t slices = theta->values.size(), first = phi->values.size();
  const auto at_least_two = [](const Tensor& t, std::size_t from) {
    return std::all_of(t.shape.begin() + static_cast<std::ptrdiff_t>(from), t.shape.end(),
                       [](auto n) { return n >= 2; });
  };
  if (slices < 2 || !std::ranges::is_sorted(theta->values, std::less_equal<>()) || visible->shape[0] != first ||
      visible->shape[1] != slices || colors->shape[0] != first || colors->shape[1] != slices ||
      colors->shape[2] != (is_spectral ? wavelengths.size() : 3) || !at_least_two(*visible, 2) ||
      !at_least_two(*colors, 3) || !at_least_two(*sigma, 0) || !at_least_two(*ndf, 0))
    return input_error("{}: the sizes of its fields do not fit together", path);

  RglTables tables{theta->values, *sigma, *ndf, *colors, visible->shape[2], visible->shape[3], {}};
  const std::size_t size = tables.height * tables.width;
  for (std::size_t k = 0; k < slices; ++k) {
    tables.visible.push_back(density(std::span(visible->values).subspan(k * size, size), tables.height, tables.width));
    if (!std::isfinite(tables.visible.back().over_rows.back()))
      return input_error("{}: the density of visible normals is empty at {} deg", path, theta->values[k] / kDegree);
  }
  MeasuredTraits traits{.format = "rgl", .description = file.description(), .wavelengths_nm = wavelengths};
  double negative_square = 0;
  for (const double value : colors->values) count_sample(value, traits, negative_square);
  if (!is_spectral) {
    const std::vector<double>& values = colors->values;
    const std::size_t plane = colors->shape[3] * colors->shape[4];
    for (std::size_t slice = 0; slice + 2 * plane < values.size(); slice += 3 * plane)
      for (std::size_t i = slice; i < slice + plane && !traits.noisy; ++i)
        traits.noisy = is_noise({values[i], values[i + plane], values[i + 2 * plane]});
    if (!traits.noisy) traits.negative = 0;
  }
  return MeasuredPointer(std::make_unique<RglBrdf>(std::move(traits), std::move(tables)));
}

}  // namespace

const MeasuredFormat kRgl = {looks_rgl, read_rgl, "RGL .bsdf"};

}  // namespace goniochrome::brdf
