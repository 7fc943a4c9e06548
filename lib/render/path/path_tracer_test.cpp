// Whole pictures by paths: the same for any number of threads, as noisy as they say, stopped where they are told to.
#include "render/path/path_tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/hard_case_for_test.h"
#include "base/parallel.h"
#include "render/camera.h"
#include "render/internal/seen.h"
#include "render/path/pixel_pieces.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::path_tracer_test {
namespace {

paint::LobeFit glossy() {
  paint::LobeFit paint = matt({0.3, 0.2, 0.1});
  paint.lobes = {{20, {0.5, 0.5, 0.5}, {0.1, 0.1, 0.1}}, {paint::kMirrorExponent, {}, {0.6, 0.6, 0.6}}};
  return paint;
}

// A ball in a cup, in uneven light.
std::unique_ptr<PathStage> ball_in_a_cup() {
  mesh::Mesh mesh = box_mesh(false);
  add_mesh(mesh, sphere_mesh(32), 0.5, {0.1, -0.5, 0});
  auto stage = std::make_unique<PathStage>(std::move(mesh), std::vector<paint::LobeFit>{matt({0.7, 0.6, 0.5})});
  stage->scene.paints.back() = glossy();
  stage->environment = environment_of(32, 16, [](int x, int y) {
    const double lamp = x > 10 && x < 14 && y > 2 && y < 5 ? 10 : 0;
    return color::Rgb{0.5 + lamp, 0.5 + 0.02 * y + lamp, 0.7 + lamp};
  });
  stage->build();
  return stage;
}

Camera from_above() {
  Camera camera;
  camera.eye = {0.5, 4, 2};
  camera.fov_deg = 36;
  return camera;
}

Gbuffer seen_from_above(const PathStage& stage, int width, int height) {
  return visible_surface(stage.transport->rays(), *rays(from_above(), width, height), width, height);
}

TEST(PathPicture, IsTheSameForAnyNumberOfThreads) {
  const auto stage = ball_in_a_cup();
  const Gbuffer surface = seen_from_above(*stage, 24, 18);
  PathRequest request;
  request.tolerance_de00 = 4;
  PathPicture first;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    const PathPicture picture = path_picture(*stage->transport, surface, nullptr, request);
    if (first.points.empty()) first = picture;
    ASSERT_EQ(picture.points.size(), first.points.size());
    EXPECT_EQ(picture.noise_p95_de00, first.noise_p95_de00);
    for (std::size_t i = 0; i < first.points.size(); ++i) {
      EXPECT_EQ(picture.points[i].radiance, first.points[i].radiance);
      EXPECT_EQ(picture.points[i].covariance, first.points[i].covariance);
    }
  }
  set_threads(0);
  // The surface as well.
  set_threads(1);
  const Gbuffer again = seen_from_above(*stage, 24, 18);
  set_threads(0);
  EXPECT_EQ(again.data, surface.data);
}

// The picture against one of 25 times the samples: the root mean square difference in CIEDE2000 is the stated noise,
// and 95 % of the points are within two of theirs.
TEST(PathPicture, IsAsNoisyAsItSays) {
  const auto stage = ball_in_a_cup();
  const Gbuffer surface = seen_from_above(*stage, 32, 24);
  PathRequest request;
  request.options.bounces = 4;
  request.tolerance_de00 = 1.5;
  request.white_luminance = 1.2;
  const PathPicture picture = path_picture(*stage->transport, surface, nullptr, request);
  ASSERT_TRUE(picture.reached);
  EXPECT_LE(picture.noise_p95_de00, 1.5);
  request.tolerance_de00 = 1.5 / 5;
  request.seed = 99;
  const PathPicture truth = path_picture(*stage->transport, surface, nullptr, request);
  ASSERT_TRUE(truth.reached);
  double stated2 = 0, true2 = 0, count = 0;
  int within = 0;
  std::vector<double> differences;
  for (std::size_t i = 0; i < picture.points.size(); ++i) {
    const PathPoint &a = picture.points[i], &b = truth.points[i];
    const double difference = seen_difference(a.radiance, b.radiance, request.white_luminance);
    differences.push_back(difference);
    stated2 += a.noise_de00 * a.noise_de00 + b.noise_de00 * b.noise_de00, true2 += difference * difference, ++count;
    within += difference <= 2 * std::hypot(a.noise_de00, b.noise_de00);
  }
  // Some 500 points lie in neighborhoods that share variances; the rotation term of CIEDE2000 is left out.
  EXPECT_NEAR(std::sqrt(true2 / stated2), 1, 0.1);
  EXPECT_GT(within, 0.92 * count);
  // The 95th percentile of differences is that of a spread, whose standard deviation is the noise; three channels, in
  // part together, lie between 1 and 2 of it.
  const double p95 = percentile_95(differences);
  EXPECT_GT(p95, 1.0 * picture.noise_p95_de00);
  EXPECT_LT(p95, 2.2 * picture.noise_p95_de00);
}

