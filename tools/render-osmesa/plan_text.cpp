#include "plan_text.h"

#include <cmath>

namespace goniochrome::tool {

namespace {

// Engines that draw everything at once are not asked what each effect is worth and costs.
std::string known(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.2f}", value);
}

}  // namespace

std::string plan_table(const render::Plan& plan) {
  bool truth = false;
  for (const render::PlanItem& item : plan.items) truth |= item.truth_de00_p95.has_value();
  std::string text = fmt::format("{:<13} {:<6} {:>7} {}{:>7}  {:<16} {}\n", "effect", "needed", "dE00",
                                 truth ? "  truth " : "", "ms", "decision", "why");
  for (const render::PlanItem& item : plan.items) {
    const std::string exact = item.truth_de00_p95 ? fmt::format("{:7.2f} ", *item.truth_de00_p95)
                              : truth             ? "        "
                                                  : "";
    text += item.needed
                ? fmt::format("{:<13} {:<6} {:>7} {}{:>7}  {:<16} {}\n", item.effect, "yes", known(item.de00_p95),
                              exact, known(item.cost_ms), spelled(item.decision), item.reason)
                : fmt::format("{:<13} {:<6} {:>7} {}{:>7}  {:<16} {}\n", item.effect, "no", "-",
                              truth ? "        " : "", "-", spelled(item.decision), item.reason);
  }
  if (plan.rays_ms > 0)
    text += fmt::format("rays: predicted {:.0f} ms, noise dE00 {:.2f}\n", plan.rays_ms, plan.rays_noise_de00);
  if (plan.effects.most_samples_in_all > 0)
    text += fmt::format(
        "no tolerance, time limit or check is asked for: rays take at most {:.0f} million samples a picture\n",
        1e-6 * plan.effects.most_samples_in_all);
  if (plan.open_de00_p95)
    text += fmt::format("open light as planned: dE00 {:.2f} to its exact sum (p95)\n", *plan.open_de00_p95);
  if (plan.whole_de00_p95) text += fmt::format("the whole: dE00 {:.2f} (p95) predicted\n", *plan.whole_de00_p95);
  if (plan.path_ms > 0)
    text += fmt::format("rays alone would keep the tolerance in {:.0f} ms, predicted for a picture\n", plan.path_ms);
  return text + fmt::format("left out together: dE00 {:.2f} (p95); planned in {:.1f} ms\nengine {}: {}\n",
                            plan.de00_p95, plan.time_ms, plan.engine, plan.engine_reason);
}

std::string shader_gaps(const render::Plan& plan) {
  const render::Effects& effects = plan.effects;
  std::string gaps;
  const auto gap = [&](bool shown, const char* effect, const char* what) {
    if (shown) gaps += fmt::format("//   {}: {}\n", effect, what);
  };
  gap(effects.maps, "travel", "color maps under lights, evaluated on the processor");
  gap(effects.rays.shadow, "shadow", "light that the mesh takes from itself, traced by rays");
  gap(effects.rays.self, "self", "the mesh in its own mirror and gloss, traced by rays");
  gap(effects.rays.bounce, "bounce", "light that the mesh sends to itself, traced by rays");
  gap(effects.rays.floor, "floor", "the floor and its light, traced by rays");
  if (gaps.empty()) return "";
  return "// The picture also shows what this program lacks. It is added to the output of the program:\n" + gaps;
}

Json plan_rows(const render::Plan& plan, bool times) {
  Json rows = Json::array();
  for (const render::PlanItem& item : plan.items) {
    Json row = {{"effect", item.effect},
                {"needed", item.needed},
                {"reason", item.reason},
                {"de00_p95", item.needed ? json_number(item.de00_p95) : Json(nullptr)},
                {"decision", spelled(item.decision)}};
    if (times) row["cost_ms"] = item.needed ? json_number(item.cost_ms) : Json(nullptr);
    if (item.standard_error) row["standard_error"] = json_number(*item.standard_error);
    if (item.truth_de00_p95) row["truth_de00_p95"] = json_number(*item.truth_de00_p95);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace goniochrome::tool
