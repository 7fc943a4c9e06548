// A BRDF in bands of wavelength at every combination of some angles of incidence, of exit and of azimuth between both.
// goniochrome-export(7), "OpenMATERIAL".
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"
#include "paint/band_lobes.h"

namespace goniochrome::materials {

class AngleTable {
 public:
  explicit AngleTable(const paint::BandLobes& paint);

  // Angles from the normal, of light and of viewers, and of the azimuth from the light to the viewer: 0 to pi, at which
  // the mirror direction is.
  static const std::vector<double>& polar_rad();
  static const std::vector<double>& azimuth_rad();

  // f linear in each of the three angles, and constant beyond the last of them.
  color::Bands at(const Vec3& to_light, const Vec3& to_viewer) const;

  // The rows [wavelength in m, incidence, exit, azimuth, f] in their order, one a line, without the comma behind the
  // last. A viewer along the normal has a single azimuth, 0.
  std::string rows() const;

 private:
  color::Bands& cell(std::size_t incidence, std::size_t exit, std::size_t azimuth);
  const color::Bands& cell(std::size_t incidence, std::size_t exit, std::size_t azimuth) const;
  void add_mirror(std::size_t polar, const color::Bands& weight, double coat_index);

  std::vector<color::Bands> cells_;
};

// A wavelength of a band in m, as the file writes it.
std::string meters(int band);

}  // namespace goniochrome::materials
