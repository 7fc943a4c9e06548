#include "envmap/gauss_rule.h"

#include <array>

namespace goniochrome {

GaussRule gauss_rule(int points, int pieces) {
  constexpr std::array<std::array<double, 4>, 3> kAt = {
      {{.21132486540518713, .78867513459481287},
       {.1127016653792583, .5, .8872983346207417},
       {.06943184420297371, .33000947820757187, .66999052179242813, .93056815579702629}}};
  constexpr std::array<std::array<double, 4>, 3> kWeight = {
      {{.5, .5},
       {5.0 / 18, 8.0 / 18, 5.0 / 18},
       {.17392742256872693, .32607257743127307, .32607257743127307, .17392742256872693}}};
  GaussRule rule;
  for (int piece = 0; piece < pieces; ++piece)
    for (int i = 0; i < points; ++i) {
      rule.at.push_back((piece + kAt[points - 2][i]) / pieces);
      rule.weight.push_back(kWeight[points - 2][i] / pieces);
    }
  return rule;
}

}  // namespace goniochrome
