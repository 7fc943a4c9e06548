// Pages of charts: every judgement with its pictures, and the control charts of all samples in their order.
#pragma once

#include <vector>

#include "cli/tool.h"
#include "judgement.h"
#include "tool.h"

namespace goniochrome::tool {

struct ChartedSample {
  Judgement judgement;
  paint::Paint sample;
};

// A standard and the eight paints of quality::just_passing() behind it.
using LimitFamily = std::vector<paint::Paint>;

// Writes the page of --chart, or a folder with a page for each sample and an index. The families are drawn before the
// samples. Error: the drawing cannot be set up or a file cannot be written.
Result<void> write_charts(const Options& options, const std::vector<ChartedSample>& samples,
                          const std::vector<LimitFamily>& families, const quality::CompareOptions& compare,
                          cli::Session& session);

}  // namespace goniochrome::tool
