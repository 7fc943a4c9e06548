// NVIDIA MBSDF: a line of text, then a regular grid over both polar angles and the azimuth between them.
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/internal/measured_formats.h"
#include "color/acescg.h"

namespace goniochrome::brdf {

namespace {

// Before the part of reflection stands one of two marks; files of reflection alone may have the shorter one. [MDL,
// MBSDF file format]
constexpr std::string_view kMbsdfMagic = "NVIDIA ARC MBSDF", kReflection = "MBSDF_DATA_REFLECTION=\n",
                           kReflectionAlone = "MBSDF_DATA=\n", kTransmission = "MBSDF_DATA_TRANSMISSION=\n";

// Values at the centers of cells: theta (i + 1/2) 90/n_theta deg for light and viewer, azimuth (k + 1/2) 180/n_phi deg,
// 180 deg across the normal from the light.
struct Grid {
  std::size_t theta = 0, phi = 0, channels = 3;
  std::vector<float> values;  // [light][viewer][azimuth][channel]

  double at(std::size_t light, std::size_t view, std::size_t azimuth, std::size_t channel) const {
    return values[((light * theta + view) * phi + azimuth) * channels + (channels == 3 ? channel : 0)];
  }
  std::span<const float> row(std::size_t light, std::size_t view) const {
    return {values.data() + (light * theta + view) * phi * channels, phi * channels};
  }
};

class MbsdfBrdf final : public MeasuredBrdf {
 public:
  MbsdfBrdf(MeasuredTraits traits, Grid grid) : MeasuredBrdf(std::move(traits)), grid_(std::move(grid)) {}

  MeasuredValue value(const Vec3& light, const Vec3& view) const override {
    const auto theta_index = [&](const Vec3& direction) {
      return polar_angle(direction) / (kPi / 2) * static_cast<double>(grid_.theta) - 0.5;
    };
    const double light_index = theta_index(light), view_index = theta_index(view);
    const double azimuth_index = azimuth_between(light, view) / kPi * static_cast<double>(grid_.phi) - 0.5;
    const Cell l = cell_at(light_index, grid_.theta), v = cell_at(view_index, grid_.theta);
    const Cell a = cell_at(azimuth_index, grid_.phi);
    MeasuredValue result{.f = {0, 0, 0}};
    for (int corner = 0; corner < 8; ++corner) {
      const double weight = (corner & 1 ? l.weight : 1 - l.weight) * (corner & 2 ? v.weight : 1 - v.weight) *
                            (corner & 4 ? a.weight : 1 - a.weight);
      if (weight == 0) continue;
      for (std::size_t c = 0; c < 3; ++c)
        result.f[c] += weight * grid_.at(l.low + (corner & 1), v.low + (corner >> 1 & 1), a.low + (corner >> 2), c);
    }
    const auto off_center = [](double index) { return std::abs(index - std::round(index)) > 1e-6; };
    if (off_center(light_index) || off_center(view_index)) result.gap_deg = 90.0 / static_cast<double>(grid_.theta);
    if (off_center(azimuth_index)) result.gap_deg = std::max(result.gap_deg, 180.0 / static_cast<double>(grid_.phi));
    return result;
  }

