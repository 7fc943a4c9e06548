#include "render/path/packed_view.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/angles.h"
#include "render/internal/seen.h"

namespace goniochrome::render {

namespace {

constexpr double kVersion = 2;
constexpr int kMantissa = 10;          // bits of a half
constexpr int kMostDropped = 4;        // of them; a lobe that few points show would be off by percents there
constexpr int kProbeDropped = 2;       // of probes, which are averaged
constexpr float kLargest = 65504;      // half
constexpr std::size_t kJudged = 4096;  // points that a rounding is judged by
constexpr double kMostNumbers = 1e9;
constexpr float kAngleSteps = 50;    // in a degree
constexpr float kShareSteps = 2047;  // of a class in all bounced light; 255 changed a closed box by .15 dE00

// A half without its sign, as a whole number: its bits, so that neighbors differ by 1.
int magnitude(float value) {
  return value < kLargest ? Imath::half(value).bits() : Imath::half(kLargest).bits();
}
float of_magnitude(int number) {
  return Imath::half(Imath::half::FromBits, static_cast<std::uint16_t>(number));
}

// Floats as halves times a power of two, without some of their bits.
struct Rounding {
  float scale = 1;
  int dropped = 0;

  int number(float value) const {
    const int step = 1 << dropped, rounded = (magnitude(std::abs(value) * scale) + step / 2) >> dropped;
    return value < 0 ? -rounded : rounded;
  }
  float value(int number) const {
    const int whole = std::min(std::abs(number) << dropped, (31 << kMantissa) - 1);
    return std::copysign(of_magnitude(whole) / scale, static_cast<float>(number));
  }
};

// The scale by which light of weight 1 is around 1, and no value beyond what halves hold.
float scale_of(double weight, float largest) {
  int exponent = 0;
  std::frexp(weight, &exponent);
  auto scale = static_cast<float>(std::ldexp(1.0, exponent));
  while (largest * scale >= 0.99F * kLargest) scale /= 2;
  return scale;
}

float largest_of(const std::vector<float>& values) {
  float largest = 0;
  for (const float value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

class Writer {
 public:
  std::string bytes;

  void number(double value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  }
  template <class List>
  void numbers(const List& list) {
    number(static_cast<double>(list.size()));
    for (const auto& value : list) number(static_cast<double>(value));
  }
  void color(const color::Rgb& c) { number(c.x), number(c.y), number(c.z); }
  // Differences from one value to the next, their low bytes before their high bytes. 2 d is kept for d, 2 |d| - 1 for
  // -d, so that small differences have no high byte.
  void plane(const std::vector<int>& values) {
    const std::size_t low = bytes.size(), high = low + values.size();
    bytes.resize(high + values.size());
    int before = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const int difference = values[i] - before;
      const auto kept = static_cast<std::uint32_t>(difference < 0 ? -2 * difference - 1 : 2 * difference);
      bytes[low + i] = static_cast<char>(kept & 255U), bytes[high + i] = static_cast<char>(kept >> 8U);
      before = values[i];
    }
  }
  void light(const std::vector<float>& values, const Rounding& rounding) {
    number(rounding.scale), number(rounding.dropped);
    std::vector<int> plane_values;
    for (const float value : values) plane_values.push_back(rounding.number(value));
    plane(plane_values);
  }
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && at_ == bytes_.size(); }
  double number() {
    double value = 0;
    if (const char* from = take(sizeof value)) std::memcpy(&value, from, sizeof value);
    return value;
  }
  // A whole number from 0 to the limit.
  std::size_t count(double most = kMostNumbers) {
    const double value = number();
    ok_ = ok_ && value >= 0 && value <= most && value == std::floor(value);
    return ok_ ? static_cast<std::size_t>(value) : 0;
  }
  template <class Number>
  void numbers(std::vector<Number>& list) {
    const std::size_t size = count();
    for (std::size_t i = 0; ok_ && i < size; ++i) list.push_back(static_cast<Number>(number()));
  }
  color::Rgb color() {
    const double r = number(), g = number(), b = number();
    return {r, g, b};
  }
  std::vector<int> plane(std::size_t size) {
    std::vector<int> values(ok_ ? size : 0);
    const char* low = take(2 * size);
    if (low == nullptr) return {};
    int before = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const int kept = static_cast<unsigned char>(low[i]) + (static_cast<unsigned char>(low[size + i]) << 8);
      before += (kept & 1) != 0 ? -(kept + 1) / 2 : kept / 2;
      values[i] = before;
    }
    return values;
  }
  // Calls set(i, value) for each of `size` values.
  template <class Set>
  void light(std::size_t size, const Set& set) {
    Rounding rounding;
    rounding.scale = static_cast<float>(number()), rounding.dropped = static_cast<int>(count(kMostDropped));
    ok_ = ok_ && rounding.scale > 0;
    const std::vector<int> values = plane(size);
    if (!ok_) return;
    // Few of the numbers are in use, and each is computed once.
    std::vector<float> known((32U << kMantissa) >> rounding.dropped, -1);
    for (std::size_t i = 0; i < size; ++i) {
      const auto place = static_cast<std::size_t>(std::abs(values[i]));
      if (place >= known.size()) {
        ok_ = false;
        return;
      }
      if (known[place] < 0) known[place] = rounding.value(static_cast<int>(place));
      set(i, values[i] < 0 ? -known[place] : known[place]);
    }
  }

