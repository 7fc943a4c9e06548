#include "tool.h"

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "curve.h"
#include "paint/spectra.h"
#include "paint_stream.h"
#include "panels.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

constexpr double kTold_deg[] = {1, 2, 5};
constexpr int kNamesShown = 20;

struct GeometryRow {
  std::size_t geometry = 0;    // of the request
  std::size_t illuminant = 0;  // of the request, where it names some
  panels::GeometryIndex index;
  double de[std::size(kTold_deg)];
};

// The index of one paint.
struct PaintIndex {
  std::string failure;  // why there is nothing else
  std::optional<double> residual_de00;
  std::vector<GeometryRow> rows;  // one for each geometry; all of one illuminant after the other
  std::size_t worst = 0;
  double smallest_deg = std::numeric_limits<double>::infinity();
};

// Adds the rows of a paint in one light. Returns why there are none, or "".
std::string add_rows(const paint::Paint& paint, std::size_t illuminant, const IndexRequest& request,
                     PaintIndex& result) {
  const auto curve = panels::FlakeCurve::make(paint, request.target);
  if (!curve.ok()) return curve.error().message;
  if (curve->residual_de00())
    result.residual_de00 = std::max(result.residual_de00.value_or(0), *curve->residual_de00());
  for (std::size_t i = 0; i < request.pairs.size(); ++i) {
    const panels::TiltedPair& pair = request.pairs[i];
    GeometryRow row{i, illuminant, panels::geometry_index(*curve, pair, request.threshold, request.metric), {}};
    for (std::size_t k = 0; k < std::size(kTold_deg); ++k)
      row.de[k] = panels::larger_difference(*curve, pair, kTold_deg[k], request.metric);
    if (row.index.smallest_deg() < result.smallest_deg)
      result.smallest_deg = row.index.smallest_deg(), result.worst = result.rows.size();
    result.rows.push_back(row);
  }
  return "";
}

PaintIndex paint_index(const paint::Paint& paint, const IndexRequest& request) {
  PaintIndex result;
  if (request.illuminants.empty()) result.failure = add_rows(paint, 0, request, result);
  for (std::size_t i = 0; i < request.illuminants.size() && result.failure.empty(); ++i) {
    const auto lit = paint::in_light(paint, {request.illuminants[i], paint::condition_of(paint).observer_deg});
    result.failure = lit.ok() ? add_rows(*lit, i, request, result)
                              : fmt::format("paint \"{}\": {}", paint.name, lit.error().message);
  }
  return result;
}

std::string angle_text(const std::optional<double>& angle) {
  return angle ? fmt::format("{:.9g}", *angle) : "none";
}

std::string verdict_of(const PaintIndex& index, double tolerance_deg) {
  return index.smallest_deg > tolerance_deg ? "pass" : "fail";
}

std::string table_rows(const paint::Paint& paint, const PaintIndex& index, const IndexRequest& request) {
  std::string text;
  const std::size_t first = request.one_row ? index.worst : 0;
  const std::size_t last = request.one_row ? first + 1 : index.rows.size();
  for (std::size_t i = first; i < last; ++i) {
    const GeometryRow& row = index.rows[i];
    const panels::LightView& g = request.geometries[row.geometry];
    fmt::format_to(std::back_inserter(text), "{}\t{}\t{}\t{}\t{:.9g}\t{}\t{}", table_field(paint.name), g.light_deg,
                   g.view_deg, g.azimuth_deg, request.pairs[row.geometry].at(0).aspecular_deg,
                   angle_text(row.index.plus_deg), angle_text(row.index.minus_deg));
    for (const double de : row.de) text += std::isnan(de) ? "\t-" : fmt::format("\t{:.6g}", de);
    if (request.tolerance_deg) text += "\t" + verdict_of(index, *request.tolerance_deg);
    if (!request.illuminants.empty()) text += "\t" + request.illuminants[row.illuminant];
    text += '\n';
  }
  return text;
}

