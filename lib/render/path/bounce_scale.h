// Bounced light was traced with the paints of that moment. Here it is scaled to other paints, to first order, with the
// error of that. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <memory>
#include <vector>

#include "color/reflection.h"
#include "render/path/lobe_transport.h"

namespace goniochrome::render {

struct BounceScale {
  bool changed = false;              // whether any paint is another than the one worn
  std::vector<color::Rgb> of_class;  // factor of each class of PaintGroups
  // The error of scaling, CIEDE2000 at the probes: the 95th percentile over all of them. Infinite where parts of one
  // group wear different paints now.
  double error_p95_de00 = 0;
};

// Asks many paints of one transport, which must outlive it: what the paints worn sent is summed up once.
class BounceScaler {
 public:
  // `reflection` null: channel by channel; it must be that of the tracing.
  BounceScaler(const LobeTransport& transport, const color::ReflectionOperator* reflection);
  BounceScaler(BounceScaler&&) noexcept;
  BounceScaler& operator=(BounceScaler&&) noexcept;
  ~BounceScaler();

  // The scale as of bounce_scale(). Bit-identical for any number of threads. Not for several threads at once.
  BounceScale scale(const std::vector<std::vector<color::Rgb>>& weights);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// For paints `weights` (by part, then by column, as column_weights() has them), of as many parts as the transport has.
// `reflection` as BounceScaler takes it.
BounceScale bounce_scale(const LobeTransport& transport, const std::vector<std::vector<color::Rgb>>& weights,
                         const color::ReflectionOperator* reflection);

// The factor of a point's bounced light: the mean over its classes; without lobes, that of floor_class().
color::Rgb bounce_factor(const LobeTransport& transport, std::size_t point, const BounceScale& scale);

}  // namespace goniochrome::render