 private:
  const char* take(std::size_t size) {
    ok_ = ok_ && size <= bytes_.size() - at_;
    if (!ok_) return nullptr;
    at_ += size;
    return bytes_.data() + at_ - size;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

// The change of the gray paint of a column by a rounding.
double rounding_error(const LobeTransport& t, std::size_t column, bool bounced, const Rounding& rounding) {
  std::vector<double> errors;
  const double weight = nominal_weight(t.columns, column);
  const std::size_t stride = 1 + t.places.size() / kJudged;
  for (std::size_t i = 0; i < t.places.size(); i += stride) {
    const auto at = t.at(i, column);
    if (!at) continue;
    color::Rgb seen = weight * t.light(i, column), rounded;
    if (t.columns.is_gloss(column)) seen += (kNominalGray / kPi) * t.light(i, LobeColumns::diffuse());
    const float* light = &(bounced ? t.bounced : t.direct)[column][*at];
    for (int c = 0; c < 3; ++c) rounded[c] = rounding.value(rounding.number(light[c])) - light[c];
    errors.push_back(seen_difference(seen, seen + weight * rounded, t.white_luminance));
  }
  return percentile_95(std::move(errors));
}

Rounding rounding_of(const LobeTransport& t, std::size_t column, bool bounced) {
  const float largest = largest_of((bounced ? t.bounced : t.direct)[column]);
  Rounding rounding{scale_of(nominal_weight(t.columns, column), largest), kMostDropped};
  while (rounding.dropped > 0 && rounding_error(t, column, bounced, rounding) > kPackedError_de00) --rounding.dropped;
  return rounding;
}

void write_worn(const LobeTransport& t, Writer& to) {
  const WornPaints& worn = t.worn;
  to.numbers(t.columns.exponents);
  to.numbers(worn.groups.of_part);
  to.number(static_cast<double>(worn.weights.size()));
  for (const auto& group : worn.weights)
    for (const color::Rgb& weight : group) to.color(weight);
  to.number(static_cast<double>(worn.brushed.size()));
  for (const paint::Anisotropy& alpha : worn.brushed) to.number(alpha.alpha_x), to.number(alpha.alpha_y);
  for (const color::Rgb& radiance : worn.emission) to.color(radiance);
  to.numbers(worn.coats);
  to.number(worn.has_floor), to.number(worn.floor_is_projected);
}

bool read_worn(LobeTransport& t, Reader& from) {
  WornPaints& worn = t.worn;
  from.numbers(t.columns.exponents);
  from.numbers(worn.groups.of_part);
  worn.weights.resize(from.count(1e5));
  worn.groups.count = static_cast<int>(worn.weights.size());
  for (auto& group : worn.weights)
    for (std::size_t k = 0; k < t.columns.count() && from.ok(); ++k) group.push_back(from.color());
  const std::size_t parts = from.count(1e6);
  for (std::size_t i = 0; i < parts && from.ok(); ++i) {
    const double x = from.number();
    worn.brushed.push_back({x, from.number()});
  }
  for (std::size_t i = 0; i < parts && from.ok(); ++i) worn.emission.push_back(from.color());
  from.numbers(worn.coats);
  worn.has_floor = from.count(1) == 1, worn.floor_is_projected = from.count(1) == 1;
  const auto in_range = [&](int group) { return group >= 0 && group < worn.groups.count; };
  return from.ok() && t.columns.exponents.size() <= kMostTracedLobes &&
         std::ranges::all_of(worn.groups.of_part, in_range) && worn.coats.size() == worn.groups.of_part.size() &&
         worn.groups.of_part.size() == parts + (worn.has_floor ? 1 : 0);
}

// The share of each class in a point's bounced light.
void write_classes(const LobeTransport& t, Writer& to) {
  std::vector<float> sums(t.direct[t.columns.mirror()].size(), 0.0F);
  for (const std::vector<float>& light : t.classes)
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += std::max(0.0F, light[i]);
  std::vector<int> shares(sums.size() / 3);
  for (std::size_t k = 0; k < 3 * t.classes.size(); ++k) {
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const float sum = sums[3 * i + k % 3], light = std::max(0.0F, t.classes[k / 3][3 * i + k % 3]);
      shares[i] = sum > 0 ? static_cast<int>(std::lrint(kShareSteps * light / sum)) : 0;
    }
    to.plane(shares);
  }
}

void write_probes(const LobeTransport& t, Writer& to) {
  to.number(static_cast<double>(t.probes.size())), to.number(t.probed);
  for (const BounceProbe& probe : t.probes) {
    to.number(probe.point);
    for (const std::vector<float>* list : {&probe.once, &probe.deeper})
      to.light(*list, {scale_of(1, largest_of(*list)), kProbeDropped});
  }
}

bool read_probes(LobeTransport& t, Reader& from) {
  const std::size_t probes = from.count(1e5);
  t.probed = static_cast<int>(from.count(1e6));
  const std::size_t floats = 3 * t.worn.weights.size() * t.columns.count() * t.columns.count();
  for (std::size_t i = 0; i < probes && from.ok(); ++i) {
    BounceProbe probe;
    probe.point = static_cast<std::uint32_t>(from.count(static_cast<double>(t.places.size()) - 1));
    for (std::vector<float>* list : {&probe.once, &probe.deeper}) {
      list->resize(floats);
      from.light(floats, [list](std::size_t k, float value) { (*list)[k] = value; });
    }
    t.probes.push_back(std::move(probe));
  }
  return from.ok() && t.probed >= static_cast<int>(probes);
}

// The pixels beside the points, where `seen` is 0.
std::vector<std::size_t> pixels_beside(const std::vector<int>& seen) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] == 0) pixels.push_back(i);
  return pixels;
}

