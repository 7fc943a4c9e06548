// Exponentials, logarithms and powers by tables. [Tang1989] [Tang1990]
//
// A table holds the function at 128 places to twice the digits of a double, and a short Taylor series carries it from
// the nearest place to the argument. The series is at most 1/128 of the value or so, and with it its rounding errors,
// so that the last addition, half an ulp, is nearly the whole error.
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "math/elementary.h"
#include "math/twice.h"

namespace goniochrome::math {

namespace {

constexpr int kPlaces = 128;

// log 2: the first part has 32 bits, so that its product with an exponent of 2 times 128 is exact.
constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;
constexpr Twice kLn2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};

// 2^exponent, for exponents of normal numbers.
double power_of_two(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// m 2^exponent for m about 1, rounded once more where that is subnormal.
double scaled(double m, int exponent) {
  if (exponent >= -1021 && exponent <= 1023) return m * power_of_two(exponent);
  if (exponent > 0) return 2 * m * power_of_two(exponent - 1);
  return m * power_of_two(exponent + 200) * 0x1p-200;
}

// 2^(i/128), from its first by multiplication, and that by the exponential series.
constexpr std::array<Twice, kPlaces> powers_of_two() {
  const Twice x = {kLn2.high / kPlaces, kLn2.low / kPlaces};
  Twice first = {1, 0};
  for (int n = 16; n >= 1; --n) first = Twice{1, 0} + x * first / Twice{static_cast<double>(n), 0};
  std::array<Twice, kPlaces> table = {};
  table[0] = {1, 0};
  for (std::size_t i = 1; i < kPlaces; ++i) table[i] = table[i - 1] * first;
  return table;
}
constexpr std::array<Twice, kPlaces> kPowers = powers_of_two();

// (high + low) 2^exponent = e^(x + small), for |x| < 800 and |small| < 2^-40.
struct Exponential {
  double high, low;
  int exponent;
};
Exponential exponential(double x, double small) {
  constexpr double kStepHigh = kLn2High / kPlaces, kStepLow = kLn2Low / kPlaces, kPerStep = kPlaces / kLn2.high;
  const double steps = (x * kPerStep + kToInteger) - kToInteger;
  const double r = (x - steps * kStepHigh) - steps * kStepLow + small;  // the first difference is exact; |r| < 0.0028
  const int k = static_cast<int>(steps), place = k & (kPlaces - 1);
  const double rr = r * r, p = r + rr * ((0.5 + r * (1.0 / 6)) + rr * (1.0 / 24 + r * (1.0 / 120)));
  const Twice& t = kPowers[static_cast<std::size_t>(place)];
  return {t.high, t.low + t.high * p, (k - place) / kPlaces};
}

// The mantissa of a number is m in [1,2), or m/2 from sqrt 2 on. The first 7 bits of the mantissa name a place, of
// which `inverse` is the reciprocal to 9 bits, and high + low = -log(inverse). Where m is nearest to 1 the inverse is
// 1, so that logarithms near 0 keep their digits. `high` is a multiple of 2^-42, and so is log 2 below: their sums are
// exact.
struct Place {
  double inverse = 1, high = 0, low = 0;
};
constexpr int kHalvedFrom = 53;  // 1 + 53/128 is the multiple of 1/128 nearest to the square root of 2

constexpr double place_inverse(int i) {
  if (i == 0 || i == kPlaces - 1) return 1;
  const double middle = (1 + (i + 0.5) / kPlaces) * (i >= kHalvedFrom ? 0.5 : 1);
  return ((1 / middle + 0x1.8p43) - 0x1.8p43);  // to a multiple of 1/512
}

// log(a/b) of neighbors by the series of the inverse hyperbolic tangent.
constexpr Twice log_of_ratio(double a, double b) {
  const Twice s = Twice{a - b, 0} / Twice{a + b, 0}, ss = s * s;
  Twice sum = {0, 0};
  for (int n = 17; n >= 1; n -= 2) sum = sum * ss + Twice{2, 0} / Twice{static_cast<double>(n), 0};
  return s * sum;
}
constexpr std::array<Place, kPlaces> places() {
  std::array<Place, kPlaces> table = {};
  const auto fill = [&](int begin, int end, int step) {
    Twice log = {0, 0};
    for (int i = begin; i != end; i += step) {
      const double inverse = place_inverse(i);
      if (i != begin) log = log + log_of_ratio(place_inverse(i - step), inverse);
      const double high = (log.high + 0x1.8p10) - 0x1.8p10;
      table[static_cast<std::size_t>(i)] = {inverse, high, (log.high - high) + log.low};
    }
  };
  fill(0, kHalvedFrom, 1);
  fill(kPlaces - 1, kHalvedFrom - 1, -1);
  return table;
}
constexpr std::array<Place, kPlaces> kTable = places();
constexpr double kLn2Log = 0x1.62e42fefa38p-1, kLn2LogRest = 0x1.ef35793c7673p-45;  // a multiple of 2^-42, and the rest

// log x = high + low + log(1 + r + rest) for a positive normal x: high and r are exact, and so is r + rest where x is.
struct Reduced {
  double high, low, r, rest;
};
// The argument is x + beyond, where |beyond| is at most half an ulp of x.
Reduced reduced(double x, double beyond, int exponent) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto at = static_cast<std::size_t>((bits >> 45) & (kPlaces - 1));
  const std::uint64_t halved = at >= kHalvedFrom ? 1 : 0;
  const int k = static_cast<int>(bits >> 52) - 1023 + static_cast<int>(halved);
  const Place& place = kTable[at];
  const std::uint64_t mantissa = (bits & 0xfffffffffffffU) | ((1023 - halved) << 52);
  const double m = std::bit_cast<double>(mantissa), head = std::bit_cast<double>(mantissa & ~std::uint64_t{0x1fffff});
  const double r = head * place.inverse - 1;  // 32 bits by 10
  double rest = (m - head) * place.inverse;
  if (beyond != 0) rest += beyond * power_of_two(-k) * place.inverse;
  const double two = k + exponent;
  return {two * kLn2Log + place.high, two * kLn2LogRest + place.low, r, rest};
}

// log(1 + r) - r for |r| < 1/127.
double log_series(double r) {
  const double rr = r * r;
  return rr * ((-0.5 + r * (1.0 / 3)) + rr * ((-0.25 + r * 0.2) + rr * ((-1.0 / 6 + r * (1.0 / 7)) - rr * 0.125)));
}

double log_of(const Reduced& x) {
  const Twice sum = ordered_sum_of(x.high, x.r);
  return sum.high + (sum.low + (x.rest + x.low + log_series(x.r + x.rest)));
}

// log x to 2^-66 of itself.
Twice log_twice(const Reduced& x) {
  const Twice r = sum_of(x.r, x.rest);
  const double head = std::bit_cast<double>(std::bit_cast<std::uint64_t>(r.high) & ~std::uint64_t{0x7ffffff});
  const double tail = (r.high - head) + r.low, rr = r.high * r.high;
  const double cubic = rr * r.high *
                       ((1.0 / 3 - r.high * 0.25) +
                        rr * ((0.2 - r.high * (1.0 / 6)) + rr * ((1.0 / 7 - r.high * 0.125) + rr * (1.0 / 9))));
  const Twice first = ordered_sum_of(x.high, r.high), second = sum_of(first.high, -0.5 * (head * head));
  const double low = (first.low + second.low) + ((r.low + x.low) + (cubic - 0.5 * ((r.high + head) * tail)));
  return ordered_sum_of(second.high, low);
}

// 1/n! for n from 2.
constexpr std::array<double, 15> inverse_factorials() {
  std::array<double, 15> values = {};
  double factorial = 1;
  for (std::size_t n = 2; n < values.size() + 2; ++n)
    factorial *= static_cast<double>(n), values[n - 2] = 1 / factorial;
  return values;
}
constexpr std::array<double, 15> kInverseFactorials = inverse_factorials();

bool ordinary(double x) {  // positive, normal and finite
  return x >= std::numeric_limits<double>::min() && x < HUGE_VAL;
}

}  // namespace

