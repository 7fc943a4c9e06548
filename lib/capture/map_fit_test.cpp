#include "capture/map_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "base/scratch_for_test.h"
#include "capture/internal/truth_for_test.h"

namespace goniochrome::capture::map_fit_test {
namespace {

constexpr int kWidth = 20, kHeight = 12;

// How photographs are made.
struct Camera {
  int photos = 60;
  double noise = 0.01;
  double bad_share = 0;    // of the pixels: specks
  int shadowed_every = 0;  // in one photograph of so many a third of the surface is in a shadow
  bool two_exposures = false;
  bool bytes = false;  // PNG of 8 bits, else EXR
  int wrong = -1;      // the photograph whose table states half of its exposure
  double tilt = 0;     // of the normals, about y, over the width
  bool one_side = false;
};

TrueTexel texel_at(int column, int) {
  const double u = (column + 0.5) / kWidth;
  return column < kWidth / 2 ? varnished(u) : brushed(u);
}

Vec3 normal_at(int column, const Camera& camera) {
  const double angle = camera.tilt * (2 * (column + 0.5) / kWidth - 1);
  return {std::sin(angle), 0, std::cos(angle)};
}

// Linear Rec.709 of linear Rec.2020, by the matrix of ITU-R BT.2087, and its sRGB in bytes.
float byte_of(double v) {
  v = std::clamp(v, 0.0, 1.0);
  return static_cast<float>(std::round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)) /
                            255);
}

class Studio {
 public:
  explicit Studio(const Camera& camera) : camera_(camera) {
    std::string table =
        "image,light_x,light_y,light_z,light_distance,camera_x,camera_y,camera_z,camera_distance,exposure\n";
    auto poses = gantry(camera.photos, 3);
    TestNumbers random(11);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (camera.one_side)
        poses[k].light = normalized({0.6, 0.1 * random(), 1}), poses[k].camera = normalized({0.5, 0, 1});
      const double exposure = camera.two_exposures && k % 2 ? 6.0 : 12.0;
      const std::string name = fmt::format("{}.{}", k, camera.bytes ? "png" : "exr");
      write(name, poses[k], exposure, k, random);
      const Pose& p = poses[k];
      table += fmt::format("{},{},{},{},5,{},{},{},inf,{}\n", name, p.light.x, p.light.y, p.light.z, p.camera.x,
                           p.camera.y, p.camera.z, static_cast<int>(k) == camera.wrong ? exposure / 2 : exposure);
    }
    path_ = folder_.file("photos.csv", table);
  }

  Result<MapFit> fit(MapFitOptions options) const {
    GONIO_ASSIGN(const PhotoTable table, read_photo_table(path_));
    GONIO_ASSIGN(const PhotoStack stack, PhotoStack::open(table, 0.999));
    options.width = 1.5;
    return fit_map(table, stack, options);
  }

 private:
  void write(const std::string& name, const Pose& pose, double exposure, std::size_t number, TestNumbers& random) {
    image::Image image{kWidth, kHeight, 3, {}, {"R", "G", "B"}};
    for (int row = 0; row < kHeight; ++row)
      for (int column = 0; column < kWidth; ++column) {
        const double size = 1.5 / kWidth;
        const Vec3 at = {(column + 0.5 - kWidth / 2.0) * size, (kHeight / 2.0 - row - 0.5) * size, 0};
        const Vec3 way = 5.0 * pose.light - at, n = normal_at(column, camera_);
        const auto local = [&](const Vec3& d) { return Vec3{n.z * d.x - n.x * d.z, d.y, dot(d, n)}; };
        const Vec3 l = local(normalized(way));
        const auto f = true_brdf(texel_at(column, row), l, local(pose.camera));
        double shade = 1;
        const double fate = random();
        if (fate < camera_.bad_share) shade = fate < camera_.bad_share / 2 ? 0.1 : 4;
        if (camera_.shadowed_every && number % static_cast<std::size_t>(camera_.shadowed_every) == 1 &&
            row < kHeight / 3)
          shade = 0.15;
        std::array<double, 3> v{};
        for (std::size_t k = 0; k < 3; ++k)
          v[k] = exposure * 3.14159265358979323846 * f[k] * l.z / dot(way, way) * shade *
                 (1 + camera_.noise * normal_deviate(random));
        for (const double value : camera_.bytes ? std::array{1.660491 * v[0] - 0.587641 * v[1] - 0.072850 * v[2],
                                                             -0.124550 * v[0] + 1.132900 * v[1] - 0.008349 * v[2],
                                                             -0.018151 * v[0] - 0.100579 * v[1] + 1.118730 * v[2]}
                                                : v)
          image.data.push_back(camera_.bytes ? byte_of(value) : static_cast<float>(std::min(value, 1.0)));
      }
    if (camera_.bytes) {
      ASSERT_TRUE(image::write_png(folder_.path(name), image).ok());
    } else {
      image::ImagePart part{"", std::move(image), {}, image::PixelType::kFloat};
      part.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
      ASSERT_TRUE(image::write_exr(folder_.path(name), {part}).ok());
    }
  }

  Camera camera_;
  ScratchFolder folder_;
  std::string path_;
};

