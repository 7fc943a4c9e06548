#include "prefilter/lobe_cache.h"

#include <cstdint>
#include <filesystem>

#include "base/digest.h"
#include "base/paths.h"
#include "base/text.h"

namespace goniochrome::prefilter {

namespace {

template <class T>
const T* attribute(const image::ImagePart& part, const std::string& name) {
  const auto found = part.attributes.find(name);
  return found == part.attributes.end() ? nullptr : std::get_if<T>(&found->second);
}

// The digest of all that a kept file says.
std::string digest_of(const std::vector<float>& texels, const std::string& method, float tolerance) {
  Digest digest;
  digest.add(texels);
  digest.add(std::string_view(method));
  digest.add(static_cast<double>(tolerance));
  return digest.hex();
}

}  // namespace

Result<LobeCache> LobeCache::open(const std::string& folder, const envmap::Environment& env,
                                  const PrefilterRequest& request, const std::string& version) {
  GONIO_TRY(make_folder(folder));
  GONIO_TRY(can_be_written((std::filesystem::path(folder) / "lobe.exr").string()));
  Digest digest;
  digest.add(std::string_view(version));
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
  const auto* digest = attribute<std::string>(part, "goniochrome:digest");
  if (part.image.width != grid.width() || part.image.height != grid.height() || part.image.channels != 3 || !method ||
      !tolerance || !digest || *digest != digest_of(part.image.data, *method, *tolerance))
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
  const auto tolerance = static_cast<float>(lobe.tolerance);
  part.attributes = {{"goniochrome:method", lobe.method},
                     {"goniochrome:tolerance", tolerance},
                     {"goniochrome:digest", digest_of(lobe.map.texels, lobe.method, tolerance)}};
  return image::write_exr(path(lobe.exponent, lobe.map.size), {part});
}

}  // namespace goniochrome::prefilter