// The transport of some of its points, which are given in ascending order, without probes.
LobeTransport of_points(const LobeTransport& t, const std::vector<std::uint32_t>& points) {
  LobeTransport some;
  some.width = t.width, some.height = t.height, some.columns = t.columns, some.worn = t.worn;
  some.white_luminance = t.white_luminance, some.unit = t.unit, some.bounces = t.bounces;
  for (const std::uint32_t point : points) some.places.push_back(t.places[point]), some.part.push_back(t.part[point]);
  some.make_room();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < t.columns.count(); ++k) {
      const auto from = t.at(points[i], k), to = some.at(i, k);
      if (!from) continue;
      std::copy_n(&t.direct[k][*from], 3, &some.direct[k][*to]);
      if (t.bounces > 0) std::copy_n(&t.bounced[k][*from], 3, &some.bounced[k][*to]);
    }
    for (std::size_t k = 0; k < t.classes.size() && t.has_lobes(points[i]); ++k)
      std::copy_n(&t.classes[k][std::size_t{3} * t.with_lobes[points[i]]], 3,
                  &some.classes[k][std::size_t{3} * some.with_lobes[i]]);
  }
  return some;
}

}  // namespace

Result<std::string> packed_view(const LobeTransport& t, const std::vector<float>& view_deg,
                                const image::Image& beside) {
  const std::size_t points = t.places.size();
  if (points > kMostPagePoints)
    return input_error("it has {} points, and a page shows at most {}: trace it again in a smaller size", points,
                       kMostPagePoints);
  Writer to;
  to.number(kVersion), to.number(t.width), to.number(t.height), to.number(t.bounces);
  to.number(t.unit), to.number(t.white_luminance);
  write_worn(t, to);
  std::vector<int> seen(static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height), 0);
  for (std::size_t i = 0; i < points; ++i) seen[t.places[i]] = t.part[i] + 1;
  to.plane(seen);
  std::vector<int> angles;
  for (const float angle : view_deg) angles.push_back(static_cast<int>(std::lrint(kAngleSteps * angle)));
  to.plane(angles);
  for (const bool bounced : {false, true}) {
    for (std::size_t k = 0; k < t.columns.count() && (!bounced || t.bounces > 0); ++k) {
      const std::vector<float>& light = (bounced ? t.bounced : t.direct)[k];
      const Rounding rounding = rounding_of(t, k, bounced);
      std::vector<float> plane(light.size() / 3);
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = light[3 * i + c];
        to.light(plane, rounding);
      }
    }
  }
  if (t.bounces > 0) {
    write_classes(t, to);
    write_probes(t, to);
  }
  to.number(!beside.data.empty());
  if (!beside.data.empty()) {
    const std::vector<std::size_t> pixels = pixels_beside(seen);
    std::vector<float> values(pixels.size());
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t i = 0; i < pixels.size(); ++i) values[i] = beside.data[4 * pixels[i] + c];
      to.light(values, {scale_of(1, largest_of(values)), 1});
    }
  }
  return Result(std::move(to.bytes));
}

