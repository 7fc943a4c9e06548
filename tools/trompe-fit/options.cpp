#include "tool.h"

#include <cmath>

#include "base/text.h"
#include "paint_stream.h"
#include "panels.h"

namespace goniochrome::tool {

namespace {

Result<std::array<bool, panels::kTrompeParameters>> parse_vary(const std::string& text) {
  std::array<bool, panels::kTrompeParameters> vary{};
  for (const std::string_view piece : split(text, ',')) {
    const std::string_view name = trimmed(piece);
    if (name == "face_l") {
      vary[panels::kFaceL] = true;
    } else if (name == "face_ab") {
      vary[panels::kFaceA] = vary[panels::kFaceB] = true;
    } else if (name == "flop_l") {
      vary[panels::kFlopL] = true;
    } else if (name == "flop_ab") {
      vary[panels::kFlopA] = vary[panels::kFlopB] = true;
    } else if (name == "travel") {
      vary[panels::kTravel] = true;
    } else {
      return usage_error("--vary has \"{}\": choose of face_l, face_ab, flop_l, flop_ab, travel", name);
    }
  }
  return vary;
}

// NAME=LOW:HIGH; face_ab and flop_ab bound both coordinates.
Result<void> parse_bound(const std::string& text, panels::TrompeOptions& fit) {
  const auto error = [&] {
    return usage_error("--bounds is \"{}\": write NAME=LOW:HIGH, with NAME of face_l, face_ab, flop_l, flop_ab, travel",
                       text);
  };
  const auto sides = split(text, '=');
  if (sides.size() != 2) return error();
  const auto ends = split(sides[1], ':');
  if (ends.size() != 2) return error();
  const auto low = parse_number(trimmed(ends[0])), high = parse_number(trimmed(ends[1]));
  if (!low || !high || trimmed(sides[0]).find(',') != std::string_view::npos) return error();
  const auto bounded = parse_vary(std::string(trimmed(sides[0])));
  if (!bounded.ok()) return error();
  for (int p = 0; p < panels::kTrompeParameters; ++p)
    if ((*bounded)[p]) fit.low[p] = *low, fit.high[p] = *high;
  return {};
}

// --vary, --bounds, --objective and --picture.
Result<void> parse_fit(const Options& options, panels::TrompeOptions& fit) {
  GONIO_ASSIGN(fit.vary, parse_vary(options.vary));
  for (const std::string& bound : options.bounds) GONIO_TRY(parse_bound(bound, fit));
  fit.least_maximum = options.objective == "max";
  if (!options.picture.empty() && !options.picture.ends_with(".png"))
    return usage_error("--picture is \"{}\": give a name that ends in .png", options.picture);
  GONIO_TRY(PaintPictures::check(options.picture));
  return {};
}

Result<std::optional<TrompeGeometry>> parse_single(const Options& options, double angle_deg) {
  if (options.mode != "single") {
    if (!options.at.empty()) return usage_error("--at is for --mode single");
    return std::optional<TrompeGeometry>();
  }
  if (options.at.size() != 2) return usage_error("--mode single needs --at LIGHT,VIEW");
  const panels::LightView geometry{options.at[0], options.at[1], 0};
  if (geometry.light_deg < 0 || geometry.light_deg >= 90 || std::abs(geometry.view_deg) >= 90)
    return usage_error("--at is {},{}: light and viewer must be above the panel, 0 to 90 and -90 to 90",
                       shortest(geometry.light_deg), shortest(geometry.view_deg));
  const auto view = panels::panel_view(geometry, options.seam_deg, angle_deg);
  if (!view) return usage_error("--at names a viewer who does not see the second panel: change the view");
  return std::optional<TrompeGeometry>({geometry, *view});
}

}  // namespace

Result<TrompeRequest> request_of(const Options& options) {
  TrompeRequest request;
  if (options.seam.names_anything_but_mesh() || !options.dark.empty())
    return usage_error("--seam, --light-from, --view-from, --environment and --dark are for a mesh: give --mesh");
  if (options.angle_deg.size() != 1) return usage_error("give the misalignment once: --angle DEG");
  request.angle_deg = options.angle_deg[0];
  if (request.angle_deg == 0) return usage_error("--angle is 0: panels in line match in the same paint");
  GONIO_TRY(parse_fit(options, request.fit));
  request.mode = options.mode == "all"      ? TrompeMode::kAll
                 : options.mode == "single" ? TrompeMode::kSingle
                                            : TrompeMode::kRows;
  GONIO_ASSIGN(request.single, parse_single(options, request.angle_deg));
  GONIO_ASSIGN(const panels::GeometryList list, panels::geometry_list(options.geometries));
  request.in_glare = list.left_out, request.below_horizon = list.below_horizon;
  for (std::size_t i = 0; i < list.pairs.size(); ++i) {
    auto view = panels::panel_view(list.pairs[i], options.seam_deg, request.angle_deg);
    if (!view) {
      ++request.hidden;
      continue;
    }
    view->weight = list.weights[i];
    request.geometries.push_back({list.pairs[i], *view});
  }
  if (request.geometries.empty())
    return usage_error("no viewer of --views sees the second panel at {} deg: change the views",
                       shortest(request.angle_deg));
  return request;
}

Result<TrompeSeamRequest> seam_request_of(const Options& options) {
  TrompeSeamRequest request;
  GONIO_ASSIGN(request.world, panels::seam_world(options.seam));
  if (!options.angle_deg.empty()) return usage_error("--angle is for panels without a mesh: the seam has its own");
  if (options.mode != "all" || !options.at.empty())
    return usage_error("--mode and --at are for panels without a mesh: leave out --mesh");
  GONIO_TRY(parse_fit(options, request.fit));
  GONIO_ASSIGN(request.geometries, panels::geometry_list(options.geometries));
  if (!options.picture.empty() && !request.world.in_world)
    return usage_error(
        "a picture of the mesh wants its light and viewer: give --light-from or --environment, and "
        "--view-from");
  return request;
}

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "panels";
  spec.option("angle,a", "DEG", "-2", &o.angle_deg, "how far the second panel is turned, positive toward the light")
      .from(-45, 45);
  add_geometry_options(spec, o.geometries, o.seam_deg);
  spec.option("light-weights", "K,...", "1,1,2", &o.geometries.light_weights, "weight of each light");
  spec.option("view-weights", "K,...", "1,2,1", &o.geometries.view_weights, "weight of each view");
  spec.heading = "match";
  spec.option("mode", "MODE", "rows", &o.mode, "what one paint has to match")
      .one_of({"all", "single", "rows"})
      .more(
          "all is the whole set of lights and viewers. single is the one geometry of --at, where the match can be made "
          "perfect; it is then poor elsewhere, and the table of all geometries in the report says how poor. rows finds "
          "one paint for each light.");
  spec.option("at", "LIGHT,VIEW", "45,20", &o.at, "geometry of --mode single").in("degrees from the normal");
  spec.option("objective", "NAME", "max", &o.objective, "difference that is made least")
      .one_of({"rms", "max"})
      .more("rms is the weighted root mean square, max the largest difference.");
  spec.option("vary", "LIST", "face_l,travel", &o.vary, "what may change: face_l, face_ab, flop_l, flop_ab, travel");
  spec.option("bounds", "NAME=LOW:HIGH", "travel=30:80", &o.bounds, "limits of a parameter of --vary");
  add_seam_options(spec, o.seam);
  spec.heading = "input and output";
  add_only_option(spec, o.only, "take only the paints of this name");
  spec.option("suffix", "TEXT", "_panel", &o.suffix, "text to append to the name of the paint");
  spec.option("output,o", "FILE", "b.paints.xml", &o.output, "paint XML to write; - is standard output");
  spec.option("picture", "FILE", "pair.png", &o.picture, "PNG of before and after")
      .more(
          "It shows flat panels, or the mesh as the first --view-from sees it. {name}, {code} and {index} in it make a "
          "picture for each paint; without them there may be one paint.");
  spec.option("dark", "PART", "Glass", &o.dark, "a part that the picture shows black");
  cli::add_common_options(spec, o.common, {.explain = true});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"trompe-fit testdata/paints.paints.xml --only silver_black_flop --angle -2 --views as15:105:10 --vary "
       "face_l,travel -o b.paints.xml",
       "find the silver for a panel turned 2 degrees away from the light, by its face L* and travel alone"},
      {"trompe-fit testdata/paints.paints.xml --only signal_red --angle 3 --lights 0,15.5,29.1,39.8,45,52 --views as20 "
       "--mode rows -o rows.paints.xml",
       "find one answer for each of six lights, for a solid paint"},
      {"trompe-fit testdata/paints.paints.xml --only silver_fine --mesh testdata/speed-shape.obj --seam Hood,Bumper_F "
       "--light-from 0,75 --view-from 25,20 --dark Glass --dark Seams --dark Underbody --picture pair.png -o "
       "b.paints.xml",
       "find the silver that hides a bumper 8 degrees out of flush, and draw before and after"}};
  spec.report = {
      {"before.rms, before.max", "difference of the panels in the same paint, over all geometries"},
      {"after.rms, after.max", "difference with the paint found"},
      {"delta.face_l ... delta.travel", "change of each parameter"},
      {"geometries[].light_deg", "beside it stand view_deg, azimuth_deg, aspecular_deg, aspecular_b_deg and weight"},
      {"geometries[].de_before", "difference there in the same paint; de_after is that with the paint found"},
      {"left_out[]",
       "light_deg, view_deg, azimuth_deg and aspecular_deg of pairs near the mirror direction"},
      {"undetermined[]", "parameters that the views leave open"},
      {"at_bound[]", "parameters that a bound holds back"},
      {"solid", "whether face and flop were moved together"},
      {"status", "one of converged, not_converged, and failed with a message"},
      {"time_ms", "time of the fit; starts tells from how many points it was begun"},
      {"misalignment_deg", "with --mesh: low, median and high misalignment of the seam"},
      {"traced[].paint", "with --environment: name of a paint whose light was traced"},
      {"traced[].worth_de76", "change of the difference by the mesh (CIE 1976), at 95 % of the views"},
      {"traced[].noise_de76", "standard deviation of that difference by the random rays, at 95 % of the views"},
      {"traced[].panels_not_found", "panels that no ray found, and that get unoccluded light"},
      {"seam[].rms_before",
       "with --mesh, for each place; beside it stand rms_after, run, distance_m and fold_deg. geometries[] is left out "
       "then, and views counts all of them"},
      {"fits[]", "where there is more than one answer: all of these for each, with name and light_deg"}};
  spec.see_also = {"goniogeom-index(1)", "paint-edit(1)", "fit-paint(1)", "goniochrome-panels(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "trompe-fit", .summary = "the paint for a misaligned panel that hides the misalignment"};
  spec.description = {
      "trompe-fit finds the paint for a misaligned panel that looks most like the first panel, over a set of lights "
      "and viewers. It is written with the face, flop and travel found, and with the rows that an instrument would "
      "read. Gloss and class stay; lobes and color maps are dropped. The exit status is 1 where a paint is not "
      "improved.",
      "# Colors\nLights, views and named sets are those of goniogeom-index(1). The colors are the clamped quadratic of "
      "face, flop and travel at the aspecular angle of each panel, times the cosine of its light, without gloss. "
      "Differences are CIE 1976.",
      "# What to expect\nIn the plane of incidence, a panel that is turned by b shows an aspecular angle that is "
      "smaller by 2b. Viewers on both sides of the mirror direction ask for opposite changes, which no paint can make. "
      "A solid paint has no travel, and its face and flop move together. Parameters that the views do not determine "
      "stay near those of the paint given, and are named.",
      "# Seams of a mesh\nWith --mesh and --seam A,B, the misalignment is that of every place along the seam, as "
      "goniogeom-index(1) finds it, and B gets the paint found. Lights and viewers stand to the first panel as to a "
      "flat one, or in the world by --light-from and --view-from. With --environment the light is a prefiltered "
      "environment; the light that the mesh blocks and sends is traced while all parts wear the first paint, unless "
      "--open is given."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.inputs};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
