// Wavefront OBJ, as far as a picture needs it: v, vt, vn, f, o, g, usemtl. Everything else (lines, smoothing groups,
// material libraries) is passed over.
#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "base/text.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

namespace {

class ObjParser {
 public:
  ObjParser(const std::string& text, const Source& source)
      : text_(text), path_(source.name), part_name_of_file_(source.part_name) {}

  Result<Polygons> parse() {
    find_part_keyword();
    std::string joined;
    for (std::size_t at = 0; at < text_.size();) {
      std::string_view line = next_line(at);
      ++line_;
      if (line.ends_with('\\')) {  // continued on the next line
        joined.assign(line);
        while (joined.ends_with('\\') && at < text_.size()) {
          joined.back() = ' ';
          joined += next_line(at);
          ++line_;
        }
        line = joined;
      }
      GONIO_TRY(statement(line));
    }
    if (mesh_.faces.empty()) return input_error("{}: holds no faces (f lines): there is nothing to draw", path_);
    if (part_keyword_.empty()) mesh_.parts[0].name = part_name_of_file_;
    return std::move(mesh_);
  }

 private:
  std::string_view next_line(std::size_t& at) const {
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    std::string_view line = std::string_view(text_).substr(at, end - at);
    at = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  static std::string_view next_word(std::string_view& line) {
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) return line = {};
    line.remove_prefix(first);
    const auto end = std::min(line.find_first_of(" \t"), line.size());
    const auto word = line.substr(0, end);
    line.remove_prefix(end);
    return word;
  }

  // Objects name the parts; a file without objects is divided by its groups.
  void find_part_keyword() {
    for (std::size_t at = 0; at < text_.size();) {
      std::string_view line = next_line(at);
      const auto word = next_word(line);
      if (word == "o") part_keyword_ = "o";
      if (word == "g" && part_keyword_.empty()) part_keyword_ = "g";
      if (word == "o") break;
    }
  }

  Result<void> statement(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const auto keyword = next_word(line);
    if (keyword == "v") return vertex(line);
    if (keyword == "vt") return texture(line);
    if (keyword == "vn") return normal(line);
    if (keyword == "f") return face(line);
    if (keyword == "usemtl") material_ = trimmed(line);
    if (!keyword.empty() && keyword == part_keyword_) part_name_ = trimmed(line);
    return {};
  }

  // The first `count` numbers of a line; those after the first `required` ones may be missing and are 0 then.
  Result<Vec3> coordinates(std::string_view line, const char* what, int count = 3, int required = 3) {
    Vec3 v;
    for (int axis = 0; axis < count; ++axis) {
      const auto word = next_word(line);
      if (word.empty() && axis >= required) break;
      const auto number = parse_number(word);
      if (!number) {
        return input_error("{}:{}: {} coordinate {} is \"{}\": write a finite number with a decimal point", path_,
                           line_, what, axis + 1, word);
      }
      v[axis] = *number;
    }
    return v;
  }

  Result<void> vertex(std::string_view line) {
    GONIO_ASSIGN(const Vec3 position, coordinates(line, "vertex"));
    mesh_.positions.push_back(position);
    return {};
  }

  // u and v; a w behind them is passed over.
  Result<void> texture(std::string_view line) {
    GONIO_ASSIGN(const Vec3 uv, coordinates(line, "texture", 2, 1));
    mesh_.texture.push_back({static_cast<float>(uv.x), static_cast<float>(uv.y)});
    return {};
  }

  // A normal without length is of no use: its corners get a normal that is made for them.
  Result<void> normal(std::string_view line) {
    GONIO_ASSIGN(const Vec3 given, coordinates(line, "normal"));
    const double size = length(given);
    const bool usable = size > 0 && std::isfinite(size);
    normal_index_.push_back(usable ? static_cast<std::int32_t>(mesh_.normals.size()) : kNoNormal);
    if (usable) mesh_.normals.push_back((1 / size) * given);
    return {};
  }

  // The index, from 0, for a reference that counts from 1, or, if it is negative, back from the end.
  Result<std::size_t> reference(std::string_view word, std::size_t count, const char* what) {
    const auto index = parse_integer(word);
    if (!index || *index == 0) {
      return input_error("{}:{}: \"{}\" is no {} index: write a whole number from 1, or a negative one to count back",
                         path_, line_, word, what);
    }
    const auto n = static_cast<std::int64_t>(count);
    const std::int64_t at = *index > 0 ? *index - 1 : n + *index;
    if (at < 0 || at >= n) {
      return input_error("{}:{}: the face refers to {} {}, but there are {} so far: the file may be cut or reordered",
                         path_, line_, what, word, count);
    }
    return static_cast<std::size_t>(at);
  }

  // A corner is `v`, `v/vt`, `v//vn` or `v/vt/vn`.
  Result<Polygons::Corner> corner(std::string_view word) {
    Polygons::Corner corner;
    const auto first_slash = word.find('/');
    GONIO_ASSIGN(const std::size_t position, reference(word.substr(0, first_slash), mesh_.positions.size(), "vertex"));
    corner.position = static_cast<std::uint32_t>(position);
    if (first_slash == std::string_view::npos) return corner;
    const auto second_slash = word.find('/', first_slash + 1);
    const auto place = word.substr(first_slash + 1, second_slash - first_slash - 1);
    if (!place.empty() && !mesh_.texture.empty()) {  // references to nothing at all are passed over
      GONIO_ASSIGN(const std::size_t at, reference(place, mesh_.texture.size(), "texture"));
      corner.texture = static_cast<std::int32_t>(at);
    }
    if (second_slash == std::string_view::npos) return corner;
    GONIO_ASSIGN(const std::size_t at, reference(word.substr(second_slash + 1), normal_index_.size(), "normal"));
    corner.normal = normal_index_[at];
    return corner;
  }

  Result<void> face(std::string_view line) {
    Polygons::Face face{mesh_.corners.size(), 0, part()};
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
      GONIO_ASSIGN(const Polygons::Corner next, corner(word));
      mesh_.corners.push_back(next);
      ++face.count;
    }
    if (face.count < 3) {
      return input_error("{}:{}: the face has {} corners: give it at least three", path_, line_, face.count);
    }
    mesh_.faces.push_back(face);
    return {};
  }

  // The part that faces go to now; its material is that of its first face.
  std::uint32_t part() {
    const auto [entry, is_new] = part_index_.try_emplace(part_name_, static_cast<std::uint32_t>(mesh_.parts.size()));
    if (is_new) {
      const bool unnamed = part_name_.empty() && !part_keyword_.empty();
      mesh_.parts.push_back({unnamed ? "unnamed" : part_name_, material_});
    }
    return entry->second;
  }

  const std::string& text_;
  const std::string& path_;
  const std::string& part_name_of_file_;
  std::size_t line_ = 0;
  std::string part_keyword_, part_name_, material_;
  std::unordered_map<std::string, std::uint32_t> part_index_;
  std::vector<std::int32_t> normal_index_;  // from the file's numbering to mesh_.normals
  Polygons mesh_;
};

}  // namespace

Result<Polygons> polygons_from_obj(const std::string& text, const Source& source) {
  return ObjParser(text, source).parse();
}

}  // namespace goniochrome::mesh
