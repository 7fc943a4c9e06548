// Constants of Cauchy's weights, by which outliers of a sketch lose their say.
#pragma once

namespace goniochrome::sketch {

inline constexpr double kSigmas = 1.4826;  // median absolute deviation to standard deviation
inline constexpr double kTuning = 2.385;   // 95 % as good as least squares for normal noise
inline constexpr double kLeastScale = 1;   // dE00 or L*; a residual that the paint or curve cannot follow is no outlier

}  // namespace goniochrome::sketch
