#include "mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <thread>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "base/scratch_for_test.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh::mesh_test {
namespace {

using testing::HasSubstr;

class MeshFiles : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& content) const { return folder_.file(name, content); }
  Result<Mesh> obj(const std::string& content) const { return read_mesh(file("t.obj", content)); }
  std::string obj_error(const std::string& content) const {
    const auto mesh = obj(content);
    return mesh.ok() ? "no error" : mesh.error().message.substr(folder_.path("").size());
  }
  ScratchFolder folder_;
};

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    sum += length(cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i])) / 2;
  }
  return sum;
}

TEST_F(MeshFiles, PartsComeFromObjectsAndANameTwiceIsOnePart) {
  const auto mesh = obj(kSquare + "o hood\nusemtl red\nf 1 2 3\no roof\nusemtl blue\nf 1 3 4\no hood\nf 2 3 4\n");
  ASSERT_TRUE(mesh.ok());
  ASSERT_EQ(mesh->parts.size(), 2u);
  EXPECT_EQ(mesh->parts[0].name, "hood");
  EXPECT_EQ(mesh->parts[0].material, "red");
  EXPECT_EQ(mesh->parts[0].first, 0u);
  EXPECT_EQ(mesh->parts[0].count, 2u);
  EXPECT_EQ(mesh->parts[1].name, "roof");
  EXPECT_EQ(mesh->parts[1].first, 2u);
}

TEST_F(MeshFiles, GroupsNamePartsOnlyWhereThereAreNoObjects) {
  const auto groups = obj(kSquare + "g left side\nf 1 2 3\ng right\nf 1 3 4\n");
  ASSERT_TRUE(groups.ok());
  ASSERT_EQ(groups->parts.size(), 2u);
  EXPECT_EQ(groups->parts[0].name, "left side");
  const auto objects = obj(kSquare + "g left\nf 1 2 3\no all\ng right\nf 1 3 4\n");
  ASSERT_TRUE(objects.ok());
  ASSERT_EQ(objects->parts.size(), 2u);
  EXPECT_EQ(objects->parts[0].name, "unnamed");
  EXPECT_EQ(objects->parts[1].name, "all");
  EXPECT_EQ(obj(kSquare + "f 1 2 3\n")->parts[0].name, "t") << "the file names the only part";
}

TEST_F(MeshFiles, EveryWayToWriteACornerIsRead) {
  const std::string tail = "vt 0 0\nvn 0 0 5\n";
  for (const char* face : {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1", "f -4 -3 -2",
                           "f -4/-1/-1 -3/-1/-1 -2/-1/-1", "f 1 \\\n2 3", "f 1 2 3 # not 4", "f\t1  2\t3 \r"}) {
    const auto mesh = obj(kSquare + tail + face + "\n");
    ASSERT_TRUE(mesh.ok()) << face << ": " << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 1u) << face;
    for (const Vec3& n : mesh->normals) EXPECT_EQ(n, (Vec3{0, 0, 1})) << face;
  }
}

TEST_F(MeshFiles, VertexColorsAndStrangersArePassedOver) {
  const auto mesh = obj("mtllib x.mtl\nv 0 0 0 1 .5 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\ns off\nl 1 2\nf 1 2 3");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 1u);
}

// The mark in front of the first statement hid it, so that every face lay one vertex further on.
TEST_F(MeshFiles, MarksOfEncodingsAreNoPartOfTheText) {
  const std::string text = kSquare + "v 9 9 9\nf 1 2 3 4\n";
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += {c, '\0'};
  for (const std::string& marked : {text, "\xef\xbb\xbf" + text, wide}) {
    const auto mesh = obj(marked);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_NEAR(area(*mesh), 1, 1e-15);
  }
}

TEST_F(MeshFiles, TheUnitIsThatOfTheFileWhereItStatesOne) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(obj(triangle)->unit_m, 0);
  EXPECT_EQ(obj("# File units = inches\n" + triangle)->unit_m, 0.0254);
}

