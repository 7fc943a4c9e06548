#include "map_page.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/angles.h"
#include "base/text.h"
#include "display/paint_view.h"
#include "report/lobe_drawings.h"

namespace goniochrome::tool {

namespace {

constexpr double kGlare_deg = 10, kGrazing_deg = 75;
constexpr auto kTreatment = brdf::CriticalAngle::kSlide;
constexpr int kMapWidth = 1080;

Vec3 direction(double angle_deg) {
  return {std::sin(angle_deg * kDegree), 0, std::cos(angle_deg * kDegree)};
}

double angle_between_deg(const Vec3& a, const Vec3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) / kDegree;
}

// The exposure at which a twentieth of the covered directions in plane is clipped.
double exposure_of(const brdf::ColorMap& map) {
  std::vector<double> values;
  for (double light = 0; light < 85; light += 2.5)
    for (double view = -85; view < 85; view += 2.5)
      if (is_covered(map, direction(light), direction(view)))
        values.push_back(
            color::luminance(brdf::reflectance_factor(map, direction(light), direction(view), kTreatment)));
  if (values.empty()) return 1;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 19 / 20);
  std::nth_element(values.begin(), at, values.end());
  return 0.8 / std::max(*at, 1e-4);
}

std::string css_of_scene(const color::Rgb& scene) {
  const color::Rgb rgb = color::rec709_from_rec2020(scene);
  int bytes[3];
  for (int c = 0; c < 3; ++c)
    bytes[c] = static_cast<int>(std::lround(255 * std::clamp(display::srgb_signal(rgb[c]), 0.0, 1.0)));
  return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
}

// A rectangle of cells. `pair` gives the directions of a cell whose center is at x and y, from 0 to 1, y downward;
// where the light or the viewer is below the surface the cell stays empty. A cell that is not covered gets a stroke.
std::string cells(const brdf::ColorMap& map, double exposure, int columns, int rows, double left, double top,
                  double width, double height, const std::function<std::pair<Vec3, Vec3>(double x, double y)>& pair) {
  std::string fills, strokes;
  const double w = width / columns, h = height / rows;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto [light, view] = pair((column + 0.5) / columns, (row + 0.5) / rows);
      if (light.z < 0.02 || view.z < 0.02) continue;
      const double x = left + column * w, y = top + row * h;
      const color::Rgb color = exposure * brdf::reflectance_factor(map, light, view, kTreatment);
      // A little overlap hides the seams between cells.
      fills += fmt::format(
          "<rect shape-rendering=\"crispEdges\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
          "fill=\"{}\"/>\n",
          x, y, w + 0.3, h + 0.3, css_of_scene(color));
      if (!is_covered(map, light, view)) strokes += fmt::format("M{:.2f} {:.2f}l{:.2f} {:.2f}", x, y + h, w, -h);
    }
  }
  // Black on white, so that the hatching is seen on any color.
  return fills + fmt::format(
                     "<path d=\"{0}\" stroke=\"#ffffff\" stroke-width=\"1.8\" fill=\"none\"/>\n"
                     "<path d=\"{0}\" stroke=\"#000000\" stroke-width=\"0.9\" fill=\"none\"/>\n",
                     strokes);
}

std::string label(double x, double y, const std::string& text, const char* anchor = "middle") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     xml_escaped(text, ""));
}

// Light from 0 to 85 deg upward, viewers from -85 deg (the side of the mirror direction) to 85 deg.
report::Drawing in_plane(const brdf::ColorMap& map, double exposure) {
  constexpr double kLeft = 70, kTop = 34, kPlot = 940, kHigh = 470, kMost_deg = 85;
  std::string out = "<text class=\"title\" x=\"12\" y=\"20\">Colors in the plane of incidence</text>\n";
  out += cells(map, exposure, 136, 68, kLeft, kTop, kPlot, kHigh, [&](double x, double y) {
    return std::pair{direction(kMost_deg * (1 - y)), direction(kMost_deg * (2 * x - 1))};
  });
  for (double view = -75; view <= 75; view += 25)
    out += label(kLeft + kPlot * (view / kMost_deg + 1) / 2, kTop + kHigh + 16, fmt::format("{:g}", view));
  for (double light = 0; light <= 75; light += 25)
    out += label(kLeft - 6, kTop + kHigh * (1 - light / kMost_deg) + 4, fmt::format("{:g}", light), "end");
  out += label(kLeft + kPlot / 2, kTop + kHigh + 34, "angle of the viewer (deg), positive on the side of the light");
  out += fmt::format(
      "<text x=\"20\" y=\"{0:.1f}\" text-anchor=\"middle\" transform=\"rotate(-90 20 {0:.1f})\">angle of the light "
      "(deg)</text>\n",
      kTop + kHigh / 2);
  return {kMapWidth, static_cast<int>(kTop + kHigh + 46), out};
}

