#include "render/path/transport_shading.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "math/elementary.h"
#include "render/path/transport_kernel.h"

namespace goniochrome::render {

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
  parallel_each(angles.size(), std::size_t{1} << 14, [&](std::size_t i) {
    if (!t.has_lobes(i)) return;
    const Gbuffer& seen = *samples[t.places[i] / of_sample];
    const auto x = static_cast<int>(t.places[i] % wide), y = static_cast<int>(t.places[i] % of_sample / wide);
    const Vec3 n = seen.normal(x, y), v = seen.to_viewer(x, y);
    angles[i] = static_cast<float>(math::atan2(length(cross(n, v)), dot(n, v)) / kDegree);
  });
  return angles;
}

TransportShader::TransportShader(const LobeTransport& transport, std::vector<float> view_deg)
    : light_(transport), view_deg_(std::move(view_deg)) {
  for (std::size_t k = 0; k < light_.columns.count(); ++k)
    if (!light_.direct[k].empty()) columns_.push_back(k);
}

std::size_t TransportShader::bytes() const {
  std::size_t floats = 0;
  for (const auto* light : {&light_.direct, &light_.bounced, &light_.classes})
    for (const std::vector<float>& values : *light) floats += values.size();
  return sizeof(float) * floats;
}

namespace {

// One set of weights in the columns that were read.
struct WeightSet {
  std::vector<float> matrices;  // with gain
  std::vector<std::uint8_t> dark;
};

// Where the light of a run of points begins in each column and class.
struct RunLight {
  std::vector<const float*> direct, bounced, classes;
};

constexpr std::size_t kMostAtOnce = 256;

// The shading of all points in some paints.
class Shading {
 public:
  Shading(const LobeTransport& light, const std::vector<float>& view_deg, const std::vector<std::size_t>& columns,
          const std::vector<TransportPaint>& paints, const color::ReflectionOperator* reflection,
          const BounceScale& scale, float gain)
      : t_(light), view_deg_(view_deg), columns_(columns), paints_(paints), gain_(gain), sets_(paints.size()) {
    const color::ReflectionOperator op = reflection != nullptr ? *reflection : color::component_wise();
    for (std::size_t part = 0; part < paints.size(); ++part)
      for (const auto& weights : paints[part].weights) {
        WeightSet& set = sets_[part].emplace_back();
        for (const std::size_t k : columns) {
          for (const auto& row : color::reflection_matrix(op, weights[k]))
            for (const double value : row)
              set.matrices.push_back(gain * static_cast<float>(light.unit) * static_cast<float>(value));
          set.dark.push_back(weights[k] == color::Rgb{} ? 1 : 0);
        }
      }
    for (const color::Rgb& factor : scale.of_class)
      for (int c = 0; c < 3; ++c) factors_.push_back(static_cast<float>(factor[c]));
    mirror_ = static_cast<std::size_t>(std::ranges::find(columns, light.columns.mirror()) - columns.begin());
  }

  // Points of one part, at most kMostAtOnce.
  void shade(std::size_t first, std::size_t count, RunLight& run, image::Image& rgba) const {
    const auto part = static_cast<std::size_t>(t_.part[first]);
    const bool has_lobes = t_.has_lobes(first);
    find_light(first, has_lobes ? columns_.size() : 1, run);
    const TransportPoints points{count, run.direct.data(), t_.bounces > 0 ? run.bounced.data() : nullptr,
                                 run.classes.data()};
    const std::size_t classes = has_lobes ? t_.classes.size() : 0;
    const float* factors = factors_.data() + (has_lobes ? 0 : 3 * t_.worn.floor_class());
    float rgb[3 * kMostAtOnce], mixed[3 * kMostAtOnce];
    const auto shaded = [&](const WeightSet& set, float* to) {
      shade_transport(points, {run.direct.size(), classes, set.matrices.data(), set.dark.data(), factors}, to);
    };
    const std::vector<double>& views = paints_[part].view_deg;
    if (views.size() == 1) {
      shaded(sets_[part].front(), rgb);
    } else {
      std::fill_n(rgb, 3 * count, 0.0F);
      for (std::size_t set = 0; set < views.size(); ++set)
        add_times([&](std::size_t i) { return share_of(views, set, view_deg_[first + i]); },
                  [&] { shaded(sets_[part][set], mixed); }, count, mixed, rgb);
    }
    const std::vector<float>& by_view = paints_[part].mirror_by_view;
    const WeightSet& set = sets_[part].front();  // the mirror's weight is one for all views
    if (has_lobes && !by_view.empty() && mirror_ < columns_.size() && set.dark[mirror_] == 0)
      add_times([&](std::size_t i) { return more_of(by_view, view_deg_[first + i]); },
                [&] {
                  const TransportPoints mirror{count, points.direct + mirror_,
                                               points.bounced == nullptr ? nullptr : points.bounced + mirror_,
                                               points.classes};
                  shade_transport(mirror, {1, classes, &set.matrices[9 * mirror_], &set.dark[mirror_], factors}, mixed);
                },
                count, mixed, rgb);
    const color::Rgb emission = part < t_.worn.emission.size() ? t_.worn.emission[part] : color::Rgb{};
    for (std::size_t i = 0; i < count; ++i) {
      float* pixel = &rgba.data[4 * static_cast<std::size_t>(t_.places[first + i])];
      for (int c = 0; c < 3; ++c)
        pixel[c] = rgb[3 * i + static_cast<std::size_t>(c)] + gain_ * static_cast<float>(emission[c]);
      pixel[3] = 1;
    }
  }

