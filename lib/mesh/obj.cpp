// Wavefront OBJ, as far as a picture needs it: v, vt, vn, f, o, g, usemtl. Everything else (lines, smoothing groups,
// material libraries) is passed over.
//
// The text is divided into chunks of whole statements, which are read on all cores. A reference of a face depends on
// how many vertices stand before it, and its part on the last name before it. Therefore each chunk is read twice: at
// first its statements are only counted, and then, when it is known what stands before each chunk, they are read. The
// chunks depend on the text alone, so that the result and the first error do not depend on the number of threads.
#include <algorithm>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "base/parallel.h"
#include "base/text.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

// Takes the next word off the front of the line; it is empty where there is none.
std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_blank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

// The statements of a text, one after the other: a line without its comment, or several lines of which all but the last
// end with a backslash.
class Statements {
 public:
  Statements(std::string_view text, std::size_t lines_before) : text_(text), line_(lines_before) {}

  // True if there was one more. The statement is valid until the next call.
  bool next(std::string_view& statement) {
    if (at_ >= text_.size()) return false;
    std::string_view line = next_line();
    if (line.ends_with('\\')) {
      joined_.assign(line);
      while (joined_.ends_with('\\') && at_ < text_.size()) {
        joined_.back() = ' ';
        joined_ += next_line();
      }
      line = joined_;
    }
    statement = line.substr(0, line.find('#'));
    return true;
  }
  // The number of the line that was read last, from 1.
  std::size_t line() const { return line_; }

 private:
  std::string_view next_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  std::string_view text_;
  std::size_t at_ = 0, line_;
  std::string joined_;
};

// How much of everything there is in a chunk, or before it; and which names were given last, if any were.
struct Census {
  std::size_t lines = 0, positions = 0, textures = 0, normals = 0, free_forms = 0;
  std::optional<std::string> object, group, material;

  Census& operator+=(const Census& later) {
    lines += later.lines, positions += later.positions, textures += later.textures, normals += later.normals;
    free_forms += later.free_forms;
    if (later.object) object = later.object;
    if (later.group) group = later.group;
    if (later.material) material = later.material;
    return *this;
  }
};

// A line that is too short for three numbers is an error, which ends the reading before its place is used. It is not
// counted, so that a text of such lines does not ask for twelve times its own memory.
Census census_of(std::string_view text) {
  constexpr std::size_t kThreeNumbers = std::string_view(" 0 0 0").size();
  Census census;
  Statements statements(text, 0);
  for (std::string_view line; statements.next(line);) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v" && line.size() >= kThreeNumbers) ++census.positions;
    if (keyword == "vn" && line.size() >= kThreeNumbers) ++census.normals;
    if (keyword == "vt") ++census.textures;
    if (keyword == "surf") ++census.free_forms;
    if (keyword == "o") census.object = trimmed(line);
    if (keyword == "g") census.group = trimmed(line);
    if (keyword == "usemtl") census.material = trimmed(line);
  }
  census.lines = statements.line();
  return census;
}