// Adaptive sampling decides by what it has drawn, which could bend the mean: over many pictures it does not.
TEST(PathPicture, ItsMeanIsTheTruthWhateverIsSampledMore) {
  const auto stage = ball_in_a_cup();
  const Gbuffer surface = seen_from_above(*stage, 12, 9);
  PathRequest request;
  request.options.bounces = 3;
  const auto mean_of = [&](double tolerance, std::uint64_t first, int pictures, double& variance) {
    color::Rgb sum;
    double squares = 0;
    request.tolerance_de00 = tolerance;
    for (int k = 0; k < pictures; ++k) {
      request.seed = first + static_cast<std::uint64_t>(k);
      color::Rgb total;
      for (const PathPoint& point : path_picture(*stage->transport, surface, nullptr, request).points)
        total += point.radiance;
      sum += total, squares += total.y * total.y;
    }
    const double mean = sum.y / pictures;
    variance = (squares / pictures - mean * mean) / (pictures - 1);
    return mean;
  };
  double rough_variance = 0, fine_variance = 0;
  const double rough = mean_of(3, 1000, 150, rough_variance), fine = mean_of(0.5, 5, 6, fine_variance);
  const double sigma = std::sqrt(rough_variance + fine_variance);
  EXPECT_LT(std::abs(rough - fine), 4 * sigma + 0.002 * fine) << rough << " " << fine << " " << sigma;
  EXPECT_LT(sigma, 0.005 * fine);
}

// Many samples of a point are drawn from long sequences, which cover what it sees more evenly than as many by
// themselves: to the same noise it takes fewer of them. The control is the number that the spread of short ones asks
// for.
TEST(PathPicture, LongSequencesNeedFewerSamples) {
  const auto stage = ball_in_a_cup();
  const Gbuffer surface = seen_from_above(*stage, 16, 12);
  PathRequest request;
  request.options.bounces = 2;
  request.white_luminance = 1.2;
  request.tolerance_de00 = 0.25;
  const PathPicture picture = path_picture(*stage->transport, surface, nullptr, request);
  ASSERT_TRUE(picture.reached);
  double drawn = 0, short_ones = 0;
  for (const PathPoint& point : picture.points) {
    const rays::Spot spot = spot_at(stage->transport->rays(), surface, point.x, point.y);
    const PathEstimate estimate =
        path_estimate(*stage->transport, request.options, spot, surface.to_viewer(point.x, point.y), 64, 5);
    const double noise = noise_de00(estimate.radiance, estimate.covariance, request.white_luminance);
    if (!(point.noise_de00 > 0)) continue;
    drawn += point.samples, short_ones += 64 * kBatch * std::pow(noise / point.noise_de00, 2);
  }
  ASSERT_GT(drawn, 0);
  EXPECT_LT(drawn, 0.9 * short_ones);
}

