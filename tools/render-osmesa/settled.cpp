#include "settled.h"

#include <algorithm>

#include "base/text.h"
#include "brdf/ward.h"
#include "render/engine.h"

namespace goniochrome::tool {

namespace {

// AZ,EL[,DIST[,FOV]] or six numbers of places[,FOV].
Result<void> take_camera(Options& options) {
  std::vector<double> numbers = options.camera;
  options.camera.clear();
  if (numbers.size() == 4 || numbers.size() == 7) {
    constexpr double kLeast_deg = 1, kMost_deg = 150;
    options.fov_deg = numbers.back();
    if (!(options.fov_deg >= kLeast_deg && options.fov_deg <= kMost_deg))
      return usage_error("--camera has the field of view {}: it goes from {} to {} degrees", shortest(options.fov_deg),
                         kLeast_deg, kMost_deg);
    numbers.pop_back();
  }
  if (numbers.size() == 6) {
    options.camera = numbers;
  } else if (numbers.size() == 2 || numbers.size() == 3) {
    options.orbit = numbers;
  } else {
    return usage_error(
        "--camera has {} numbers: write AZIMUTH,ELEVATION[,DISTANCE[,FOV]], or EX,EY,EZ,TX,TY,TZ[,FOV] for where it "
        "stands and what it looks at",
        numbers.size());
  }
  return {};
}

// N[,AGAINST].
Result<void> take_check(Options& options) {
  constexpr std::int64_t kMost = 100000000;
  const auto pieces = split(options.check_text, ',');
  const auto count = parse_integer(trimmed(pieces[0]));
  const std::string against(pieces.size() > 1 ? trimmed(pieces[1]) : "auto");
  const bool known = pieces.size() == 1 || (pieces.size() == 2 && (against == "truth" || against == "model"));
  if (!count || *count < 0 || *count > kMost || !known)
    return usage_error(
        "--check is \"{}\": write how many pixels, 0 to {}, and after a comma truth or model, as in "
        "100,model",
        options.check_text, kMost);
  options.check = static_cast<int>(*count), options.check_against = against;
  return {};
}

// N or an error below 1.
Result<void> take_tilts(Options& options) {
  const auto count = parse_integer(options.tilts);
  const auto error = parse_number(options.tilts);
  if (count && *count >= 1 && *count <= brdf::kMostTilts) {
    options.most_tilts = static_cast<int>(*count), options.tilt_error = 0;
  } else if (error && *error > 0 && *error < 1) {
    options.most_tilts = brdf::kMostTilts, options.tilt_error = *error;
  } else {
    return usage_error("--tilts is \"{}\": write how many, 1 to {}, or an error between 0 and 1, as in 0.01",
                       options.tilts, brdf::kMostTilts);
  }
  return {};
}

}  // namespace

Result<Options> settled(const Options& asked) {
  Options options = asked;
  GONIO_TRY(take_camera(options));
  GONIO_TRY(take_check(options));
  GONIO_TRY(take_tilts(options));
  GONIO_ASSIGN(options.effects, render::words_of(asked.effects_text));
  if (asked.engine == kGpu) {
    const auto able = std::ranges::find_if(render::engines(), [](const auto* engine) { return engine->needs_opengl; });
    options.gpu = true, options.engine = (*able)->name;
  }
  return options;
}

}  // namespace goniochrome::tool
