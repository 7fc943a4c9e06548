// glTF and GLB files made here, part by part.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "base/encode.h"
#include "base/scratch_for_test.h"
#include "mesh/mesh.h"

namespace goniochrome::mesh::gltf_test {
namespace {

using testing::HasSubstr;

std::string floats(std::initializer_list<float> values) {
  std::string bytes;
  for (const float value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  return bytes;
}

// A unit right triangle in the plane z = 0 with normals +z, then the indices 0 1 2.
std::string triangle_bytes() {
  return floats({0, 0, 0, 1, 0, 0, 0, 1, 0}) + floats({0, 0, 1, 0, 0, 1, 0, 0, 1}) + std::string("\0\0\1\0\2\0", 6);
}

std::string document(const std::string& nodes, const std::string& roots, const std::string& more = "",
                     const std::string& primitive = "", const std::string& uri = "") {
  const std::string data = uri.empty() ? "data:application/octet-stream;base64," + base64(triangle_bytes()) : uri;
  const std::string attributes =
      R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"material":0)" + primitive + "}";
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
         R"(],"materials":[{"name":"Red"},{"name":"Glass"}],"meshes":[{"name":"tri","primitives":[)" + attributes +
         R"(]},{"name":"two","primitives":[)" + attributes +
         R"(,{"attributes":{"POSITION":0},"material":1}]},{"primitives":[{"attributes":{"POSITION":0},"material":1}]},)"
         R"({"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":78,"uri":")" +
         data +
         R"("}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},{"buffer":0,)"
         R"("byteOffset":72,"byteLength":6}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},)"
         R"({"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}])" +
         more + "}";
}

class GltfFiles : public testing::Test {
 protected:
  Result<Mesh> read(const std::string& content, const std::string& name = "t.gltf") const {
    return read_mesh(folder_.file(name, content));
  }
  std::string error(const std::string& content) const {
    const auto mesh = read(content);
    return mesh.ok() ? "no error" : mesh.error().message;
  }
  ScratchFolder folder_;
};

