#include "tool.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/clock.h"
#include "base/file.h"
#include "brdf/lobe_model.h"
#include "color_maps.h"
#include "fit/brdf_target.h"
#include "fit/paint_fit.h"
#include "fitting.h"
#include "formats/default_basis.h"
#include "formats/imported.h"
#include "illuminants.h"
#include "paint/spectra.h"
#include "paint_stream.h"
#include "settings.h"
#include "tally.h"
#include "tilts.h"

namespace goniochrome::tool {

namespace {

// Paints are fitted in batches that grow, so that the first ones of a slow pipe come through at once.
constexpr std::size_t kLargestBatch = 256;

Result<std::vector<FitInput>> open_all(std::vector<std::string> paths) {
  if (paths.empty()) paths = {"-"};
  std::vector<FitInput> inputs;
  for (const std::string& path : paths) {
    GONIO_ASSIGN(FitInput input, FitInput::open(path));
    inputs.push_back(std::move(input));
  }
  return inputs;
}

// Names must stay unique in the output. A reader makes sure of that within one file, and this class between files.
class NamesOfAll {
 public:
  explicit NamesOfAll(const std::vector<FitInput>& inputs) : inputs_(inputs) {}
  Result<void> note(const paint::Paint& paint, std::size_t input, const std::string& place) {
    if (inputs_.size() == 1) return {};
    const auto before = ledger_.note(paint.name, static_cast<int>(input) + 1);
    if (!before) return {};
    return input_error("{}: paint \"{}\" is already in {}: rename one of them", place, paint.name,
                       inputs_[static_cast<std::size_t>(*before) - 1].name);
  }

 private:
  const std::vector<FitInput>& inputs_;
  formats::NameLedger ledger_;
};

// One run over all inputs.
class Run {
 public:
  // The colors are those under `illuminant`, or under that of the readings if it is "".
  Run(const fit::PaintFitter& fitter, const std::string& illuminant, std::vector<FitInput>& inputs,
      formats::PaintWriter& writer, Tally& tally, ColorMaps& maps, Tilts& tilts, cli::Session& session)
      : fitter_(fitter),
        illuminant_(illuminant),
        inputs_(inputs),
        writer_(writer),
        tally_(tally),
        maps_(maps),
        tilts_(tilts),
        session_(session),
        names_(inputs) {}

  Result<void> all() {
    for (std::size_t k = 0; k < inputs_.size(); ++k) GONIO_TRY(inputs_[k].paints ? library(k) : measured(k));
    return {};
  }

 private:
  Result<void> library(std::size_t k) {
    std::vector<paint::Paint> batch;
    std::vector<std::string> places;
    formats::PaintSource& source = *inputs_[k].paints;
    tell_warnings(source.warnings(), session_);
    bool more = true;
    for (std::size_t size = 1; more; size = std::min(2 * size, kLargestBatch)) {
      batch.clear(), places.clear();
      while (more && batch.size() < size) {
        GONIO_ASSIGN(std::optional<paint::Paint> paint, source.next());
        more = paint.has_value();
        if (!more) break;
        places.push_back(source.place());
        GONIO_TRY(names_.note(*paint, k, places.back()));
        batch.push_back(std::move(*paint));
      }
      GONIO_TRY(finish_batch(batch, places, inputs_[k].name));
      session_.progress(fmt::format("{}: {} paints", session_.tool(), tally_.done()));
    }
    tell_warnings(source.closing_warnings(), session_);
    return {};
  }

  // Fits one batch and writes it on.
  Result<void> finish_batch(std::vector<paint::Paint>& batch, const std::vector<std::string>& places,
                            const std::string& name) {
    const Stopwatch clock;
    const std::vector<std::string> unlit = bring_to_light(batch);
    std::vector<Result<fit::PaintFit>> results = fit::fits(fitter_, batch);
    tally_.add_time(clock.elapsed_s());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!unlit[i].empty()) {
        tally_.add_failure(batch[i], places[i], unlit[i]);
      } else if (results[i].ok()) {
        tally_.add(batch[i], *results[i]);
        // A paint whose gloss would imply a coat says that it has none.
        if (results[i]->lobes.coat_index != paint::kNoCoat || !batch[i].gloss.empty())
          batch[i].coat_index = results[i]->lobes.coat_index;
        batch[i].lobes = std::move(results[i]->lobes);
      } else {
        tally_.add_failure(batch[i], places[i], results[i].error().message);
      }
      const std::string& where = places[i];
      GONIO_ASSIGN(const std::optional<MadeMap> map, maps_.add(batch[i], nullptr, where));
      if (results[i].ok()) tilts_.add(batch[i], map, name, where);
      GONIO_TRY(writer_.write(batch[i]));
    }
    return {};
  }

