#include "picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "display/display.h"
#include "fit/paint_fit.h"
#include "image/label.h"
#include "panels/seam.h"
#include "render/renderer.h"

namespace goniochrome::tool {

namespace {

using Color = std::array<float, 3>;
constexpr Color kInk{0.95F, 0.95F, 0.95F};
constexpr float kBackdrop = 0.30F;

image::Image blank(int width, int height) {
  return {width, height, 3, std::vector<float>(static_cast<std::size_t>(width) * height * 3, kBackdrop), {}};
}

std::string figures(double de_before, double de_after) {
  return fmt::format("dE {:.1f} > {:.1f}", de_before, de_after);
}

// The exposure, in stops, at which this luminance is still shown as it is.
double stops_for(double luminance) {
  return luminance > 0.7 ? std::log2(0.7 / luminance) : 0;
}

// One sheet of linear colors to be shown by the display, with places to be filled.
class Sheet {
 public:
  Sheet(int width, int height) : linear_{width, height, 4, std::vector<float>(4UL * width * height, 0.0F), {}} {}

  void fill(int x, int y, int width, int height, const color::Rgb& rgb) {
    for (int j = y; j < y + height; ++j)
      for (int i = x; i < x + width; ++i) {
        float* pixel = linear_.pixel(i, j);
        for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(rgb[c]);
        pixel[3] = 1;
      }
    brightest_ = std::max(brightest_, color::luminance(rgb));
  }

  Result<image::Image> shown() const {
    GONIO_ASSIGN(const display::Display display, display::Display::make(""));
    return display.image(linear_, stops_for(brightest_));
  }

 private:
  image::Image linear_;
  double brightest_ = 0;
};

constexpr std::size_t kMostRows = 24;

}  // namespace

Result<image::Image> swatches(const color::ViewingCondition& condition, const std::vector<Answer>& answers) {
  constexpr int kSide = 150, kHalf = 36, kStep = 2 * kHalf + 14, kLeft = 330, kRight = kLeft + kSide + 40, kTop = 80;
  struct Row {
    const Answer* answer;
    const TrompeGeometry* geometry;
    double before, after;
  };
  std::vector<Row> rows;
  for (const Answer& answer : answers)
    for (std::size_t i = 0; i < answer.judged.size(); ++i)
      rows.push_back({&answer, answer.judged[i], answer.before.de[i], answer.after.de[i]});
  const std::size_t all = rows.size();
  if (all > kMostRows) {  // evenly chosen
    for (std::size_t i = 0; i < kMostRows; ++i) rows[i] = rows[i * all / kMostRows];
    rows.resize(kMostRows);
  }
  GONIO_ASSIGN(const color::Xyz white, color::white_point(condition));
  const int height = kTop + static_cast<int>(rows.size()) * kStep + 50;
  Sheet sheet(kRight + kSide + 260, height);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& [answer, geometry, before, after] = rows[i];
    const panels::PanelView view = geometry->view.under_coat(answer->coat_index);
    const auto rgb = [&](const paint::Appearance& paint, double aspecular, double cosine) {
      return color::rgb_from_lab(panels::panel_color(paint::lab_at(paint, aspecular), cosine), white);
    };
    const int y = kTop + static_cast<int>(i) * kStep;
    const color::Rgb a = rgb(answer->a, view.aspecular_a_deg, view.cos_a);
    for (const int x : {kLeft, kRight}) sheet.fill(x, y, kSide, kHalf, a);
    sheet.fill(kLeft, y + kHalf, kSide, kHalf, rgb(answer->a, view.aspecular_b_deg, view.cos_b));
    sheet.fill(kRight, y + kHalf, kSide, kHalf, rgb(answer->fit.b, view.aspecular_b_deg, view.cos_b));
  }
  GONIO_ASSIGN(image::Image image, sheet.shown());
  image::draw_label(image, 20, 20, answers.front().name, 2, kInk);
  image::draw_label(image, kLeft, kTop - 24, "one paint", 2, kInk);
  image::draw_label(image, kRight, kTop - 24, "two paints", 2, kInk);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int y = kTop + static_cast<int>(i) * kStep + kHalf - image::label_height(2) / 2;
    const panels::LightView& g = rows[i].geometry->geometry;
    std::string where = fmt::format("light {} view {}", shortest(g.light_deg), shortest(g.view_deg));
    if (g.azimuth_deg != 0) where += fmt::format(" az {}", shortest(g.azimuth_deg));
    image::draw_label(image, 20, y, where, 2, kInk);
    image::draw_label(image, kRight + kSide + 20, y, figures(rows[i].before, rows[i].after), 2, kInk);
  }
  std::string total = answers.size() == 1
                          ? fmt::format("rms {:.2f} > {:.2f}  max {:.2f} > {:.2f}", answers[0].before.rms,
                                        answers[0].after.rms, answers[0].before.max, answers[0].after.max)
                          : "a paint for each light";
  if (all > rows.size()) total += fmt::format("  ({} of {} geometries shown)", rows.size(), all);
  image::draw_label(image, 20, height - 34, total, 2, kInk);
  return image;
}

