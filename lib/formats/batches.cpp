#include "formats/batches.h"

#include <algorithm>
#include <iterator>

#include "base/clock.h"

namespace goniochrome::formats {

namespace {

constexpr std::size_t kLargestBatch = 1024;
constexpr double kSlowBatch_s = 0.02;

}  // namespace

Result<PaintBatches> PaintBatches::open(std::vector<std::string> paths, const std::vector<std::string>& only) {
  if (paths.empty()) paths = {"-"};
  PaintBatches batches;
  batches.only_ = {only.begin(), only.end()};
  for (const std::string& name : batches.only_) batches.unmet_.emplace(name, WantedName(name));
  for (const std::string& path : paths) {
    GONIO_ASSIGN(PaintSourcePointer source, open_paints(path));
    const std::vector<std::string> warnings = source->warnings();
    batches.warnings_.insert(batches.warnings_.end(), warnings.begin(), warnings.end());
    batches.sources_.push_back(std::move(source));
  }
  return batches;
}

std::vector<Processing> PaintBatches::processing() const {
  std::vector<Processing> all;
  for (const PaintSourcePointer& source : sources_) std::ranges::move(source->processing(), std::back_inserter(all));
  return all;
}

std::vector<std::string> PaintBatches::foreign() const {
  std::vector<std::string> all;
  for (const PaintSourcePointer& source : sources_) std::ranges::move(source->foreign(), std::back_inserter(all));
  return all;
}

bool PaintBatches::is_wanted(const std::string& name) {
  unmet_.erase(name);
  for (auto& [unmet, wanted] : unmet_) wanted.see(name);
  return only_.empty() || only_.contains(name);
}

Result<std::vector<paint::Paint>> PaintBatches::next(const std::function<void(const Error&)>& left_out) {
  const Stopwatch filling;
  std::vector<paint::Paint> batch;
  while (batch.size() < size_ && current_ < sources_.size()) {
    auto paint = sources_[current_]->next();
    if (!paint.ok()) {
      if (!left_out) return paint.error();
      left_out(paint.error());
    } else if (paint->has_value()) {
      if (is_wanted((*paint)->name)) batch.push_back(std::move(**paint));
    } else {
      std::ranges::move(sources_[current_++]->closing_warnings(), std::back_inserter(warnings_));
    }
  }
  if (batch.empty() && !unmet_.empty()) return input_error("{}", unmet_.begin()->second.not_found());
  size_ = filling.elapsed_s() < kSlowBatch_s ? std::min(2 * size_, kLargestBatch) : 1;
  return batch;
}

}  // namespace goniochrome::formats
