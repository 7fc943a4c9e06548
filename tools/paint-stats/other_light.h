// How the colors of paints change in other light than that of their readings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "paint/spectra.h"
#include "tool.h"

namespace goniochrome::tool {

class OtherLight {
 public:
  // Error: an illuminant that is not known; a standard that cannot be read, is not one paint or has no spectra.
  static Result<OtherLight> create(const Options& options, cli::Session& session);

  // The names of the columns, each behind a tab; "" where no other light was asked for.
  std::string head() const;

  // The figures of one paint.
  struct Figures {
    std::string columns;  // the fields, each behind a tab
    Json json;            // by illuminant
  };
  Result<Figures> of(const paint::Paint& paint) const;

 private:
  std::vector<std::string> illuminants_;
  color::DifferenceFormula formula_ = paint::kInOtherLight;
  std::optional<paint::Measurement> standard_;
};

}  // namespace goniochrome::tool
