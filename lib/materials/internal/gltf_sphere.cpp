#include "materials/internal/gltf_sphere.h"

#include "base/angles.h"
#include "base/encode.h"
#include "materials/internal/one_lobe.h"

namespace goniochrome::materials {

namespace {

// A sphere of radius 1: positions, which are its normals too, and triangles, counterclockwise from outside.
struct Sphere {
  std::string positions, triangles;
  std::size_t points = 0, indices = 0;
};

Sphere sphere() {
  constexpr int kColumns = 64, kRows = 32;
  Sphere result;
  const auto put = [](std::string& bytes, auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (int j = 0; j <= kRows; ++j)
    for (int i = 0; i <= kColumns; ++i) {
      const Vec3 v = direction(kPi * j / kRows, 2 * kPi * (i % kColumns) / kColumns);
      for (const double x : {v.x, v.z, -v.y}) put(result.positions, static_cast<float>(x));
      ++result.points;
    }
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i) {
      const int a = j * (kColumns + 1) + i, b = a + kColumns + 1;
      // At the poles one of the two triangles of a cell has no area.
      if (j > 0)
        for (const int k : {a, b, a + 1}) put(result.triangles, static_cast<std::uint16_t>(k)), ++result.indices;
      if (j + 1 < kRows)
        for (const int k : {a + 1, b, b + 1}) put(result.triangles, static_cast<std::uint16_t>(k)), ++result.indices;
    }
  return result;
}

// The geometry, which is the same in every file.
const Json& sphere_json() {
  static const Json json = [] {
    const Sphere mesh = sphere();
    const std::size_t split = mesh.positions.size();
    Json part = {
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes",
         {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 0}}}, {"indices", 1}, {"material", 0}}}}}}}};
    part["accessors"] = Json::array();
    part["accessors"].push_back({{"bufferView", 0},
                                 {"componentType", 5126},
                                 {"count", mesh.points},
                                 {"type", "VEC3"},
                                 {"min", {-1, -1, -1}},
                                 {"max", {1, 1, 1}}});
    part["accessors"].push_back(
        {{"bufferView", 1}, {"componentType", 5123}, {"count", mesh.indices}, {"type", "SCALAR"}});
    part["bufferViews"] = Json::array();
    part["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", split}, {"target", 34962}});
    part["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", split}, {"byteLength", mesh.triangles.size()}, {"target", 34963}});
    part["buffers"] = Json::array();
    part["buffers"].push_back(
        {{"byteLength", split + mesh.triangles.size()},
         {"uri", "data:application/octet-stream;base64," + base64(mesh.positions + mesh.triangles)}});
    return part;
  }();
  return json;
}

}  // namespace

std::string gltf_sphere(const Json& material, const Naming& naming) {
  Json used = Json::array();
  for (const auto& extension : material.at("extensions").items()) used.push_back(extension.key());
  Json document = {{"asset", {{"version", "2.0"}, {"generator", naming.provenance}}}, {"extensionsUsed", used}};
  document["materials"] = Json::array({material});
  document.update(sphere_json());
  return json_text(document, 1) + "\n";
}

Json gltf_extras(const Naming& naming, const Shown& shown) {
  return {{"identifier", naming.identifier},
          {"de00_mean", rounded(shown.de00_mean)},
          {"de00_max", rounded(shown.de00_max)}};
}

}  // namespace goniochrome::materials
