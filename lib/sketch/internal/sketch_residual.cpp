#include "sketch/internal/sketch_residual.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "math/statistics.h"
#include "sketch/internal/view_angles.h"

namespace goniochrome::sketch {

namespace {

constexpr double kResidualBin_deg = 10;

// The angle that a residual goes by: from specular where lamps alone light the picture, else of the viewer.
class ResidualAngle {
 public:
  explicit ResidualAngle(const image::AovFile& buffers) : buffers_(buffers), views_(buffers) {
    const auto aspecular = buffers.channel("aspecular");
    if (buffers.environment.empty() && aspecular.ok()) aspecular_ = *aspecular;
  }
  std::string name() const { return aspecular_ >= 0 ? "aspecular" : views_.are_known() ? "view" : ""; }
  double at(std::uint32_t place) const {
    if (aspecular_ < 0) return views_.at(place);
    return buffers_.image.data[static_cast<std::size_t>(place) * buffers_.image.channels + aspecular_];
  }

 private:
  const image::AovFile& buffers_;
  const ViewAngles views_;
  int aspecular_ = -1;
};

AngleResidual residual_of(int bin, const std::vector<PixelPair>& pixels) {
  AngleResidual residual{kResidualBin_deg * bin, kResidualBin_deg * (bin + 1), pixels.size(), 0, {}};
  std::vector<double> de76;
  for (const PixelPair& pixel : pixels) {
    de76.push_back(pixel.de76());
    residual.mean.L += pixel.seen.L - pixel.shown.L;
    residual.mean.a += pixel.seen.a - pixel.shown.a;
    residual.mean.b += pixel.seen.b - pixel.shown.b;
  }
  const double share = 1 / static_cast<double>(pixels.size());
  residual.mean.L *= share, residual.mean.a *= share, residual.mean.b *= share;
  residual.median_de76 = math::median(std::move(de76));
  return residual;
}

}  // namespace

void take_residual(const image::AovFile& buffers, const std::vector<std::uint32_t>& used,
                   const std::function<PixelPair(std::size_t i)>& pair, bool all, SketchFit& fit) {
  constexpr std::size_t kJudged = 20000;
  const std::size_t step = all ? 1 : std::max<std::size_t>(1, used.size() / kJudged);
  const ResidualAngle angle(buffers);
  fit.residual_angle = angle.name(), fit.residual.clear(), fit.pixels.clear();
  std::map<int, std::vector<PixelPair>> bins;
  std::vector<double> de76;
  double squares = 0;
  for (std::size_t i = 0; i < used.size(); i += step) {
    const PixelPair pixel = pair(i);
    const double apart = pixel.de76();
    de76.push_back(apart), squares += apart * apart;
    if (all) fit.pixels.push_back(pixel);
    if (fit.residual_angle.empty()) continue;
    if (const double at = angle.at(used[i]); std::isfinite(at))
      bins[static_cast<int>(at / kResidualBin_deg)].push_back(pixel);
  }
  if (de76.empty()) return;
  fit.rms_de76 = std::sqrt(squares / static_cast<double>(de76.size()));
  fit.median_de76 = math::median(std::move(de76));
  for (const auto& [bin, pixels] : bins) fit.residual.push_back(residual_of(bin, pixels));
}

}  // namespace goniochrome::sketch