MapFit fitted(const Camera& camera, const MapFitOptions& options) {
  auto fit = Studio(camera).fit(options);
  EXPECT_TRUE(fit.ok()) << (fit.ok() ? "" : fit.error().message);
  if (!fit.ok()) return {};
  return std::move(*fit);
}

const MapFitOptions kChecked{.lobes = 2, .method = MapMethod::kDictionary, .holdout = 10};

TEST(MapFit, PhotographsHeldOutArePredicted) {
  const Camera plain{.bytes = true};
  const MapFit clean = fitted(plain, kChecked);
  EXPECT_LE(clean.holdout_rel_error, plain.noise + 0.02);
  EXPECT_EQ(clean.texels, static_cast<std::size_t>(kWidth * kHeight));
  EXPECT_LT(clean.uncertain, clean.texels / 20);
  // 5 % specks, shadows and two exposures.
  const Camera spoiled{.bad_share = 0.05, .shadowed_every = 6, .two_exposures = true, .bytes = true};
  const MapFit robust = fitted(spoiled, kChecked);
  EXPECT_LE(robust.holdout_rel_error, 1.5 * clean.holdout_rel_error);
  // The control: plain least squares.
  MapFitOptions least_squares = kChecked;
  least_squares.method = MapMethod::kNonlinear;
  EXPECT_GT(fitted(spoiled, least_squares).holdout_rel_error, 1.5 * clean.holdout_rel_error);
}

TEST(MapFit, ErrorFallsWithPhotographsAndLobes) {
  const Camera noisy{.photos = 30, .noise = 0.05}, more{.photos = 90, .noise = 0.05};
  const MapFitOptions two{.lobes = 2, .method = MapMethod::kDictionary, .holdout = 8};
  MapFitOptions one = two;
  one.lobes = 1;
  EXPECT_GT(fitted(noisy, two).holdout_rel_error, fitted(more, two).holdout_rel_error);
  EXPECT_GT(fitted(Camera{}, one).holdout_rel_error, fitted(Camera{}, two).holdout_rel_error);
}

TEST(MapFit, AWrongExposureIsFoundAndMended) {
  const Camera wrong{.wrong = 13};
  const MapFit told = fitted(wrong, kChecked);
  for (std::size_t k = 0; k < told.photos.size(); ++k)
    EXPECT_EQ(told.photos[k].wrong_exposure, k == 13) << k << " by " << told.photos[k].exposure_factor;
  EXPECT_NEAR(told.photos[13].exposure_factor, 2, 0.06);
  MapFitOptions mend = kChecked;
  mend.mend_exposures = true;
  const MapFit mended = fitted(wrong, mend);
  EXPECT_NEAR(mended.photos[13].exposure_factor, 2, 0.06);
  EXPECT_LT(mended.photos[13].rel_error, 0.05);
  EXPECT_GT(told.photos[13].rel_error, 0.3);
  // Without one, none is found.
  for (const PhotoFigures& photo : fitted({}, kChecked).photos) EXPECT_FALSE(photo.wrong_exposure);
}

TEST(MapFit, IsTheSameForAnyThreadsAndBands) {
  const Studio studio({.photos = 24});
  MapFitOptions options{.lobes = 1, .method = MapMethod::kDictionary};
  set_threads(1);
  const auto first = studio.fit(options);
  set_threads(3);
  options.tile_rows = 5;
  const auto second = studio.fit(options);
  set_threads(0);
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(first->map.values, second->map.values);
  EXPECT_EQ(first->certainty, second->certainty);
  EXPECT_EQ(first->error, second->error);
  EXPECT_EQ(first->holdout_rel_error, second->holdout_rel_error);
}

TEST(MapFit, NormalsOfTheTexelsCount) {
  const Camera tilted{.tilt = 0.25};
  image::Image normals{kWidth, kHeight, 3, {}, {}};
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const Vec3 n = normal_at(i % kWidth, tilted);
    for (int k = 0; k < 3; ++k) normals.data.push_back(static_cast<float>(n[k]));
  }
  MapFitOptions with = kChecked;
  with.normals = &normals;
  const MapFit fit = fitted(tilted, with);
  EXPECT_LE(fit.holdout_rel_error, 0.03);
  EXPECT_EQ(fit.map.normals, normals.data) << "unit normals are those that were given";
  EXPECT_GT(fitted(tilted, kChecked).holdout_rel_error, 0.05);
}

