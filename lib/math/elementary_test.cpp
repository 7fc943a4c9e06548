#include "math/elementary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/random_for_test.h"

namespace goniochrome::math::elementary_test {
namespace {

using Function = std::function<double(double)>;
using Exact = std::function<long double(long double)>;
static_assert(std::numeric_limits<long double>::digits >= 64, "long double is the reference");

// How far a value is from the exact one, in units of the last place of a double of that size.
double ulps(double value, long double exact) {
  int exponent = 0;
  std::frexp(static_cast<double>(exact), &exponent);
  return static_cast<double>(std::abs(value - exact) / std::ldexp(1.0L, std::max(exponent - 53, -1074)));
}

struct Range {
  double low, high;
  bool by_size = false;  // even in the logarithm
};
struct Case {
  std::string name;
  Function function;
  Exact exact;
  Function naive;  // what one writes first; the control
  std::vector<Range> ranges;
  double bound;        // in ulps: what was measured, and some hundredths more
  double naive_above;  // the control is worse than this
};

int trials() {
  const char* text = std::getenv("GONIOCHROME_TRIALS");
  return text ? std::atoi(text) : 100000;
}

double worst(const Case& one, const Function& function, double* where = nullptr) {
  TestNumbers random(7);
  double most = 0;
  for (const Range& range : one.ranges)
    for (int i = 0; i < trials(); ++i) {
      const double share = random(), sign = range.low < 0 ? 1 : 0;
      double x = range.by_size ? std::exp(std::lerp(std::log(range.low), std::log(range.high), share))
                               : range.low + (range.high - range.low) * share;
      if (!sign && i % 2 == 1 && one.name != "log" && one.name != "acos" && range.by_size) x = -x;
      const double off = ulps(function(x), one.exact(x));
      if (!(off <= most)) {
        most = off;
        if (where) *where = x;
      }
    }
  return most;
}

std::vector<Case> cases() {
  const Range every_size{1e-300, 1, true};
  return {
      {"exp",
       [](double x) { return exp(x); },
       [](long double x) { return std::exp(x); },
       [](double x) { return std::pow(2.718281828459045, x); },
       {{-700, 700}, {-1, 1}, {1e-20, 1, true}},
       0.53,
       10},
      {"expm1",
       [](double x) { return expm1(x); },
       [](long double x) { return std::expm1(x); },
       [](double x) { return std::exp(x) - 1; },
       {{-30, 30}, {-1, 1}, {1e-300, 1, true}},
       0.75,
       10},
      {"sinh",
       [](double x) { return sinh(x); },
       [](long double x) { return std::sinh(x); },
       [](double x) { return (std::exp(x) - std::exp(-x)) / 2; },
       {{-30, 30}, {-2, 2}, {1e-300, 1, true}},
       0.6,
       10},
      {"cosh",
       [](double x) { return cosh(x); },
       [](long double x) { return std::cosh(x); },
       [](double x) { return 1 + std::pow(std::sinh(x / 2), 2) * 2; },
       {{-30, 30}, {-2, 2}},
       0.53,
       1},
      {"log",
       [](double x) { return log(x); },
       [](long double x) { return std::log(x); },
       [](double x) { return std::log10(x) * 2.302585092994046; },
       {{1e-308, 1e308, true}, {0.5, 2}, {0.99, 1.01}, {1e-320, 1e-307, true}},
       0.53,
       1},
      {"log1p",
       [](double x) { return log1p(x); },
       [](long double x) { return std::log1p(x); },
       [](double x) { return std::log(1 + x); },
       {{-0.999, 10}, {-0.01, 0.01}, {1e-300, 0.99, true}},
       0.53,
       10},
      {"sin",
       [](double x) { return sin(x); },
       [](long double x) { return std::sin(x); },
       [](double x) { return std::cos(x - 1.5707963267948966); },
       {{-8, 8}, {-1e7, 1e7}, every_size},
       0.8,
       10},
      {"cos",
       [](double x) { return cos(x); },
       [](long double x) { return std::cos(x); },
       [](double x) { return std::sin(x + 1.5707963267948966); },
       {{-8, 8}, {-1e7, 1e7}},
       0.8,
       10},
      {"tan",
       [](double x) { return tan(x); },
       [](long double x) { return std::tan(x); },
       [](double x) { return std::sin(x) / std::cos(x); },
       {{-8, 8}, {-1e7, 1e7}, every_size},
       0.97,
       1},
      {"asin",
       [](double x) { return asin(x); },
       [](long double x) { return std::asin(x); },
       [](double x) { return std::atan2(x, std::sqrt(1 - x * x)); },
       {{-1, 1}, every_size},
       0.8,
       1},
      {"acos",
       [](double x) { return acos(x); },
       [](long double x) { return std::acos(x); },
       [](double x) { return std::atan2(std::sqrt(1 - x * x), x); },
       {{-1, 1}, {0.999, 1}, {-1, -0.999}},
       0.8,
       10},
      {"cbrt",
       [](double x) { return cbrt(x); },
       [](long double x) { return std::cbrt(x); },
       [](double x) { return std::copysign(std::pow(std::abs(x), 1 / 3.0), x); },
       {{1, 8}, {1e-300, 1e300, true}, {1e-320, 1e-307, true}},
       0.51,
       1},
  };
}

TEST(Elementary, FunctionsOfOneNumberKeepTheirBounds) {
  for (const Case& one : cases()) {
    double where = 0;
    const double off = worst(one, one.function, &where), naive = worst(one, one.naive);
    RecordProperty(one.name, std::to_string(off));
    std::printf("%-6s %.4f ulp at %.17g; control %.3g\n", one.name.c_str(), off, where, naive);
    EXPECT_LE(off, one.bound) << one.name << " at " << where;
    EXPECT_GT(naive, one.naive_above) << one.name;
  }
}

struct Pairs {
  std::string name;
  std::function<double(double, double)> function;
  std::function<long double(long double, long double)> exact;
  std::function<double(double, double)> naive;
  std::function<std::pair<double, double>(TestNumbers&)> arguments;
  double bound, naive_above;
};

TEST(Elementary, FunctionsOfTwoNumbersKeepTheirBounds) {
  const auto size = [](TestNumbers& random) { return std::exp(40 * random() - 20) * (random() < 0.5 ? -1 : 1); };
  const auto sizes = [&](TestNumbers& random) {
    const double x = size(random), y = random() < 0.5 ? size(random) : x * (2 * random() - 1);
    return random() < 0.5 ? std::pair(x, y) : std::pair(y, x);
  };
  const auto powers = [](TestNumbers& random) {
    const double x = random() < 0.5 ? std::exp(20 * random() - 10) : 1 + (random() - 0.5) / 50;
    return std::pair(x, (random() - 0.5) * std::min(1200 / std::abs(std::log(x)), 1e6));
  };
  const std::vector<Pairs> all = {
      {"pow", [](double x, double y) { return pow(x, y); }, [](long double x, long double y) { return std::pow(x, y); },
       [](double x, double y) { return std::exp(y * std::log(x)); }, powers, 0.56, 100},
      {"atan2", [](double y, double x) { return atan2(y, x); },
       [](long double y, long double x) { return std::atan2(y, x); },
       [](double y, double x) { return 2 * std::atan(y / (std::hypot(x, y) + x)); }, sizes, 0.8, 10},
      {"hypot", [](double x, double y) { return hypot(x, y); },
       [](long double x, long double y) { return std::sqrt(x * x + y * y); },
       [](double x, double y) { return std::sqrt(x * x + y * y); }, sizes, 0.51, 0.8},
      {"hypot3", [](double x, double y) { return hypot(x, y, 0.7 * x); },
       [](long double x, long double y) {
         const long double z = 0.7 * static_cast<double>(x);
         return std::sqrt(x * x + y * y + z * z);
       },
       [](double x, double y) { return std::sqrt(x * x + y * y + 0.7 * x * (0.7 * x)); }, sizes, 0.51, 0.8},
  };
  for (const Pairs& one : all) {
    TestNumbers random(11);
    double off = 0, naive = 0;
    std::pair<double, double> where;
    for (int i = 0; i < 3 * trials(); ++i) {
      const auto [x, y] = one.arguments(random);
      const long double exact = one.exact(x, y);
      const double here = ulps(one.function(x, y), exact);
      if (!(here <= off)) off = here, where = {x, y};
      naive = std::max(naive, ulps(one.naive(x, y), exact));
    }
    std::printf("%-6s %.4f ulp at %.17g, %.17g; control %.3g\n", one.name.c_str(), off, where.first, where.second,
                naive);
    EXPECT_LE(off, one.bound) << one.name << " at " << where.first << ", " << where.second;
    EXPECT_GT(naive, one.naive_above) << one.name;
  }
}

// The doubles that come nearest to multiples of 90 degrees, where nearly all digits of the argument cancel.
TEST(Elementary, SinesNearMultiplesOfAQuarterTurn) {
  double most = 0;
  for (int k = 1; k < 6000000; k = k * 9 / 8 + 1) {
    const double x = k * 1.5707963267948966;
    for (const double y : {x, std::nextafter(x, 0), std::nextafter(x, 1e9)}) {
      most = std::max({most, ulps(sin(y), std::sin(static_cast<long double>(y))),
                       ulps(cos(y), std::cos(static_cast<long double>(y))),
                       ulps(tan(y), std::tan(static_cast<long double>(y)))});
    }
  }
  EXPECT_LE(most, 0.97);
}

// Exact cases, signs, zeros, the ends of the range and what is no number.
TEST(Elementary, SpecialValuesAreThoseOfTheCLibrary) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const double least = std::numeric_limits<double>::denorm_min(), largest = std::numeric_limits<double>::max();
  const std::vector<double> values = {0.0, -0.0, 1,   -1,   2,   -2,    0.5,    -0.5,    3,
                                      -3,  1e10, inf, -inf, nan, least, -least, largest, -largest};
  const auto same = [](double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b)) ||
           std::abs(a - b) <= 4.5e-16 * std::abs(b);  // 1 ulp for each of the two libraries
  };
