// Words, figures and verdict of --check.
#pragma once

#include <string>

#include "cli/tool.h"
#include "render/truth.h"

namespace goniochrome::tool {

// The 95th percentile with the range of its standard error by the choice of pixels: "1.20 (0.90 to 1.74)".
std::string told_p95(const render::PictureError& error);

// The figures of both checks as the report has them.
Json error_json(const render::PictureError& error, const std::string& against, const std::string& source);

// Says where the checked pixels do not keep the tolerance, or leave it open. Returns the verdict.
cli::Verdict tell_verdict(const render::PictureError& error, double tolerance, cli::Session& session);

// Reports the comparison with path traced truth, and says it in a sentence: the total, its causes, and the verdict.
cli::Verdict tell_truth(const render::TruthError& error, const std::string& source, double tolerance,
                        cli::Session& session);

}  // namespace goniochrome::tool
