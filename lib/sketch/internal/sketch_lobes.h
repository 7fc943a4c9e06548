// The lobes that a picture shows, whatever curve they make. Internal to lib/fit. goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <optional>
#include <vector>

#include "brdf/gloss.h"
#include "formats/basis.h"
#include "sketch/internal/sketch_samples.h"

namespace goniochrome::sketch {

struct FreeLobes {
  std::vector<color::Rgb> weights;  // in the order of the samples' columns
  double gloss_60_gu = 0;
  double cost = 0;  // as robust_cost()
};

// A picture is linear in the weights of its lobes, so that the best weights are found from any start: flake weights
// channel by channel, gloss as a meter's reading makes it of the basis.
class FreeLobeFit {
 public:
  // All outlive it; `target` has the Lab of every sample.
  FreeLobeFit(const formats::Basis& basis, const brdf::GlossTable& gloss, const SearchSamples& samples,
              const std::vector<color::Lab>& target);

  // With gray gloss lobes of any weight.
  FreeLobes with_any_gloss() const;

  // Over all values of gloss: the best of some, one of them read off gray gloss lobes of any weight, refined.
  FreeLobes find() const;

  // From there, with gloss as it is.
  FreeLobes refined(const FreeLobes& start) const;

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

  const formats::Basis& basis_;
  const brdf::GlossTable& gloss_;
  const SearchSamples& samples_;
  const std::vector<color::Lab>& target_;
  std::size_t flake_lobes_ = 0;  // those that reach 15 deg
};

// Columns as lobes, the mirror last, and back.
paint::LobeFit lobes_of(const formats::Basis& basis, const std::vector<color::Rgb>& weights);
std::vector<color::Rgb> weights_of(const formats::Basis& basis, const paint::LobeFit& lobes);

}  // namespace goniochrome::sketch
