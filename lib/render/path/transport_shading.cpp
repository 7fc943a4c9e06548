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
    bool is_bounced = false;
    std::size_t columns = 0;                           // that its points have
    std::size_t direct = 0, bounced = 0, classes = 0;  // where its light begins
    std::uint32_t points[kTransportLanes] = {};
    std::uint32_t count = 0;
  };
  std::vector<std::size_t> columns;  // those that were read, the diffuse one first
  std::size_t classes = 0, mirror = 0, floor_class = 0;
  int floor = -1;  // the part of a floor that shows the environment
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
  std::vector<std::uint8_t> lit(t.places.size());
  parallel_each(lit.size(), std::size_t{1} << 14, [&](std::size_t i) {
    for (const std::size_t k : columns)
      if (const auto at = t.at(i, k); at && lit[i] == 0)
        lit[i] = std::any_of(&t.bounced[k][*at], &t.bounced[k][*at] + 3, [](float value) { return value != 0; });
  });
  std::vector<std::vector<std::uint32_t>> kinds(2 * t.worn.groups.of_part.size());  // part and whether light bounces
  for (std::size_t i = 0; i < lit.size(); ++i)
    kinds[2 * static_cast<std::size_t>(t.part[i]) + lit[i]].push_back(static_cast<std::uint32_t>(i));
  Block next;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    next.part = static_cast<int>(kind / 2), next.is_bounced = kind % 2 == 1;
    next.columns = next.part == floor ? 1 : columns.size();
    for (std::size_t first = 0; first < kinds[kind].size(); first += kTransportLanes) {
      next.count = static_cast<std::uint32_t>(std::min(kTransportLanes, kinds[kind].size() - first));
      for (std::size_t k = 0; k < kTransportLanes; ++k)
        next.points[k] = kinds[kind][std::min(first + k, kinds[kind].size() - 1)];
      blocks.push_back(next);
      const std::size_t halves = 3 * kTransportLanes;
      next.direct += halves * next.columns;
      if (next.is_bounced) next.bounced += halves * next.columns;
      if (next.is_bounced && next.part != floor) next.classes += halves * classes;
    }
  }
  direct.resize(next.direct), bounced.resize(next.bounced), of_classes.resize(next.classes);
}

void TransportShader::State::lay_out(const LobeTransport& t) {
  scales.resize(columns.size());
  parallel_each(columns.size(), 1, [&](std::size_t k) {
    scales[k] = half_scale(std::max(largest_of(t.direct[columns[k]]), largest_of(t.bounced[columns[k]])));
  });
  const float of_class = half_scale(largest_of(t.classes));  // classes are factors of a mean, which it does not change
  const auto put = [](std::uint16_t* to, float scale, const float* from, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) to[k * kTransportLanes] = Imath::half(scale * from[k]).bits();
  };
  parallel_for(blocks.size(), kBlocksAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Block& block = blocks[b];
      for (std::size_t k = 0; k < block.columns; ++k)
        for (std::size_t lane = 0; lane < kTransportLanes; ++lane) {
          const std::size_t at = *t.at(block.points[lane], columns[k]), to = 3 * k * kTransportLanes + lane;
          put(&direct[block.direct + to], scales[k], &t.direct[columns[k]][at], 3);
          if (block.is_bounced) put(&bounced[block.bounced + to], scales[k], &t.bounced[columns[k]][at], 3);
        }
      for (std::size_t lane = 0; lane < kTransportLanes && block.is_bounced && block.part != floor; ++lane)
        put(&of_classes[block.classes + lane], of_class, t.classes_of(block.points[lane]), 3 * classes);
    }
  });
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
  for (std::size_t k = 0; k < t.columns.count(); ++k)
    if (!t.direct[k].empty()) s.columns.push_back(k);
  s.mirror = static_cast<std::size_t>(std::ranges::find(s.columns, t.columns.mirror()) - s.columns.begin());
  s.classes = t.worn.groups.classes(), s.unit = static_cast<float>(t.unit);
  if (t.worn.floor_is_projected)
    s.floor = static_cast<int>(t.worn.brushed.size()), s.floor_class = t.worn.floor_class();
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
      for (std::size_t k = 0; k < s.columns.size(); ++k) {
        const color::Rgb& weight = weights[s.columns[k]];
        const color::Matrix3 m = color::reflection_matrix(reflection != nullptr ? *reflection : plain, weight);
        for (const auto& row : m)
          for (const double value : row)
            set.matrices.push_back(gain * s.unit / s.scales[k] * static_cast<float>(value));
        set.dark.push_back(weight == color::Rgb{} ? 1 : 0);
      }
      sets[part].push_back(std::move(set));
    }
  }
  std::vector<float> factors;
  for (const color::Rgb& factor : scale.of_class)
    for (int c = 0; c < 3; ++c) factors.push_back(static_cast<float>(factor[c]));
  std::uint16_t one_class[3 * kTransportLanes];
  std::ranges::fill(one_class, Imath::half(1).bits());
  parallel_for(s.blocks.size(), kBlocksAtOnce, [&](std::size_t begin, std::size_t end) {
    float rgb[3 * kTransportLanes], mixed[3 * kTransportLanes];
    for (std::size_t b = begin; b < end; ++b) {
      const State::Block& block = s.blocks[b];
      const auto part = static_cast<std::size_t>(block.part);
      TransportBlock light;
      const bool is_floor = block.part == s.floor;
      light.direct = s.direct.data() + block.direct;
      if (block.is_bounced) {
        light.bounced = s.bounced.data() + block.bounced;
        light.classes = is_floor ? one_class : s.of_classes.data() + block.classes;
      }
      const auto shaded = [&](std::size_t set, float* to) {
        shade_transport(light,
                        {block.columns, is_floor ? 1 : s.classes, sets[part][set].matrices.data(),
                         sets[part][set].dark.data(), factors.data() + (is_floor ? 3 * s.floor_class : 0)},
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
      if (!by_view.empty() && s.mirror < s.columns.size() && sets[part].front().dark[s.mirror] == 0) {
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
