#include "score.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "base/angles.h"
#include "base/encoding.h"
#include "base/file.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "brdf/measured.h"
#include "formats/csv.h"
#include "formulas.h"
#include "image/surface_file.h"
#include "math/statistics.h"
#include "paint/curve.h"
#include "paint_stream.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

constexpr double kGlare_deg = 10, kGrazing_deg = 75;

// One measured color.
struct Row {
  Vec3 light, view;
  color::Lab lab;
};
struct Rows {
  std::vector<Row> kept;
  int left_out = 0;  // glare and grazing directions
  color::Xyz white;

  void add(const Row& row) {
    const double lowest = std::cos(kGrazing_deg * kDegree) - 1e-9;
    const bool glare = paint::aspecular_angle_rad(row.light, row.view, {0, 0, 1}) < kGlare_deg * kDegree;
    if (glare || row.light.z < lowest || row.view.z < lowest) {
      ++left_out;
    } else {
      kept.push_back(row);
    }
  }
};

// The directions of --score: those of one measured BRDF, or readings by the names of paints.
class Table {
 public:
  static Result<Table> read(const std::string& path, cli::Session& session) {
    Table table;
    table.path_ = path;
    GONIO_ASSIGN(InputFile file, InputFile::open(path));
    GONIO_ASSIGN(const std::string_view head, file.peek());
    if (brdf::looks_measured(path, head)) {
      GONIO_ASSIGN(table.brdf_, brdf::read_measured(path));
    } else {
      GONIO_ASSIGN(const std::vector<paint::Paint> paints, all_paints(path, session));
      for (const paint::Paint& paint : paints) table.note(paint);
    }
    if (!table.brdf_ && table.readings_.empty()) return input_error("{}: has no readings to compare with", path);
    return table;
  }

  // The measurement of a paint, as Lab under the condition of the paint; nothing where the table has no such paint.
  Result<std::optional<Rows>> of(const paint::Paint& paint) const {
    const color::ViewingCondition condition = paint::condition_of(paint);
    Rows rows;
    if (brdf_) {
      const auto meter = brdf::ChannelColorimeter::make(brdf_->traits(), condition);
      if (!meter.ok()) return input_error("{}: {}", path_, meter.error().message);
      rows.white = meter->white();
      for (const paint::DirectionPair& pair : brdf_->samples()) {
        brdf::MeasuredValue value = brdf_->value(pair.light, pair.view);
        for (double& f : value.f) f *= kPi;
        brdf::take_off_noise(brdf_->traits(), value.f);
        rows.add({pair.light, pair.view, color::lab_from_xyz(meter->xyz(value.f), rows.white)});
      }
      return std::optional(std::move(rows));
    }
    const auto found = readings_.find(paint.name);
    if (found == readings_.end()) return std::optional<Rows>();
    if (found->second.condition != condition)
      return input_error("{}: \"{}\" was measured under {}/{}, and the paint is told under {}/{}", path_, paint.name,
                         found->second.condition.illuminant, found->second.condition.observer_deg, condition.illuminant,
                         condition.observer_deg);
    GONIO_ASSIGN(rows.white, color::white_point(condition));
    for (const paint::LabReading& reading : found->second.rows) {
      const paint::DirectionPair pair = paint::directions(reading.geometry);
      rows.add({pair.light, pair.view, reading.lab});
    }
    return std::optional(std::move(rows));
  }

  // True if a measured BRDF is meant for this paint: where a paint has the name of its file, for no other.
  bool is_of_one_paint() const { return brdf_ != nullptr; }
  std::vector<std::string> doubts() const { return brdf_ ? brdf::checks(*brdf_).warnings : std::vector<std::string>(); }
  std::string stem() const { return std::filesystem::path(path_).stem().string(); }

 private:
  void note(const paint::Paint& paint) {
    if (paint.measurement) readings_[paint.name] = *paint.measurement;
  }
  std::string path_;
  std::unique_ptr<brdf::MeasuredBrdf> brdf_;
  std::map<std::string, paint::Measurement> readings_;
};

// The differences of one model.
struct Score {
  std::string model;
  std::vector<double> de76, by_formula;
};

// The differences of all models of a paint by a formula.
struct Scores {
  color::DifferenceFormula formula;
  std::vector<Score> list;
};

// `predicted` gives Lab at the directions of a row, or nothing where the model says nothing.
template <class Predicted>
void add_score(const std::string& model, const Rows& rows, Predicted&& predicted, Scores& scores) {
  Score score{model, {}, {}};
  for (const Row& row : rows.kept) {
    const std::optional<color::Lab> lab = predicted(row);
    if (!lab) continue;
    score.de76.push_back(color::delta_e_76(*lab, row.lab));
    const double aspecular_deg = paint::aspecular_angle_rad(row.light, row.view, {0, 0, 1}) / kDegree;
    score.by_formula.push_back(color::difference(scores.formula, row.lab, *lab, aspecular_deg));
  }
  if (!score.de76.empty()) scores.list.push_back(std::move(score));
}

bool is_beyond_critical(const Row& row, double index) {
  const brdf::FlakeAngles angles = brdf::flake_angles(row.light, row.view, index);
  return angles.flake_rad + angles.incidence_rad > std::asin(1 / index);
}