#define SAME_OF_ONE(f) EXPECT_TRUE(same(f(x), std::f(x))) << #f << " of " << x << ": " << f(x) << " for " << std::f(x)
#define SAME_OF_TWO(f)                     \
  EXPECT_TRUE(same(f(x, y), std::f(x, y))) \
      << #f << " of " << x << ", " << y << ": " << f(x, y) << " for " << std::f(x, y)
  for (const double x : values) {
    SAME_OF_ONE(exp);
    SAME_OF_ONE(expm1);
    SAME_OF_ONE(sinh);
    SAME_OF_ONE(cosh);
    SAME_OF_ONE(log);
    SAME_OF_ONE(log1p);
    SAME_OF_ONE(sin);
    SAME_OF_ONE(cos);
    SAME_OF_ONE(tan);
    SAME_OF_ONE(asin);
    SAME_OF_ONE(acos);
    SAME_OF_ONE(cbrt);
    for (const double y : values) {
      SAME_OF_TWO(pow);
      SAME_OF_TWO(atan2);
      SAME_OF_TWO(hypot);
    }
  }
  EXPECT_EQ(cbrt(27), 3);
  EXPECT_EQ(cbrt(-1e-3 * 1e-3 * 1e-3 * 0), 0);
  EXPECT_EQ(hypot(3, 4), 5);
  EXPECT_EQ(hypot(2, 3, 6), 7);
  EXPECT_EQ(hypot(3e300, 4e300), 5e300);
  EXPECT_EQ(pow(2, 0.5) * 1, std::sqrt(2));
  EXPECT_EQ(pow(3, 30), 205891132094649.0);
  EXPECT_EQ(pow(10, -3), 1e-3);
  EXPECT_EQ(exp(709.78271289338397), std::exp(709.78271289338397));
  EXPECT_EQ(exp(709.79), inf);
  EXPECT_EQ(exp(-745.2), 0);
  EXPECT_GT(exp(-745), 0);
}

}  // namespace
}  // namespace goniochrome::math::elementary_test
