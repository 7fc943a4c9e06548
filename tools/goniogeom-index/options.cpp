#include "options.h"

#include <iterator>

#include "../seam_options.h"
#include "base/text.h"

namespace goniochrome::tool {

namespace {

std::string sets_text() {
  std::string text = "Named sets are";
  for (const panels::GeometrySet& set : panels::geometry_sets())
    text += fmt::format("{} set:{} (lights {}, views {}: {})", &set == &panels::geometry_sets().front() ? "" : ";",
                        set.name, set.lights, set.views, set.meaning);
  return text + ".";
}

}  // namespace

Result<IndexRequest> request_of(const Options& options) {
  IndexRequest request;
  if (options.seam.names_anything_but_mesh() || !options.picture.empty() || options.advise)
    return usage_error(
        "--seam, --light-from, --view-from, --environment, --picture and --advise are for a mesh: give --mesh");
  if (!(options.threshold > 0))
    return usage_error("--threshold is {}: give a color difference above 0", shortest(options.threshold));
  request.threshold = options.threshold;
  if (options.tolerance_for_deg.size() > 1)
    return usage_error("--tolerance-for is given {} angles: give one", options.tolerance_for_deg.size());
  if (!options.tolerance_for_deg.empty()) {
    request.tolerance_deg = options.tolerance_for_deg[0];
    if (!(*request.tolerance_deg > 0))
      return usage_error("--tolerance-for is {}: give an angle above 0", shortest(*request.tolerance_deg));
  }
  for (const std::string& curve : options.curves)
    if (!curve.ends_with(".csv") && !curve.ends_with(".svg"))
      return usage_error("--curve is \"{}\": give a name that ends in .csv or .svg", curve);
  request.metric = options.metric == "de00" ? panels::DifferenceMetric::kDe00 : panels::DifferenceMetric::kDe76;
  request.target = options.target == "curve" ? paint::TargetCurve::Kind::kCurve : paint::TargetCurve::Kind::kMeasured;
  request.one_row = options.worst || request.tolerance_deg;
  GONIO_ASSIGN(panels::GeometryList list, panels::geometry_list(options.geometries));
  request.glare = list.glare, request.below_horizon = list.below_horizon;
  for (const panels::LightView& geometry : list.pairs)
    request.pairs.push_back(panels::TiltedPair::make(geometry, options.seam_deg));
  request.geometries = std::move(list.pairs);
  return request;
}

Result<SeamRequest> seam_request_of(const Options& options) {
  SeamRequest request;
  GONIO_ASSIGN(request.world, panels::seam_world(options.seam));
  if (!options.tolerance_for_deg.empty() || !options.curves.empty())
    return usage_error("--tolerance-for and --curve are for panels without a mesh: leave out --mesh");
  if (!options.picture.empty() && !options.picture.ends_with(".png"))
    return usage_error("--picture is \"{}\": give a name that ends in .png", options.picture);
  if (!(options.threshold > 0))
    return usage_error("--threshold is {}: give a color difference above 0", shortest(options.threshold));
  request.threshold = options.threshold;
  request.metric = options.metric == "de00" ? panels::DifferenceMetric::kDe00 : panels::DifferenceMetric::kDe76;
  request.target = options.target == "curve" ? paint::TargetCurve::Kind::kCurve : paint::TargetCurve::Kind::kMeasured;
  GONIO_ASSIGN(request.geometries, panels::geometry_list(options.geometries));
  return request;
}

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "goniogeom-index";
  spec.summary = "the angle at which two panels of one paint stop matching";
  spec.description = {
      "goniogeom-index takes two panels of one paint that meet at a seam, one turned about the seam against the other, "
      "with light and viewer at rest. Each panel shows its color at its own aspecular angle, times the cosine of its "
      "light. The goniogeometric index is the smallest angle at which the color difference reaches --threshold: for "
      "positive angles, which turn the second panel toward the light, and for negative ones. Gloss is left out: "
      "highlights need not line up for panels to match, and pairs of light and viewer within 10 degrees of the mirror "
      "direction are passed over.",
      "The difference rises and falls with the angle. The index is its first crossing, found in steps that cannot jump "
      "over one, and bracketed to 1e-9 degrees; it reads none where the threshold is not reached before the second "
      "panel turns its back to the viewer.",
      "One row of tab-separated values is written for each paint and pair: name, light, view, azimuth, aspecular "
      "angle, index for + and for -, and the difference at 1, 2 and 5 degrees (the larger of both signs; - where "
      "neither panel is seen). With --worst and --tolerance-for there is one row for each paint, that of its smallest "
      "index.",
      "Lights are polar angles from the normal of the first panel. Views are polar angles, positive on the far side of "
      "the normal from the light, or aspecular angles where they start with as. Both are lists of numbers, ranges "
      "FIRST:LAST:STEP and named sets. " +
          sets_text(),
      "With --mesh and --seam A,B the panels are two parts of a mesh. They meet where their skins end: at open edges, "
      "folds and tight bends, so that a rolled border belongs to the gap. Gap, flush, the angle between the smooth "
      "normals and its part about the seam (positive for a ridge) are written for every place along the seam, with the "
      "largest and the RMS difference over the lights and viewers, which stand to the first panel at every place as "
      "they would to a flat one, the light from either side of the seam. --light-from and --view-from put them into "
      "the world instead, and --environment takes the light of a prefiltered environment. Shadows and reflections of "
      "the mesh on itself are left out. Meshes of more than 30 units are taken as millimeters.",
      "--tolerance-for DEG answers for a whole library which paints stay under the threshold at every angle up to DEG: "
      "the verdict stands in the last column, those that fail are listed on standard error, and the exit status is 1 "
      "if there are any."};
  spec.inputs = {.value = "PAINTS", .help = "paint XML files; standard input where none is given", .target = &o.inputs};
  spec.options = {
      {.name = "output", .letter = 'o', .value = "FILE", .help = "table to write", .target = &o.output},
      {.name = "only", .value = "NAME", .help = "take the paints of this name; repeatable", .target = &o.only},
  };
  std::ranges::move(geometry_options(o.geometries, o.seam_deg), std::back_inserter(spec.options));
  spec.options.insert(
      spec.options.end(),
      {
          {.name = "threshold",
           .letter = 't',
           .value = "DE",
           .help = "color difference that is seen",
           .target = &o.threshold,
           .low = 0,
           .high = 1000},
          {.name = "metric",
           .value = "METRIC",
           .help = "color difference formula",
           .target = &o.metric,
           .choices = {"de76", "de00"}},
          {.name = "target",
           .value = "KIND",
           .help = "face, flop and travel (fitted where the paint has only rows), or a monotone curve through the rows",
           .target = &o.target,
           .choices = {"curve", "measured"}},
          {.name = "worst", .help = "one row for each paint: the smallest index", .target = &o.worst},
          {.name = "tolerance-for",
           .value = "DEG",
           .help = "tell the paints that stay under the threshold at every angle up to this",
           .target = &o.tolerance_for_deg,
           .low = 0,
           .high = 90},
          {.name = "curve",
           .value = "FILE",
           .help =
               "write the difference of one paint against viewing angle, for each light and misalignment, as .csv or "
               ".svg; repeatable",
           .target = &o.curves},
          {.name = "misalignments",
           .value = "LIST",
           .help = "angles of --curve in degrees, positive toward the light",
           .target = &o.misalignments_deg,
           .low = -90,
           .high = 90},
      });
  std::ranges::move(seam_options(o.seam), std::back_inserter(spec.options));
  spec.options.insert(spec.options.end(), {
                                              {.name = "picture",
                                               .value = "FILE",
                                               .help = "PNG of the seam, colored by the difference of one paint",
                                               .target = &o.picture},
                                              {.name = "advise",
                                               .help = "tell which styling guidelines apply to the seam, with figures",
                                               .target = &o.advise},
                                          });
  spec.examples = {
      {"goniogeom-index testdata/paints.paints.xml --worst -o index.tsv",
       "The angle at which each paint of a library shows a panel gap, in the geometries of an instrument."},
      {"goniogeom-index testdata/paints.paints.xml --only silver_fine --lights set:showroom --views set:showroom",
       "One paint under the lights of a showroom."},
      {"goniogeom-index testdata/paints.paints.xml --only silver_fine --lights 30,45 --curve curve.svg --curve "
       "curve.csv -o index.tsv",
       "How far panels differ from every side, for misalignments of 1, 2, 3 and 5 degrees."},
      {"goniogeom-index testdata/paints.paints.xml --only silver_fine --mesh testdata/speed-shape.obj --seam "
       "Hood,Bumper_F --picture seam.png --advise -o seam.tsv",
       "The seam between hood and bumper in one silver: a table, a picture and advice."},
  };
  spec.report = {
      {"paints[].name", "the paint"},
      {"paints[].status", "done, or failed with a message: the paint has no color"},
      {"paints[].residual_de00", "worst row of the curve that was fitted; null where it was stated"},
      {"paints[].geometries[].light_deg", "the light, from the normal of the first panel"},
      {"paints[].geometries[].view_deg", "the viewer, positive on the far side of the normal from the light"},
      {"paints[].geometries[].azimuth_deg", "of the viewer about the normal"},
      {"paints[].geometries[].aspecular_deg", "aspecular angle at the first panel"},
      {"paints[].geometries[].index_plus_deg", "first crossing for turns toward the light; null: none"},
      {"paints[].geometries[].index_minus_deg", "first crossing for turns away from the light; null: none"},
      {"paints[].geometries[].de_at_1deg",
       "difference at 1 degree, the larger of both signs; also de_at_2deg, "
       "de_at_5deg"},
      {"paints[].worst_deg", "the smallest index; null: none"},
      {"worst_deg", "the smallest index of all paints"},
      {"seam_length_m", "with --mesh; also unit_m, misalignment_deg, gap_mm and flush_mm (low, median, high), repairs"},
      {"paints[].de_max", "with --mesh: the largest difference along the seam; de_rms: of all places and views"},
      {"paints[].over_threshold", "with --mesh: the part of the seam that reaches the threshold"},
      {"paints[].seam[]", "with --mesh: the rows of the table"},
      {"paints[].advice[]", "with --advise: one line for each guideline"},
      {"failing", "with --tolerance-for: the names of the paints that do not stay under the threshold"},
  };
  spec.see_also = {"trompe-fit(1)", "paint-stats(1)", "goniochrome-theory(7)"};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome::tool
