// One view of one mesh in the paints of a stream: what does not depend on the paints is made once.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "paint_source.h"
#include "render/exact.h"
#include "render/renderer.h"
#include "request.h"
#include "sight.h"
#include "stage.h"
#include "transport_view.h"

namespace goniochrome::tool {

// A picture of a paint, as far as it was shaded.
struct PaintView {
  image::Image picture;  // R G B A
  double shading_ms = 0;
  double bounced_de00_p95 = 0;  // what scaling bounced light errs by, with a transport
};

// The parts that the paints of a stream are put on: those that nothing else dresses.
std::vector<std::size_t> free_parts(const DressedMesh& dress);

// The dress of a stream, whose free parts wear one paint after the other.
class Wardrobe {
 public:
  explicit Wardrobe(const DressedMesh& base);
  const DressedMesh& in(const SourcePaint& paint);

 private:
  DressedMesh dress_;
  std::vector<std::size_t> parts_;
  std::shared_ptr<const brdf::ColorMap> map_;  // that the dress refers to
};

class PaintViews {
 public:
  virtual ~PaintViews() = default;

  // Draws the stage in the paint, on every part that nothing else dresses. The picture's memory is used again. Error:
  // the paint cannot be shown.
  virtual Result<void> draw(const SourcePaint& paint, PaintView& view) = 0;

  std::shared_ptr<const render::Plan> plan = std::make_shared<render::Plan>();  // of the picture that was drawn last
  Exposure exposure;
  double gbuffer_ms = 0;
};

// From the transport of the stage, which has one.
class TransportViews : public PaintViews {
 public:
  TransportViews(const Options& options, const Request& request, Stage& stage, cli::Session& session);

  Result<void> draw(const SourcePaint& paint, PaintView& view) override;

  // Draws the paints of this dress. The report gets the figures.
  Result<ShadedPaint> show(const DressedMesh& dress, image::Image& picture);

 private:
  cli::Session& session_;
  int points_across_;
  Wardrobe wardrobe_;
  ViewShader shader_;
  image::Image points_;  // what all points show, where pixels are squares of them
  bool is_coat_told_ = false;
};

// From the transport of the stage where it has one, else by an engine. The first dress of the stage has what --part,
// --trim and --texture put on. Error: nothing is left for the paints; what the engine lacks.
Result<std::unique_ptr<PaintViews>> paint_views(const Options& options, const Request& request, Stage& stage,
                                                cli::Session& session);

// Draws the paints of a stream from light by lobes that is looked up once, in a few milliseconds. Paints that it cannot
// show (brushed ones, color maps, lobes that the environment lacks) are left to `others`. Coats are taken with an index
// that is rounded to 1/50, and the base under them is scaled to look the same at 45 degrees. Returns `others` where the
// view cannot be kept as light by lobes, which takes an environment alone, nothing on the mesh that is no sum of lobes,
// no engine asked for but cpu, and samples whose light takes less than 100 MB.
std::unique_ptr<PaintViews> open_views(const Options& options, const Request& request, Stage& stage,
                                       cli::Session& session, std::unique_ptr<PaintViews> others);

}  // namespace goniochrome::tool