TEST(PathPicture, AConvexShapeIsDrawnWithoutASample) {
  PathStage stage(sphere_mesh(64), {glossy()});
  stage.environment = even_environment();
  stage.build();
  const Gbuffer surface = seen_from_above(stage, 32, 24);
  PathRequest request;
  request.options.correction = true;
  const PathPicture picture = path_picture(*stage.transport, surface, nullptr, request);
  EXPECT_TRUE(picture.reached);
  EXPECT_GT(picture.points.size(), 50U);
  EXPECT_EQ(picture.free_share, 1);
  EXPECT_EQ(picture.noise_p95_de00, 0);
  for (const PathPoint& point : picture.points) EXPECT_EQ(point.radiance, color::Rgb{});
}

TEST(PathPicture, StopsWhenItsTimeIsUpAndSaysHowFarItCame) {
  const auto stage = ball_in_a_cup();
  const Gbuffer surface = seen_from_above(*stage, 64, 48);
  PathRequest request;
  request.tolerance_de00 = 0.001;
  request.time_limit_s = 0.3;
  int told = 0;
  request.progress = [&](double noise, double seconds) {
    ++told;
    EXPECT_GT(noise, 0);
    EXPECT_GT(seconds, 0);
  };
  const PathPicture picture = path_picture(*stage->transport, surface, nullptr, request);
  EXPECT_FALSE(picture.reached);
  EXPECT_GT(picture.noise_p95_de00, 0.001);
  EXPECT_LT(picture.time_s, 3);  // of a busy machine
  EXPECT_GT(told, 0);
}

// Judging the noise of a picture takes time, so that a picture that its limit keeps from the tolerance is given up, and
// none is brought to it by a few points at a time: here that took 79 and 42 rounds.
TEST(PathPicture, TakesFewRounds) {
  const auto stage = ball_in_a_cup();
  const Gbuffer surface = seen_from_above(*stage, 32, 24);
  int rounds = 0;
  PathRequest request;
  request.progress = [&](double, double) { ++rounds; };
  request.most_samples = 2048;
  for (const double tolerance : {0.5, 1.0}) {
    rounds = 0;
    request.tolerance_de00 = tolerance;
    const PathPicture picture = path_picture(*stage->transport, surface, nullptr, request);
    EXPECT_EQ(picture.reached, tolerance == 1.0);
    EXPECT_LE(rounds, 16);
    if (picture.reached) continue;
    int noisy = 0, at_limit = 0;
    for (const PathPoint& point : picture.points)
      if (point.noise_de00 > tolerance) ++noisy, at_limit += point.samples >= request.most_samples;
    EXPECT_GT(2 * at_limit, noisy) << "most points that are too noisy got what they may";
  }
}

// Where light grazes a smooth ball of few triangles its facets would shade each other, and the border of light and
// shadow would be jagged. Over a plane that is there twice, at three sizes, every pixel of the lit side shows the
// cosine of its smooth normal. The control starts its rays on the flat triangles.
TEST(HardCase, SmoothBallsAreLitSmoothlyAtAnyScale) {
  constexpr int kWidth = 96, kHeight = 72, kBall = 2;
  double worst = 0, least_textbook = 1;
  for (const double size : {1e-6, 1.0, 1e6}) {
    mesh::Mesh mesh;
    for (const char* name : {"plane", "again"})
      add_rectangle(mesh, name, {-3 * size, 0, -3 * size}, {0, 0, 6 * size}, {6 * size, 0, 0});
    add_mesh(mesh, sphere_mesh(12), size, {0, 1.5 * size, 0});
    PathStage stage(std::move(mesh), {matt({0.5, 0.5, 0.5})});
    const Vec3 to_light = normalized({1, 0.3, 0.2});
    stage.scene.lights = {{to_light, {1, 1, 1}}};
    const Transport& transport = stage.build();
    Camera camera;
    camera.eye = size * Vec3{2, 4, 7};
    camera.target = size * Vec3{0, 1.2, 0};
    camera.fov_deg = 25;
    const Gbuffer surface = visible_surface(transport.rays(), *rays(camera, kWidth, kHeight), kWidth, kHeight);
    PathOptions options;
    options.bounces = 0;
    double ours = 0, textbook = 0;
    int lit = 0, plane = 0, plane_lit = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const int part = surface.part(x, y);
        if (part < 0) continue;
        rays::Spot spot = spot_at(transport.rays(), surface, x, y);
        const rays::Float3 viewer = rays::float3(surface.to_viewer(x, y));
        const double shown = PointTransport(transport, options, spot, viewer).deterministic().y;
        if (part != kBall) {
          plane_lit += std::abs(shown - 0.5 * to_light.y) < 1e-6, ++plane;
          EXPECT_TRUE(shown == 0 || std::abs(shown - 0.5 * to_light.y) < 1e-6);
          continue;
        }
        const double truth = 0.5 * std::max(0.0, dot(rays::vec3(spot.shading), to_light));
        lit += truth > 0;
        ours = worst_of(ours, std::abs(shown - truth));
        spot.start = spot.position + rays::kLift * spot.geometric;
        textbook =
            worst_of(textbook, std::abs(PointTransport(transport, options, spot, viewer).deterministic().y - truth));
      }
    }
    EXPECT_GT(lit, 300);
    EXPECT_GT(plane_lit, 100);
    EXPECT_GT(plane - plane_lit, 100);  // the ball's shadow
    worst = worst_of(worst, ours), least_textbook = std::min(least_textbook, textbook);
  }
  hard_case("transport-self", {"light on a smooth ball of few triangles", least_textbook, worst, 1e-5, "absolute"});
}

