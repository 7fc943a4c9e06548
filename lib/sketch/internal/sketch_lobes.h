// The samples for the search of a picture's paint, and the lobes that explain them best, whatever curve they make.
// goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <optional>
#include <vector>

#include "brdf/gloss.h"
#include "color/color.h"
#include "color/reflection.h"
#include "formats/basis.h"

namespace goniochrome::sketch {

// A lobe of peak 1 at an aspecular angle.
double lobe_at(double aspecular_deg, double exponent);

// Lab of a working-space color relative to white 1, as paints carry it.
color::Lab paint_lab(const color::Rgb& rgb);

// The weights of a paint found, in the order of the columns of SearchSamples: those for all views, and, where the paint
// has others for several views (paint::LobeFit::views), those at each of these angles of the viewer.
struct PaintWeights {
  std::vector<color::Rgb> all;
  std::vector<double> views_deg = {};  // ascending
  std::vector<std::vector<color::Rgb>> at_views = {};

  // Those that hold for a viewer at that angle from the normal are `low` and `share` of the way from there to `high`:
  // linear between two views, constant beyond the ends.
  struct Mixed {
    const std::vector<color::Rgb>*low, *high;
    double share;
  };
  Mixed mixed_at(double view_deg) const;
};

// The observed colors, and the light of each part of the lobe model with weight 1 (1/sr) there, all relative to white.
struct SearchSamples {
  std::size_t columns = 0;  // K_D, then K_DD and K_G of every lobe of the basis, then the mirror
  std::vector<Vec3> light;  // `columns` for each sample
  std::vector<color::Rgb> seen;
  std::vector<double> importance;     // of each sample; more than 0
  std::vector<double> view_deg = {};  // of each sample's viewer from the normal; none: weights for all views are shown
  std::optional<color::ReflectionOperator> reflection = {};  // as that of a SketchLight
  double coat_index = paint::kNoCoat;                        // of the coat through which K_D and K_DD are lit
  bool display = false;  // seen on an sRGB display, whose gamut is then part of the picture

  std::size_t size() const { return seen.size(); }
  const Vec3* columns_of(std::size_t sample) const { return &light[sample * columns]; }
  // The light of a sample as the picture could show it.
  color::Lab shown(const color::Rgb& rgb) const;
  // The color of the paint there.
  color::Lab shown_by(const PaintWeights& weights, std::size_t sample) const;
};

// The light that weights make of one sample's columns.
color::Rgb shown_light(const Vec3* columns, const std::vector<color::Rgb>& weights,
                       const std::optional<color::ReflectionOperator>& reflection);
color::Rgb shown_light(const Vec3* columns, const PaintWeights::Mixed& weights,
                       const std::optional<color::ReflectionOperator>& reflection);

// Writes, for each sample, the difference in Lab of what these weights show from `target`.
void differences(const SearchSamples& samples, const std::vector<color::Lab>& target, const PaintWeights& weights,
                 std::vector<double>& out);

// Gives lobes the gloss of a meter's reading as paints get it: a reading above what their coat reads asks for a coat of
// a higher index, which changes how the light is shared between the sharpest lobe and the mirror. The result is as it
// looks under the coat that they had. The lobes are all those of the table in its order, then the mirror, as
// lobes_of() makes them. Returns false, and changes nothing, where they cannot have that reading.
bool give_gloss(const brdf::GlossTable& table, double gloss_60_gu, paint::LobeFit& lobes);

struct FreeLobes {
  std::vector<color::Rgb> weights;  // in the order of the samples' columns
  double gloss_60_gu = 0;
  double cost = 0;  // as robust_cost()
};

// Finds the weights that explain the samples best. A picture is linear in the weights of its lobes, so that any start
// leads to them. Flake weights are free channel by channel; the gloss weights are those that the basis gives a meter's
// reading.
class FreeLobeFit {
 public:
  // The arguments must outlive it; `target` has the Lab of every sample.
  FreeLobeFit(const formats::Basis& basis, const brdf::GlossTable& gloss, const SearchSamples& samples,
              const std::vector<color::Lab>& target);

  // With gray gloss lobes of any weight.
  FreeLobes with_any_gloss() const;

  // The best over all values of gloss: the best of twenty, one of which with_any_gloss() finds, refined by sections.
  FreeLobes find() const;

  // The best from that start, with its gloss.
  FreeLobes refined(const FreeLobes& start) const;

  // The lobes with the best gloss about that of the start where the mirror has a share of it. Elsewhere gloss is known
  // to no better than a part of a unit, and a flat search would only drift.
  FreeLobes sharpened(const FreeLobes& start) const;

 private:
  struct Unknown {
    std::size_t column;
    int channel;  // 3: gray
  };
  std::vector<Unknown> unknowns(bool free_gloss) const;
  Vec3 effect(const Unknown& unknown, std::size_t sample) const;
  void set_gloss_of(double gloss, std::vector<color::Rgb>& weights) const;
  double cost(const std::vector<color::Rgb>& weights, std::vector<double>& differences) const;
  std::vector<color::Rgb> solved(const std::vector<color::Rgb>& at, const std::vector<double>& r, bool free_gloss,
                                 bool first) const;
  FreeLobes descend(std::vector<color::Rgb> weights, std::optional<double> gloss, bool first, int rounds) const;
  FreeLobes with_gloss(const FreeLobes& start, double gloss) const;
  FreeLobes between(double low, double high, FreeLobes least, int sections) const;

  const formats::Basis& basis_;
  const brdf::GlossTable& gloss_;
  const SearchSamples& samples_;
  const std::vector<color::Lab>& target_;
  std::size_t flake_lobes_ = 0;  // those that reach 15 deg
};

// Columns as lobes under such a coat, the mirror last, and back.
paint::LobeFit lobes_of(const formats::Basis& basis, const std::vector<color::Rgb>& weights, double coat_index);
std::vector<color::Rgb> weights_of(const formats::Basis& basis, const paint::LobeFit& lobes);

// The color that an instrument reads of a paint with these weights at an aspecular angle.
color::Lab instrument_lab(const formats::Basis& basis, const PaintWeights& weights, double coat_index,
                          double aspecular_deg);

// The weights of such lobes, and those of their views.
PaintWeights paint_weights(const formats::Basis& basis, const paint::LobeFit& lobes);

}  // namespace goniochrome::sketch
