// Maps hold what whole lobes gather. What a lobe gathers that the horizon cuts, each direction with its own cosine, is
// estimated from all the wide maps that a point looks up anyway: their weights are those of the best linear estimate in
// light of which nothing is known but how its variance falls with the degree of spherical harmonics, and even light
// comes out exact. goniochrome-rendering(7), "Horizon".
#pragma once

#include <memory>
#include <vector>

#include "color/color.h"
#include "render/internal/lobe_curves.h"

namespace goniochrome::render {

class HorizonMix {
 public:
  // The light that a paint sends by a lobe in even light of 1: weights times the integrals of internal/lobe_curves.h.
  struct Sent {
    color::Rgb flake, gloss;
  };
  struct Weights {
    std::vector<color::Rgb> lobes;  // of P_Ej(r + s n)
    std::vector<double> shifts;     // s
    color::Rgb diffuse;             // of the diffuse map at n
  };
  // The diffuse map that is looked up as well: none, or one of a base that is bare or under a coat.
  enum class Diffuse { kNone, kBare, kCoated };

  // For lobes of these exponents, ascending, under a coat of that index, at the views cos_o = (node/segments)^2.
  // With `fresnel` gloss has the reflectance of the coat in it.
  HorizonMix(const std::vector<double>& exponents, int segments, double coat_index, Diffuse diffuse, bool fresnel);

  // One for each exponent. A lobe looks where what its flakes and its gloss gather comes from, by their shares; by
  // flakes alone where it sends nothing.
  Weights at(const std::vector<Sent>& sent, int node) const;

 private:
  // A map, in units of what it holds of even light: of the lobe of an exponent under a coat.
  struct Kernel {
    double exponent, coat_index;
    auto operator<=>(const Kernel&) const = default;
  };
  class Zonal;
  struct Curve;

  static std::shared_ptr<const Zonal> covariance(const Kernel& a, const Kernel& b);
  std::shared_ptr<const Curve> curve(double exponent, std::size_t map) const;

  std::vector<double> exponents_;
  int segments_;
  double coat_index_;
  bool fresnel_;
  std::vector<std::shared_ptr<const LobeCurve>> looks_;    // of the lobes
  std::vector<Kernel> maps_;                               // those of the lobes, then the diffuse one
  std::vector<std::shared_ptr<const Zonal>> covariances_;  // of two maps
  std::vector<std::shared_ptr<const Curve>> curves_;       // of a lobe and a map
};

}  // namespace goniochrome::render
