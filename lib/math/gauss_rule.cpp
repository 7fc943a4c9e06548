#include "math/gauss_rule.h"

namespace goniochrome::math {

GaussRule gauss_rule(int points, int pieces) {
  const GaussPoints& piece_rule = kGaussPoints[static_cast<std::size_t>(points) - 1];
  GaussRule rule;
  for (int piece = 0; piece < pieces; ++piece)
    for (int i = 0; i < points; ++i) {
      rule.at.push_back((piece + piece_rule.at[i]) / pieces);
      rule.weight.push_back(piece_rule.weight[i] / pieces);
    }
  return rule;
}

}  // namespace goniochrome::math
