#include "render/path/bounce_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
      const float* once = &probe.once[3 * (row + l)];
      const float* deeper = &probe.deeper[3 * (row + l)];
      (t.columns.is_gloss(l) ? result.gloss : result.base)[k] += paint.of(l, {once[0], once[1], once[2]});
      result.deeper[k] += paint.of(l, {deeper[0], deeper[1], deeper[2]});
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

class Scaling {
 public:
  Scaling(const LobeTransport& t, const std::vector<Weights>& parts, const std::vector<Weights>& now,
          const color::ReflectionOperator* op)
      : t_(t) {
    for (const Weights& weights : t.worn.weights) worn_.emplace_back(op, weights);
    for (const Weights& weights : now) now_.emplace_back(op, weights);
    for (const Weights& weights : parts) parts_.emplace_back(op, weights);
  }

  // The mean over the probes of what each class shows in the paints worn there, before and after.
  void add_factors(BounceScale& scale) {
    const PaintGroups& groups = t_.worn.groups;
    std::vector<color::Rgb> before(groups.classes()), after(groups.classes());
    color::Rgb all_before, all_after;
    for (const BounceProbe& probe : t_.probes) {
      const Products& own = worn_[static_cast<std::size_t>(group_of(probe))];
      std::vector<color::Rgb> old(groups.classes()), fresh(groups.classes());
      color::Rgb total;
      for (int g = 0; g < groups.count; ++g) {
        const Arriving a = arriving(t_, probe, g, worn_[static_cast<std::size_t>(g)]);
        const Arriving b = arriving(t_, probe, g, now_[static_cast<std::size_t>(g)]);
        old[groups.at(g, PaintGroups::kBase)] = shown(own, a.base),
                         fresh[groups.at(g, PaintGroups::kBase)] = shown(own, b.base);
        old[groups.at(g, PaintGroups::kGloss)] = shown(own, a.gloss),
                         fresh[groups.at(g, PaintGroups::kGloss)] = shown(own, b.gloss);
        old[groups.at(g, PaintGroups::kDeeper)] = shown(own, a.deeper),
                         fresh[groups.at(g, PaintGroups::kDeeper)] = shown(own, b.deeper);
      }
      for (const color::Rgb& light : old) total += light;
      const double weight = 1 / (color::xyz_d65_from_rgb(total).Y + kDark * t_.white_luminance);
      for (std::size_t k = 0; k < old.size(); ++k) {
        before[k] += weight * old[k], after[k] += weight * fresh[k];
        if (k % PaintGroups::kKinds != PaintGroups::kDeeper)
          all_before += weight * old[k], all_after += weight * fresh[k];
      }
    }
    further_ = ratio(all_after, all_before);
    for (std::size_t k = 0; k < before.size(); ++k) {
      scale.of_class.push_back(ratio(after[k], before[k]));
      if (k % PaintGroups::kKinds == PaintGroups::kDeeper) scale.of_class.back() = scale.of_class.back() * further_;
    }
  }

  // At a probe, scaled light against light by the pairs of columns. How often light was sent on that came through
  // several surfaces is not known: once or twice, whichever is farther off.
  double error(const BounceProbe& probe, const BounceScale& scale) const {
    const PaintGroups& groups = t_.worn.groups;
    const std::size_t count = t_.columns.count();
    const Products& own = worn_[static_cast<std::size_t>(group_of(probe))];
    const Products& paint = parts_[static_cast<std::size_t>(t_.part[probe.point])];
    std::vector<color::Rgb> before(count), once(count), deeper(count);
    color::Rgb weighted, all;
    for (int g = 0; g < groups.count; ++g) {
      const Arriving a = arriving(t_, probe, g, worn_[static_cast<std::size_t>(g)]);
      const Arriving b = arriving(t_, probe, g, now_[static_cast<std::size_t>(g)]);
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
      if (!paint.dark(k)) direct += paint.of(k, t_.light(probe.point, k, false));
    std::vector<color::Rgb> scaled(count);
    for (std::size_t k = 0; k < count; ++k) scaled[k] = factor * before[k];
    const color::Rgb ours = direct + shown(paint, scaled), first = direct + shown(paint, once);
    double worst = 0;
    color::Rgb further = further_;
    for (int times = 1; times <= 2; ++times, further = further * further_) {
      std::vector<color::Rgb> sent(count);
      for (std::size_t k = 0; k < count; ++k) sent[k] = further * deeper[k];
      worst = std::max(worst, seen_difference(ours, first + shown(paint, sent), t_.white_luminance));
    }
    return worst;
  }

 private:
  int group_of(const BounceProbe& probe) const {
    return t_.worn.groups.of_part[static_cast<std::size_t>(t_.part[probe.point])];
  }

  const LobeTransport& t_;
  std::vector<Products> worn_, now_, parts_;
  color::Rgb further_{1, 1, 1};  // of what each surface sends on
};

}  // namespace

BounceScale bounce_scale(const LobeTransport& t, const std::vector<Weights>& parts,
                         const color::ReflectionOperator* reflection) {
  BounceScale scale;
  std::vector<Weights> now;
  const bool agree = gathered(t, parts, now);
  scale.changed = now != t.worn.weights || !agree;
  if (!scale.changed || t.probes.empty()) {
    scale.of_class.assign(t.worn.groups.classes(), {1, 1, 1});
    return scale;
  }
  Scaling scaling(t, parts, now, reflection);
  scaling.add_factors(scale);
  std::vector<double> errors(static_cast<std::size_t>(t.probed), 0.0);
  for (std::size_t i = 0; i < t.probes.size(); ++i) errors[i] = scaling.error(t.probes[i], scale);
  scale.error_p95_de00 = agree ? percentile_95(std::move(errors)) : std::numeric_limits<double>::infinity();
  return scale;
}

color::Rgb bounce_factor(const LobeTransport& t, std::size_t point, const BounceScale& scale) {
  const std::size_t count = t.worn.groups.classes();
  color::Rgb weighted, all;
  for (std::size_t k = 0; k < count; ++k) {
    const float* light = &t.classes[(point * count + k) * 3];
    const color::Rgb shown{light[0], light[1], light[2]};
    all += shown, weighted += shown * scale.of_class[k];
  }
  return ratio(weighted, all);
}

}  // namespace goniochrome::render
