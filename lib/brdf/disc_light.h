// Light from a disc of even radiance, such as the sun or a lamp, and what a cosine lobe gathers of it.
// goniochrome-rendering(7), "LAMPS".
#pragma once

#include <array>
#include <memory>
#include <vector>

namespace goniochrome::brdf {

// The angular radius of a disc goes up to that of the hemisphere.
constexpr double kWidestDisc_rad = 1.5707963267948966;

// The angular diameter of the sun: what a lamp has unless it says otherwise.
constexpr double kSunExtent_deg = 0.53;

// All integrals here are relative to pi sin^2(radius), which is what a disc of radiance 1 gives to a surface that faces
// it, so that they go over into those of a point where the disc shrinks.

// The irradiance on a surface whose normal has the cosine `cosine` (-1..1) to the middle of the disc: the cosine itself
// where all of the disc is above the horizon, 0 where none of it is, and in between the integral over the part above.
// The relative error is below 1e-6 of the value in the middle of the disc. radius_rad in 0..kWidestDisc_rad.
double disc_irradiance(double cosine, double radius_rad);

// The part of the disc's solid angle that is above the horizon.
double disc_above(double cosine, double radius_rad);

// The light that a lobe cos^E about a direction r gathers of the disc about the direction l, horizon apart:
//   power = integral of cos^E,   integral of cos^E times the direction = by_light l + by_mirror r
// with both directions unit, and r the mirror direction. cos^E is 0 beyond 90 degrees.
struct LobeOfDisc {
  double power = 0, by_light = 0, by_mirror = 0;
};

// For exponents of 0..1e6, radii of 0..kWidestDisc_rad and 0..pi between both directions; relative error of `power`
// below 1e-7 of its largest value. A radius of 0 is a point.
LobeOfDisc lobe_of_disc(double exponent, double radius_rad, double between_rad);

// The rings about r that lie within the disc, as far as the lobe counts there: those up to `whole` with all of their
// circumference, and of those from `first` on, over `width`, an arc to both sides of the direction to l.
struct DiscRings {
  double whole = 0, first = 0, width = 0;
  double radius_rad = 0, between_rad = 0, crossing = 0;
  // Half of the angle of the arc at first + share * width.
  double half_arc(double share) const;
};
DiscRings disc_rings(double exponent, double radius_rad, double between_rad);

// The radiance that a mirror sees within the disc, again relative: 1/(pi sin^2(radius)). Infinite for a point.
double disc_radiance(double radius_rad);

// lobe_of_disc() at even steps of the chord |l - r|, for kernels that look it up many times. Beyond the last node the
// lobe gathers nothing; before the first one it gathers what it gathers there. Linear interpolation errs by less than
// 5e-5 of the largest value for exponents of 1 and more; a smaller one ends too steeply at 90 degrees.
struct DiscLobeTable {
  // The product of a lobe and the horizon and the coat, which change slowly, is split between both directions:
  //   integral of cos_i cos^E about 0.. = cosine[0] disc_irradiance(n.l) + cosine[1] n.r
  //   integral of F cos^E = plain[0] disc_above(n.l) F(l) + plain[1] F(r)
  struct Node {
    float cosine[2] = {0, 0}, plain[2] = {0, 0};
  };
  static constexpr int kNodes = 1024;
  double first_chord = 0, nodes_per_chord = 0;
  std::vector<Node> nodes;  // kNodes, and the last one once more

  Node at(double chord) const;
  // Beyond it the lobe gathers nothing.
  double last_chord() const { return first_chord + (kNodes - 1) / nodes_per_chord; }
};

// disc_irradiance() and disc_above() where the horizon cuts the disc: at even steps of the elevation of its middle,
// relative to its radius, from -1 to 1. Linear interpolation errs by less than 1e-4 of the largest value; by the sine
// of the elevation it would err by .005 for half of the sphere.
struct DiscHorizonTable {
  static constexpr int kNodes = 1024;
  std::vector<std::array<float, 2>> nodes;  // kNodes, and the last one once more

  // `part` is that elevation, -1..1: irradiance and part.
  std::array<float, 2> at(float part) const {
    const float x = 0.5F * (part + 1) * (kNodes - 1);
    const auto node = static_cast<std::size_t>(x);
    const float t = x - static_cast<float>(node);
    return {nodes[node][0] + t * (nodes[node + 1][0] - nodes[node][0]),
            nodes[node][1] + t * (nodes[node + 1][1] - nodes[node][1])};
  }
};
// Kept as those of lobes are.
std::shared_ptr<const DiscHorizonTable> disc_horizon_table(double radius_rad);

// The node of the table at that chord, computed.
DiscLobeTable::Node disc_lobe_node(double exponent, double radius_rad, double chord);

// The table of this lobe and disc. Tables are kept, so that asking again costs nothing. Any number of threads.
std::shared_ptr<const DiscLobeTable> disc_lobe_table(double exponent, double radius_rad);
// The value of that table at a chord. Each thread remembers the tables that it asked for last, so that asking at every
// point of a picture waits for no other thread.
DiscLobeTable::Node disc_lobe(double exponent, double radius_rad, double chord);

}  // namespace goniochrome::brdf