// The text in pieces of about kChunkBytes that end with whole statements.
std::vector<std::string_view> chunks_of(std::string_view text) {
  std::vector<std::string_view> chunks;
  while (!text.empty()) {
    std::size_t end = std::min(kChunkBytes, text.size());
    for (bool whole = false; !whole && end < text.size();) {
      end = std::min(text.find('\n', end), text.size() - 1) + 1;
      std::string_view line = text.substr(0, end - 1);
      if (line.ends_with('\r')) line.remove_suffix(1);
      whole = !line.ends_with('\\');
    }
    chunks.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return chunks;
}

// The faces of a chunk, whose corners and parts are counted from 0 in each chunk.
struct Faces {
  std::vector<Polygons::Corner> corners;
  std::vector<Polygons::Face> faces;
  std::vector<Polygons::Part> parts;
  bool normals_lost = false;  // whether a normal has no length
  std::string mixed = {};     // the first part of several materials, and two of these
};

std::string mixed_materials(const Polygons::Part& part, const std::string& other) {
  const std::string name = part.name.empty() ? "a part without a name" : fmt::format("\"{}\"", part.name);
  return fmt::format("{} has faces of several materials (\"{}\", \"{}\")", name, part.material, other);
}

// Reads one chunk. Its vertices go to their places in `mesh`, which has room for all.
class ChunkReader {
 public:
  ChunkReader(std::string_view text, const Census& before, bool has_objects, const std::string& path, Polygons& mesh)
      : statements_(text, before.lines),
        path_(path),
        has_objects_(has_objects),
        part_name_((has_objects ? before.object : before.group).value_or("")),
        material_(before.material.value_or("")),
        positions_(before.positions),
        textures_(before.textures),
        normals_(before.normals),
        mesh_(mesh) {}

  Result<Faces> faces() {
    for (std::string_view statement; statements_.next(statement);) GONIO_TRY(read(statement));
    return std::move(faces_);
  }

 private:
  Result<void> read(std::string_view line) {
    const auto keyword = next_word(line);
    if (keyword == "v") return vertex(line);
    if (keyword == "vt") return texture(line);
    if (keyword == "vn") return normal(line);
    if (keyword == "f") return face(line);
    if (keyword == "usemtl") material_ = trimmed(line), part_.reset();
    if (keyword == (has_objects_ ? "o" : "g")) part_name_ = trimmed(line), part_.reset();
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
                           statements_.line(), what, axis + 1, word);
      }
      v[axis] = *number;
    }
    return v;
  }

  Result<void> vertex(std::string_view line) {
    GONIO_ASSIGN(mesh_.positions[positions_], coordinates(line, "vertex"));
    ++positions_;
    return {};
  }

  // u and v; a w behind them is passed over.
  Result<void> texture(std::string_view line) {
    GONIO_ASSIGN(const Vec3 uv, coordinates(line, "texture", 2, 1));
    mesh_.texture[textures_++] = {static_cast<float>(uv.x), static_cast<float>(uv.y)};
    return {};
  }

  // A normal without length is of no use, and is left at 0: its corners get a normal that is made for them.
  Result<void> normal(std::string_view line) {
    GONIO_ASSIGN(const Vec3 given, coordinates(line, "normal"));
    const double size = length(given);
    const bool usable = size > 0 && std::isfinite(size);
    faces_.normals_lost |= !usable;
    mesh_.normals[normals_++] = usable ? (1 / size) * given : Vec3{};
    return {};
  }

  // The index, from 0, for a reference that counts from 1, or, if it is negative, back from the end.
  Result<std::size_t> reference(std::string_view word, std::size_t count, const char* what) {
    const auto index = parse_integer(word);
    if (!index || *index == 0) {
      return input_error("{}:{}: \"{}\" is no {} index: write a whole number from 1, or a negative one to count back",
                         path_, statements_.line(), word, what);
    }
    const auto n = static_cast<std::int64_t>(count);
    const std::int64_t at = *index > 0 ? *index - 1 : n + *index;
    if (at < 0 || at >= n) {
      return input_error("{}:{}: the face refers to {} {}, but there are {} so far: the file may be cut or reordered",
                         path_, statements_.line(), what, word, count);
    }
    return static_cast<std::size_t>(at);
  }

  // A corner is `v`, `v/vt`, `v//vn` or `v/vt/vn`.
  Result<Polygons::Corner> corner(std::string_view word) {
    Polygons::Corner corner;
    const auto first_slash = word.find('/');
    GONIO_ASSIGN(const std::size_t position, reference(word.substr(0, first_slash), positions_, "vertex"));
    corner.position = static_cast<std::uint32_t>(position);
    if (first_slash == std::string_view::npos) return corner;
    const auto second_slash = word.find('/', first_slash + 1);
    const auto place = word.substr(first_slash + 1, second_slash - first_slash - 1);
    if (!place.empty() && textures_ > 0) {  // references to nothing at all are passed over
      GONIO_ASSIGN(const std::size_t at, reference(place, textures_, "texture"));
      corner.texture = static_cast<std::int32_t>(at);
    }
    if (second_slash == std::string_view::npos) return corner;
    GONIO_ASSIGN(const std::size_t at, reference(word.substr(second_slash + 1), normals_, "normal"));
    corner.normal = static_cast<std::int32_t>(at);
    return corner;
  }

  Result<void> face(std::string_view line) {
    Polygons::Face face{faces_.corners.size(), 0, part()};
    for (auto word = next_word(line); !word.empty(); word = next_word(line)) {
      GONIO_ASSIGN(const Polygons::Corner next, corner(word));
      faces_.corners.push_back(next);
      ++face.count;
    }
    if (face.count < 3) {
      return input_error("{}:{}: the face has {} corners: give it at least three", path_, statements_.line(),
                         face.count);
    }
    faces_.faces.push_back(face);
    return {};
  }

  // The part that faces go to now; its material is that of its first face.
  std::uint32_t part() {
    if (part_) return *part_;
    const auto [entry, is_new] = part_index_.try_emplace(part_name_, static_cast<std::uint32_t>(faces_.parts.size()));
    if (is_new) faces_.parts.push_back({part_name_, material_});
    const Polygons::Part& part = faces_.parts[entry->second];
    if (part.material != material_ && faces_.mixed.empty()) faces_.mixed = mixed_materials(part, material_);
    part_ = entry->second;
    return *part_;
  }

  Statements statements_;
  const std::string& path_;
  bool has_objects_;
  std::string part_name_, material_;
  std::unordered_map<std::string, std::uint32_t> part_index_;
  std::optional<std::uint32_t> part_;           // of part_name_, once it is known
  std::size_t positions_, textures_, normals_;  // so far, in the whole text
  Faces faces_;
  Polygons& mesh_;
};