double exp(double x) {
  if (!(x > -746)) return x < 0 ? 0 : x;  // NaN stays
  if (x > 710) return HUGE_VAL;
  const Exponential e = exponential(x, 0);
  return scaled(e.high + e.low, e.exponent);
}

// Up to 1/4 the Taylor series, whose first term is exact and whose second is at most 1/8 of it. Beyond, 1 is taken from
// the entry of the table exactly.
double expm1(double x) {
  if (!(std::abs(x) <= 40)) return x < 0 ? -1 : x > 0 ? exp(x) : x;
  if (x == 0) return x;  // with its sign
  if (std::abs(x) < 0.25) {
    double sum = 0;
    for (std::size_t n = 13; n >= 2; --n) sum = sum * x + kInverseFactorials[n - 2];
    return x + x * x * sum;
  }
  const Exponential e = exponential(x, 0);
  const double scale = power_of_two(e.exponent);
  const Twice rest = sum_of(e.high * scale, -1);
  return rest.high + (rest.low + e.low * scale);
}

namespace {

// (e^x + sign e^-x)/2 for x >= 1/2, or for any x >= 0 where the sign is positive.
double hyperbolic(double x, double sign) {
  if (x > 711) return HUGE_VAL;
  const Exponential up = exponential(x, 0);
  if (x > 40) return scaled(up.high + up.low, up.exponent - 1);
  const Exponential down = exponential(-x, 0);
  const double scale = sign * power_of_two(down.exponent - up.exponent);
  const Twice sum = ordered_sum_of(up.high, down.high * scale);
  return scaled(sum.high + (sum.low + (up.low + down.low * scale)), up.exponent - 1);
}

}  // namespace

