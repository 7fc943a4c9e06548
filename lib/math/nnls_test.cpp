#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "math/internal/problems_for_test.h"
#include "math/least_squares.h"

namespace goniochrome::math::nnls_test {
namespace {

using problems::Problem;

// The best objective over all subsets of columns, by Householder QR in long double: independent of active sets. Subsets
// that begin alike share the reflections of their first columns.
class BestSubset {
 public:
  explicit BestSubset(const Problem& p) : p_(p) { extend(0, std::vector<long double>(p.b.begin(), p.b.end())); }
  long double objective() const { return best_; }

 private:
  using Column = std::vector<long double>;
  struct Reflection {
    Column v;  // from its row on
    long double half;
  };

  // The subset of the columns so far, and all that follow it with further columns from `next` on; b is reflected
  // already.
  void extend(int next, const Column& b) {
    offer(b);
    if (std::ssize(reflections_) == p_.m.rows) return;
    for (int j = next; j < p_.m.columns; ++j) {
      Column a(p_.m.column(j), p_.m.column(j) + p_.m.rows);
      for (std::size_t c = 0; c < reflections_.size(); ++c) reflect(reflections_[c], c, a);
      const std::size_t row = reflections_.size();
      long double norm = 0, whole = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        whole += a[i] * a[i];
        if (i >= row) norm += a[i] * a[i];
      }
      norm = std::sqrt(norm);
      if (norm <= 1e-17L * std::sqrt(whole)) continue;  // singular, as is every subset with these columns
      Reflection reflection{Column(a.begin() + static_cast<std::ptrdiff_t>(row), a.end()), 0};
      reflection.v[0] -= a[row] > 0 ? -norm : norm;
      for (const long double x : reflection.v) reflection.half += x * x / 2;
      reflect(reflection, row, a);
      Column reflected = b;
      reflect(reflection, row, reflected);
      reflections_.push_back(std::move(reflection));
      triangle_.push_back(std::move(a));
      extend(j + 1, reflected);
      reflections_.pop_back();
      triangle_.pop_back();
    }
  }
  static void reflect(const Reflection& reflection, std::size_t row, Column& t) {
    long double s = 0;
    for (std::size_t i = row; i < t.size(); ++i) s += reflection.v[i - row] * t[i];
    for (std::size_t i = row; i < t.size(); ++i) t[i] -= s / reflection.half * reflection.v[i - row];
  }
  void offer(const Column& b) {
    const int k = static_cast<int>(triangle_.size());
    Column x(triangle_.size());
    for (int c = k - 1; c >= 0; --c) {
      x[c] = b[c];
      for (int q = c + 1; q < k; ++q) x[c] -= triangle_[q][c] * x[q];
      x[c] /= triangle_[c][c];
      if (!(x[c] >= 0)) return;
    }
    long double rest = 0;
    for (std::size_t i = triangle_.size(); i < b.size(); ++i) rest += b[i] * b[i];
    best_ = std::min(best_, std::sqrt(rest));
  }