// Deep in a cup under even light of 1 a matt paint of albedo a shows a without the cup. What is added to that makes the
// same picture as a sum of all light, also where all that is left is summed; and that has less noise by as many
// samples.
TEST(PathPicture, CorrectsHiddenPointsByTheSumOfWhatIsLeft) {
  constexpr double kAlbedo = 0.5;
  PathStage stage(box_mesh(false), {matt({kAlbedo, kAlbedo, kAlbedo})});
  for (Vec3& p : stage.mesh.positions) p.y = 1 + 3 * (p.y - 1);
  stage.environment = even_environment();
  stage.build();
  const Gbuffer surface = seen_from_above(stage, 32, 24);
  image::Image base;
  base.width = 32, base.height = 24, base.channels = 3;
  base.data.assign(std::size_t{32} * 24 * 3, static_cast<float>(kAlbedo));
  PathRequest request;
  request.options.bounces = 3;
  request.tolerance_de00 = 0.5;
  const PathPicture whole = path_picture(*stage.transport, surface, nullptr, request);
  request.options.correction = true, request.seed = 2;
  request.tolerance_de00 = 0, request.most_samples = 64;
  const PathPicture added = path_picture(*stage.transport, surface, &base, request);
  request.options.correction = true, request.seed = 3;
  const PathPicture never_hidden = path_picture(*stage.transport, surface, nullptr, request);
  ASSERT_EQ(added.points.size(), whole.points.size());
  int hidden = 0;
  double difference = 0, variance = 0, left = 0, taken = 0;
  for (std::size_t i = 0; i < whole.points.size(); ++i) {
    const PathPoint &a = added.points[i], &b = whole.points[i], &c = never_hidden.points[i];
    difference += kAlbedo + a.radiance.y - b.radiance.y, variance += a.covariance[1] + b.covariance[1];
    if (b.radiance.y > 0.3 * kAlbedo) continue;
    ++hidden;
    ASSERT_EQ(a.samples, c.samples);
    left += a.covariance[1], taken += c.covariance[1];
  }
  EXPECT_LT(std::abs(difference), 4 * std::sqrt(variance));
  ASSERT_GT(hidden, 20);
  EXPECT_LT(left, 0.8 * taken) << "the control: what is taken away";
}

// The surfaces that four samples of each pixel show.
std::vector<const Gbuffer*> pointers(const std::vector<Gbuffer>& samples) {
  std::vector<const Gbuffer*> result;
  for (const Gbuffer& sample : samples) result.push_back(&sample);
  return result;
}

