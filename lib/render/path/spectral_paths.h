// Paths whose light and paints are in bands of wavelength: what the products of three channels are compared with.
// goniochrome-color(7), "LIGHT IN BANDS".
#pragma once

#include <vector>

#include "render/path/transport.h"
#include "render/spectra.h"

namespace goniochrome::render {

// One ray carries all bands: directions, places on lamps and the chance to go on are drawn by the mean over the bands,
// so that every band is weighed by the same density. Each path's light is summed in bands and then seen as a color.
class SpectralPaths {
 public:
  // The transport of a scene with spectra. `scene.environment` is null. Error: as Transport::create() has them; spectra
  // that are not those of the scene's parts, floor and lamps; a floor that shows an environment; textures.
  static Result<Transport> transport(const PathScene& scene);

  // The color of what the surface there emits.
  color::Rgb emitted(const rays::Spot& spot) const;
  // The mean of the samples first, first + 1, ... of the light that the surface reflects. The light of PathOptions's
  // `into_lobes` and `into_diffuse` is not told apart, and there is no `correction`.
  color::Rgb shown(const Transport& transport, const PathOptions& options, const rays::Spot& spot,
                   const rays::Float3& to_viewer, const Sequence& sequence, std::uint32_t first,
                   std::uint32_t count) const;

 private:
  // In floats, and one element for each band.
  using Carrier = std::array<float, color::kBands>;
  struct View {
    Carrier diffuse{}, mirror{};
    std::vector<Carrier> directional_diffuse, gloss;  // by the number of the lobe in the traced paint
  };
  using Paint = std::vector<View>;
  class Bands;
  static Paint laid_out(const paint::BandLobes& lobes, double gloss_deg, bool rough);
  void add_path(const Transport& transport, const PathOptions& options, const rays::Spot& spot,
                const rays::Float3& to_viewer, const Sequence& sequence, std::uint32_t index, Carrier& sum) const;
  const Carrier& emission(int part) const {
    return static_cast<std::size_t>(part) < emission_.size() ? emission_[static_cast<std::size_t>(part)] : kDark;
  }

  static constexpr Carrier kDark{};
  std::array<color::Rgb, color::kBands> eye_{};
  std::vector<Paint> paints_;  // of the parts, then of the floor
  std::vector<Carrier> emission_, lights_;
};

}  // namespace goniochrome::render
