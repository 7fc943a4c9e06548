#include "color/color.h"

#include <algorithm>
#include <array>

#include "color/acescg.h"
#include "color/illuminant.h"
#include "color/spectrum.h"
#include "math/elementary.h"

namespace goniochrome::color {

namespace {

using Matrix = std::array<Vec3, 3>;  // rows

constexpr Vec3 operator*(const Matrix& m, const Vec3& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

constexpr Matrix transposed(const Matrix& m) {
  return {Vec3{m[0].x, m[1].x, m[2].x}, Vec3{m[0].y, m[1].y, m[2].y}, Vec3{m[0].z, m[1].z, m[2].z}};
}

constexpr Matrix operator*(const Matrix& a, const Matrix& b) {
  const Matrix columns = transposed(b);
  return transposed({a * columns[0], a * columns[1], a * columns[2]});
}

// The inverse, by cross products of the rows.
constexpr Matrix inverse_of(const Matrix& m) {
  const double scale = 1 / dot(m[0], cross(m[1], m[2]));
  return transposed({scale * cross(m[1], m[2]), scale * cross(m[2], m[0]), scale * cross(m[0], m[1])});
}

constexpr Vec3 vec(const Xyz& c) {
  return {c.X, c.Y, c.Z};
}
constexpr Xyz xyz(const Vec3& v) {
  return {v.x, v.y, v.z};
}

struct Chromaticity {
  double x, y;
};

constexpr Vec3 xyz_of(const Chromaticity& c) {
  return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

// Linear RGB -> XYZ from the chromaticities of the primaries: their columns, scaled so that (1,1,1) is the white.
constexpr Matrix rgb_to_xyz(const Chromaticity& red, const Chromaticity& green, const Chromaticity& blue,
                            const Chromaticity& white) {
  const Matrix columns = {xyz_of(red), xyz_of(green), xyz_of(blue)};
  const Vec3 scale = inverse_of(transposed(columns)) * xyz_of(white);
  return transposed({scale.x * columns[0], scale.y * columns[1], scale.z * columns[2]});
}

// ITU-R BT.2020 and BT.709, tables of primaries and reference white.
constexpr Chromaticity kWhite = {0.3127, 0.3290};
constexpr Matrix kXyzFrom2020 = rgb_to_xyz({0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kWhite);
constexpr Matrix kXyzFrom709 = rgb_to_xyz({0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, kWhite);
constexpr Matrix k2020FromXyz = inverse_of(kXyzFrom2020);
constexpr Matrix k2020From709 = k2020FromXyz * kXyzFrom709;
constexpr Matrix k709From2020 = inverse_of(k2020From709);
constexpr Xyz kWorkingWhite = xyz(xyz_of(kWhite));

// Sharpened cone responses of the Bradford transform. [Lam1985]
constexpr Matrix kBradford = {Vec3{0.8951, 0.2664, -0.1614}, Vec3{-0.7502, 1.7135, 0.0367},
                              Vec3{0.0389, -0.0685, 1.0296}};
constexpr Matrix kBradfordInverse = inverse_of(kBradford);

// [S-2014-004], the primaries AP1 and the white of ACES, to which colors are adapted by Bradford's matrix.
constexpr Chromaticity kAcesWhite = {0.32168, 0.33767};
constexpr Matrix kXyzFromAcescg = rgb_to_xyz({0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, kAcesWhite);
constexpr Matrix between_whites(const Vec3& from, const Vec3& to) {
  const Vec3 was = kBradford * from, is = kBradford * to;
  const Matrix scale = {Vec3{is.x / was.x, 0, 0}, Vec3{0, is.y / was.y, 0}, Vec3{0, 0, is.z / was.z}};
  return kBradfordInverse * (scale * kBradford);
}
constexpr Matrix k2020FromAcescg = k2020FromXyz * (between_whites(xyz_of(kAcesWhite), xyz_of(kWhite)) * kXyzFromAcescg);
constexpr Matrix kAcescgFrom2020 = inverse_of(k2020FromAcescg);

// White points as CIE 15 and ASTM E308 print them (X and Z for Y = 100), for the 2 and the 10 deg observer.
struct White {
  std::string_view illuminant;
  std::array<double, 2> xz_2deg, xz_10deg;
};
constexpr std::array kWhites = {
    White{"D65", {95.047, 108.883}, {94.811, 107.304}}, White{"D50", {96.422, 82.521}, {96.720, 81.427}},
    White{"A", {109.850, 35.585}, {111.144, 35.200}},   White{"C", {98.074, 118.232}, {97.285, 116.145}},
    White{"D55", {95.682, 92.149}, {95.799, 90.926}},   White{"D75", {94.972, 122.638}, {94.416, 120.641}},
    White{"F2", {99.187, 67.395}, {103.280, 69.026}},   White{"F7", {95.044, 108.755}, {95.792, 107.687}},
    White{"F11", {100.966, 64.370}, {103.866, 65.627}},
};

// The CIELAB response and its inverse: a cube root that turns into its tangent at (6/29)^3, so that it is smooth,
// finite and invertible down to zero and below.
constexpr double kKnee = 6.0 / 29.0;
double response(double ratio) {
  return ratio > kKnee * kKnee * kKnee ? math::cbrt(ratio) : ratio / (3 * kKnee * kKnee) + 4.0 / 29.0;
}
double ratio_of_response(double f) {
  return f > kKnee ? f * f * f : 3 * kKnee * kKnee * (f - 4.0 / 29.0);
}

}  // namespace

Result<Xyz> white_point(const ViewingCondition& stated) {
  const ViewingCondition condition = condition_of(stated.illuminant, stated.observer_deg);
  if (!illuminant_named(condition.illuminant))
    return input_error("illuminant \"{}\" is not known: give one of {}", stated.illuminant, spectral_illuminants());
  if (condition.observer_deg != 2 && condition.observer_deg != 10)
    return input_error("observer {} is not known: give 2 or 10 (degrees)", condition.observer_deg);
  const auto white = std::ranges::find(kWhites, condition.illuminant, &White::illuminant);
  if (white == kWhites.end()) {
    GONIO_ASSIGN(const SpectralColorimeter meter, SpectralColorimeter::make(std::array{360.0, 780.0}, condition));
    return meter.white();
  }
  const auto& [X, Z] = condition.observer_deg == 2 ? white->xz_2deg : white->xz_10deg;
  return Xyz{X / 100, 1, Z / 100};
}

Lab lab_from_xyz(const Xyz& c, const Xyz& white) {
  const double x = response(c.X / white.X), y = response(c.Y / white.Y), z = response(c.Z / white.Z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Xyz xyz_from_lab(const Lab& lab, const Xyz& white) {
  const double y = (lab.L + 16) / 116;
  return {white.X * ratio_of_response(y + lab.a / 500), white.Y * ratio_of_response(y),
          white.Z * ratio_of_response(y - lab.b / 200)};
}

Xyz adapted(const Xyz& c, const Xyz& from_white, const Xyz& to_white) {
  const Vec3 from = kBradford * vec(from_white), to = kBradford * vec(to_white), cone = kBradford * vec(c);
  return xyz(kBradfordInverse * Vec3{cone.x * (to.x / from.x), cone.y * (to.y / from.y), cone.z * (to.z / from.z)});
}

Rgb rgb_from_xyz_d65(const Xyz& c) {
  return k2020FromXyz * vec(c);
}

Xyz xyz_d65_from_rgb(const Rgb& rgb) {
  return xyz(kXyzFrom2020 * rgb);
}

Rgb rgb_from_lab(const Lab& lab, const Xyz& white) {
  return rgb_from_xyz_d65(adapted(xyz_from_lab(lab, white), white, kWorkingWhite));
}

Lab lab_from_rgb(const Rgb& rgb, const Xyz& white) {
  return lab_from_xyz(adapted(xyz_d65_from_rgb(rgb), kWorkingWhite, white), white);
}

Rgb rec2020_from_rec709(const Rgb& rec709) {
  return k2020From709 * rec709;
}

Rgb rec709_from_rec2020(const Rgb& rec2020) {
  return k709From2020 * rec2020;
}

Rgb rec2020_from_acescg(const Rgb& acescg) {
  return k2020FromAcescg * acescg;
}

Rgb acescg_from_rec2020(const Rgb& rec2020) {
  return kAcescgFrom2020 * rec2020;
}

// From CIE 1976: L* = 116 Y^(1/3) - 16 gives 116/3 Y^(-2/3); the linear branch gives (29/3)^3.
double lightness_slope(double lightness) {
  if (lightness <= 8) return 24389.0 / 27;
  const double cube_root = (lightness + 16) / 116;
  return 116.0 / 3 / (cube_root * cube_root);
}

}  // namespace goniochrome::color
