#include "tool.h"

#include <cmath>
#include <functional>
#include <optional>

#include "base/clock.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "other_light.h"
#include "paint/inferred_class.h"
#include "paint/metrics.h"
#include "paint_sink.h"
#include "score.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

// The decimals of the readings of a paint, or of its design.
int decimals_for(const paint::Paint& paint) {
  std::vector<color::Lab> colors;
  if (paint.measurement)
    for (const paint::LabReading& row : paint.measurement->rows) colors.push_back(row.lab);
  else if (paint.appearance)
    colors = {paint.appearance->face, paint.appearance->flop};
  return decimals_of(colors);
}

// The figures of one paint.
struct Figures {
  paint::PaintMetrics numbers;
  OtherLight::Figures elsewhere;
  std::optional<bool> inferred;  // with --classify: whether the class follows from the readings
};

// The origin of a class, in one word.
const char* class_source(const paint::Paint& paint, const Figures& figures) {
  return paint.paint_class == paint::PaintClass::kUnknown ? "-" : *figures.inferred ? "inferred" : "stated";
}

Json as_json(const paint::Paint& paint, const Figures& figures) {
  const paint::PaintMetrics& numbers = figures.numbers;
  Json json = {{"name", paint.name}, {"code", paint.code}, {"class", paint::paint_class_name(paint.paint_class)}};
  for (const paint::MetricColumn& column : paint::metric_columns())
    json[column.name] = json_number(numbers.*column.value);
  if (paint.measurement)
    for (const paint::TextureReading& texture : paint.measurement->textures)
      json["textures"].push_back({{"quantity", texture.quantity},
                                  {"geometry", texture.geometry},
                                  {"version", texture.version},
                                  {"instrument", paint.measurement->instrument},
                                  {"value", texture.value}});
  json["source"] = paint::source_name(numbers.source);
  json["flags"] = numbers.flags;
  if (figures.inferred) json["class_source"] = class_source(paint, figures);
  if (!figures.elsewhere.json.is_null()) json["under"] = figures.elsewhere.json;
  return json;
}

std::string table_head(const OtherLight& light, bool classify) {
  std::string text = "name\tcode\tclass";
  for (const paint::MetricColumn& column : paint::metric_columns()) text += std::string("\t") + column.name;
  return text + "\tsource\tflags" + light.head() + (classify ? "\tclass_source\n" : "\n");
}

std::string table_line(const paint::Paint& paint, const Figures& figures) {
  const paint::PaintMetrics& numbers = figures.numbers;
  std::string text =
      table_field(paint.name) + "\t" + table_field(paint.code) + "\t" + paint::paint_class_name(paint.paint_class);
  const int decimals = decimals_for(paint);
  for (const paint::MetricColumn& column : paint::metric_columns())
    text += "\t" + table_number(numbers.*column.value, decimals);
  const std::string flags = joined({numbers.flags.begin(), numbers.flags.end()}, ",");
  return text + "\t" + paint::source_name(numbers.source) + "\t" + (flags.empty() ? "-" : flags) +
         figures.elsewhere.columns + (figures.inferred ? std::string("\t") + class_source(paint, figures) : "") + "\n";
}

// One run, which turns a stream of paints into figures or picks paints of it.
class Run {
 public:
  Run(const Options& options, cli::Session& session) : options_(options), session_(session) {}

  Result<cli::Verdict> operator()() {
    if (!options_.where.empty()) {
      GONIO_ASSIGN(paint::PaintFilter filter, paint::PaintFilter::parse(options_.where));
      filter_.emplace(std::move(filter));
    }
    GONIO_ASSIGN(light_, OtherLight::create(options_, session_));
    GONIO_ASSIGN(formats::PaintBatches batches, formats::PaintBatches::open(options_.inputs));
    GONIO_ASSIGN(PaintSink sink, PaintSink::begin(options_.format, options_.output,
                                                  table_head(*light_, options_.classify), batches, session_));
    sink_.emplace(std::move(sink));
    session_.begin_list("paints");
    GONIO_TRY(for_each_batch(
        batches, session_, [&](const std::vector<paint::Paint>& batch) { return measure(batch); }, left_out()));
    GONIO_TRY(sink_->finish());
    return finish();
  }

 private:
  // The handler of a paint that cannot be read.
  std::function<void(const Error&)> left_out() {
    if (!options_.keep_going) return {};
    return [this](const Error& error) {
      session_.warn(error.message + ": left out");
      ++left_out_;
    };
  }

