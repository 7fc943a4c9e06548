#include "tool.h"

#include <algorithm>
#include <cmath>

#include "advice.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "brdf/gloss.h"
#include "mesh/unit.h"
#include "paint_stream.h"
#include "panels.h"
#include "seam_picture.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

struct Spread {
  double low = 0, median = 0, high = 0;
};
Spread spread(const mesh::Seam& seam, double mesh::SeamPoint::*value) {
  std::vector<double> values;
  for (const mesh::SeamPoint& p : seam.points) values.push_back(p.*value);
  std::ranges::sort(values);
  return {values.front(), values[values.size() / 2], values.back()};
}
Json spread_json(const Spread& s) {
  return {{"low", s.low}, {"median", s.median}, {"high", s.high}};
}

std::string seam_line(const SeamRequest& request, const mesh::Seam& seam) {
  const Spread fold = spread(seam, &mesh::SeamPoint::fold_deg), gap = spread(seam, &mesh::SeamPoint::gap_mm),
               flush = spread(seam, &mesh::SeamPoint::flush_mm);
  std::string line = fmt::format(
      "seam {} | {}: {:.2f} m, misalignment {:+.1f} to {:+.1f} deg (median {:+.1f}), gap {:.1f} mm ({:.1f} to {:.1f}), "
      "flush {:+.1f} to {:+.1f} mm",
      request.world.part_a, request.world.part_b, seam.length_m, fold.low, fold.high, fold.median, gap.median, gap.low,
      gap.high, flush.low, flush.high);
  if (seam.unit_guessed && seam.unit_m != 1)
    line += fmt::format("; taken as {} (--unit says otherwise)", mesh::unit_of(seam.unit_m).name);
  return line;
}

void tell_repairs(const mesh::Seam& seam, const mesh::Mesh& mesh, cli::Session& session) {
  const auto tell = [&](int count, const char* what) {
    if (count > 0) session.say(fmt::format("  {} {}", count, what));
  };
  tell(seam.repairs.duplicate_faces, "duplicate faces were left out");
  tell(seam.repairs.non_manifold_edges, "edges of more than two faces were taken as ends of a panel");
  tell(seam.repairs.turned, "edges had inward normals, which were turned");
  tell(seam.not_continued, "places stand at more than 30 deg and were left out");
  tell(mesh.repairs.degenerate_dropped, "faces without area were left out");
  tell(mesh.repairs.triangles_turned, "faces were wound against their normals and turned");
}

class SeamRun {
 public:
  SeamRun(const Options& options, const SeamRequest& request, cli::Session& session)
      : options_(options), request_(request), session_(session) {}

