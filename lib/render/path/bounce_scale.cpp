#include "render/path/bounce_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "render/internal/seen.h"

namespace goniochrome::render {

namespace {

constexpr double kDark = 0.05;  // of white: darker probes count no more than this in the mean of factors
constexpr double kLargestFactor = 1e3;

using Weights = std::vector<color::Rgb>;

// The product of colors with weights that are used again and again.
class Products {
 public:
  Products(const color::ReflectionOperator* op, const Weights& weights) {
    const color::ReflectionOperator plain = color::component_wise();
    for (const color::Rgb& weight : weights) {
      matrices_.push_back(color::reflection_matrix(op != nullptr ? *op : plain, weight));
      dark_.push_back(weight == color::Rgb{});
    }
  }
  bool dark(std::size_t column) const { return dark_[column]; }
  color::Rgb of(std::size_t column, const color::Rgb& light) const { return color::product(matrices_[column], light); }

 private:
  std::vector<color::Matrix3> matrices_;
  std::vector<bool> dark_;
};

// Light that a group sends to each column of a probe, of weight 1 there, by kind: what paints of these weights send.
struct Arriving {
  std::vector<color::Rgb> base, gloss, deeper;  // by column
  explicit Arriving(std::size_t columns) : base(columns), gloss(columns), deeper(columns) {}
};
Arriving arriving(const LobeTransport& t, const BounceProbe& probe, int group, const Products& paint) {
  const std::size_t count = t.columns.count();
  Arriving result(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t row = (static_cast<std::size_t>(group) * count + k) * count;
    for (std::size_t l = 0; l < count; ++l) {
      if (paint.dark(l)) continue;
      (t.columns.is_gloss(l) ? result.gloss : result.base)[k] += paint.of(l, vec3(&probe.once[3 * (row + l)]));
      result.deeper[k] += paint.of(l, vec3(&probe.deeper[3 * (row + l)]));
    }
  }
  return result;
}

color::Rgb shown(const Products& paint, const std::vector<color::Rgb>& light) {
  color::Rgb sum;
  for (std::size_t k = 0; k < light.size(); ++k)
    if (!paint.dark(k)) sum += paint.of(k, light[k]);
  return sum;
}

color::Rgb ratio(const color::Rgb& to, const color::Rgb& from) {
  color::Rgb result{1, 1, 1};
  for (int c = 0; c < 3; ++c) {
    if (to[c] == from[c]) continue;
    result[c] = from[c] > 0 ? std::clamp(to[c] / from[c], 0.0, kLargestFactor) : 1;
  }
  return result;
}

// A group's paint now: that of its parts, if they agree.
bool gathered(const LobeTransport& t, const std::vector<Weights>& parts, std::vector<Weights>& groups) {
  groups = t.worn.weights;
  std::vector<bool> known(groups.size(), false);
  bool agree = true;
  for (std::size_t part = 0; part < parts.size() && part < t.worn.groups.of_part.size(); ++part) {
    const auto group = static_cast<std::size_t>(t.worn.groups.of_part[part]);
    if (known[group] && parts[part] != groups[group]) agree = false;
    groups[group] = parts[part], known[group] = true;
  }
  return agree;
}

// The light that each group sends to a probe.
std::vector<Arriving> arriving(const LobeTransport& t, const BounceProbe& probe, const std::vector<Products>& groups) {
  std::vector<Arriving> result;
  for (int g = 0; g < t.worn.groups.count; ++g)
    result.push_back(arriving(t, probe, g, groups[static_cast<std::size_t>(g)]));
  return result;
}

std::vector<Products> products_of(const color::ReflectionOperator* op, const std::vector<Weights>& paints) {
  std::vector<Products> products;
  for (const Weights& weights : paints) products.emplace_back(op, weights);
  return products;
}

}  // namespace

struct BounceScaler::State {
  const LobeTransport& t;
  std::optional<color::ReflectionOperator> reflection;
  std::vector<Products> worn;                 // by group
  std::vector<std::vector<Arriving>> before;  // probe, group: in the paints worn

