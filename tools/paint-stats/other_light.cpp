#include "other_light.h"

#include "formulas.h"
#include "illuminants.h"
#include "paint_stream.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

// The largest difference, or n/a where there is none.
std::string field_of(const std::vector<paint::DifferenceAt>& differences) {
  double largest = -1;
  for (const paint::DifferenceAt& difference : differences)
    if (!(difference.value <= largest)) largest = difference.value;  // also one that is not a number
  constexpr int kDecimals = 2;                                       // these come from spectra
  return "\t" + (largest >= 0 ? table_number(largest, kDecimals) : std::string("n/a"));
}

Json json_of(const std::vector<paint::DifferenceAt>& differences) {
  Json json = Json::object();
  for (const paint::DifferenceAt& difference : differences)
    json[paint::geometry_name(difference.geometry)] = json_number(difference.value);
  return json;
}

Result<paint::Measurement> standard_of(const std::string& reference, cli::Session& session) {
  GONIO_ASSIGN(const std::vector<paint::Paint> paints, all_paints(reference, session));
  if (paints.size() != 1)
    return input_error("--standard {}: holds {} paints: name one of them by FILE#NAME", reference, paints.size());
  const auto& measurement = paints.front().measurement;
  if (!measurement || measurement->spectra.empty())
    return input_error("--standard {}: has no spectra, so that nothing tells its color in other light", reference);
  return Result(*measurement);
}

}  // namespace

Result<OtherLight> OtherLight::create(const Options& options, cli::Session& session) {
  OtherLight result;
  GONIO_ASSIGN(result.formula_, formula_of(options.formula));
  GONIO_ASSIGN(result.illuminants_, illuminants_of(options.illuminants));
  if (options.standard.empty()) return result;
  if (result.illuminants_.empty())
    return usage_error("--standard needs the light in which pairs are compared: give --illuminant, as in A,F11");
  GONIO_ASSIGN(result.standard_, standard_of(options.standard, session));
  return result;
}

std::string OtherLight::head() const {
  std::string text;
  for (const std::string& name : illuminants_) {
    text += "\tinconstancy_" + name;
    if (standard_) text += "\tmetamerism_" + name;
  }
  return text;
}

Result<OtherLight::Figures> OtherLight::of(const paint::Paint& paint) const {
  Figures figures;
  const bool known = paint.measurement && !paint.measurement->spectra.empty();
  for (const std::string& name : illuminants_) {
    std::vector<paint::DifferenceAt> inconstancy, metamerism;
    if (known) {
      const color::ViewingCondition reference = paint.measurement->condition, test = {name, reference.observer_deg};
      GONIO_ASSIGN(inconstancy, paint::inconstancy(*paint.measurement, reference, test, formula_));
      if (standard_) {
        GONIO_ASSIGN(metamerism, paint::metamerism(*paint.measurement, *standard_, reference, test, formula_));
      }
    }
    figures.columns += field_of(inconstancy);
    figures.json[name]["inconstancy"] = json_of(inconstancy);
    if (!standard_) continue;
    figures.columns += field_of(metamerism);
    figures.json[name]["metamerism"] = json_of(metamerism);
  }
  return figures;
}

}  // namespace goniochrome::tool
