// A sphere with buffers, shaded by the exact lobe model, for the tests of sketch fitting alone.
#pragma once

#include <cmath>
#include <random>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "fit/paint_fit.h"
#include "paint/geometry.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch::sketch_scene {

inline const formats::Basis& basis() {
  static const formats::Basis b7{"b7", {1.3, 6, 20, 70, 250, 900, 3000}, true};
  return b7;
}

// Designed metallics: lighter and mostly more chromatic at the face, travel 35 to 110 deg, any gloss.
inline paint::Paint random_paint(std::mt19937_64& random) {
  const auto in = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const double hue = in(0, 2 * kPi), chroma = in(5, 55), light = in(45, 110), dark = in(12, 0.75 * light);
  const double flop_chroma = in(0.3, 0.9) * chroma * std::min(1.0, dark / 30), flop_hue = hue + in(-0.4, 0.4);
  paint::Paint paint;
  paint.appearance = paint::Appearance{{light, chroma * std::cos(hue), chroma * std::sin(hue)},
                                       {dark, flop_chroma * std::cos(flop_hue), flop_chroma * std::sin(flop_hue)},
                                       in(35, 110),
                                       std::nullopt};
  paint.gloss.push_back({60, in(0, 95)});
  return paint;
}

// Without a coat, so that pictures that know nothing of the view are those of its lobes.
inline const fit::PaintFitter& fitter() {
  static const fit::PaintFitter one(basis(), [] {
    fit::FitOptions options;
    options.coat_index = paint::kNoCoat;
    return options;
  }());
  return one;
}

inline paint::LobeFit lobes(const paint::Paint& paint) {
  return fitter().fit(paint)->lobes;
}

// The buffers of a unit sphere seen from +Z, nearly from infinity, with one part named Ball.
inline image::AovFile sphere(int size, const Vec3& to_light) {
  image::AovFile file;
  file.path = "sphere.exr";
  file.light = normalized(to_light);
  file.lights = {{file.light, {1, 1, 1}}};
  const double pixel = 1e-4;
  file.corner = {-0.5 * size * pixel, 0.5 * size * pixel, -1}, file.right = {pixel, 0, 0}, file.down = {0, -pixel, 0};
  file.has_rays = true;
  file.parts = {"Ball"};
  file.image = {size,
                size,
                11,
                {},
                {"R", "G", "B", "A", "aspecular", "lambert", "mask", "normal.X", "normal.Y", "normal.Z", "part"}};
  file.image.data.assign(static_cast<std::size_t>(size) * size * 11, 0);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double u = 2.1 * ((x + 0.5) / size - 0.5), v = 2.1 * (0.5 - (y + 0.5) / size), z2 = 1 - u * u - v * v;
      float* p = file.image.pixel(x, y);
      p[4] = 180;
      if (z2 <= 0) continue;
      const Vec3 n{u, v, std::sqrt(z2)};
      p[3] = 1;
      p[4] = static_cast<float>(paint::aspecular_angle_rad(file.light, file.to_viewer(x, y), n) / kDegree);
      p[5] = static_cast<float>(std::max(0.0, dot(n, file.light)));
      p[6] = 1;
      for (int c = 0; c < 3; ++c) p[7 + c] = static_cast<float>(n[c]);
      p[10] = 1;
    }
  return file;
}

inline void set(image::AovFile& file, int x, int y, const color::Rgb& color) {
  for (int c = 0; c < 3; ++c) file.image.pixel(x, y)[c] = static_cast<float>(color[c]);
}

inline Vec3 normal(const image::AovFile& file, int x, int y) {
  const float* p = file.image.pixel(x, y);
  return {p[7], p[8], p[9]};
}

inline void shade(image::AovFile& file, const paint::LobeFit& fit) {
  for (int y = 0; y < file.image.height; ++y)
    for (int x = 0; x < file.image.width; ++x) {
      if (file.image.pixel(x, y)[6] == 0) continue;
      const Vec3 n = normal(file, x, y);
      const double scale = kPi * std::max(0.0, dot(n, file.light));
      set(file, x, y, scale * brdf::brdf(fit, file.light, file.to_viewer(x, y), n));
    }
  file.drawn.clear();
  if (fit.coat_index != paint::kNoCoat) file.drawn = {"coat"};
}

// The picture of the buffers as light, unedited.
inline Picture picture(const image::AovFile& file) {
  Picture p;
  p.scene_linear = true;
  p.rgb = {file.image.width, file.image.height, 3, {}, {}};
  for (int y = 0; y < file.image.height; ++y)
    for (int x = 0; x < file.image.width; ++x)
      p.rgb.data.insert(p.rgb.data.end(), file.image.pixel(x, y), file.image.pixel(x, y) + 3);
  p.state.assign(p.rgb.data.size() / 3, Picture::kGood);
  return p;
}

inline SketchInput input(const image::AovFile& file, const Picture& p) {
  SketchInput i;
  i.buffers = &file, i.edited = &p, i.least_cosine = 0.05, i.glare_deg = 10;
  return i;
}

inline SketchFit fit(const SketchInput& i) {
  return sketch_point(i, *sketch_pixels(i), basis(), {}, false);
}

// The largest CIEDE2000 at 15, 45 and 110 deg between the paint found and the planted one.
inline double worst_de00(const SketchFit& found, const paint::Appearance& planted) {
  double worst = 0;
  for (const paint::LabReading& row : found.rows)
    if (const double angle = row.geometry.aspecular_deg; angle == 15 || angle == 45 || angle == 110)
      worst = std::max(worst, color::delta_e_2000(row.lab, paint::lab_at(planted, angle)));
  return worst;
}

}  // namespace goniochrome::sketch::sketch_scene
