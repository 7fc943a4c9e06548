#include "hud.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/encode.h"
#include "base/text.h"
#include "display/display.h"
#include "image/byte_image.h"
#include "paint/curve.h"
#include "plane.h"

namespace goniochrome::tool {

namespace {

constexpr float kNothing_deg = 180;                    // where there is no surface
constexpr double kUnseen_deg = 179.9, kEdge_deg = 20;  // a larger step between neighbors is an edge of the mesh
constexpr int kLine = 28, kLegend = 3 * kLine + 8, kLeastWidth = 440;  // px, below the view

struct Ring {
  double angle_deg;
  std::string name;
  const char* color;
};

}  // namespace

// Marching squares. Of a saddle, two corners on each side of the level, the middle of the cell decides.
std::string ring_path(const std::vector<float>& values, int width, int height, double level) {
  std::string path;
  const auto at = [&](int x, int y) {
    return static_cast<double>(
        values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]);
  };
  for (int y = 0; y + 1 < height; ++y) {
    for (int x = 0; x + 1 < width; ++x) {
      // Around the cell: upper left, upper right, lower right, lower left.
      const std::array<double, 4> v = {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)};
      const auto [low, high] = std::ranges::minmax(v);
      if (high >= kUnseen_deg || high - low > kEdge_deg || low >= level || high < level) continue;
      constexpr std::array<std::array<double, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
      std::vector<std::array<double, 2>> crossings;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        if ((v[i] < level) == (v[j] < level)) continue;
        const double t = (level - v[i]) / (v[j] - v[i]);
        crossings.push_back({x + 0.5 + kCorner[i][0] + t * (kCorner[j][0] - kCorner[i][0]),
                             y + 0.5 + kCorner[i][1] + t * (kCorner[j][1] - kCorner[i][1])});
      }
      // The crossings of a saddle are in order around the cell: each is joined to its neighbor about a corner that lies
      // on the other side than the middle.
      const bool middle_below = (v[0] + v[1] + v[2] + v[3]) / 4 < level;
      const std::size_t first = crossings.size() == 4 && (v[0] < level) != middle_below ? 3 : 0;
      for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
        const auto &a = crossings[(first + k) % crossings.size()], &b = crossings[(first + k + 1) % crossings.size()];
        path += fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}", a[0], a[1], b[0], b[1]);
      }
    }
  }
  return path;
}

Result<HudView> read_hud_view(const std::string& path) {
  GONIO_ASSIGN(const image::AovFile file, image::read_aov_file(path, {"R", "G", "B", "A", "aspecular"}));
  HudView view;
  view.width = file.image.width, view.height = file.image.height;
  image::Image picture{view.width, view.height, 4, {}, {}};
  std::array<int, 5> channels{};
  constexpr std::array kNames = {"R", "G", "B", "A", "aspecular"};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    GONIO_ASSIGN(channels[c], file.channel(kNames[c]));
  }
  const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height),
                    step = static_cast<std::size_t>(file.image.channels);
  picture.data.resize(4 * pixels), view.aspecular.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float* pixel = &file.image.data[i * step];
    for (std::size_t c = 0; c < 4; ++c) picture.data[4 * i + c] = pixel[channels[c]];
    const float angle = pixel[channels[4]];
    view.aspecular[i] = std::isfinite(angle) ? angle : kNothing_deg;
  }
  if (std::ranges::all_of(view.aspecular, [](float angle) { return !(angle < kUnseen_deg); }))
    return input_error("{}: nothing of a mesh is seen in it", path);
  GONIO_ASSIGN(const display::Display shown, display::Display::make(""));
  image::ByteImage bytes;
  GONIO_TRY(shown.show(picture, file.automatic_stops - file.exposure_stops, bytes));
  view.png = image::png_content(bytes);
  return view;
}

Result<report::Drawing> hud_drawing(const paint::Paint& paint, const HudView& view) {
  GONIO_ASSIGN(const paint::TargetCurve curve, paint::TargetCurve::make(paint, paint::TargetCurve::Kind::kMeasured));
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(paint)));
  paint::Appearance appearance;
  if (paint.appearance) {
    appearance = *paint.appearance;
  } else {
    GONIO_ASSIGN(const paint::AppearanceFit fit, paint::appearance_from_rows(paint.measurement->rows));
    appearance = fit.appearance;
  }
  const double travel = appearance.travel_deg;
  const std::array<Ring, 3> rings = {{{paint::kFaceAngle_deg, "15 deg, face", "#ffd41a"},
                                      {45, "45 deg", "#33e6ff"},
                                      {travel, fmt::format("{:.1f} deg, travel", travel), "#ff73e6"}}};
  report::Drawing drawing{std::max(view.width, kLeastWidth), view.height + kLegend, ""};
  drawing.body = fmt::format(R"(<image width="{}" height="{}" href="data:image/png;base64,{}"/>)", view.width,
                             view.height, base64(view.png));
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Ring& ring = rings[i];
    const std::string line = ring_path(view.aspecular, view.width, view.height, ring.angle_deg);
    // A dark line beneath keeps the ring in sight on light paints.
    for (const auto& [color, wide] : {std::pair{"#000000", 3.4}, std::pair{ring.color, 1.8}})
      drawing.body += fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="{}" stroke-linecap="round"/>)",
                                  line, color, wide);
    const color::Lab lab = curve.at(ring.angle_deg);
    const double y = view.height + 8 + kLine * static_cast<double>(i);
    drawing.body += fmt::format(
        R"(<rect x="10" y="{:.1f}" width="40" height="18" fill="{}" stroke="#000" stroke-width="4"/>)"
        R"(<rect x="10" y="{:.1f}" width="40" height="18" fill="none" stroke="{}" stroke-width="2.4"/>)"
        R"(<text x="60" y="{:.1f}" font-size="13">{}{}</text>)"
        R"(<text x="{}" y="{:.1f}" font-size="13" text-anchor="end">L* {:.1f}  a* {:.1f}  b* {:.1f}</text>)",
        y, css(lab, white), y, ring.color, y + 14, ring.name, line.empty() ? ": not in this view" : "",
        drawing.width - 10, y + 14, lab.L, lab.a, lab.b);
  }
  return drawing;
}

}  // namespace goniochrome::tool