// Glass within the object of a body was painted without a word.
TEST_F(MeshFiles, SeveralMaterialsOfOnePartAreRemarked) {
  const auto mesh = obj(kSquare + "o body\nusemtl lacquer\nf 1 2 3\nusemtl glass\nf 1 3 4\n");
  EXPECT_THAT(mesh->remarks,
              testing::ElementsAre("\"body\" has faces of several materials (\"lacquer\", \"glass\"), "
                                   "and is one part of the first: write an o line before each material"));
  EXPECT_TRUE(obj(kSquare + "o body\nusemtl a\nf 1 2 3\no glass\nusemtl b\nf 1 3 4\n")->remarks.empty());
}

TEST_F(MeshFiles, FreeFormSurfacesAreRemarked) {
  const std::string form = "cstype bezier\nsurf 0 1 0 1 1 2 3 4\nend\n";
  EXPECT_THAT(obj(kSquare + "f 1 2 3 4\n" + form)->remarks, testing::ElementsAre(HasSubstr("1 free-form surfaces")));
  EXPECT_THAT(obj(kSquare + "f 1 2 3 4\n")->remarks, testing::IsEmpty());
  EXPECT_THAT(obj_error(kSquare + form), HasSubstr("no faces (f lines), but free-form surfaces"));
}

TEST_F(MeshFiles, ErrorsNameLineValueAndRemedy) {
  EXPECT_EQ(obj_error("v 0 0,5 0\n"),
            "t.obj:1: vertex coordinate 2 is \"0,5\": write a finite number with a decimal point");
  EXPECT_EQ(obj_error("v 0 0\n"), "t.obj:1: vertex coordinate 3 is \"\": write a finite number with a decimal point");
  EXPECT_THAT(obj_error("v 0 nan 0\n"), HasSubstr("\"nan\""));
  EXPECT_EQ(obj_error(kSquare + "f 1 2 9\n"),
            "t.obj:5: the face refers to vertex 9, but there are 4 so far: the file may be cut or reordered");
  EXPECT_THAT(obj_error(kSquare + "f 1 2 -5\n"), HasSubstr("vertex -5"));
  EXPECT_THAT(obj_error(kSquare + "f 0 1 2\n"), HasSubstr("whole number from 1"));
  EXPECT_THAT(obj_error(kSquare + "f 1//1 2//1 3//1\n"), HasSubstr("normal 1, but there are 0"));
  EXPECT_THAT(obj_error(kSquare + "\nf 1 2\n"), HasSubstr("t.obj:6: the face has 2 corners"));
  EXPECT_THAT(obj_error(kSquare), HasSubstr("holds no faces"));
  EXPECT_THAT(obj_error(kSquare + "f 1 1 2\n"), HasSubstr("none of its 1 faces has an area"));
  EXPECT_THAT(obj_error(kSquare + "f 1 2 \\\n3 \\\nx\n"), HasSubstr("t.obj:7: \"x\"")) << "continued lines count";
  EXPECT_THAT(read_mesh("car.fbx").error().message, HasSubstr("\".fbx\" is no mesh format"));
  EXPECT_THAT(read_mesh("/nowhere/car.obj").error().message, HasSubstr("No such file"));
  EXPECT_THAT(read_mesh("/nowhere/car.ply").error().message, HasSubstr("No such file"));
  EXPECT_THAT(read_mesh(file("cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\n")).error().message,
              HasSubstr("not a whole ply mesh"));
}

