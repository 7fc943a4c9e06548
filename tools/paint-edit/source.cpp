#include "source.h"

#include <utility>

namespace goniochrome::tool {

Result<std::optional<paint::Paint>> PaintSource::Input::next() {
  return first ? std::exchange(first, std::nullopt) : source->next();
}

Result<PaintSource> PaintSource::open(const std::vector<std::string>& inputs, cli::Session& session) {
  PaintSource source(session);
  for (const std::string& input : inputs.empty() ? std::vector<std::string>{"-"} : inputs) {
    GONIO_ASSIGN(formats::PaintSourcePointer paints, formats::open_paints(input));
    tell_warnings(paints->warnings(), session);
    Input opened{std::move(paints), std::nullopt};
    GONIO_ASSIGN(opened.first, opened.next());
    source.inputs_.push_back(std::move(opened));
  }
  return source;
}

Result<std::optional<paint::Paint>> PaintSource::next() {
  for (; current_ < inputs_.size(); ++current_) {
    GONIO_ASSIGN(std::optional<paint::Paint> paint, inputs_[current_].next());
    if (paint) return paint;
    tell_warnings(inputs_[current_].source->closing_warnings(), session_);
  }
  return std::optional<paint::Paint>();
}

Prolog PaintSource::prolog() {
  Prolog all;
  for (const Input& input : inputs_) all.take(*input.source);
  return all;
}

}  // namespace goniochrome::tool
