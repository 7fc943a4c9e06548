#include "mesh/internal/gltf_packed.h"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <cstdint>
#include <cstring>

#include "base/json.h"

namespace goniochrome::mesh {

namespace {

constexpr std::size_t kGlbHead = 12, kChunkHead = 8;

std::size_t word_at(std::string_view content, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, content.data() + at, sizeof word);
  return word;
}

std::string word(std::size_t value) {
  const auto number = static_cast<std::uint32_t>(value);
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

// True if a buffer says that its bytes are those which an extension unpacks.
bool is_fallback(const Json& buffer) {
  if (!buffer.is_object() || buffer.contains("uri") || !buffer.contains("extensions")) return false;
  const Json& extensions = buffer["extensions"];
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (extensions.is_object() && extensions.contains(name)) return true;
  return false;
}

// Gives the indices of primitives that Draco packs a view, which the library wants to see and nothing reads. Returns
// true where one had none.
bool gave_views_to_packed_indices(Json& document) {
  const auto list_of = [](Json& of, const char* name) -> Json::array_t* {
    return of.is_object() && of.contains(name) ? of[name].get_ptr<Json::array_t*>() : nullptr;
  };
  Json::array_t *meshes = list_of(document, "meshes"), *accessors = list_of(document, "accessors");
  if (meshes == nullptr || accessors == nullptr) return false;
  bool gave = false;
  for (Json& mesh : *meshes) {
    Json::array_t* primitives = list_of(mesh, "primitives");
    if (primitives == nullptr) continue;
    for (Json& primitive : *primitives) {
      if (!primitive.is_object() || !primitive.contains("extensions") || !primitive["extensions"].is_object() ||
          !primitive["extensions"].contains(kDraco) || !primitive.contains("indices") ||
          !primitive["indices"].is_number_unsigned())
        continue;
      const auto index = primitive["indices"].get<std::size_t>();
      if (index >= accessors->size() || !(*accessors)[index].is_object() || (*accessors)[index].contains("bufferView"))
        continue;
      (*accessors)[index]["bufferView"] = 0;
      gave = true;
    }
  }
  return gave;
}

}  // namespace

std::optional<std::string> acceptable_to_library(std::string_view content) {
  if (content.find("_meshopt_compression") == std::string_view::npos && content.find(kDraco) == std::string_view::npos)
    return std::nullopt;
  const bool binary = content.starts_with("glTF");
  std::string_view text = content, rest;
  if (binary) {
    constexpr std::size_t kText = kGlbHead + kChunkHead;
    if (content.size() < kText || word_at(content, kGlbHead) > content.size() - kText) return std::nullopt;
    text = content.substr(kText, word_at(content, kGlbHead));
    rest = content.substr(kText + text.size());
  }
  Json json = parse_json(text);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return std::nullopt;
  bool changed = gave_views_to_packed_indices(json);
  for (Json& buffer : json["buffers"])
    if (is_fallback(buffer)) {
      buffer["byteLength"] = 1, buffer["uri"] = "data:application/octet-stream;base64,AA==";
      changed = true;
    }
  if (!changed) return std::nullopt;
  std::string made = json_text(json);
  if (!binary) return made;
  made.resize((made.size() + 3) / 4 * 4, ' ');
  return std::string(content.substr(0, 8)) + word(kGlbHead + kChunkHead + made.size() + rest.size()) +
         word(made.size()) + std::string(content.substr(kGlbHead + 4, 4)) + made + std::string(rest);
}

std::optional<std::string> meshopt_unpacked(const MeshoptView& view) {
  // A group of vertices that are all equal packs best, to 1/64 of its bytes; a tail holds a vertex as it is.
  constexpr std::size_t kMostTimes = 80, kFree = 1 << 16, kMostStride = 256;
  if (view.stride == 0 || view.stride > kMostStride ||
      view.count > (kMostTimes * view.packed.size() + kFree) / view.stride)
    return std::nullopt;
  std::string bytes(view.count * view.stride, '\0');
  const auto* packed = reinterpret_cast<const unsigned char*>(view.packed.data());
  const std::size_t size = view.packed.size();
  const bool is_index = view.stride == 2 || view.stride == 4;
  int failed = 1;
  if (view.mode == "ATTRIBUTES" && view.stride % 4 == 0)
    failed = meshopt_decodeVertexBuffer(bytes.data(), view.count, view.stride, packed, size);
  else if (view.mode == "TRIANGLES" && is_index && view.count % 3 == 0)
    failed = meshopt_decodeIndexBuffer(bytes.data(), view.count, view.stride, packed, size);
  else if (view.mode == "INDICES" && is_index)
    failed = meshopt_decodeIndexSequence(bytes.data(), view.count, view.stride, packed, size);
  if (failed != 0) return std::nullopt;
  if (view.filter.empty() || view.filter == "NONE") return bytes;
  if (view.mode != "ATTRIBUTES") return std::nullopt;
  if (view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8))
    meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
  else if (view.filter == "QUATERNION" && view.stride == 8)
    meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
  else if (view.filter == "EXPONENTIAL")
    meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
  else
    return std::nullopt;
  return bytes;
}

std::optional<DracoMesh> draco_unpacked(std::string_view packed, std::vector<DracoMesh::Attribute>& attributes,
                                        std::size_t most) {
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return std::nullopt;
  const draco::Mesh& mesh = *decoded.value();
  if (mesh.num_points() > most || mesh.num_faces() > most / 3) return std::nullopt;
  DracoMesh result;
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
    for (const draco::PointIndex& corner : mesh.face(face)) result.indices.push_back(corner.value());
  for (DracoMesh::Attribute& attribute : attributes) {
    const draco::PointAttribute* of = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(attribute.id));
    if (attribute.id < 0 || of == nullptr) return std::nullopt;
    attribute.values.resize(attribute.wide * mesh.num_points());
    double* to = attribute.values.data();
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point, to += attribute.wide)
      if (!of->ConvertValue(of->mapped_index(point), static_cast<std::int8_t>(attribute.wide), to)) return std::nullopt;
  }
  return result;
}

}  // namespace goniochrome::mesh
