#include "envmap/environment.h"

#include <OpenEXR/ImfEnvmap.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "base/scratch_for_test.h"
#include "color/color.h"

namespace goniochrome::envmap::environment_test {
namespace {

using testing::HasSubstr;
using BadPixels = Environment::BadPixels;
using Layout = Environment::Layout;

class EnvironmentFile : public testing::Test {
 protected:
  // Writes a working-space image and returns its path.
  std::string written(const std::string& name, const image::Image& image, const std::string& envmap = "") {
    image::ImagePart part = {
        "", image, {{"colorInteropID", std::string("lin_rec2020_scene")}}, image::PixelType::kFloat};
    if (!envmap.empty()) part.attributes["envmap"] = envmap;
    EXPECT_TRUE(image::write_exr(folder_.path(name), {part}).ok());
    return folder_.path(name);
  }

  ScratchFolder folder_;
};

image::Image filled(int width, int height, const std::function<Vec3(double, double)>& value) {
  image::Image image = {width, height, 3, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec3 rgb = value(x + 0.5, y + 0.5);
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(rgb[c]));
    }
  return image;
}

// A scene without symmetry, so that no mirrored or swapped face goes unseen.
Vec3 scene(const Vec3& d) {
  return {2 + d.x + 0.3 * d.y * d.z, 1.5 + d.y - 0.4 * d.x, 3 + 0.8 * d.z + 0.5 * d.x * d.y};
}

image::Image lat_long_scene(int height) {
  return filled(2 * height, height, [&](double x, double y) {
    const double theta = kPi * y / height, longitude = 2 * kPi * (0.5 - x / (2 * height));
    return scene({std::sin(theta) * std::sin(longitude), std::cos(theta), std::sin(theta) * std::cos(longitude)});
  });
}

image::Image gl_strip_scene(int n) {
  return filled(n, 6 * n, [&](double x, double y) {
    const int face = static_cast<int>(y) / n;
    return scene(cube_direction(face, x, y - face * n, n));
  });
}

// OpenEXR's own functions say where its texels look.
image::Image openexr_scene(int n) {
  const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(n - 1, 6 * n - 1));
  image::Image image = {n, 6 * n, 3, std::vector<float>(static_cast<std::size_t>(n) * n * 18), {}};
  for (int face = 0; face < 6; ++face)
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        const auto which = static_cast<Imf::CubeMapFace>(face);
        const Imath::V2f in_face(static_cast<float>(a), static_cast<float>(b));
        const Imath::V2f at = Imf::CubeMap::pixelPosition(which, window, in_face);
        const Imath::V3f d = Imf::CubeMap::direction(which, window, in_face);
        const Vec3 rgb = scene(normalized({d.x, d.y, d.z}));
        for (int c = 0; c < 3; ++c)
          image.pixel(static_cast<int>(at.x), static_cast<int>(at.y))[c] = static_cast<float>(rgb[c]);
      }
  return image;
}

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

// The flux of the scene in closed form: the odd terms vanish.
const Vec3 kFlux = {4 * kPi * 2, 4 * kPi * 1.5, 4 * kPi * 3};

void expect_scene(const Environment& env, double slope_tolerance) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 d = random_direction(random);
    const float* got = env.lookup(d);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], scene(d)[c], slope_tolerance) << i;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(env.flux()[c] / kFlux[c], 1, 1e-4);
}

