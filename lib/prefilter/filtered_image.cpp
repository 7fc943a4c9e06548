#include "prefilter/filtered_image.h"

#include "base/clock.h"
#include "base/digest.h"
#include "base/file.h"
#include "base/text.h"
#include "envmap/env_content.h"
#include "envmap/environment.h"
#include "envmap/open_maps.h"
#include "envmap/remarks.h"
#include "image/image.h"
#include "prefilter/prefilter.h"

namespace goniochrome::prefilter {

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{2} << 30;

// The key of the maps that a request makes of an image. The layer of an EXR stands in its path.
Result<std::string> key_of(const std::string& path, const PrefilterRequest& request, const std::string& version) {
  std::vector<std::string> files = {image::image_file(path)};
  if (path.find("{face}") != std::string::npos) {
    GONIO_ASSIGN(files, envmap::face_paths(path));
  }
  Digest digest;
  digest.add(std::string_view(version));
  digest.add(request.tolerance);
  digest.add(static_cast<std::uint64_t>(request.spots));
  for (const double exponent : request.exponents) digest.add(exponent);
  digest.add(std::string_view(path).substr(files.size() == 1 ? files.front().size() : path.size()));
  for (const std::string& file : files) {
    GONIO_ASSIGN(const std::string content, file_content(file));
    digest.add(std::string_view(content));
  }
  return digest.hex();
}

}  // namespace

FileCache filtered_images(std::string folder) {
  return {std::move(folder), ".env.exr", kMostBytes};
}

Result<FilteredImage> filtered_image(const std::string& path, const std::vector<double>& exponents,
                                     const std::string& version, const FileCache* cache,
                                     const std::function<bool(double)>& is_wanted) {
  PrefilterRequest request;
  request.exponents = filter_exponents(exponents);
  FilteredImage filtered;
  std::string key;
  if (cache != nullptr) {
    GONIO_ASSIGN(key, key_of(path, request, version));
    if (const auto content = cache->find(key)) {
      if (auto env = envmap::env_of_content(*content, path, is_wanted); env.ok()) {
        filtered.env = *std::move(env), filtered.env.source = path;
        filtered.was_kept = true;
        return filtered;
      }
    }
  }
  const Stopwatch clock;
  GONIO_ASSIGN(const envmap::Environment image,
               envmap::Environment::read(path, envmap::Environment::BadPixels::kError));
  filtered.remarks = envmap::remarks(image);
  envmap::PrefilteredEnvironment env =
      prefiltered(image, request, prefilter_plan(image, request), [](const envmap::PrefilteredLobe&, double) {});
  envmap::keep_open_maps(env);
  // One image may be there under several names.
  env.source.clear();
  GONIO_ASSIGN(const std::string content, envmap::env_content(path, env, "goniochrome " + version));
  filtered.time_s = clock.elapsed_s();
  if (cache != nullptr) {
    if (const auto kept = cache->keep(key, content); !kept.ok()) filtered.not_kept = kept.error().message;
  }
  GONIO_ASSIGN(filtered.env, envmap::env_of_content(content, path, is_wanted));
  filtered.env.source = path;
  return filtered;
}

}  // namespace goniochrome::prefilter