// A fan from the first corner, the textbook triangulation, covers the notch of a concave polygon.
TEST(Triangulation, ConcavePolygonKeepsItsArea) {
  const std::vector<Vec3> arrow = {
      {0, 0, 0}, {2, -2, 1}, {1, 0, 0.5}, {2, 2, 1}};  // in the plane z = x/2, a notch at 1
  const std::vector<Vec3> comb = {{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {4, 3, 0}, {4, 1, 0}, {3, 1, 0},
                                  {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  const auto signed_area = [](const std::vector<Vec3>& p, const auto& triangles) {
    double sum = 0, absolute = 0;
    for (const auto& [i, j, k] : triangles) {
      const Vec3 doubled = cross(p[j] - p[i], p[k] - p[i]);
      sum += doubled.z / 2;
      absolute += std::abs(doubled.z) / 2;
    }
    return std::pair{sum, absolute};
  };
  for (const auto& [ring, wanted] : {std::pair{arrow, 2.0}, std::pair{comb, 11.0}}) {
    for (std::size_t turn = 0; turn < ring.size(); ++turn) {
      std::vector<Vec3> turned = ring;
      std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turn), turned.end());
      const auto triangles = triangulated(turned);
      EXPECT_EQ(triangles.size(), ring.size() - 2);
      const auto [sum, absolute] = signed_area(turned, triangles);
      EXPECT_NEAR(sum, wanted, 1e-12);
      EXPECT_NEAR(absolute, wanted, 1e-12) << "no triangle may be turned over";
    }
  }
  std::vector<std::array<std::uint32_t, 3>> fan;
  std::vector<Vec3> turned = comb;
  std::rotate(turned.begin(), turned.begin() + 2, turned.end());
  for (std::uint32_t i = 1; i + 1 < turned.size(); ++i) fan.push_back({0, i, i + 1});
  EXPECT_GT(signed_area(turned, fan).second, 11.5) << "the control must fail";
}

TEST(Triangulation, HopelessPolygonsStillEnd) {
  EXPECT_EQ(triangulated(std::vector<Vec3>(50)).size(), 48u);                                     // all in one place
  EXPECT_EQ(triangulated({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 2, 0}}).size(), 3u);  // crosses itself
}

TEST_F(MeshFiles, DegenerateTrianglesAreDroppedAndCounted) {
  const auto mesh = obj(kSquare + "v 0.5 0 0\nf 1 2 3\nf 1 1 2\nf 1 5 2\nf 1 3 4\n");
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->repairs.degenerate_dropped, 2);
  EXPECT_EQ(mesh->triangles.size(), 2u);
  EXPECT_NEAR(area(*mesh), 1, 1e-15);
  EXPECT_TRUE(mesh->repairs.parts_dropped.empty());
}

TEST_F(MeshFiles, PartsWithoutAnAreaAreNamed) {
  const auto mesh = obj(kSquare + "o flat\nf 1 1 2\no body\nf 1 2 3\nf 1 3 3\n");
  ASSERT_TRUE(mesh.ok());
  ASSERT_EQ(mesh->parts.size(), 1u);
  EXPECT_EQ(mesh->parts[0].name, "body");
  EXPECT_EQ(mesh->repairs.parts_dropped, std::vector<std::string>{"flat"});
}

TEST_F(MeshFiles, TrianglesAreTurnedToTheirNormals) {
  const auto mesh = obj(kSquare + "vn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 4//1 3//1\n");
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->repairs.triangles_turned, 1);
  for (const auto& [i, j, k] : mesh->triangles) {
    EXPECT_GT(cross(mesh->positions[j] - mesh->positions[i], mesh->positions[k] - mesh->positions[i]).z, 0);
  }
}

// A cube keeps its six flat faces, a fine sphere gets smooth normals: the made normal of a sphere's vertex is radial
// within the size of its triangles squared.
TEST_F(MeshFiles, MadeNormalsAreSmoothButKeepCreases) {
  const auto cube =
      obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
          "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  ASSERT_TRUE(cube.ok());
  EXPECT_EQ(cube->positions.size(), 24u);
  EXPECT_EQ(cube->repairs.normals_made, 24);
  EXPECT_EQ(cube->repairs.polygons_split, 6);
  for (const auto& triangle : cube->triangles) {
    EXPECT_EQ(cube->normals[triangle[0]], cube->normals[triangle[1]]);
    EXPECT_EQ(cube->normals[triangle[0]], cube->normals[triangle[2]]);
  }

  constexpr int kRows = 32, kColumns = 64;
  std::string text;
  for (int i = 0; i <= kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const double t = kPi * i / kRows, p = 2 * kPi * j / kColumns;
      const double sine = i % kRows == 0 ? 0 : std::sin(t);  // the poles are one point, whatever the number of vertices
      text += fmt::format("v {} {} {}\n", sine * std::cos(p), std::cos(t), sine * std::sin(p));
    }
  }
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const int a = i * kColumns + j + 1, b = i * kColumns + (j + 1) % kColumns + 1;
      text += fmt::format("f {} {} {} {}\n", a, b, b + kColumns, a + kColumns);
    }
  }
  const auto sphere = obj(text);
  ASSERT_TRUE(sphere.ok());
  EXPECT_EQ(sphere->repairs.degenerate_dropped, 2 * kColumns) << "one triangle of each quad at the poles";
  for (std::size_t i = 0; i < sphere->normals.size(); ++i) {
    EXPECT_NEAR(length(sphere->normals[i]), 1, 1e-15);
    EXPECT_NEAR(dot(sphere->normals[i], sphere->positions[i]), 1, 1e-4);
  }
}

