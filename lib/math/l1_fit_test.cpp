#include <gtest/gtest.h>

#include <cmath>
#include <coin/ClpSimplex.hpp>
#include <cstdio>
#include <map>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "math/internal/problems_for_test.h"
#include "math/least_squares.h"

namespace goniochrome::math::l1_fit_test {
namespace {

using problems::Problem;

double norm_1(const std::vector<double>& v) {
  double s = 0;
  for (const double x : v) s += std::abs(x);
  return s;
}

double objective_of(const Problem& p, const double* x) {
  double sum = 0;
  for (int i = 0; i < p.m.rows; ++i) {
    double r = p.b[i];
    for (int j = 0; j < p.m.columns; ++j) r -= p.m(i, j) * x[j];
    sum += std::abs(r);
  }
  return sum;
}

// The program by an independent solver: minimize sum(u+v), Mx + u - v = b. `scaling` 0 is off, 3 its default. Its
// tolerances are absolute, so columns and target are given with largest entry 1 where `unit`.
double clp_objective(Problem p, int scaling, bool unit, int* status) {
  const int m = p.m.rows, n = p.m.columns;
  double scale = 0;
  for (const double v : p.b) scale = std::max(scale, std::abs(v));
  if (!unit || scale == 0) scale = 1;
  for (double& v : p.b) v /= scale;
  for (int j = 0; j < n && unit; ++j) {
    double largest = 0;
    for (int i = 0; i < m; ++i) largest = std::max(largest, std::abs(p.m(i, j)));
    for (int i = 0; i < m && largest > 0; ++i) p.m(i, j) /= largest;
  }
  // Columns of M, of u and of v, one after another. To make a solver takes longer than to solve, so one serves all.
  std::vector<CoinBigIndex> starts = {0};
  std::vector<int> rows;
  std::vector<double> values, costs(n + 2 * m, 1.0);
  std::fill_n(costs.begin(), n, 0.0);
  for (int j = 0; j < n; ++j) {
    values.insert(values.end(), p.m.column(j), p.m.column(j) + m);
    for (int i = 0; i < m; ++i) rows.push_back(i);
    starts.push_back(static_cast<CoinBigIndex>(rows.size()));
  }
  for (int i = 0; i < 2 * m; ++i) {
    values.push_back(i < m ? 1 : -1), rows.push_back(i % m);
    starts.push_back(static_cast<CoinBigIndex>(rows.size()));
  }
  static ClpSimplex clp;
  clp.setLogLevel(0);
  clp.messageHandler()->setLogLevel(0);
  clp.loadProblem(n + 2 * m, m, starts.data(), rows.data(), values.data(), nullptr, nullptr, costs.data(), p.b.data(),
                  p.b.data());
  clp.scaling(scaling);
  clp.setPrimalTolerance(1e-10);
  clp.setDualTolerance(1e-10);
  clp.dual();
  *status = clp.status();
  std::vector<double> x(clp.primalColumnSolution(), clp.primalColumnSolution() + n);
  for (double& v : x) v = std::max(v, 0.0);
  return scale * objective_of(p, x.data());
}

TEST(L1Fit, HundredThousandProblemsAllProvenOptimal) {
  std::mt19937_64 random(11);
  std::map<std::string, double> worst;
  std::map<std::string, int> pivots;
  for (int trial = 0; trial < 100000; ++trial) {
    const Problem p = problems::make(problems::kinds()[trial % problems::kinds().size()], random);
    const NonNegativeFit fit = l1_fit(p.m, p.b);
    ASSERT_TRUE(fit.converged) << p.kind << " " << trial << " gap " << fit.optimality_gap;
    for (const double x : fit.x) ASSERT_GE(x, 0);
    worst[p.kind] = std::max(worst[p.kind], fit.optimality_gap);
    pivots[p.kind] = std::max(pivots[p.kind], fit.iterations);
  }
  EXPECT_EQ(worst.size(), problems::kinds().size());
  for (const auto& [kind, gap] : worst) {
    RecordProperty(kind, fmt::format("gap {} pivots {}", gap, pivots[kind]));
    EXPECT_LE(gap, 1e-9) << kind;
  }
}

// math.long (ctest -L long) tries 100000.
TEST(L1Fit, AgreesWithClp) {
  std::mt19937_64 random(12);
  double above = 0, gap = 0;
  const int count = problems::trials(3600);
  for (int trial = 0; trial < count; ++trial) {
    const std::string kind = problems::kinds()[trial % problems::kinds().size()];
    const Problem p = problems::make(kind, random);
    int status = 0;
    const double clp = clp_objective(p, 0, true, &status);
    const NonNegativeFit fit = l1_fit(p.m, p.b);
    const double size = norm_1(p.b);
    ASSERT_TRUE(fit.converged) << kind << " " << trial;
    EXPECT_EQ(status, 0) << kind << " " << trial;
    EXPECT_NEAR(fit.objective, clp, 1e-9 * size) << kind << " " << trial;
    above = std::max(above, size > 0 ? (fit.objective - clp) / size : 0);
    gap = std::max(gap, fit.optimality_gap);
  }
  EXPECT_LE(gap, 1e-9);
  std::printf("%d problems: above the control by at most %.1e of |b|, proven gap %.1e\n", count, above, gap);
}

// The textbook simplex: largest price, first of the smallest ratios, any pivot that is not zero, no limit on stalls.
// Returns x, or nothing after `limit` pivots.
std::vector<double> textbook_simplex(const Problem& p, int limit) {
  const int m = p.m.rows, n = p.m.columns, width = m + n;
  // Shifted to z = y + 1 in [0,2]: rows sum A z + s = sum A, and z + t = 2.
  std::vector<std::vector<double>> t(n + m, std::vector<double>(width + m + 1, 0.0));
  std::vector<double> cost(width + m + 1, 0.0);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < m; ++i) t[j][i] = p.m(i, j), t[j].back() += p.m(i, j);
    t[j][m + j] = 1;
  }
  for (int i = 0; i < m; ++i) t[n + i][i] = 1, t[n + i][width + i] = 1, t[n + i].back() = 2, cost[i] = p.b[i];
  for (int pivots = 0; pivots < limit; ++pivots) {
    const int q = static_cast<int>(std::max_element(cost.begin(), cost.end() - 1) - cost.begin());
    if (cost[q] <= 0) {
      std::vector<double> x(n);
      for (int j = 0; j < n; ++j) x[j] = std::max(0.0, -cost[m + j]);
      return x;
    }
    int best = -1;
    for (int r = 0; r < n + m; ++r)
      if (t[r][q] > 0 && (best < 0 || t[r].back() / t[r][q] < t[best].back() / t[best][q])) best = r;
    if (best < 0) return {};
    const double inverse = 1 / t[best][q];
    for (double& v : t[best]) v *= inverse;
    const auto eliminate = [&](std::vector<double>& row) {
      const double f = row[q];
      for (std::size_t k = 0; k < row.size(); ++k) row[k] -= f * t[best][k];
    };
    for (int r = 0; r < n + m; ++r)
      if (r != best) eliminate(t[r]);
    eliminate(cost);
  }
  return {};
}

