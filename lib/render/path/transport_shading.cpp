#include "render/path/transport_shading.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "math/elementary.h"
#include "render/path/transport_kernel.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kBlocksAtOnce = 64;

// The largest magnitude of each of `stride` values of a point.
std::vector<float> largest_of(const std::vector<float>& values, std::size_t stride) {
  constexpr std::size_t kPointsAtOnce = 8192;
  if (stride == 0) return {};
  const std::size_t points = values.size() / stride, chunks = (points + kPointsAtOnce - 1) / kPointsAtOnce;
  std::vector<std::vector<float>> of_chunk(chunks, std::vector<float>(stride, 0));
  parallel_for(points, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<float>& largest = of_chunk[begin / kPointsAtOnce];
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < stride; ++k) largest[k] = std::max(largest[k], std::abs(values[i * stride + k]));
  });
  std::vector<float> largest(stride, 0);
  for (const std::vector<float>& chunk : of_chunk)
    for (std::size_t k = 0; k < stride; ++k) largest[k] = std::max(largest[k], chunk[k]);
  return largest;
}

// The power of two, 1 or less, that brings these values within the range of halves.
float half_scale(float largest) {
  constexpr float kMostHalf = 65504;
  float scale = 1;
  while (largest * scale >= kMostHalf) scale /= 2;
  return scale;
}

}  // namespace

// Blocks of kTransportLanes points of one part; those with bounced light apart from those without. The last of each
// kind is filled up with its last point.
struct TransportShader::State {
  struct Block {
    int part = 0;
    std::size_t direct = 0, bounced = 0;  // number of the block among those that have such light
    bool is_bounced = false;
    std::uint32_t points[kTransportLanes] = {};
    std::uint32_t count = 0;
  };
  std::size_t columns = 0, classes = 0, mirror = 0;
  float unit = 1;
  std::vector<Block> blocks;
  std::vector<float> scales;                               // of the columns, whose light is kept times these
  std::vector<std::uint16_t> direct, bounced, of_classes;  // halves
  std::vector<std::uint32_t> places;
  std::vector<float> view_deg;
  std::vector<color::Rgb> emission;  // by part

  void gather(const LobeTransport& t);
  void lay_out(const LobeTransport& t);
};

void TransportShader::State::gather(const LobeTransport& t) {
  const std::size_t points = t.places.size(), floats = t.floats();
  std::vector<std::vector<std::uint32_t>> kinds;  // part and whether light bounces there
  std::size_t direct_blocks = 0, bounced_blocks = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const float* light = &t.bounced[i * floats];
    const bool lit = std::any_of(light, light + floats, [](float value) { return value != 0; });
    const std::size_t kind = 2 * static_cast<std::size_t>(t.part[i]) + (lit ? 1 : 0);
    if (kind >= kinds.size()) kinds.resize(kind + 1);
    kinds[kind].push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (std::size_t first = 0; first < kinds[kind].size(); first += kTransportLanes) {
      Block block;
      block.part = static_cast<int>(kind / 2), block.is_bounced = kind % 2 == 1;
      block.direct = direct_blocks++, block.bounced = block.is_bounced ? bounced_blocks++ : 0;
      block.count = static_cast<std::uint32_t>(std::min(kTransportLanes, kinds[kind].size() - first));
      for (std::size_t k = 0; k < kTransportLanes; ++k)
        block.points[k] = kinds[kind][std::min(first + k, kinds[kind].size() - 1)];
      blocks.push_back(block);
    }
  }
}

