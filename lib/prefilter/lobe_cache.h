// Keeps the maps of lobes in a folder, so that a later run with the same environment need not filter it again. The name
// of a file is made of all that shapes the map: the radiance of the environment, the turn, the exponent, the size, the
// layout, the tolerance and the version of the program.
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "prefilter/prefilter.h"

namespace goniochrome::prefilter {

class LobeCache {
 public:
  // Opens a folder, and makes it if it is not there. Error: it cannot be made, or it is no folder.
  static Result<LobeCache> open(const std::string& folder, const envmap::Environment& env,
                                const PrefilterRequest& request, const std::string& version);

  // A lobe with the errors and the method that it was kept with, or nothing; a file that does not fit, or of which a byte
  // changed, counts as nothing.
  std::optional<envmap::PrefilteredLobe> find(const LobePlan& plan) const;

  // Writes a lobe, whose values envmap::round_to_storage() rounded, into the folder, whole or not at all. Error: the file and the system's reason.
  Result<void> keep(const envmap::PrefilteredLobe& lobe) const;

 private:
  LobeCache(std::string folder, std::string key, envmap::SphereGrid::Layout layout)
      : folder_(std::move(folder)), key_(std::move(key)), layout_(layout) {}
  std::string path(double exponent, int size) const;

  std::string folder_, key_;
  envmap::SphereGrid::Layout layout_;
};

}  // namespace goniochrome::prefilter
