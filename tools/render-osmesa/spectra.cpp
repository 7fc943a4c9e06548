#include "spectra.h"

#include <algorithm>
#include <set>

#include "base/text.h"
#include "brdf/band_lobes.h"
#include "color/color_bands.h"
#include "color/spectrum.h"
#include "formats/spectrum_table.h"
#include "stage.h"

namespace goniochrome::tool {

namespace {

struct TableColumn {
  std::vector<double> nm, values;
};

using ColumnOf = Result<std::vector<double>> (formats::SpectrumTable::*)(const std::string& name) const;

// FILE#COLUMN as `values_of` gives it, or nothing where there is no #.
Result<std::optional<TableColumn>> table_column(const std::string& term, ColumnOf values_of) {
  const auto hash = term.rfind('#');
  if (hash == std::string::npos) return std::optional<TableColumn>();
  GONIO_ASSIGN(formats::SpectrumTable table, formats::read_spectrum_table(term.substr(0, hash)));
  auto values = (table.*values_of)(term.substr(hash + 1));
  if (!values.ok()) return input_error("{}: {}", term.substr(0, hash), values.error().message);
  return std::optional<TableColumn>({std::move(table.wavelengths_nm), *std::move(values)});
}

Result<color::Bands> light_of_term(const std::string& term) {
  GONIO_ASSIGN(const std::optional<TableColumn> column, table_column(term, &formats::SpectrumTable::column));
  const auto light = column ? color::light_bands(column->nm, column->values) : color::illuminant_bands(term);
  if (light.ok()) return light;
  if (column) return input_error("{}: {}", term, light.error().message);
  return usage_error("\"{}\" is no light: write three numbers, one of {}, or FILE.csv#COLUMN", term,
                     color::spectral_illuminants());
}

Result<color::Bands> filter_of_term(const std::string& term) {
  if (const auto factor = parse_number(term)) {
    if (*factor >= 0) return color::even_bands(*factor);
    return usage_error("light cannot be negative");
  }
  GONIO_ASSIGN(const std::optional<TableColumn> column, table_column(term, &formats::SpectrumTable::factors));
  if (!column) return usage_error("\"{}\" is no filter: write a number or FILE.csv#COLUMN", term);
  return color::reflectance_bands(column->nm, column->values);
}

// The observer whose eyes the readings of all paints with spectra are for; 2 deg where they differ.
int observer_deg(const DressedMesh& dress) {
  std::set<int> all;
  for (const auto& paint : dress.worn)
    if (paint && paint->measurement && !paint->measurement->spectra.empty())
      all.insert(paint->measurement->condition.observer_deg);
  return all.size() == 1 ? *all.begin() : 2;
}

// The spectra of a scene, and what has none or a guessed one.
class Gathering {
 public:
  Gathering(const Options& options, const Request& request, const Stage& stage)
      : options_(options), request_(request), stage_(stage) {}

  Result<void> gather() {
    GONIO_ASSIGN(spectra.eye, color::BandObserver::make(observer_deg(stage_.dresses.front())));
    if (!options_.env.empty()) lacks.emplace_back("the environment has three channels");
    if (!options_.gbuffer.empty()) lacks.emplace_back("--gbuffer holds no spectra");
    if (request_.transport) lacks.emplace_back("--aov transport holds three channels");
    if (!options_.textures.empty()) lacks.emplace_back("textures have three channels");
    if (stage_.dresses.size() > 1) lacks.emplace_back("--split changes paints");
    gather_paints();
    for (std::size_t i = 0; i < request_.lights.size(); ++i) {
      const auto& bands = request_.light_bands[i];
      spectra.lights.push_back(bands ? *bands : light_of_color(request_.lights[i].white, "light", options_.lights[i]));
    }
    GONIO_TRY(gather_emission());
    return gather_floor();
  }

  render::SceneSpectra spectra;
  std::vector<std::string> lacks;
  double misfit_de00 = 0, readings_de00 = 0;
  std::vector<std::string> even;     // paints without a spectrum whose weights are gray
  std::vector<std::string> guessed;  // what has the smoothest spectrum of its color

 private:
  void take(const paint::BandLobes& lobes) {
    misfit_de00 = std::max(misfit_de00, lobes.misfit_de00);
    for (const double de00 : lobes.readings_de00) readings_de00 = std::max(readings_de00, de00);
  }

  bool guesses() const { return options_.spectral == "guess"; }

  // The lobes of a paint in bands, guessed where they are to be and the paint states no spectrum.
  Result<paint::BandLobes> lobes_of(const paint::Paint& paint, const std::string& what) {
    auto stated = brdf::band_lobes(paint, spectra.eye);
    if (stated.ok() || !guesses()) return stated;
    auto lobes = brdf::band_lobes(paint, spectra.eye, brdf::NoSpectrum::kGuessed);
    if (lobes.ok()) add(fmt::format("{}: {}", what, stated.error().message), guessed);
    return lobes;
  }

  bool is_guessed(const std::string& what) const {
    return std::ranges::any_of(guessed, [&](const std::string& told) { return told.starts_with(what + ":"); });
  }

  static void add(const std::string& what, std::vector<std::string>& list) {
    if (std::ranges::find(list, what) == list.end()) list.push_back(what);
  }