// The hemisphere of viewers as a square, the light from the left.
report::Drawing hemisphere(const brdf::ColorMap& map, double exposure, double incidence_deg, int side) {
  const Vec3 light = direction(-incidence_deg);
  std::string out = fmt::format("<text class=\"title\" x=\"12\" y=\"20\">Light at {:g} deg</text>\n", incidence_deg);
  out += cells(map, exposure, 60, 60, 12, 30, side - 24, side - 24, [&](double x, double y) {
    return std::pair{light, report::hemisphere_direction(2 * x - 1, 1 - 2 * y)};
  });
  return {side, side + 20, out};
}

// The share of the pairs of directions above the surface that are covered, by equal areas of both hemispheres.
double covered_share(const brdf::ColorMap& map) {
  int covered = 0, all = 0;
  for (int l = 0; l < 20; ++l)
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) {
        const double z = (l + 0.5) / 20;
        const Vec3 light = {-std::sqrt(1 - z * z), 0, z};
        const Vec3 view = report::hemisphere_direction((2 * i + 1.0) / 20 - 1, (2 * j + 1.0) / 20 - 1);
        ++all, covered += is_covered(map, light, view);
      }
  return static_cast<double>(covered) / all;
}

}  // namespace

bool is_covered(const brdf::ColorMap& map, const Vec3& to_light, const Vec3& to_viewer) {
  const Vec3 mirror = {-to_light.x, -to_light.y, to_light.z};
  if (to_light.z < std::cos(kGrazing_deg * kDegree) || to_viewer.z < std::cos(kGrazing_deg * kDegree)) return false;
  if (angle_between_deg(mirror, to_viewer) < kGlare_deg) return false;
  if (!map.aspecular) {
    const brdf::FlakeAngles angles = brdf::flake_angles(to_light, to_viewer, map.index);
    if (angles.flake_rad + angles.incidence_rad > std::asin(1 / map.index)) return false;
  }
  if (map.distance_deg.empty()) return true;
  const brdf::MapPlace place = brdf::place_of_pair(map, to_light, to_viewer, kTreatment);
  const auto texel = [](double at, int count) { return std::clamp(static_cast<int>(at), 0, count - 1); };
  const int column = texel(place.x, map.size), row = texel(place.y, 2 * map.size);
  return map.distance_deg[static_cast<std::size_t>(row) * static_cast<std::size_t>(map.size) +
                          static_cast<std::size_t>(column)] <= kCovered_deg;
}

report::Drawing map_page(const std::string& paint, const brdf::ColorMap& map,
                         const std::vector<double>& incidence_deg) {
  const double exposure = exposure_of(map);
  const std::string told = fmt::format("{}, {:.0f} % of all pairs of directions are covered; the others are hatched",
                                       map.aspecular ? "a function of the aspecular angle alone"
                                                     : fmt::format("isolines in a coat of index {:g}", map.index),
                                       100 * covered_share(map));
  std::vector<report::Drawing> rows = {
      {kMapWidth, 54,
       fmt::format("<text x=\"12\" y=\"24\" style=\"font-size:18px;font-weight:bold\">{}, color map</text>\n"
                   "<text x=\"12\" y=\"44\">{}</text>\n",
                   xml_escaped(paint, ""), xml_escaped(told, ""))},
      in_plane(map, exposure)};
  const int side = std::clamp(kMapWidth / std::max<int>(1, static_cast<int>(incidence_deg.size())), 120, 360);
  std::vector<report::Drawing> squares;
  for (const double incidence : incidence_deg) squares.push_back(hemisphere(map, exposure, incidence, side));
  rows.push_back(report::row_of(squares));
  return report::column_of(rows);
}

}  // namespace goniochrome::tool
