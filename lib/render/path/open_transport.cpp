#include "render/path/open_transport.h"

#include "base/parallel.h"

namespace goniochrome::render {

LobeTransport open_transport(const OpenLight& light, const LobeColumns& columns, const WornPaints& worn,
                             const std::vector<std::shared_ptr<const Gbuffer>>& samples) {
  LobeTransport t;
  const std::size_t width = static_cast<std::size_t>(samples.front()->width),
                    of_sample = width * static_cast<std::size_t>(samples.front()->height);
  t.width = samples.front()->width, t.height = samples.front()->height * static_cast<int>(samples.size());
  t.columns = columns, t.worn = worn;
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (std::size_t i = 0; i < of_sample; ++i) {
      const float part = samples[s]->data[4 * i + 3];
      if (part == 0) continue;
      t.places.push_back(static_cast<std::uint32_t>(s * of_sample + i));
      t.part.push_back(static_cast<int>(std::abs(part)) - 1);
    }
  t.make_room();
  parallel_for(t.places.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<VisiblePoint> points;
    for (std::size_t k = begin; k < end; ++k) {
      const Gbuffer& seen = *samples[t.places[k] / of_sample];
      const std::size_t pixel = t.places[k] % of_sample;
      const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
      points.push_back({.normal = seen.normal(x, y), .to_viewer = seen.to_viewer(x, y), .part = t.part[k]});
    }
    std::vector<color::Rgb> gathered(points.size() * columns.count());
    light.look_up(points, gathered.data());
    for (std::size_t n = 0; n < gathered.size(); ++n)
      for (std::size_t c = 0; c < 3; ++c)
        t.direct[n % columns.count()][3 * (begin + n / columns.count()) + c] =
            static_cast<float>(gathered[n][static_cast<int>(c)]);
  });
  return t;
}

void put_mean(const image::Image& stacked, int count, image::Image& picture) {
  picture.width = stacked.width, picture.height = stacked.height / count, picture.channels = 4;
  picture.channel_names = {"R", "G", "B", "A"};
  const std::size_t floats = stacked.data.size() / static_cast<std::size_t>(count);
  picture.data.resize(floats);
  const float gain = 1.0F / static_cast<float>(count);
  parallel_each(floats, std::size_t{1} << 15, [&](std::size_t i) {
    float sum = 0;
    for (int s = 0; s < count; ++s) sum += stacked.data[static_cast<std::size_t>(s) * floats + i];
    picture.data[i] = gain * sum;
  });
}

}  // namespace goniochrome::render