double sinh(double x) {
  if (std::isnan(x)) return x;
  if (std::abs(x) >= 0.5) return std::copysign(hyperbolic(std::abs(x), -1), x);
  double sum = 0;
  for (std::size_t n = 15; n >= 3; n -= 2) sum = sum * (x * x) + kInverseFactorials[n - 2];
  return x + x * (x * x) * sum;
}

double cosh(double x) {
  return std::isnan(x) ? x : hyperbolic(std::abs(x), 1);
}

double log(double x) {
  if (ordinary(x)) return log_of(reduced(x, 0, 0));
  if (x > 0 && x < HUGE_VAL) return log_of(reduced(x * 0x1p54, 0, -54));
  return std::log(x);
}

// Near 0 the series alone. Elsewhere 1 + x and its rounding error, which the reduction takes.
double log1p(double x) {
  if (std::abs(x) < 1.0 / 256) return x + log_series(x);
  if (!(x > -1 && x < HUGE_VAL)) return std::log1p(x);
  const Twice sum = sum_of(1, x);
  return log_of(reduced(sum.high, sum.high < 0x1p1000 ? sum.low : 0, 0));
}

// e^(y log x), with the logarithm and the product to twice the digits, as an exponent of 700 would multiply an error by
// 700.
double pow(double x, double y) {
  if (x < 0 && std::isfinite(x) && std::isfinite(y)) {
    if (y != std::trunc(y)) return std::numeric_limits<double>::quiet_NaN();
    const double value = pow(-x, y);
    return std::fmod(y, 2) != 0 ? -value : value;
  }
  if (!(x > 0 && x < HUGE_VAL) || !std::isfinite(y)) return std::pow(x, y);
  const Twice log = log_twice(ordinary(x) ? reduced(x, 0, 0) : reduced(x * 0x1p54, 0, -54));
  const double product = log.high * y;
  if (!(std::abs(product) < 800)) return product > 0 ? HUGE_VAL : 0;
  if (std::abs(product) < 0x1p-60) return 1 + product;
  const Twice exact = product_of(log.high, y);
  const Exponential e = exponential(exact.high, exact.low + log.low * y);
  if (e.exponent > 1024) return HUGE_VAL;
  if (e.exponent < -1080) return 0;
  return scaled(e.high + e.low, e.exponent);
}

}  // namespace goniochrome::math