TEST_F(EnvironmentFile, HardCase_PrefilterConventionEveryLayoutOfOneSceneAgrees) {
  // A lookup finds a texel whose center is within half its diagonal: slope 1.5 * angle * 0.71.
  constexpr int kSize = 96;
  const double cube_step = 1.5 * 2.0 / kSize * 0.71, lat_long_step = 1.5 * kPi / 200 * 0.71;
  const auto read = [&](const std::string& path) {
    auto env = Environment::read(path, BadPixels::kError);
    EXPECT_TRUE(env.ok()) << env.error().message;
    return std::move(env).value();
  };
  expect_scene(read(written("latlong.exr", lat_long_scene(200))), lat_long_step);

  const image::Image strip = gl_strip_scene(kSize);
  expect_scene(read(written("strip.exr", strip)), cube_step);
  const auto block = [&](image::Image& to, int face, int x, int y, bool turned) {
    for (int row = 0; row < kSize; ++row)
      for (int column = 0; column < kSize; ++column) {
        const float* from =
            strip.pixel(turned ? kSize - 1 - column : column, face * kSize + (turned ? kSize - 1 - row : row));
        std::copy(from, from + 3, to.pixel(x * kSize + column, y * kSize + row));
      }
  };
  const auto blank = [](int w, int h) { return image::Image{w, h, 3, std::vector<float>(std::size_t(w) * h * 3), {}}; };
  image::Image wide = blank(6 * kSize, kSize);
  for (int f = 0; f < 6; ++f) block(wide, f, f, 0, false);
  expect_scene(read(written("wide.exr", wide)), cube_step);
  image::Image cross = blank(4 * kSize, 3 * kSize);
  const int cells[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
  for (int f = 0; f < 6; ++f) block(cross, f, cells[f][0], cells[f][1], false);
  expect_scene(read(written("cross.exr", cross)), cube_step);
  image::Image upright = blank(3 * kSize, 4 * kSize);
  for (int f = 0; f < 5; ++f) block(upright, f, cells[f][0], cells[f][1], false);
  block(upright, 5, 1, 3, true);
  expect_scene(read(written("upright.exr", upright)), cube_step);
  for (int f = 0; f < 6; ++f) {
    image::Image face = blank(kSize, kSize);
    std::copy(strip.pixel(0, f * kSize), strip.pixel(0, f * kSize) + kSize * kSize * 3, face.data.begin());
    written(fmt::format("sky-{}.exr", std::array{"px", "nx", "py", "ny", "pz", "nz"}[f]), face);
  }
  expect_scene(read(folder_.path("sky-{face}.exr")), cube_step);

  const Environment edges = read(written("edges.exr", openexr_scene(kSize), "cube"));
  EXPECT_EQ(edges.layout(), Layout::kCubeEdges);
  expect_scene(edges, 1.5 * 2.0 / (kSize - 1) * 0.71);
  // At its own texel centers OpenEXR's file is met to the last bits of a float, corners of faces included.
  for (const Vec3& corner : {normalized({1, 1, 1}), normalized({-1, 1, -1}), normalized({1, -1, -1})})
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(edges.lookup(corner)[c], scene(corner)[c], 1e-6);

  // The textbook reader takes the same file for OpenGL's: mirrored faces.
  const Environment mistaken = read(written("mistaken.exr", openexr_scene(kSize)));
  int far_off = 0;
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 d = random_direction(random);
    far_off += std::fabs(mistaken.lookup(d)[0] - scene(d).x) > 0.1;
  }
  EXPECT_GT(far_off, 500);
  double textbook = 0, ours = 0;
  for (const Vec3& corner : {normalized({1, 1, 1}), normalized({-1, 1, -1}), normalized({1, -1, -1})}) {
    ours = worst_of(ours, std::fabs(edges.lookup(corner)[0] - scene(corner).x));
    textbook = worst_of(textbook, std::fabs(mistaken.lookup(corner)[0] - scene(corner).x));
  }
  hard_case("prefilter-convention", {.what = "radiance at the corners of an OpenEXR cube",
                                     .textbook = textbook,
                                     .ours = ours,
                                     .bound = 1e-6,
                                     .unit = "radiance"});
}

