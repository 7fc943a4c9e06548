#include "fit/internal/lobe_choice.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::fit {

namespace {

// Subsets of the exponents by the objective of their linear fit, the best one kept.
class SubsetSearch {
 public:
  SubsetSearch(Norm norm, const FlakeTarget& target, const std::vector<double>& exponents, const Deadline& deadline)
      : norm_(norm),
        problem_(linear_problem(target, FlakeModel{exponents})),
        all_(static_cast<int>(exponents.size())),
        deadline_(deadline) {
    consider({});
  }

  const std::vector<int>& best() const { return best_; }
  void try_all(int count) {
    std::vector<char> taken(static_cast<std::size_t>(all_), 0);
    std::fill(taken.begin(), taken.begin() + count, 1);
    do {
      std::vector<int> lobes;
      for (int j = 0; j < all_; ++j)
        if (taken[j]) lobes.push_back(j);
      consider(lobes);
    } while (!deadline_.passed() && std::ranges::prev_permutation(taken).found);
  }

  // From the best k - 1 lobes to the best k, of all subsets or step by step; false, and nothing changed, where the
  // error falls by no more than that part of it.
  bool grow(int k, bool of_all, double least_gain) {
    const std::vector<int> fewer = best_;
    const double before = value_;
    if (of_all) {
      try_all(k);
    } else if (add_one()) {
      while (exchange_one()) {
      }
    }
    if (value_ < (1 - least_gain) * before) return true;
    best_ = fewer, value_ = before;
    return false;
  }

 private:
  // Adds the lobe that gains most; false where none does.
  bool add_one() {
    const std::vector<int> smaller = best_;
    bool gained = false;
    for (int j = 0; j < all_ && !deadline_.passed(); ++j) {
      std::vector<int> larger = smaller;
      larger.push_back(j);
      gained = consider(larger) || gained;
    }
    return gained;
  }

  // Puts another lobe in the place of each; false where that gains nothing.
  bool exchange_one() {
    const std::vector<int> before = best_;
    bool gained = false;
    for (std::size_t k = 0; k < before.size(); ++k)
      for (int j = 0; j < all_ && !deadline_.passed(); ++j) {
        std::vector<int> other = before;
        other[k] = j;
        gained = consider(other) || gained;
      }
    return gained;
  }

  bool consider(const std::vector<int>& lobes) {
    std::vector<int> columns = {0};
    for (const int j : lobes) {
      if (std::ranges::count(lobes, j) > 1) return false;
      columns.push_back(j + 1);
    }
    const double value = linear_fit(norm_, with_columns(problem_, columns)).objective;
    constexpr double kGain = 1e-9;  // below it an exchange is rounding
    if (!(value < value_ * (1 - kGain))) return false;
    best_ = lobes, value_ = value;
    return true;
  }

  Norm norm_;
  LinearProblem problem_;
  int all_;
  const Deadline& deadline_;
  std::vector<int> best_;
  double value_ = INFINITY;
};

double subsets_of(int all, int count) {
  double subsets = 1;
  for (int k = 0; k < count; ++k) subsets *= static_cast<double>(all - k) / (k + 1);
  return subsets;
}

std::vector<double> without(std::vector<double> values, std::size_t at) {
  values.erase(values.begin() + static_cast<std::ptrdiff_t>(at));
  return values;
}

double largest_change(const FlakeTarget& target, const FlakeModel& full, const std::vector<color::Rgb>& x,
                      const FlakeModel& part, const std::vector<color::Rgb>& part_x) {
  double worst = 0;
  for (const FlakeRow& row : target.rows)
    worst = std::max(worst, color_difference(shown(full, x, row.at), shown(part, part_x, row.at), target.white));
  return worst;
}

}  // namespace

std::vector<double> best_exponents(FitMethod method, const FlakeTarget& target, const std::vector<double>& exponents,
                                   int count, const Deadline& deadline) {
  // An exact l1 fit to thousands of rows takes a hundred times as long as l2, and both choose much the same lobes.
  constexpr std::size_t kManyRows = 200;
  const bool many = target.rows.size() > kManyRows;
  const int all = static_cast<int>(exponents.size());
  if (count >= all && !many) return exponents;
  count = std::min(count, all);
  SubsetSearch search(many ? Norm::kL2 : norm_of(method), target, exponents, deadline);
  constexpr double kFewSubsets = 500;
  if (!many && subsets_of(all, count) <= kFewSubsets) {
    search.try_all(count);
  } else {
    // Among thousands of directions, a gain below a hundredth of the error is noise.
    const double least_gain = many ? 0.01 : 0;
    bool gained = true;
    for (int k = 1; k <= count && gained; ++k) gained = search.grow(k, subsets_of(all, k) <= kFewSubsets, least_gain);
  }
  std::vector<double> chosen;
  for (const int j : search.best()) chosen.push_back(exponents[static_cast<std::size_t>(j)]);
  std::ranges::sort(chosen);
  return chosen;
}

std::vector<double> pruned_exponents(FitMethod method, const FlakeTarget& target, const std::vector<double>& exponents,
                                     double de00, const Deadline& deadline) {
  const FlakeModel full{exponents};
  const std::vector<color::Rgb> x = flake_fit(method, target, full, deadline).x;
  std::vector<double> left = exponents;
  while (!left.empty()) {
    std::size_t least = 0;
    double least_change = INFINITY;
    for (std::size_t k = 0; k < left.size() && !deadline.passed(); ++k) {
      const FlakeModel part{without(left, k)};
      const double change = largest_change(target, full, x, part, flake_fit(method, target, part, deadline).x);
      if (change < least_change) least = k, least_change = change;
    }
    if (least_change > de00) break;
    left = without(left, least);
  }
  return left;
}

}  // namespace goniochrome::fit
