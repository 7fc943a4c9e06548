// glTF and GLB files made here, part by part.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>

#include "base/encode.h"
#include "base/scratch_for_test.h"
#include "mesh/mesh.h"
#include "mesh/unit.h"

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
  EXPECT_THAT(error(document(node, "0", "", R"(,"extensions":{"KHR_draco_mesh_compression":{}})")),
              HasSubstr("mesh 0, primitive 0: what it packs by Draco cannot be unpacked"));
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

// A scene of 80 meters was taken for inches by its size.
TEST_F(GltfFiles, LengthsAreMetersWhateverTheSize) {
  const auto mesh = read(document(R"({"mesh":0,"scale":[80,80,80]})", "0"));
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(likely_unit(bounding_box(*mesh)).meters, 0.0254) << "control";
  EXPECT_EQ(length_unit(*mesh).meters, 1);
}

TEST_F(GltfFiles, HiddenNodesAndThoseBelowThemAreNotDrawn) {
  const std::string hidden = R"(,"extensions":{"KHR_node_visibility":{"visible":false}})",
                    visible = R"(,"extensions":{"KHR_node_visibility":{"visible":true}})";
  const auto nodes = [](const std::string& first, const std::string& second) {
    return R"({"name":"up","children":[1])" + first + R"(},{"name":"below","mesh":0)" + second +
           R"(},{"name":"beside","mesh":0})";
  };
  const auto parts = [&](const std::string& first, const std::string& second) {
    const auto mesh = read(document(nodes(first, second), "0,2", R"(,"extensionsRequired":["KHR_node_visibility"])"));
    EXPECT_TRUE(mesh.ok()) << mesh.error().message;
    return mesh->parts.size();
  };
  EXPECT_EQ(parts("", ""), 2U) << "control";
  EXPECT_EQ(parts(visible, ""), 2U);
  EXPECT_EQ(parts(hidden, ""), 1U);
  EXPECT_EQ(parts("", hidden), 1U);
  EXPECT_EQ(parts(hidden, visible), 1U) << "a hidden node hides those below it";
  EXPECT_THAT(error(document(R"({"mesh":0)" + hidden + "}", "0")), HasSubstr("KHR_node_visibility hides all"));
}

TEST_F(GltfFiles, WhatIsNotKnownOfAMeshIsRemarkedOnce) {
  const auto remarks = [&](const std::string& nodes, const std::string& roots) {
    const auto mesh = read(document(nodes, roots));
    EXPECT_TRUE(mesh.ok()) << mesh.error().message;
    return mesh->remarks;
  };
  const std::string strange = R"({"mesh":0,"extensions":{"VENDOR_bend":{}}})";
  EXPECT_THAT(remarks(strange + "," + strange, "0,1"),
              testing::ElementsAre(HasSubstr("node 0 has the extension VENDOR_bend")));
  EXPECT_THAT(remarks(R"({"mesh":0,"weights":[0.5]})", "0"), testing::ElementsAre(HasSubstr("morph targets")));
  EXPECT_THAT(remarks(R"({"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}}})", "0"), testing::IsEmpty());
}

TEST_F(GltfFiles, MaterialsThatAreClearOrOfPolishedMetalAreKnown) {
  const auto look = [&](const std::string& material) {
    std::string text = document(R"({"mesh":0})", "0");
    const std::string red = R"({"name":"Red"})";
    text.replace(text.find(red), red.size(), R"({"name":"Red",)" + material + "}");
    const auto mesh = read(text);
    EXPECT_TRUE(mesh.ok()) << mesh.error().message;
    return mesh->parts.front().look;
  };
  EXPECT_EQ(look(R"("extensions":{"KHR_materials_transmission":{"transmissionFactor":0.9}})"), Look::kClear);
  EXPECT_EQ(look(R"("alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]})"), Look::kClear);
  EXPECT_EQ(look(R"("pbrMetallicRoughness":{"metallicFactor":1,"roughnessFactor":0.1})"), Look::kPolishedMetal);
  // A metallic paint has a clear coat; a material that says nothing is rough; an alpha without BLEND means nothing.
  EXPECT_EQ(look(R"("pbrMetallicRoughness":{"metallicFactor":1,"roughnessFactor":0.1},)"
                 R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1}})"),
            Look::kUnknown);
  EXPECT_EQ(look(R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]})"), Look::kUnknown);
}

TEST_F(GltfFiles, ANodeFarAwayKeepsTheShapeOfItsMesh) {
  const auto mesh = read(document(R"({"mesh":0,"translation":[500000.3,0,5400000.7],"scale":[0.1,0.1,0.1]})", "0"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const Box box = bounding_box(*mesh);
  EXPECT_NEAR(box.high.x - box.low.x, .1, 1e-8);
  EXPECT_NEAR(box.high.y - box.low.y, .1, 1e-8);
}

// A file beside which `data` is the only buffer with bytes. The buffer of the views is a fallback without any.
std::string packed_document(const std::string& data, const std::string& extension, const std::string& views,
                            const std::string& primitive, const std::string& accessors) {
  return R"({"asset":{"version":"2.0"},"extensionsRequired":[")" + extension +
         R"("],"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[)" + primitive +
         R"(]}],"buffers":[{"byteLength":)" + std::to_string(data.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64(data) +
         R"("},{"byteLength":999,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}],"bufferViews":[)" +
         views + R"(],"accessors":[)" + accessors + "]}";
}