namespace {

constexpr int kHalfWidth = 760, kHalfHeight = 620, kSeamFoot = 110, kBetween = 10;

// Draws the mesh all in paint A, and with paint B on the second part. There is no gloss, because highlights need not
// line up and would only hide what is to be compared.
Result<std::array<image::Image, 2>> seam_halves(const SeamPair& pair) {
  std::vector<double> exponents = {1.5, 3, 6, 12, 25, 50, 100, 200};
  if (pair.env != nullptr) {
    exponents.clear();
    for (const envmap::PrefilteredLobe& lobe : pair.env->lobes) exponents.push_back(lobe.exponent);
  }
  const fit::PaintFitter fitter = panels::appearance_fitter(exponents);
  GONIO_ASSIGN(const paint::LobeFit a,
               panels::appearance_lobes(fitter, pair.answer.a, paint::condition_of(pair.a), pair.answer.coat_index));
  GONIO_ASSIGN(const paint::LobeFit b, panels::appearance_lobes(fitter, pair.answer.fit.b, paint::condition_of(pair.a),
                                                                pair.answer.coat_index));
  paint::LobeFit black;
  black.diffuse = (0.01 / M_PI) * color::Rgb{1, 1, 1};

  render::Renderer renderer = render::Renderer::tracing();
  const render::Camera camera =
      panels::seam_camera_from(*pair.seam, pair.viewer, static_cast<double>(kHalfWidth) / kHalfHeight, 10, 1.15);
  std::array<image::Image, 2> halves;
  render::Scene scene;
  scene.mesh = pair.mesh, scene.env = pair.env;
  for (const Vec3& light : pair.lights) scene.lights.push_back({light, {1, 1, 1}});
  for (int after = 0; after < 2; ++after) {
    scene.paints.clear();
    for (const mesh::MeshPart& part : pair.mesh->parts)
      scene.paints.push_back(std::ranges::find(pair.dark, part.name) != pair.dark.end() ? black
                             : after == 1 && part.name == pair.part_b                   ? b
                                                                                        : a);
    GONIO_TRY(renderer.load(scene, "cpu"));
    GONIO_ASSIGN(render::Frame frame, renderer.draw(camera, kHalfWidth, kHalfHeight, 16));
    halves[static_cast<std::size_t>(after)] = std::move(frame.picture);
  }
  return halves;
}

// The exposure at which 99 of 100 pixels of the mesh are below the display's white.
double stops_of(const image::Image& picture) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i < picture.data.size(); i += 4)
    if (picture.data[i + 3] > 0.99F)
      luminances.push_back(color::luminance({picture.data[i], picture.data[i + 1], picture.data[i + 2]}));
  if (luminances.empty()) return 0;
  std::ranges::sort(luminances);
  return std::log2(0.75 / std::max(1e-6, luminances[luminances.size() * 99 / 100]));
}

}  // namespace

Result<image::Image> seam_pair(const SeamPair& pair) {
  for (const std::string& name : pair.dark)
    if (std::ranges::find(pair.mesh->parts, name, &mesh::MeshPart::name) == pair.mesh->parts.end())
      return input_error("the mesh has no part \"{}\", which --dark names", name);
  GONIO_ASSIGN(const auto halves, seam_halves(pair));
  GONIO_ASSIGN(const display::Display display, display::Display::make(""));
  const double stops = stops_of(halves[0]);
  image::Image image = blank(2 * kHalfWidth + kBetween, kHalfHeight + kSeamFoot);
  for (int after = 0; after < 2; ++after) {
    GONIO_ASSIGN(const image::Image shown, display.image(halves[static_cast<std::size_t>(after)], stops));
    for (int y = 0; y < kHalfHeight; ++y)
      for (int x = 0; x < kHalfWidth; ++x)
        std::copy_n(shown.pixel(x, y), 3, image.pixel(after * (kHalfWidth + kBetween) + x, y));
  }
  const panels::TrompeErrors &before = pair.answer.before, &found = pair.answer.after;
  image::draw_label(image, 20, kHalfHeight + 20,
                    fmt::format("one paint: dE rms {:.2f} max {:.2f}", before.rms, before.max), 3, kInk);
  image::draw_label(
      image, kHalfWidth + 30, kHalfHeight + 20,
      fmt::format("{} on {}: dE rms {:.2f} max {:.2f}", pair.answer.name, pair.part_b, found.rms, found.max),
      image::label_width(pair.answer.name + pair.part_b, 3) > 330 ? 2 : 3, kInk);
  image::draw_label(image, 20, kHalfHeight + 62, pair.a.name, 2, kInk);
  return image;
}

}  // namespace goniochrome::tool