TEST(HardCase, FitDegenerateLpFiniteAndBoundedPivots) {
  std::mt19937_64 random(13);
  double textbook = 0, gap = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Problem p = problems::make(trial % 2 ? "tied" : "collinear", random);
    const NonNegativeFit fit = l1_fit(p.m, p.b);
    ASSERT_TRUE(fit.converged);
    gap = worst_of(gap, fit.optimality_gap);
    EXPECT_LE(fit.iterations, 10 * (p.m.rows + p.m.columns));
    const std::vector<double> x = textbook_simplex(p, 5000);
    const double excess = x.empty() ? INFINITY : (objective_of(p, x.data()) - fit.objective) / norm_1(p.b);
    textbook = worst_of(textbook, excess);
  }
  hard_case("fit-degenerate-lp", {.what = "objective above the optimum, over |b|, with ties and equal columns",
                                  .textbook = textbook,
                                  .ours = gap,
                                  .bound = 1e-11,
                                  .unit = "relative"});
}

TEST(HardCase, FitDegenerateLpWideColumnsFoolAutomaticScaling) {
  // Lobes that all but vanish at the samples: the control solver with its default scaling says "optimal" (status 0).
  std::mt19937_64 random(14);
  double worst = 1, gap = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Problem p = problems::lobes(random, 5, 8);
    int status = 0;
    const double clp = clp_objective(p, 3, false, &status);
    const NonNegativeFit fit = l1_fit(p.m, p.b);
    gap = worst_of(gap, fit.optimality_gap);
    EXPECT_LE(fit.objective, clp + 1e-9 * norm_1(p.b));
    if (status == 0) worst = worst_of(worst, clp / std::max(fit.objective, 1e-9 * norm_1(p.b)));
  }
  hard_case("fit-degenerate-lp", {.what = "objective above the optimum, with lobes nearly 0 at all samples",
                                  .textbook = worst - 1,
                                  .ours = gap,
                                  .bound = 1e-11,
                                  .unit = "relative"});
}

// Lobes with weights for six views, and rows that ask neighboring views to differ little: entries of both signs.
TEST(L1Fit, RowsOfBothSignsEndSoon) {
  constexpr int kViews = 6, kLobes = 6, kData = 600, kAlike = 60;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  int most = 0;
  for (int trial = 0; trial < 10; ++trial) {
    Matrix m(kData + kAlike, kViews * kLobes);
    std::vector<double> b(kData + kAlike, 0.0);
    for (int i = 0; i < m.rows; ++i) {
      const int view = i < kData ? static_cast<int>(random() % kViews) : i % (kViews - 1);
      const double c = std::cos((10 + 90 * unit(random)) * kDegree), weight = i < kData ? 1 : 0.1;
      for (int j = 0; j < kLobes; ++j) {
        m(i, view * kLobes + j) = weight * std::pow(std::max(c, 0.0), j == 0 ? 0 : std::pow(3, j - 1));
        if (i >= kData) m(i, (view + 1) * kLobes + j) = -m(i, view * kLobes + j);
      }
      if (i < kData) b[i] = std::max(0.0, std::pow(std::max(c, 0.0), 5 + view) - 0.3 * unit(random));
    }
    const NonNegativeFit fit = l1_fit(m, b);
    EXPECT_TRUE(fit.converged);
    EXPECT_LE(fit.optimality_gap, 1e-12);
    most = std::max(most, fit.iterations);
  }
  EXPECT_LE(most, kData);
}

TEST(L1Fit, IgnoresOutliersThatPullLeastSquares) {
  Matrix m(7, 1);
  std::vector<double> b(7, 2.0);
  for (int i = 0; i < 7; ++i) m(i, 0) = 1;
  b[3] = 100;
  EXPECT_EQ(l1_fit(m, b).x[0], 2.0);
  EXPECT_GT(nnls(m, b).x[0], 15);
}

}  // namespace
}  // namespace goniochrome::math::l1_fit_test
