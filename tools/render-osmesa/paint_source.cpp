#include "paint_source.h"

#include <utility>

namespace goniochrome::tool {

Result<PaintSource> PaintSource::open(const Options& options) {
  GONIO_ASSIGN(Fitting fitting, Fitting::of(options));
  formats::ImportOptions import;
  import.keep_going = true;  // a paint that fails is told, and the others are drawn
  GONIO_ASSIGN(formats::PaintSourcePointer reader, formats::open_paints(options.paint, import));
  return PaintSource(std::move(reader), std::move(fitting), formats::paint_reference(options.paint).file);
}

bool PaintSource::next(bool look_ahead, SourcePaint& result) {
  Read read = ahead_ ? *std::exchange(ahead_, std::nullopt) : reader_->next();
  if (read.ok() && !read->has_value()) return false;
  result = {};
  result.number = ++count_;
  if (look_ahead) {
    ahead_ = reader_->next();
    if (ahead_->ok() && ahead_->value()) result.follower = (*ahead_)->value().name;
  }
  if (!read.ok()) {
    result.failure = read.error();
    return true;
  }
  result.paint = **std::move(read);
  const std::string name = result.paint.name;
  auto fitted = with_lobes(result.paint, fitting_, file_ == "-" ? "standard input" : file_);
  if (fitted.ok()) {
    result.paint = *std::move(fitted);
    auto map = color_map_of(result.paint, file_);
    if (map.ok()) result.map = *std::move(map);
    if (!map.ok()) result.failure = about_paint(map.error(), name);
  } else {
    result.failure = fitted.error();
  }
  return true;
}

std::vector<std::string> PaintSource::remarks() const {
  std::vector<std::string> lines = reader_->warnings();
  const std::vector<std::string> closing = reader_->closing_warnings();
  lines.insert(lines.end(), closing.begin(), closing.end());
  return lines;
}

}  // namespace goniochrome::tool
