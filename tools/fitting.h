// Options that fit-basis and fit-paint share: their inputs, and two options about the target.
#pragma once

#include <optional>
#include <string>

#include "base/file.h"
#include "brdf/measured.h"
#include "cli/options.h"
#include "formats/paint_source.h"
#include "paint/curve.h"

namespace goniochrome::tool {

inline void add_target_options(cli::ToolSpec& spec, std::string& target, std::string& weights) {
  spec.option("target,t", "TARGET", "curve", &target, "color that the lobes follow")
      .one_of({"measured", "curve"})
      .more(
          "measured takes the readings, with a monotone curve between them. curve takes the quadratic curve of face, "
          "flop and travel.");
  spec.option("weights,w", "WEIGHTS", "plain", &weights, "how errors count")
      .one_of({"perceptual", "plain"})
      .more(
          "perceptual weighs an error by its effect on lightness; plain weighs all alike.");
}

inline paint::TargetCurve::Kind target_kind(const std::string& target) {
  return target == "curve" ? paint::TargetCurve::Kind::kCurve : paint::TargetCurve::Kind::kMeasured;
}

// A file of paints, open, or a measured BRDF, to be read when its turn comes.
struct FitInput {
  std::string name;
  formats::PaintSourcePointer paints;
  std::optional<InputFile> measured;

  // `reference` is FILE, or FILE#NAMES for some of its paints. Error: the file cannot be opened.
  static Result<FitInput> open(const std::string& reference) {
    auto [path, names] = formats::paint_reference(reference);
    GONIO_ASSIGN(InputFile file, InputFile::open(path));
    const std::string name = file.name();
    GONIO_ASSIGN(const std::string_view head, file.peek());
    if (brdf::looks_measured(path, head)) {
      if (names) return input_error("{}: is one measured BRDF without names: leave out #{}", name, *names);
      return FitInput{name, nullptr, std::move(file)};
    }
    GONIO_ASSIGN(formats::PaintSourcePointer paints, formats::open_paints(std::move(file), std::move(names)));
    return FitInput{name, std::move(paints), std::nullopt};
  }
};

}  // namespace goniochrome::tool
