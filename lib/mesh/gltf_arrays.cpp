#include "mesh/internal/gltf_arrays.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "mesh/internal/gltf_numbers.h"
#include "mesh/internal/gltf_packed.h"

namespace goniochrome::mesh {

Error GltfArrayReader::refused(const std::string& where, const std::string& why) const {
  return input_error("{}: {}: {}", name_, where, why);
}

Result<std::size_t> GltfArrayReader::unpack_views() {
  const auto number = [](const tinygltf::Value& object, const char* name) {
    const tinygltf::Value& value = object.Get(name);
    const double given = value.IsNumber() ? value.GetNumberAsDouble() : 0;
    return given >= 0 && given <= 1e15 ? static_cast<std::size_t>(given) : 0;
  };
  const auto text = [](const tinygltf::Value& object, const char* name) {
    const tinygltf::Value& value = object.Get(name);
    return value.IsString() ? value.Get<std::string>() : std::string();
  };
  std::size_t bytes_unpacked = 0;
  for (std::size_t i = 0; i < model_.bufferViews.size(); ++i)
    for (const char* name : kMeshopt) {
      const auto found = model_.bufferViews[i].extensions.find(name);
      if (found == model_.bufferViews[i].extensions.end() || !found->second.IsObject()) continue;
      const tinygltf::Value& packed = found->second;
      tinygltf::BufferView view;
      view.buffer = packed.Get("buffer").IsNumber() ? packed.Get("buffer").GetNumberAsInt() : -1;
      view.byteOffset = number(packed, "byteOffset"), view.byteLength = number(packed, "byteLength");
      const auto bytes = bytes_of_buffer(view);
      auto unpacked = !bytes ? std::nullopt
                             : meshopt_unpacked({*bytes, number(packed, "count"), number(packed, "byteStride"),
                                                 text(packed, "mode"), text(packed, "filter")});
      if (!unpacked)
        return refused(
            fmt::format("bufferView {}", i),
            fmt::format("what it packs by {} cannot be unpacked: export it again, or without compression", name));
      bytes_unpacked += unpacked->size();
      unpacked_[static_cast<int>(i)] = std::move(*unpacked);
    }
  return bytes_unpacked;
}

Result<GltfArrays> GltfArrayReader::arrays_of(const tinygltf::Primitive& primitive, const std::string& where) const {
  GltfArrays arrays;
  struct Wanted {
    const char* name;
    std::size_t wide;
    std::vector<double>& values;
  };
  const std::array<Wanted, 3> all = {
      {{"POSITION", 3, arrays.positions}, {"NORMAL", 3, arrays.normals}, {"TEXCOORD_0", 2, arrays.texture}}};
  const auto packed = primitive.extensions.find(kDraco);
  const bool has_draco = packed != primitive.extensions.end() && packed->second.IsObject();
  const auto id_of = [&](const char* name) {
    const tinygltf::Value& ids = has_draco ? packed->second.Get("attributes") : tinygltf::Value();
    return ids.IsObject() && ids.Get(name).IsNumber() ? ids.Get(name).GetNumberAsInt() : -1;
  };
  if (has_draco) {
    std::vector<DracoMesh::Attribute> attributes;
    std::vector<const Wanted*> which;
    for (const Wanted& wanted : all)
      if (const int id = id_of(wanted.name); id >= 0) attributes.push_back({id, wanted.wide}), which.push_back(&wanted);
    const tinygltf::Value& number = packed->second.Get("bufferView");
    const auto bytes = number.IsNumber() ? bytes_of_view(number.GetNumberAsInt()) : std::nullopt;
    auto mesh = bytes ? draco_unpacked(*bytes, attributes, room_) : std::nullopt;
    if (!mesh)
      return refused(where, "what it packs by Draco cannot be unpacked: export it again, or without compression");
    arrays.indices = std::move(mesh->indices);
    for (std::size_t i = 0; i < which.size(); ++i) which[i]->values = std::move(attributes[i].values);
    for (const Wanted& wanted : all)
      for (const double value : wanted.values)
        if (!std::isfinite(value)) return refused(where, fmt::format("a number of its {} is not finite", wanted.name));
  }
  for (const Wanted& wanted : all) {
    const auto found = primitive.attributes.find(wanted.name);
    if (found == primitive.attributes.end() || id_of(wanted.name) >= 0) continue;
    GONIO_ASSIGN(wanted.values, accessor(found->second, wanted.wide, where + ", " + wanted.name));
  }
  if (arrays.positions.empty() && !primitive.attributes.contains("POSITION")) return refused(where, "has no POSITION");
  if (has_draco) return arrays;
  if (primitive.indices != -1) {
    GONIO_ASSIGN(arrays.indices, accessor(primitive.indices, 1, where + ", indices"));
  } else {
    for (std::size_t i = 0; i < arrays.positions.size() / 3; ++i) arrays.indices.push_back(static_cast<double>(i));
  }
  return arrays;
}

// The bytes of a view, unpacked; nothing where there is no such view, or its buffer has not so many.
std::optional<std::string_view> GltfArrayReader::bytes_of_view(int index) const {
  if (const auto found = unpacked_.find(index); found != unpacked_.end()) return found->second;
  const tinygltf::BufferView* view = element(model_.bufferViews, index);
  return view == nullptr ? std::nullopt : bytes_of_buffer(*view);
}
std::optional<std::string_view> GltfArrayReader::bytes_of_buffer(const tinygltf::BufferView& view) const {
  const tinygltf::Buffer* buffer = element(model_.buffers, view.buffer);
  if (buffer == nullptr) return std::nullopt;
  const std::string_view bytes(reinterpret_cast<const char*>(buffer->data.data()), buffer->data.size());
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) return std::nullopt;
  return bytes.substr(view.byteOffset, view.byteLength);
}

