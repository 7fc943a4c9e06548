#include "library/internal/nearest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/parallel.h"
#include "library/internal/random_paints_for_test.h"

namespace goniochrome::library::nearest_test {
namespace {

using Kind = color::DifferenceFormula::Kind;

constexpr color::DifferenceFormula kFormulas[] = {kDe76,        kDe00,           {Kind::kCie94},
                                                  {Kind::kCmc}, {Kind::kDin99o}, {Kind::kDin6175}};

struct Library {
  std::size_t geometries = 0;
  std::vector<double> rows;
  std::vector<std::uint32_t> labels;
  Tree tree;

  std::size_t size() const { return labels.size(); }
  color::Lab color(std::size_t paint, std::size_t geometry) const {
    const double* at = &rows[3 * (paint * geometries + geometry)];
    return {at[0], at[1], at[2]};
  }
};

// `duplicates` paints repeat earlier ones, so that there are ties.
Library random_library(std::mt19937_64& random, std::size_t size, const std::vector<double>& angles_deg,
                       std::size_t duplicates) {
  Library library;
  library.geometries = angles_deg.size();
  for (std::size_t i = 0; i < size; ++i) {
    library.labels.push_back(static_cast<std::uint32_t>(i));
    if (i + duplicates >= size) {
      const auto from = static_cast<std::ptrdiff_t>(3 * angles_deg.size() * (random() % (size - duplicates)));
      const std::vector<double> copy(library.rows.begin() + from,
                                     library.rows.begin() + from + 3 * static_cast<std::ptrdiff_t>(angles_deg.size()));
      library.rows.insert(library.rows.end(), copy.begin(), copy.end());
    } else {
      for (const color::Lab& lab : random_paints::colors(random, angles_deg))
        library.rows.insert(library.rows.end(), {lab.L, lab.a, lab.b});
    }
  }
  library.tree = build_tree(library.rows, 3 * angles_deg.size(), library.labels);
  return library;
}

// Every paint, one after another. The differences of a paint are added in the order of the terms, until it is out.
std::vector<Match> brute_force(const Library& library, const std::vector<SearchTerm>& terms,
                               const color::DifferenceFormula& metric, std::size_t count,
                               const std::function<bool(std::size_t)>& passes = {}) {
  std::vector<Match> best;
  for (std::size_t i = 0; i < library.size(); ++i) {
    if (passes && !passes(i)) continue;
    Match match{0, static_cast<std::uint32_t>(i)};
    const auto is_out = [&] { return best.size() == count && !(match < best.back()); };
    for (std::size_t t = 0; t < terms.size() && !is_out(); ++t) {
      const color::Lab lab = library.color(i, terms[t].geometry);
      match.distance += search_distance({&terms[t], 1}, {&lab, 1}, metric);
    }
    if (is_out()) continue;
    best.insert(std::upper_bound(best.begin(), best.end(), match), match);
    if (best.size() > count) best.pop_back();
  }
  return best;
}

void expect_equal(const std::vector<Match>& found, const std::vector<Match>& wanted, const std::string& what) {
  ASSERT_EQ(found.size(), wanted.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].label, wanted[i].label) << what << ", match " << i;
    ASSERT_EQ(found[i].distance, wanted[i].distance) << what << ", match " << i;
  }
}

std::vector<Match> found(const Library& library, const std::vector<SearchTerm>& terms,
                         const color::DifferenceFormula& metric, SearchMethod method, std::size_t count,
                         std::span<const LeafMask> masks = {}) {
  NearestMatches best(count);
  find_nearest(library.tree.view(), terms, metric, method, masks, best);
  return best.list();
}

// A paint of the library, untouched or moved a little, or any other paint.
std::vector<SearchTerm> random_query(std::mt19937_64& random, const Library& library,
                                     const std::vector<double>& angles_deg, int kind) {
  std::vector<color::Lab> lab = random_paints::colors(random, angles_deg);
  const std::size_t paint = random() % library.size();
  std::normal_distribution<double> moved(0, 2);
  std::vector<SearchTerm> terms;
  for (std::size_t g = 0; g < angles_deg.size(); ++g) {
    if (kind > 0) lab[g] = library.color(paint, g);
    if (kind > 1) lab[g] = {lab[g].L + moved(random), lab[g].a + moved(random), lab[g].b + moved(random)};
    terms.push_back({g, lab[g], 1, angles_deg[g]});
  }
  return terms;
}

