// How long a search for the nearest paints takes, by the size of the library, in both metrics, for the tree and the
// scan. Every method is compared with brute force before it is timed. Queries are paints of the library moved by a few
// units, like designs that have near neighbors.
#include <benchmark/benchmark.h>

#include <map>
#include <random>

#include "library/internal/nearest.h"
#include "library/internal/random_paints_for_test.h"

namespace goniochrome::library {
namespace {

const std::vector<double> kAngles_deg = {15, 45, 110};
constexpr std::size_t kCount = 5;

struct Library {
  std::vector<double> rows;
  Tree tree;
  std::vector<std::vector<SearchTerm>> queries;
};

const Library& library(std::size_t size) {
  static std::map<std::size_t, Library> all;
  if (const auto found = all.find(size); found != all.end()) return found->second;
  std::mt19937_64 random(size);
  Library& made = all[size];
  std::vector<std::uint32_t> labels(size);
  for (std::size_t i = 0; i < size; ++i) {
    labels[i] = static_cast<std::uint32_t>(i);
    for (const color::Lab& lab : random_paints::colors(random, kAngles_deg))
      made.rows.insert(made.rows.end(), {lab.L, lab.a, lab.b});
  }
  made.tree = build_tree(made.rows, 9, labels);
  std::normal_distribution<double> moved(0, 2);
  for (std::size_t q = 0; q < 500; ++q) {
    const double* row = &made.rows[9 * (random() % size)];
    auto& terms = made.queries.emplace_back();
    for (std::size_t g = 0; g < 3; ++g)
      terms.push_back(
          {g, {row[3 * g] + moved(random), row[3 * g + 1] + moved(random), row[3 * g + 2] + moved(random)}});
  }
  return made;
}

bool agrees_with_brute_force(const Library& made, const std::vector<SearchTerm>& query, color::DifferenceFormula metric,
                             const NearestMatches& found) {
  NearestMatches brute(kCount);
  std::vector<color::Lab> lab(3);
  for (std::size_t i = 0; i < made.tree.size; ++i) {
    for (std::size_t g = 0; g < 3; ++g) {
      const double* color = &made.rows[9 * i + 3 * g];
      lab[g] = {color[0], color[1], color[2]};
    }
    brute.offer({search_distance(query, lab, metric), static_cast<std::uint32_t>(i)});
  }
  return std::ranges::equal(brute.list(), found.list(), [](const Match& x, const Match& y) {
    return x.distance == y.distance && x.label == y.label;
  });
}

template <bool de00, SearchMethod method>
void nearest(benchmark::State& state) {
  constexpr color::DifferenceFormula metric = de00 ? kDe00 : kDe76;
  const Library& made = library(static_cast<std::size_t>(state.range(0)));
  const auto run = [&](const std::vector<SearchTerm>& query) {
    NearestMatches best(kCount);
    find_nearest(made.tree.view(), query, metric, method, {}, best);
    return best;
  };
  for (std::size_t q = 0; q < 3; ++q)
    if (!agrees_with_brute_force(made, made.queries[q], metric, run(made.queries[q])))
      return state.SkipWithError("not the nearest paints");
  std::size_t q = 0;
  for (auto _ : state) benchmark::DoNotOptimize(run(made.queries[q++ % made.queries.size()]));
}

// A library of which a filter lets one paint in range(1) through.
template <SearchMethod method>
void nearest_filtered(benchmark::State& state) {
  const Library& made = library(static_cast<std::size_t>(state.range(0)));
  const TreeView tree = made.tree.view();
  std::mt19937_64 random(1);
  std::vector<LeafMask> masks(tree.leaves());
  for (std::size_t i = 0; i < tree.size; ++i)
    if (random() % static_cast<std::uint64_t>(state.range(1)) == 0)
      masks[i / kLeafSize] |= LeafMask{1} << i % kLeafSize;
  std::size_t q = 0;
  for (auto _ : state) {
    NearestMatches best(kCount);
    find_nearest(tree, made.queries[q++ % made.queries.size()], kDe76, method, masks, best);
    benchmark::DoNotOptimize(best);
  }
}

void build(benchmark::State& state) {
  const Library& made = library(static_cast<std::size_t>(state.range(0)));
  const std::vector<std::uint32_t> labels(made.tree.size);
  for (auto _ : state) benchmark::DoNotOptimize(build_tree(made.rows, 9, labels));
  state.counters["bytes_per_raw_byte"] =
      static_cast<double>(made.tree.blocks.size() * sizeof(double) + made.tree.boxes.size() * sizeof(ChildBounds) +
                          made.tree.labels.size() * sizeof(std::uint32_t)) /
      static_cast<double>(made.rows.size() * sizeof(double));
}

void sizes(benchmark::internal::Benchmark* bench) {
  for (const int size : {32, 64, 128, 256, 512, 1000, 10000, 100000, 1000000}) bench->Arg(size);
  bench->Unit(benchmark::kMicrosecond);
}

BENCHMARK(nearest<false, SearchMethod::kScan>)->Apply(sizes);
BENCHMARK(nearest<false, SearchMethod::kTree>)->Apply(sizes);
BENCHMARK(nearest<true, SearchMethod::kScan>)->Apply(sizes);
BENCHMARK(nearest<true, SearchMethod::kTree>)->Apply(sizes);
BENCHMARK(nearest_filtered<SearchMethod::kScan>)
    ->ArgsProduct({{1000000}, {10, 100, 1000, 10000, 100000}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(nearest_filtered<SearchMethod::kTree>)
    ->ArgsProduct({{1000000}, {10, 100, 1000, 10000, 100000}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(build)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace goniochrome::library
