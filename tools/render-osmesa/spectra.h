// From words of the command line and paints with spectra to a scene in bands of wavelength.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "cli/tool.h"
#include "color/bands.h"
#include "paints.h"
#include "render/spectra.h"
#include "request.h"
#include "tool.h"

namespace goniochrome::tool {

struct Stage;

// A light: LIGHT*TERM*..., where LIGHT is an illuminant or FILE.csv#COLUMN, of luminance 1, and each TERM a number or
// FILE.csv#COLUMN, a filter. Relative to daylight. Error (usage): what is wrong with the word, and what it may be.
Result<color::Bands> light_of_word(const std::string& word);

// The color of such light in the working space, for the standard observer of 2 deg.
color::Rgb color_of(const color::Bands& light);

// Gives the scene of the stage its spectra, if it has all of them and the engine follows light in bands; tells the
// session what lacks them where any lamp has one. Error: --spectral on, and something lacks them.
Result<void> set_spectra(const Options& options, const Request& request, Stage& stage, cli::Session& session);

}  // namespace goniochrome::tool
