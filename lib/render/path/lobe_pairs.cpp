// Bounced light by pairs of columns, see LobePoint::Pairs.
#include "render/path/lobe_point.h"

namespace goniochrome::render {

// `values`: of the columns at the visible point toward the hit, over the density of that direction.
void LobePoint::add_pairs(const rays::Hit& hit, const rays::Float3& direction, const float* values, double scale,
                          const Sequence& sequence, std::uint32_t index, Pairs& pairs) const {
  const Transport& t = transport_;
  // The tint of a column of the visible point; a floor that shows the environment has a color of its own.
  const color::Rgb tint = on_projected_ ? rays::vec3(painted_.diffuse()) : color::Rgb{1, 1, 1};
  if (t.is_projected(hit)) {
    const Transport::FloorLight floor = t.off_floor(hit, spot_.start, direction, options_.bounces, sequence, index, 4);
    for (std::size_t k = 0; k < columns_.count(); ++k)
      pairs.deeper[pairs.at(group_of(hit), k, LobeColumns::diffuse())] += (scale * values[k]) * tint * floor.bounced;
    return;
  }
  const rays::Spot at = t.rays_->spot(hit, spot_.start, direction);
  const PaintedPoint painted = t.painted(at, -direction);
  const LobeKernels kernels(columns_, painted);
  const std::size_t count = columns_.count();
  std::vector<color::Rgb> once(count), deeper(count);
  float sent[2 * kMostTracedLobes + 2];
  const std::array<double, 4> of_lamp = sequence.point(index, 5);
  for (std::size_t i = 0; i < t.lights_.size(); ++i) {
    const Transport::LampSample lamp = Transport::drawn_from(t.seen_lamp(i, at.start), of_lamp[0], of_lamp[1]);
    if (!(kernels.at(lamp.direction, sent) > 0) || t.rays_->occluded(at.start, lamp.direction, lamp.reach)) continue;
    for (std::size_t l = 0; l < count; ++l) once[l] += static_cast<double>(sent[l]) * lamp.light;
  }
  const int further = options_.bounces - 1;
  const auto add = [&](const rays::Float3& toward, double share, std::uint32_t set) {
    const rays::Hit next = t.rays_->closest(at.start, toward);
    color::Rgb light, bounced;
    if (t.is_projected(next)) {
      const Transport::FloorLight floor = t.off_floor(next, at.start, toward, further, sequence, index, set);
      light = floor.fixed, bounced = floor.bounced;
    } else if (!next.any()) {
      if (t.environment_) light = t.environment_->at(toward).radiance;
    } else {
      light = t.emitters_.radiance(t.rays_->part(next.triangle));
      if (further > 0) bounced = t.bounced(next, at.start, toward, further, sequence, index, set);
    }
    for (std::size_t l = 0; l < count; ++l)
      once[l] += (share * sent[l]) * light, deeper[l] += (share * sent[l]) * bounced;
  };
  const std::array<double, 4> numbers = sequence.point(index, 4);
  rays::Float3 toward;
  if (numbers[0] < light_chance_) {
    toward = t.environment_->drawn(numbers[1], numbers[2]).direction;
  } else {
    toward = kernels.direction((numbers[0] - light_chance_) / (1 - light_chance_), numbers[1], numbers[2]);
  }
  const float kernels_pdf = kernels.at(toward, sent);
  if (kernels_pdf > 0) {
    const double light_pdf = t.environment_ ? t.environment_->at(toward).pdf : 0;
    add(toward, 1 / (light_chance_ * light_pdf + (1 - light_chance_) * kernels_pdf), 6);
  }
  std::fill_n(sent, count, 0.0F);
  sent[columns_.mirror()] = kernels.mirror();
  add(painted.mirrored(), 1, 40);
  if (!t.lights_.empty())
    once[columns_.mirror()] += kernels.mirror() * t.mirrored_lamps(at.start, painted.mirrored(),
                                                                   t.rays_->closest(at.start, painted.mirrored()));
  const int group = groups_.of_part[static_cast<std::size_t>(at.part)];
  for (std::size_t k = 0; k < count; ++k) {
    if (values[k] == 0 || (on_projected_ && k != LobeColumns::diffuse())) continue;
    for (std::size_t l = 0; l < count; ++l) {
      pairs.once[pairs.at(group, k, l)] += (scale * values[k]) * tint * once[l];
      pairs.deeper[pairs.at(group, k, l)] += (scale * values[k]) * tint * deeper[l];
    }
  }
}

LobePoint::Pairs LobePoint::pairs(int sequences, int directions, std::uint64_t seed) const {
  Pairs pairs{columns_.count(), {}, {}};
  pairs.once.resize(static_cast<std::size_t>(groups_.count) * pairs.columns * pairs.columns);
  pairs.deeper.resize(pairs.once.size());
  if (open_ || options_.bounces == 0) return pairs;
  bool any_occluded = false;
  const double share = 1.0 / (static_cast<double>(sequences) * directions);
  float values[2 * kMostTracedLobes + 2];
  for (int which = 0; which < sequences; ++which) {
    const std::uint64_t own = mixed(seed, static_cast<std::uint64_t>(which));
    const Sequence sequence(own, static_cast<std::uint32_t>(directions));
    const std::vector<Ray> rays = traced_rays(directions, own, any_occluded);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      if (!ray.above || !ray.occluded) continue;
      const float kernels_pdf = kernels_.at(ray.direction, values);
      const double light_pdf = transport_.environment_ ? transport_.environment_->at(ray.direction).pdf : 0;
      const double pdf = light_chance_ * light_pdf + (1 - light_chance_) * kernels_pdf;
      const rays::Hit hit =
          pdf > 0 && kernels_pdf > 0 ? transport_.rays_->closest(spot_.start, ray.direction) : rays::Hit{};
      if (!hit.any()) continue;
      add_pairs(hit, ray.direction, values, share / pdf, sequence, static_cast<std::uint32_t>(i), pairs);
    }
  }
  if (!mirror_hit_.any()) return pairs;
  std::fill_n(values, columns_.count(), 0.0F);
  values[columns_.mirror()] = kernels_.mirror();
  const Sequence sequence(mixed(seed, 0x4D), static_cast<std::uint32_t>(directions));
  for (int i = 0; i < directions; ++i)
    add_pairs(mirror_hit_, painted_.mirrored(), values, 1.0 / directions, sequence, static_cast<std::uint32_t>(i),
              pairs);
  return pairs;
}

}  // namespace goniochrome::render
