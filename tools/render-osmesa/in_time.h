// Pictures within a time limit: where it is too short for all pixels, fewer are drawn and enlarged.
// goniochrome-plan(7), "Time limits".
#pragma once

#include <memory>
#include <optional>

#include "render/renderer.h"
#include "setup.h"

namespace goniochrome::tool {

class TimedPictures {
 public:
  // They show this mesh, and the limit is that of the effort.
  TimedPictures(const mesh::Mesh& mesh, render::Effort effort) : mesh_(mesh), effort_(std::move(effort)) {}

  // Draws a picture that began so many seconds ago. `seen`: its G-buffer, if that is known. All pictures have as many
  // pixels as there was time for in the first.
  Result<void> draw(render::Renderer& renderer, const render::View& view, double spent_s,
                    std::shared_ptr<const render::Gbuffer> seen, render::Frame& frame);
  // The size of the last picture, which was enlarged; none where all pixels were drawn.
  const std::optional<PictureSize>& enlarged_from() const { return enlarged_from_; }

 private:
  Result<void> draw_smaller(render::Renderer& renderer, render::View view, double left_s, render::Frame& frame);

  const mesh::Mesh& mesh_;
  render::Effort effort_;
  double shrink_ = 0;  // how many times fewer pixels each side has; 0: not known yet
  std::optional<PictureSize> enlarged_from_;
};

}  // namespace goniochrome::tool