TEST_F(EnvironmentFile, CellsCoverTheSphereAndDirectionsLieInThem) {
  std::vector<Environment> all;
  all.push_back(Environment::from_lat_long(lat_long_scene(9), BadPixels::kError, "a").value());
  all.push_back(
      Environment::from_lat_long(filled(7, 3, [](double, double) { return Vec3{1, 1, 1}; }), BadPixels::kError, "odd")
          .value());
  CubeMap map(5);
  all.push_back(Environment::from_cube(map, "b"));
  all.push_back(Environment::from_cube_edges(gl_strip_scene(5), BadPixels::kError, "c").value());
  all.push_back(Environment::from_cube_edges(gl_strip_scene(2), BadPixels::kError, "d").value());
  for (const Environment& env : all) {
    double sum = 0, parts = 0;
    for (int row = 0; row < env.height(); ++row)
      for (int column = 0; column < env.width(); ++column) {
        sum += env.solid_angle(column, row);
        for (const double a : {0.0, 0.4})
          for (const double b : {0.0, 0.7})
            parts += env.solid_angle(column + a, row + b, column + (a > 0 ? 1 : 0.4), row + (b > 0 ? 1 : 0.7));
        EXPECT_EQ(env.lookup(env.direction(column, row)), env.radiance(column, row));
        EXPECT_EQ(env.lookup(env.direction_at(column + 0.1, row + 0.9)), env.radiance(column, row));
      }
    EXPECT_NEAR(sum, 4 * kPi, 1e-12);
    EXPECT_NEAR(parts, 4 * kPi, 1e-12);
  }
}

TEST_F(EnvironmentFile, UntaggedIsRec709AndTagsAreHonored) {
  const auto first_texel = [&](const image::Attributes& attributes) {
    image::ImagePart part = {"", filled(4, 2, [](double, double) { return Vec3{0.2, 0.5, 0.7}; }), attributes,
                             image::PixelType::kFloat};
    const std::string path = folder_.path("tag.exr");
    EXPECT_TRUE(image::write_exr(path, {part}).ok());
    const auto env = Environment::read(path, BadPixels::kError);
    EXPECT_TRUE(env.ok()) << env.error().message;
    const float* rgb = env->radiance(0, 0);
    return Vec3{rgb[0], rgb[1], rgb[2]};
  };
  const Vec3 from_709 = color::rec2020_from_rec709({0.2, 0.5, 0.7});
  EXPECT_LT(length(first_texel({}) - from_709), 1e-6);
  EXPECT_LT(length(first_texel({{"colorInteropID", std::string("lin_rec709_scene")}}) - from_709), 1e-6);
  EXPECT_LT(length(first_texel({{"colorInteropID", std::string("lin_rec2020_scene")}}) - Vec3{.2, .5, .7}), 1e-7);
  const std::vector<float> rec2020 = {.708F, .292F, .17F, .797F, .131F, .046F, .3127F, .329F};
  EXPECT_LT(length(first_texel({{"chromaticities", rec2020}}) - Vec3{.2, .5, .7}), 1e-6);
  // White stays white when the file's white is not D65 (ACES).
  image::ImagePart white = {"",
                            filled(4, 2, [](double, double) { return Vec3{1, 1, 1}; }),
                            {{"colorInteropID", std::string("lin_ap1_scene")}},
                            image::PixelType::kFloat};
  const std::string path = folder_.path("white.exr");
  ASSERT_TRUE(image::write_exr(path, {white}).ok());
  const auto env = Environment::read(path, BadPixels::kError);
  ASSERT_TRUE(env.ok());
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(env->radiance(0, 0)[c], 1, 1e-6);
  white.attributes["colorInteropID"] = std::string("log_film");
  ASSERT_TRUE(image::write_exr(path, {white}).ok());
  const auto refused = Environment::read(path, BadPixels::kError);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("white.exr: colorInteropID is \"log_film\", which is not known"));
}

