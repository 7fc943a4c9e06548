#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

namespace {

constexpr int kReach = 8;                 // pixels
constexpr std::size_t kMostEdges = 8000;  // looked at
constexpr double kBetter = 1.1;           // than no shift, or none is suggested

// How strong the edge at a pixel is: the larger neighboring difference of the square roots of luminance, which cut no
// more than 0.3 short, so that one glaring edge does not outvote all others.
template <class Luminance>
float edge(const Luminance& luminance, int x, int y) {
  const float here = luminance(x, y);
  return std::min(0.3F, std::max(std::abs(luminance(x + 1, y) - here), std::abs(luminance(x, y + 1) - here)));
}

struct Edge {
  float strength;
  int x, y;
};

}  // namespace

// The strongest edges of the original are looked for in the edited picture; what counts is how strong it is there.
SketchShift sketch_shift(const SketchInput& input) {
  const image::Image &buffers = input.buffers->image, &edited = input.edited->rgb;
  const double white = input.buffers->white_luminance;
  const double gain_was = std::exp2(-input.buffers->exposure_stops) / white, gain_is = input.gain / white;
  const auto root = [](const float* p, double gain) {
    return std::sqrt(static_cast<float>(gain) * std::max(0.0F, 0.26F * p[0] + 0.68F * p[1] + 0.06F * p[2]));
  };
  const auto was = [&](int x, int y) { return root(buffers.pixel(x, y), gain_was); };
  const auto is = [&](int x, int y) { return root(edited.pixel(x, y), gain_is); };
  std::vector<Edge> edges;
  const int border = kReach + 1;
  for (int y = border; y < buffers.height - border; y += 2)
    for (int x = border + (y & 2) / 2; x < buffers.width - border; x += 2)
      if (const float strength = edge(was, x, y); strength > 0.03F) edges.push_back({strength, x, y});
  if (edges.size() > kMostEdges) {
    std::nth_element(edges.begin(), edges.begin() + kMostEdges, edges.end(),
                     [](const Edge& a, const Edge& b) { return a.strength > b.strength; });
    edges.resize(kMostEdges);
  }
  constexpr int kSide = 2 * kReach + 1;
  std::vector<double> agreement(kSide * kSide, 0);
  parallel_for(agreement.size(), kSide, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int dx = static_cast<int>(i % kSide) - kReach, dy = static_cast<int>(i / kSide) - kReach;
      for (const Edge& e : edges) agreement[i] += e.strength * edge(is, e.x + dx, e.y + dy);
    }
  });
  SketchShift best;
  double most = kBetter * agreement[kReach * kSide + kReach];
  for (int i = 0; i < kSide * kSide; ++i)
    if (agreement[i] > most) most = agreement[i], best = {i % kSide - kReach, i / kSide - kReach};
  return best;
}

}  // namespace goniochrome::sketch