// The numbers of an accessor, `wide` of them to an element. Sparse ones take the place of the others.
Result<std::vector<double>> GltfArrayReader::accessor(int index, std::size_t wide, const std::string& where) const {
  const tinygltf::Accessor* of = element(model_.accessors, index);
  if (of == nullptr) return refused(where, fmt::format("there is no accessor {}", index));
  const int type = wide == 1 ? TINYGLTF_TYPE_SCALAR : wide == 2 ? TINYGLTF_TYPE_VEC2 : TINYGLTF_TYPE_VEC3;
  if (of->type != type || bytes_of_number(of->componentType) == 0 || (wide == 1 && !is_index(of->componentType)))
    return refused(
        where, fmt::format("its accessor has component type {}, and elements of {} numbers, which do not "
                           "fit",
                           of->componentType, tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(of->type))));
  if (of->bufferView == -1 && !of->sparse.isSparse) return refused(where, "its accessor has no bufferView");
  if (of->count > room_) return refused(where, fmt::format("its accessor counts {} elements", of->count));
  std::vector<double> values;
  const Numbers numbers{of->bufferView, of->byteOffset, of->componentType, of->normalized, wide, of->count};
  if (of->bufferView != -1) {
    GONIO_TRY(read_elements(numbers, where, values));
  } else {
    values.assign(wide * of->count, 0);
  }
  if (of->sparse.isSparse) GONIO_TRY(put_sparse(*of, numbers, where, values));
  for (const double value : values)
    if (!std::isfinite(value)) return refused(where, "a number of its accessor is not finite");
  return values;
}

Result<void> GltfArrayReader::read_elements(const Numbers& numbers, const std::string& where,
                                            std::vector<double>& values) const {
  const tinygltf::BufferView* view = element(model_.bufferViews, numbers.view);
  const auto bytes = bytes_of_view(numbers.view);
  const std::size_t one = bytes_of_number(numbers.component), size = one * numbers.wide,
                    stride = view == nullptr || view->byteStride == 0 ? size : view->byteStride;
  if (!bytes || stride < size ||
      (numbers.count > 0 && (numbers.offset > bytes->size() || bytes->size() - numbers.offset < size ||
                             (bytes->size() - numbers.offset - size) / stride < numbers.count - 1)))
    return refused(where,
                   fmt::format("the bufferView {} has too few bytes for {} elements", numbers.view, numbers.count));
  values.reserve(numbers.wide * numbers.count);
  for (std::size_t i = 0; i < numbers.count; ++i)
    for (std::size_t k = 0; k < numbers.wide; ++k)
      values.push_back(
          number_at(bytes->data() + numbers.offset + i * stride + k * one, numbers.component, numbers.normalized));
  return {};
}

Result<void> GltfArrayReader::put_sparse(const tinygltf::Accessor& of, const Numbers& all, const std::string& where,
                                         std::vector<double>& values) const {
  const auto& sparse = of.sparse;
  if (!is_index(sparse.indices.componentType) || std::cmp_less(sparse.count, 0) ||
      std::cmp_less(sparse.indices.byteOffset, 0) || std::cmp_less(sparse.values.byteOffset, 0))
    return refused(where, "its sparse accessor has indices that are no whole numbers");
  const auto count = static_cast<std::size_t>(sparse.count);
  std::vector<double> places, numbers;
  GONIO_TRY(read_elements({sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                           sparse.indices.componentType, false, 1, count},
                          where, places));
  GONIO_TRY(read_elements({sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), all.component,
                           all.normalized, all.wide, count},
                          where, numbers));
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = static_cast<std::size_t>(places[i]);
    if (place >= all.count) return refused(where, "its sparse accessor has an index beyond its count");
    std::copy_n(&numbers[all.wide * i], all.wide, &values[all.wide * place]);
  }
  return {};
}

}  // namespace goniochrome::mesh
