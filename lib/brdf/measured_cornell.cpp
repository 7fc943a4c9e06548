// Cornell's gonioreflectometer files: text, scattered direction pairs, a spectrum for each.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/internal/measured_formats.h"

namespace goniochrome::brdf {

namespace {

constexpr double kSameDirection_deg = 0.05;  // nearer is the sample itself

// A viewing direction as seen from the mirror direction of its light, in degrees: `toward` the normal (signed, the
// aspecular angle in plane) and `across` the plane of incidence (folded to >= 0: the sample is isotropic).
struct Offset {
  double toward = 0, across = 0;
};
double distance(const Offset& a, const Offset& b) {
  return std::hypot(a.toward - b.toward, a.across - b.across);
}

Offset aspecular_offset(const Vec3& light, const Vec3& view) {
  const double sine = std::hypot(light.x, light.y);
  const Vec3 ahead = sine > 0 ? Vec3{light.x / sine, light.y / sine, 0} : Vec3{1, 0, 0};
  const Vec3 mirror = {-light.x, -light.y, light.z};
  const Vec3 toward = light.z * ahead + Vec3{0, 0, sine};
  const double angle_deg = std::atan2(length(cross(mirror, view)), dot(mirror, view)) / kDegree;
  const double along = dot(view, toward), beside = std::abs(dot(view, cross({0, 0, 1}, ahead)));
  const double size = std::hypot(along, beside);
  if (size == 0) return {angle_deg, 0};
  const double across = angle_deg * beside / size;
  constexpr double kInPlane_deg = 1e-3;  // angles in the file are rounded to 1e-6 rad
  return across < kInPlane_deg ? Offset{std::copysign(angle_deg, along), 0} : Offset{angle_deg * along / size, across};
}

struct Share {
  std::size_t index;
  double weight;
};

// The samples of one incidence angle.
struct Ring {
  double incidence_deg = 0;
  std::vector<Offset> offsets;
  std::vector<std::size_t> rows;
};

// The vertices of the Delaunay triangle around `at`, with barycentric weights; fewer on an edge or a vertex, none
// outside the convex hull.
//
// Lift each point onto the paraboloid z = |p - at|^2. The triangle is the facet of the lower convex hull over `at`,
// that is, the vertices of the solution of
//     minimize sum l_i |p_i - at|^2   with   sum l_i (p_i - at) = 0,  sum l_i = 1,  l_i >= 0,
// found by the simplex method from three far and costly points. In plane (across = 0, the border of the hull) only
// points in plane can balance, so there it is the plain interpolation between neighbors in aspecular angle.
std::vector<Share> delaunay_shares(const std::vector<Offset>& points, const Offset& at) {
  struct Vertex {
    double x, y, cost;
  };
  constexpr double kFar_deg = 1e3, kFarCost = 1e9, kInside = 1e-6;
  const std::size_t n = points.size();
  const auto vertex = [&](std::size_t i) -> Vertex {
    if (i < n) {
      const double x = points[i].toward - at.toward, y = points[i].across - at.across;
      return {x, y, x * x + y * y};
    }
    const double turn = 2 * kPi / 3 * static_cast<double>(i - n) + 0.1;
    return {kFar_deg * std::cos(turn), kFar_deg * std::sin(turn), kFarCost};
  };
  std::array<std::size_t, 3> basis = {n, n + 1, n + 2};
  std::array<double, 3> weight{};
  // A few dozen rounds suffice, unless many points lie on one circle, where the search may go round among equals: then
  // any of the triangles is one.
  const std::size_t most_rounds = 100 + 10 * std::min<std::size_t>(n, 20);
  for (std::size_t round = 0; round < most_rounds; ++round) {
    const Vertex a = vertex(basis[0]), b = vertex(basis[1]), c = vertex(basis[2]);
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    const auto barycentric = [&](double x, double y) -> std::array<double, 3> {
      const double wb = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
      const double wc = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
      return {1 - wb - wc, wb, wc};
    };
    weight = barycentric(0, 0);
    const double slope_x = ((b.cost - a.cost) * (c.y - a.y) - (c.cost - a.cost) * (b.y - a.y)) / area;
    const double slope_y = ((b.x - a.x) * (c.cost - a.cost) - (c.x - a.x) * (b.cost - a.cost)) / area;
    std::size_t entering = n;
    double deepest = -1e-9 * (1 + std::abs(a.cost));
    for (std::size_t i = 0; i < n; ++i) {
      const Vertex p = vertex(i);
      const double below = p.cost - a.cost - slope_x * (p.x - a.x) - slope_y * (p.y - a.y);
      if (below < deepest && i != basis[0] && i != basis[1] && i != basis[2]) deepest = below, entering = i;
    }
    if (entering == n) break;
    const Vertex p = vertex(entering);
    const auto direction = barycentric(p.x, p.y);
    std::size_t leaving = 3;
    double step = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double limit = std::max(weight[k], 0.0) / direction[k];
      if (direction[k] > 1e-10 && (leaving == 3 || limit < step)) leaving = k, step = limit;
    }
    if (leaving == 3) break;
    basis[leaving] = entering;
  }
  std::vector<Share> shares;
  double total = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (weight[k] < kInside) continue;
    if (basis[k] >= n) return {};
    shares.push_back({basis[k], weight[k]});
    total += weight[k];
  }
  for (Share& share : shares) share.weight /= total;
  return shares;
}

