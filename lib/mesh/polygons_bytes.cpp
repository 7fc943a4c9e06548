#include "mesh/internal/polygons_bytes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace goniochrome::mesh {

namespace {

template <class Value>
void put_all(ChildOutput& output, const Value* values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<Value>);
  const std::uint64_t number = count;
  output.write(&number, sizeof number);
  if (count > 0) output.write(values, count * sizeof(Value));
}

class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}

  // Fills a vector or a text; false where the bytes end before it does.
  template <class Values>
  bool take(Values& values) {
    using Value = typename Values::value_type;
    std::uint64_t count = 0;
    if (!take_number(count) || count > rest_.size() / sizeof(Value)) return false;
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), rest_.data(), count * sizeof(Value));
    rest_.remove_prefix(count * sizeof(Value));
    return true;
  }
  bool take_number(std::uint64_t& number) {
    if (rest_.size() < sizeof number) return false;
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
    return true;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

// True if `index` counts one of `count`, or is `none`.
bool is_within(std::int32_t index, std::int32_t none, std::size_t count) {
  return index == none || (index >= 0 && static_cast<std::size_t>(index) < count);
}

bool is_whole(const Polygons& polygons) {
  const auto is_finite = [](const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  const auto is_corner = [&](const Polygons::Corner& corner) {
    return corner.position < polygons.positions.size() &&
           is_within(corner.normal, kNoNormal, polygons.normals.size()) &&
           is_within(corner.texture, kNoTexture, polygons.texture.size());
  };
  const std::size_t corners = polygons.corners.size();
  const auto is_face = [&](const Polygons::Face& face) {
    return face.count >= 3 && face.count <= corners && face.first <= corners - face.count &&
           face.part < polygons.parts.size();
  };
  return std::ranges::all_of(polygons.positions, is_finite) && std::ranges::all_of(polygons.normals, is_finite) &&
         std::ranges::all_of(polygons.corners, is_corner) && std::ranges::all_of(polygons.faces, is_face);
}

}  // namespace

void put(ChildOutput& output, const Polygons& polygons) {
  put_all(output, polygons.positions.data(), polygons.positions.size());
  put_all(output, polygons.normals.data(), polygons.normals.size());
  put_all(output, polygons.texture.data(), polygons.texture.size());
  put_all(output, polygons.corners.data(), polygons.corners.size());
  put_all(output, polygons.faces.data(), polygons.faces.size());
  const std::uint64_t parts = polygons.parts.size();
  output.write(&parts, sizeof parts);
  for (const Polygons::Part& part : polygons.parts) {
    for (const std::string* text : {&part.name, &part.material}) put_all(output, text->data(), text->size());
    const auto look = static_cast<std::uint64_t>(part.look);
    output.write(&look, sizeof look);
  }
  const std::uint64_t remarks = polygons.remarks.size();
  output.write(&remarks, sizeof remarks);
  for (const std::string& remark : polygons.remarks) put_all(output, remark.data(), remark.size());
}

Result<Polygons> polygons_of_bytes(std::string_view content, const std::string& path) {
  Polygons polygons;
  Bytes bytes(content);
  std::uint64_t parts = 0;
  bool whole = bytes.take(polygons.positions) && bytes.take(polygons.normals) && bytes.take(polygons.texture) &&
               bytes.take(polygons.corners) && bytes.take(polygons.faces) && bytes.take_number(parts) &&
               parts <= bytes.left();
  if (whole) polygons.parts.resize(parts);
  for (Polygons::Part& part : polygons.parts) {
    std::uint64_t look = 0;
    whole = whole && bytes.take(part.name) && bytes.take(part.material) && bytes.take_number(look) &&
            look <= static_cast<std::uint64_t>(Look::kPolishedMetal);
    if (whole) part.look = static_cast<Look>(look);
  }
  std::uint64_t remarks = 0;
  whole = whole && bytes.take_number(remarks) && remarks <= bytes.left();
  if (whole) polygons.remarks.resize(remarks);
  for (std::string& remark : polygons.remarks) whole = whole && bytes.take(remark);
  if (!whole || !is_whole(polygons))
    return input_error("{}: the library that reads it lost its way: the file is damaged: export it again", path);
  return polygons;
}

}  // namespace goniochrome::mesh
