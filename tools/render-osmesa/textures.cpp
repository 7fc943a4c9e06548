#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/angles.h"
#include "base/text.h"
#include "image/surface_file.h"
#include "paints.h"

namespace goniochrome::tool {

namespace {

using render::Projection;

const std::array<std::pair<const char*, Projection>, 7> kProjections = {{{"uv", Projection::kOwn},
                                                                         {"planar", Projection::kPlanar},
                                                                         {"box", Projection::kBox},
                                                                         {"triplanar", Projection::kFacet},
                                                                         {"cylinder", Projection::kCylinder},
                                                                         {"sphere", Projection::kSphere},
                                                                         {"decal", Projection::kDecal}}};
const std::array<const char*, 5> kWords = {"project", "axis", "scale", "center", "turn"};

const char* name_of(Projection projection) {
  return std::ranges::find(kProjections, projection, &std::pair<const char*, Projection>::second)->first;
}

// PART=FILE[*N][,WORD=VALUE...], as it is written.
struct Texture {
  std::string part, file;
  double repeat = 1;
  std::map<std::string, std::string> words;
};

Error wrong(const std::string& option, const std::string& why) {
  return usage_error("--texture is \"{}\": {}", option, why);
}

// Where the first ,WORD= begins.
std::size_t words_of(const std::string& text) {
  std::size_t first = std::string::npos;
  for (const char* word : kWords) first = std::min(first, text.find(fmt::format(",{}=", word)));
  return first;
}

Result<Texture> parsed(const std::string& option) {
  const auto equals = option.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == option.size())
    return wrong(option, "write PART=FILE.exr, or PART=FILE.exr*N to lay it N times");
  Texture texture{option.substr(0, equals), option.substr(equals + 1), 1, {}};
  if (const auto comma = words_of(texture.file); comma != std::string::npos) {
    const std::string rest = texture.file.substr(comma + 1);
    texture.file.resize(comma);
    std::string last;
    for (const std::string_view piece : split(rest, ',')) {
      const auto at = piece.find('=');
      if (at == std::string_view::npos) {
        texture.words[last] += "," + std::string(piece);  // of a value with commas
        continue;
      }
      last = piece.substr(0, at);
      if (std::ranges::find(kWords, last) == kWords.end())
        return wrong(option, fmt::format("\"{}\" is none of project, axis, scale, center and turn", last));
      texture.words[last] = piece.substr(at + 1);
    }
  }
  if (const auto star = texture.file.rfind('*'); star != std::string::npos) {
    const auto times = parse_number(texture.file.substr(star + 1));
    if (!times || *times <= 0) return wrong(option, "the number after * must be above 0");
    texture.repeat = *times;
    texture.file.resize(star);
  }
  return texture;
}

// x, y, z with or without a sign, or three numbers.
std::optional<Vec3> vector_of(const std::string& text) {
  const bool negative = text.starts_with('-'), is_signed = negative || text.starts_with('+');
  const std::string letter = lower(text).substr(is_signed ? 1 : 0);
  Vec3 result;
  if (letter == "x" || letter == "y" || letter == "z") {
    result[letter[0] - 'x'] = negative ? -1 : 1;
    return result;
  }
  const auto numbers = split(text, ',');
  if (numbers.size() != 3) return std::nullopt;
  for (int c = 0; c < 3; ++c) {
    const auto number = parse_number(numbers[static_cast<std::size_t>(c)]);
    if (!number) return std::nullopt;
    result[c] = *number;
  }
  return result;
}

mesh::Box box_of(const mesh::Mesh& mesh, const std::vector<std::size_t>& parts) {
  mesh::Box box = mesh::kEmptyBox;
  for (const std::size_t part : parts)
    for (std::size_t i = mesh.parts[part].first; i < mesh.parts[part].first + mesh.parts[part].count; ++i)
      for (const std::uint32_t vertex : mesh.triangles[i]) box.add(mesh.positions[vertex]);
  return box;
}

// True if texture coordinates lay any of the part out: those that are the same everywhere do not.
bool has_coordinates(const mesh::Mesh& mesh, std::size_t part) {
  if (mesh.texture.empty()) return false;
  const auto& first = mesh.texture[mesh.triangles[mesh.parts[part].first][0]];
  for (std::size_t i = mesh.parts[part].first; i < mesh.parts[part].first + mesh.parts[part].count; ++i)
    for (const std::uint32_t vertex : mesh.triangles[i])
      if (mesh.texture[vertex] != first) return true;
  return false;
}

// The least width at which a texture covers the box in the projection along the axis.
double covering_width(const mesh::Box& box, const render::TextureLaying& laying) {
  const auto [across, up] = render::texture_axes(laying.axis, laying.turn_rad);
  const Vec3 size = box.size();
  const auto extent = [&](const Vec3& way) {
    return std::abs(way.x) * size.x + std::abs(way.y) * size.y + std::abs(way.z) * size.z;
  };
  return std::max(extent(across), extent(up) / laying.aspect);
}

// The meaning of the words, completed by values that suit the box of the parts.
Result<render::TextureLaying> laying_of(const std::string& option, const Texture& texture, Projection projection,
                                        const mesh::Box& box, const brdf::SbrdfTexture& map) {
  render::TextureLaying laying;
  laying.projection = projection;
  laying.aspect = static_cast<double>(map.height) / map.width;
  laying.ends = !map.alpha.empty();
  const bool boxed = projection == Projection::kBox || projection == Projection::kFacet;
  laying.half_texel_u = 0.5 / map.width, laying.half_texel_v = 0.5 / map.height;
  laying.center = box.middle();
  const Vec3 size = box.size();
  const auto word = [&](const char* name) -> const std::string* {
    const auto found = texture.words.find(name);
    return found == texture.words.end() ? nullptr : &found->second;
  };
  if (const std::string* text = word("axis")) {
    const auto axis = vector_of(*text);
    if (boxed) return wrong(option, "a box has no axis: leave axis out, or take planar");
    if (!axis || !(length(*axis) > 0)) return wrong(option, "axis is x, y, z, -x, -y, -z or three numbers");
    laying.axis = normalized(*axis);
  } else if (projection == Projection::kPlanar) {
    // The thinnest side of the box.
    laying.axis = size.x <= size.y && size.x <= size.z ? Vec3{1, 0, 0}
                  : size.y <= size.z                   ? Vec3{0, 1, 0}
                                                       : Vec3{0, 0, 1};
  }
  if (const std::string* text = word("center")) {
    const auto center = vector_of(*text);
    if (!center || text->find(',') == std::string::npos)
      return wrong(option, "center is a place of the mesh, such as center=0,0.5,1");
    laying.center = *center;
  }
  if (const std::string* text = word("turn")) {
    const auto turn = parse_number(*text);
    if (!turn) return wrong(option, "turn is a number of degrees");
    laying.turn_rad = *turn * kDegree;
  }
  const std::string* text = word("scale");
  const auto scale = text == nullptr ? std::optional<double>(0) : parse_number(*text);
  if (!scale || (text != nullptr && !(*scale > 0)))
    return wrong(option, "scale is the width of the texture in units of the mesh, above 0");
  const bool turns = projection == Projection::kCylinder || projection == Projection::kSphere;
  laying.radius = std::max(0.5 * length(size - dot(size, laying.axis) * laying.axis) / std::sqrt(2.0), 1e-300);
  laying.around = std::max(1.0, std::round(*scale > 0 ? 2 * kPi * laying.radius / *scale
                                           : turns    ? texture.repeat
                                                      : 1.0));
  if (*scale > 0)
    laying.width = *scale;
  else if (boxed)
    laying.width = box.longest_side();
  else if (!turns)
    laying.width = covering_width(box, laying);
  laying.width = std::max(laying.width, 1e-300);
  if (!turns) laying.width /= texture.repeat;
  if (projection == Projection::kDecal && texture.repeat != 1)
    return wrong(option, "a decal is laid once: leave * out, or take planar");
  return laying;
}

// The three facets of a triplanar projection are three textures that are blended.
std::vector<render::LaidTexture> facets_of(const render::LaidTexture& laid) {
  if (laid.laying.projection != Projection::kFacet) return {laid};
  std::vector<render::LaidTexture> facets(3, laid);
  for (int facet = 0; facet < 3; ++facet) {
    facets[static_cast<std::size_t>(facet)].laying.facet = facet;
    facets[static_cast<std::size_t>(facet)].blends = facet > 0;
  }
  return facets;
}

// Lays a map on a part: over what lies there if it has alpha, else in its place.
Result<void> lay(const std::string& option, const Texture& texture, const render::LaidTexture& laid, std::size_t part,
                 DressedMesh& dress) {
  render::PartSurface& surface = dress.surfaces[part];
  const std::vector<render::LaidTexture> facets = facets_of(laid);
  if (laid.texture->alpha.empty()) {
    dress.paints[part] = {};
    dress.anisotropy[part] = {};
    dress.worn[part].reset();
    dress.names[part] = texture.file;
    surface = {};
  }
  if (surface.textures.size() + facets.size() > render::kMostLaid)
    return wrong(option,
                 fmt::format("a part takes {} maps at most, of which a triplanar one counts three", render::kMostLaid));
  surface.textures.insert(surface.textures.end(), facets.begin(), facets.end());
  return {};
}

}  // namespace