// Puts the faces of the next chunk behind those before it, and lets go of them.
class FacesJoined {
 public:
  FacesJoined(Polygons& mesh, std::size_t corners, std::size_t faces) : mesh_(mesh) {
    mesh.corners.reserve(corners);
    mesh.faces.reserve(faces);
  }

  void add(Faces chunk) {
    if (mixed_.empty()) mixed_ = std::move(chunk.mixed);
    std::vector<std::uint32_t> number_of;  // in the mesh, of each part of the chunk
    for (Polygons::Part& part : chunk.parts) {
      const auto [entry, is_new] = index_.try_emplace(part.name, static_cast<std::uint32_t>(mesh_.parts.size()));
      if (is_new) mesh_.parts.push_back(std::move(part));
      const Polygons::Part& known = mesh_.parts[entry->second];
      if (!is_new && known.material != part.material && mixed_.empty()) mixed_ = mixed_materials(known, part.material);
      number_of.push_back(entry->second);
    }
    const std::size_t before = mesh_.corners.size();
    mesh_.corners.insert(mesh_.corners.end(), chunk.corners.begin(), chunk.corners.end());
    for (const Polygons::Face& face : chunk.faces)
      mesh_.faces.push_back({before + face.first, face.count, number_of[face.part]});
    normals_lost_ |= chunk.normals_lost;
  }
  bool normals_lost() const { return normals_lost_; }
  const std::string& mixed() const { return mixed_; }

 private:
  std::string mixed_;
  Polygons& mesh_;
  std::unordered_map<std::string, std::uint32_t> index_;
  bool normals_lost_ = false;
};

}  // namespace

Result<Polygons> polygons_from_obj(std::string_view text, const Source& source) {
  const std::vector<std::string_view> chunks = chunks_of(text);
  std::vector<Census> before(chunks.size() + 1);
  parallel_for(chunks.size(), 1, [&](std::size_t i, std::size_t) { before[i + 1] = census_of(chunks[i]); });
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    Census sum = before[i];
    before[i + 1] = sum += before[i + 1];
  }
  const Census& all = before.back();
  // Objects name the parts; a file without objects is divided by its groups.
  const bool has_objects = all.object.has_value(), has_parts = has_objects || all.group.has_value();

  Polygons mesh;
  mesh.positions.resize(all.positions), mesh.texture.resize(all.textures), mesh.normals.resize(all.normals);
  std::vector<std::optional<Result<Faces>>> read(chunks.size());
  parallel_for(chunks.size(), 1, [&](std::size_t i, std::size_t) {
    read[i] = ChunkReader(chunks[i], before[i], has_objects, source.name, mesh).faces();
  });
  std::size_t corners = 0, faces = 0;
  for (const auto& chunk : read) {
    GONIO_TRY(chunk->ok() ? Result<void>() : Result<void>(chunk->error()));
    corners += (*chunk)->corners.size(), faces += (*chunk)->faces.size();
  }
  if (faces == 0)
    return input_error("{}: holds no faces (f lines){}: there is nothing to draw", source.name,
                       all.free_forms > 0 ? ", but free-form surfaces (surf): export them as faces" : "");
  if (all.free_forms > 0)
    mesh.remarks.push_back(
        fmt::format("{} free-form surfaces (surf lines) are not drawn: export them as faces", all.free_forms));
  FacesJoined joined(mesh, corners, faces);
  for (auto& chunk : read) {
    joined.add(std::move(**chunk));
    chunk.reset();
  }
  if (!joined.mixed().empty())
    mesh.remarks.push_back(joined.mixed() + ", and is one part of the first: write an o line before each material");
  if (joined.normals_lost()) {
    for (Polygons::Corner& corner : mesh.corners)
      if (corner.normal != kNoNormal && mesh.normals[static_cast<std::size_t>(corner.normal)] == Vec3{})
        corner.normal = kNoNormal;
  }
  for (Polygons::Part& part : mesh.parts)
    if (part.name.empty()) part.name = has_parts ? "unnamed" : source.part_name;
  return mesh;
}

}  // namespace goniochrome::mesh
