#include "source.h"

#include <utility>

namespace goniochrome::tool {

Result<std::optional<paint::Paint>> PaintSource::Input::next() {
  return first ? std::exchange(first, std::nullopt) : reader.next();
}

Result<PaintSource> PaintSource::open(const std::vector<std::string>& inputs) {
  PaintSource source;
  for (const std::string& input : inputs.empty() ? std::vector<std::string>{"-"} : inputs) {
    GONIO_ASSIGN(formats::PaintReader reader, formats::PaintReader::open(input));
    Input opened{std::move(reader), std::nullopt};
    GONIO_ASSIGN(opened.first, opened.next());
    source.inputs_.push_back(std::move(opened));
  }
  return source;
}

Result<std::optional<paint::Paint>> PaintSource::next() {
  for (; current_ < inputs_.size(); ++current_) {
    GONIO_ASSIGN(std::optional<paint::Paint> paint, inputs_[current_].next());
    if (paint) return paint;
  }
  return std::optional<paint::Paint>();
}

Prolog PaintSource::prolog() const {
  Prolog all;
  for (const Input& input : inputs_) all.take(input.reader);
  return all;
}

}  // namespace goniochrome::tool
