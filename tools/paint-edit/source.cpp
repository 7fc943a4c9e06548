#include "source.h"

#include <utility>

#include "formats/batches.h"

namespace goniochrome::tool {

Result<std::optional<paint::Paint>> PaintSource::Input::next() {
  if (first) return std::exchange(first, std::nullopt);
  for (;;) {
    GONIO_ASSIGN(std::optional<paint::Paint> paint, reader.next());
    if (!paint || !name || paint->name == *name) return paint;
  }
}

Result<PaintSource> PaintSource::open(const std::vector<std::string>& inputs) {
  PaintSource source;
  for (const std::string& input : inputs.empty() ? std::vector<std::string>{"-"} : inputs) {
    const auto [path, name] = formats::paint_reference(input);
    GONIO_ASSIGN(formats::PaintReader reader, formats::PaintReader::open(path));
    Input opened{path, name, std::move(reader), std::nullopt};
    GONIO_ASSIGN(opened.first, opened.next());
    if (name && !opened.first)
      return input_error("{}: no paint is named \"{}\": names are taken letter by letter", path, *name);
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