// A strip of squares of several megabytes, written in every way that makes a chunk depend on those before it: indices
// that count back, parts and materials that go on, and lines that are continued. What is read is known from how it is
// made.
std::string long_strip(int squares) {
  std::string text = "v 0 0 0\nv 0 1 0\nvn 0 0 1\n";
  for (int i = 1; i <= squares; ++i) {
    if (i % (squares / 3) == 1) text += fmt::format("o part{}\nusemtl m{}\n", i / (squares / 3) % 2, i);
    text += fmt::format("v {} 0 \\\n0\nv {} 1 0  # a comment of some length, so that the text has many bytes\n", i, i);
    text += i % 2 == 0 ? std::string("f -4//1 -2//1 \\\n -1//1 -3//1\n")
                       : fmt::format("f {}//-1 {}//-1 {}//-1 {}//-1\n", 2 * i - 1, 2 * i + 1, 2 * i + 2, 2 * i);
  }
  return text;
}

TEST_F(MeshFiles, LongTextsAreReadInChunksAsIfInOnePieceByAnyNumberOfThreads) {
  constexpr int kSquares = 39999;  // in three runs of 13333, of parts 0, 1 and 0
  const std::string text = long_strip(kSquares);
  ASSERT_GT(text.size(), std::size_t{3} << 20) << "several chunks";
  const std::string path = file("strip.obj", text);
  for (const int threads : {1, 2, 5}) {
    set_threads(threads);
    const auto mesh = read_mesh(path);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    ASSERT_EQ(mesh->triangles.size(), 2u * kSquares);
    EXPECT_EQ(mesh->positions.size(), 2u * kSquares + 2);
    EXPECT_NEAR(area(*mesh), kSquares, 1e-9 * kSquares);
    ASSERT_EQ(mesh->parts.size(), 2u);  // part0 goes on after part1
    EXPECT_EQ(mesh->parts[0].name, "part0");
    EXPECT_EQ(mesh->parts[0].material, "m1");
    EXPECT_EQ(mesh->parts[1].count, 2u * (kSquares / 3));
    // In each part the squares stand in order: triangle 2 i lies in the square of its own number.
    for (std::size_t part = 0, first = 0; part < 2; first += mesh->parts[part++].count)
      for (std::size_t t = first; t < first + mesh->parts[part].count; ++t) {
        double middle = 0;
        for (const auto vertex : mesh->triangles[t]) middle += mesh->positions[vertex].x / 3;
        const int third = kSquares / 3, in_part = static_cast<int>(t - first) / 2;
        const int square = part == 1 ? third + in_part : in_part < third ? in_part : third + in_part;
        ASSERT_EQ(std::floor(middle), square) << "triangle " << t;
      }
  }
  // The first error counts, wherever threads meet another one.
  const std::string broken = text + "v 1 2 x\n" + long_strip(kSquares) + "f 1 2\n";
  const auto lines = std::count(text.begin(), text.end(), '\n');
  for (const int threads : {1, 5}) {
    set_threads(threads);
    EXPECT_EQ(obj_error(broken), fmt::format("t.obj:{}: vertex coordinate 3 is \"x\": write a finite number with a "
                                             "decimal point",
                                             lines + 1));
  }
  set_threads(0);
}

