#include "paints.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/angles.h"
#include "base/paths.h"
#include "base/text.h"
#include "formats/default_basis.h"
#include "formats/paint_source.h"
#include "formats/reference.h"
#include "image/surface_file.h"
#include "render/panes.h"
#include "render/trim.h"
#include "setup.h"

namespace goniochrome::tool {

namespace {

constexpr double kUnpaintedReflectance = 0.18;
constexpr double kUnreadGlossDeg = 45;
// The word that --part takes in the place of a paint, for glass that is seen through.
constexpr const char* kGlass = "glass";

// Up to `most` names, in order, then how many there are.
std::string listed(const std::vector<std::string>& names, std::size_t most = 12) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > most ? fmt::format("{}, ... ({} in all)", text, names.size()) : text;
}

// `did you mean "X"? `, or nothing.
std::string nearest_of(const std::string& wanted, const std::vector<std::string>& names) {
  const auto distance = [&](const std::string& name) { return edit_distance(lower(wanted), lower(name)); };
  const auto nearest = std::ranges::min_element(names, {}, distance);
  if (nearest == names.end() || distance(*nearest) > std::max<std::size_t>(2, wanted.size() / 3)) return "";
  return fmt::format("did you mean \"{}\"? ", *nearest);
}

// The place in `names` of the paint that FILE#NAME means, where NAME may be a pattern that one name meets.
Result<std::size_t> place_of(const std::string& file, const std::string& name, const std::vector<std::string>& names) {
  const auto same = std::find(names.begin(), names.end(), name);
  if (same != names.end()) return static_cast<std::size_t>(same - names.begin());
  formats::NameChoice choice(name);
  std::vector<std::size_t> places;
  std::vector<std::string> met;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (choice.takes(names[i])) places.push_back(i), met.push_back(names[i]);
  if (places.size() == 1) return places.front();
  if (places.empty())
    return input_error("{} holds no paint \"{}\": {}it holds {}", file, name, nearest_of(name, names), listed(names));
  return usage_error("{}#{} means {} paints, and one is wanted: write {}#NAME for one of them: {}", file, name,
                     places.size(), file, listed(met));
}

// A file that is named beside another one.
std::string path_beside(const std::string& file, const std::string& name) {
  return (std::filesystem::path(file).parent_path() / name).string();
}

// True if somebody may have meant kGlass, and no file.
bool is_like_glass(const std::string& file) {
  return edit_distance(lower(file), kGlass) <= 2 && !is_there(file);
}

// A finish in the place of a paint.
void put_finish(std::size_t part, const paint::LobeFit& finish, const char* name, DressedMesh& dress) {
  dress.paints[part] = finish, dress.gloss_deg[part] = kUnreadGlossDeg;
  dress.anisotropy[part] = {}, dress.surfaces[part] = {}, dress.names[part] = name;
  dress.worn[part].reset();
}

// The paints of all files named, each file read once.
class PaintShelf {
 public:
  explicit PaintShelf(Fitting fitting) : fitting_(std::move(fitting)) {}

  // `reference` is FILE or FILE#NAME.
  Result<paint::Paint> paint(const std::string& reference) {
    const auto [file, name] = formats::paint_reference(reference);
    if (!files_.contains(file)) {
      if (!name && is_like_glass(file))
        return usage_error("there is no file \"{}\": for glass that is seen through write PART={}", file, kGlass);
      GONIO_ASSIGN(files_[file], formats::read_paints(file, &remarks_));
    }
    const std::vector<paint::Paint>& paints = files_[file];
    if (paints.empty()) return input_error("{}: holds no paint", file);
    std::vector<std::string> names;
    for (const paint::Paint& paint : paints) names.push_back(paint.name);
    if (!name) {
      if (paints.size() == 1) return fitted(paints.front(), file);
      return usage_error(
          "{} holds {} paints: write {}#NAME for one of them, braces in --output for a picture of each, as in "
          "-o '{{name}}.png', or --sheet 3x3: it holds {}",
          file, paints.size(), file, listed(names));
    }
    GONIO_ASSIGN(const std::size_t place, place_of(file, *name, names));
    return fitted(paints[place], file);
  }

  // The color map that the paint of a reference names, relative to its file; null where it names none.
  Result<const brdf::ColorMap*> color_map(const std::string& reference, const paint::Paint& paint) {
    if (!paint.color_map) return static_cast<const brdf::ColorMap*>(nullptr);
    const std::string file = formats::paint_reference(reference).file;
    std::shared_ptr<const brdf::ColorMap>& map = maps_[path_beside(file, paint.color_map->href)];
    if (map == nullptr) {
      GONIO_ASSIGN(map, color_map_of(paint, file));
    }
    return map.get();
  }
  const std::vector<std::string>& remarks() const { return remarks_; }
  const std::vector<std::string>& fits() const { return fitted_; }
  std::vector<std::shared_ptr<const brdf::ColorMap>> color_maps() const {
    std::vector<std::shared_ptr<const brdf::ColorMap>> all;
    for (const auto& [path, map] : maps_) all.push_back(map);
    return all;
  }

