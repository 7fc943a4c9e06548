#include "stream_sink.h"

#include <utility>

#include "base/file.h"
#include "base/file_names.h"
#include "base/text.h"
#include "picture_file.h"

namespace goniochrome::tool {

namespace {

Result<void> show(const SinkSetup& setup, StreamSlot& slot) {
  return setup.display->show(slot.view.picture, setup.views.exposure.stops, slot.shown);
}

// The parts of an EXR file.
Result<std::vector<image::ImagePart>> scene_linear(const SinkSetup& setup, StreamSlot& slot) {
  render::Frame frame;
  std::swap(frame.picture, slot.view.picture);
  auto parts = exr_picture(setup.options, setup.request, frame, setup.stage.scene, setup.stage.dresses.front(),
                           *slot.plan, setup.views.exposure, nullptr, setup.session);
  std::swap(frame.picture, slot.view.picture);
  return parts;
}

// A file for each paint.
class FileSink : public StreamSink {
 public:
  FileSink(const SinkSetup& setup, FileNames names) : setup_(setup), names_(std::move(names)) {}

  Result<void> place(StreamSlot& slot) override {
    if (slot.source.failure) return {};
    slot.file = names_.next(slot.source.number, slot.source.paint.name, slot.source.paint.code);
    return {};
  }

  Result<void> finish(StreamSlot& slot) override {
    if (setup_.display == nullptr) return write_scene_linear(slot);
    GONIO_TRY(show(setup_, slot));
    image::Attributes text = provenance(setup_.session, setup_.display);
    text["goniochrome:paint"] = slot.source.paint.name;
    return write_file(slot.file, image::png_content(slot.shown, text));
  }

  Result<void> settle(StreamSlot& slot) override {
    files_ += slot.source.failure ? 0 : 1;
    return {};
  }
  std::size_t files() const override { return files_; }

 private:
  Result<void> write_scene_linear(StreamSlot& slot) const {
    GONIO_ASSIGN(const std::vector<image::ImagePart> picture, scene_linear(setup_, slot));
    return image::write_exr(slot.file, picture);
  }

  SinkSetup setup_;
  FileNames names_;
  std::size_t files_ = 0;
};

// Contact sheets, one of them in memory at a time.
class SheetSink : public StreamSink {
 public:
  SheetSink(const SinkSetup& setup, FileNames names, const PictureSize& size)
      : setup_(setup), names_(std::move(names)), size_(size), places_(size.width, size.height) {}

  bool looks_ahead() const override { return true; }

  Result<void> place(StreamSlot& slot) override {
    slot.place = places_.next(slot.source.paint.name, slot.source.follower);
    return {};
  }

  Result<void> finish(StreamSlot& slot) override { return show(setup_, slot); }

  Result<void> settle(StreamSlot& slot) override {
    if (sheet_ && slot.place.sheet != number_) {
      if (!names_.has("index"))
        return usage_error(
            "--output is \"{}\": there are more paints than a sheet of {} x {} has room for: write {{index}} into it, "
            "as in 'sheet-{{index}}.png'",
            setup_.options.output, size_.width, size_.height);
      GONIO_TRY(end());
    }
    if (!sheet_) sheet_.emplace(size_.width, size_.height, setup_.request.size.width, setup_.request.size.height);
    number_ = slot.place.sheet;
    const std::string name = slot.source.paint.name.empty() ? "?" : slot.source.paint.name;
    sheet_->put(slot.place.cell, slot.source.failure ? nullptr : &slot.shown,
                slot.source.failure ? name + ": failed" : name);
    return {};
  }

  Result<void> end() override {
    if (!sheet_) return {};
    const std::string content = image::png_content(sheet_->picture(), provenance(setup_.session, setup_.display));
    sheet_.reset();
    return write_file(names_.next(++files_, "", ""), content);
  }
  std::size_t files() const override { return files_; }

 private:
  SinkSetup setup_;
  FileNames names_;
  PictureSize size_;  // in cells
  image::SheetPlaces places_;
  std::optional<image::ContactSheet> sheet_;
  std::size_t number_ = 0, files_ = 0;
};

class FrameSink : public StreamSink {
 public:
  explicit FrameSink(const SinkSetup& setup) : setup_(setup), frames_(setup.options.to) {}

  Result<void> finish(StreamSlot& slot) override {
    if (setup_.display == nullptr) {
      GONIO_ASSIGN(std::vector<image::ImagePart> picture, scene_linear(setup_, slot));
      GONIO_ASSIGN(slot.content, exr_frame(std::move(picture)));
      return {};
    }
    GONIO_TRY(show(setup_, slot));
    slot.content = frames_.content(slot.shown);
    return {};
  }

  Result<void> settle(StreamSlot& slot) override {
    return slot.source.failure ? Result<void>() : frames_.write(slot.content, setup_.request.size);
  }
  std::size_t files() const override { return 0; }

 private:
  SinkSetup setup_;
  FrameOutput frames_;
};

}  // namespace

Result<std::unique_ptr<StreamSink>> stream_sink(const SinkSetup& setup) {
  const Options& options = setup.options;
  if (!options.to.empty()) return std::unique_ptr<StreamSink>(std::make_unique<FrameSink>(setup));
  const bool is_sheet = !options.sheet.empty();
  const std::vector<std::string> words =
      is_sheet ? std::vector<std::string>{"index"} : std::vector<std::string>{"name", "code", "index"};
  GONIO_ASSIGN(FileNames names, FileNames::create(options.output, words, "--output"));
  if (!is_sheet) return std::unique_ptr<StreamSink>(std::make_unique<FileSink>(setup, std::move(names)));
  constexpr int kMostCells = 64;
  const auto size = width_by_height(options.sheet, kMostCells);
  if (!size)
    return usage_error("--sheet is \"{}\": write COLSxROWS, 1x1 to {}x{}, as in 3x3", options.sheet, kMostCells,
                       kMostCells);
  return std::unique_ptr<StreamSink>(std::make_unique<SheetSink>(setup, std::move(names), *size));
}

}  // namespace goniochrome::tool
