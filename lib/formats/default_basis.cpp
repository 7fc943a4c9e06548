#include "formats/default_basis.h"

namespace goniochrome::formats {

Basis default_basis() {
  return {"b7", {1.3, 6, 20, 70, 250, 900, 3000}, true, {}};
}

Result<Basis> basis_or_default(const std::string& path) {
  return path.empty() ? Result<Basis>(default_basis()) : read_basis(path);
}

}  // namespace goniochrome::formats
