#include "paint/band_lobes.h"

namespace goniochrome::paint {

LobeFit mean_lobes(const BandLobes& bands) {
  const auto gray = [](const color::Bands& values) { return color::mean(values) * color::Rgb{1, 1, 1}; };
  LobeFit fit;
  fit.coat_index = bands.coat_index;
  for (const BandWeights& weights : bands.views) {
    ViewLobes view{weights.view_deg, gray(weights.diffuse), {}};
    for (std::size_t j = 0; j < bands.exponents.size(); ++j)
      view.lobes.push_back({bands.exponents[j], gray(weights.directional_diffuse[j]), gray(weights.gloss[j])});
    const color::Rgb mirror = gray(weights.mirror);
    if (mirror != color::Rgb{}) view.lobes.push_back({kMirrorExponent, {}, mirror});
    fit.views.push_back(std::move(view));
  }
  if (fit.views.empty()) return fit;
  fit.diffuse = fit.views.front().diffuse;
  fit.lobes = fit.views.front().lobes;
  if (fit.views.size() == 1) fit.views.clear();
  return fit;
}

}  // namespace goniochrome::paint