  Result<cli::Verdict> operator()() {
    GONIO_TRY(prepare());
    GONIO_ASSIGN(formats::PaintBatches paints, formats::PaintBatches::open(options_.inputs, options_.only));
    GONIO_ASSIGN(OutputFile file, OutputFile::create(options_.output));
    GONIO_TRY(
        file.write("name\trun\tdistance_m\tx\ty\tz\tgap_mm\tflush_mm\tangle_deg\tfold_deg\tde_max\tde_rms\tviews\n"));
    const auto take_all = [&](const std::vector<paint::Paint>& batch) -> Result<void> {
      for (const paint::Paint& paint : batch) GONIO_TRY(take(paint, file));
      return {};
    };
    GONIO_TRY(for_each_batch(paints, session_, take_all));
    GONIO_TRY(file.commit());
    return failed_ > 0 ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

 private:
  Result<void> prepare() {
    GONIO_ASSIGN(stage_, panels::seam_stage(options_.seam, request_.world, request_.geometries, options_.seam_deg));
    tell_remarks(stage_.mesh, session_);
    traced_ = traced_seam(options_.seam, stage_, session_);
    const mesh::Seam& seam = stage_.seam;
    session_.say(seam_line(request_, seam));
    tell_repairs(seam, stage_.mesh, session_);
    Json& results = session_.results();
    results["seam_length_m"] = seam.length_m;
    results["unit_m"] = seam.unit_m;
    results["misalignment_deg"] = spread_json(spread(seam, &mesh::SeamPoint::fold_deg));
    results["gap_mm"] = spread_json(spread(seam, &mesh::SeamPoint::gap_mm));
    results["flush_mm"] = spread_json(spread(seam, &mesh::SeamPoint::flush_mm));
    results["repairs"] = {{"duplicate_faces", seam.repairs.duplicate_faces},
                          {"non_manifold_edges", seam.repairs.non_manifold_edges},
                          {"turned", seam.repairs.turned},
                          {"not_continued", seam.not_continued}};
    results["paints"] = Json::array();
    return {};
  }

  // The difference of the panels for every view.
  Result<std::vector<double>> differences(const paint::Paint& paint) {
    std::vector<double> de(stage_.views.size());
    if (!options_.seam.environment.empty()) {
      GONIO_ASSIGN(const paint::Appearance appearance, panels::appearance_of(paint));
      GONIO_ASSIGN(const double coat, brdf::coat_index_of_paint(paint));
      GONIO_ASSIGN(const panels::EnvironmentPanels panels,
                   panels::EnvironmentPanels::make(stage_.env, paint::condition_of(paint), coat));
      GONIO_ASSIGN(const paint::LobeFit fit, panels.lobes(appearance));
      GONIO_ASSIGN(const panels::SeamLights lights,
                   panels::seam_lights(panels, traced_ ? &*traced_ : nullptr, fit, stage_.seam, stage_.views,
                                       request_.world.part_a, request_.world.part_b));
      tell_traced(lights, stage_.views.size(), paint.name, session_);
      GONIO_ASSIGN(const auto a, panels::seam_colors(panels, lights.a)(appearance));
      GONIO_ASSIGN(const auto b, panels::seam_colors(panels, lights.b)(appearance));
      for (std::size_t i = 0; i < de.size(); ++i) de[i] = panels::difference(request_.metric, a[i], b[i]);
      return de;
    }
    GONIO_ASSIGN(const panels::FlakeCurve curve, panels::FlakeCurve::make(paint, request_.target));
    parallel_for(de.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const panels::PanelView view = panels::panel_view(stage_.seam, stage_.views[i]).under_coat(curve.coat_index());
        de[i] = panels::difference(request_.metric, panels::panel_color(curve.at(view.aspecular_a_deg), view.cos_a),
                                   panels::panel_color(curve.at(view.aspecular_b_deg), view.cos_b));
      }
    });
    return de;
  }

  Result<void> take(const paint::Paint& paint, OutputFile& file) {
    const auto de = differences(paint);
    if (!de.ok()) {
      session_.warn(fmt::format("left out: {}: {}", paint.name, de.error().message));
      ++failed_;
      return {};
    }
    const std::vector<panels::SeamDifference> places = panels::by_place(stage_.seam, stage_.views, *de);
    GONIO_TRY(write_rows(paint, places, file));
    report(paint, places);
    if (options_.advise)
      for (const std::string& line : advice(paint, request_, stage_.seam, stage_.views, *de)) {
        session_.say(line);
        session_.results()["paints"].back()["advice"].push_back(line);
      }
    if (options_.picture.empty()) return {};
    const SeamPicture picture{fmt::format("{}: {} | {}", paint.name, request_.world.part_a, request_.world.part_b),
                              request_.threshold, places};
    GONIO_ASSIGN(const image::Image image, seam_picture(stage_.mesh, request_, stage_.seam, picture));
    return pictures_.write(paint, image, session_);
  }

  Result<void> write_rows(const paint::Paint& paint, const std::vector<panels::SeamDifference>& places,
                          OutputFile& file) {
    std::size_t first = 0, last = places.size();
    if (options_.worst) {
      // A comparison with NaN is false, so that a place without views is never the worst.
      for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].views > 0 && (places[first].views == 0 || places[i].max > places[first].max)) first = i;
      last = first + 1;
    }
    std::string text;
    for (std::size_t i = first; i < last; ++i) {
      const mesh::SeamPoint& p = stage_.seam.points[i];
      fmt::format_to(std::back_inserter(text),
                     "{}\t{}\t{:.6g}\t{:.6g}\t{:.6g}\t{:.6g}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t",
                     table_field(paint.name), p.run, p.distance_m, p.a.x, p.a.y, p.a.z, p.gap_mm, p.flush_mm,
                     p.angle_deg, p.fold_deg);
      text += places[i].views > 0 ? fmt::format("{:.6g}\t{:.6g}\t{}\n", places[i].max, places[i].rms, places[i].views)
                                  : "-\t-\t0\n";
    }
    return file.write(text);
  }

  void report(const paint::Paint& paint, const std::vector<panels::SeamDifference>& places) {
    double most = 0, squares = 0;
    std::size_t seen = 0, over = 0;
    Json rows = Json::array();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const mesh::SeamPoint& p = stage_.seam.points[i];
      rows.push_back({{"run", p.run},
                      {"distance_m", p.distance_m},
                      {"x", p.a.x},
                      {"y", p.a.y},
                      {"z", p.a.z},
                      {"gap_mm", p.gap_mm},
                      {"flush_mm", p.flush_mm},
                      {"angle_deg", p.angle_deg},
                      {"fold_deg", p.fold_deg},
                      {"de_max", json_number(places[i].max)},
                      {"de_rms", json_number(places[i].rms)}});
      if (places[i].views == 0) continue;
      ++seen, over += places[i].max >= request_.threshold;
      most = std::max(most, places[i].max);
      squares += places[i].rms * places[i].rms;
    }
    const double rms = std::sqrt(squares / static_cast<double>(seen));
    session_.results()["paints"].push_back({{"name", paint.name},
                                            {"de_max", most},
                                            {"de_rms", json_number(rms)},
                                            {"over_threshold", static_cast<double>(over) / static_cast<double>(seen)},
                                            {"seam", std::move(rows)}});
    session_.say(fmt::format("{}: dE max {:.2f}, rms {:.2f}; {:.0f} % of the seam reach {}", paint.name, most, rms,
                             100.0 * static_cast<double>(over) / static_cast<double>(seen),
                             shortest(request_.threshold)));
  }

  const Options& options_;
  const SeamRequest& request_;
  cli::Session& session_;
  panels::SeamStage stage_;
  std::optional<panels::TracedSeam> traced_;  // in an environment with a mirror part
  int failed_ = 0;
  PaintPictures pictures_{options_.picture, "--picture draws"};
};

std::string plan(const Options& options, const SeamRequest& request) {
  return fmt::format("seam of {} and {} in {}: places a thousandth of the mesh's size apart\n{}", request.world.part_a,
                     request.world.part_b, options.seam.mesh,
                     panels::seam_light_text(options.seam, request.world, request.geometries));
}

}  // namespace

Result<cli::Verdict> run_on_seam(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(const SeamRequest request, seam_request_of(options));
  session.explain(plan(options, request));
  return SeamRun(options, request, session)();
}

}  // namespace goniochrome::tool