// Square roots flatten a flake lobe, so that a straight line between samples errs less; the sign survives.
double root(double f) {
  return std::copysign(std::sqrt(std::abs(f)), f);
}
double unroot(double r) {
  return std::copysign(r * r, r);
}

class CornellBrdf final : public MeasuredBrdf {
 public:
  struct Row {
    paint::DirectionPair pair;
    std::vector<double> f;
  };

  CornellBrdf(MeasuredTraits traits, std::vector<Row> rows) : MeasuredBrdf(std::move(traits)), rows_(std::move(rows)) {
    constexpr double kSameIncidence_deg = 0.5;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < rows_.size(); ++i) order.push_back({polar_angle(rows_[i].pair.light) / kDegree, i});
    std::sort(order.begin(), order.end());
    for (const auto& [incidence_deg, i] : order) {
      if (rings_.empty() || incidence_deg > rings_.back().incidence_deg + kSameIncidence_deg)
        rings_.push_back({incidence_deg, {}, {}});
      rings_.back().offsets.push_back(aspecular_offset(rows_[i].pair.light, rows_[i].pair.view));
      rings_.back().rows.push_back(i);
    }
  }

  // Each measured incidence answers at the same offset from its own mirror direction; two neighbors are blended.
  MeasuredValue value(const Vec3& light, const Vec3& view) const override {
    const double incidence_deg = polar_angle(light) / kDegree;
    const Offset at = aspecular_offset(light, view);
    std::size_t high = 0;
    while (high + 1 < rings_.size() && rings_[high].incidence_deg < incidence_deg) ++high;
    const std::size_t low = high > 0 && rings_[high].incidence_deg > incidence_deg ? high - 1 : high;
    const double step_deg = rings_[high].incidence_deg - rings_[low].incidence_deg;
    const double share = step_deg > 0 ? (incidence_deg - rings_[low].incidence_deg) / step_deg : 1;

    MeasuredValue result;
    result.outside_deg = std::max({0.0, rings_.front().incidence_deg - incidence_deg - kSameDirection_deg,
                                   incidence_deg - rings_.back().incidence_deg - kSameDirection_deg});
    std::vector<double> sum(traits().wavelengths_nm.size(), 0.0);
    const bool both = std::min(share, 1 - share) * step_deg > kSameDirection_deg;
    if (both) result.gap_deg = step_deg;
    if (both || share <= 0.5) add(rings_[low], at, both ? 1 - share : 1, sum, result);
    if (both || share > 0.5) add(rings_[high], at, both ? share : 1, sum, result);
    for (double& r : sum) r = unroot(r);
    result.f = std::move(sum);
    return result;
  }

  std::vector<paint::DirectionPair> samples() const override {
    std::vector<paint::DirectionPair> result;
    for (const Row& row : rows_) result.push_back(row.pair);
    return result;
  }

  // The measured rows themselves, away from specular and grazing. Of very many, which each cost a search among all,
  // some are taken throughout the file.
  std::vector<paint::DirectionPair> probes() const override {
    constexpr std::size_t kMostProbes = 1000;
    const std::size_t every = (rows_.size() + kMostProbes - 1) / kMostProbes;
    std::vector<paint::DirectionPair> result;
    for (std::size_t i = 0; i < rows_.size(); i += every) {
      const Row& row = rows_[i];
      const Offset offset = aspecular_offset(row.pair.light, row.pair.view);
      const double steepest = std::max(polar_angle(row.pair.light), polar_angle(row.pair.view));
      if (std::hypot(offset.toward, offset.across) > 15 && steepest < 75 * kDegree) result.push_back(row.pair);
    }
    return result;
  }

 private:
  void add(const Ring& ring, const Offset& at, double weight, std::vector<double>& sum, MeasuredValue& result) const {
    auto shares = delaunay_shares(ring.offsets, at);
    if (shares.empty()) {
      const auto nearest =
          std::min_element(ring.offsets.begin(), ring.offsets.end(),
                           [&](const auto& a, const auto& b) { return distance(a, at) < distance(b, at); });
      result.outside_deg = std::max(result.outside_deg, distance(*nearest, at));
      shares.push_back({static_cast<std::size_t>(nearest - ring.offsets.begin()), 1.0});
    }
    const bool hit = std::ranges::any_of(
        shares, [&](const Share& share) { return distance(ring.offsets[share.index], at) < kSameDirection_deg; });
    for (const Share& a : shares) {
      for (const Share& b : shares)
        if (!hit) result.gap_deg = std::max(result.gap_deg, distance(ring.offsets[a.index], ring.offsets[b.index]));
      const std::vector<double>& f = rows_[ring.rows[a.index]].f;
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * a.weight * root(f[k]);
    }
  }

  std::vector<Row> rows_;
  std::vector<Ring> rings_;
};

