// The numbers of the vertices and corners of a glTF file, from its accessors and from what meshoptimizer and Draco
// pack. Sections are those of the specification (Khronos, glTF 2.0, revision 2.0.1).
#pragma once

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <fstream>
#include <sstream>

#include <tiny_gltf.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace goniochrome::mesh {

// An element of a list by its index, where -1 and others are none.
template <class Element>
const Element* element(const std::vector<Element>& list, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)] : nullptr;
}

// The numbers of a primitive's vertices and corners; empty where it has none.
struct GltfArrays {
  std::vector<double> positions, normals, texture, indices;
};

// Reads the arrays of a model that stays where it is. Errors begin with `name` and the place in the file.
class GltfArrayReader {
 public:
  GltfArrayReader(const tinygltf::Model& model, std::string name) : model_(model), name_(std::move(name)) {}

  // Unpacks the views that meshoptimizer packed, and returns the number of their bytes.
  Result<std::size_t> unpack_views();

  // The most vertices or corners that an array may have.
  void set_room(std::size_t room) { room_ = room; }

  // The arrays of a primitive: those of its accessors, but where Draco has packed them.
  Result<GltfArrays> arrays_of(const tinygltf::Primitive& primitive, const std::string& where) const;

 private:
  // Elements of `wide` numbers of one type, one behind the other.
  struct Numbers {
    int view;
    std::size_t offset;
    int component;
    bool normalized;
    std::size_t wide, count;
  };

  Error refused(const std::string& where, const std::string& why) const;
  std::optional<std::string_view> bytes_of_view(int index) const;
  std::optional<std::string_view> bytes_of_buffer(const tinygltf::BufferView& view) const;
  Result<std::vector<double>> accessor(int index, std::size_t wide, const std::string& where) const;
  Result<void> read_elements(const Numbers& numbers, const std::string& where, std::vector<double>& values) const;
  Result<void> put_sparse(const tinygltf::Accessor& of, const Numbers& all, const std::string& where,
                          std::vector<double>& values) const;

  const tinygltf::Model& model_;
  std::string name_;
  std::size_t room_ = 0;
  std::map<int, std::string> unpacked_;  // the bytes of views that were packed, by their numbers
};

}  // namespace goniochrome::mesh