 private:
  Grid grid_;
};

// The value of a line key="value" of the header; "" where there is none.
std::string header_value(std::string_view header, const std::string& key) {
  const std::string begin = "\n" + key + "=\"";
  const auto at = header.find(begin);
  if (at == std::string_view::npos) return "";
  header.remove_prefix(at + begin.size());
  return std::string(header.substr(0, header.find_first_of("\"\n")));
}

void turn_into_rec709(Grid& grid) {
  for (std::size_t i = 0; i < grid.values.size(); i += 3) {
    const color::Rgb rgb = color::rec709_from_rec2020(
        color::rec2020_from_acescg({grid.values[i], grid.values[i + 1], grid.values[i + 2]}));
    for (int c = 0; c < 3; ++c) grid.values[i + static_cast<std::size_t>(c)] = static_cast<float>(rgb[c]);
  }
}

// Viewer rows that repeat their neighbor for every light, and are no constants, were copied, not measured.
void find_copied_rows(const Grid& grid, MeasuredTraits& traits) {
  const auto is_copy = [&](std::size_t view) {
    const auto first = grid.row(0, view);
    bool copy = std::ranges::adjacent_find(first, std::not_equal_to<>()) != first.end();
    for (std::size_t light = 0; copy && light < grid.theta; ++light)
      copy = std::ranges::equal(grid.row(light, view), grid.row(light, view - 1));
    return copy;
  };
  const auto center_deg = [&](std::size_t view) {
    return (static_cast<double>(view) + 0.5) * 90 / static_cast<double>(grid.theta);
  };
  for (std::size_t view = 1; view < grid.theta; ++view) {
    if (!is_copy(view)) continue;
    const std::size_t original = view - 1;
    while (view + 1 < grid.theta && is_copy(view + 1)) ++view;
    traits.findings.push_back(fmt::format(
        "the values for viewers beyond {} deg, to {} deg, repeat those at {} deg: they were copied, not measured",
        center_deg(original), center_deg(view), center_deg(original)));
  }
}

bool looks_mbsdf(std::string_view, std::string_view head) {
  return head.starts_with(kMbsdfMagic);
}

Result<MeasuredPointer> read_mbsdf(const std::string& path, std::string_view bytes) {
  std::string_view mark = kReflection;
  auto found = bytes.find(mark);
  if (found == std::string_view::npos) found = bytes.find(mark = kReflectionAlone);
  if (found == std::string_view::npos)
    return input_error("{}: has no MBSDF_DATA_REFLECTION part: export a measurement of reflected light", path);
  // Files of paint-export state their colors; others say nothing, and are Rec.709.
  const std::string_view header = bytes.substr(0, found);
  const std::string space = header_value(header, "colorspace");
  if (!space.empty() && space != "lin_rec709" && space != "acescg")
    return input_error("{}: its colorspace is \"{}\", and lin_rec709 and acescg are read: convert it to one of them",
                       path, shown(space));
  ByteReader reader(bytes.substr(found + mark.size()));
  const auto type = reader.next<std::uint32_t>(), theta = reader.next<std::uint32_t>(),
             phi = reader.next<std::uint32_t>();
  if (!phi) return input_error("{}: ends within the header of its reflection part", path);
  constexpr std::uint32_t kMost = 4096;
  if (*type > 1) return input_error("{}: type {}: 0 (gray) and 1 (RGB) are known", path, *type);
  if (*theta < 2 || *phi < 2 || *theta > kMost || *phi > kMost)
    return input_error("{}: a grid of {} x {} x {} directions: 2 to {} each were expected", path, *theta, *theta, *phi,
                       kMost);

  Grid grid{*theta, *phi, *type == 1 ? std::size_t{3} : std::size_t{1}, {}};
  const std::size_t count = grid.theta * grid.theta * grid.phi * grid.channels;
  const auto data = reader.text(count * sizeof(float));
  if (!data)
    return input_error("{}: {} bytes of values where a grid of {} x {} x {} has {}: the file is cut", path,
                       reader.left(), grid.theta, grid.theta, grid.phi, count * sizeof(float));
  MeasuredTraits traits{.format = "mbsdf", .description = header_value(header, "description")};
  if (bytes.substr(bytes.size() - reader.left()).starts_with(kTransmission))
    traits.findings.emplace_back("its values of light that goes through are left out");
  grid.values.resize(count);
  std::memcpy(grid.values.data(), data->data(), data->size());
  const bool acescg = grid.channels == 3 && space == "acescg";
  double negative_square = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(grid.values[i])) return input_error("{}: value {} is not finite", path, i);
    count_sample(grid.values[i], traits, negative_square);
  }
  traits.noisy = grid.channels == 1;
  for (std::size_t i = 0; grid.channels == 3 && !acescg && i < count && !traits.noisy; i += 3)
    traits.noisy = is_noise({grid.values[i], grid.values[i + 1], grid.values[i + 2]});
  if (!traits.noisy) traits.negative = 0;
  if (traits.negative) traits.negative_rms = std::sqrt(negative_square / static_cast<double>(traits.negative));
  if (acescg) turn_into_rec709(grid);
  find_copied_rows(grid, traits);
  return MeasuredPointer(std::make_unique<MbsdfBrdf>(std::move(traits), std::move(grid)));
}

}  // namespace

const MeasuredFormat kMbsdf = {looks_mbsdf, read_mbsdf, "NVIDIA .mbsdf"};

}  // namespace goniochrome::brdf
