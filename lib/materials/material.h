// Paints as the materials of other renderers. A target writes the lobes of a paint in the terms of another program, and
// tells what that program will show of it, by the program's own model. goniochrome-export(7), "EXPORT".
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::materials {

// How far the target is from the lobes of the paint at one geometry.
struct DifferenceAt {
  paint::Geometry geometry;
  double de00 = 0;
};

// Errors of the target, in CIEDE2000 under the condition of the paint. The mirror direction is not among the
// geometries, since no instrument reads there.
struct Shown {
  double de00_mean = 0, de00_max = 0;  // over compared_geometries(), from the lobes of the paint
  std::vector<DifferenceAt> by_geometry;
  std::optional<double> readings_de00_mean;  // from the paint's own readings, where it has any
};

// The geometries at which every target is compared: light at 15, 45 and 65 deg, viewers in the plane of incidence from
// 15 to 110 deg off the mirror direction, and one out of it.
const std::vector<paint::Geometry>& compared_geometries();

// Names of the paint in a file.
struct Naming {
  std::string identifier;  // letters, digits and underscores: a name in every format
  std::string display;     // the paint's own name
  std::string provenance;  // the tool, its version and its command line
  std::string file_stem;   // of the file without folder and ending, for a file that names another one
};

struct Material {
  std::string bytes;  // of the file
  Shown shown;
  std::string companion = {};              // bytes of the second file, of targets that have one
  std::vector<std::string> left_out = {};  // what of the paint has no place in this target, as left_out() words it
};

struct Target {
  const char* name;    // on the command line
  const char* ending;  // of its files, with the dot
  const char* what;    // for people: what the file is and who reads it
  // The file for a fitted paint. Error: the paint has no lobes.
  Result<Material> (*material)(const paint::Paint& paint, const Naming& naming);
  const char* companion = nullptr;  // ending of a second file beside the first, behind the name without an ending
  std::size_t at_once = 16;         // files to make and hold side by side; large ones are fewer
  bool has_flakes = false;          // the file states the flakes of the paint
};
extern const Target kRgl, kRglSpectral, kMaterialX, kGltf, kUsd, kStandardSurface, kOpenPbr, kOpenPbrUsd, kMdl,
    kMdlAcescg, kRadiance, kEnterprise, kOpenMaterial;

// All targets, in the order in which help names them.
std::span<const Target* const> targets();

// Names what the target cannot take along of a paint, as parts of a sentence: "its color map". Empty for most paints.
std::vector<std::string> left_out(const paint::Paint& paint, const Target& target);

// Makes identifiers out of names, each only once in its life and unlike all others also where a file system does not
// tell capitals from small letters.
class Identifiers {
 public:
  // `name` with an underscore in place of everything but ASCII letters, digits and underscores; cut to 64 letters; with
  // an underscore before a digit; and with a number behind it where it is already taken.
  std::string of(std::string_view name);

 private:
  std::set<std::string> taken_;
};

}  // namespace goniochrome::materials
