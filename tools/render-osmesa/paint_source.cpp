#include "paint_source.h"

#include <utility>

#include "paints.h"

namespace goniochrome::tool {

Result<PaintSource> PaintSource::open(const Options& options) {
  GONIO_ASSIGN(auto fitter, fitter_of(options));
  GONIO_ASSIGN(formats::PaintReader reader, formats::PaintReader::open(options.paint));
  return PaintSource(std::move(reader), std::move(fitter), formats::paint_reference(options.paint).file);
}

bool PaintSource::next(bool look_ahead, SourcePaint& result) {
  Read read = ahead_ ? *std::exchange(ahead_, std::nullopt) : reader_.next();
  if (read.ok() && !read->has_value()) return false;
  result = {};
  result.number = ++count_;
  if (look_ahead) {
    ahead_ = reader_.next();
    if (ahead_->ok() && ahead_->value()) result.follower = (*ahead_)->value().name;
  }
  if (!read.ok()) {
    result.failure = read.error();
    return true;
  }
  result.paint = **std::move(read);
  const std::string name = result.paint.name;
  auto fitted = with_lobes(result.paint, fitter_ ? &*fitter_ : nullptr, file_ == "-" ? "standard input" : file_);
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

}  // namespace goniochrome::tool
