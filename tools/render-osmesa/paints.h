// Which part wears which paint.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "fit/paint_fit.h"
#include "formats/basis.h"
#include "mesh/mesh.h"
#include "paint/paint.h"
#include "render/surface_layer.h"
#include "tool.h"

namespace goniochrome::tool {

// How a map of --texture lies on its parts.
struct LaidTexture {
  std::string part, file, projection;
  std::optional<double> width;  // of the map in units of the mesh, where it is projected along an axis
};

inline constexpr const char* kTrimName = "trim";  // stands for a paint in the parts that --trim dresses

struct DressedMesh {
  std::vector<paint::LobeFit> paints;         // for each part of the mesh
  std::vector<double> gloss_deg;              // at which their gloss was read; 45 where it was not
  std::vector<paint::Anisotropy> anisotropy;  // alpha 0 where there is none
  std::vector<render::PartSurface> surfaces;  // textures and color maps, held by the two below
  std::vector<std::shared_ptr<const brdf::SbrdfTexture>> textures;
  std::vector<std::shared_ptr<const brdf::ColorMap>> color_maps;
  std::vector<std::shared_ptr<const paint::Paint>> worn;  // as they were read; null where none was
  std::vector<std::string> names;                         // of those paints; "" where none was given
  std::vector<LaidTexture> laid;
  std::vector<bool> panes;             // for each part, whether it is clear glass that is seen through
  std::vector<std::string> unplaced;   // parts of --texture without texture coordinates, of which nothing was said
  std::vector<std::size_t> trim;       // the parts that --trim recognized
  std::vector<std::string> remarks;    // about the files of paints
  std::vector<std::string> fitted;     // a line about each paint that was fitted
  std::vector<std::string> unpainted;  // names of the parts that wear the gray of unpainted parts
};

// Six of the names at most: "a, b, ...".
std::string first_names(std::vector<std::string> names);

// Resolves --part and --paint. Finishes of --trim mirror where `with_mirrors`. Error: an unknown part, paint or file,
// or a paint without lobes, with what there is.
Result<DressedMesh> dressed(const mesh::Mesh& mesh, const Options& options, bool with_mirrors);

// Lays the maps of --texture on the mesh. A part without texture coordinates gets its map by a box unless the option
// says how. Error: an unknown part or word, a map that cannot be read, or `project=uv` where there are no coordinates.
Result<void> lay_textures(const mesh::Mesh& mesh, const Options& options, DressedMesh& dress);

// Fits paints as fit-paint(1) does without further options, to --basis or the default basis.
class Fitting {
 public:
  // Error: the file of --basis cannot be read.
  static Result<Fitting> of(const Options& options);
  // The fitter, which is made when the first paint needs it.
  const fit::PaintFitter& fitter();

 private:
  explicit Fitting(formats::Basis basis) : basis_(std::move(basis)) {}
  formats::Basis basis_;
  std::optional<fit::PaintFitter> fitter_;
};

// The error with the name of the paint in front, unless it is told with its name already.
Error about_paint(const Error& error, const std::string& name);

// The paint with its lobes, which are fitted where it has none. Error: nothing to fit; `file` is where it comes from.
Result<paint::Paint> with_lobes(paint::Paint paint, Fitting& fitting, const std::string& file);

// The color map that a paint of `file` names, or null.
Result<std::shared_ptr<const brdf::ColorMap>> color_map_of(const paint::Paint& paint, const std::string& file);

// Puts the paint on a part. A map must outlive the mesh.
void put_on(std::size_t part, const paint::Paint& paint, const brdf::ColorMap* map, DressedMesh& dress);

// FILE#NAME, which has lobes or can be fitted. The session tells remarks about the file.
Result<paint::Paint> paint_named(const std::string& reference, const Options& options, cli::Session& session);

// The parts that a word means: the part of that name, or all of that material. Error (usage): what there is.
Result<std::vector<std::size_t>> parts_of(const mesh::Mesh& mesh, const std::string& word);

// The radiance of each part by --emit. Error: an unknown part.
struct Emission;
Result<std::vector<color::Rgb>> emission_of(const mesh::Mesh& mesh, const std::vector<Emission>& emissions);

}  // namespace goniochrome::tool
