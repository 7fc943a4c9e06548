// The data of a page as JSON. Numbers of meshes, maps and weights stand beside it, and the JSON has their places.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "envmap/prefiltered.h"
#include "formats/basis.h"
#include "mesh/mesh.h"
#include "numbers.h"
#include "paint/paint.h"

namespace goniochrome::tool {

// The paints of a page: an index that the compiled library searches, and a line of JSON for each paint. Lines of paints
// that hold nothing but readings and gloss are lists: the number of their layout, name, code, class, and then the
// numbers of all rows and gloss readings in the layout's order. Other lines are objects of file and paint.
class PackedLibrary {
 public:
  // Takes a paint of a file of that name.
  void add(const std::string& file, const paint::Paint& paint);
  std::size_t size() const { return paints_.size(); }
  const std::vector<paint::Paint>& paints() const { return paints_; }
  const std::string& lines() const { return lines_; }
  const Json& layouts() const { return layouts_; }
  // The content of its index. Error: a paint whose metrics cannot be computed.
  Result<std::string> index() const;

 private:
  std::vector<paint::Paint> paints_;
  std::string lines_;
  Json layouts_ = Json::array();
  std::map<std::string, std::size_t> numbers_;  // of layouts, by their text
};

// Positions as 16 bits within the bounding box, normals as 16 bits an axis, and the parts with the row of their
// weights: 0 is the design, the others are finishes that nobody paints. `finishes` gets the weights of those rows.
struct PackedMesh {
  Json json;
  std::vector<paint::LobeFit> finishes;
};
PackedMesh packed_mesh(const mesh::Mesh& mesh, bool with_mirror, PackedNumbers& numbers);

// Cubes as half floats, with the program that draws by them. `white` is the luminance that exposure 0 brings to 1.
// Error: an environment that lacks a lobe of the basis.
Result<Json> packed_environment(const std::string& name, const envmap::PrefilteredEnvironment& env,
                                const formats::Basis& basis, PackedNumbers& numbers);

// The lamp that a page has beside its environments: its extent in degrees, and its disc as the programs read it.
Json packed_lamp(const formats::Basis& basis, PackedNumbers& numbers);

// The layers in which a page keeps the light of a view, and the program that draws from them.
Json packed_layers(const formats::Basis& basis);

// The rows of weights of these finishes, one behind the other, and the size of a row.
Json packed_finishes(const std::vector<paint::LobeFit>& finishes, const formats::Basis& basis, PackedNumbers& numbers);

}  // namespace goniochrome::tool
