// The circle constant and the degree. Angles are in radians unless a name ends in _deg.
#pragma once

#include <numbers>

namespace goniochrome {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;  // one degree in radians: deg * kDegree, rad / kDegree

}  // namespace goniochrome
