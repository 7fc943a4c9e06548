#include "sketch/internal/sketch_icc.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace goniochrome::sketch {

namespace {

constexpr color::Xyz kD50{0.9642, 1, 0.8249};  // of the profile connection space, ICC.1:2010 6.3.4.3
constexpr int kCurveSteps = 4096;

// Big-endian numbers of a profile; what lies beyond its end reads as nothing.
class Bytes {
 public:
  explicit Bytes(const std::string& bytes) : bytes_(bytes) {}
  bool holds(std::size_t at, std::size_t count) const { return at <= bytes_.size() && count <= bytes_.size() - at; }
  std::uint32_t u32(std::size_t at) const { return u16(at) << 16 | u16(at + 2); }
  std::uint32_t u16(std::size_t at) const {
    return holds(at, 2) ? static_cast<std::uint32_t>(byte(at) << 8 | byte(at + 1)) : 0;
  }
  double fixed(std::size_t at) const { return static_cast<std::int32_t>(u32(at)) / 65536.0; }
  std::string text(std::size_t at) const { return holds(at, 4) ? bytes_.substr(at, 4) : ""; }

 private:
  int byte(std::size_t at) const { return static_cast<unsigned char>(bytes_[at]); }
  const std::string& bytes_;
};

// Where the tag's data begins, or nothing.
std::optional<std::size_t> find_tag(const Bytes& profile, const std::string& signature) {
  const std::size_t count = std::min<std::size_t>(profile.u32(128), 1000);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = 132 + 12 * i;
    const std::size_t at = profile.u32(entry + 4);
    if (profile.text(entry) == signature && profile.holds(at, 8)) return at;
  }
  return std::nullopt;
}

// parametricCurveType, ICC.1:2010 10.16: g a b c d e f, by function type.
double parametric(int type, const std::array<double, 7>& p, double x) {
  const auto [g, a, b, c, d, e, f] = p;
  const auto power = [&](double base) { return std::pow(std::max(base, 0.0), g); };
  switch (type) {
    case 0:
      return power(x);
    case 1:
      return a * x + b >= 0 ? power(a * x + b) : 0;
    case 2:
      return a * x + b >= 0 ? power(a * x + b) + c : c;
    case 3:
      return x >= d ? power(a * x + b) : c * x;
    default:
      return x >= d ? power(a * x + b) + e : c * x + f;
  }
}

std::optional<std::vector<float>> curve_at(const Bytes& profile, std::size_t at) {
  std::vector<float> curve(kCurveSteps + 1);
  const auto fill = [&](auto&& value) {
    for (int i = 0; i <= kCurveSteps; ++i) curve[i] = static_cast<float>(value(i / double(kCurveSteps)));
    return curve;
  };
  if (profile.text(at) == "para") {
    const int type = static_cast<int>(profile.u16(at + 8));
    constexpr int kCount[] = {1, 3, 4, 5, 7};
    if (type > 4 || !profile.holds(at + 12, 4 * kCount[type])) return std::nullopt;
    std::array<double, 7> p{};
    for (int i = 0; i < kCount[type]; ++i) p[i] = profile.fixed(at + 12 + 4 * i);
    return fill([&](double x) { return parametric(type, p, x); });
  }
  if (profile.text(at) != "curv") return std::nullopt;
  const std::size_t count = profile.u32(at + 8);
  if (count > 65536 || !profile.holds(at + 12, 2 * count)) return std::nullopt;
  if (count == 0) return fill([](double x) { return x; });
  if (count == 1) return fill([g = profile.u16(at + 12) / 256.0](double x) { return std::pow(x, g); });
  return fill([&](double x) {
    const double place = x * static_cast<double>(count - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(place), count - 2);
    const double low = profile.u16(at + 12 + 2 * i), high = profile.u16(at + 14 + 2 * i);
    return (low + (place - static_cast<double>(i)) * (high - low)) / 65535;
  });
}

float looked_up(const std::vector<float>& curve, float value) {
  const float place = std::clamp(value, 0.0F, 1.0F) * kCurveSteps;
  const int i = std::min(static_cast<int>(place), kCurveSteps - 1);
  return curve[i] + (place - static_cast<float>(i)) * (curve[i + 1] - curve[i]);
}

}  // namespace

color::Rgb IccProfile::rgb(float r, float g, float b) const {
  return static_cast<double>(looked_up(curves[0], r)) * columns[0] +
         static_cast<double>(looked_up(curves[1], g)) * columns[1] +
         static_cast<double>(looked_up(curves[2], b)) * columns[2];
}

Result<IccProfile> parse_icc(const std::string& bytes, const std::string& name) {
  const Bytes profile(bytes);
  const auto broken = [&] { return input_error("{}: its ICC profile is damaged: convert the image to sRGB", name); };
  if (!profile.holds(0, 132) || profile.text(36) != "acsp") return broken();
  const std::string space = profile.text(16);
  if (space != "RGB " && space != "GRAY")
    return input_error("{}: its ICC profile is for {}: convert the image to sRGB", name, space);
  IccProfile result;
  result.gray = space == "GRAY";
  const char* const curves[] = {"rTRC", "gTRC", "bTRC"};
  const char* const colorants[] = {"rXYZ", "gXYZ", "bXYZ"};
  for (int c = 0; c < 3; ++c) {
    const auto trc = find_tag(profile, result.gray ? "kTRC" : curves[c]);
    const auto xyz = find_tag(profile, result.gray ? "wtpt" : colorants[c]);
    if (!trc || (!xyz && !result.gray))
      return input_error("{}: its ICC profile maps by tables, which are not read: convert the image to sRGB", name);
    const auto curve = curve_at(profile, *trc);
    if (!curve || (xyz && !profile.holds(*xyz, 20))) return broken();
    result.curves[c] = *curve;
    if (result.gray) {
      result.columns[c] = color::Rgb{1, 1, 1} * color::Rgb{c == 0 ? 1.0 : 0.0, c == 1 ? 1.0 : 0.0, c == 2 ? 1.0 : 0.0};
      continue;
    }
    const color::Xyz pcs{profile.fixed(*xyz + 8), profile.fixed(*xyz + 12), profile.fixed(*xyz + 16)};
    result.columns[c] = color::rgb_from_xyz_d65(color::adapted(pcs, kD50, color::xyz_d65_from_rgb({1, 1, 1})));
  }
  return result;
}

}  // namespace goniochrome::sketch
