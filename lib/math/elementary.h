// The elementary functions of the design arithmetic. Two C libraries return different last bits for them, and so a page
// in a browser would not repeat what a tool printed. These are made of +, -, *, / and square roots alone, which IEEE
// 754 defines to the last bit, and are compiled without contraction to fused operations: every machine returns the
// same.
//
// Each is within 1 ulp of the true value where that is a normal number; elementary_test.cpp holds them to the narrower
// bounds that were measured. Zeros, infinities, NaN and arguments outside the domain give what the C library gives.
#pragma once

namespace goniochrome::math {

double exp(double x);
double expm1(double x);  // e^x - 1
double sinh(double x);
double cosh(double x);

double log(double x);
double log1p(double x);  // log(1 + x)
double pow(double x, double y);

// The sine of an angle in radians. Beyond 1e7 in size, which no angle here reaches, they are those of the C library.
double sin(double x);
double cos(double x);
double tan(double x);

double asin(double x);
double acos(double x);
double atan2(double y, double x);

double cbrt(double x);
double hypot(double x, double y);
double hypot(double x, double y, double z);

}  // namespace goniochrome::math