std::string table_head(const IndexRequest& request) {
  return fmt::format(
      "name\tlight_deg\tview_deg\tazimuth_deg\taspecular_deg\tindex_plus_deg\tindex_minus_deg\tde_at_1deg\tde_at_2deg\t"
      "de_at_5deg{}{}\n",
      request.tolerance_deg ? "\tverdict" : "", request.illuminants.empty() ? "" : "\tilluminant");
}

Json paint_json(const paint::Paint& paint, const PaintIndex& index, const IndexRequest& request) {
  Json geometries = Json::array();
  const auto angle = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  for (std::size_t i = 0; i < index.rows.size(); ++i) {
    const GeometryRow& row = index.rows[i];
    const panels::LightView& g = request.geometries[row.geometry];
    geometries.push_back({{"light_deg", g.light_deg},
                          {"view_deg", g.view_deg},
                          {"azimuth_deg", g.azimuth_deg},
                          {"aspecular_deg", request.pairs[row.geometry].at(0).aspecular_deg},
                          {"index_plus_deg", angle(row.index.plus_deg)},
                          {"index_minus_deg", angle(row.index.minus_deg)},
                          {"de_at_1deg", json_number(row.de[0])},
                          {"de_at_2deg", json_number(row.de[1])},
                          {"de_at_5deg", json_number(row.de[2])}});
    if (!request.illuminants.empty()) geometries.back()["illuminant"] = request.illuminants[row.illuminant];
  }
  return {{"name", paint.name},
          {"status", "done"},
          {"residual_de00", index.residual_de00 ? Json(*index.residual_de00) : Json(nullptr)},
          {"worst_deg", json_number(index.smallest_deg)},
          {"geometries", std::move(geometries)}};
}

std::string plan(const Options& options, const IndexRequest& request) {
  std::string text = fmt::format(
      "{} pairs of light and viewer; left out: {} within {} deg of the mirror direction (gloss is no mismatch), {} "
      "below the horizon\n"
      "difference {} to {}, first crossing for + and -; about 5 us a pair and paint\n"
      "seam at {} deg from the plane of incidence\n",
      request.pairs.size(), request.in_glare.size(), panels::kIndexGlare_deg, request.below_horizon, options.metric,
      shortest(request.threshold), shortest(options.seam_deg));
  if (!request.illuminants.empty())
    text += fmt::format("colors from spectra, under {} each\n", joined(request.illuminants, ", "));
  text +=
      request.target == paint::TargetCurve::Kind::kCurve
          ? "color: face, flop and travel; a fit of some 20 us where a paint has only rows, residual in the report\n"
          : "color: a monotone curve through the rows, constant beyond the last; the highlight goes on below the first "
            "as in fit-paint\n";
  return text;
}

class Run {
 public:
  Run(const Options& options, const IndexRequest& request, cli::Session& session)
      : options_(options), request_(request), session_(session) {}

  Result<cli::Verdict> operator()() {
    GONIO_ASSIGN(formats::PaintBatches paints, formats::PaintBatches::open(options_.inputs, options_.only));
    GONIO_ASSIGN(OutputFile file, OutputFile::create(options_.output));
    GONIO_TRY(file.write(table_head(request_)));
    session_.begin_list("paints");
    GONIO_TRY(
        for_each_batch(paints, session_, [&](const std::vector<paint::Paint>& batch) { return take(batch, file); }));
    GONIO_TRY(file.commit());
    return finish();
  }