// A grid of 9 x 9 points in the plane z = 0, of which each square is two triangles.
struct Grid {
  std::vector<float> positions;
  std::vector<unsigned> indices;
};
Grid grid() {
  Grid made;
  for (unsigned y = 0; y < 9; ++y)
    for (unsigned x = 0; x < 9; ++x)
      made.positions.insert(made.positions.end(), {static_cast<float>(x) / 8, static_cast<float>(y) / 8, 0});
  for (unsigned y = 0; y < 8; ++y)
    for (unsigned x = 0; x < 8; ++x) {
      const unsigned i = 9 * y + x;
      made.indices.insert(made.indices.end(), {i, i + 1, i + 9, i + 1, i + 10, i + 9});
    }
  return made;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles)
    sum += length(cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i])) / 2;
  return sum;
}

// Current exporters write such files.
TEST_F(GltfFiles, WhatMeshoptimizerPacksIsUnpacked) {
  const Grid from = grid();
  std::vector<unsigned char> points(meshopt_encodeVertexBufferBound(81, 12));
  meshopt_encodeVertexVersion(0);
  points.resize(meshopt_encodeVertexBuffer(points.data(), points.size(), from.positions.data(), 81, 12));
  std::vector<unsigned char> corners(meshopt_encodeIndexBufferBound(from.indices.size(), 81));
  corners.resize(meshopt_encodeIndexBuffer(corners.data(), corners.size(), from.indices.data(), from.indices.size()));
  std::string data(points.begin(), points.end());
  data.append(corners.begin(), corners.end());
  const auto view = [](std::size_t offset, std::size_t size, int stride, std::size_t count, const char* mode) {
    return fmt::format(R"({{"buffer":1,"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,)"
                       R"("byteOffset":{},"byteLength":{},"byteStride":{},"count":{},"mode":"{}"}}}}}})",
                       static_cast<std::size_t>(stride) * count, offset, size, stride, count, mode);
  };
  const auto written = [&](const std::string& bytes, std::size_t count) {
    return packed_document(bytes, "EXT_meshopt_compression",
                           view(0, points.size(), 12, count, "ATTRIBUTES") + "," +
                               view(points.size(), corners.size(), 4, 384, "TRIANGLES"),
                           R"({"attributes":{"POSITION":0},"indices":1})",
                           R"({"bufferView":0,"componentType":5126,"count":81,"type":"VEC3"},)"
                           R"({"bufferView":1,"componentType":5125,"count":384,"type":"SCALAR"})");
  };
  const auto mesh = read(written(data, 81));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 128U);
  EXPECT_NEAR(area(*mesh), 1, 1e-12);
  // The text as a GLB file, whose first buffer is the chunk behind the text.
  std::string text = written(data, 81);
  const std::string uri = R"(,"uri":"data:application/octet-stream;base64,)" + base64(data) + "\"";
  text.erase(text.find(uri), uri.size());
  const auto padded = [](std::string bytes, char with) { return bytes.append((4 - bytes.size() % 4) % 4, with); };
  const auto word = [](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&number), sizeof number);
  };
  const std::string head = padded(text, ' '), body = padded(data, '\0');
  const std::string chunks = word(head.size()) + "JSON" + head + word(body.size()) + std::string("BIN\0", 4) + body;
  const auto binary = read("glTF" + word(2) + word(12 + chunks.size()) + chunks, "t.glb");
  ASSERT_TRUE(binary.ok()) << binary.error().message;
  EXPECT_EQ(binary->positions, mesh->positions);
  EXPECT_THAT(error(written(data.substr(1), 81)), HasSubstr("cannot be unpacked"));
  EXPECT_THAT(error(written(data, 99999999999)), HasSubstr("bufferView 0: what it packs by EXT_meshopt_compression"));
}

TEST_F(GltfFiles, WhatDracoPacksIsUnpacked) {
  const Grid from = grid();
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(from.indices.size() / 3));
  const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::size_t face = 0; face < from.indices.size() / 3; ++face) {
    const auto at = [&](std::size_t corner) { return &from.positions[3 * from.indices[3 * face + corner]]; };
    builder.SetAttributeValuesForFace(positions, draco::FaceIndex(static_cast<std::uint32_t>(face)), at(0), at(1),
                                      at(2));
  }
  const std::unique_ptr<draco::Mesh> packed = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*packed, &buffer).ok());
  const std::string data(buffer.data(), buffer.size());
  const auto written = [&](const std::string& bytes, int id) {
    return packed_document(
        bytes, "KHR_draco_mesh_compression", fmt::format(R"({{"buffer":0,"byteLength":{}}})", bytes.size()),
        fmt::format(R"({{"attributes":{{"POSITION":0}},"indices":1,"extensions":{{)"
                    R"("KHR_draco_mesh_compression":{{"bufferView":0,"attributes":{{"POSITION":{}}}}}}}}})",
                    id),
        R"({"componentType":5126,"count":81,"type":"VEC3"},)"
        R"({"componentType":5125,"count":384,"type":"SCALAR"})");
  };
  const int id = static_cast<int>(packed->attribute(positions)->unique_id());
  const auto mesh = read(written(data, id));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 128U);
  EXPECT_NEAR(area(*mesh), 1, 1e-3) << "14 bits";
  EXPECT_THAT(error(written(data.substr(0, data.size() / 2), id)), HasSubstr("cannot be unpacked"));
  EXPECT_THAT(error(written(data, 77)), HasSubstr("cannot be unpacked"));
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
