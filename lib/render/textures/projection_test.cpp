#include "render/textures/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/random_for_test.h"
#include "render/scenes_for_test.h"
#include "render/textures/texture_places.h"

namespace goniochrome::render::projection_test {
namespace {

Vec3 tangent_of(const TexturePlace& place) {
  return {place.tangent[0], place.tangent[1], place.tangent[2]};
}

// True if the two sides of a box that are nearest to the normal are about as near.
bool near_an_edge(const Vec3& n) {
  std::array<double, 3> size = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  std::ranges::sort(size);
  return size[2] - size[1] < 0.05;
}

// The tangent and the other direction are those in which u and v grow, by finite differences on the surface; and a
// texture is never mirrored. The surface is a unit sphere, on which every normal occurs. Steps that cross an edge of
// the projection, where u jumps, are passed over.
TEST(Projection, TangentsRunAlongGrowingUAndNothingIsMirrored) {
  TestNumbers random(5);
  for (const Projection projection :
       {Projection::kPlanar, Projection::kBox, Projection::kCylinder, Projection::kSphere, Projection::kDecal}) {
    for (const Vec3& axis : {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}, normalized({1, 2, 3})}) {
      int tested = 0;
      for (int i = 0; i < 400; ++i) {
        TextureLaying laying{projection, axis, {0.1, -0.2, 0.3}, 3, 0.5, 0.4};
        laying.around = 2;
        if (projection == Projection::kCylinder) laying.center = {};  // elsewhere some of the sphere faces its axis
        const Vec3 n = normalized({random() - 0.5, random() - 0.5, random() - 0.5});
        if (std::abs(dot(n, axis)) < 0.1 || std::abs(dot(n, axis)) > 0.95) continue;
        if (projection == Projection::kBox && near_an_edge(n)) continue;
        const TexturePlace here = projected(laying, n, n);
        const Vec3 t = tangent_of(here);
        const Vec3 level = normalized(t - dot(t, n) * n), other = cross(n, level);
        constexpr double kStep = 1e-2;
        const auto moved = [&](const Vec3& way) {
          const Vec3 m = normalized(n + kStep * way);
          return projected(laying, m, m);
        };
        const TexturePlace by_tangent = moved(level), by_other = moved(other);
        const double du = by_tangent.u - here.u, dv = by_other.v - here.v;
        if (std::abs(du) > 0.2 || std::abs(dv) > 0.2) continue;
        if (projection == Projection::kDecal && (du == 0 || dv == 0)) continue;  // on its edge
        EXPECT_GT(du, 0) << static_cast<int>(projection);
        EXPECT_GT(dv, 0) << static_cast<int>(projection);
        ++tested;
      }
      EXPECT_GT(tested, projection == Projection::kDecal ? 20 : 200) << static_cast<int>(projection);
    }
  }
}

TEST(Projection, WidthAndCenterAreInUnitsOfTheMesh) {
  const TextureLaying planar{Projection::kPlanar, {0, 0, 1}, {1, 2, 0}, 4, 0.5, 0};
  const TexturePlace middle = projected(planar, {1, 2, 7}, {0, 0, 1}), right = projected(planar, {2, 2, 0}, {0, 0, 1});
  EXPECT_FLOAT_EQ(middle.u, 0.5F);
  EXPECT_FLOAT_EQ(middle.v, 0.5F);
  EXPECT_FLOAT_EQ(right.u, 0.75F);
  EXPECT_FLOAT_EQ(projected(planar, {1, 3, 0}, {0, 0, 1}).v, 1.0F);
  EXPECT_FLOAT_EQ(projected(planar, {2, 2, 0}, {0, 0, -1}).u, 0.25F) << "read from behind";
  TextureLaying turned = planar;
  turned.turn_rad = kPi / 2;
  EXPECT_FLOAT_EQ(projected(turned, {1, 3, 0}, {0, 0, 1}).u, 0.75F) << "u runs up";
}

// The azimuth jumps from pi to -pi at the back. Texels go on there, since the repetition is whole.
TEST(Projection, ACylinderHasNoSeam) {
  TextureLaying laying{Projection::kCylinder, {0, 1, 0}, {}, 1, 1, 0.3};
  laying.around = 3;
  for (const double turn : {0.0, 0.3, 2.0}) {
    laying.turn_rad = turn;
    const TexturePlace left = projected(laying, {1e-6, 0, -1}, {0, 0, -1}),
                       right = projected(laying, {-1e-6, 0, -1}, {0, 0, -1});
    const double apart = left.u - right.u;
    EXPECT_NEAR(apart, std::round(apart), 1e-4);
    EXPECT_NEAR(tangent_of(left).x, tangent_of(right).x, 1e-5);
  }
  laying.turn_rad = 0;
  EXPECT_FLOAT_EQ(projected(laying, {0, 0, 5}, {0, 0, 1}).u, 0.5F) << "the middle is in front";
  laying.projection = Projection::kSphere, laying.around = 1;
  EXPECT_FLOAT_EQ(projected(laying, {0, 9, 0}, {0, 1, 0}).v, 1.0F);
  EXPECT_TRUE(std::isfinite(projected(laying, {}, {0, 1, 0}).u)) << "in the middle of the sphere";
}

TEST(Projection, ADecalIsLaidOnceAndFromOneSide) {
  TextureLaying laying{Projection::kDecal, {0, 1, 0}, {}, 1, 1, 0};
  laying.half_texel_u = laying.half_texel_v = 0.125;
  EXPECT_FLOAT_EQ(projected(laying, {0.2, 3, 0}, {0, 1, 0}).u, 0.7F);
  EXPECT_FLOAT_EQ(projected(laying, {9, 3, 0}, {0, 1, 0}).u, 0.875F);
  EXPECT_FLOAT_EQ(projected(laying, {0, 3, 9}, {0, 1, 0}).v, 0.125F);
  EXPECT_FLOAT_EQ(projected(laying, {0, 3, 0}, {0, -1, 0}).u, 0.125F) << "from behind there is its edge";
}

// The old way for meshes without coordinates, around the vertical axis, makes rays about the pole: texels there are
// stretched without end. A box does not.
TEST(Projection, ABoxStretchesNoTexelByMoreThanARoot) {
  TestNumbers random(9);
  double most = 0, most_around = 0;
  TextureLaying box{Projection::kBox, {0, 1, 0}, {}, 1, 1, 0}, around{Projection::kCylinder, {0, 1, 0}, {}, 1, 1, 0};
  for (int i = 0; i < 2000; ++i) {
    const Vec3 n = normalized({random() - 0.5, random() - 0.5, random() - 0.5});
    for (const TextureLaying* laying : {&box, &around}) {
      const TexturePlace here = projected(*laying, n, n);
      for (double a = 0; a < 180; a += 15) {
        const Vec3 x = normalized(cross(std::abs(n.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n));
        const Vec3 way = std::cos(a * kDegree) * x + std::sin(a * kDegree) * cross(n, x);
        const Vec3 m = n + 1e-3 * way;
        const TexturePlace there = projected(*laying, m, n);
        const double step = std::hypot(there.u - here.u, there.v - here.v) / 1e-3;
        if (step > 100) continue;  // across the jump of the azimuth
        const double stretched = laying == &box ? 1 / step : step * 2 * kPi;
        double& worst = laying == &box ? most : most_around;
        worst = std::max(worst, stretched);
      }
    }
  }
  EXPECT_LT(most, std::sqrt(3.0) + 0.01);
  EXPECT_GT(most_around, 10);
}

// Where a box jumps from one side to the next, the facets of a triplanar projection are blended: what they show
// together does not jump, and their shares add up to 1. The box is the control.
TEST(Projection, FacetsBlendWhereABoxJumps) {
  const auto shown = [](const Vec3& n, bool blended) {
    double sum = 0, shares = 0;
    for (int facet = 0; facet < (blended ? 3 : 1); ++facet) {
      TextureLaying laying{blended ? Projection::kFacet : Projection::kBox, {0, 1, 0}, {}, 3, 1, 0};
      laying.facet = facet;
      const TexturePlace place = projected(laying, n, n);
      sum += place.share * place.u, shares += place.share;
    }
    EXPECT_NEAR(shares, 1, 1e-6);
    return sum;
  };
  double most = 0, most_of_box = 0;
  for (double turn = 1; turn < 360; turn += 7) {
    for (const double height : {-0.6, -0.2, 0.3, 0.7}) {
      const auto at = [&](double azimuth_deg) {
        const double wide = std::sqrt(1 - height * height);
        return Vec3{wide * std::sin(azimuth_deg * kDegree), height, wide * std::cos(azimuth_deg * kDegree)};
      };
      const double edge = 90 * std::floor(turn / 90) + 45;
      most = std::max(most, std::abs(shown(at(turn + 0.05), true) - shown(at(turn - 0.05), true)));
      most = std::max(most, std::abs(shown(at(edge + 0.05), true) - shown(at(edge - 0.05), true)));
      most_of_box = std::max(most_of_box, std::abs(shown(at(edge + 0.05), false) - shown(at(edge - 0.05), false)));
    }
  }
  EXPECT_LT(most, 0.01);
  EXPECT_GT(most_of_box, 0.2);
  EXPECT_NEAR(facet_shares({0, 0, -1}).z, 1, 1e-12);
}

// Beyond its edge and behind, a decal that ends shows nothing.
TEST(Projection, ADecalThatEndsShowsNothingElsewhere) {
  TextureLaying laying{Projection::kDecal, {0, 1, 0}, {}, 1, 1, 0};
  laying.ends = true;
  EXPECT_EQ(projected(laying, {0.4, 3, 0.4}, {0, 1, 0}).share, 1);
  EXPECT_EQ(projected(laying, {0.6, 3, 0}, {0, 1, 0}).share, 0);
  EXPECT_EQ(projected(laying, {0, 3, -0.6}, {0, 1, 0}).share, 0);
  EXPECT_EQ(projected(laying, {0, -3, 0}, {0, -1, 0}).share, 0);
  laying.ends = false;
  EXPECT_EQ(projected(laying, {0.6, 3, 0}, {0, 1, 0}).share, 1);
}

// Pixels of a G-buffer are projected one by one, as the point of the mesh is.
TEST(Projection, PlacesOfPixelsAreThoseOfPoints) {
  const mesh::Mesh mesh = sphere_mesh(32);
  Camera camera;
  camera.eye = {0, 2, 6};
  const Gbuffer g = seen_by_rays(mesh, camera, 32, 32);
  TextureLaying laying{Projection::kBox, {0, 1, 0}, {}, 2, 1, 0};
  const TextureLayout layout(mesh, {true}, {laying});
  const auto places = layout.places(g);
  int seen = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      if (g.part(x, y) < 0) continue;
      const MeshPoint point = mesh_point(mesh, g, x, y);
      const TexturePlace place = layout.place(0, point, false);
      EXPECT_EQ(place.u, places[g.index(x, y)].u);
      const Vec3 from = point.position;
      const double x_of = std::abs(from.x), y_of = std::abs(from.y), z_of = std::abs(from.z);
      if (z_of > 1.1 * std::max(x_of, y_of) && from.z > 0) {
        EXPECT_NEAR(place.u, 0.5 + from.x / 2, 1e-5);
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 20);
}

}  // namespace
}  // namespace goniochrome::render::projection_test
