// Surfaces behind panes, as engines that shade G-buffers draw them. goniochrome-coats(7), "PANES".
#pragma once

#include <memory>
#include <vector>

#include "render/engine.h"
#include "render/panes.h"

namespace goniochrome::render {

// A view of what lies behind panes. It must outlive neither of the arguments.
class BehindSight : public Sight {
 public:
  BehindSight(const BehindPanes& behind, const SurfaceLayer* layer);
  std::shared_ptr<const Gbuffer> gbuffer(int) override { return gbuffer_; }
  const std::vector<TexturePlace>& places(int) override { return places_; }
  const GlContext* gl() const override { return nullptr; }

 private:
  std::shared_ptr<const Gbuffer> gbuffer_;  // which another owns
  std::vector<TexturePlace> places_;
};

// Adds `gain` times what is shown behind panes, radiance and coverage, to the picture.
void add_behind(const BehindPanes& behind, const image::Image& shown, float gain, image::Image& picture);

// Takes from the picture `gain` times the coverage that panes have in full and let through.
void uncover(const BehindPanes& behind, float gain, image::Image& picture);

}  // namespace goniochrome::render
