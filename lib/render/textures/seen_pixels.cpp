#include "render/textures/seen_pixels.h"

#include <algorithm>

namespace goniochrome::render {

SeenBand::Bin& SeenBand::bin(std::size_t texture, int level) {
  const auto same = [&](const Bin& one) { return one.texture == texture && one.level == level; };
  const auto found = std::ranges::find_if(bins, same);
  return found != bins.end() ? *found : bins.emplace_back(Bin{texture, level, {}, {}});
}

void SeenBand::clear() {
  for (Bin& one : bins) one.points.clear(), one.texels.clear();
  bare.clear();
}

std::size_t SeenBand::bytes() const {
  std::size_t sum = bare.size() * sizeof(float);
  for (const Bin& one : bins) sum += one.points.size() * sizeof(Point) + one.texels.size() * sizeof(TexelShare);
  return sum;
}

void SeenPixels::begin(std::uint64_t layer, const Effects& effects, double scale, std::size_t count) {
  const Key key = {layer, effects.texture, effects.texture_filter, effects.texture_lobes, scale};
  again_ = key == key_ && bands_.size() == count && !forgotten_;
  forgotten_ = false;
  if (again_) return;
  key_ = key;
  bands_.resize(count), known_.assign(count, 0);
}

}  // namespace goniochrome::render
