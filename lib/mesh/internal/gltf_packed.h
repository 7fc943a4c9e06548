// Parts of glTF files that meshoptimizer or Draco packed, unpacked. Neither library is trusted: call them in a child
// process.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace goniochrome::mesh {

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr std::array kMeshopt = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

// A glTF text or GLB file in which each buffer without bytes of its own, which stands for what meshoptimizer packed, is
// a buffer of one byte, and in which indices that Draco packs have a view: tinygltf refuses others. Nothing where there
// is neither, or the text is no JSON.
std::optional<std::string> acceptable_to_library(std::string_view content);

// A bufferView that is packed by meshoptimizer (EXT_meshopt_compression).
struct MeshoptView {
  std::string_view packed;
  std::size_t count = 0, stride = 0;
  std::string mode, filter;
};
// Its count x stride bytes; nothing where they cannot be unpacked.
std::optional<std::string> meshopt_unpacked(const MeshoptView& view);

// The triangles of a primitive that is packed by Draco (KHR_draco_mesh_compression), and the numbers of its vertices.
struct DracoMesh {
  std::vector<double> indices;
  struct Attribute {
    int id = 0;            // unique in the packed mesh
    std::size_t wide = 3;  // numbers of a vertex
    std::vector<double> values = {};
  };
};
// Fills the values of the attributes. Nothing where they cannot be unpacked; there may be `most` vertices and corners.
std::optional<DracoMesh> draco_unpacked(std::string_view packed, std::vector<DracoMesh::Attribute>& attributes,
                                        std::size_t most);

}  // namespace goniochrome::mesh
