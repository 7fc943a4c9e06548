#include "plan_text.h"

#include <cmath>

namespace goniochrome::tool {

namespace {

// Not every effect is measured.
std::string known(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.2f}", value);
}

// An effect, and the word of --effects that switches it where that is another.
std::string label_of(const std::string& effect) {
  const std::string word = render::word_of_effect(effect);
  return word == effect ? effect : fmt::format("{} ({})", effect, word);
}

}  // namespace

std::string plan_table(const render::Plan& plan) {
  bool truth = false;
  for (const render::PlanItem& item : plan.items) truth |= item.truth_de00_p95.has_value();
  std::string text = fmt::format("{:<20} {:<6} {:>7} {} {:<16} {}\n", "effect", "needed", "dE00",
                                 truth ? "  truth " : "", "decision", "why");
  for (const render::PlanItem& item : plan.items) {
    const std::string exact = item.truth_de00_p95 ? fmt::format("{:7.2f} ", *item.truth_de00_p95)
                              : truth             ? "        "
                                                  : "";
    text += fmt::format("{:<20} {:<6} {:>7} {} {:<16} {}\n", label_of(item.effect), item.needed ? "yes" : "no",
                        item.needed ? known(item.de00_p95) : "-", exact, spelled(item.decision), item.reason);
  }
  return text + fmt::format("left out of the maps together: dE00 {:.2f} (p95); planned in {:.1f} ms\nengine {}: {}\n",
                            plan.de00_p95, plan.time_ms, plan.engine, plan.engine_reason);
}

std::string findings_text(const render::Plan& before, const render::Plan& after) {
  std::string text;
  for (std::size_t i = 0; i < after.items.size(); ++i) {
    const render::PlanItem& item = after.items[i];
    if (!std::isnan(before.items[i].de00_p95) || std::isnan(item.de00_p95)) continue;
    text += fmt::format("{:<20} {:>14} {}  {}\n", label_of(item.effect), known(item.de00_p95), spelled(item.decision),
                        item.reason);
  }
  return text.empty() ? "" : "the first pass found\n" + text;
}

std::string shader_gaps(const render::Plan& plan) {
  const render::Effects& effects = plan.effects;
  std::string gaps;
  const auto gap = [&](bool shown, const char* effect, const char* what) {
    if (shown) gaps += fmt::format("//   {}: {}\n", effect, what);
  };
  gap(effects.tilt_level > 0 || effects.stretch, "travel, satin", "tilted lobes, looked up on the processor");
  gap(effects.placed, "lamps at a place", "shaded on the processor");
  gap(effects.texture, "texture", "surfaces of lobes, shaded on the processor");
  gap(effects.maps, "travel", "color maps under lights, evaluated on the processor");
  gap(effects.rays.shadow, "shadow", "light that the mesh takes from itself, traced by rays");
  gap(effects.rays.self, "self", "the mesh in its own mirror and gloss, traced by rays");
  gap(effects.rays.bounce, "bounce", "light that the mesh sends to itself, traced by rays");
  gap(effects.rays.floor, "floor", "the floor and its light, traced by rays");
  if (gaps.empty()) return "";
  return "// The picture also shows what this program lacks. It is added to the output of the program:\n" + gaps;
}

Json plan_rows(const render::Plan& plan) {
  Json rows = Json::array();
  for (const render::PlanItem& item : plan.items) {
    Json row = {{"effect", item.effect},
                {"needed", item.needed},
                {"reason", item.reason},
                {"de00_p95", item.needed ? json_number(item.de00_p95) : Json(nullptr)},
                {"decision", spelled(item.decision)}};
    if (item.truth_de00_p95) row["truth_de00_p95"] = json_number(*item.truth_de00_p95);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace goniochrome::tool