void TransportShader::State::lay_out(const LobeTransport& t) {
  scales.assign(columns, 1);
  for (const std::vector<float>* light : {&t.direct, &t.bounced}) {
    const std::vector<float> largest = largest_of(*light, t.floats());
    for (std::size_t k = 0; k < columns; ++k)
      scales[k] = std::min(scales[k], half_scale(*std::max_element(&largest[3 * k], &largest[3 * k] + 3)));
  }
  // Classes are factors of a mean, which no common scale changes.
  const std::vector<float> of_classes_largest = largest_of(t.classes, 3 * classes);
  const float largest_class = of_classes_largest.empty() ? 0 : *std::ranges::max_element(of_classes_largest);
  const std::vector<float> of_class(classes, half_scale(largest_class));
  std::size_t bounced_blocks = 0;
  for (const Block& block : blocks) bounced_blocks += block.is_bounced ? 1 : 0;
  const auto spread = [&](const std::vector<float>& from, const std::vector<float>& scale, bool all,
                          std::vector<std::uint16_t>& half) {
    const std::size_t stride = 3 * scale.size(), size = stride * kTransportLanes;
    half.resize((all ? blocks.size() : bounced_blocks) * size);
    parallel_for(blocks.size(), kBlocksAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const Block& block = blocks[b];
        if (!all && !block.is_bounced) continue;
        std::uint16_t* to = half.data() + (all ? block.direct : block.bounced) * size;
        for (std::size_t lane = 0; lane < kTransportLanes; ++lane)
          for (std::size_t k = 0; k < stride; ++k)
            to[k * kTransportLanes + lane] = Imath::half(scale[k / 3] * from[block.points[lane] * stride + k]).bits();
      }
    });
  };
  spread(t.direct, scales, true, direct);
  spread(t.bounced, scales, false, bounced);
  spread(t.classes, of_class, false, of_classes);
}

Result<TransportPaint> transport_paint(const LobeColumns& columns, const paint::LobeFit& paint, double gloss_deg) {
  TransportPaint result;
  if (paint.views.empty()) {
    GONIO_ASSIGN(auto weights, column_weights(columns, paint.diffuse, paint.lobes, gloss_deg));
    result.view_deg = {0}, result.weights.push_back(std::move(weights));
  }
  for (const paint::ViewLobes& view : paint.views) {
    GONIO_ASSIGN(auto weights, column_weights(columns, view.diffuse, view.lobes, gloss_deg));
    result.view_deg.push_back(view.view_deg), result.weights.push_back(std::move(weights));
  }
  return result;
}

std::vector<float> view_angles_deg(const LobeTransport& t, const std::vector<const Gbuffer*>& samples) {
  const auto wide = static_cast<std::uint32_t>(samples.front()->width),
             of_sample = wide * static_cast<std::uint32_t>(samples.front()->height);
  std::vector<float> angles(t.places.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const Gbuffer& seen = *samples[t.places[i] / of_sample];
    const auto x = static_cast<int>(t.places[i] % wide), y = static_cast<int>(t.places[i] % of_sample / wide);
    const Vec3 n = seen.normal(x, y), v = seen.to_viewer(x, y);
    angles[i] = static_cast<float>(math::atan2(length(cross(n, v)), dot(n, v)) / kDegree);
  }
  return angles;
}

TransportShader::TransportShader(const LobeTransport& t, std::vector<float> view_deg)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.columns = t.columns.count(), s.mirror = t.columns.mirror(), s.classes = t.worn.groups.classes(),
  s.unit = static_cast<float>(t.unit);
  s.emission = t.worn.emission, s.emission.resize(t.worn.groups.of_part.size());
  s.places = t.places, s.view_deg = std::move(view_deg);
  s.gather(t);
  s.lay_out(t);
}
TransportShader::~TransportShader() = default;

std::size_t TransportShader::bytes() const {
  const State& s = *state_;
  return 2 * (s.direct.size() + s.bounced.size() + s.of_classes.size());
}

