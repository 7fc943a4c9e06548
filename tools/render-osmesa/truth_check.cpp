#include "truth_check.h"
#include "render/picture_error.h"

#include <fmt/format.h>

namespace goniochrome::tool {

void tell_truth(const render::TruthError& error, const std::string& source, double tolerance, cli::Session& session) {
  const render::PictureError& total = error.total;
  const render::TruthShares& shares = error.shares;
  session.results()["error"] = {{"against", "truth"},
                                {"de00_mean", json_number(total.de00_mean)},
                                {"de00_p95", json_number(total.de00_p95)},
                                {"de00_max", json_number(total.de00_max)},
                                {"standard_error", json_number(error.standard_error)},
                                {"fit", json_number(shares.fit)},
                                {"prefilter", json_number(shares.prefilter)},
                                {"occlusion", json_number(shares.occlusion)},
                                {"bounce", json_number(shares.bounce)},
                                {"noise", json_number(shares.noise)},
                                {"worth",
                                 {{"shadow", json_number(error.worth.shadow)},
                                  {"self", json_number(error.worth.self)},
                                  {"bounce", json_number(error.worth.bounce)},
                                  {"floor", json_number(error.worth.floor)}}},
                                {"checked_pixels", total.checked_pixels},
                                {"worst_x", total.worst_x},
                                {"worst_y", total.worst_y},
                                {"time_s", total.time_s},
                                {"source", source}};
  session.say(
      fmt::format("dE00 to path traced truth: mean {:.2f}, p95 {:.2f} +- {:.2f}, max {:.2f} at {},{} ({} pixels, "
                  "{:.1f} s)",
                  total.de00_mean, total.de00_p95, error.standard_error, total.de00_max, total.worst_x, total.worst_y,
                  total.checked_pixels, total.time_s));
  session.say(
      fmt::format("of which alone: prefiltering and look-up {:.2f}, occlusion {:.2f}, bounced light {:.2f}, noise "
                  "{:.2f}; beside it the fit of the paints to their readings {:.2f}",
                  shares.prefilter, shares.occlusion, shares.bounce, shares.noise, shares.fit));
  if (!error.sharp)
    session.warn(
        fmt::format("the truth is known to {:.2f} dE00 only, which is more than a tenth of the difference and a "
                    "twentieth of --tolerance",
                    error.standard_error));
  if (total.de00_p95 > tolerance)
    session.say(fmt::format("the picture is farther from the truth than --tolerance {:g} allows", tolerance));
}

}  // namespace goniochrome::tool