Vec3 normal_of(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return normalized(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
}

TEST_F(GltfFiles, NodesPlaceTheirMeshesAndInstancesAreParts) {
  const auto mesh = read(document(R"({"name":"car","translation":[10,0,0],"children":[1,2]},)"
                                  R"({"name":"left","mesh":0,"scale":[2,2,2]},)"
                                  R"({"name":"right","mesh":0,"rotation":[0,0,0.7071067811865476,0.7071067811865476]})",
                                  "0"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  ASSERT_EQ(mesh->parts.size(), 2U);
  EXPECT_EQ(mesh->parts[0].name, "left");
  EXPECT_EQ(mesh->parts[0].material, "Red");
  EXPECT_EQ(mesh->parts[1].name, "right");
  const Box box = bounding_box(*mesh);
  EXPECT_NEAR(box.low.x, 9, 1e-6);  // turned by 90 degrees about z, the triangle reaches to x = -1
  EXPECT_NEAR(box.high.x, 12, 1e-6);
  EXPECT_NEAR(box.high.y, 2, 1e-6);
  EXPECT_EQ(mesh->repairs.normals_made, 0);
}

TEST_F(GltfFiles, MirrorImagesKeepTheirOutside) {
  for (const std::string& primitive : {std::string(), std::string(R"(,"mode":4)")}) {
    const auto mesh = read(document(R"({"mesh":0,"scale":[-1,1,1]})", "0", "", primitive));
    ASSERT_TRUE(mesh.ok());
    EXPECT_NEAR(mesh->normals[0].z, 1, 1e-6);
    EXPECT_NEAR(normal_of(*mesh, 0).z, 1, 1e-6);
    EXPECT_EQ(mesh->repairs.triangles_turned, 0);
  }
}

// A plane at 45 degrees that is stretched along x leans less; a normal that is turned like a vector would be wrong.
TEST_F(GltfFiles, NormalsStandUprightOnStretchedSurfaces) {
  const auto mesh = read(document(R"({"scale":[4,1,1],"children":[1]},)"
                                  R"({"mesh":0,"rotation":[0,0.3826834323650898,0,0.9238795325112867]})",
                                  "0"));
  ASSERT_TRUE(mesh.ok());
  EXPECT_NEAR(dot(mesh->normals[0], normal_of(*mesh, 0)), 1, 1e-6);
  const Vec3 as_vector = normalized({4 * std::sqrt(0.5), 0, std::sqrt(0.5)});
  EXPECT_LT(dot(as_vector, normal_of(*mesh, 0)), 0.9);
}

TEST_F(GltfFiles, AMeshInSeveralMaterialsIsSeveralParts) {
  const auto mesh = read(document(R"({"name":"door","mesh":1})", "0"));
  ASSERT_TRUE(mesh.ok());
  ASSERT_EQ(mesh->parts.size(), 2U);
  EXPECT_EQ(mesh->parts[0].name, "door.Red");
  EXPECT_EQ(mesh->parts[1].name, "door.Glass");
  EXPECT_EQ(mesh->parts[1].material, "Glass");
  EXPECT_EQ(mesh->repairs.normals_made, 3);  // of the one without normals
}

TEST_F(GltfFiles, NodesOfOneNameAreOnePartForEachMaterial) {
  const std::string node = R"({"name":"lid","mesh":0})";
  const std::string other = R"({"name":"lid","mesh":2})";
  const auto mesh = read(document(node + "," + other + "," + node + "," + R"({"name":"lid","mesh":3})", "0,1,2,3"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  ASSERT_EQ(mesh->parts.size(), 3U);
  EXPECT_EQ(mesh->parts[0].name, "lid");
  EXPECT_EQ(mesh->parts[0].material, "Red");
  EXPECT_EQ(mesh->parts[1].name, "lid.Glass");
  EXPECT_EQ(mesh->parts[1].material, "Glass");
  EXPECT_EQ(mesh->parts[2].name, "lid.plain");
  EXPECT_EQ(mesh->parts[2].material, "");
  EXPECT_EQ(mesh->triangles.size(), 4U);
}

TEST_F(GltfFiles, BinaryFilesAndFilesBesideAreTheSame) {
  const std::string bytes = triangle_bytes();
  const auto named = [&] {
    folder_.file("a b.bin", bytes);
    return read(document(R"({"mesh":0})", "0", "", "", "a%20b.bin"));
  }();
  ASSERT_TRUE(named.ok()) << named.error().message;
  std::string text = document(R"({"mesh":0})", "0", "", "", "X");
  text.replace(text.find(R"(,"uri":"X")"), 10, "");
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t n) {
    const auto value = static_cast<std::uint32_t>(n);
    return std::string(reinterpret_cast<const char*>(&value), 4);
  };
  const std::string chunks = word(text.size()) + "JSON" + text + word(80) + std::string("BIN\0", 4) + bytes + "\0\0";
  const auto binary = read("glTF" + word(2) + word(12 + chunks.size() + 2) + chunks + std::string(2, '\0'), "t.glb");
  ASSERT_TRUE(binary.ok()) << binary.error().message;
  ASSERT_EQ(binary->positions.size(), named->positions.size());
  for (std::size_t i = 0; i < binary->positions.size(); ++i) {
    EXPECT_EQ(binary->positions[i].x, named->positions[i].x);
    EXPECT_EQ(binary->normals[i].z, named->normals[i].z);
  }
}

TEST_F(GltfFiles, BadFilesAreOneErrorThatNamesTheElement) {
  const std::string node = R"({"mesh":0})";
  EXPECT_THAT(error("{"), HasSubstr("is no whole glTF 2.0 file"));
  EXPECT_THAT(error(R"({"asset":{"version":"1.0"}})"), HasSubstr("glTF of version \"1.0\""));
  EXPECT_THAT(error(R"({"asset":{"version":"2.0"}})"), HasSubstr("there is no scene"));
  EXPECT_THAT(error(document(node, "7")), HasSubstr("node 7: there is no such node"));
  EXPECT_THAT(error(document(R"({"mesh":0,"children":[0]})", "0")), HasSubstr("stands below two nodes"));
  EXPECT_THAT(error(document(node, "0,0")), HasSubstr("stands below two nodes"));
  EXPECT_THAT(error(document(R"({"mesh":9})", "0")), HasSubstr("there is no mesh 9"));
  EXPECT_THAT(error(document(R"({"mesh":0,"rotation":[0,0,0,0]})", "0")), HasSubstr("no quaternion"));
  EXPECT_THAT(error(document(R"({"mesh":0,"scale":[1,1]})", "0")), HasSubstr("no list of finite numbers"));
  EXPECT_THAT(error(document(node, "0", R"(,"extensionsRequired":["KHR_draco_mesh_compression"])")),
              HasSubstr("compressed by Draco"));
  EXPECT_THAT(error(document(node, "0", "", R"(,"extensions":{"KHR_draco_mesh_compression":{}})")),
              HasSubstr("compressed by Draco"));
  EXPECT_THAT(error(document(node, "0", R"(,"extensionsRequired":["VENDOR_x"])")), HasSubstr("\"VENDOR_x\""));
  EXPECT_THAT(error(document(node, "0", "", "", "/etc/hostname")), HasSubstr("cannot be read"));
  EXPECT_THAT(error(document(node, "0", "", "", "gone.bin")), HasSubstr("gone.bin"));
  EXPECT_THAT(error(document(node, "0", "", "", "data:application/octet-stream;base64,AAAA")),
              HasSubstr("Failed to decode 'uri'"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = document(node, "0");
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    return text.replace(at, from.size(), to);
  };
  EXPECT_THAT(error(with(R"("count":3,"type":"VEC3")", R"("count":4,"type":"VEC3")")), HasSubstr("too few bytes"));
  EXPECT_THAT(error(with(R"("count":3,"type":"VEC3")", R"("count":99999999999,"type":"VEC3")")), HasSubstr("POSITION"));
  EXPECT_THAT(error(with(R"("count":3,"type":"VEC3")", R"("count":2,"type":"VEC3")")), HasSubstr("different counts"));
  EXPECT_THAT(error(with(R"("componentType":5123)", R"("componentType":5126)")), HasSubstr("do not fit"));
  EXPECT_THAT(error(with(R"("attributes":{"POSITION":0,)", R"("attributes":{)")), HasSubstr("has no POSITION"));
}

std::string with_sparse(const std::string& index) {
  // The third point of the triangle is put at (0, 5, 0), by the bytes behind the indices.
  const std::string bytes = triangle_bytes() + std::string(2, 0) + index + floats({0, 5, 0});
  std::string text = document(R"({"mesh":0})", "0", "", "", "data:application/octet-stream;base64," + base64(bytes));
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put(R"("byteLength":78)", R"("byteLength":96)");
  put(R"("byteOffset":72,"byteLength":6})",
      R"("byteOffset":72,"byteLength":6},{"buffer":0,"byteOffset":80,"byteLength":4},{"buffer":0,"byteOffset":84,"byteLength":12})");
  put(R"("count":3,"type":"VEC3"})",
      R"("count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":3,"componentType":5125},"values":{"bufferView":4}}})");
  return text;
}

TEST_F(GltfFiles, SparseNumbersTakeThePlaceOfOthers) {
  const auto mesh = read(with_sparse(std::string("\2\0\0\0", 4)));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_NEAR(bounding_box(*mesh).high.y, 5, 1e-6);
  EXPECT_THAT(error(with_sparse(std::string("\3\0\0\0", 4))), HasSubstr("index beyond its count"));
}

TEST_F(GltfFiles, NumbersThatAreNotFiniteAndIndicesBeyondTheVerticesAreRefused) {
  const auto with = [&](const std::string& bytes) {
    return document(R"({"mesh":0})", "0", "", "", "data:application/octet-stream;base64," + base64(bytes));
  };
  std::string bytes = triangle_bytes();
  bytes[74] = '\3';
  EXPECT_THAT(error(with(bytes)), HasSubstr("index 3 is beyond its 3 vertices"));
  bytes = triangle_bytes();
  const float not_a_number = std::nanf("");
  std::memcpy(bytes.data() + 16, &not_a_number, 4);
  EXPECT_THAT(error(with(bytes)), HasSubstr("is not finite"));
  EXPECT_THAT(error(document(R"({"mesh":0,"scale":[1e308,1e308,1]})", "0", "", "",
                             "data:application/octet-stream;base64," +
                                 base64(floats({9, 9, 9, 1, 9, 0, 0, 1, 0}) + triangle_bytes().substr(36)))),
              HasSubstr("not at a finite place"));
}

TEST_F(GltfFiles, InstancesByExtensionAreRefusedByName) {
  EXPECT_THAT(error(document(R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{}}})", "0")),
              HasSubstr("EXT_mesh_gpu_instancing"));
}

// A file of few bytes that places a mesh again and again, which would take all memory.
TEST_F(GltfFiles, HardCase_MeshInstancesAreBounded) {
  std::string nodes, roots;
  for (int i = 0; i < 20000; ++i) {
    nodes += (i ? "," : "") + std::string(R"({"mesh":0})");
    roots += (i ? "," : "") + std::to_string(i);
  }
  std::string text = document(nodes, roots);
  std::string many;
  for (int i = 0; i < 4000; ++i) many += std::string("\0\0\1\0\2\0", 6);
  // 20,000 nodes of 4000 triangles each.
  const std::string before = R"({"buffer":0,"byteOffset":72,"byteLength":6}])";
  text.replace(text.find(before), before.size(), R"({"buffer":1,"byteLength":24000}])");
  text.replace(text.find(R"("componentType":5123,"count":3)"), 30, R"("componentType":5123,"count":12000)");
  text.replace(text.find(R"(],"bufferViews")"), 0,
               R"(,{"byteLength":24000,"uri":"data:application/octet-stream;base64,)" + base64(many) + "\"}");
  EXPECT_THAT(error(text), HasSubstr("corners, instances counted"));
}

}  // namespace
}  // namespace goniochrome::mesh::gltf_test
