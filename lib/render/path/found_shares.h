// The change of a picture by each share of the light, by its first round of samples, and the shares that need no more.
// goniochrome-plan(7), "Effects of rays".
#pragma once

#include <array>
#include <iterator>
#include <vector>

#include "render/path/transport.h"

namespace goniochrome::render {

// Sets of shares are bits, in the order of kShares.
constexpr std::size_t kShareCount = std::size(kShares);
constexpr unsigned kAllShares = (1U << kShareCount) - 1;
color::Rgb sum_of(const LightShares& shares, unsigned bits);

// Some point of a picture: what it shows is the sum of both.
struct SharedPoint {
  LightShares shares;
  color::Rgb base;
};

struct FoundShare {
  double de00_p95 = 0;   // that leaving it out changes; of direct light, with what is passed on
  bool stopped = false;  // whether the first round was its last
};

struct FoundShares {
  std::array<FoundShare, kShareCount> of;
  unsigned stopped = 0;
  double stopped_de00 = 0;  // what leaving out all of these changes, noise and all
};

// `points` have the noise of the first round, and `smooth` are means over their neighborhoods, which have little. The
// shares that together change no more than `stop_de00`, noise and all, stop.
FoundShares found_shares(const std::vector<SharedPoint>& points, const std::vector<SharedPoint>& smooth,
                         double stop_de00, double white_luminance);

}  // namespace goniochrome::render