void TransportShader::shade(const std::vector<TransportPaint>& paints, const color::ReflectionOperator* reflection,
                            const BounceScale& scale, float gain, image::Image& rgba) const {
  const State& s = *state_;
  const color::ReflectionOperator plain = color::component_wise();
  // The matrices of every set of weights, with gain and unit.
  struct Set {
    std::vector<float> matrices;
    std::vector<std::uint8_t> dark;
  };
  std::vector<std::vector<Set>> sets(paints.size());
  for (std::size_t part = 0; part < paints.size(); ++part) {
    for (const auto& weights : paints[part].weights) {
      Set set;
      for (std::size_t k = 0; k < weights.size(); ++k) {
        const color::Matrix3 m = color::reflection_matrix(reflection != nullptr ? *reflection : plain, weights[k]);
        for (const auto& row : m)
          for (const double value : row)
            set.matrices.push_back(gain * s.unit / s.scales[k] * static_cast<float>(value));
        set.dark.push_back(weights[k] == color::Rgb{} ? 1 : 0);
      }
      sets[part].push_back(std::move(set));
    }
  }
  std::vector<float> factors;
  for (const color::Rgb& factor : scale.of_class)
    for (int c = 0; c < 3; ++c) factors.push_back(static_cast<float>(factor[c]));
  const std::size_t of_block = 3 * s.columns * kTransportLanes, of_class = 3 * s.classes * kTransportLanes;
  parallel_for(s.blocks.size(), kBlocksAtOnce, [&](std::size_t begin, std::size_t end) {
    float rgb[3 * kTransportLanes], mixed[3 * kTransportLanes];
    for (std::size_t b = begin; b < end; ++b) {
      const State::Block& block = s.blocks[b];
      const auto part = static_cast<std::size_t>(block.part);
      TransportBlock light;
      light.direct = s.direct.data() + block.direct * of_block;
      if (block.is_bounced) {
        light.bounced = s.bounced.data() + block.bounced * of_block;
        light.classes = s.of_classes.data() + block.bounced * of_class;
      }
      const auto shaded = [&](std::size_t set, float* to) {
        shade_transport(
            light, {s.columns, s.classes, sets[part][set].matrices.data(), sets[part][set].dark.data(), factors.data()},
            to);
      };
      const std::vector<double>& views = paints[part].view_deg;
      if (views.size() == 1) {
        shaded(0, rgb);
      } else {
        // Every set that a point lies beside, and its share of it.
        std::fill_n(rgb, 3 * kTransportLanes, 0.0F);
        for (std::size_t set = 0; set < views.size(); ++set) {
          float share[kTransportLanes];
          for (std::size_t lane = 0; lane < kTransportLanes; ++lane) {
            const double view = std::clamp<double>(s.view_deg[block.points[lane]], views.front(), views.back());
            const std::size_t other = view < views[set] ? set - 1 : std::min(set + 1, views.size() - 1);
            const double width = std::abs(views[other] - views[set]);
            share[lane] =
                view == views[set] ? 1 : static_cast<float>(std::max(0.0, 1 - std::abs(view - views[set]) / width));
          }
          if (std::ranges::none_of(share, [](float own) { return own > 0; })) continue;
          shaded(set, mixed);
          for (std::size_t k = 0; k < 3 * kTransportLanes; ++k) rgb[k] += share[k % kTransportLanes] * mixed[k];
        }
      }
      const std::vector<float>& by_view = paints[part].mirror_by_view;
      if (!by_view.empty() && sets[part].front().dark[s.mirror] == 0) {
        const std::size_t skipped = 3 * s.mirror * kTransportLanes;
        light.direct += skipped;
        if (block.is_bounced) light.bounced += skipped;
        const Set& set = sets[part].front();  // the mirror's weight is one for all views
        shade_transport(light, {1, s.classes, &set.matrices[9 * s.mirror], &set.dark[s.mirror], factors.data()}, mixed);
        float more[kTransportLanes];
        for (std::size_t lane = 0; lane < kTransportLanes; ++lane) {
          const float view = std::min(s.view_deg[block.points[lane]], 89.999F);
          const auto degree = static_cast<std::size_t>(view);
          const float rest = view - static_cast<float>(degree);
          more[lane] = (1 - rest) * by_view[degree] + rest * by_view[degree + 1] - 1;
        }
        for (std::size_t k = 0; k < 3 * kTransportLanes; ++k) rgb[k] += more[k % kTransportLanes] * mixed[k];
      }
      for (std::size_t lane = 0; lane < block.count; ++lane) {
        float* pixel = &rgba.data[4 * static_cast<std::size_t>(s.places[block.points[lane]])];
        for (int c = 0; c < 3; ++c)
          pixel[c] = rgb[static_cast<std::size_t>(c) * kTransportLanes + lane] +
                     gain * static_cast<float>(s.emission[part][c]);
        pixel[3] = 1;
      }
    }
  });
}

}  // namespace goniochrome::render