TEST_F(EnvironmentFile, HardCase_PrefilterBadTexelsAreRefusedByNameOrZeroedWithACount) {
  image::Image image = lat_long_scene(8);
  image.pixel(3, 5)[1] = std::numeric_limits<float>::quiet_NaN();
  image.pixel(9, 5)[0] = std::numeric_limits<float>::infinity();
  image.pixel(0, 7)[2] = -0.25F;
  const auto refused = Environment::from_lat_long(image, BadPixels::kError, "x.hdr");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message,
            "x.hdr: texel 3,5 channel G is nan: repair the image, or zero such texels with "
            "prefilter-envmap --bad-pixels zero");
  const auto zeroed = Environment::from_lat_long(image, BadPixels::kZero, "x.hdr");
  ASSERT_TRUE(zeroed.ok());
  EXPECT_EQ(zeroed->replaced().nan, 1);
  EXPECT_EQ(zeroed->replaced().infinite, 1);
  EXPECT_EQ(zeroed->replaced().negative, 1);
  EXPECT_EQ(zeroed->radiance(3, 5)[0], 0);
  image::Image repaired = image;
  for (float* texel : {repaired.pixel(3, 5), repaired.pixel(9, 5), repaired.pixel(0, 7)}) std::fill_n(texel, 3, 0.0F);
  const Vec3 flux = Environment::from_lat_long(repaired, BadPixels::kError, "x.hdr")->flux();
  // The textbook sum is poisoned.
  double sum = 0;
  for (const float value : image.data) sum += value;
  hard_case("prefilter-bad", {.what = "flux of a map with texels of NaN, infinity and -0.25",
                              .textbook = sum,
                              .ours = length(zeroed->flux() - flux),
                              .bound = 0,
                              .unit = "radiance"});
}

TEST_F(EnvironmentFile, HardCase_PrefilterBadShapesAreRefusedAndOddOnesRead) {
  const auto read = [&](int w, int h, const std::string& envmap = "") {
    return Environment::read(written("s.exr", filled(w, h, [](double, double) { return Vec3{1, 1, 1}; }), envmap),
                             BadPixels::kError);
  };
  for (const auto& [w, h] : {std::pair{1, 1}, {10, 3}, {5, 4}}) {
    const auto env = read(w, h);
    ASSERT_FALSE(env.ok()) << w << " x " << h;
    EXPECT_THAT(env.error().message, HasSubstr(fmt::format("s.exr: {} x {} is no known shape", w, h)));
  }
  EXPECT_THAT(read(9, 3, "latlong").error().message, HasSubstr("is tagged as lat-long but is 9 x 3"));
  EXPECT_THAT(read(9, 3, "cube").error().message, HasSubstr("is tagged as an OpenEXR cube but is 9 x 3"));
  for (const auto& [w, h] : {std::pair{2, 1}, {7, 3}, {5, 3}, {1, 6}, {18, 3}, {4, 3}, {3, 4}}) {
    const auto env = read(w, h);
    ASSERT_TRUE(env.ok()) << w << " x " << h;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(env->flux()[c], 4 * kPi, 1e-5) << w << " x " << h;
  }
  EXPECT_THAT(Environment::read(folder_.path("sea-{face}.exr"), BadPixels::kError).error().message,
              HasSubstr("sea-px.exr"));
}

// A fisheye of half the sphere was taken for an angular probe of the whole one.
TEST_F(EnvironmentFile, TheViewOfARadiancePictureIsHeard) {
  const auto read = [&](const std::string& lines, int width) {
    const std::string pixels(static_cast<std::size_t>(4 * width * 4), '\x80');
    return Environment::read(folder_.file("v.hdr", fmt::format("#?RADIANCE\n{}FORMAT=32-bit_rle_rgbe\n\n-Y 4 +X {}\n{}",
                                                               lines, width, pixels)),
                             BadPixels::kError);
  };
  for (const auto& [view, width] : {std::pair{"-vta -vh 180 -vv 180", 4},
                                    {"-vth -vh 180 -vv 180", 4},
                                    {"-vtv -vp 0 0 0 -vh 53 -vv 40", 8},
                                    {"", 4}})
    EXPECT_EQ(read(*view ? fmt::format("VIEW= {}\n", view) : "", width).ok(), !*view) << view;
  EXPECT_THAT(read("VIEW= -vth -vh 180 -vv 180\n", 4).error().message,
              HasSubstr("v.hdr: its header says VIEW= -vth -vh 180 -vv 180"));
  EXPECT_TRUE(read("VIEW= -vtv\nVIEW= -vta -vp 0 0 0 -vd 0 1 0 -vh 360 -vv 360\n", 4).ok()) << "the last one counts";
  EXPECT_TRUE(read("pcompos left.hdr right.hdr\n\tVIEW= -vtv -vh 45 -vv 45\n", 8).ok()) << "that of another picture";
}

