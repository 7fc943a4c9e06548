#include "tool.h"

#include <algorithm>
#include <map>
#include <set>

#include "at_pixel.h"
#include "base/text.h"
#include "formats/reference.h"
#include "paint/curve.h"
#include "source.h"
#include "stated.h"

namespace goniochrome::tool {

namespace {

paint::Variation variation_of(const std::string& word) {
  if (word == "face") return paint::Variation::kFace;
  if (word == "flop") return paint::Variation::kFlop;
  return word == "travel" ? paint::Variation::kTravel : paint::Variation::kGloss;
}

// Face, flop, travel, gloss and anisotropy as the report has them.
Json state_json(const std::optional<paint::Appearance>& appearance, const paint::Paint& paint) {
  Json json = Json::object();
  if (appearance) {
    json["face"] = lab_json(appearance->face);
    json["flop"] = lab_json(appearance->flop);
    json["travel_deg"] = appearance->travel_deg;
  }
  for (const paint::GlossReading& reading : paint.gloss)
    json[fmt::format("gloss_{}_deg", shortest(reading.angle_deg))] = reading.gloss_units;
  if (paint.anisotropy) json["anisotropy"] = {paint.anisotropy->alpha_x, paint.anisotropy->alpha_y};
  if (const auto& flakes = paint.flakes) json["flakes"] = {flakes->diameter_um, flakes->coverage, flakes->spread_deg};
  return json;
}

double de00_max(const paint::Appearance& before, const paint::Appearance& after) {
  double worst = 0;
  for (const double angle : {15.0, 45.0, 110.0})
    worst = std::max(worst, color::delta_e_2000(paint::lab_at(before, angle), paint::lab_at(after, angle)));
  return worst;
}

// One run, which makes moves on a stream of paints.
class Run {
 public:
  Run(const Options& options, paint::Edit edit, cli::Session& session)
      : options_(options),
        edit_(std::move(edit)),
        session_(session),
        wanted_(options.only.begin(), options.only.end()) {
    for (const std::string& name : wanted_) unmet_.emplace(name, formats::WantedName(name));
  }

  Result<cli::Verdict> operator()() {
    if (!options_.new_name.empty()) return make();
    GONIO_ASSIGN(PaintSource source, PaintSource::open(options_.inputs, session_));
    GONIO_ASSIGN(formats::PaintWriter opened, begin_paints(options_.output, source.prolog(), session_));
    writer_.emplace(std::move(opened));
    for (;;) {
      GONIO_ASSIGN(std::optional<paint::Paint> paint, source.next());
      if (!paint) break;
      ++read_;
      GONIO_TRY(take(std::move(*paint)));
    }
    GONIO_TRY(writer_->finish());
    return finish();
  }

 private:
  // A paint from nothing.
  Result<cli::Verdict> make() {
    GONIO_ASSIGN(const paint::Paint paint, stated_paint(options_, edit_));
    GONIO_ASSIGN(formats::PaintWriter opened, begin_paints(options_.output, {}, session_));
    writer_.emplace(std::move(opened));
    GONIO_TRY(change(paint));
    GONIO_TRY(writer_->finish());
    return finish();
  }

  Result<void> take(paint::Paint paint) {
    if (options_.gradient > 0) return lead_to(std::move(paint));
    unmet_.erase(paint.name);
    for (auto& [name, unmet] : unmet_) unmet.see(paint.name);
    if (!wanted_.empty() && !wanted_.contains(paint.name)) return write(paint);
    if (!options_.variations.empty()) return vary(paint);
    if (!options_.rename.empty() && changes_ > 0)
      return usage_error(
          "--rename is for one paint, and \"{}\" would be a second: choose one by --only, or give --suffix",
          paint.name);
    return change(paint);
  }

  Result<void> change(const paint::Paint& paint) {
    GONIO_ASSIGN(paint::Edited done, paint::edited(paint, edit_));
    if (!options_.rename.empty()) done.paint.name = options_.rename;
    done.paint.name += options_.suffix;
    if (!options_.code.empty() || options_.no_code) done.paint.code = options_.code;
    if (const auto stated = paint::paint_class_of(options_.paint_class)) done.paint.paint_class = *stated;
    tell(paint, done);
    return write(done.paint);
  }