  const Problem& p_;
  std::vector<Reflection> reflections_;
  std::vector<Column> triangle_;  // the reflected columns
  long double best_ = INFINITY;
};

double norm(const std::vector<double>& v) {
  double s = 0;
  for (const double x : v) s = std::hypot(s, x);
  return s;
}

// math.long (ctest -L long) tries 100000.
TEST(Nnls, MatchesTheBestSubsetInLongDouble) {
  std::mt19937_64 random(1);
  double worst = 0;
  const int count = problems::trials(3000);
  for (int trial = 0; trial < count; ++trial) {
    const Problem p = problems::make(problems::kinds()[trial % problems::kinds().size()], random);
    const NonNegativeFit fit = nnls(p.m, p.b);
    ASSERT_TRUE(fit.converged) << p.kind << " " << trial;
    for (const double x : fit.x) ASSERT_GE(x, 0);
    // A gradient known to a few ulp of |b| fixes the squared objective to as many ulp of |b|^2 times the weights.
    const double ours = fit.objective / norm(p.b),
                 reference = static_cast<double>(BestSubset(p).objective()) / norm(p.b);
    if (norm(p.b) == 0) continue;
    EXPECT_NEAR(ours * ours, reference * reference, 2e-14) << p.kind << " " << trial;
    EXPECT_LE(ours, reference + 1e-9) << p.kind << " " << trial;
    worst = std::max(worst, ours - reference);
    if (reference > 1e-4) {
      EXPECT_NEAR(ours, reference, 1e-9 * reference) << p.kind << " " << trial;
    }
  }
  std::printf("%d problems: above the reference by at most %.1e of |b|\n", count, worst);
}

TEST(Nnls, HundredThousandProblemsAllOptimal) {
  std::mt19937_64 random(2);
  std::map<std::string, double> worst;
  for (int trial = 0; trial < 100000; ++trial) {
    const Problem p = problems::make(problems::kinds()[trial % problems::kinds().size()], random);
    const NonNegativeFit fit = nnls(p.m, p.b);
    ASSERT_TRUE(fit.converged) << p.kind << " " << trial;
    worst[p.kind] = std::max(worst[p.kind], fit.optimality_gap);
  }
  EXPECT_EQ(worst.size(), problems::kinds().size());
  // Largest for columns of mixed sign, whose weights can be large and of opposite effect.
  for (const auto& [kind, gap] : worst) EXPECT_LE(gap, kind == "signed" ? 1e-11 : 1e-14) << kind;
}

// Columns of cos^E at the usual angles; what a basis with exponents 900 and 1000, or twice the same, gives.
Matrix lobe_columns(const std::vector<double>& exponents) {
  const std::vector<double> angles = {2, 5, 10, 15, 25, 45, 75, 110};
  Matrix m(static_cast<int>(angles.size()), static_cast<int>(exponents.size()));
  for (int i = 0; i < m.rows; ++i)
    for (int j = 0; j < m.columns; ++j) m(i, j) = std::pow(std::max(0.0, std::cos(angles[i] * kDegree)), exponents[j]);
  return m;
}

// The textbook form: normal equations and Cholesky for the passive set.
std::vector<double> normal_equations(const Matrix& m, const std::vector<double>& b) {
  const int n = m.columns;
  std::vector<double> g(static_cast<std::size_t>(n) * n, 0.0), h(n, 0.0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < m.rows; ++i) {
      for (int k = 0; k < n; ++k) g[j * n + k] += m(i, j) * m(i, k);
      h[j] += m(i, j) * b[i];
    }
  for (int k = 0; k < n; ++k) {
    for (int i = k + 1; i < n; ++i) {
      const double f = g[i * n + k] / g[k * n + k];
      for (int j = k; j < n; ++j) g[i * n + j] -= f * g[k * n + j];
      h[i] -= f * h[k];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) h[i] -= g[i * n + j] * h[j];
    h[i] /= g[i * n + i];
  }
  return h;
}

TEST(HardCase, FitCollinearSameObjectiveAndBoundedWeights) {
  const std::vector<double> b = {4.2, 3.9, 3.1, 2.2, 1.0, 0.3, 0.1, 0.05};
  const NonNegativeFit lean = nnls(lobe_columns({0, 6, 70, 900}), b);
  double ours = 0, control = INFINITY;
  for (const std::vector<double>& exponents :
       {std::vector<double>{0, 6, 70, 900, 900}, {0, 6, 6, 70, 900}, {0, 0, 6, 70, 70, 900, 900, 900}}) {
    const NonNegativeFit fit = nnls(lobe_columns(exponents), b);
    EXPECT_NEAR(fit.objective, lean.objective, 1e-9 * lean.objective);
    for (const double x : fit.x) ours = worst_of(ours, x);
    // The control: normal equations divide by zero or by rounding noise.
    const std::vector<double> textbook = normal_equations(lobe_columns(exponents), b);
    double largest = 0;
    for (const double x : textbook) largest = std::isfinite(x) ? std::max(largest, std::abs(x)) : INFINITY;
    EXPECT_GT(largest, 100 * norm(b));
    control = std::min(control, largest);
  }
  hard_case("fit-collinear", {.what = "largest weight of equal lobes, over |b|",
                              .textbook = control / norm(b),
                              .ours = ours / norm(b),
                              .bound = 2,
                              .unit = "|b|"});
  const NonNegativeFit near = nnls(lobe_columns({0, 6, 70, 900, 1000}), b);
  EXPECT_LE(near.objective, lean.objective * (1 + 1e-12));
  for (const double x : near.x) EXPECT_LE(x, 2 * norm(b));
}

TEST(HardCase, FitRangeScaleFree) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Problem p = problems::lobes(random, 8, 7);
    const NonNegativeFit fit = nnls(p.m, p.b);
    const NonNegativeFit lp = l1_fit(p.m, p.b);
    for (const double s : {0x1p-60, 0x1p40, 1e-8, 1e4, 1e-150, 1e150}) {
      std::vector<double> scaled = p.b;
      for (double& v : scaled) v *= s;
      const NonNegativeFit fit_s = nnls(p.m, scaled), lp_s = l1_fit(p.m, scaled);
      const bool power_of_two = std::log2(s) == std::floor(std::log2(s));
      for (int j = 0; j < p.m.columns; ++j) {
        if (power_of_two) {  // no rounding anywhere: the same bits
          EXPECT_EQ(fit_s.x[j], s * fit.x[j]);
          EXPECT_EQ(lp_s.x[j], s * lp.x[j]);
          continue;
        }
        // b is rounded once more; condition numbers of some 1e5 magnify it in a lobe's share of the target.
        const double share = *std::max_element(p.m.column(j), p.m.column(j) + p.m.rows);
        EXPECT_NEAR(fit_s.x[j] / s * share, fit.x[j] * share, 1e-8 * norm(p.b));
        EXPECT_NEAR(lp_s.x[j] / s * share, lp.x[j] * share, 1e-8 * norm(p.b));
      }
    }
  }
}