// A fan around the tip of a steep cone, whose neighbors within 60 degrees are a third of all. The sum over them is
// compared with a plain loop over all, which takes n^2 steps.
TEST_F(MeshFiles, ATipOfManyTrianglesGetsTheNormalsOfItsNeighborhoodInLessThanQuadraticTime) {
  const auto spike = [](int sides) {
    std::string text = "v 0 3 0\n";
    for (int i = 0; i < sides; ++i)
      text += fmt::format("v {} 0 {}\n", std::cos(2 * kPi * i / sides), std::sin(2 * kPi * i / sides));
    for (int i = 0; i < sides; ++i) text += fmt::format("f 1 {} {}\n", (i + 1) % sides + 2, i + 2);
    return text;
  };
  constexpr int kSides = 1000;
  const auto mesh = obj(spike(kSides));
  ASSERT_TRUE(mesh.ok());
  std::vector<Vec3> weighted, normals;
  for (const auto& [i, j, k] : mesh->triangles) {
    const Vec3 a = mesh->positions[j] - mesh->positions[i], b = mesh->positions[k] - mesh->positions[i];
    normals.push_back(normalized(cross(a, b)));
    weighted.push_back(std::atan2(length(cross(a, b)), dot(a, b)) * normals.back());
  }
  for (int t = 0; t < kSides; ++t) {
    Vec3 sum;
    double apart = 1;  // from the limit
    for (int other = 0; other < kSides; ++other) {
      const double cosine = dot(normals[t], normals[other]);
      apart = std::min(apart, std::abs(cosine - 0.5));
      if (cosine >= 0.5) sum += weighted[other];
    }
    if (apart < 1e-9) continue;  // rounding decides
    const Vec3 made = mesh->normals[mesh->triangles[static_cast<std::size_t>(t)][0]];
    EXPECT_LT(length(made - normalized(sum)), 1e-12) << t;  // 1000 roundings of a sum
  }
  const auto large = obj(spike(300000));  // 9e10 steps in a plain loop, which are minutes
  ASSERT_TRUE(large.ok());
  EXPECT_EQ(large->triangles.size(), 300000u);
}

TEST_F(MeshFiles, OffPlyAndStlAreOnePartNamedForTheFile) {
  const std::string off = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  const std::string stl =
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
  for (const auto& [name, text] : {std::pair{"panel.off", off}, {"panel.ply", ply}, {"panel.stl", stl}}) {
    const auto mesh = read_mesh(file(name, text));
    ASSERT_TRUE(mesh.ok()) << name << ": " << mesh.error().message;
    EXPECT_EQ(mesh->parts.size(), 1u) << name;
    EXPECT_EQ(mesh->parts[0].name, "panel") << name;
    EXPECT_EQ(mesh->triangles.size(), 2u) << name;
    EXPECT_NEAR(area(*mesh), 1, 1e-15) << name;
    for (const Vec3& n : mesh->normals) EXPECT_EQ(n, (Vec3{0, 0, 1})) << name;
    EXPECT_THAT(mesh->remarks, testing::IsEmpty()) << name;
  }
}

// A square whose normals lean, as those of a round surface do; made ones stand upright. Reading was once without them.
TEST_F(MeshFiles, NormalsOfOffAndPlyAreTheFiles) {
  const std::string off = "NOFF\n4 1 0\n0 0 0 3 0 4\n1 0 0 3 0 4\n1 1 0 0 0 2\n0 1 0 0 0 0\n4 0 1 2 3\n";
  const std::string head =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
      "property float nz\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string ply =
      "ply\nformat ascii 1.0\n" + head + faces + "0 0 0 3 0 4\n1 0 0 3 0 4\n1 1 0 0 0 2\n0 1 0 0 0 0\n4 0 1 2 3\n";
  std::string binary = "ply\r\nformat binary_big_endian 1.0\r\n" + head + faces;
  const auto add = [&](std::uint32_t bits) {
    for (int shift = 24; shift >= 0; shift -= 8) binary += static_cast<char>(bits >> shift & 255);
  };
  for (const auto& vertex :
       {std::array{0.F, 0.F, 0.F, 3.F, 0.F, 4.F}, {1, 0, 0, 3, 0, 4}, {1, 1, 0, 0, 0, 2}, {0, 1, 0, 0, 0, 0}})
    for (const float value : vertex) add(std::bit_cast<std::uint32_t>(value));
  binary += '\4';
  for (const std::uint32_t index : {0U, 1U, 2U, 3U}) add(index);
  for (const auto& [name, text] : {std::pair{"t.off", off}, {"t.ply", ply}, {"b.ply", binary}}) {
    const auto mesh = read_mesh(file(name, text));
    ASSERT_TRUE(mesh.ok()) << name << ": " << mesh.error().message;
    ASSERT_EQ(mesh->positions.size(), 4U) << name;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 wanted = mesh->positions[i].y == 0 ? Vec3{.6, 0, .8} : Vec3{0, 0, 1};
      EXPECT_LT(length(mesh->normals[i] - wanted), 1e-7) << name << ' ' << i;
    }
    EXPECT_EQ(mesh->repairs.normals_made, 1U) << name << ": a normal without length is no normal";
  }
  std::string textured = ply;
  textured.replace(textured.find("nx"), 2, "s ");
  EXPECT_THAT(read_mesh(file("s.ply", textured))->remarks,
              testing::ElementsAre(HasSubstr("texture coordinates of PLY are not read")));
}