// 2000 queries by each formula, ties included: the same paints and the same distances, to the last bit.
TEST(Search, TreeAndScanEqualBruteForce) {
  std::mt19937_64 random(7);
  const std::vector<double> angles_deg = {15, 45, 110};
  const Library library = random_library(random, 1000, angles_deg, 200);
  int ties = 0;
  for (int q = 0; q < 2000; ++q) {
    const auto terms = random_query(random, library, angles_deg, q % 3);
    for (const color::DifferenceFormula& metric : kFormulas) {
      const auto wanted = brute_force(library, terms, metric, 5);
      for (std::size_t i = 1; i < wanted.size(); ++i) ties += wanted[i].distance == wanted[i - 1].distance;
      expect_equal(found(library, terms, metric, SearchMethod::kTree, 5), wanted, "tree");
      if (q % 10 == 0) expect_equal(found(library, terms, metric, SearchMethod::kScan, 5), wanted, "scan");
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(ties, 1000);
}

TEST(Search, TreeAndScanAgreeForAnySizeCountAnglesAndWeights) {
  std::mt19937_64 random(8);
  for (const std::size_t size : {1, 2, 31, 32, 33, 64, 65, 97, 1000, 4097}) {
    const std::vector<double> angles_deg = {15, 25, 45, 75, 110};
    const Library library = random_library(random, size, angles_deg, size / 4);
    for (int q = 0; q < 8; ++q) {
      std::vector<SearchTerm> terms = random_query(random, library, angles_deg, q % 3);
      // Any subset of the angles, in any order, with weights; zero is one.
      std::shuffle(terms.begin(), terms.end(), random);
      terms.resize(1 + random() % terms.size());
      for (SearchTerm& term : terms) term.weight = static_cast<double>(random() % 5);
      for (const color::DifferenceFormula& metric : kFormulas)
        for (const std::size_t count : {std::size_t{1}, std::size_t{5}, size, size + 3})
          for (const SearchMethod method : {SearchMethod::kTree, SearchMethod::kScan})
            expect_equal(found(library, terms, metric, method, count), brute_force(library, terms, metric, count),
                         "size " + std::to_string(size));
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Search, EqualPaintsComeInTheOrderOfTheLibrary) {
  Library library;
  library.geometries = 1;
  for (std::uint32_t i = 0; i < 500; ++i) {
    library.labels.push_back(i);
    library.rows.insert(library.rows.end(), {50, 0, 0});
  }
  library.tree = build_tree(library.rows, 3, library.labels);
  const std::vector<SearchTerm> terms = {{0, {50, 0, 0}, 1}};
  for (const color::DifferenceFormula& metric : kFormulas) {
    const auto matches = found(library, terms, metric, SearchMethod::kTree, 7);
    ASSERT_EQ(matches.size(), 7u);
    for (std::uint32_t i = 0; i < 7; ++i) EXPECT_EQ(matches[i].label, i);
  }
}

TEST(Search, MasksLeavePaintsOut) {
  std::mt19937_64 random(9);
  const std::vector<double> angles_deg = {15, 110};
  const Library library = random_library(random, 3000, angles_deg, 500);
  const TreeView tree = library.tree.view();
  for (const std::uint32_t one_in : {1u, 3u, 100u, 2999u, 5000u}) {
    const auto passes = [&](std::size_t paint) { return (paint + 1) % one_in == 0; };
    std::vector<LeafMask> masks(tree.leaves());
    for (std::size_t place = 0; place < tree.size; ++place)
      if (passes(tree.labels[place])) masks[place / kLeafSize] |= LeafMask{1} << place % kLeafSize;
    for (int q = 0; q < 30; ++q) {
      const auto terms = random_query(random, library, angles_deg, q % 3);
      const auto wanted = brute_force(library, terms, kDe76, 5, passes);
      expect_equal(found(library, terms, kDe76, SearchMethod::kTree, 5, masks), wanted, "tree");
      expect_equal(found(library, terms, kDe76, SearchMethod::kScan, 5, masks), wanted, "scan");
    }
  }
}

TEST(Search, TreeDoesNotDependOnThreads) {
  std::mt19937_64 random(10);
  const Library library = random_library(random, 5000, {15, 45, 110}, 1000);
  for (const int count : {1, 2, 7}) {
    set_threads(count);
    const Tree again = build_tree(library.rows, 9, library.labels);
    EXPECT_EQ(again.labels, library.tree.labels);
    EXPECT_EQ(again.blocks, library.tree.blocks);
  }
  set_threads(0);
}

TEST(Search, FasterMethodCountsWhatPasses) {
  EXPECT_EQ(faster_method(20, 20), SearchMethod::kScan);
  EXPECT_EQ(faster_method(6000, 6000), SearchMethod::kTree);
  EXPECT_EQ(faster_method(1000000, 1000), SearchMethod::kTree);
  EXPECT_EQ(faster_method(1000000, 10), SearchMethod::kScan);
}

// The search relies on this: the bound, less its slack, is never above the color difference.
class Bound : public testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  // Colors as they come, and those that strain the formula: grays, near grays, blues where hue and chroma are coupled,
  // hues half a turn apart, far outside of any paint, on the axes.
  color::Lab color() {
    const double L = uniform(-5, 160), hue = uniform(0, 2 * kPi);
    switch (random_() % 8) {
      case 0:
        return {L, 0, 0};
      case 1:
        return {L, uniform(-1e-9, 1e-9), uniform(-1e-9, 1e-9)};
      case 2:
        return polar(L, uniform(0, 150), (275 + uniform(-40, 40)) * kDegree);
      case 3:
        return {uniform(49.9, 50.1), uniform(-1, 1), uniform(-1, 1)};
      case 4:
        return {L, uniform(-200, 200), 0};
      case 5:
        return polar(uniform(-1e3, 1e3), uniform(0, 1e4), hue);
      default:
        return polar(L, uniform(0, 120), hue);
    }
  }
  // Another color, related to the first or not.
  color::Lab partner(const color::Lab& x) {
    const double near = std::pow(10, uniform(-6, 1));
    switch (random_() % 5) {
      case 0:
        return {x.L + uniform(-near, near), x.a + uniform(-near, near), x.b + uniform(-near, near)};
      case 1:  // opposite hue, up to rounding
        return {uniform(0, 100), -x.a * near * (1 + uniform(-1e-9, 1e-9)), -x.b * near};
      case 2:  // chroma alone
        return {x.L, x.a * near, x.b * near};
      case 3:  // hue alone
        return polar(x.L, color::chroma(x), std::atan2(x.b, x.a) + uniform(-near, near));
      default:
        return color();
    }
  }
  static color::Lab polar(double L, double C, double hue) { return {L, C * std::cos(hue), C * std::sin(hue)}; }

  std::mt19937_64 random_{11};
};

double less_slack(double bound) {
  return bound - 1e-9 * bound - 1e-8;
}

TEST_F(Bound, De00FloorOfPoints) {
  double tightest = 0;
  for (int i = 0; i < 10'000'000; ++i) {
    const color::Lab x = color(), y = partner(x);
    const double difference = color::delta_e_2000(x, y), bound = de00_floor(x, {y, y});
    ASSERT_LE(less_slack(bound), difference)
        << x.L << " " << x.a << " " << x.b << " against " << y.L << " " << y.a << " " << y.b;
    if (difference > 1e-3) tightest = std::max(tightest, bound / difference);
  }
  EXPECT_GT(tightest, 0.999);  // reached where only L* differs
}

TEST_F(Bound, De00FloorOfBoxes) {
  for (int i = 0; i < 1'000'000; ++i) {
    const color::Lab x = color(), y = partner(x), z = partner(random_() % 2 ? x : y);
    const color::LabBox box = {{std::min(y.L, z.L), std::min(y.a, z.a), std::min(y.b, z.b)},
                               {std::max(y.L, z.L), std::max(y.a, z.a), std::max(y.b, z.b)}};
    const double bound = less_slack(de00_floor(x, box));
    for (int inside = 0; inside < 4; ++inside) {
      const auto between = [&](double low, double high) {
        const double at = std::array{0.0, 1.0, uniform(0, 1), uniform(0, 1)}[random_() % 4];
        return at == 1 ? high : low + at * (high - low);
      };
      const color::Lab p = {between(box.lower.L, box.upper.L), between(box.lower.a, box.upper.a),
                            between(box.lower.b, box.upper.b)};
      ASSERT_LE(bound, color::delta_e_2000(x, p))
          << x.L << " " << x.a << " " << x.b << " / " << p.L << " " << p.a << " " << p.b;
    }
  }
}

// The bound without the rotation term's factor is none: blues break it.
TEST_F(Bound, WithoutTheRotationTermItIsNoBound) {
  int broken = 0;
  for (int i = 0; i < 100'000; ++i) {
    const color::Lab x = color(), y = partner(x);
    const double C = (color::chroma(x) + color::chroma(y)) / 2 * 1.5, SC = 1 + 0.045 * C, u = (x.L + y.L) / 2 - 50;
    const double SL = 1 + 0.015 * u * u / std::sqrt(20 + u * u);
    const double naive = std::hypot((x.L - y.L) / SL, (x.a - y.a) / SC, (x.b - y.b) / SC);
    broken += less_slack(naive) > color::delta_e_2000(x, y);
  }
  EXPECT_GT(broken, 10);
}

// Neither is CIEDE2000 a metric: the way over a third color can be shorter, so a tree may not prune by it.
TEST_F(Bound, De00BreaksTheTriangleInequality) {
  int broken = 0;
  for (int i = 0; i < 100'000; ++i) {
    const color::Lab x = color(), y = partner(x), z = partner(x);
    broken += color::delta_e_2000(x, y) > color::delta_e_2000(x, z) + color::delta_e_2000(z, y) + 1e-6;
  }
  EXPECT_GT(broken, 10);
}

}  // namespace
}  // namespace goniochrome::library::nearest_test
