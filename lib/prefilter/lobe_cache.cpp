#include "prefilter/lobe_cache.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "base/paths.h"
#include "base/text.h"

namespace goniochrome::prefilter {

namespace {

// 128 bits that stand for a stream of words: two multiplicative hashes with different odd factors. They tell maps apart
// that differ by accident, not those that somebody made alike on purpose.
class Digest {
 public:
  void add(std::uint64_t word) {
    a_ = (std::rotl(a_, 23) ^ word) * 0x9e3779b97f4a7c15U;
    b_ = (std::rotl(b_, 41) ^ word) * 0xc2b2ae3d27d4eb4fU;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const std::vector<float>& values) {
    add(values.size());
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
      std::uint64_t word = 0;
      std::memcpy(&word, &values[i], sizeof word);
      add(word);
    }
    if (values.size() % 2 == 1) add(static_cast<double>(values.back()));
  }
  void add(const std::string& text) {
    add(text.size());
    for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  }
  std::string hex() const { return fmt::format("{:016x}{:016x}", a_ ^ (a_ >> 29), b_ ^ (b_ >> 29)); }

 private:
  std::uint64_t a_ = 0x243f6a8885a308d3U, b_ = 0x13198a2e03707344U;
};

template <class T>
const T* attribute(const image::ImagePart& part, const std::string& name) {
  const auto found = part.attributes.find(name);
  return found == part.attributes.end() ? nullptr : std::get_if<T>(&found->second);
}

}  // namespace

Result<LobeCache> LobeCache::open(const std::string& folder, const envmap::Environment& env,
                                  const PrefilterRequest& request, const std::string& version) {
  GONIO_TRY(make_folder(folder));
  GONIO_TRY(can_be_written((std::filesystem::path(folder) / "lobe.exr").string()));
  Digest digest;
  digest.add(version);
  digest.add(static_cast<std::uint64_t>(env.layout()));
  digest.add(static_cast<std::uint64_t>(env.width()));
  digest.add(env.values());
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    const Vec3 turned = request.turn.to_world(axis);
    for (int c = 0; c < 3; ++c) digest.add(turned[c]);
  }
  digest.add(static_cast<std::uint64_t>(request.layout));
  digest.add(request.tolerance);
  return LobeCache(folder, digest.hex(), request.layout);
}

std::string LobeCache::path(double exponent, int size) const {
  return (std::filesystem::path(folder_) / fmt::format("{}-{}-{}.exr", key_, shortest(exponent), size)).string();
}

std::optional<envmap::PrefilteredLobe> LobeCache::find(const LobePlan& plan) const {
  const std::string file = path(plan.exponent, plan.size);
  if (!is_there(file)) return std::nullopt;
  auto parts = image::read_exr(file);
  if (!parts.ok() || parts->size() != 1) return std::nullopt;
  image::ImagePart& part = parts->front();
  const envmap::SphereGrid grid = envmap::map_grid(layout_, plan.size);
  const auto* method = attribute<std::string>(part, "goniochrome:method");
  const auto* tolerance = attribute<float>(part, "goniochrome:tolerance");
  if (part.image.width != grid.width() || part.image.height != grid.height() || part.image.channels != 3 || !method ||
      !tolerance)
    return std::nullopt;
  envmap::PrefilteredLobe lobe;
  lobe.exponent = plan.exponent;
  lobe.layout = layout_;
  lobe.predicted_error = plan.predicted_error;
  lobe.lookup_error = plan.lookup_error;
  lobe.method = *method;
  lobe.map.size = plan.size;
  lobe.map.texels = std::move(part.image.data);
  return lobe;
}

Result<void> LobeCache::keep(const envmap::PrefilteredLobe& lobe) const {
  const envmap::SphereGrid grid = envmap::map_grid(lobe.layout, lobe.map.size);
  image::ImagePart part;
  part.name = "lobe";
  part.type = envmap::storage_type(lobe);
  part.image = {grid.width(), grid.height(), 3, lobe.map.texels, {}};
  part.attributes = {{"goniochrome:method", lobe.method},
                     {"goniochrome:tolerance", static_cast<float>(lobe.tolerance)}};
  return image::write_exr(path(lobe.exponent, lobe.map.size), {part});
}

}  // namespace goniochrome::prefilter