Result<UnpackedView> unpacked_view(std::string_view bytes) {
  const Error damaged = input_error("the light of this view is damaged");
  Reader from(bytes);
  UnpackedView view;
  LobeTransport& t = view.light;
  constexpr double kMostAcross = 1e5;
  if (from.number() != kVersion) return damaged;
  t.width = static_cast<int>(from.count(kMostAcross)), t.height = static_cast<int>(from.count(kMostAcross));
  t.bounces = static_cast<int>(from.count(kMostAcross));
  t.unit = from.number(), t.white_luminance = from.number();
  if (!from.ok() || !(t.unit > 0) || !(t.white_luminance > 0) || !read_worn(t, from)) return damaged;
  const std::vector<int> seen = from.plane(static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0) continue;
    if (seen[i] < 0 || static_cast<std::size_t>(seen[i]) > t.worn.groups.of_part.size()) return damaged;
    t.places.push_back(static_cast<std::uint32_t>(i)), t.part.push_back(seen[i] - 1);
  }
  const std::size_t points = t.places.size();
  if (points > kMostPagePoints) return damaged;
  for (const int angle : from.plane(points)) view.view_deg.push_back(static_cast<float>(angle) / kAngleSteps);
  t.make_room();
  for (const bool bounced : {false, true})
    for (std::size_t k = 0; k < t.columns.count() && (!bounced || t.bounces > 0); ++k)
      for (std::size_t c = 0; c < 3 && from.ok(); ++c) {
        std::vector<float>& to = (bounced ? t.bounced : t.direct)[k];
        from.light(to.size() / 3, [&](std::size_t i, float value) { to[3 * i + c] = value; });
      }
  for (std::size_t k = 0; k < 3 * t.classes.size() && from.ok(); ++k) {
    std::vector<float>& to = t.classes[k / 3];
    const std::vector<int> shares = from.plane(to.size() / 3);
    for (std::size_t i = 0; i < shares.size(); ++i) to[3 * i + k % 3] = static_cast<float>(shares[i]);
  }
  if (t.bounces > 0 && !read_probes(t, from)) return damaged;
  if (from.count(1) == 1) {
    const std::vector<std::size_t> pixels = pixels_beside(seen);
    view.beside = {t.width, t.height, 4, std::vector<float>(4 * seen.size(), 0.0F), {}};
    for (std::size_t c = 0; c < 4; ++c)
      from.light(pixels.size(), [&](std::size_t i, float value) { view.beside.data[4 * pixels[i] + c] = value; });
  }
  if (!from.at_end()) return damaged;
  return Result(std::move(view));
}

PackingError packing_error(const LobeTransport& t, const std::vector<float>& view_deg, const UnpackedView& view,
                           const std::vector<ShownPaints>& paints, const color::ReflectionOperator* reflection) {
  const TransportShader exact(t, view_deg), packed(view.light, view.view_deg);
  const image::Image black = image::even_image(t.width, t.height, 4);
  image::Image pictures[] = {black, black};
  const auto gain = static_cast<float>(1 / (t.unit * t.white_luminance));
  PackingError error;
  for (const ShownPaints& paint : paints) {
    exact.shade(paint.paints, reflection, bounce_scale(t, paint.weights, reflection), gain, pictures[0]);
    packed.shade(paint.paints, reflection, bounce_scale(view.light, paint.weights, reflection), gain, pictures[1]);
    std::vector<double> differences;
    double sum = 0;
    for (const std::uint32_t place : t.places) {
      const std::size_t at = 4 * std::size_t{place};
      differences.push_back(seen_difference(vec3(&pictures[0].data[at]), vec3(&pictures[1].data[at]), 1));
      sum += differences.back();
    }
    error.mean_de00 =
        std::max(error.mean_de00, sum / static_cast<double>(std::max<std::size_t>(1, differences.size())));
    error.p95_de00 = std::max(error.p95_de00, percentile_95(std::move(differences)));
  }
  return error;
}

Thinned thinned(const LobeTransport& t, int n) {
  const auto step = static_cast<std::uint32_t>(n), width = static_cast<std::uint32_t>(t.width);
  const auto across = static_cast<std::uint32_t>(t.width / n), down = static_cast<std::uint32_t>(t.height / n);
  const auto is_kept = [&](std::uint32_t place) {
    const std::uint32_t x = place % width, y = place / width;
    return x % step == step / 2 && y % step == step / 2 && x / step < across && y / step < down;
  };
  Thinned thin;
  for (std::uint32_t i = 0; i < t.places.size(); ++i)
    if (is_kept(t.places[i])) thin.points.push_back(i);
  LobeTransport& some = thin.light;
  some = of_points(t, thin.points);
  some.width = static_cast<int>(across), some.height = static_cast<int>(down);
  for (std::uint32_t& place : some.places) place = (place / width / step) * across + place % width / step;
  return thin;
}

}  // namespace goniochrome::render
