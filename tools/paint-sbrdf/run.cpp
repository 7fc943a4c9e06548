#include "tool.h"

#include "build.h"
#include "image/surface_file.h"
#include "output_names.h"

namespace goniochrome::tool {

namespace {

std::string plan_text(const Options& options, const Surfaces& surfaces, const Pattern& pattern, const Layout& layout) {
  std::string text;
  for (std::size_t i = 0; i < surfaces.all.size(); ++i) {
    const Surface& surface = surfaces.all[i];
    text += fmt::format("surface {}: {} {}, ", i + 1, surface.kind, surface.name);
    text += surface.width() > 0 ? fmt::format("{} x {} texels, ", surface.width(), surface.height()) : "";
    text += fmt::format("{} lobes\n", surface.lobes());
  }
  text += pattern.told() + "\n";
  text += fmt::format("map: {} x {} texels", layout.width, layout.height);
  if (layout.crop_width != layout.width || layout.crop_height != layout.height)
    text += fmt::format(", of which {} x {} from ({},{}) are kept", layout.crop_width, layout.crop_height, layout.left,
                        layout.top);
  if (layout.columns * layout.rows > 1) text += fmt::format(", {} x {} times", layout.columns, layout.rows);
  text += fmt::format("\nmirrors become lobes of the exponent {:g}\n", surfaces.mirror_exponent);
  text += options.lobes > 0 ? fmt::format(
                                  "lobes: {} at most; texels that need more are fitted, which takes about 10 ms "
                                  "for each kind of texel\n",
                                  options.lobes)
                            : "lobes: as many as mixtures need, which is exact\n";
  return text;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_TRY(check_output_name(options.output, "an EXR", ".exr"));
  GONIO_ASSIGN(const Surfaces surfaces, read_surfaces(options, session));
  GONIO_ASSIGN(const Pattern pattern, Pattern::create(options, surfaces.all.size()));
  GONIO_ASSIGN(const Layout layout, layout_of(options, surfaces, pattern));
  session.explain(plan_text(options, surfaces, pattern, layout));
  GONIO_ASSIGN(const BuiltMap map, built_map(options, surfaces, pattern, layout, session));
  GONIO_TRY(image::write_sbrdf(options.output, map.texture, {{"goniochrome:command", session.provenance()}}));

  const bool reflects = map.highest >= map.lowest;
  Json& results = session.results();
  results["size"] = {map.texture.width, map.texture.height};
  results["lobes"] = map.texture.lobes;
  results["lobe_frames"] = map.frames;
  results["exponents"] = reflects ? Json{map.lowest, map.highest} : Json(nullptr);
  results["mirror_exponent"] = surfaces.mirror_exponent;
  results["surfaces"] = Json::array();
  for (std::size_t i = 0; i < surfaces.all.size(); ++i)
    results["surfaces"].push_back({{"name", surfaces.all[i].name},
                                   {"kind", surfaces.all[i].kind},
                                   {"share", map.share[i]},
                                   {"strength_error", surfaces.all[i].strength_error}});
  results["refitted_texels"] = map.refitted;
  results["refit_error_mean"] = map.error_mean;
  results["refit_error_max"] = map.error_max;
  results["albedo_max"] = map.albedo_max;
  results["alpha_mean"] = map.alpha_mean;
  if (map.albedo_max > 1.001)
    session.warn(
        fmt::format("a texel sends back {:.3g} of the light that it gets along the normal: a surface that "
                    "makes no light sends back 1 at most",
                    map.albedo_max));
  std::string line =
      fmt::format("map: {} x {} texels, {} lobes", map.texture.width, map.texture.height, map.texture.lobes);
  if (reflects) line += fmt::format(" of exponents {:.4g} to {:.4g}", map.lowest, map.highest);
  if (map.frames) line += ", each in a frame of its own";
  if (!map.texture.alpha.empty()) line += fmt::format("; alpha is {:.3g} in the mean", map.alpha_mean);
  if (map.refitted > 0)
    line += fmt::format("; {} texels fitted, with errors of {:.1f} % in the mean and {:.1f} % at most", map.refitted,
                        100 * map.error_mean, 100 * map.error_max);
  session.say(line);
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
