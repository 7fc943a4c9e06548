#include "tool.h"

#include <cstdlib>
#include <ctime>

#include "averaging.h"
#include "base/paths.h"
#include "base/text.h"
#include "formats.h"
#include "formats/imported.h"
#include "paint/curve.h"
#include "paint/spectra.h"
#include "selection.h"

namespace goniochrome::tool {

namespace {

// An input, open or still to be opened.
struct Input {
  std::string path;
  formats::PaintSourcePointer source;
};

// Opens each input once, to make sure that it is there and to read what stands before its first paint. Files are closed
// again, since there may be more of them than can be open at once. An input that cannot be opened twice stays open.
Result<std::vector<Input>> surveyed(const Options& options, const SourceSetup& source_setup, SinkSetup& setup,
                                    cli::Session& session) {
  std::vector<std::string> paths = options.inputs;
  if (paths.empty()) paths.push_back("-");
  std::vector<Input> inputs;
  for (const std::string& path : paths) {
    GONIO_ASSIGN(auto source, open_source(path, options.from, source_setup));
    session.explain(fmt::format("{}: {}\n", path == "-" ? "standard input" : path, source->format()));
    const Prolog prolog{source->processing(), source->foreign()};
    setup.layout.origin = setup.layout.origin || source->holds_designs();
    setup.prolog.processing.insert(setup.prolog.processing.end(), prolog.processing.begin(), prolog.processing.end());
    setup.prolog.foreign.insert(setup.prolog.foreign.end(), prolog.foreign.begin(), prolog.foreign.end());
    const bool reopens = paths.size() > 1 && path != "-" && is_plain_file(path);
    inputs.push_back({path, reopens ? nullptr : std::move(source)});
  }
  return inputs;
}

// `45as45`, or `WORDS=45as45`.
Result<formats::Viewing> viewing_of(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const std::string words = equals == std::string::npos ? "" : text.substr(0, equals);
  const auto geometry = paint::parse_geometry(equals == std::string::npos ? text : text.substr(equals + 1));
  if (!geometry.ok()) return usage_error("--viewing {}: {}", text, geometry.error().message);
  if (equals != std::string::npos && trimmed(words).empty())
    return usage_error("--viewing {}: the words before = are missing", text);
  return formats::Viewing{std::string(trimmed(words)), *geometry};
}

Result<SourceSetup> source_setup_of(const Options& options, const Selection& selection) {
  SourceSetup setup;
  if (options.observer != "auto") setup.import.observer_deg = options.observer == "2" ? 2 : 10;
  if (options.illuminant != "auto") {
    const auto condition = formats::stated_condition(options.illuminant, setup.import.observer_deg);
    if (!condition.ok()) return usage_error("{}", condition.error().message);
    setup.import.illuminant = condition->illuminant, setup.import.observer_deg = condition->observer_deg;
  }
  for (const std::string& text : options.viewings) {
    GONIO_ASSIGN(formats::Viewing viewing, viewing_of(text));
    setup.import.viewings.push_back(std::move(viewing));
  }
  setup.import.keep_going = options.keep_going;
  if (options.scale != "auto")
    setup.import.scale = options.scale == "percent" ? formats::Scale::kPercent : formats::Scale::kFactor;
  setup.geometries = selection.requested();
  setup.aperture_deg = options.aperture_deg;
  return Result(std::move(setup));
}

// The time as 2026-11-21T10:00:00Z. As usual, SOURCE_DATE_EPOCH sets the clock, so that files can be made again byte by
// byte.
std::string now_utc() {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  const auto seconds = epoch ? parse_integer(epoch) : std::nullopt;
  const std::time_t now = seconds ? static_cast<std::time_t>(*seconds) : std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

// One conversion: what goes through it, and what it counts.
class Conversion {
 public:
  Conversion(const Options& options, const SourceSetup& setup, const Selection& selection, PaintSink& sink,
             cli::Session& session)
      : options_(options),
        setup_(setup),
        selection_(selection),
        sink_(sink),
        session_(session),
        averaging_(options, session) {}

  Result<void> convert(Input& input);
  Result<void> finish();
  int read = 0, written = 0, skipped = 0;

 private:
  Result<void> take(paint::Paint paint, const formats::PaintSource& source);
  Result<void> pass(paint::Paint paint, const std::string& place);
  Result<void> skip(const Error& error);
  Result<void> bring_to_light(paint::Paint& paint);

  const Options& options_;
  const SourceSetup& setup_;
  const Selection& selection_;
  PaintSink& sink_;
  cli::Session& session_;
  Averaging averaging_;
  formats::Remarks remarks_;
  formats::PaintLedger names_;
  std::vector<std::string> inputs_;
};

// Bad input stops the run. With --keep-going it is told and counted instead.
Result<void> Conversion::skip(const Error& error) {
  if (!options_.keep_going || error.kind != ErrorKind::kInput) return error;
  ++skipped;
  session_.warn(error.message);
  return {};
}

// Readings under the illuminant and observer asked for, from spectra. What was made for the light before is made again
// or left out.
Result<void> Conversion::bring_to_light(paint::Paint& paint) {
  const formats::ImportOptions& asked = setup_.import;
  if (!paint.measurement || (asked.illuminant.empty() && asked.observer_deg == 0)) return {};
  color::ViewingCondition condition = paint.measurement->condition;
  if (!asked.illuminant.empty()) condition.illuminant = asked.illuminant;
  if (asked.observer_deg != 0) condition.observer_deg = asked.observer_deg;
  if (condition == paint.measurement->condition) return {};
  if (paint.measurement->spectra.empty()) {
    remarks_.note(fmt::format("paints without spectra stay as they are: nothing tells their color under {}/{}",
                              condition.illuminant, condition.observer_deg),
                  paint.name);
    return {};
  }
  const std::size_t rows = paint.measurement->rows.size();
  const bool has_models = paint.lobes || paint.color_map;
  GONIO_ASSIGN(paint, paint::in_light(paint, condition));
  if (paint.measurement->rows.size() < rows)
    remarks_.note("readings without a spectrum are left out: nothing tells their color in other light", paint.name);
  if (has_models) remarks_.note("lobes and color maps are left out: they are those of the light before", paint.name);
  return {};
}

// A paint as it is read: it goes on, or waits for the other readings of its name.
Result<void> Conversion::take(paint::Paint paint, const formats::PaintSource& source) {
  ++read;
  if (options_.average == "none") return pass(std::move(paint), source.place());
  const auto waits = averaging_.take(std::move(paint), source.place());
  return waits.ok() ? Result<void>() : skip(waits.error());
}

Result<void> Conversion::pass(paint::Paint paint, const std::string& place) {
  if (const auto other = names_.note(paint, static_cast<int>(inputs_.size()), remarks_))
    return skip(
        input_error("{}: paint \"{}\" is also in {}: rename one of them", place, paint.name, inputs_[*other - 1]));
  const auto relit = bring_to_light(paint);
  if (!relit.ok()) return skip(input_error("{}: paint \"{}\": {}", place, paint.name, relit.error().message));
  std::vector<paint::Geometry> from_curve;
  const auto selected = selection_.apply(paint, from_curve, remarks_);
  if (!selected.ok()) return skip(input_error("{}: {}", place, selected.error().message));
  GONIO_TRY(sink_.write(paint, from_curve));
  ++written;
  if (written % 1000 == 0) session_.progress(fmt::format("{} paints", written));
  return {};
}

Result<void> Conversion::convert(Input& input) {
  inputs_.push_back(input.path);
  if (!input.source) {
    GONIO_ASSIGN(input.source, open_source(input.path, options_.from, setup_));
  }
  for (const std::string& warning : input.source->warnings()) session_.warn(warning);
  for (;;) {
    auto paint = input.source->next();
    if (!paint.ok()) {
      GONIO_TRY(skip(paint.error()));
      continue;
    }
    if (!*paint) break;
    GONIO_TRY(take(std::move(**paint), *input.source));
  }
  for (const std::string& warning : input.source->closing_warnings()) session_.warn(warning);
  if (Json figures = input.source->figures(); !figures.is_null())
    session_.results()["measured"].push_back(std::move(figures));
  input.source.reset();
  return {};
}

Result<void> Conversion::finish() {
  GONIO_TRY(
      averaging_.finish([&](paint::Paint paint, const std::string& place) { return pass(std::move(paint), place); },
                        [&](const Error& error) { return skip(error); }));
  GONIO_TRY(sink_.finish());
  for (const std::string& remark : remarks_.lines()) session_.warn(remark);
  for (const std::string& warning : sink_.warnings()) session_.warn(warning);
  session_.results()["read"] = read;
  session_.results()["written"] = written;
  session_.results()["skipped"] = skipped;
  return {};
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  session.results() = {
      {"read", 0}, {"written", 0}, {"skipped", 0}, {"measured", Json::array()}, {"warnings", Json::array()}};
  GONIO_ASSIGN(const OutputFormat* format, output_format(options.output, options.to));
  GONIO_ASSIGN(const Selection selection, Selection::make(options, *format));
  if (session.common().report == "-" && options.output == "-")
    return usage_error("--report - needs standard output for itself: give -o FILE");

  GONIO_ASSIGN(const SourceSetup source_setup, source_setup_of(options, selection));
  SinkSetup setup{.prolog = {},
                  .layout = selection.layout(),
                  .creator = fmt::format("goniochrome {} {}", session.tool(), cli::Session::version()),
                  .command = session.command_line(),
                  .created = now_utc(),
                  .cxf_compat = options.cxf_compat};
  if (options.cxf_compat && format->name != "cxf")
    return usage_error("--cxf-compat is for CxF, and the output is {}: give --to cxf", format->title);
  GONIO_ASSIGN(std::vector<Input> inputs, surveyed(options, source_setup, setup, session));
  session.explain(selection.explanation());
  setup.prolog.processing.push_back(step_of(session));
  GONIO_ASSIGN(OutputFile file, OutputFile::create(options.output));
  GONIO_ASSIGN(const auto sink, format->begin(std::move(file), setup));

  Conversion conversion(options, source_setup, selection, *sink, session);
  for (Input& input : inputs) GONIO_TRY(conversion.convert(input));
  GONIO_TRY(conversion.finish());
  session.say(fmt::format("paint-convert: {} paints read, {} written as {}{}", conversion.read, conversion.written,
                          format->title, conversion.skipped ? fmt::format(", {} left out", conversion.skipped) : ""));
  if (conversion.read == 0 && conversion.skipped == 0) session.warn("no paint was read: nothing was converted");
  return conversion.skipped > 0 || conversion.read == 0 ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