 private:
  // Each paint is fitted once, however many parts wear it.
  Result<paint::Paint> fitted(const paint::Paint& paint, const std::string& file) {
    if (paint.lobes) return paint;
    const std::string key = file + "#" + paint.name;
    if (const auto known = ready_.find(key); known != ready_.end()) return known->second;
    GONIO_ASSIGN(paint::Paint ready, with_lobes(paint, fitting_, file));
    fitted_.push_back(fmt::format("{} of {}: fitted to {}, dE00 {:.2f} in the mean and {:.2f} at most at its readings",
                                  shown(paint.name), file, ready.lobes->basis, ready.lobes->mean_de00,
                                  ready.lobes->max_de00));
    return ready_[key] = std::move(ready);
  }

  Fitting fitting_;
  std::map<std::string, paint::Paint> ready_;
  std::vector<std::string> remarks_, fitted_;
  std::map<std::string, std::vector<paint::Paint>> files_;
  std::map<std::string, std::shared_ptr<const brdf::ColorMap>> maps_;
};

struct Assignment {
  std::string part, reference;
};

Result<std::vector<Assignment>> assignments(const std::vector<std::string>& options) {
  std::vector<Assignment> all;
  for (const std::string& option : options) {
    const auto equals = option.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == option.size()) {
      return usage_error("--part is \"{}\": write PART=FILE.xml#PAINT", option);
    }
    all.push_back({option.substr(0, equals), option.substr(equals + 1)});
  }
  return all;
}

}  // namespace

std::string first_names(std::vector<std::string> names) {
  constexpr std::size_t kMost = 6;
  if (names.size() > kMost) names.resize(kMost + 1), names.back() = "...";
  return joined(names, ", ");
}

Result<std::vector<std::size_t>> parts_of(const mesh::Mesh& mesh, const std::string& word) {
  std::vector<std::size_t> named, made_of;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    if (mesh.parts[i].name == word) named.push_back(i);
    if (mesh.parts[i].material == word) made_of.push_back(i);
  }
  if (!named.empty()) return named;
  if (!made_of.empty()) return made_of;
  std::vector<std::string> parts, materials;
  for (const mesh::MeshPart& part : mesh.parts) {
    parts.push_back(part.name);
    const bool is_new = std::find(materials.begin(), materials.end(), part.material) == materials.end();
    if (is_new && !part.material.empty()) materials.push_back(part.material);
  }
  if (std::ranges::find(mesh.repairs.parts_dropped, word) != mesh.repairs.parts_dropped.end())
    return input_error("the part \"{}\" has no area: each of its faces is a line or a point, and none is drawn", word);
  std::vector<std::string> both = parts;
  both.insert(both.end(), materials.begin(), materials.end());
  return usage_error("the mesh has no part or material \"{}\": {}its parts are {}{}", word, nearest_of(word, both),
                     listed(parts), materials.empty() ? "" : "; its materials are " + listed(materials, 30));
}

Result<Fitting> Fitting::of(const Options& options) {
  GONIO_ASSIGN(formats::Basis basis, formats::basis_or_default(options.basis));
  return Fitting(std::move(basis));
}

const fit::PaintFitter& Fitting::fitter() {
  if (!fitter_) fitter_.emplace(basis_, fit::FitOptions{});
  return *fitter_;
}

Error about_paint(const Error& error, const std::string& name) {
  const std::string quoted = fmt::format("\"{}\"", shown(name));
  if (error.message.find(quoted) != std::string::npos) return error;
  // Some are told with the bare name in front, as is said of a mesh with several paints.
  const std::string bare = name + ": ";
  const std::size_t begin = error.message.starts_with(bare) ? bare.size() : 0;
  return {error.kind, fmt::format("the paint {}: {}", quoted, error.message.substr(begin))};
}

Result<paint::Paint> with_lobes(paint::Paint paint, Fitting& fitting, const std::string& file) {
  if (paint.lobes) return paint;
  auto fit = fitting.fitter().fit(paint);
  if (!fit.ok()) {
    const Error error = about_paint(fit.error(), paint.name);
    return Error{error.kind, fmt::format("{}: {}", file, error.message)};
  }
  if (fit->lobes.coat_index != paint::kNoCoat) paint.coat_index = fit->lobes.coat_index;
  paint.lobes = std::move(fit->lobes);
  return paint;
}

