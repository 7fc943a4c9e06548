#include "envmap/internal/mirror_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/vec3.h"

namespace goniochrome::envmap {

namespace {

// Pixels darker than this part of the picture's mean count as dark ground.
constexpr double kDark = 1e-3;

double brightness(const image::Image& rgb, int x, int y) {
  const float* texel = rgb.pixel(x, y);
  return std::max({texel[0], texel[1], texel[2]});
}

double mean_brightness(const image::Image& rgb) {
  double sum = 0;
  for (int y = 0; y < rgb.height; ++y)
    for (int x = 0; x < rgb.width; ++x) sum += brightness(rgb, x, y);
  return sum / (static_cast<double>(rgb.width) * rgb.height);
}

// The number of corners with light. A corner is a square whose side is a tenth of the picture's shorter side, which the
// disc of a square picture does not reach.
int lit_corners(const image::Image& rgb) {
  const double dark = kDark * mean_brightness(rgb);
  const int n = std::max(1, std::min(rgb.width, rgb.height) / 10);
  int lit = 0;
  for (const int left : {0, rgb.width - n})
    for (const int top : {0, rgb.height - n}) {
      int bright = 0;
      for (int y = top; y < top + n; ++y)
        for (int x = left; x < left + n; ++x) bright += brightness(rgb, x, y) > dark;
      lit += 2 * bright > n * n;
    }
  return lit;
}

struct Point {
  double x = 0, y = 0;
};

double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners of the convex hull of the lit texels' centers: the monotone chain of the outermost texels of each row.
std::vector<Point> lit_hull(const image::Image& rgb) {
  const double dark = kDark * mean_brightness(rgb);
  std::vector<Point> ends;
  for (int y = 0; y < rgb.height; ++y) {
    int first = 0, last = rgb.width - 1;
    while (first < rgb.width && brightness(rgb, first, y) <= dark) ++first;
    if (first == rgb.width) continue;
    while (brightness(rgb, last, y) <= dark) --last;
    ends.push_back({first + 0.5, y + 0.5});
    ends.push_back({last + 0.5, y + 0.5});
  }
  std::ranges::sort(ends, {}, [](const Point& p) { return std::pair(p.x, p.y); });
  std::vector<Point> hull;
  const auto walk = [&](auto begin, auto end) {
    const std::size_t start = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
      hull.push_back(*p);
    }
    if (!hull.empty()) hull.pop_back();
  };
  walk(ends.begin(), ends.end());
  walk(ends.rbegin(), ends.rend());
  return hull;
}

// The circle x^2 + y^2 = 2 a x + 2 b y + c nearest to the points by least squares [Kasa1976]. Points are taken from
// their mean, where the sums of x and of y vanish.
BallDisc circle_through(const std::vector<Point>& points) {
  Point mean;
  const auto n = static_cast<double>(points.size());
  for (const Point& p : points) mean.x += p.x / n, mean.y += p.y / n;
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
  for (const Point& p : points) {
    const double x = p.x - mean.x, y = p.y - mean.y, z = x * x + y * y;
    xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z, zz += z;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-9 * zz * zz)) return {};
  const double a = (xz * yy - yz * xy) / (2 * determinant), b = (yz * xx - xz * xy) / (2 * determinant);
  return {mean.x + a, mean.y + b, std::sqrt(zz / n + a * a + b * b)};
}

double distance(const BallDisc& disc, const Point& p) {
  return std::hypot(p.x - disc.x, p.y - disc.y) - disc.radius;
}

// A part of the ball that reflects a dark room cuts chords from the hull, whose ends lie inside of the circle: points
// that are far from the circle are left out and the rest fitted again.
Result<BallDisc> circle_about(std::vector<Point> hull, const image::Image& rgb, const std::string& name) {
  // Where the picture ends, the outline is the picture's and not the ball's.
  std::erase_if(hull,
                [&](const Point& p) { return p.x < 1 || p.y < 1 || p.x > rgb.width - 1 || p.y > rgb.height - 1; });
  BallDisc disc;
  for (int round = 0; round < 20 && hull.size() >= 3; ++round) {
    disc = circle_through(hull);
    const double most = 1 + 0.005 * disc.radius;
    const std::size_t before = hull.size();
    double worst = 0;
    for (const Point& p : hull) worst = std::max(worst, std::fabs(distance(disc, p)));
    const double limit = std::max(most, 0.7 * worst);
    std::erase_if(hull, [&](const Point& p) { return std::fabs(distance(disc, p)) > limit; });
    if (hull.size() == before) break;
  }
  std::array<bool, 24> seen{};
  for (const Point& p : hull)
    seen[static_cast<std::size_t>((std::atan2(p.y - disc.y, p.x - disc.x) / kPi + 1) * 12) % 24] = true;
  if (hull.size() < 8 || disc.radius < 2 || std::count(seen.begin(), seen.end(), true) < 14)
    return input_error(
        "{}: what is lit in front of the dark ground has no round outline: say where the ball lies, in texels, with "
        "--ball X,Y,RADIUS",
        name);
  return disc;
}

