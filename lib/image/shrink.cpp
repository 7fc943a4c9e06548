#include "image/shrink.h"

#include <cstddef>

#include "base/parallel.h"

namespace goniochrome::image {

void shrink(const Image& from, int factor, Image& into) {
  into.width = from.width / factor, into.height = from.height / factor, into.channels = from.channels;
  into.channel_names = from.channel_names;
  const auto row = static_cast<std::size_t>(into.width) * static_cast<std::size_t>(into.channels);
  into.data.resize(row * static_cast<std::size_t>(into.height));
  const float share = 1.0F / static_cast<float>(factor * factor);
  parallel_for(static_cast<std::size_t>(into.height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < into.width; ++x) {
        float* pixel = into.pixel(x, y);
        for (int c = 0; c < into.channels; ++c) {
          float sum = 0;
          for (int v = 0; v < factor; ++v)
            for (int u = 0; u < factor; ++u) sum += from.pixel(factor * x + u, factor * y + v)[c];
          pixel[c] = share * sum;
        }
      }
    }
  });
}

}  // namespace goniochrome::image