std::vector<Gbuffer> four_samples(const PathStage& stage, const Camera& camera, int width, int height) {
  const Rays center = *rays(camera, width, height);
  std::vector<Gbuffer> samples;
  for (const auto& [dx, dy] : sample_shifts(4))
    samples.push_back(visible_surface(stage.transport->rays(), center.shifted(dx, dy), width, height));
  return samples;
}

// The picture that these changes were added to.
image::Image without(const std::vector<PathPoint>& change, const std::vector<PathPoint>& truth, int width, int height) {
  image::Image base = image::even_image(width, height, 3, {"R", "G", "B"});
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c)
      base.pixel(truth[i].x, truth[i].y)[c] = static_cast<float>(truth[i].radiance[c] - change[i].radiance[c]);
  return base;
}

// At the edges of a ball deep in a cup hardly anything is left of the light that the ball shows without the cup. What
// is shown there is near that, at every point.
TEST(PathPicture, EdgesInTheDarkShowTheLightThatIsLeft) {
  const auto stage = ball_in_a_cup();
  constexpr int kWidth = 48, kHeight = 36;
  const std::vector<Gbuffer> samples = four_samples(*stage, from_above(), kWidth, kHeight);
  const auto picture_of = [&](bool correction, bool reconstruct, int most, const image::Image* base) {
    PathRequest request;
    request.options.bounces = 2, request.options.correction = correction;
    request.tolerance_de00 = 0, request.most_samples = most, request.reconstruct = reconstruct;
    return path_picture(*stage->transport, pointers(samples), base, request).points;
  };
  const std::vector<PathPoint> truth = picture_of(false, false, 1024, nullptr),
                               change = picture_of(true, false, 1024, nullptr);
  const image::Image base = without(change, truth, kWidth, kHeight);
  const auto too_dark = [&](const std::vector<PathPoint>& points) {
    return std::ranges::count_if(points, [&](const PathPoint& point) {
      const PathPoint& true_point = truth[static_cast<std::size_t>(&point - points.data())];
      return base.pixel(point.x, point.y)[1] + point.radiance.y < 0.3 * true_point.radiance.y;
    });
  };
  EXPECT_EQ(too_dark(picture_of(true, true, 64, &base)), 0);
  EXPECT_GT(too_dark(picture_of(true, true, 64, nullptr)), 0) << "the control: what is taken away";
}

// Where the light that is left is summed, a pixel at an edge keeps what it shows beside the mesh.
TEST(PathPicture, EdgesInTheDarkKeepWhatIsBesideThem) {
  const auto stage = ball_in_a_cup();
  constexpr int kWidth = 48, kHeight = 36;
  constexpr double kBackground = 2;
  Camera camera = from_above();
  camera.fov_deg *= 2;
  const std::vector<Gbuffer> samples = four_samples(*stage, camera, kWidth, kHeight);
  PathRequest request;
  request.options.bounces = 2, request.tolerance_de00 = 0, request.most_samples = 1024;
  const std::vector<PathPoint> truth = path_picture(*stage->transport, pointers(samples), nullptr, request).points;
  request.options.correction = true;
  const std::vector<PathPoint> change = path_picture(*stage->transport, pointers(samples), nullptr, request).points;
  image::Image base = without(change, truth, kWidth, kHeight), background = image::even_image(kWidth, kHeight, 1);
  for (const PathPoint& point : truth) {
    *background.pixel(point.x, point.y) = static_cast<float>(kBackground * (1 - point.coverage));
    for (int c = 0; c < 3; ++c) base.pixel(point.x, point.y)[c] += *background.pixel(point.x, point.y);
  }
  request.reconstruct = true, request.most_samples = 64;
  const auto lost = [&](const std::function<color::Rgb(int, int)>& beside_mesh) {
    request.beside_mesh = beside_mesh;
    const std::vector<PathPoint> drawn = path_picture(*stage->transport, pointers(samples), &base, request).points;
    int count = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const double beside = *background.pixel(drawn[i].x, drawn[i].y);
      count += base.pixel(drawn[i].x, drawn[i].y)[1] + drawn[i].radiance.y < 0.9 * beside;
    }
    return count;
  };
  EXPECT_EQ(lost([&](int x, int y) {
              const double light = *background.pixel(x, y);
              return color::Rgb{light, light, light};
            }),
            0);
  EXPECT_EQ(lost(nullptr), 0) << "what is not known is not summed";
  EXPECT_GT(lost([](int, int) { return color::Rgb{}; }), 0)
      << "the control: what is beside the mesh counts as its light";
}

