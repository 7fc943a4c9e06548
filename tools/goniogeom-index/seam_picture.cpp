#include "seam_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "display/display.h"
#include "image/label.h"
#include "panels/seam.h"
#include "render/renderer.h"
#include "report/plot.h"

namespace goniochrome::tool {

namespace {

constexpr int kWidth = 1280, kHeight = 720;
constexpr int kScaleWidth = 28, kScaleHeight = 480, kScaleRight = 120, kScaleTop = 120;
using Color = std::array<float, 3>;
constexpr Color kWhite{1, 1, 1}, kBlack{0, 0, 0};

// From dark blue by green to yellow and red: lightness rises up to the yellow, so that it reads in gray, too.
Color scale_color(double part) {
  static constexpr std::array<Color, 5> kStops = {Color{0.10F, 0.15F, 0.45F},
                                                  {0.05F, 0.50F, 0.60F},
                                                  {0.35F, 0.75F, 0.30F},
                                                  {1.00F, 0.85F, 0.15F},
                                                  {0.85F, 0.10F, 0.10F}};
  const double at = std::clamp(part, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), kStops.size() - 2);
  const auto f = static_cast<float>(at - static_cast<double>(i));
  Color color;
  for (int c = 0; c < 3; ++c) color[c] = (1 - f) * kStops[i][c] + f * kStops[i + 1][c];
  return color;
}

paint::LobeFit matt(double reflectance) {
  paint::LobeFit fit;
  fit.diffuse = (reflectance / M_PI) * color::Rgb{1, 1, 1};
  return fit;
}

void draw_dot(image::Image& image, double x, double y, double radius, const Color& color) {
  for (int j = static_cast<int>(y - radius); j <= static_cast<int>(y + radius); ++j)
    for (int i = static_cast<int>(x - radius); i <= static_cast<int>(x + radius); ++i)
      if (std::hypot(i + 0.5 - x, j + 0.5 - y) <= radius) image::fill_box(image, i, j, 1, 1, color);
}

void draw_scale(image::Image& image, const SeamPicture& picture, double most) {
  const int left = kWidth - kScaleRight;
  for (int row = 0; row < kScaleHeight; ++row)
    image::fill_box(image, left, kScaleTop + kScaleHeight - 1 - row, kScaleWidth, 1,
                    scale_color((row + 0.5) / kScaleHeight));
  const auto row_of = [&](double value) {
    return kScaleTop + static_cast<int>(std::lround((1 - value / most) * kScaleHeight));
  };
  for (const double tick : report::ticks(0, most, false, 6)) {
    image::fill_box(image, left + kScaleWidth, row_of(tick) - 1, 6, 2, kWhite);
    image::draw_label(image, left + kScaleWidth + 10, row_of(tick) - image::label_height(2) / 2, shortest(tick), 2,
                      kWhite);
  }
  image::draw_label(image, left - 8, kScaleTop - 30, "dE max", 2, kWhite);
  if (picture.threshold >= most) return;
  const std::string text = fmt::format("threshold {}", shortest(picture.threshold));
  image::fill_box(image, left - 10, row_of(picture.threshold) - 1, kScaleWidth + 10, 2, kWhite);
  image::draw_label(image, left - 16 - image::label_width(text, 2),
                    row_of(picture.threshold) - image::label_height(2) / 2, text, 2, kWhite);
}

}  // namespace

Result<image::Image> seam_picture(const mesh::Mesh& mesh, const SeamRequest& request, const mesh::Seam& seam,
                                  const SeamPicture& picture) {
  render::Scene scene;
  scene.mesh = &mesh;
  for (const mesh::MeshPart& part : mesh.parts)
    scene.paints.push_back(matt(part.name == request.world.part_a || part.name == request.world.part_b ? 0.5 : 0.16));
  const render::Camera camera = panels::seam_camera(seam, static_cast<double>(kWidth) / kHeight, 30, 1.25);
  const Vec3 to_eye = normalized(camera.eye - camera.target), side = normalized(cross({0, 1, 0}, to_eye));
  scene.lights = {{normalized(to_eye + 0.8 * Vec3{0, 1, 0} + 0.7 * side), {0.75, 0.75, 0.75}},
                  {normalized(to_eye - 0.9 * side), {0.3, 0.3, 0.3}}};
  render::Renderer renderer = render::Renderer::tracing();
  GONIO_TRY(renderer.load(scene, "cpu"));
  GONIO_ASSIGN(const render::Frame frame, renderer.draw(camera, kWidth, kHeight, 4));
  GONIO_ASSIGN(const display::Display display, display::Display::make(""));
  GONIO_ASSIGN(image::Image image, display.image(frame.picture, 0));

  double most = 0;
  for (const panels::SeamDifference& place : picture.places)
    if (place.views > 0) most = std::max(most, place.max);
  most = std::max({most, 1e-3, std::min(picture.threshold * 1.2, 3 * most)});
  const auto dots = [&](double radius, bool outline) {
    for (std::size_t i = 0; i < seam.points.size(); ++i) {
      const mesh::SeamPoint& p = seam.points[i];
      const Vec3 middle = 0.5 * (p.a + p.b);
      const auto at = panels::projected(camera, frame.gbuffer->rays, middle);
      if (!at || dot(p.normal_a + p.normal_b, camera.eye - middle) <= 0) continue;
      const bool seen = picture.places[i].views > 0;
      draw_dot(image, at->x, at->y, radius,
               outline ? kBlack : (seen ? scale_color(picture.places[i].max / most) : Color{0.5F, 0.5F, 0.5F}));
    }
  };
  dots(6, true);
  dots(4.5, false);
  draw_scale(image, picture, most);
  image::draw_label(image, 24, 24, picture.title, 3, kWhite);
  return image;
}

}  // namespace goniochrome::tool
