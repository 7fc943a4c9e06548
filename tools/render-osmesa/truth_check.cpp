#include "truth_check.h"
#include "render/picture_error.h"

#include <fmt/format.h>

#include <cmath>

namespace goniochrome::tool {

std::string told_p95(const render::PictureError& error) {
  const auto [low, high] = error.p95_range;
  return fmt::format("{:.2f} ({:.2f} {})", error.de00_p95, low,
                     std::isfinite(high) ? fmt::format("to {:.2f}", high) : "or more");
}

Json error_json(const render::PictureError& error, const std::string& against, const std::string& source) {
  return {{"against", against},
          {"de00_mean", json_number(error.de00_mean)},
          {"de00_p95", json_number(error.de00_p95)},
          {"de00_p95_low", json_number(error.p95_range.low)},
          {"de00_p95_high", json_number(error.p95_range.high)},
          {"de00_max", json_number(error.de00_max)},
          {"checked_pixels", error.checked_pixels},
          {"worst_x", error.worst_x},
          {"worst_y", error.worst_y},
          {"time_s", error.time_s},
          {"source", source}};
}

cli::Verdict tell_verdict(const render::PictureError& error, double tolerance, cli::Session& session) {
  const bool negative = error.de00_p95 > tolerance;
  const auto checked = static_cast<std::size_t>(error.checked_pixels);
  constexpr std::size_t kMore = 4;  // times as many pixels halve the range
  if (checked < error.visible_pixels && error.p95_range.low <= tolerance && error.p95_range.high > tolerance)
    session.say(fmt::format("{} pixels leave it open whether p95 is within --tolerance {:g}: --check {} narrows it",
                            checked, tolerance, std::min(kMore * checked, error.visible_pixels)));
  if (negative)
    session.say_verdict(
        fmt::format("the picture is farther from the reference than --tolerance {:g} allows", tolerance));
  return negative ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

cli::Verdict tell_truth(const render::TruthError& error, const std::string& source, double tolerance,
                        cli::Session& session) {
  const render::PictureError& total = error.total;
  const render::TruthShares& shares = error.shares;
  Json json = error_json(total, "truth", source);
  json.update({{"standard_error", json_number(error.standard_error)},
               {"fit", json_number(shares.fit)},
               {"prefilter", json_number(shares.prefilter)},
               {"occlusion", json_number(shares.occlusion)},
               {"bounce", json_number(shares.bounce)},
               {"noise", json_number(shares.noise)},
               {"worth",
                {{"shadow", json_number(error.worth.shadow)},
                 {"self", json_number(error.worth.self)},
                 {"bounce", json_number(error.worth.bounce)},
                 {"floor", json_number(error.worth.floor)}}}});
  session.results()["error"] = std::move(json);
  session.say(fmt::format(
      "dE00 to path traced truth: mean {:.2f}, p95 {}, max {:.2f} at {},{} ({} pixels, {:.1f} s); the truth has noise "
      "{:.2f}",
      total.de00_mean, told_p95(total), total.de00_max, total.worst_x, total.worst_y, total.checked_pixels,
      total.time_s, error.standard_error));
  session.say(
      fmt::format("of which alone: prefiltering and look-up {:.2f}, occlusion {:.2f}, bounced light {:.2f}, noise "
                  "{:.2f}; beside it the fit of the paints to their readings {:.2f}",
                  shares.prefilter, shares.occlusion, shares.bounce, shares.noise, shares.fit));
  if (!error.sharp)
    session.warn(
        fmt::format("the truth is known to {:.2f} dE00 only, which is more than a tenth of the difference and a "
                    "twentieth of --tolerance",
                    error.standard_error));
  return tell_verdict(total, tolerance, session);
}

}  // namespace goniochrome::tool