// A first round that leaves out points of smooth pieces takes fewer samples, and neighbors tell the points that were
// left out: each has an error, and what is told of the picture is its error. The truth is a picture that is not
// smoothed.
TEST(PathPicture, PointsWithoutSamplesAreToldByTheirNeighbors) {
  const auto stage = ball_in_a_cup();
  constexpr int kWidth = 96, kHeight = 72;
  const std::vector<Gbuffer> samples = four_samples(*stage, from_above(), kWidth, kHeight);
  PathRequest request;
  request.options.bounces = 2;
  request.tolerance_de00 = 1, request.seed = 9;
  const PathPicture truth = path_picture(*stage->transport, pointers(samples), nullptr, request);
  request.reconstruct = true, request.tolerance_de00 = 0, request.most_samples = 8, request.seed = 1;
  const PathPicture dense = path_picture(*stage->transport, pointers(samples), nullptr, request);
  request.first_points = truth.points.size() / 20;
  const PathPicture sparse = path_picture(*stage->transport, pointers(samples), nullptr, request);
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.points.size(); ++i) {
    EXPECT_TRUE(std::isfinite(sparse.points[i].noise_de00)) << i;
    errors.push_back(seen_difference(sparse.points[i].radiance, truth.points[i].radiance, 1));
  }
  EXPECT_LT(sparse.samples_mean, 0.5 * dense.samples_mean);
  const double error = percentile_95(errors);
  EXPECT_GT(sparse.noise_p95_de00, 0.8 * error);
  EXPECT_LT(sparse.noise_p95_de00, 1.25 * error);
}

// The first samples of a point may all miss a small bright light: where no neighbor tells of it, they do not end there.
// The control is a picture of the same tolerance whose points have neighbors.
TEST(PathPicture, PointsThatNoNeighborTellsGetMoreSamples) {
  const auto stage = ball_in_a_cup();
  PathRequest request;
  request.options.bounces = 2, request.tolerance_de00 = 20, request.reconstruct = true;
  const auto samples_of = [&](int width, int height) {
    const std::vector<Gbuffer> samples = four_samples(*stage, from_above(), width, height);
    std::vector<int> counts;
    for (const PathPoint& point : path_picture(*stage->transport, pointers(samples), nullptr, request).points)
      if (point.samples > 0) counts.push_back(point.samples);
    std::ranges::sort(counts);
    return counts;
  };
  const std::vector<int> apart = samples_of(4, 3), beside = samples_of(48, 36);
  ASSERT_FALSE(apart.empty());
  EXPECT_EQ(beside[beside.size() / 2], 8) << "the first round";
  EXPECT_GE(apart[apart.size() / 2], 16);
}

// In large pictures few points are sampled first. Which of the others lie in the dark is told by several of them: by
// the one or two in a neighborhood of fixed size, pieces of the dark were decided by chance. Control: all points are
// sampled.
TEST(PathPicture, TheDarkIsFoundByFewPoints) {
  const auto stage = ball_in_a_cup();
  constexpr int kWidth = 160, kHeight = 120;
  const std::vector<Gbuffer> samples = four_samples(*stage, from_above(), kWidth, kHeight);
  PathRequest request;
  request.options.bounces = 2, request.tolerance_de00 = 0, request.most_samples = 512;
  const std::vector<PathPoint> truth = path_picture(*stage->transport, pointers(samples), nullptr, request).points;
  request.options.correction = true;
  const std::vector<PathPoint> change = path_picture(*stage->transport, pointers(samples), nullptr, request).points;
  const image::Image base = without(change, truth, kWidth, kHeight);
  request.reconstruct = true, request.most_samples = 8;
  const auto error_with = [&](std::size_t first_points) {
    request.first_points = first_points;
    std::vector<double> errors;
    const std::vector<PathPoint> drawn = path_picture(*stage->transport, pointers(samples), &base, request).points;
    for (std::size_t i = 0; i < truth.size(); ++i)
      errors.push_back(std::abs(drawn[i].radiance.y - change[i].radiance.y));
    return percentile_95(errors);
  };
  EXPECT_LT(error_with(truth.size() / 32), 2.8 * error_with(truth.size()));
}