  Result<void> vary(const paint::Paint& paint) {
    GONIO_TRY(write(paint));
    for (const paint::Neighbor& neighbor : paint::neighbors(variation_of(options_.variations), options_.step)) {
      GONIO_ASSIGN(paint::Edited done, paint::edited(paint, neighbor.edit));
      done.paint.name += "." + neighbor.name;
      if (done.skipped.empty() && !paint::is_distinct(done, paint))
        done.skipped.push_back(fmt::format(
            "{}: {}", done.paint.name,
            done.clipped.empty() ? "nothing changed" : joined(done.clipped, ", ") + ", the end of the scale"));
      tell(paint, done);
      // A neighbor beyond the domain would be a copy of the paint itself or of another neighbor.
      if (done.skipped.empty()) GONIO_TRY(write(done.paint));
    }
    return {};
  }

  // The paints between the one before and this one, then this one.
  Result<void> lead_to(paint::Paint paint) {
    for (int i = 1; last_ && i <= options_.gradient; ++i) {
      const double fraction = i / (options_.gradient + 1.0);
      GONIO_ASSIGN(paint::Paint step, paint::between(*last_, paint, fraction));
      step.name = fmt::format("{}-{}.{}", last_->name, paint.name, i);
      if (i == 1) tell_rows(*last_, paint);
      note({{"name", step.name},
            {"from", {last_->name, paint.name}},
            {"fraction", fraction},
            {"after", state_json(step.appearance, step)}});
      GONIO_TRY(write(step));
    }
    last_ = std::move(paint);
    return write(*last_);
  }

  Result<void> write(const paint::Paint& paint) {
    ++written_;
    if (written_ % 1000 == 0) session_.progress(fmt::format("{} paints", written_));
    return writer_->write(paint);
  }

  // Rows that only one end of a gradient has cannot be carried along it.
  void tell_rows(const paint::Paint& from, const paint::Paint& to) {
    const auto rows = [](const paint::Paint& paint) {
      return paint.measurement ? paint.measurement->rows : std::vector<paint::LabReading>();
    };
    const auto a = rows(from), b = rows(to);
    const auto common = std::ranges::count_if(a, [&](const paint::LabReading& row) {
      return std::ranges::any_of(b, [&](const paint::LabReading& other) { return other.geometry == row.geometry; });
    });
    if (static_cast<std::size_t>(common) < std::max(a.size(), b.size()))
      session_.warn(fmt::format("{} to {}: {} of {} and {} measured geometries are common to both and kept", from.name,
                                to.name, common, a.size(), b.size()));
  }

  void note(Json change) {
    ++changes_;
    session_.add("changes", [&] { return std::move(change); });
  }

  void tell(const paint::Paint& from, const paint::Edited& done) {
    for (const std::string& skipped : done.skipped) session_.warn(fmt::format("{}: left out: {}", from.name, skipped));
    for (const std::string& clipped : done.clipped)
      if (done.skipped.empty()) session_.warn(fmt::format("{}: clipped: {}", done.paint.name, clipped));
    skipped_ += !done.skipped.empty();
    for (const std::string& dropped : done.dropped) dropped_.insert(dropped);
    Json change = {{"name", done.paint.name},
                   {"before", state_json(done.before, from)},
                   {"after", state_json(done.after, done.paint)}};
    if (options_.new_name.empty()) change["from"] = from.name;
    if (done.before) change["de00_max"] = json_number(de00_max(*done.before, *done.after));
    if (done.fitted_de00) change["fitted_de00"] = json_number(*done.fitted_de00);
    if (done.restated_de00) change["restated_de00"] = json_number(*done.restated_de00);
    change["dropped"] = done.dropped;
    change["clipped"] = done.clipped;
    change["skipped"] = done.skipped;
    note(std::move(change));
  }