// Every model that a paint has.
Result<Scores> scores_of(const paint::Paint& paint, const Rows& rows, const std::filesystem::path& folder,
                         const color::DifferenceFormula& formula) {
  Scores scores{formula, {}};
  const auto aspecular_deg = [](const Row& row) {
    return paint::aspecular_angle_rad(row.light, row.view, {0, 0, 1}) / kDegree;
  };
  if (paint.measurement || paint.appearance) {
    GONIO_ASSIGN(const auto curve, paint::TargetCurve::make(paint, paint::TargetCurve::Kind::kMeasured));
    add_score("curve", rows, [&](const Row& row) { return std::optional(curve.at(aspecular_deg(row))); }, scores);
  }
  if (paint.lobes) {
    add_score(
        "lobes", rows,
        [&](const Row& row) {
          const auto from_normal_deg = [](const Vec3& v) { return std::acos(std::min(v.z, 1.0)) / kDegree; };
          const double view_deg = from_normal_deg(row.view);
          const color::Rgb seen = brdf::flake_reflectance_factor(
              brdf::at_view(*paint.lobes, view_deg), aspecular_deg(row), from_normal_deg(row.light), view_deg);
          return std::optional(color::lab_from_rgb(seen, rows.white));
        },
        scores);
  }
  if (paint.color_map) {
    GONIO_ASSIGN(brdf::ColorMap map, image::read_color_map((folder / paint.color_map->href).string()));
    map.index = paint.color_map->index;
    const auto at = [&](const Row& row) {
      return color::lab_from_rgb(brdf::reflectance_factor(map, row.light, row.view, brdf::CriticalAngle::kSlide),
                                 rows.white);
    };
    const std::string name = map.aspecular ? "aspecular map" : "isoline map";
    add_score(name, rows, [&](const Row& row) { return std::optional(at(row)); }, scores);
    if (!map.aspecular)
      add_score(
          "isoline map, within the critical angle", rows,
          [&](const Row& row) {
            return is_beyond_critical(row, map.index) ? std::optional<color::Lab>() : std::optional(at(row));
          },
          scores);
  }
  return Result(std::move(scores));
}

// The name of the columns of a formula, which is de00 for CIEDE2000.
std::string column_of(const color::DifferenceFormula& formula) {
  using Kind = color::DifferenceFormula::Kind;
  return formula.kind == Kind::kCiede2000 ? "de00" : formula_name(formula);
}

Json as_json(const std::string& paint, const Score& score, const std::string& column, const Rows& rows) {
  return {{"name", paint},
          {"model", score.model},
          {"rows", score.de76.size()},
          {"left_out", rows.left_out},
          {column + "_mean", math::mean(score.by_formula)},
          {column + "_p95", math::percentile_95(score.by_formula)},
          {column + "_max", *std::max_element(score.by_formula.begin(), score.by_formula.end())},
          {"de76_mean", math::mean(score.de76)},
          {"de76_p95", math::percentile_95(score.de76)}};
}

// A line of the table: the values of the object.
std::string line_of(const Json& json) {
  std::string line;
  for (const Json& value : json)
    line += (line.empty() ? "" : "\t") + (value.is_string()         ? table_field(value.get<std::string>())
                                          : value.is_number_float() ? fmt::format("{:.3f}", value.get<double>())
                                                                    : json_text(value));
  return line + "\n";
}

}  // namespace

Result<cli::Verdict> score(const Options& options, cli::Session& session) {
  const Format format = format_of(options.format, options.output);
  if (format == Format::kPaints) return usage_error("--score writes a table or JSON, and no paints");
  GONIO_ASSIGN(const color::DifferenceFormula formula, formula_of(options.formula));
  const std::string column = column_of(formula);
  GONIO_ASSIGN(const Table table, Table::read(options.score, session));
  for (const std::string& doubt : table.doubts()) session.warn(fmt::format("{}: {}", options.score, doubt));
  std::vector<std::pair<paint::Paint, std::filesystem::path>> paints;
  bool named = false;
  for (const std::string& path : options.inputs.empty() ? std::vector<std::string>{"-"} : options.inputs) {
    GONIO_ASSIGN(std::vector<paint::Paint> read, all_paints(path, session));
    for (paint::Paint& paint : read) {
      named = named || paint.name == table.stem();
      paints.emplace_back(std::move(paint), std::filesystem::path(formats::paint_reference(path).file).parent_path());
    }
  }
  std::string text =
      format == Format::kTable
          ? fmt::format("name\tmodel\trows\tleft_out\t{0}_mean\t{0}_p95\t{0}_max\tde76_mean\tde76_p95\n", column)
          : "";
  std::size_t scored = 0;
  session.begin_list("scores");
  for (const auto& [paint, folder] : paints) {
    if (table.is_of_one_paint() && named && paint.name != table.stem()) continue;
    GONIO_ASSIGN(const std::optional<Rows> rows, table.of(paint));
    if (!rows || rows->kept.empty()) continue;
    GONIO_ASSIGN(const Scores scores, scores_of(paint, *rows, folder, formula));
    scored += !scores.list.empty();
    for (const Score& each : scores.list) {
      const Json json = as_json(paint.name, each, column, *rows);
      text += format == Format::kTable ? line_of(json) : json_text(json) + "\n";
      session.add("scores", [&] { return json; });
    }
  }
  if (scored == 0) return input_error("{}: no paint has both a model and directions there", options.score);
  GONIO_TRY(write_file(options.output, text));
  session.results()["read"] = paints.size();
  session.say(
      fmt::format("{}: {} of {} paints compared with {}", session.tool(), scored, paints.size(), options.score));
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
