// Where the pictures of a stream go.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/clock.h"
#include "image/byte_image.h"
#include "image/sheet.h"
#include "paint_views.h"
#include "stream.h"

namespace goniochrome::tool {

// A paint on its way through the stages of a stream.
struct StreamSlot {
  SourcePaint source;
  Stopwatch clock;  // since the paint was there
  PaintView view;
  std::shared_ptr<const render::Plan> plan;
  std::string file;              // that the picture goes to
  image::SheetPlace place;       // on sheets
  image::ByteImage shown;        // the picture as a display shows it
  std::string content;           // of the file or frame
  std::optional<Error> stopped;  // ends the stream: a file cannot be written
};

class StreamSink {
 public:
  virtual ~StreamSink() = default;

  // In order, on one thread: where the picture goes. It is called for failed paints too.
  virtual Result<void> place(StreamSlot&) { return {}; }
  // The picture is there. Several threads may call it at once for different paints, of which none failed.
  virtual Result<void> finish(StreamSlot& slot) = 0;
  // In order, on one thread, after finish(). It is called for failed paints too.
  virtual Result<void> settle(StreamSlot&) { return {}; }
  // After the last paint.
  virtual Result<void> end() { return {}; }

  // True if it must know the name of the next paint to place one.
  virtual bool looks_ahead() const { return false; }
  // The number of files it wrote, for the report.
  virtual std::size_t files() const = 0;
};

// The data of the stream that a sink needs.
struct SinkSetup {
  const Options& options;
  const Request& request;
  const Stage& stage;
  const display::Display* display;  // null: scene-linear
  const PaintViews& views;
  const cli::Session& session;
};

// Error (usage): words in braces that the option does not take.
Result<std::unique_ptr<StreamSink>> stream_sink(const SinkSetup& setup);

}  // namespace goniochrome::tool