  const color::ReflectionOperator* op() const { return reflection ? &*reflection : nullptr; }
  const Products& worn_at(const BounceProbe& probe) const {
    return worn[static_cast<std::size_t>(t.worn.groups.of_part[static_cast<std::size_t>(t.part[probe.point])])];
  }
};

namespace {

// The light of the classes at a probe in the paints worn there, before and after.
struct OfClasses {
  std::vector<color::Rgb> before, after;
  double weight = 0;
};

OfClasses of_classes(const LobeTransport& t, const Products& own, const std::vector<Arriving>& before,
                     const std::vector<Arriving>& after) {
  const PaintGroups& groups = t.worn.groups;
  OfClasses of{std::vector<color::Rgb>(groups.classes()), std::vector<color::Rgb>(groups.classes()), 0};
  for (int g = 0; g < groups.count; ++g) {
    const auto add = [&](const Arriving& light, std::vector<color::Rgb>& to) {
      to[groups.at(g, PaintGroups::kBase)] = shown(own, light.base);
      to[groups.at(g, PaintGroups::kGloss)] = shown(own, light.gloss);
      to[groups.at(g, PaintGroups::kDeeper)] = shown(own, light.deeper);
    };
    add(before[static_cast<std::size_t>(g)], of.before), add(after[static_cast<std::size_t>(g)], of.after);
  }
  color::Rgb total;
  for (const color::Rgb& light : of.before) total += light;
  of.weight = 1 / (color::luminance(total) + kDark * t.white_luminance);
  return of;
}

// The factors of the classes, by the mean over the probes; and that of what each surface sends on.
color::Rgb add_factors(const LobeTransport& t, const std::vector<OfClasses>& probes, BounceScale& scale) {
  std::vector<color::Rgb> before(t.worn.groups.classes()), after(before.size());
  color::Rgb all_before, all_after;
  for (const OfClasses& probe : probes) {
    for (std::size_t k = 0; k < before.size(); ++k) {
      before[k] += probe.weight * probe.before[k], after[k] += probe.weight * probe.after[k];
      if (k % PaintGroups::kKinds != PaintGroups::kDeeper)
        all_before += probe.weight * probe.before[k], all_after += probe.weight * probe.after[k];
    }
  }
  const color::Rgb further = ratio(all_after, all_before);
  for (std::size_t k = 0; k < before.size(); ++k) {
    scale.of_class.push_back(ratio(after[k], before[k]));
    if (k % PaintGroups::kKinds == PaintGroups::kDeeper) scale.of_class.back() = scale.of_class.back() * further;
  }
  return further;
}

// At a probe, scaled light against light by the pairs of columns. How often light was sent on that came through
// several surfaces is not known: once or twice, whichever is farther off. `paint`: that of the point now.
double error_at(const LobeTransport& t, const BounceProbe& probe, const Products& own, const Products& paint,
                const std::vector<Arriving>& worn, const std::vector<Arriving>& now, const BounceScale& scale,
                const color::Rgb& of_surface) {
  const PaintGroups& groups = t.worn.groups;
  const std::size_t count = t.columns.count();
  std::vector<color::Rgb> before(count), once(count), deeper(count);
  color::Rgb weighted, all;
  for (int g = 0; g < groups.count; ++g) {
    const Arriving &a = worn[static_cast<std::size_t>(g)], &b = now[static_cast<std::size_t>(g)];
    for (std::size_t k = 0; k < count; ++k) {
      before[k] += a.base[k] + a.gloss[k] + a.deeper[k];
      once[k] += b.base[k] + b.gloss[k], deeper[k] += b.deeper[k];
    }
    const color::Rgb kinds[] = {shown(own, a.base), shown(own, a.gloss), shown(own, a.deeper)};
    for (std::size_t kind = 0; kind < 3; ++kind) {
      all += kinds[kind];
      weighted += kinds[kind] * scale.of_class[groups.at(g, static_cast<PaintGroups::Kind>(kind))];
    }
  }
  const color::Rgb factor = ratio(weighted, all);
  color::Rgb direct;
  for (std::size_t k = 0; k < count; ++k)
    if (!paint.dark(k)) direct += paint.of(k, t.light(probe.point, k, false));
  std::vector<color::Rgb> scaled(count);
  for (std::size_t k = 0; k < count; ++k) scaled[k] = factor * before[k];
  const color::Rgb ours = direct + shown(paint, scaled), first = direct + shown(paint, once);
  double worst = 0;
  color::Rgb further = of_surface;
  for (int times = 1; times <= 2; ++times, further = further * of_surface) {
    std::vector<color::Rgb> sent(count);
    for (std::size_t k = 0; k < count; ++k) sent[k] = further * deeper[k];
    worst = std::max(worst, seen_difference(ours, first + shown(paint, sent), t.white_luminance));
  }
  return worst;
}

}  // namespace

BounceScaler::BounceScaler(const LobeTransport& transport, const color::ReflectionOperator* reflection)
    : state_(new State{transport, {}, {}, {}}) {
  if (reflection != nullptr) state_->reflection = *reflection;
}
BounceScaler::BounceScaler(BounceScaler&&) noexcept = default;
BounceScaler& BounceScaler::operator=(BounceScaler&&) noexcept = default;
BounceScaler::~BounceScaler() = default;

BounceScale BounceScaler::scale(const std::vector<Weights>& parts) {
  State& s = *state_;
  const LobeTransport& t = s.t;
  BounceScale scale;
  std::vector<Weights> now;
  const bool agree = gathered(t, parts, now);
  scale.changed = now != t.worn.weights || !agree;
  if (!scale.changed || t.probes.empty()) {
    scale.of_class.assign(t.worn.groups.classes(), {1, 1, 1});
    return scale;
  }
  const std::vector<Products> of_groups = products_of(s.op(), now), of_parts = products_of(s.op(), parts);
  const auto at_probes = [&](const auto& visit) {
    parallel_each(t.probes.size(), 8, [&](std::size_t i) { visit(i, t.probes[i]); });
  };
  if (s.before.empty()) {
    s.worn = products_of(s.op(), t.worn.weights);
    s.before.resize(t.probes.size());
    at_probes([&](std::size_t i, const BounceProbe& probe) { s.before[i] = arriving(t, probe, s.worn); });
  }
  std::vector<std::vector<Arriving>> after(t.probes.size());
  std::vector<OfClasses> classes(t.probes.size());
  at_probes([&](std::size_t i, const BounceProbe& probe) {
    after[i] = arriving(t, probe, of_groups);
    classes[i] = of_classes(t, s.worn_at(probe), s.before[i], after[i]);
  });
  const color::Rgb further = add_factors(t, classes, scale);
  std::vector<double> errors(static_cast<std::size_t>(t.probed), 0.0);
  at_probes([&](std::size_t i, const BounceProbe& probe) {
    const Products& paint = of_parts[static_cast<std::size_t>(t.part[probe.point])];
    errors[i] = error_at(t, probe, s.worn_at(probe), paint, s.before[i], after[i], scale, further);
  });
  scale.error_p95_de00 = agree ? percentile_95(std::move(errors)) : std::numeric_limits<double>::infinity();
  return scale;
}

BounceScale bounce_scale(const LobeTransport& t, const std::vector<Weights>& parts,
                         const color::ReflectionOperator* reflection) {
  return BounceScaler(t, reflection).scale(parts);
}

color::Rgb bounce_factor(const LobeTransport& t, std::size_t point, const BounceScale& scale) {
  if (!t.has_lobes(point)) return scale.of_class[t.worn.floor_class()];
  color::Rgb weighted, all;
  for (std::size_t k = 0; k < t.classes.size(); ++k) {
    const color::Rgb shown = vec3(&t.classes[k][std::size_t{3} * t.with_lobes[point]]);
    all += shown, weighted += shown * scale.of_class[k];
  }
  return ratio(weighted, all);
}

}  // namespace goniochrome::render