  // Brings the paints to the illuminant, and says why a paint stays as it was; "" of those that did not.
  std::vector<std::string> bring_to_light(std::vector<paint::Paint>& batch) const {
    std::vector<std::string> unlit(batch.size());
    for (std::size_t i = 0; !illuminant_.empty() && i < batch.size(); ++i) {
      auto lit = paint::in_light(batch[i], {illuminant_, paint::condition_of(batch[i]).observer_deg});
      if (lit.ok())
        batch[i] = std::move(*lit);
      else
        unlit[i] = lit.error().message;
    }
    return unlit;
  }

  Result<void> measured(std::size_t k) {
    FitInput& input = inputs_[k];
    if (!illuminant_.empty())
      return usage_error("{}: is a measured BRDF: bring it to --illuminant {} by paint-convert first", input.name,
                         illuminant_);
    GONIO_ASSIGN(fit::BrdfTarget target, fit::read_brdf_target(*input.measured));
    input.measured.reset();
    for (const std::string& remark : target.remarks) session_.warn(fmt::format("{}: {}", input.name, remark));
    GONIO_TRY(names_.note(target.paint, k, input.name));
    const Stopwatch clock;
    Result<fit::PaintFit> fit = fitter_.fit(target);
    tally_.add_time(clock.elapsed_s());
    if (fit.ok()) {
      GONIO_ASSIGN(fit->report.brdf->albedo_error,
                   fit::albedo_error(*target.source, [&](const Vec3& light, const Vec3& view) {
                     return brdf::coated_brdf(fit->lobes, light, view, {0, 0, 1});
                   }));
      tally_.add(target.paint, *fit);
      target.paint.lobes = std::move(fit->lobes);
    } else {
      tally_.add_failure(target.paint, input.name, fit.error().message);
    }
    GONIO_ASSIGN(const std::optional<MadeMap> map, maps_.add(target.paint, target.source.get(), input.name));
    tilts_.add(target.paint, map, input.name, input.name);
    return writer_.write(target.paint);
  }

  const fit::PaintFitter& fitter_;
  const std::string& illuminant_;
  std::vector<FitInput>& inputs_;
  formats::PaintWriter& writer_;
  Tally& tally_;
  ColorMaps& maps_;
  Tilts& tilts_;
  cli::Session& session_;
  NamesOfAll names_;
};

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(fit::FitOptions fit, fit_options(options));
  fit.by_incidence = !options.common.report.empty();
  GONIO_ASSIGN(formats::Basis basis, formats::basis_or_default(options.basis));
  std::string illuminant;
  if (!options.illuminant.empty()) {
    GONIO_ASSIGN(const std::vector<std::string> illuminants, illuminants_of({options.illuminant}));
    if (illuminants.size() != 1)
      return usage_error("--illuminant is \"{}\": give one, and run once for each", options.illuminant);
    illuminant = illuminants.front();
  }
  session.explain(plan(options, fit, basis));
  const fit::PaintFitter fitter(std::move(basis), std::move(fit));

  GONIO_ASSIGN(std::vector<FitInput> inputs, open_all(options.paints));
  Prolog prolog;
  for (const FitInput& input : inputs)
    if (input.paints) prolog.take(*input.paints);
  GONIO_ASSIGN(formats::PaintWriter writer, begin_paints(options.output, std::move(prolog), session));
  Tally tally(options, session);
  ColorMaps maps(options, session);
  GONIO_TRY(maps.begin());
  Tilts tilts(options, fitter.basis(), session);
  GONIO_TRY(tilts.begin());
  GONIO_TRY(Run(fitter, illuminant, inputs, writer, tally, maps, tilts, session).all());
  GONIO_TRY(writer.finish());
  maps.finish();
  tilts.finish();
  return tally.finish();
}

}  // namespace goniochrome::tool