TEST_F(EnvironmentFile, FinerTexelsShowTheSameRadianceEverywhere) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  std::normal_distribution<double> normal;
  const auto noise = [&](int width, int height) {
    return filled(width, height, [&](double, double) { return Vec3{unit(random), unit(random), unit(random)}; });
  };
  CubeMap cube(5);
  cube.texels = noise(5, 30).data;
  for (const Environment& env : {Environment::from_lat_long(noise(12, 6), BadPixels::kError, "flat").value(),
                                 Environment::from_cube(cube, "cube"),
                                 Environment::from_cube_edges(noise(5, 30), BadPixels::kError, "edges").value(),
                                 Environment::from_angular(noise(9, 9), BadPixels::kError, "probe").value()}) {
    const Environment fine = env.cut_to(0.06);
    EXPECT_LE(fine.grid().largest_texel_rad(), 0.06 * (1 + 1e-12));
    EXPECT_EQ(fine.cut_to(0.06).values(), fine.values());
    for (int i = 0; i < 1000; ++i) {
      const Vec3 d = normalized({normal(random), normal(random), normal(random)});
      for (int c = 0; c < 3; ++c) ASSERT_EQ(fine.lookup(d)[c], env.lookup(d)[c]) << int(env.layout());
    }
    // The rim of a probe is summed in equal parts: to 1/32 of the texels that it cuts, whose density is all but zero.
    const double rounding = env.layout() == Layout::kAngular ? 1e-3 : 1e-12;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fine.flux()[c] / env.flux()[c], 1, rounding) << int(env.layout());
  }
}

// The first map of a prefiltered environment has the shape of a cube, and would be taken for one.
TEST_F(EnvironmentFile, MapsThatArePrefilteredAreNoEnvironment) {
  const std::string cube = folder_.path("cube.exr"), prefiltered = folder_.path("x.env.exr");
  image::ImagePart part = {"diffuse", {2, 12, 3, std::vector<float>(72, 1.0F), {}}, {}, image::PixelType::kHalf};
  ASSERT_TRUE(image::write_exr(cube, {part}).ok());
  EXPECT_TRUE(Environment::read(cube, BadPixels::kError).ok()) << "the control";
  part.attributes["goniochrome:texels"] = std::string("center");
  part.attributes["goniochrome:source"] = std::string("hall.hdr");
  ASSERT_TRUE(image::write_exr(prefiltered, {part}).ok());
  const auto env = Environment::read(prefiltered, BadPixels::kError);
  ASSERT_FALSE(env.ok());
  EXPECT_EQ(env.error().kind, ErrorKind::kInput);
  EXPECT_THAT(env.error().message,
              HasSubstr("x.env.exr: is prefiltered already: give the image that it was made from, hall.hdr"));
}

TEST_F(EnvironmentFile, FacesOfDifferentSizeAreRefused) {
  std::vector<std::string> paths;
  for (int f = 0; f < 6; ++f) {
    const int n = f == 4 ? 5 : 4;
    paths.push_back(written(fmt::format("f{}.exr", f), filled(n, n, [](double, double) { return Vec3{1, 1, 1}; })));
  }
  const auto env = Environment::read_faces(paths, BadPixels::kError);
  ASSERT_FALSE(env.ok());
  EXPECT_THAT(env.error().message, HasSubstr("f4.exr: is 5 x 5: every face of this cube must be 4 x 4"));
  paths.pop_back();
  EXPECT_EQ(Environment::read_faces(paths, BadPixels::kError).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace goniochrome::envmap::environment_test
