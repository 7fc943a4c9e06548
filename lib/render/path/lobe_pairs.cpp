// Bounced light by pairs of columns, see LobePoint::Pairs.
#include "render/path/lobe_point.h"
#include "render/path/path_loop.h"

namespace goniochrome::render {

using rays::Float3;
using rays::Hit;

// The light that one surface on a ray sends back, by column of weight 1.
class LobePoint::SentColumns {
 public:
  static constexpr bool kWeighsLamps = false;
  explicit SentColumns(const LobeColumns& columns) : once(columns.count()), deeper(columns.count()) {}
  std::vector<color::Rgb> once, deeper;  // as Pairs has them

  PaintedPoint::Shares reflected(const Transport::Vertex& vertex, const Float3& to_light) const {
    return vertex.painted.shares(to_light);
  }
  void add_reflected(const Transport::Vertex&, const PaintedPoint::Shares& f, double scale, const PathLight& light) {
    for (std::size_t l = 0; l < once.size(); ++l) once[l] += (scale * f.of[l]) * light.rgb;
  }
  void add(double scale, const PathLight& light) {
    for (std::size_t l = 0; l < once.size(); ++l) once[l] += (scale * scale_ * path_.of[l]) * light.rgb;
  }
  void reflect(const Transport::Vertex&, const PaintedPoint::Shares& f, double scale) { path_ = f, scale_ = scale; }
  void mirror(const Transport::Vertex& vertex, double scale) {
    path_ = {}, scale_ = scale;
    path_.of[once.size() - 1] = vertex.painted.coat_mirror();
  }
  void add_deeper(const color::Rgb& light) {
    for (std::size_t l = 0; l < once.size(); ++l) deeper[l] += (scale_ * path_.of[l]) * light;
  }

 private:
  PaintedPoint::Shares path_;
  double scale_ = 1;
};

// Receives bounced light alone, as means over so many directions.
class LobePoint::PairColumns {
 public:
  PairColumns(const LobePoint& point, int directions, Pairs& pairs)
      : point_(point), share_(1.0 / directions), pairs_(pairs) {
    // A floor that shows the environment has a color of its own.
    if (point.on_projected_)
      tint_ = rays::vec3(point.transport_.painted(point.spot_, point.painted_.to_viewer()).diffuse());
  }

  PaintedPoint::Shares at(const Float3& direction) const { return point_.painted_.shares(direction); }
  PaintedPoint::Shares mirror() const { return point_.mirror(); }
  static bool wants(const Ray& ray) { return ray.hit.any(); }
  static void add_sky(const PaintedPoint::Shares&, double, const Ray&, const color::Rgb&) {}
  static void add_light(const PaintedPoint::Shares&, double, const color::Rgb&) {}
  void add_floor(const PaintedPoint::Shares& f, double scale, const Hit& hit, const Transport::FloorLight& light) {
    for (std::size_t k = 0; k < pairs_.columns; ++k)
      pairs_.deeper[pairs_.at(point_.group_of(hit), k, LobeColumns::diffuse())] += weight(f, scale, k) * light.bounced;
  }
  void add_sent(const PaintedPoint::Shares& f, double scale, const Hit& hit, const Float3& direction,
                const Sequence& sequence, std::uint32_t index) {
    const Transport& t = point_.transport_;
    const rays::Spot spot = t.rays_->spot(hit, point_.spot_.start, direction);
    SentColumns sent(point_.columns_);
    t.send({t, spot, t.painted(spot, -direction).of_basis(point_.columns_.exponents)}, point_.bounces_ - 1, sequence,
           index, 4, sent);
    for (std::size_t k = 0; k < pairs_.columns; ++k) {
      if (f.of[k] == 0) continue;
      const std::size_t first = pairs_.at(point_.group_of(hit), k, 0);
      for (std::size_t l = 0; l < pairs_.columns; ++l) {
        pairs_.once[first + l] += weight(f, scale, k) * sent.once[l];
        pairs_.deeper[first + l] += weight(f, scale, k) * sent.deeper[l];
      }
    }
  }

 private:
  color::Rgb weight(const PaintedPoint::Shares& f, double scale, std::size_t column) const {
    return (share_ * scale * f.of[column]) * tint_;
  }
  const LobePoint& point_;
  double share_;
  color::Rgb tint_{1, 1, 1};
  Pairs& pairs_;
};

LobePoint::Pairs LobePoint::pairs(int sequences, int directions, std::uint64_t seed) const {
  Pairs pairs{columns_.count(), {}, {}};
  pairs.once.resize(static_cast<std::size_t>(groups_.count) * pairs.columns * pairs.columns);
  pairs.deeper.resize(pairs.once.size());
  if (open_ || bounces_ == 0) return pairs;
  PairColumns receiver(*this, sequences * directions, pairs);
  const auto count = static_cast<std::uint32_t>(directions);
  for (int which = 0; which < sequences; ++which) {
    const Sequence sequence(mixed(seed, static_cast<std::uint64_t>(which)), count);
    sample(sequence, 0, count, receiver);
    sample_mirror(sequence.other(0x4D), 0, count, 1, receiver);
  }
  return pairs;
}

}  // namespace goniochrome::render