 private:
  Result<void> take(const std::vector<paint::Paint>& batch, OutputFile& file) {
    std::vector<PaintIndex> indices(batch.size());
    std::vector<std::string> rows(batch.size());
    parallel_for(batch.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        indices[i] = paint_index(batch[i], request_);
        if (indices[i].failure.empty()) rows[i] = table_rows(batch[i], indices[i], request_);
      }
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      GONIO_TRY(file.write(rows[i]));
      GONIO_TRY(note(batch[i], indices[i]));
    }
    return file.flush();
  }

  Result<void> note(const paint::Paint& paint, const PaintIndex& index) {
    if (!index.failure.empty()) {
      if (++failed_ <= kNamesShown) session_.warn(fmt::format("left out: {}", index.failure));
      session_.add("paints", [&] {
        return Json{{"name", paint.name}, {"status", "failed"}, {"message", index.failure}};
      });
      return {};
    }
    ++done_;
    if (index.smallest_deg < smallest_deg_ || done_ == 1) {
      smallest_deg_ = index.smallest_deg;
      const GeometryRow& row = index.rows[index.worst];
      const panels::LightView& g = request_.geometries[row.geometry];
      worst_ = fmt::format("{} at light {}, view {}{}", paint.name, shortest(g.light_deg), shortest(g.view_deg),
                           request_.illuminants.empty() ? "" : ", " + request_.illuminants[row.illuminant]);
    }
    if (request_.tolerance_deg && verdict_of(index, *request_.tolerance_deg) == "fail") failing_.push_back(paint.name);
    session_.add("paints", [&] { return paint_json(paint, index, request_); });
    return options_.curves.empty() ? Result<void>() : write_curves(paint);
  }

  Result<void> write_curves(const paint::Paint& paint) {
    GONIO_TRY(check_only_paint(static_cast<int>(done_), "--curve draws", paint.name));
    GONIO_ASSIGN(const panels::FlakeCurve curve, panels::FlakeCurve::make(paint, request_.target));
    GONIO_ASSIGN(const std::vector<double> lights, panels::light_angles(options_.geometries.lights));
    const DifferenceCurves what{paint.name, options_.seam_deg,         request_.threshold, request_.metric,
                                lights,     options_.misalignments_deg};
    for (const std::string& path : options_.curves)
      GONIO_TRY(write_file(path, path.ends_with(".svg") ? svg(what, curve) : csv(what, curve)));
    return {};
  }

  Result<cli::Verdict> finish() {
    if (failed_ > kNamesShown) session_.warn(fmt::format("{} more left out", failed_ - kNamesShown));
    session_.results()["worst_deg"] = json_number(smallest_deg_);
    std::string line = fmt::format("{} paint{}, {} geometries: ", done_, done_ == 1 ? "" : "s", request_.pairs.size());
    if (std::isfinite(smallest_deg_)) {
      line += fmt::format("smallest index {:.3g} deg ({})", smallest_deg_, worst_);
    } else {
      line += "the threshold is reached nowhere";
    }
    if (request_.tolerance_deg) {
      session_.results()["failing"] = failing_;
      line += fmt::format("; {} stay under {} up to {} deg, {} do not", done_ - failing_.size(),
                          shortest(request_.threshold), shortest(*request_.tolerance_deg), failing_.size());
    }
    failing_.empty() ? session_.say(line) : session_.say_verdict(line);
    for (const std::string& name : failing_) session_.say_verdict("  " + name);
    if (done_ + failed_ == 0) session_.warn("the input holds no paints: nothing was computed");
    return failing_.empty() && failed_ == 0 && done_ > 0 ? cli::Verdict::kDone : cli::Verdict::kNegative;
  }

  const Options& options_;
  const IndexRequest& request_;
  cli::Session& session_;
  std::vector<std::string> failing_;
  std::size_t done_ = 0, failed_ = 0;
  double smallest_deg_ = std::numeric_limits<double>::infinity();
  std::string worst_;
};

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (!options.seam.mesh.empty()) return run_on_seam(options, session);
  GONIO_ASSIGN(const IndexRequest request, request_of(options));
  session.explain(plan(options, request));
  tell_left_out(request.in_glare, request.below_horizon, session);
  return Run(options, request, session)();
}

}  // namespace goniochrome::tool
