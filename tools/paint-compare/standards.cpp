#include "standards.h"

#include <algorithm>

#include "base/file.h"
#include "paint_stream.h"

namespace goniochrome::tool {

Result<Standards> Standards::open(const Options& options, cli::Session& session) {
  Standards result;
  GONIO_TRY(result.read(options, session));
  const bool one = result.standards_.size() == 1;
  if (options.pair == "nearest") {
    result.pair_ = Pair::kNearest;
    GONIO_TRY(result.prepare_search());
  } else if (options.pair != "auto" || !one) {
    result.pair_ = options.pair == "code" ? Pair::kCode : Pair::kName;
    GONIO_TRY(result.prepare_names(options));
  }
  return Result(std::move(result));
}

Result<void> Standards::read(const Options& options, cli::Session& session) {
  std::vector<quality::Limit> limits;
  if (!options.limits.empty()) {
    GONIO_ASSIGN(const std::string table, file_content(options.limits));
    GONIO_ASSIGN(limits, quality::parse_limits(table, options.limits));
  }
  GONIO_ASSIGN(std::vector<paint::Paint> paints, all_paints(options.standard, session));
  if (paints.empty()) return input_error("--standard {}: there is no paint in it", options.standard);
  for (paint::Paint& paint : paints) {
    const std::string name = paint.name;
    auto subject = quality::subject_of(std::move(paint));
    if (!subject.ok())
      return input_error("--standard {}: paint \"{}\": {}", options.standard, name, subject.error().message);
    std::vector<quality::Limit> own = limits;
    if (options.limits.empty()) {
      GONIO_ASSIGN(own, quality::limits_of(subject->paint));
    }
    standards_.push_back({std::move(*subject), std::move(own)});
  }
  return {};
}

Result<void> Standards::prepare_names(const Options& options) {
  for (std::size_t i = 0; i < standards_.size(); ++i) {
    const paint::Paint& paint = standards_[i].subject.paint;
    const std::string& key = pair_ == Pair::kCode ? paint.code : paint.name;
    if (pair_ == Pair::kCode && key.empty()) continue;
    if (!places_.try_emplace(key, i).second)
      return input_error("--standard {}: two standards have the {} \"{}\": rename one of them", options.standard,
                         pair_ == Pair::kCode ? "code" : "name", key);
  }
  return {};
}

Result<void> Standards::prepare_search() {
  std::size_t next = 0;
  GONIO_ASSIGN(library::LibraryIndex index,
               library::LibraryIndex::from_paints([&]() -> Result<std::optional<paint::Paint>> {
                 if (next == standards_.size()) return std::optional<paint::Paint>();
                 return std::optional(standards_[next++].subject.paint);
               }));
  index_ = std::make_unique<library::LibraryIndex>(std::move(index));
  search_ = std::make_unique<library::LibrarySearch>(
      *index_, library::LibrarySearchOptions{.count = 1, .metric = library::kDe00});
  return {};
}

bool Standards::has_limits() const {
  return std::ranges::any_of(standards_, [](const Standard& standard) { return !standard.limits.empty(); });
}

Result<const Standard*> Standards::of(const paint::Paint& sample) const {
  if (pair_ == Pair::kOne) return &standards_.front();
  if (pair_ == Pair::kNearest) {
    GONIO_ASSIGN(const library::SearchPlan plan, search_->plan(sample));
    const auto found = search_->nearest(plan);
    return &standards_[found.front().paint];
  }
  const bool by_code = pair_ == Pair::kCode;
  const auto found = places_.find(by_code ? sample.code : sample.name);
  if (found != places_.end()) return &standards_[found->second];
  if (by_code && sample.code.empty()) return input_error("it has no code by which to find its standard");
  return input_error("there is no standard of its {}{}: give one, or --pair", by_code ? "code " : "name",
                     by_code ? "\"" + sample.code + "\"" : "");
}

}  // namespace goniochrome::tool
