#include "in_time.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "image/shrink.h"

namespace goniochrome::tool {

namespace {

// A picture of so many pixels tells how long larger ones take. Measured up to 2560x1440, one round of samples takes the
// power 1.47 to 1.62 of the width.
constexpr double kSmall = 160 * 90, kGrowth = 1.55;
constexpr double kLeast_s = 1e-3;    // ends rays after one round
constexpr double kWorthLess = 1.15;  // times fewer pixels along each side save too little
constexpr double kWrite_s = 1e-7;    // to encode a pixel

// Times fewer pixels along each side, at most `most`, for a picture to take `left_s`, where that of `most` took
// `small_s`.
double shrink_for(double most, double small_s, double left_s) {
  if (!(left_s > 0)) return most;
  const double shrink = std::min(most, most * std::pow(small_s / left_s, 1 / kGrowth));
  return shrink < kWorthLess ? 1 : shrink;
}

}  // namespace

Result<void> TimedPictures::draw_smaller(render::Renderer& renderer, render::View view, double left_s,
                                         render::Frame& frame) {
  render::Effort effort = effort_;
  effort.time_limit_s = std::max(kLeast_s, left_s);
  renderer.set_effort(std::move(effort));
  for (int* side : {&view.width, &view.height}) *side = std::max(1, static_cast<int>(std::lround(*side / shrink_)));
  return renderer.draw(view, frame);
}

Result<void> TimedPictures::draw(render::Renderer& renderer, const render::View& view, double spent_s,
                                 std::shared_ptr<const render::Gbuffer> seen, render::Frame& frame) {
  const Stopwatch clock;
  const double pixels = static_cast<double>(view.width) * view.height;
  const double most_s = effort_.time_limit_s - spent_s - kWrite_s * pixels;
  const double most = std::sqrt(pixels / kSmall);
  bool is_drawn = false;
  if (shrink_ == 0 && most > kWorthLess) {
    shrink_ = most;
    GONIO_TRY(draw_smaller(renderer, view, 0, frame));
    shrink_ = shrink_for(most, 1e-3 * (frame.frame_ms - frame.maps.ms), most_s - clock.elapsed_s());
    is_drawn = shrink_ == most;
  }
  if (shrink_ == 0) shrink_ = 1;
  if (!is_drawn) GONIO_TRY(draw_smaller(renderer, view, most_s - clock.elapsed_s(), frame));
  enlarged_from_.reset();
  if (shrink_ == 1) return {};
  enlarged_from_ = {frame.picture.width, frame.picture.height};
  std::vector<image::Image*> pictures = {&frame.picture, &frame.centers, &frame.open_centers};
  if (frame.noise) pictures.push_back(&frame.noise->de00);
  for (image::Image* picture : pictures)
    if (!picture->data.empty()) *picture = image::enlarged(*picture, view.width, view.height);
  if (seen == nullptr) {
    GONIO_ASSIGN(seen, renderer.look(mesh_, view));
  }
  frame.gbuffer = std::move(seen);
  return {};
}

}  // namespace goniochrome::tool
