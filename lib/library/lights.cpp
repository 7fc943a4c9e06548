#include "library/lights.h"

#include <algorithm>
#include <utility>

#include "formats/paint_source.h"
#include "paint/spectra.h"

namespace goniochrome::library {

namespace {

// How many candidates of the first light are looked at first, for each match that is wanted.
constexpr std::size_t kFirstCandidates = 8;

// The paint in this light. All of its rows are those of its spectra, so that it has the same geometries in all lights.
Result<paint::Paint> lit_by(const paint::Paint& paint, const std::string& illuminant) {
  const color::ViewingCondition condition{illuminant, paint::condition_of(paint).observer_deg};
  GONIO_ASSIGN(paint::Paint lit, paint::in_light(paint, condition));
  GONIO_ASSIGN(lit.measurement, paint::under_light(*paint.measurement, condition));
  return Result(std::move(lit));
}

}  // namespace

Result<LightsSearch> LightsSearch::open(const std::string& library_path, std::vector<std::string> illuminants,
                                        LibrarySearchOptions options,
                                        const std::function<void(std::size_t)>& progress) {
  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(library_path));
  GONIO_ASSIGN(LightsSearch search,
               from_paints([&] { return source->next(); }, std::move(illuminants), std::move(options), progress));
  for (const auto& lines : {source->warnings(), source->closing_warnings()})
    search.warnings_.insert(search.warnings_.end(), lines.begin(), lines.end());
  return Result(std::move(search));
}

Result<LightsSearch> LightsSearch::from_paints(const std::function<Result<std::optional<paint::Paint>>()>& next_paint,
                                               std::vector<std::string> illuminants, LibrarySearchOptions options,
                                               const std::function<void(std::size_t)>& progress) {
  LightsSearch result;
  result.illuminants_ = std::move(illuminants);
  result.options_ = std::move(options);
  result.rows_.resize(result.illuminants_.size() - 1);
  std::size_t read = 0;
  const auto next = [&]() -> Result<std::optional<paint::Paint>> {
    GONIO_ASSIGN(std::optional<paint::Paint> paint, next_paint());
    if (!paint) return paint;
    if (++read % 1000 == 0 && progress) progress(read);
    const bool known = paint->measurement && !paint->measurement->spectra.empty();
    if (!known) {
      ++result.without_spectra_;
      paint->measurement.reset(), paint->appearance.reset();
    }
    for (std::size_t light = 1; light < result.illuminants_.size(); ++light) {
      auto& rows = result.rows_[light - 1].emplace_back();
      if (!known) continue;
      GONIO_ASSIGN(paint::Paint lit, lit_by(*paint, result.illuminants_[light]));
      rows = std::move(lit.measurement->rows);
    }
    if (!known) return paint;
    GONIO_ASSIGN(paint, lit_by(*paint, result.illuminants_.front()));
    return paint;
  };
  GONIO_ASSIGN(LibraryIndex index, LibraryIndex::from_paints(next));
  result.index_ = std::make_unique<LibraryIndex>(std::move(index));
  result.search_ = std::make_unique<LibrarySearch>(*result.index_, result.options_);
  return Result(std::move(result));
}

Result<LightsPlan> LightsSearch::plan(const paint::Paint& query) const {
  LightsPlan plan;
  for (const std::string& illuminant : illuminants_) {
    GONIO_ASSIGN(const paint::Paint lit, lit_by(query, illuminant));
    if (plan.terms.empty()) {
      GONIO_ASSIGN(plan.first, search_->plan(lit));
      plan.terms.push_back(plan.first.terms);
      continue;
    }
    std::vector<SearchTerm>& terms = plan.terms.emplace_back(plan.first.terms);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const auto row = std::ranges::find(lit.measurement->rows, plan.first.geometries[i], &paint::LabReading::geometry);
      if (row == lit.measurement->rows.end())
        return input_error("it has no spectrum at {}", paint::geometry_name(plan.first.geometries[i]));
      terms[i].lab = row->lab;
    }
  }
  return Result(std::move(plan));
}

LightsMatch LightsSearch::measured(LibraryMatch match, const LightsPlan& plan) const {
  LightsMatch result{std::move(match), 0};
  for (std::size_t light = 1; light < illuminants_.size(); ++light) {
    std::vector<color::Lab> lab;
    for (const paint::Geometry& geometry : plan.first.geometries)
      lab.push_back(
          std::ranges::find(rows_[light - 1][result.match.paint], geometry, &paint::LabReading::geometry)->lab);
    const double distance = search_distance(plan.terms[light], lab, options_.metric);
    if (distance > result.match.distance)
      result.match.distance = distance, result.match.lab = std::move(lab), result.light = light;
  }
  return result;
}

std::vector<LightsMatch> LightsSearch::nearest(const LightsPlan& plan) const {
  const std::size_t count = options_.count;
  for (std::size_t candidates = kFirstCandidates * count;; candidates *= 4) {
    std::vector<LibraryMatch> first = search_->nearest(plan.first, candidates);
    const bool all = first.size() < candidates;
    const double reached = first.empty() ? 0 : first.back().distance;
    std::vector<LightsMatch> matches;
    for (LibraryMatch& match : first) matches.push_back(measured(std::move(match), plan));
    std::ranges::sort(matches, {}, [](const LightsMatch& m) { return std::pair(m.match.distance, m.match.paint); });
    if (matches.size() > count) matches.resize(count);
    // A paint beyond those is at least as far as the last of them. It may be as far and stand before in the library.
    if (all || (matches.size() == count && matches.back().match.distance < reached)) return matches;
  }
}

}  // namespace goniochrome::library
