// Times of an edited paint where the light of a picture is known by lobes: the check of its bounced light and its
// shading. A ball in a cup has some 100,000 points in 640x360 pixels, half as many as a vehicle in 1280x720; the time
// goes with the points and the columns, whatever they show.
#include <benchmark/benchmark.h>

#include "render/internal/seen.h"
#include "render/path/transport_shading.h"
#include "render/path/transport_stage_for_test.h"

namespace goniochrome::render {
namespace {

using namespace transport_stage;

// Argument: whether colored light is multiplied by the operator.
void BM_EditedPaint(benchmark::State& state) {
  std::mt19937_64 random(2);
  const paint::LobeFit cup = random_paint(random), ball = random_paint(random), edited = random_paint(random);
  const Stage stage(cup, ball, 640, 360);
  LobeTransportRequest request;
  request.tolerance_de00 = 20, request.bounces = 2;
  const LobeTransport t = stage.traced(request).transport;
  const TransportShader shader(t, {});
  const color::ReflectionOperator iso = color::iso_rgb_operator();
  const color::ReflectionOperator* op = state.range(0) != 0 ? &iso : nullptr;
  std::vector<TransportPaint> paints(5, *transport_paint(t.columns, edited, brdf::kGlossIncidence_deg));
  paints.push_back(*transport_paint(t.columns, ball, brdf::kGlossIncidence_deg));
  std::vector<std::vector<color::Rgb>> weights(5, weights_of(t.columns, edited));
  weights.push_back(weights_of(t.columns, ball));
  image::Image picture{640, 360, 4, std::vector<float>(4UL * 640 * 360, 0.0F), {}};
  BounceScaler scaler(t, op);
  BounceScale scale;
  for (auto _ : state) {
    scale = scaler.scale(weights);
    shader.shade(paints, op, scale, 1, picture);
    benchmark::DoNotOptimize(picture.data.data());
  }
  double worst = 0;  // against sums in doubles
  for (std::size_t i = 0; i < t.places.size(); i += 997) {
    const auto& own = weights[static_cast<std::size_t>(t.part[i])];
    const color::Rgb factor = bounce_factor(t, i, scale);
    color::Rgb sum;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const color::Rgb direct = t.light(i, k, false), light = direct + factor * (t.light(i, k) - direct);
      sum += op != nullptr ? color::reflected(*op, own[k], light) : own[k] * light;
    }
    const float* p = &picture.data[4 * t.places[i]];
    worst = std::max(worst, seen_difference({p[0], p[1], p[2]}, sum, 1));
  }
  if (worst > 0.05) return state.SkipWithError("the shading is off");
  state.counters["points"] = static_cast<double>(t.places.size());
  state.counters["columns"] = static_cast<double>(t.columns.count());
  state.counters["worst_de00"] = worst;
}
BENCHMARK(BM_EditedPaint)->ArgName("operator")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace goniochrome::render