// Points that were drawn before, in other bands of a picture, share its tolerance: beside many without an error samples
// end earlier, and beside worse ones no later than alone, which is the control. What is told is the error of all.
TEST(PathPicture, SharesItsToleranceWithPointsThatWereDrawnBefore) {
  const auto stage = ball_in_a_cup();
  const std::vector<Gbuffer> samples = four_samples(*stage, from_above(), 64, 48);
  PathRequest request;
  request.options.bounces = 2;
  request.tolerance_de00 = 1, request.reconstruct = true, request.seed = 1;
  const auto picture_beside = [&](double error_de00, std::size_t count) {
    const PointErrors before{std::vector<double>(count, error_de00), {}};
    request.before = &before;
    return path_picture(*stage->transport, pointers(samples), nullptr, request);
  };
  const PathPicture alone = picture_beside(0, 0);
  ASSERT_TRUE(alone.reached);
  const PathPicture late = picture_beside(0, 40 * alone.points.size());
  EXPECT_TRUE(late.reached);
  EXPECT_LT(late.samples_mean, 0.6 * alone.samples_mean);
  EXPECT_LT(late.error_p95_de00, 0.5 * alone.error_p95_de00);
  const PathPicture beside_worse = picture_beside(3, 9 * alone.points.size());
  EXPECT_EQ(beside_worse.samples_mean, alone.samples_mean);
  EXPECT_FALSE(beside_worse.reached);
  EXPECT_GT(beside_worse.error_p95_de00, 3);
}

// Groups of any size are drawn together, by the memory that samples take.
TEST(PathPicture, TakesAnyNumberOfSamplesOfAPixel) {
  const auto stage = ball_in_a_cup();
  const std::vector<Gbuffer> samples = four_samples(*stage, from_above(), 32, 24);
  const std::vector<const Gbuffer*> all = pointers(samples);
  PathRequest request;
  request.options.bounces = 2;
  request.tolerance_de00 = 3, request.reconstruct = true;
  std::vector<double> sums;
  for (std::size_t count = 1; count <= all.size(); ++count) {
    color::Rgb sum;
    const PathPicture picture = path_picture(*stage->transport, PixelSamples(all.data(), count), nullptr, request);
    for (const PathPoint& point : picture.points) sum += point.radiance;
    sums.push_back(color::xyz_d65_from_rgb(sum).Y);
  }
  for (const double one : sums) EXPECT_NEAR(one, sums.back(), 0.03 * sums.back());
}

