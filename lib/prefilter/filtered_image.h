// Images of light that are filtered where a picture needs them, and kept for the next one.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/file_cache.h"
#include "base/result.h"
#include "envmap/prefiltered.h"

namespace goniochrome::prefilter {

// The user's folder for filtered images, of 2 GiB: those of about a dozen panoramas of 8192 x 4096.
FileCache filtered_images(std::string folder);

struct FilteredImage {
  envmap::PrefilteredEnvironment env;
  bool was_kept = false;             // an earlier run filtered it
  double time_s = 0;                 // of reading and filtering, where none did
  std::vector<std::string> remarks;  // about the image
  std::string not_kept;              // the reason why no later run will find it, if there is one
};

// The image of `path`, see Environment::read(), filtered by the diffuse lobe, those of the exponents and the mirror
// with the defaults of PrefilterRequest, and with the maps that follow from them (envmap/open_maps.h). A cache, unless
// it is null, knows it by the content of the image, by all that shapes the maps and by `version`, that of the program.
// Both ways give the same maps, bit for bit. `is_wanted` is that of read_env(). Error: the image cannot be read, or
// has texels that are no light; a cache that cannot be used is none.
Result<FilteredImage> filtered_image(const std::string& path, const std::vector<double>& exponents,
                                     const std::string& version, const FileCache* cache,
                                     const std::function<bool(double exponent)>& is_wanted = {});

}  // namespace goniochrome::prefilter