  // The bands of a light that is three numbers, if they are to be guessed.
  color::Bands light_of_color(const color::Rgb& color, const char* option, const std::string& word) {
    (guesses() ? guessed : lacks).push_back(fmt::format("--{} {} is three numbers", option, word));
    return guesses() ? color::bands_of_color(color, spectra.eye) : color::Bands{};
  }

  void gather_paints() {
    const DressedMesh& dress = stage_.dresses.front();
    for (std::size_t part = 0; part < dress.paints.size(); ++part) {
      const std::string& name = dress.names[part].empty() ? stage_.mesh.parts[part].name : dress.names[part];
      paint::Paint bare;
      bare.lobes = dress.paints[part];
      const bool has_surface = !dress.surfaces[part].textures.empty();
      const std::string what = fmt::format("the paint {}", name);
      auto lobes = lobes_of(dress.worn[part] ? *dress.worn[part] : bare, what);
      if (!lobes.ok() && !has_surface) add(fmt::format("{}: {}", what, lobes.error().message), lacks);
      const bool measured =
          dress.worn[part] && dress.worn[part]->measurement && !dress.worn[part]->measurement->spectra.empty();
      if (lobes.ok() && !measured && !is_guessed(what)) add(name, even);
      if (lobes.ok()) take(*lobes);
      spectra.paints.push_back(lobes.ok() ? *std::move(lobes) : paint::BandLobes{});
    }
  }

  Result<void> gather_emission() {
    spectra.emission.assign(request_.emissions.empty() ? 0 : stage_.mesh.parts.size(), color::Bands{});
    for (const Emission& emission : request_.emissions) {
      const color::Bands bands =
          emission.bands ? *emission.bands : light_of_color(emission.radiance, "emit", emission.part);
      GONIO_ASSIGN(const std::vector<std::size_t> parts, parts_of(stage_.mesh, emission.part));
      for (const std::size_t part : parts) spectra.emission[part] = bands;
    }
    return {};
  }

  Result<void> gather_floor() {
    if (request_.floor.kind == FloorRequest::Kind::kNone) return {};
    if (request_.floor.kind == FloorRequest::Kind::kShadow) {
      lacks.emplace_back("the floor shows the environment");
      return {};
    }
    auto lobes = lobes_of(*stage_.floor_paint, "the paint of the floor");
    if (!lobes.ok()) {
      lacks.push_back(fmt::format("the paint of the floor: {}", lobes.error().message));
      return {};
    }
    take(*lobes);
    spectra.floor = *std::move(lobes);
    return {};
  }

  const Options& options_;
  const Request& request_;
  const Stage& stage_;
};

}  // namespace

Result<color::Bands> light_of_word(const std::string& word) {
  const auto terms = split(word, '*');
  GONIO_ASSIGN(color::Bands light, light_of_term(std::string(trimmed(terms.front()))));
  for (std::size_t i = 1; i < terms.size(); ++i) {
    GONIO_ASSIGN(const color::Bands filter, filter_of_term(std::string(trimmed(terms[i]))));
    light = color::product(light, filter);
  }
  return light;
}

color::Rgb color_of(const color::Bands& light) {
  static const color::BandObserver kEye = *color::BandObserver::make();
  return kEye.rgb(light);
}

Result<void> set_spectra(const Options& options, const Request& request, Stage& stage, cli::Session& session) {
  const bool named = std::ranges::any_of(request.light_bands, [](const auto& bands) { return bands.has_value(); }) ||
                     std::ranges::any_of(request.emissions, [](const Emission& e) { return e.bands.has_value(); });
  if (options.spectral == "off" || (options.spectral == "auto" && !named)) return {};
  if (!request.traces()) {
    session.say("light has three channels, which --engine path --spectral on would follow in bands");
    return {};
  }
  Gathering gathering(options, request, stage);
  GONIO_TRY(gathering.gather());
  const std::string lacks = joined(gathering.lacks, "; ");
  if (!lacks.empty() && options.needs_bands())
    return input_error("--spectral {} needs spectra of all: {}", options.spectral, lacks);
  Json& told = session.results()["spectral"];
  told = {{"bands", lacks.empty() ? color::kBands : 0},
          {"observer_deg", gathering.spectra.eye.observer_deg()},
          {"misfit_de00", json_number(gathering.misfit_de00)},
          {"readings_de00", json_number(gathering.readings_de00)},
          {"lacks", gathering.lacks},
          {"even", gathering.even},
          {"guessed", gathering.guessed}};
  if (!lacks.empty()) {
    session.say("drawn in three channels, not in bands: " + lacks);
    return {};
  }
  if (!gathering.guessed.empty())
    session.say("drawn in bands, with the smoothest spectrum of the color where none is stated: " +
                joined(gathering.guessed, "; "));
  const std::string even = joined(gathering.even, ", ");
  session.explain(
      fmt::format("light: {} bands from {} to {} nm, for the observer of {} deg; --operator has no part in it\n"
                  "  spectra of lobes: within dE00 {:.2f} of their three channels, within {:.2f} of the paints' "
                  "spectra under A\n{}",
                  color::kBands, color::kFirstBand_nm, color::band_nm(color::kBands - 1),
                  gathering.spectra.eye.observer_deg(), gathering.misfit_de00, gathering.readings_de00,
                  even.empty() ? "" : "  gray, and taken as even over all bands: " + even + "\n"));
  stage.spectra = std::move(gathering.spectra);
  stage.scene.spectra = &*stage.spectra;
  return {};
}

}  // namespace goniochrome::tool
