// Sines, arcs and roots by polynomials. The coefficients interpolate the function at Chebyshev's nodes of its interval.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "math/elementary.h"
#include "math/twice.h"

namespace goniochrome::math {

namespace {

constexpr Twice kTwicePi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr Twice kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double kFarthest_rad = 1e7;

// An angle within 45 degrees (but for rounding) of a multiple of 90 degrees, from which it is taken.
struct Turned {
  Twice angle;
  int quarter;
};

// The multiple of pi/2 is taken away in four parts. The first three have 30 bits, so that their products with a number
// below 2^23 are exact, and the four together have 143. A double below 1e7 comes no nearer to a multiple of pi/2 than
// 2^-62, so that the rest keeps 50 bits beyond those of a double.
Turned turned(double x) {
  if (std::abs(x) < 0.785) return {{x, 0}, 0};
  constexpr double kParts[] = {0x1.921fb54p+0, 0x1.10b46118p-30, 0x1.313198ap-61, 0x1.701b839a25205p-92};
  const double k = (x * (1 / kHalfPi.high) + kToInteger) - kToInteger;
  const Twice first = sum_of(x - k * kParts[0], -k * kParts[1]), second = sum_of(first.high, -k * kParts[2]);
  return {sum_of(second.high, (first.low + second.low) - k * kParts[3]), static_cast<int>(k) & 3};
}

// sin x = x + x^3 S(x^2) and cos x = 1 - x^2/2 + x^4 C(x^2) to 45 degrees, the first terms exactly and the others
// rounded.
Twice sine_near_0(Twice x) {
  const double z = x.high * x.high, zz = z * z;
  const double s = (-0x1.5555555555555p-3 + z * 0x1.1111111111110p-7) +
                   zz * ((-0x1.a01a01a019937p-13 + z * 0x1.71de3a54607a5p-19) +
                         zz * ((-0x1.ae64541295cdfp-26 + z * 0x1.61217ee5cca1bp-33) - zz * 0x1.ab17bdcbd3414p-41));
  return {x.high, x.high * z * s + x.low * (1 - 0.5 * z)};
}
Twice cosine_near_0(Twice x) {
  const double z = x.high * x.high, zz = z * z, half = 0.5 * z, most = 1 - half;
  const double c = (0x1.5555555555555p-5 - z * 0x1.6c16c16c16967p-10) +
                   zz * ((0x1.a01a019f4e9b4p-16 - z * 0x1.27e4fa17bf139p-22) +
                         zz * (0x1.1eeb68cd22f56p-29 - z * 0x1.907d8f29fe831p-37));
  return {most, ((1 - most) - half) + (zz * c - x.high * x.low)};
}

// The sine of an angle and a number of quarter turns.
Twice sine_of(Twice angle, int quarters) {
  const Twice value = quarters % 2 == 0 ? sine_near_0(angle) : cosine_near_0(angle);
  return quarters % 4 < 2 ? value : -value;
}

bool beyond(double x) {
  return !(std::abs(x) <= kFarthest_rad);
}

}  // namespace

double sin(double x) {
  if (beyond(x)) return std::sin(x);
  if (x == 0) return x;  // with its sign
  const Turned at = turned(x);
  const Twice value = sine_of(at.angle, at.quarter);
  return value.high + value.low;
}

double cos(double x) {
  if (beyond(x)) return std::cos(x);
  const Turned at = turned(x);
  const Twice value = sine_of(at.angle, at.quarter + 1);
  return value.high + value.low;
}

double tan(double x) {
  if (beyond(x)) return std::tan(x);
  if (x == 0) return x;
  const Turned at = turned(x);
  const Twice s = sine_of(at.angle, at.quarter), c = sine_of(at.angle, at.quarter + 1);
  const Twice sine = ordered_sum_of(s.high, s.low), cosine = sum_of(c.high, c.low);
  const Twice quotient = sine / cosine;
  return quotient.high + quotient.low;
}

namespace {

// (asin x - x)/x for z = x^2 <= 1/4.
double arc_excess(double z) {
  constexpr double a[] = {0x1.5555555555556p-3, 0x1.3333333332ecap-4, 0x1.6db6db6e31f13p-5, 0x1.f1c71c1db0623p-6,
                          0x1.6e8bb1c8209a2p-6, 0x1.1c4d35cf95421p-6, 0x1.c9cf07674736ap-7, 0x1.782651caa6547p-7,
                          0x1.52420b04b37bep-7, 0x1.65a9c4dfcf8b2p-8, 0x1.1d189408314eep-6, -0x1.e6aaa8a0a04ccp-7,
                          0x1.d72b2bc8155f8p-6};
  const double zz = z * z, z4 = zz * zz;
  const double first = (a[0] + z * a[1]) + zz * (a[2] + z * a[3]), second = (a[4] + z * a[5]) + zz * (a[6] + z * a[7]),
               third = (a[8] + z * a[9]) + zz * (a[10] + z * a[11]);
  return z * (first + z4 * (second + z4 * (third + z4 * a[12])));
}

// acos(1 - 2 z)/2 = asin(sqrt z) for 0 <= z <= 1/4, as the root and what is to be added to it.
Twice half_arc(double z) {
  if (z == 0) return {0, 0};
  const double root = std::sqrt(z);
  const Twice square = square_of(root);
  return {root, ((z - square.high) - square.low) / (2 * root) + root * arc_excess(z)};
}

}  // namespace

double asin(double x) {
  const double size = std::abs(x);
  if (!(size <= 1)) return std::asin(x);
  if (size <= 0.5) return x + x * arc_excess(x * x);
  const Twice arc = half_arc(0.5 * (1 - size));
  const Twice from_quarter = ordered_sum_of(kHalfPi.high, -2 * arc.high);
  return std::copysign(from_quarter.high + (from_quarter.low + (kHalfPi.low - 2 * arc.low)), x);
}

double acos(double x) {
  if (!(std::abs(x) <= 1)) return std::acos(x);
  if (std::abs(x) <= 0.5) {
    const Twice sum = ordered_sum_of(kHalfPi.high, -x);
    return sum.high + (sum.low + (kHalfPi.low - x * arc_excess(x * x)));
  }
  const Twice arc = half_arc(0.5 * (1 - std::abs(x)));
  if (x > 0) return 2 * (arc.high + arc.low);
  const Twice from_half = ordered_sum_of(kTwicePi.high, -2 * arc.high);
  return from_half.high + (from_half.low + (kTwicePi.low - 2 * arc.low));
}

namespace {

// Arc tangents of i/64, each from the one before it: the difference is the arc tangent of 64/(4096 + i (i - 1)).
constexpr int kArcs = 64;
constexpr std::array<Twice, kArcs + 1> arcs() {
  std::array<Twice, kArcs + 1> table = {};
  for (int i = 1; i <= kArcs; ++i) {
    const Twice t = Twice{kArcs, 0} / Twice{static_cast<double>(kArcs * kArcs + i * (i - 1)), 0}, tt = t * t;
    Twice sum = {0, 0};
    for (int n = 19; n >= 1; n -= 2) sum = Twice{1, 0} / Twice{static_cast<double>(n), 0} + -(tt * sum);
    table[static_cast<std::size_t>(i)] = table[static_cast<std::size_t>(i - 1)] + t * sum;
  }
  return table;
}
constexpr std::array<Twice, kArcs + 1> kArcTable = arcs();

// The arc tangent of near/far, for 0 <= near <= far, far within 2^+-500. Near 0 the quotient, exactly, and the series;
// beyond, that of i/64 and of what is left, (near - far i/64)/(far + near i/64), whose numerator is nearly exact.
Twice arc_of(double near, double far) {
  const double q = near / far, nearest = (q * kArcs + kToInteger) - kToInteger;
  if (nearest < 4) {
    if (q < 0x1p-60) return {q, 0};
    const Twice product = product_of(q, far);
    const double z = q * q, zz = z * z;
    const double series =
        z * ((-1.0 / 3 + z * 0.2) + zz * ((-1.0 / 7 + z * (1.0 / 9)) + zz * (-1.0 / 11 + z * (1.0 / 13))));
    return {q, ((near - product.high) - product.low) / far + q * series};
  }
  const double c = nearest * (1.0 / kArcs);
  const Twice parts = halves_of(far);
  const double t = ((near - c * parts.high) - c * parts.low) / (far + c * near), z = t * t;
  const Twice& arc = kArcTable[static_cast<std::size_t>(nearest)];
  return {arc.high, arc.low + (t + t * z * (-1.0 / 3 + z * (0.2 - z * (1.0 / 7))))};
}

}  // namespace

double atan2(double y, double x) {
  double up = std::abs(y), along = std::abs(x);
  if (!(up < HUGE_VAL && along < HUGE_VAL) || up == 0 || along == 0) return std::atan2(y, x);
  const double most = up > along ? up : along;
  if (most > 0x1p500) up *= 0x1p-600, along *= 0x1p-600;
  if (most < 0x1p-400) up *= 0x1p600, along *= 0x1p600;
  const bool steep = up > along;
  const Twice arc = steep ? arc_of(along, up) : arc_of(up, along);
  double angle = 0;
  if (!steep && x > 0) {
    angle = arc.high + arc.low;
  } else {
    // From a quarter or a half turn: pi/2 - arc, pi/2 + arc or pi - arc.
    const Twice& from = steep ? kHalfPi : kTwicePi;
    const double sign = steep && x < 0 ? 1 : -1;
    const Twice sum = ordered_sum_of(from.high, sign * arc.high);
    angle = sum.high + (sum.low + (from.low + sign * arc.low));
  }
  return std::copysign(angle, y);
}

// x = 2^(3 q) m 2^j with m in [1,2) and j = 0, 1 or 2. A polynomial and the root of 2^j give y with 17 bits, whose cube
// is exact, and so is e = (x - y^3)/y^3 but for one rounding; the root is y (1 + e)^(1/3), and |e| < 1e-4.
double cbrt(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  double size = std::abs(x);
  int lifted = 0;
  if (size < 0x1p-1022) size *= 0x1p54, lifted = 18;
  const auto bits = std::bit_cast<std::uint64_t>(size);
  const int exponent = static_cast<int>(bits >> 52), third = exponent / 3, j = exponent - 3 * third;  // 1023 = 3 * 341
  const double m = std::bit_cast<double>((bits & 0xfffffffffffffU) | (std::uint64_t{1023} << 52));
  constexpr double kRoots[] = {1, 0x1.428a2f98d728bp+0, 0x1.965fea53d6e3dp+0};
  const double guess = (0x1.04bc2bde493b9p-1 + m * 0x1.6c697f83452edp-1) +
                       m * m * ((-0x1.2d024eeecb9cbp-2 + m * 0x1.544aaec5e4624p-4) - m * m * 0x1.4b077fcd0882bp-7);
  const double y = (guess * kRoots[j] + 0x1.8p36) - 0x1.8p36;  // to a multiple of 2^-16
  const double cube = y * y * y, e = (m * (1 << j) - cube) / cube;
  const double root = y + y * e * ((1.0 / 3 - e * (1.0 / 9)) + e * e * (5.0 / 81 - e * (10.0 / 243)));
  return std::copysign(root * std::bit_cast<double>(static_cast<std::uint64_t>(third - 341 - lifted + 1023) << 52), x);
}

namespace {

// The root of a sum, to which is added what its square leaves of the sum.
double root_of(Twice sum) {
  const double root = std::sqrt(sum.high);
  const Twice square = square_of(root);
  return root + ((sum.high - square.high) - square.low + sum.low) / (2 * root);
}

// A power of two by which sizes up to this one can be squared.
double scale_of(double most) {
  return most > 0x1p500 ? 0x1p-600 : most < 0x1p-400 ? 0x1p600 : 1;
}

}  // namespace

double hypot(double x, double y) {
  const double a = std::abs(x), b = std::abs(y), most = a > b ? a : b;
  if (a == HUGE_VAL || b == HUGE_VAL) return HUGE_VAL;
  if (most == 0) return a + b;
  const double scale = scale_of(most);
  const Twice aa = square_of(a * scale), bb = square_of(b * scale), sum = sum_of(aa.high, bb.high);
  return root_of({sum.high, sum.low + (aa.low + bb.low)}) / scale;
}

double hypot(double x, double y, double z) {
  const double a = std::abs(x), b = std::abs(y), c = std::abs(z), ab = a > b ? a : b, most = ab > c ? ab : c;
  if (a == HUGE_VAL || b == HUGE_VAL || c == HUGE_VAL) return HUGE_VAL;
  if (most == 0) return a + b + c;
  const double scale = scale_of(most);
  const Twice aa = square_of(a * scale), bb = square_of(b * scale), cc = square_of(c * scale);
  const Twice two = sum_of(aa.high, bb.high), sum = sum_of(two.high, cc.high);
  return root_of({sum.high, (two.low + sum.low) + (aa.low + bb.low + cc.low)}) / scale;
}

}  // namespace goniochrome::math