TEST(HardCase, FitRangeWeightsOf1e8And1e4Together) {
  Matrix m = lobe_columns({0, 6, 70, 900});
  const std::vector<double> truth = {1e-8, 3e-7, 0, 1e4};
  std::vector<double> b(m.rows, 0.0);
  for (int i = 0; i < m.rows; ++i)
    for (int j = 0; j < m.columns; ++j) b[i] += truth[j] * m(i, j);
  const NonNegativeFit fit = nnls(m, b);
  // At 110 deg only the constant is left: b holds it exactly, but the sum of squares does not resolve 1e-8 beside 1e4
  // (their ratio squared is 1e-24); what can be asked is the residual relative to |b|.
  EXPECT_NEAR(fit.x[3], 1e4, 1e-9 * 1e4);
  EXPECT_LE(fit.objective, 1e-13 * norm(b));
  // The control: a stop on the gradient of unscaled columns, |gradient| <= 1e-6, leaves the small target at zero.
  std::vector<double> dark(m.rows);
  for (int i = 0; i < m.rows; ++i) dark[i] = 1e-8 * m(i, 0) + 3e-7 * m(i, 1);
  double gradient = 0;
  for (int j = 0; j < m.columns; ++j) {
    double g = 0;
    for (int i = 0; i < m.rows; ++i) g += m(i, j) * dark[i];
    gradient = std::max(gradient, g);
  }
  EXPECT_LE(gradient, 2e-6) << "the textbook stop is met by x = 0";
  const NonNegativeFit ours = nnls(m, dark);
  hard_case("fit-range", {.what = "weights of a target of 1e-8",
                          .textbook = 1,
                          .ours = std::max(std::abs(ours.x[0] / 1e-8 - 1), std::abs(ours.x[1] / 3e-7 - 1)),
                          .bound = 1e-10,
                          .unit = "relative"});
}

TEST(HardCase, FitRangeZeroTargetAndOneSample) {
  const Matrix m = lobe_columns({0, 6, 70});
  for (auto* solve : {&nnls, &l1_fit}) {
    const NonNegativeFit zero = (*solve)(m, std::vector<double>(m.rows, 0.0));
    EXPECT_EQ(zero.x, std::vector<double>(3, 0.0));
    EXPECT_EQ(zero.objective, 0);
    EXPECT_TRUE(zero.converged);
    Matrix one(1, 3);
    one(0, 0) = 1, one(0, 1) = 0.5, one(0, 2) = 1e-30;
    const NonNegativeFit single = (*solve)(one, {7});
    EXPECT_NEAR(single.objective, 0, 1e-14);
    EXPECT_EQ((*solve)(one, {-7}).x, std::vector<double>(3, 0.0));
  }
}

TEST(Nnls, ErrorNeverRisesWithAnotherLobe) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 500; ++trial) {
    const Problem p = problems::lobes(random, 10, 9);
    double before2 = INFINITY, before1 = INFINITY;
    for (int columns = 1; columns <= 9; ++columns) {
      Matrix part(10, columns);
      std::copy_n(p.m.values.begin(), part.values.size(), part.values.begin());
      const double now2 = nnls(part, p.b).objective, now1 = l1_fit(part, p.b).objective;
      // Both differ from the exact optimum by some ten ulp of |b| times the condition of the columns.
      EXPECT_LE(now2, before2 + 1e-13 * norm(p.b));
      EXPECT_LE(now1, before1 + 1e-13 * norm(p.b));
      before2 = now2, before1 = now1;
    }
  }
}

}  // namespace
}  // namespace goniochrome::math::nnls_test