Result<std::shared_ptr<const brdf::ColorMap>> color_map_of(const paint::Paint& paint, const std::string& file) {
  if (!paint.color_map) return std::shared_ptr<const brdf::ColorMap>();
  GONIO_ASSIGN(brdf::ColorMap map, image::read_color_map(path_beside(file, paint.color_map->href)));
  map.index = paint.color_map->index;
  return std::shared_ptr<const brdf::ColorMap>(std::make_shared<brdf::ColorMap>(std::move(map)));
}

void put_on(std::size_t part, const paint::Paint& paint, const brdf::ColorMap* map, DressedMesh& dress) {
  dress.paints[part] = *paint.lobes;
  if (map == nullptr) dress.paints[part].tilts.clear();  // they stand for a map
  dress.gloss_deg[part] = paint.gloss.empty() ? kUnreadGlossDeg : paint.gloss.front().angle_deg;
  dress.anisotropy[part] = paint.anisotropy.value_or(paint::Anisotropy{});
  dress.surfaces[part] = {{}, map};
  dress.names[part] = paint.name;
}

Result<DressedMesh> dressed(const mesh::Mesh& mesh, const Options& options, bool with_mirrors) {
  GONIO_ASSIGN(Fitting fitting, Fitting::of(options));
  PaintShelf shelf(std::move(fitting));
  paint::LobeFit gray;
  gray.diffuse = (kUnpaintedReflectance / kPi) * color::Rgb{1, 1, 1};
  const std::size_t parts_there = mesh.parts.size();
  DressedMesh result;
  result.paints.assign(parts_there, gray);
  result.gloss_deg.assign(parts_there, kUnreadGlossDeg);
  result.anisotropy.resize(parts_there);
  result.surfaces.resize(parts_there);
  result.worn.resize(parts_there);
  result.names.resize(parts_there);
  result.panes.assign(parts_there, false);
  const auto wear = [&](std::size_t part, const paint::Paint& paint, const brdf::ColorMap* map) {
    put_on(part, paint, map, result);
    result.worn[part] = std::make_shared<const paint::Paint>(paint);
  };
  if (!options.paint.empty()) {
    GONIO_ASSIGN(const paint::Paint paint, shelf.paint(options.paint));
    GONIO_ASSIGN(const brdf::ColorMap* map, shelf.color_map(options.paint, paint));
    for (std::size_t part = 0; part < mesh.parts.size(); ++part) wear(part, paint, map);
  }
  for (std::size_t part = 0; options.trim && part < mesh.parts.size(); ++part) {
    const auto trim = render::trim_of(mesh.parts[part], with_mirrors);
    if (!trim) continue;
    result.trim.push_back(part);
    put_finish(part, *trim, kTrimName, result);
  }
  // A part's own name is meant before its material, wherever it stands on the command line.
  GONIO_ASSIGN(const std::vector<Assignment> all, assignments(options.parts));
  for (const bool by_name : {false, true}) {
    for (const Assignment& assignment : all) {
      GONIO_ASSIGN(const std::vector<std::size_t> parts, parts_of(mesh, assignment.part));
      if ((mesh.parts[parts.front()].name == assignment.part) != by_name) continue;
      const bool is_glass = assignment.reference == kGlass;
      for (const std::size_t part : parts) {
        result.panes[part] = is_glass;
        if (is_glass) put_finish(part, render::pane_finish(), kGlass, result);
      }
      if (is_glass) continue;
      GONIO_ASSIGN(const paint::Paint paint, shelf.paint(assignment.reference));
      GONIO_ASSIGN(const brdf::ColorMap* map, shelf.color_map(assignment.reference, paint));
      for (const std::size_t part : parts) wear(part, paint, map);
    }
  }
  result.color_maps = shelf.color_maps();
  result.remarks = shelf.remarks(), result.fitted = shelf.fits();
  GONIO_TRY(lay_textures(mesh, options, result));
  for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
    if (result.names[part].empty()) result.unpainted.push_back(mesh.parts[part].name);
  }
  return result;
}

Result<paint::Paint> paint_named(const std::string& reference, const Options& options, cli::Session& session) {
  GONIO_ASSIGN(Fitting fitting, Fitting::of(options));
  PaintShelf shelf(std::move(fitting));
  GONIO_ASSIGN(paint::Paint paint, shelf.paint(reference));
  for (const std::string& remark : shelf.remarks()) session.warn(remark);
  for (const std::string& line : shelf.fits()) session.say(line);
  return paint;
}

Result<std::vector<color::Rgb>> emission_of(const mesh::Mesh& mesh, const std::vector<Emission>& emissions) {
  std::vector<color::Rgb> all(emissions.empty() ? 0 : mesh.parts.size());
  for (const Emission& emission : emissions) {
    GONIO_ASSIGN(const std::vector<std::size_t> parts, parts_of(mesh, emission.part));
    for (const std::size_t part : parts) all[part] = emission.radiance;
  }
  return all;
}

}  // namespace goniochrome::tool