  Result<void> measure(const std::vector<paint::Paint>& batch) {
    const Stopwatch measuring;
    std::vector<std::optional<Result<Figures>>> figures(batch.size());
    parallel_for(batch.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) figures[i] = figures_of(batch[i]);
    });
    measuring_s_ += measuring.elapsed_s();
    read_ += batch.size();
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!figures[i]->ok()) return input_error("paint \"{}\": {}", batch[i].name, figures[i]->error().message);
      GONIO_TRY(options_.classify ? take_classified(batch[i], **figures[i]) : take(batch[i], **figures[i]));
    }
    return sink_->flush();
  }

  Result<Figures> figures_of(const paint::Paint& paint) const {
    GONIO_ASSIGN(paint::PaintMetrics numbers, paint::metrics(paint));
    GONIO_ASSIGN(OtherLight::Figures elsewhere, light_->of(paint));
    return Figures{std::move(numbers), std::move(elsewhere), std::nullopt};
  }

  // Gives a paint that states no class the one that its readings tell.
  Result<void> take_classified(paint::Paint paint, Figures& figures) {
    figures.inferred = false;
    if (paint.paint_class == paint::PaintClass::kUnknown) {
      const auto found = paint::inferred_class(paint, figures.numbers);
      ++(found ? inferred_ : undecided_);
      figures.inferred = found.has_value();
      paint.paint_class = found.value_or(paint::PaintClass::kUnknown);
    }
    return take(paint, figures);
  }

  Result<void> take(const paint::Paint& paint, const Figures& figures) {
    if (filter_ && !filter_->matches(paint, figures.numbers)) return {};
    ++matched_;
    session_.add("paints", [&] { return as_json(paint, figures); });
    switch (sink_->format()) {
      case Format::kPaints:
        return sink_->write(paint);
      case Format::kJson:
        return sink_->write(json_text(as_json(paint, figures)) + "\n");
      case Format::kTable:
        break;
    }
    return sink_->write(table_line(paint, figures));
  }

  cli::Verdict finish() {
    Json& results = session_.results();
    results["read"] = read_;
    results["matched"] = matched_;
    results["left_out"] = left_out_;
    results["paints_per_s"] = measuring_s_ > 0 ? static_cast<double>(read_) / measuring_s_ : 0.0;
    std::string line = fmt::format("{}: {} paints", session_.tool(), read_);
    if (filter_) line += fmt::format(", {} match", matched_);
    if (options_.classify) {
      results["inferred"] = inferred_, results["undecided"] = undecided_;
      line += fmt::format(", {} classes inferred from readings, {} undecided", inferred_, undecided_);
    }
    if (left_out_ > 0) line += fmt::format(", {} left out", left_out_);
    if (read_ + left_out_ == 0) session_.warn("the input holds no paints");
    session_.say(line);
    return left_out_ > 0 || read_ == 0 || (filter_ && matched_ == 0) ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

  const Options& options_;
  cli::Session& session_;
  std::optional<paint::PaintFilter> filter_;
  std::optional<OtherLight> light_;
  std::optional<PaintSink> sink_;
  std::size_t read_ = 0, matched_ = 0, left_out_ = 0, inferred_ = 0, undecided_ = 0;
  double measuring_s_ = 0;
};

std::string plan(const Options& options) {
  const Format format = format_of(options.format, options.output);
  return fmt::format(
      "colors: measured rows at 15, 45 and 110 deg, else the stated curve, else a fitted one; about 1 us a paint, 10 "
      "us where a curve is fitted for travel and residual\n"
      "{}"
      "output: {}\n"
      "left out: rows out of plane, or not at 45 deg incidence, have no part in the indices\n",
      options.where.empty() ? "all paints\n" : fmt::format("only paints with {}\n", options.where),
      format == Format::kPaints ? "the paints as they came, with this step in their history"
      : format == Format::kJson ? "one JSON object a line"
                                : "a table");
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (!options.score.empty()) {
    if (!options.where.empty()) return usage_error("--score and --where exclude each other");
    if (!options.illuminants.empty() || !options.standard.empty())
      return usage_error("--score compares under the light of the readings: leave out --illuminant and --standard");
    return score(options, session);
  }
  session.explain(plan(options));
  return Run(options, session)();
}

}  // namespace goniochrome::tool