Result<void> lay_textures(const mesh::Mesh& mesh, const Options& options, DressedMesh& dress) {
  for (const std::string& option : options.textures) {
    GONIO_ASSIGN(const Texture texture, parsed(option));
    GONIO_ASSIGN(const std::vector<std::size_t> parts, parts_of(mesh, texture.part));
    const bool placed = std::ranges::all_of(parts, [&](std::size_t part) { return has_coordinates(mesh, part); });
    Projection projection = placed ? Projection::kOwn : Projection::kBox;
    if (const auto word = texture.words.find("project"); word != texture.words.end()) {
      const auto known = std::ranges::find_if(kProjections, [&](const auto& p) { return word->second == p.first; });
      if (known == kProjections.end())
        return wrong(
            option,
            fmt::format("there is no projection \"{}\": give uv, planar, box, triplanar, cylinder, sphere or decal",
                        word->second));
      projection = known->second;
      if (projection == Projection::kOwn && !placed)
        return input_error(
            "{}: the mesh has no texture coordinates there: give project=box, triplanar, planar, cylinder, sphere or "
            "decal",
            texture.part);
    } else if (!placed) {
      dress.unplaced.push_back(texture.part);
    }
    if (projection == Projection::kOwn && texture.words.size() > texture.words.count("project"))
      return wrong(option,
                   "texture coordinates have no axis, scale, center and turn: name a projection, as project=planar");
    GONIO_ASSIGN(brdf::SbrdfTexture map, image::read_sbrdf(texture.file));
    dress.textures.push_back(std::make_shared<brdf::SbrdfTexture>(std::move(map)));
    GONIO_ASSIGN(const render::TextureLaying laying,
                 laying_of(option, texture, projection, box_of(mesh, parts), *dress.textures.back()));
    const double repeat = projection == Projection::kOwn ? texture.repeat : 1;
    for (const std::size_t part : parts) {
      if (dress.panes[part])
        return wrong(option,
                     fmt::format("--part makes \"{}\" glass, which has no place for a texture: leave out one of both",
                                 mesh.parts[part].name));
      GONIO_TRY(lay(option, texture, {dress.textures.back().get(), repeat, laying, false}, part, dress));
    }
    const bool flat =
        projection != Projection::kOwn && projection != Projection::kCylinder && projection != Projection::kSphere;
    LaidTexture laid{texture.part, texture.file, name_of(projection), std::nullopt};
    if (flat) laid.width = laying.width;
    dress.laid.push_back(laid);
  }
  return {};
}

}  // namespace goniochrome::tool
