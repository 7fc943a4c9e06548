// A number as the unevaluated sum of two doubles, which carries twice the digits of one. All of it is exact in IEEE
// arithmetic without fused operations, so it gives the same bits on every machine. [Dekker1971]
#pragma once

namespace goniochrome::math {

struct Twice {
  double high = 0, low = 0;
};

// Added to a number and taken away again, this leaves the nearest integer (ties to even), for |x| < 2^51.
inline constexpr double kToInteger = 0x1.8p52;

// a + b and its rounding error, exactly.
constexpr Twice sum_of(double a, double b) {
  const double s = a + b, bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

// Variant for |a| >= |b| or a = 0, in half of the operations.
constexpr Twice ordered_sum_of(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

// a as the sum of two numbers of at most 26 bits, for |a| < 2^996.
constexpr Twice halves_of(double a) {
  const double t = 134217729 * a, high = t - (t - a);  // 2^27 + 1
  return {high, a - high};
}

// a b and its rounding error, exactly where neither overflows nor falls below 2^-969.
constexpr Twice product_of(double a, double b) {
  const double p = a * b;
  const Twice x = halves_of(a), y = halves_of(b);
  return {p, ((x.high * y.high - p) + (x.high * y.low + x.low * y.high)) + x.low * y.low};
}
constexpr Twice square_of(double a) {
  const double p = a * a;
  const Twice x = halves_of(a);
  return {p, ((x.high * x.high - p) + 2 * (x.high * x.low)) + x.low * x.low};
}

constexpr Twice operator-(Twice a) {
  return {-a.high, -a.low};
}
constexpr Twice operator+(Twice a, Twice b) {
  Twice s = sum_of(a.high, b.high);
  const Twice t = sum_of(a.low, b.low);
  s = sum_of(s.high, s.low + t.high);
  return sum_of(s.high, s.low + t.low);
}
constexpr Twice operator*(Twice a, double b) {
  const Twice p = product_of(a.high, b);
  return sum_of(p.high, p.low + a.low * b);
}
constexpr Twice operator*(Twice a, Twice b) {
  const Twice p = product_of(a.high, b.high);
  return sum_of(p.high, p.low + (a.high * b.low + a.low * b.high));
}
constexpr Twice operator/(Twice a, Twice b) {
  const double q = a.high / b.high;
  const Twice rest = a + -(b * q);
  return sum_of(q, rest.high / b.high);
}

}  // namespace goniochrome::math
