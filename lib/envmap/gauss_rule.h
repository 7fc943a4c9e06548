// Gauss-Legendre rules on 0..1, in equal pieces.
#pragma once

#include <vector>

namespace goniochrome {

struct GaussRule {
  std::vector<double> at, weight;
};

// `pieces` equal parts of 0..1 with 2 to 4 points each.
GaussRule gauss_rule(int points, int pieces);

}  // namespace goniochrome