// Two boxes with a gap between them that a few pixels show, under a bright lamp. The first round is within the
// tolerance at 95 of 100 points, and one more mends the worst of the others. Control: the first round alone.
TEST(PathPicture, TheWorstPointsGetOneRoundMore) {
  mesh::Mesh box = box_mesh(true), boxes;
  for (auto& t : box.triangles) std::swap(t[1], t[2]);  // facing outward
  for (Vec3& n : box.normals) n = -n;
  for (const double x : {-1.03, 1.03}) add_mesh(boxes, box, 1, {x, 0, 0});
  PathStage stage(boxes, {matt({0.7, 0.6, 0.5})});
  stage.environment = environment_of(64, 32, [](int x, int y) {
    return x >= 20 && x < 23 && y >= 5 && y < 8 ? color::Rgb{60, 60, 60} : color::Rgb{0.3, 0.4, 0.5};
  });
  stage.build();
  Camera camera;
  camera.eye = {0.2, 5, 1};
  camera.fov_deg = 30;
  constexpr int kWidth = 128, kHeight = 96;
  const std::vector<Gbuffer> samples = four_samples(stage, camera, kWidth, kHeight);
  PathRequest request;
  request.options.bounces = 2, request.options.correction = true;
  constexpr color::Rgb kBase{0.2, 0.2, 0.2};
  image::Image base;
  base.width = kWidth, base.height = kHeight, base.channels = 3;
  base.data.assign(std::size_t{kWidth} * kHeight * 3, 0.2F);
  request.tolerance_de00 = 0, request.most_samples = 8;
  constexpr int kPictures = 64;
  std::vector<color::Rgb> truth;
  for (int i = 0; i < kPictures; ++i) {
    request.seed = 100 + static_cast<std::uint64_t>(i);
    const PathPicture one = path_picture(*stage.transport, pointers(samples), &base, request);
    truth.resize(one.points.size(), kBase);
    for (std::size_t k = 0; k < truth.size(); ++k) truth[k] += (1.0 / kPictures) * one.points[k].radiance;
  }
  request.reconstruct = true, request.seed = 1;
  const PathPicture first = path_picture(*stage.transport, pointers(samples), &base, request);
  request.tolerance_de00 = 1, request.most_samples = 1 << 16;
  const PathPicture mended = path_picture(*stage.transport, pointers(samples), &base, request);
  const auto worst = [&](const PathPicture& picture) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < truth.size(); ++i)
      errors.push_back(seen_difference(kBase + picture.points[i].radiance, truth[i], 1));
    std::ranges::sort(errors);
    return errors[errors.size() * 995 / 1000];
  };
  ASSERT_LT(first.noise_p95_de00, request.tolerance_de00);
  EXPECT_TRUE(mended.reached);
  EXPECT_LE(mended.samples_mean, first.samples_mean + 2);
  EXPECT_LT(worst(mended), 0.6 * worst(first));
  // Nor do they stay where no share changes much at most points, so that all stop.
  request.stop_de00 = 0.35;
  const PathPicture stopped = path_picture(*stage.transport, pointers(samples), &base, request);
  ASSERT_TRUE(std::ranges::all_of(std::span(stopped.found).first(3), &FoundShare::stopped));
  EXPECT_LT(worst(stopped), 0.7 * worst(first));
  request.stop_de00 = 0;
  request.most_samples = 8;
  EXPECT_EQ(path_picture(*stage.transport, pointers(samples), &base, request).samples_mean, first.samples_mean)
      << "no point gets more than it may";
}

TEST(Noise, IsTheSpreadOfSmallErrors) {
  TestNumbers next(2);
  const auto normal = [&] { return std::sqrt(-2 * std::log(1 - next())) * std::cos(6.283185307179586 * next()); };
  for (const color::Rgb& color : {color::Rgb{0.2, 0.2, 0.2}, color::Rgb{0.5, 0.1, 0.05}, color::Rgb{0.02, 0.3, 0.1},
                                  color::Rgb{0.003, 0.004, 0.002}, color::Rgb{2, 2, 1.5}}) {
    // Errors in brightness, and a third of that in each channel alone.
    const double common = 0.01, own = 0.003;
    Covariance covariance{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double c = color[static_cast<int>(i)];
      covariance[i] = c * c * (common * common + own * own);
    }
    covariance[3] = color.x * color.y * common * common, covariance[4] = color.x * color.z * common * common,
    covariance[5] = color.y * color.z * common * common;
    double squares = 0;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
      const double all = common * normal();
      const color::Rgb off =
          color * color::Rgb{1 + all + own * normal(), 1 + all + own * normal(), 1 + all + own * normal()};
      squares += std::pow(seen_difference(off, color, 1), 2) / kCount;
    }
    EXPECT_NEAR(noise_de00(color, covariance, 1) / std::sqrt(squares), 1, 0.05);
  }
}

}  // namespace
}  // namespace goniochrome::render::path_tracer_test