// A small triangle at the coordinates of a surveyor. Where numbers are stored as doubles, or written out, its corners
// are as far apart as at the origin, to 1e-6 of its size; floats lie .5 apart there.
TEST_F(MeshFiles, CornersFarFromTheOriginKeepTheirPlaces) {
  const std::string a = "500000.125 1.25 5400000.25\n", b = "500000.875 1.25 5400000.25\n",
                    c = "500000.125 1.25 5400000.625\n";
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double "
      "z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const double value : {500000.125, 1.25, 5400000.25, 500000.875, 1.25, 5400000.25, 500000.125, 1.25, 5400000.625})
    binary.append(reinterpret_cast<const char*>(&value), sizeof value);
  binary += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  const std::pair<const char*, std::string> files[] = {
      {"far.obj", "v " + a + "v " + b + "v " + c + "f 1 2 3\n"},
      {"far.off", "OFF\n3 1 0\n" + a + b + c + "3 0 1 2\n"},
      {"ascii.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nelement face "
       "1\nproperty list uchar int vertex_indices\nend_header\n" +
           a + b + c + "3 0 1 2\n"},
      {"binary.ply", binary},
      {"far.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex " + a + "vertex " + b + "vertex " + c +
                      "endloop\nendfacet\nendsolid s\n"}};
  for (const auto& [name, content] : files) {
    const auto mesh = read_mesh(file(name, content));
    ASSERT_TRUE(mesh.ok()) << name << ": " << mesh.error().message;
    const Box box = bounding_box(*mesh);
    EXPECT_NEAR(box.high.x - box.low.x, .75, 1e-6) << name;
    EXPECT_NEAR(box.high.z - box.low.z, .375, 1e-6) << name;
    EXPECT_NEAR(area(*mesh), .75 * .375 / 2, 1e-6) << name;
    EXPECT_EQ(float_origin(box), 0.5 * (box.low + box.high)) << name;
  }
  EXPECT_EQ(float_origin({{-1, 0, 2}, {1, 1, 4}}), (Vec3{})) << "a mesh near the origin stays where it is";
}

// The content of a pipe gives its format, since its name has no ending.
TEST_F(MeshFiles, ContentTellsTheFormatWhereTheNameHasNoEnding) {
  const std::string corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  std::string binary(80, ' ');
  binary.replace(0, 5, "solid");
  binary += std::string("\1\0\0\0", 4);
  const float facet[] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0};
  binary.append(reinterpret_cast<const char*>(facet), sizeof facet).append(2, '\0');
  const std::vector<std::pair<std::string, double>> contents = {
      // and the area of each
      {"OFF\n4 1 0\n" + corners + "4 0 1 2 3\n", 1},
      {"# made\n\nOFF\n4 1 0\n" + corners + "4 0 1 2 3\n", 1},
      {"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
       "property list uchar int vertex_indices\nend_header\n" +
           corners + "4 0 1 2 3\n",
       1},
      {"solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid "
       "s\n",
       0.5},
      {binary, 0.5},
      {"# OFF\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", 0.5}};
  for (const auto& [content, expected] : contents) {
    const auto plain = read_mesh(file("hood", content));
    ASSERT_TRUE(plain.ok()) << content << plain.error().message;
    EXPECT_NEAR(area(*plain), expected, 1e-15) << content;
    EXPECT_EQ(plain->parts[0].name, "hood");
    const std::string fifo = folder_.path("fifo");
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    std::thread writer([&, text = content] { std::ofstream(fifo, std::ios::binary) << text; });
    const auto piped = read_mesh(fifo);
    writer.join();
    std::remove(fifo.c_str());
    ASSERT_TRUE(piped.ok()) << content << piped.error().message;
    EXPECT_EQ(piped->positions, plain->positions) << content;
    EXPECT_EQ(piped->parts[0].name, "mesh");
  }
  EXPECT_THAT(read_mesh(file("none", "nothing\n")).error().message, HasSubstr("holds no faces"));
  EXPECT_THAT(read_mesh("").error().message, HasSubstr("is empty"));
}

