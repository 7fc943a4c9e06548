// glTF 2.0 as JSON or GLB, read by tinygltf: the meshes of the scene's nodes, each where its node and the nodes above
// put it. Animations, skins, cameras, lights and pictures are passed over. The library checks
// few of the numbers that it reads, so it runs in a child process, as does what is made of them. Sections are those of
// the specification (Khronos, glTF 2.0, revision 2.0.1).
#define TINYGLTF_IMPLEMENTATION
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/child.h"
#include "base/file.h"
#include "base/text.h"
#include "mesh/internal/gltf_arrays.h"
#include "mesh/internal/gltf_packed.h"
#include "mesh/internal/polygons_bytes.h"

namespace goniochrome::mesh {

namespace {

using Matrix = std::array<double, 16>;  // column by column

constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
// A small file may place a mesh again and again. A triangle takes some 30 bytes of a file, so that a file of many bytes
// may place each mesh 80 times.
constexpr std::size_t kLeastRoom = std::size_t{1} << 20, kMostRoom = std::size_t{1} << 27, kRoomAByte = 8;
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kVisibility = "KHR_node_visibility";
// Extensions of nodes, meshes and primitives that change nothing of the surface. FB_ngon_encoding only says which
// triangles were one polygon, and the coarser meshes of MSFT_lod are nodes outside of the scene.
constexpr std::array kHarmless = {
    "KHR_node_selectability", "KHR_node_hoverability", "KHR_lights_punctual", "KHR_materials_variants",
    "KHR_mesh_quantization",  "FB_ngon_encoding",      "EXT_mesh_features",   "MSFT_lod",
    "KHR_xmp_json_ld"};

// Addresses for a file: the library's own; what its JSON takes, of which a node of 11 bytes takes 900, and what its
// meshes take where they are placed often; and buffers in files beside it, whose sizes are not known before it is read.
ChildLimits limits_for(std::size_t file_bytes, bool has_folder) {
  constexpr std::size_t kOwn = std::size_t{256} << 20, kArraysAByte = 640, kBeside = std::size_t{4} << 30;
  return {kOwn + kArraysAByte * file_bytes + (has_folder ? kBeside : 0), 60 + static_cast<int>(file_bytes >> 20)};
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k) result[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return result;
}

Vec3 column_of(const Matrix& m, std::size_t column) {
  return {m[4 * column], m[4 * column + 1], m[4 * column + 2]};
}

Vec3 placed(const Matrix& m, const Vec3& p) {
  return p.x * column_of(m, 0) + p.y * column_of(m, 1) + p.z * column_of(m, 2) + column_of(m, 3);
}

// Files beside the mesh are read by the project's own reader, and only from its folder: the library would look in the
// working folder as well.
bool is_beside(const std::string& path, void* folder) {
  const auto& name = *static_cast<const std::string*>(folder);
  return !name.empty() && path.starts_with(name + "/");
}
std::string as_it_is(const std::string& path, void*) {
  return path;
}
bool read_whole(std::vector<unsigned char>* bytes, std::string* error, const std::string& path, void*) {
  const auto content = file_content(path);
  if (!content.ok()) return *error += content.error().message, false;
  bytes->assign(content->begin(), content->end());
  return true;
}
bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}
// The library compares this with a limit of its own; read_whole() and the limits of the child process hold instead.
[[maybe_unused]] bool size_is_no_matter(std::size_t* bytes, std::string*, const std::string&, void*) {
  *bytes = 0;
  return true;
}
// Version 2.9 of the library also asks for the size of a file before it reads it, and takes no incomplete list.
template <class Callbacks>
Callbacks callbacks_for(std::string& folder) {
  Callbacks callbacks{};
  callbacks.FileExists = is_beside;
  callbacks.ExpandFilePath = as_it_is;
  callbacks.ReadWholeFile = read_whole;
  callbacks.WriteWholeFile = write_nothing;
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) callbacks.GetFileSizeInBytes = size_is_no_matter;
  callbacks.user_data = &folder;
  return callbacks;
}
bool pass_over_picture(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

class Reader {
 public:
  Reader(const Source& source, std::string folder) : source_(source), folder_(std::move(folder)) {}

  Result<Polygons> polygons(const std::string& content) {
    const std::optional<std::string> changed = acceptable_to_library(content);
    GONIO_TRY(load(changed ? *changed : content));
    GONIO_ASSIGN(const std::size_t unpacked, arrays_.unpack_views());
    std::size_t bytes = content.size() + unpacked;
    for (const tinygltf::Buffer& buffer : model_.buffers) bytes += buffer.data.size();
    room_ = std::clamp(std::min(bytes, kMostRoom) * kRoomAByte, kLeastRoom, kMostRoom);
    arrays_.set_room(room_);
    met_.assign(model_.nodes.size(), false);
    const tinygltf::Scene* scene = element(model_.scenes, std::max(model_.defaultScene, 0));
    if (scene == nullptr) return refused("scenes", "there is no scene: export one");
    GONIO_TRY(place_all(scene->nodes));
    if (result_.faces.empty())
      return refused("scene", hidden_ ? "KHR_node_visibility hides all of its meshes: show one"
                                      : "no node of it has a mesh of triangles");
    return std::move(result_);
  }

 private:
  Error refused(const std::string& where, const std::string& why) const {
    return input_error("{}: {}: {}", source_.name, where, why);
  }

  Result<void> load(const std::string& content) {
    tinygltf::TinyGLTF library;
    library.SetImageLoader(pass_over_picture, nullptr);
    library.SetFsCallbacks(callbacks_for<tinygltf::FsCallbacks>(folder_));
    std::string error, warning;
    const auto size = static_cast<unsigned>(content.size());
    if (size != content.size()) return refused("file", "has more than 4 GB: split it");
    const bool loaded =
        content.starts_with("glTF")
            ? library.LoadBinaryFromMemory(&model_, &error, &warning,
                                           reinterpret_cast<const unsigned char*>(content.data()), size, folder_)
            : library.LoadASCIIFromString(&model_, &error, &warning, content.data(), size, folder_);
    // A compressed file may lack the buffers that others have, so its extensions come first.
    GONIO_TRY(check_extensions());
    if (!loaded) {
      constexpr std::size_t kLongest = 160;  // it may name a buffer that is written out in the file
      const std::string first(trimmed(std::string_view(error).substr(0, std::min(error.find('\n'), kLongest))));
      return input_error("{}: is no whole glTF 2.0 file ({}): export it again as glTF 2.0 or GLB", source_.name, first);
    }
    if (!model_.asset.version.starts_with("2."))
      return input_error("{}: is glTF of version \"{}\": export glTF 2.0", source_.name, model_.asset.version);
    return {};
  }

  // Extensions that change what the surface is must be known; those of looks are passed over.
  Result<void> check_extensions() const {
    for (const std::string& name : model_.extensionsRequired) {
      const bool known = name == kDraco || name == kVisibility || std::ranges::find(kMeshopt, name) != kMeshopt.end() ||
                         std::ranges::find(kHarmless, name) != kHarmless.end();
      const bool of_looks = name.starts_with("KHR_materials_") || name.starts_with("KHR_texture_") ||
                            name.starts_with("KHR_lights_") || name.starts_with("EXT_texture_") ||
                            name.starts_with("MSFT_texture_");
      if (!known && !of_looks)
        return refused("extensionsRequired", fmt::format("\"{}\" is not known here: export without it", name));
    }
    return {};
  }

  // Remarks on extensions, of what is placed, that may change it and are not known. Each is named once.
  void remark_on(const tinygltf::ExtensionMap& extensions, const std::string& where) {
    for (const auto& [name, value] : extensions) {
      if (name == kDraco || name == kVisibility || std::ranges::find(kHarmless, name) != kHarmless.end()) continue;
      remark_once(name, fmt::format("{} has the extension {}, which is not known here: what it changes is not drawn",
                                    where, name));
    }
  }
  void remark_once(const std::string& about, const std::string& remark) {
    if (remarked_.insert(about).second) result_.remarks.push_back(remark);
  }

  // The numbers of a node's property: `usual` where it has none, and nothing where they are not as many or not finite.
  static std::optional<std::vector<double>> numbers(const std::vector<double>& given, std::vector<double> usual) {
    if (given.empty()) return usual;
    const auto is_finite = [](double v) { return std::isfinite(v); };
    if (given.size() != usual.size() || !std::ranges::all_of(given, is_finite)) return std::nullopt;
    return given;
  }

  // The matrix of a node (section 3.5.3): its own, or that of translation, rotation and scale.
  Result<Matrix> matrix_of(const tinygltf::Node& node, const std::string& where) const {
    if (!node.matrix.empty()) {
      const auto values = numbers(node.matrix, std::vector<double>(16));
      if (!values) return refused(where, "its matrix has no 16 finite numbers");
      Matrix matrix;
      std::ranges::copy(*values, matrix.begin());
      return matrix;
    }
    const auto t = numbers(node.translation, {0, 0, 0}), r = numbers(node.rotation, {0, 0, 0, 1}),
               s = numbers(node.scale, {1, 1, 1});
    if (!t || !r || !s) return refused(where, "its translation, rotation or scale is no list of finite numbers");
    const double size = std::sqrt((*r)[0] * (*r)[0] + (*r)[1] * (*r)[1] + (*r)[2] * (*r)[2] + (*r)[3] * (*r)[3]);
    if (!(size > 0)) return refused(where, "its rotation is no quaternion of length 1");
    const double x = (*r)[0] / size, y = (*r)[1] / size, z = (*r)[2] / size, w = (*r)[3] / size;
    const double a = (*s)[0], b = (*s)[1], c = (*s)[2];
    return Matrix{a * (1 - 2 * (y * y + z * z)),
                  a * 2 * (x * y + z * w),
                  a * 2 * (x * z - y * w),
                  0,
                  b * 2 * (x * y - z * w),
                  b * (1 - 2 * (x * x + z * z)),
                  b * 2 * (y * z + x * w),
                  0,
                  c * 2 * (x * z + y * w),
                  c * 2 * (y * z - x * w),
                  c * (1 - 2 * (x * x + y * y)),
                  0,
                  (*t)[0],
                  (*t)[1],
                  (*t)[2],
                  1};
  }

  struct Waiting {
    int node;
    Matrix above;
  };

  // A hidden node hides those below it as well.
  static bool is_hidden(const tinygltf::Node& node) {
    const auto found = node.extensions.find(kVisibility);
    if (found == node.extensions.end() || !found->second.IsObject()) return false;
    const tinygltf::Value& visible = found->second.Get("visible");
    return visible.IsBool() && !visible.Get<bool>();
  }

  // Places the meshes of these nodes and of all below them. A node may stand in one place only, so that there are no
  // circles.
  Result<void> place_all(const std::vector<int>& roots) {
    std::vector<Waiting> waiting;
    const auto push = [&](const std::vector<int>& nodes, const Matrix& above) {
      for (std::size_t i = nodes.size(); i-- > 0;) waiting.push_back({nodes[i], above});
    };
    push(roots, kIdentity);
    while (!waiting.empty()) {
      const Waiting next = waiting.back();
      waiting.pop_back();
      const std::string where = fmt::format("node {}", next.node);
      const tinygltf::Node* node = element(model_.nodes, next.node);
      if (node == nullptr) return refused(where, "there is no such node");
      const auto number = static_cast<std::size_t>(next.node);
      if (met_[number]) return refused(where, "stands below two nodes, or below itself");
      met_[number] = true;
      if (is_hidden(*node)) {
        hidden_ = true;
        continue;
      }
      if (node->extensions.contains(kInstancing))
        return refused(where, fmt::format("is placed by {}: export a node for each instance", kInstancing));
      GONIO_ASSIGN(const Matrix own, matrix_of(*node, where));
      const Matrix matrix = product(next.above, own);
      if (node->mesh != -1) GONIO_TRY(place_mesh(*node, matrix, where));
      push(node->children, matrix);
    }
    return {};
  }

  // A part has the name of its node or, where that has none, of its mesh. Of a mesh in several materials each is a
  // part.
  Result<void> place_mesh(const tinygltf::Node& node, const Matrix& matrix, const std::string& where) {
    const tinygltf::Mesh* mesh = element(model_.meshes, node.mesh);
    if (mesh == nullptr) return refused(where, fmt::format("there is no mesh {}", node.mesh));
    std::string name = node.name.empty() ? mesh->name : node.name;
    if (name.empty()) name = fmt::format("mesh-{}", node.mesh);
    remark_on(node.extensions, where), remark_on(mesh->extensions, fmt::format("mesh {}", node.mesh));
    if (node.skin != -1) remark_once("a skin", where + " is bent by a skin: it is drawn as it is stored");
    const std::vector<double>& weights = node.weights.empty() ? mesh->weights : node.weights;
    if (std::ranges::any_of(weights, [](double weight) { return weight != 0; }))
      remark_once("morph targets", where + " is changed by morph targets: it is drawn without them");
    for (std::size_t i = 0; i < mesh->primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = mesh->primitives[i];
      const int mode = primitive.mode;
      if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN)
        continue;  // points and lines
      const tinygltf::Material* material = element(model_.materials, primitive.material);
      const std::string made_of = material != nullptr ? material->name : "";
      const std::string of_several =
          mesh->primitives.size() > 1 ? "." + (made_of.empty() ? std::to_string(i) : made_of) : "";
      const std::string primitive_name = fmt::format("mesh {}, primitive {}", node.mesh, i);
      remark_on(primitive.extensions, primitive_name);
      const Look look = material != nullptr ? look_of(*material) : Look::kUnknown;
      GONIO_TRY(place(primitive, matrix, part(name + of_several, made_of, look), primitive_name));
    }
    return {};
  }

  // Light passes a material that transmits half of it or lets a quarter of the background through; metal is polished
  // where no texture and no coat of paint says otherwise (section 3.9, KHR_materials_transmission).
  static Look look_of(const tinygltf::Material& material) {
    const auto transmission = material.extensions.find("KHR_materials_transmission");
    if (transmission != material.extensions.end() && transmission->second.IsObject()) {
      const tinygltf::Value& factor = transmission->second.Get("transmissionFactor");
      if (factor.IsNumber() && factor.GetNumberAsDouble() >= 0.5) return Look::kClear;
    }
    const tinygltf::PbrMetallicRoughness& surface = material.pbrMetallicRoughness;
    if (material.alphaMode == "BLEND" && surface.baseColorFactor.size() == 4 && surface.baseColorFactor[3] <= 0.75)
      return Look::kClear;
    const bool polished = surface.metallicFactor >= 0.9 && surface.roughnessFactor <= 0.5 &&
                          surface.metallicRoughnessTexture.index == -1 &&
                          !material.extensions.contains("KHR_materials_clearcoat");
    return polished ? Look::kPolishedMetal : Look::kUnknown;
  }

  // The part of that name and material. A name that comes twice is one part, unless it is made of something else: that
  // gets the name of its material behind its own.
  std::uint32_t part(std::string name, const std::string& material, Look look) {
    while (true) {
      const auto [found, is_new] = parts_.try_emplace(name, static_cast<std::uint32_t>(result_.parts.size()));
      if (is_new) result_.parts.push_back({name, material, look});
      if (result_.parts[found->second].material == material) return found->second;
      name += "." + (material.empty() ? "plain" : material);
    }
  }

  Result<void> place(const tinygltf::Primitive& primitive, const Matrix& matrix, std::uint32_t part,
                     const std::string& where) {
    GONIO_ASSIGN(const GltfArrays arrays, arrays_.arrays_of(primitive, where));
    const std::size_t count = arrays.positions.size() / 3;
    const bool with_normals = !arrays.normals.empty(), with_texture = !arrays.texture.empty();
    if ((with_normals && arrays.normals.size() != 3 * count) || (with_texture && arrays.texture.size() != 2 * count))
      return refused(where, "its attributes have different counts");
    for (const double index : arrays.indices)
      if (!(index < static_cast<double>(count)))
        return refused(where, fmt::format("index {} is beyond its {} vertices", index, count));
    const auto first = static_cast<std::uint32_t>(result_.positions.size());
    GONIO_TRY(add_vertices(arrays.positions, arrays.normals, arrays.texture, matrix, where));
    // Draco packs triangles, whatever they were before.
    const int mode = primitive.extensions.contains(kDraco) ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    return add_faces(arrays.indices, mode, matrix, part, first, with_normals, with_texture, where);
  }

  Result<void> add_vertices(const std::vector<double>& positions, const std::vector<double>& normals,
                            const std::vector<double>& texture, const Matrix& matrix, const std::string& where) {
    const std::size_t count = positions.size() / 3;
    if (result_.positions.size() + count > room_)
      return refused(where, fmt::format("the scene has more than {} vertices, instances counted", room_));
    // Normals are turned by the cofactors of the matrix, which its mirror images keep on the outside.
    const Vec3 x = column_of(matrix, 0), y = column_of(matrix, 1), z = column_of(matrix, 2);
    const double side = dot(cross(x, y), z) < 0 ? -1 : 1;
    first_normal_ = static_cast<std::int32_t>(result_.normals.size());
    first_texture_ = static_cast<std::int32_t>(result_.texture.size());
    for (std::size_t i = 0; i < count; ++i) {
      const double* p = &positions[3 * i];
      const Vec3 at = placed(matrix, {p[0], p[1], p[2]});
      if (!std::isfinite(at.x + at.y + at.z)) return refused(where, "a vertex is not at a finite place");
      result_.positions.push_back(at);
      if (!normals.empty()) {
        const double* n = &normals[3 * i];
        const Vec3 normal = side * (n[0] * cross(y, z) + n[1] * cross(z, x) + n[2] * cross(x, y));
        const double size = length(normal);
        result_.normals.push_back(size > 0 && std::isfinite(size) ? (1 / size) * normal : Vec3{});
      }
      if (!texture.empty())
        result_.texture.push_back({static_cast<float>(texture[2 * i]), static_cast<float>(1 - texture[2 * i + 1])});
    }
    return {};
  }

  // Triangles of a list, a strip or a fan (section 3.7.2.1), turned where the matrix mirrors them.
  Result<void> add_faces(const std::vector<double>& indices, int mode, const Matrix& matrix, std::uint32_t part,
                         std::uint32_t first, bool with_normals, bool with_texture, const std::string& where) {
    const bool mirrors = dot(cross(column_of(matrix, 0), column_of(matrix, 1)), column_of(matrix, 2)) < 0;
    const std::size_t count = mode == TINYGLTF_MODE_TRIANGLES ? indices.size() / 3
                              : indices.size() < 3            ? 0
                                                              : indices.size() - 2;
    if (result_.corners.size() + 3 * count > room_)
      return refused(where, fmt::format("the scene has more than {} corners, instances counted", room_));
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::size_t, 3> at = {3 * i, 3 * i + 1, 3 * i + 2};
      if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) at = {i, i + 1 + i % 2, i + 2 - i % 2};
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN) at = {i + 1, i + 2, 0};
      if (mirrors) std::swap(at[1], at[2]);
      result_.faces.push_back({result_.corners.size(), 3, part});
      for (const std::size_t corner : at) {
        const auto vertex = static_cast<std::uint32_t>(indices[corner]);
        const auto normal = first_normal_ + static_cast<std::int32_t>(vertex);
        const bool known = with_normals && length(result_.normals[static_cast<std::size_t>(normal)]) > 0;
        result_.corners.push_back({first + vertex, known ? normal : kNoNormal,
                                   with_texture ? first_texture_ + static_cast<std::int32_t>(vertex) : kNoTexture});
      }
    }
    return {};
  }

  const Source& source_;
  std::string folder_;
  tinygltf::Model model_;
  GltfArrayReader arrays_{model_, source_.name};
  std::size_t room_ = 0;  // for corners, and for vertices
  std::vector<bool> met_;
  bool hidden_ = false;             // whether a node was
  std::set<std::string> remarked_;  // what there is a remark on
  std::map<std::string, std::uint32_t> parts_;
  std::int32_t first_normal_ = 0, first_texture_ = 0;  // of the primitive that is placed
  Polygons result_;
};

}  // namespace

Result<Polygons> polygons_from_gltf(const std::string& content, const Source& source, const std::string& folder) {
  GONIO_ASSIGN(
      const ChildBytes bytes,
      made_by_child(source.name, limits_for(content.size(), !folder.empty()), [&](ChildOutput& output) -> Result<void> {
        GONIO_ASSIGN(const Polygons polygons, Reader(source, folder).polygons(content));
        put(output, polygons);
        return {};
      }));
  return polygons_of_bytes(bytes.view(), source.name);
}

}  // namespace goniochrome::mesh