  cli::Verdict finish() {
    bool negative = skipped_ > 0;
    for (const auto& [name, unmet] : unmet_) {
      session_.warn(unmet.not_found());
      negative = true;
    }
    if (options_.gradient > 0 && read_ < 2) {
      session_.warn(fmt::format("{} paint was read: a gradient takes two or more", read_));
      negative = true;
    }
    if (read_ == 0 && options_.new_name.empty() && options_.gradient == 0) {
      session_.warn("the input holds no paints: nothing was edited");
      negative = true;
    }
    Json& results = session_.results();
    results["read"] = read_;
    results["written"] = written_;
    if (!results.contains("changes")) results["changes"] = Json::array();
    const std::string stale = dropped_.empty() ? ""
                                               : fmt::format("; dropped because they no longer hold: {}",
                                                             joined({dropped_.begin(), dropped_.end()}, ", "));
    session_.say(fmt::format(
        "paints: {} read, {} {}, {} written{}", read_, changes_,
        options_.variations.empty() && options_.gradient == 0 && options_.new_name.empty() ? "edited" : "made",
        written_, stale));
    return negative ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

  const Options& options_;
  const paint::Edit edit_;
  cli::Session& session_;
  const std::set<std::string> wanted_;
  std::optional<formats::PaintWriter> writer_;
  std::optional<paint::Paint> last_;
  std::map<std::string, formats::WantedName> unmet_;  // of those that are wanted
  std::set<std::string> dropped_;
  std::size_t read_ = 0, written_ = 0, changes_ = 0, skipped_ = 0;
};

std::string plan_text(const Options& options, const paint::Edit& edit) {
  std::string text;
  const auto line = [&](const std::string& sentence) { text += sentence + "\n"; };
  if (options.gradient > 0)
    line(fmt::format("between each paint and the next: {} new ones, equally spaced in Lab", options.gradient));
  if (!options.variations.empty())
    line(
        fmt::format("each paint and its eight neighbors in {}, {} a step", options.variations, shortest(options.step)));
  if (paint::moves_color(edit)) {
    line("color: rows and appearance move together; the appearance is fitted where a paint has only rows");
    line("       (the costly part: the fit scans the whole domain of the travel)");
    line("dropped: lobes and color maps, which hold the old color; run fit-paint afterwards");
  }
  if (edit.at_deg && edit.share == paint::Share::kSource)
    line(fmt::format("at {} deg: face and flop move by R and 1 - R, R = (travel - {}) / (travel - 15) within 0 and 1",
                     shortest(*edit.at_deg), shortest(*edit.at_deg)));
  if (edit.at_deg && edit.share == paint::Share::kExact)
    line(fmt::format("at {} deg: the color changes by the shifts; face and flop move as little as that needs",
                     shortest(*edit.at_deg)));
  if (paint::states_appearance(edit))
    line(edit.keep_residual ? "rows: keep what the curve did not explain of them"
                            : "rows: stated anew from the curve (--keep-residual keeps what it did not explain)");
  if (!edit.readings.empty())
    line(fmt::format("readings: {} set{}", edit.readings.size(),
                     paint::states_appearance(edit) ? "" : "; face, flop and travel are fitted to all rows"));
  if (paint::moves_gloss(edit))
    line(fmt::format("gloss: the reading at {} deg is moved, readings at other angles and the lobes are dropped",
                     options.gloss_angle_deg));
  if (!options.only.empty()) line(fmt::format("left as they are: all paints but {}", joined(options.only, ", ")));
  return text;
}

}  // namespace

Result<cli::Verdict> run(const Options& stated, cli::Session& session) {
  GONIO_ASSIGN(const PlacedOptions place, placed(stated));
  const Options& options = place.options;
  GONIO_ASSIGN(const paint::Edit edit, edit_of(options));
  if (!place.drawn_by_rays.empty())
    session.say(
        fmt::format("{} shows {}: the edit is made at the angle of the pixel, in light that nothing blocks; "
                    "with --aov transport the angle is that of the light there",
                    stated.image, place.drawn_by_rays));
  for (const SeenPixel& pixel : place.pixels) {
    session.results()["pixels"].push_back({{"option", pixel.option},
                                           {"x", pixel.x},
                                           {"y", pixel.y},
                                           {"aspecular_deg", pixel.aspecular_deg},
                                           {"traced", pixel.traced}});
    session.say(pixel.traced ? fmt::format("{} {},{} gets light as from one lamp {:.1f} deg from specular",
                                           pixel.option, pixel.x, pixel.y, pixel.aspecular_deg)
                             : fmt::format("{} {},{} is {:.1f} deg from specular", pixel.option, pixel.x, pixel.y,
                                           pixel.aspecular_deg));
  }
  session.explain(plan_text(options, edit));
  return Run(options, edit, session)();
}

}  // namespace goniochrome::tool