// The photograph at a place, from the texels that lie wholly on the ball.
class BallTexels {
 public:
  BallTexels(const image::Image& rgb, const BallDisc& disc) : rgb_(rgb), disc_(disc) {}

  // Bilinear at (x, y), which is at most one texel's diagonal from a texel that lies on the ball.
  Vec3 at(double x, double y) const {
    const int left = static_cast<int>(std::floor(x - 0.5)), top = static_cast<int>(std::floor(y - 0.5));
    Vec3 sum;
    double weights = 0;
    for (int j = top; j <= top + 1; ++j)
      for (int i = left; i <= left + 1; ++i) {
        if (!is_on_ball(i, j)) continue;
        const double weight = (1 - std::fabs(x - 0.5 - i)) * (1 - std::fabs(y - 0.5 - j));
        sum = sum + weight * vec3(rgb_.pixel(i, j));
        weights += weight;
      }
    if (weights > 1e-6) return (1 / weights) * sum;
    return at(x + 0.25 * (disc_.x - x) / disc_.radius, y + 0.25 * (disc_.y - y) / disc_.radius);
  }

 private:
  bool is_on_ball(int column, int row) const {
    if (column < 0 || row < 0 || column >= rgb_.width || row >= rgb_.height) return false;
    const double x = std::fabs(column + 0.5 - disc_.x) + 0.5, y = std::fabs(row + 0.5 - disc_.y) + 0.5;
    return std::hypot(x, y) <= disc_.radius;
  }

  const image::Image& rgb_;
  const BallDisc& disc_;
};

}  // namespace

bool has_lit_corners(const image::Image& rgb) {
  return lit_corners(rgb) >= 3;
}

Result<BallDisc> ball_disc(const image::Image& rgb, const std::string& name) {
  if (lit_corners(rgb) == 0) return circle_about(lit_hull(rgb), rgb, name);
  if (rgb.width == rgb.height) return BallDisc{rgb.width / 2.0, rgb.height / 2.0, rgb.width / 2.0};
  return input_error(
      "{}: the ball's outline cannot be told from its background: cut the picture to the square about the ball, or say "
      "where the ball lies, in texels, with --ball X,Y,RADIUS",
      name);
}

// The normal n of the ball at the distance r (in radii) from its middle has n_z = sqrt(1 - r^2); a ray from the camera
// at +Z leaves in the direction d = 2 n_z n - z, so that n is halfway between d and z. A texel of the map covers, near
// -Z, a long thin arc of the picture; it is cut into as many parts as that needs.
Result<image::Image> unrolled_ball(const image::Image& rgb, const BallDisc& disc, const std::string& name) {
  const double slack = 1 + 1e-9 * disc.radius;
  if (!(disc.radius >= 2)) return input_error("{}: the ball's radius is {} texels: give 2 or more", name, disc.radius);
  if (disc.x - disc.radius < -slack || disc.y - disc.radius < -slack || disc.x + disc.radius > rgb.width + slack ||
      disc.y + disc.radius > rgb.height + slack)
    return input_error(
        "{}: the ball reaches from {:.1f},{:.1f} to {:.1f},{:.1f}, beyond the picture of {} x {}: the outer 30 % of "
        "its radius shows half of all directions, so take a picture of the whole ball",
        name, disc.x - disc.radius, disc.y - disc.radius, disc.x + disc.radius, disc.y + disc.radius, rgb.width,
        rgb.height);
  const int height = std::max(2, static_cast<int>(std::lround(kPi * disc.radius / 2)));
  image::Image map = image::even_image(2 * height, height, 3);
  const BallTexels ball(rgb, disc);
  parallel_for(static_cast<std::size_t>(height), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int column = 0; column < 2 * height; ++column) {
        const auto direction = [&](double x, double y) {
          const double theta = kPi * y / height, longitude = kPi * (1 - x / height);
          return Vec3{std::sin(theta) * std::sin(longitude), std::cos(theta), std::sin(theta) * std::cos(longitude)};
        };
        const double cosine = direction(column + 0.5, static_cast<double>(row) + 0.5).z;  // 2 n_z^2 - 1
        const int parts =
            std::clamp(static_cast<int>(std::ceil(2 / std::sqrt(std::max(0.0, (1 + cosine) / 2)))), 2, 24);
        Vec3 sum;
        for (int j = 0; j < parts; ++j)
          for (int i = 0; i < parts; ++i) {
            const Vec3 d = direction(column + (i + 0.5) / parts, static_cast<double>(row) + (j + 0.5) / parts);
            const double scale = 1 / std::max(1e-9, std::hypot(d.x, d.y, d.z + 1));
            sum = sum + ball.at(disc.x + disc.radius * scale * d.x, disc.y - disc.radius * scale * d.y);
          }
        for (int c = 0; c < 3; ++c)
          map.pixel(column, static_cast<int>(row))[c] = static_cast<float>(sum[c] / (parts * parts));
      }
  });
  return map;
}

}  // namespace goniochrome::envmap
