#include "finding.h"

#include <cmath>

#include "base/clock.h"
#include "base/text.h"

namespace goniochrome::tool {

namespace {

Neighbor neighbor_of(library::LibraryMatch match, const std::vector<library::SearchTerm>& terms,
                     const color::DifferenceFormula& metric) {
  Neighbor neighbor;
  double weight = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const color::Lab &query = terms[i].lab, &found = match.lab[i];
    neighbor.de.push_back(color::difference(metric, query, found, terms[i].aspecular_deg));
    const color::LabDifference difference = color::lab_difference(found, query);
    neighbor.dL += difference.dL, neighbor.dC += difference.dC, neighbor.dH += difference.dH;
    weight += terms[i].weight;
  }
  const auto count = static_cast<double>(terms.size());
  neighbor.dL /= count, neighbor.dC /= count, neighbor.dH /= count;
  neighbor.mean_de = weight > 0 ? match.distance / weight : 0;
  neighbor.match = std::move(match);
  return neighbor;
}

}  // namespace

std::string Finding::status() const {
  if (no_match()) return "no_match";
  std::vector<std::string> held;
  if (outside) held.emplace_back("outside");
  if (off_radial) held.emplace_back("off_radial");
  if (turns) held.emplace_back("hue_travel");
  return held.empty() ? "ok" : joined(held, ",");
}

Result<QueryPlan> Searched::plan(const paint::Paint& query) const {
  QueryPlan result;
  if (lights_ == nullptr) {
    GONIO_ASSIGN(result.plan, search_.plan(query));
    return Result(std::move(result));
  }
  GONIO_ASSIGN(result.lights, lights_->plan(query));
  result.plan = result.lights->first;
  return Result(std::move(result));
}

std::vector<Neighbor> Searched::nearest(const QueryPlan& plan, const color::DifferenceFormula& metric) const {
  std::vector<Neighbor> neighbors;
  if (!plan.lights) {
    for (library::LibraryMatch& match : search_.nearest(plan.plan))
      neighbors.push_back(neighbor_of(std::move(match), plan.plan.terms, metric));
    return neighbors;
  }
  for (library::LightsMatch& found : lights_->nearest(*plan.lights)) {
    neighbors.push_back(neighbor_of(std::move(found.match), plan.lights->terms[found.light], metric));
    neighbors.back().illuminant = lights_->illuminants()[found.light];
  }
  return neighbors;
}

Finding finding_of(const paint::Paint& query, QueryPlan plan, const Searched& library,
                   const color::DifferenceFormula& metric, const library::VerdictLimits& limits) {
  Finding finding;
  finding.query = query.name;
  const Stopwatch searching;
  finding.neighbors = library.nearest(plan, metric);
  finding.search_s = searching.elapsed_s();
  finding.plan = std::move(plan.plan);
  finding.hue_shift = finding.matched_hue_shift = paint::PaintMetrics::kNone;
  finding.hue_travel_deg = finding.matched_hue_travel_deg = paint::PaintMetrics::kNone;
  if (finding.no_match()) return finding;

  const Neighbor& nearest = finding.neighbors.front();
  const library::Verdict verdict =
      library::verdict(query, library.index(), nearest.match.paint, nearest.mean_de, limits);
  finding.hue_shift = verdict.hue_shift, finding.matched_hue_shift = verdict.matched_hue_shift;
  finding.hue_travel_deg = verdict.hue_travel_deg, finding.matched_hue_travel_deg = verdict.matched_hue_travel_deg;
  finding.outside = verdict.outside, finding.off_radial = verdict.off_radial, finding.turns = verdict.turns;
  return finding;
}

}  // namespace goniochrome::tool