 private:
  void find_light(std::size_t first, std::size_t columns, RunLight& run) const {
    run.direct.clear(), run.bounced.clear(), run.classes.clear();
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t column = columns_[k], at = *t_.at(first, column);
      run.direct.push_back(t_.direct[column].data() + at);
      if (t_.bounces > 0) run.bounced.push_back(t_.bounced[column].data() + at);
    }
    for (const std::vector<float>& light : t_.classes)
      run.classes.push_back(light.data() + std::size_t{3} * t_.with_lobes[first]);
  }

  // Adds what `shade` brings to `mixed`, times the factor of each point. Without one that is not 0, nothing is shaded.
  template <class Factor, class Shade>
  static void add_times(const Factor& factor, const Shade& shade, std::size_t count, const float* mixed, float* rgb) {
    float factors[kMostAtOnce];
    for (std::size_t i = 0; i < count; ++i) factors[i] = factor(i);
    if (std::all_of(factors, factors + count, [](float value) { return value == 0; })) return;
    shade();
    for (std::size_t k = 0; k < 3 * count; ++k) rgb[k] += factors[k / 3] * mixed[k];
  }

  // The share of a set, which two sets beside a view have.
  static float share_of(const std::vector<double>& views, std::size_t set, double view_deg) {
    const double view = std::clamp(view_deg, views.front(), views.back());
    const std::size_t other = view < views[set] ? set - 1 : std::min(set + 1, views.size() - 1);
    const double width = std::abs(views[other] - views[set]);
    return view == views[set] ? 1 : static_cast<float>(std::max(0.0, 1 - std::abs(view - views[set]) / width));
  }
  // By how much the mirror shows more there than by its weight.
  static float more_of(const std::vector<float>& by_view, float view_deg) {
    const float view = std::min(view_deg, 89.999F);
    const auto degree = static_cast<std::size_t>(view);
    const float rest = view - static_cast<float>(degree);
    return (1 - rest) * by_view[degree] + rest * by_view[degree + 1] - 1;
  }

  const LobeTransport& t_;
  const std::vector<float>& view_deg_;
  const std::vector<std::size_t>& columns_;
  const std::vector<TransportPaint>& paints_;
  float gain_;
  std::vector<std::vector<WeightSet>> sets_;  // by part
  std::vector<float> factors_;                // of the classes, by channel
  std::size_t mirror_ = 0;                    // among the columns
};

}  // namespace

void TransportShader::shade(const std::vector<TransportPaint>& paints, const color::ReflectionOperator* reflection,
                            const BounceScale& scale, float gain, image::Image& rgba) const {
  constexpr std::size_t kChunk = 8192;
  const Shading shading(light_, view_deg_, columns_, paints, reflection, scale, gain);
  parallel_for(light_.places.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    RunLight run;
    for (std::size_t first = begin, next = begin; first < end; first = next) {
      while (next < std::min(end, first + kMostAtOnce) && light_.part[next] == light_.part[first]) ++next;
      shading.shade(first, next - first, run, rgba);
    }
  });
}

}  // namespace goniochrome::render