Vec3 direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad),
          std::cos(polar_rad)};
}

class CornellParser {
 public:
  CornellParser(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  Result<MeasuredPointer> parse() {
    GONIO_TRY(wavelengths());
    while (next_line()) GONIO_TRY(row());
    if (rows_.empty()) return input_error("{}: holds no measured directions", path_);
    if (traits_.negative) traits_.negative_rms = std::sqrt(negative_square_ / static_cast<double>(traits_.negative));
    return MeasuredPointer(std::make_unique<CornellBrdf>(std::move(traits_), std::move(rows_)));
  }

 private:
  // The numbers of the next line that has any; comments go to the description until the numbers begin.
  bool next_line() {
    words_.clear();
    while (words_.empty() && !text_.empty()) {
      const auto end = std::min(text_.find('\n'), text_.size());
      std::string_view line = trimmed(text_.substr(0, end));
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (line.starts_with('#')) {
        const auto words = trimmed(line.substr(1));
        if (traits_.wavelengths_nm.empty() && !counted_ && !words.empty() && words != "num wls")
          traits_.description += (traits_.description.empty() ? "" : "; ") + std::string(words);
        continue;
      }
      for (std::size_t at = 0; at < line.size();) {
        const auto stop = std::min(line.find_first_of(" \t", at), line.size());
        if (stop > at) words_.push_back(line.substr(at, stop - at));
        at = stop + 1;
      }
    }
    return !words_.empty();
  }

  Error error(std::string_view what) const { return input_error("{}:{}: {}", path_, line_, what); }

  Result<double> number(std::string_view word) const {
    const auto value = parse_number(word);
    if (!value) return error(fmt::format("\"{}\" is not a number", word.substr(0, 40)));
    return *value;
  }

  Result<void> wavelengths() {
    if (!next_line()) return input_error("{}: is empty", path_);
    const auto count = words_.size() == 1 ? parse_integer(words_[0]) : std::nullopt;
    if (!count || *count < 2 || *count > 10000)
      return error("a spectral .brdf begins with the number of its wavelengths alone on a line");
    counted_ = true;
    while (traits_.wavelengths_nm.size() < static_cast<std::size_t>(*count)) {
      if (!next_line()) return error("the file ends within the list of wavelengths");
      for (const auto word : words_) {
        GONIO_ASSIGN(const double nm, number(word));
        if (nm < 100 || nm > 5000) return error(fmt::format("wavelength {}: give nanometers", word));
        if (!traits_.wavelengths_nm.empty() && nm <= traits_.wavelengths_nm.back())
          return error(fmt::format("wavelength {} does not ascend", word));
        traits_.wavelengths_nm.push_back(nm);
      }
    }
    if (traits_.wavelengths_nm.size() > static_cast<std::size_t>(*count))
      return error(fmt::format("there are more wavelengths than the {} announced", *count));
    return {};
  }

  Result<void> row() {
    const std::size_t channels = traits_.wavelengths_nm.size();
    if (words_.size() != 4 + channels)
      return error(
          fmt::format("{} numbers where 4 angles and {} wavelengths make {}", words_.size(), channels, 4 + channels));
    std::array<double, 4> angles{};
    for (std::size_t k = 0; k < 4; ++k) {
      GONIO_ASSIGN(angles[k], number(words_[k]));
    }
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}})
      if (angles[k] < 0 || angles[k] > kPi / 2 + 1e-6)
        return error(fmt::format("theta is {}: give radians from the normal, 0 to 1.5708", words_[k]));
    CornellBrdf::Row row{{direction(angles[0], angles[1]), direction(angles[2], angles[3])}, {}};
    for (std::size_t k = 0; k < channels; ++k) {
      GONIO_ASSIGN(const double f, number(words_[4 + k]));
      count_sample(f, traits_, negative_square_);
      row.f.push_back(f);
    }
    rows_.push_back(std::move(row));
    return {};
  }

  const std::string& path_;
  std::string_view text_;
  std::vector<std::string_view> words_;
  int line_ = 0;
  bool counted_ = false;
  MeasuredTraits traits_{.format = "cornell", .scattered = true};
  double negative_square_ = 0;
  std::vector<CornellBrdf::Row> rows_;
};

bool looks_cornell(std::string_view path, std::string_view) {
  return lower(path).ends_with(".brdf");
}

Result<MeasuredPointer> read_cornell(const std::string& path, std::string_view text) {
  return CornellParser(path, text).parse();
}

}  // namespace

const MeasuredFormat kCornell = {looks_cornell, read_cornell, "Cornell .brdf"};

}  // namespace goniochrome::brdf
