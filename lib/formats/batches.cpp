#include "formats/batches.h"

#include <algorithm>

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
    GONIO_ASSIGN(PaintReader reader, PaintReader::open(path));
    batches.readers_.push_back(std::move(reader));
  }
  for (PaintReader& reader : batches.readers_) reader.read_prolog();
  return batches;
}

std::vector<Processing> PaintBatches::processing() const {
  std::vector<Processing> all;
  for (const PaintReader& reader : readers_)
    all.insert(all.end(), reader.processing().begin(), reader.processing().end());
  return all;
}

std::vector<std::string> PaintBatches::foreign() const {
  std::vector<std::string> all;
  for (const PaintReader& reader : readers_) all.insert(all.end(), reader.foreign().begin(), reader.foreign().end());
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
  while (batch.size() < size_ && current_ < readers_.size()) {
    auto paint = readers_[current_].next();
    if (!paint.ok()) {
      if (!left_out) return paint.error();
      left_out(paint.error());
    } else if (paint->has_value()) {
      if (is_wanted((*paint)->name)) batch.push_back(std::move(**paint));
    } else {
      ++current_;
    }
  }
  if (batch.empty() && !unmet_.empty()) return input_error("{}", unmet_.begin()->second.not_found());
  size_ = filling.elapsed_s() < kSlowBatch_s ? std::min(2 * size_, kLargestBatch) : 1;
  return batch;
}

}  // namespace goniochrome::formats