TEST(MapFit, AMaskLeavesTexelsBlack) {
  image::Image mask{kWidth, kHeight, 1, std::vector<float>(kWidth * kHeight, 1.0F), {}};
  mask.data[25] = 0;
  const MapFit fit = fitted({.photos = 24}, {.lobes = 1, .method = MapMethod::kDictionary, .mask = &mask});
  EXPECT_EQ(fit.texels, mask.data.size() - 1);
  EXPECT_EQ(fit.alpha[25], 0);
  EXPECT_EQ(fit.certainty[25], 0);
  EXPECT_EQ(fit.map.texel(5, 1)[0], 0);
  EXPECT_GT(fit.map.texel(6, 1)[0], 0);
}

TEST(MapFit, ASurfaceOfOneTexelIsFound) {
  image::Image mask{kWidth, kHeight, 1, std::vector<float>(kWidth * kHeight, 0.0F), {}};
  mask.data[57] = 1;
  const MapFit fit = fitted({.photos = 24}, {.lobes = 1, .method = MapMethod::kDictionary, .mask = &mask});
  EXPECT_EQ(fit.texels, 1u);
}

TEST(MapFit, WhatCannotTellTheSurfaceIsRefused) {
  const auto told = [](const Camera& camera, MapFitOptions options) {
    const auto fit = Studio(camera).fit(options);
    return fit.ok() ? std::string("nothing") : fit.error().message;
  };
  EXPECT_NE(told({.photos = 14}, kChecked).find("too few for this many lobes: give at least 22"), std::string::npos);
  EXPECT_NE(told({.one_side = true}, kChecked).find("from one side of its highlight"), std::string::npos);
  const image::Image small{3, 3, 3, std::vector<float>(27, 1.0F), {}};
  MapFitOptions options = kChecked;
  options.mask = &small;
  EXPECT_NE(told({}, options).find("the mask is 3 x 3"), std::string::npos);
  image::Image normals{kWidth, kHeight, 3, std::vector<float>(3 * kWidth * kHeight, -1.0F), {}};
  options.mask = nullptr, options.normals = &normals;
  EXPECT_NE(told({}, options).find("its z must be"), std::string::npos);
}

// Few photographs, none of them near the highlight of the right side of the surface, leave texels open; and this is
// told.
TEST(MapFit, TexelsThatNobodySawShineAreUncertain) {
  const ScratchFolder folder;
  std::string table = "image,light_x,light_y,light_z,camera_x,camera_y,camera_z,exposure\n";
  const TrueTexel texel{{0.05, 0.05, 0.05}, 0, {{{8, 8, 8}, -1, -1, 1, 400}}};
  for (int k = 0; k < 16; ++k) {
    // A lamp that goes around near the camera, so that the mirror direction is met at one end of a long surface only.
    const double a = k * 0.4;
    const Vec3 light = {-3.0 + 0.3 * std::cos(a), 0.3 * std::sin(a), 2.0}, camera = {-3, 0, 2.2};
    image::Image image{32, 2, 3, {}, {"R", "G", "B"}};
    for (int i = 0; i < 64; ++i) {
      const Vec3 at = {(i % 32 + 0.5 - 16) * 8 / 32, (0.5 - i / 32) * 8.0 / 32, 0};
      const Vec3 l = light - at;
      const auto f = true_brdf(texel, normalized(l), normalized(camera - at));
      for (std::size_t c = 0; c < 3; ++c)
        image.data.push_back(static_cast<float>(3.14159265358979 * f[c] * normalized(l).z / dot(l, l)));
    }
    image::ImagePart part{"", std::move(image), {}, image::PixelType::kFloat};
    ASSERT_TRUE(image::write_exr(folder.path(fmt::format("{}.exr", k)), {part}).ok());
    table += fmt::format("{}.exr,{},{},{},{},{},{},1\n", k, light.x, light.y, light.z, camera.x, camera.y, camera.z);
  }
  const auto photos = read_photo_table(folder.file("photos.csv", table));
  ASSERT_TRUE(photos.ok());
  const auto stack = PhotoStack::open(*photos, 1e9);
  ASSERT_TRUE(stack.ok());
  const auto fit = fit_map(*photos, *stack, {.lobes = 1, .method = MapMethod::kDictionary, .width = 8});
  // The middle of the surface is beside its highlight in all of them, which is refused where it holds for all texels.
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_EQ(fit->certainty[31], 0);
  EXPECT_GT(fit->uncertain, fit->texels / 3);
  EXPECT_LT(fit->uncertain, fit->texels);
}

}  // namespace
}  // namespace goniochrome::capture::map_fit_test