TEST_F(MeshFiles, TextureCoordinatesAreKept) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0 0\nvt 1 0.5\nvt 0\n";
  const auto mesh = read_mesh(file("uv.obj", text + "f 1/1 2/2 3/3\nf 1/4 3/3 4\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  ASSERT_EQ(mesh->texture.size(), mesh->positions.size());
  EXPECT_EQ(mesh->positions.size(), 5u);  // the first position has two texture coordinates
  EXPECT_EQ(mesh->texture[mesh->triangles[0][2]], (std::array<float, 2>{1, 0.5F}));
  EXPECT_EQ(mesh->texture[mesh->triangles[1][2]], (std::array<float, 2>{0, 0}));
  EXPECT_TRUE(read_mesh(file("none.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\n"))->texture.empty());
  const auto past = read_mesh(file("past.obj", text + "f 1/1 2/2 3/5\n"));
  ASSERT_FALSE(past.ok());
  EXPECT_NE(past.error().message.find("texture 5"), std::string::npos) << past.error().message;
  const auto comma = read_mesh(file("comma.obj", "vt 0,5 1\n" + text));
  ASSERT_FALSE(comma.ok());
  EXPECT_NE(comma.error().message.find("comma.obj:1: texture coordinate 1 is \"0,5\""), std::string::npos);
}

TEST_F(MeshFiles, ReadsAVehicleRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (data == nullptr) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const auto mesh = read_mesh(std::string(data) + "/mesh/vehicle.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_GT(mesh->triangles.size(), 48000u);
  EXPECT_EQ(mesh->repairs.normals_made, 0);
  EXPECT_TRUE(std::any_of(mesh->parts.begin(), mesh->parts.end(),
                          [](const MeshPart& p) { return p.name == "Body" && p.material == "Paint_Red"; }));
}

// The library is ended by a signal on the first of these files, and takes 2.4 GB for the second, which has 50 bytes.
TEST_F(MeshFiles, HardCase_LibraryCrashADamagedFileIsAnError) {
  const std::string ply =
      file("a.ply", "ply\nformat ascii 1.0\nproperty float x\nelement vertex 3\nend_header\n0 0 0\n1 0 0\n0 1 0\n");
#if defined(__SANITIZE_ADDRESS__)  // which ends it with a status of its own
  EXPECT_THAT(read_mesh(ply).error().message, HasSubstr("a.ply: the library that reads it ended with status"));
#else
  EXPECT_THAT(read_mesh(ply).error().message, HasSubstr("a.ply: the library that reads it crashed on it"));
#endif
  for (const auto& [name, content] : std::map<std::string, std::string>{
           {"b.off", "OFF\n100000000 100000000 0\n0 0 0\n1 0 0\n0 1 0\n"},
           {"c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n"},
           {"d.ply",
            "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
            "property float z\nend_header\n0 0 0\n"},
           {"e.stl", std::string(80, ' ') + "\xff\xff\xff\x7f" + std::string(50, '\0')}}) {
    const auto mesh = read_mesh(file(name, content));
    ASSERT_FALSE(mesh.ok()) << name;
    EXPECT_THAT(mesh.error().message, HasSubstr(name + ": "));
  }
  EXPECT_LT(peak_rss_mb(), 400);
}

}  // namespace
}  // namespace goniochrome::mesh::mesh_test
