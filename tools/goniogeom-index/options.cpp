#include "tool.h"

#include <algorithm>

#include "base/text.h"
#include "color/spectrum.h"
#include "illuminants.h"
#include "paint_stream.h"
#include "panels.h"

namespace goniochrome::tool {

namespace {

std::string sets_text() {
  std::string text =
      "Lights are polar angles from the normal of the first panel. Views are polar angles, positive on the far side of "
      "the normal from the light, or aspecular angles where they begin with as. Both are lists of numbers, ranges "
      "FIRST:LAST:STEP and named sets. The named sets are";
  for (const panels::GeometrySet& set : panels::geometry_sets())
    text += fmt::format("{} set:{} (lights {}, views {}: {})", &set == &panels::geometry_sets().front() ? "" : ";",
                        set.name, set.lights, set.views, set.meaning);
  return text + ".";
}

Result<DifferenceRequest> difference_of(const Options& options) {
  if (!(options.threshold > 0))
    return usage_error("--threshold is {}: give a color difference above 0", shortest(options.threshold));
  return DifferenceRequest{
      options.metric == "de00" ? panels::DifferenceMetric::kDe00 : panels::DifferenceMetric::kDe76,
      options.target == "curve" ? paint::TargetCurve::Kind::kCurve : paint::TargetCurve::Kind::kMeasured,
      options.threshold};
}

}  // namespace

Result<IndexRequest> request_of(const Options& options) {
  IndexRequest request;
  if (options.seam.names_anything_but_mesh() || !options.picture.empty() || options.advise)
    return usage_error(
        "--seam, --light-from, --view-from, --environment, --picture and --advise are for a mesh: give --mesh");
  GONIO_ASSIGN(static_cast<DifferenceRequest&>(request), difference_of(options));
  if (options.tolerance_for_deg.size() > 1)
    return usage_error("--tolerance-for is given {} angles: give one", options.tolerance_for_deg.size());
  if (!options.tolerance_for_deg.empty()) {
    request.tolerance_deg = options.tolerance_for_deg[0];
    if (!(*request.tolerance_deg > 0))
      return usage_error("--tolerance-for is {}: give an angle above 0", shortest(*request.tolerance_deg));
  }
  for (const std::string& curve : options.curves)
    if (curve != "-" && !curve.ends_with(".csv") && !curve.ends_with(".svg"))
      return usage_error("--curve is \"{}\": give a name that ends in .csv or .svg, or - for a table", curve);
  if (options.output == "-" && std::ranges::find(options.curves, "-") != options.curves.end())
    return usage_error("--curve - and the table of indices are both to go to standard output: give one a file by -o");
  GONIO_ASSIGN(request.illuminants, illuminants_of(options.illuminants));
  if (!request.illuminants.empty() && !options.curves.empty())
    return usage_error("--curve shows a paint under the illuminant of its readings: leave out --illuminant");
  request.one_row = options.worst || request.tolerance_deg;
  GONIO_ASSIGN(panels::GeometryList list, panels::geometry_list(options.geometries));
  request.in_glare = std::move(list.left_out), request.below_horizon = list.below_horizon;
  for (const panels::LightView& geometry : list.pairs)
    request.pairs.push_back(panels::TiltedPair::make(geometry, options.seam_deg));
  request.geometries = std::move(list.pairs);
  return request;
}

Result<SeamRequest> seam_request_of(const Options& options) {
  SeamRequest request;
  GONIO_ASSIGN(request.world, panels::seam_world(options.seam));
  if (!options.tolerance_for_deg.empty() || !options.curves.empty() || !options.illuminants.empty())
    return usage_error("--tolerance-for, --curve and --illuminant are for panels without a mesh: leave out --mesh");
  if (!options.picture.empty() && !options.picture.ends_with(".png"))
    return usage_error("--picture is \"{}\": give a name that ends in .png", options.picture);
  GONIO_TRY(PaintPictures::check(options.picture));
  GONIO_ASSIGN(static_cast<DifferenceRequest&>(request), difference_of(options));
  GONIO_ASSIGN(request.geometries, panels::geometry_list(options.geometries));
  return request;
}

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "difference";
  spec.option("threshold,t", "DE", "1", &o.threshold, "color difference that is seen")
      .from(0, 1000)
      .in("units of the metric");
  spec.option("metric", "METRIC", "de00", &o.metric, "color difference: CIE 1976 (de76) or CIEDE2000 (de00)")
      .one_of({"de76", "de00"});
  spec.option("target", "KIND", "measured", &o.target, "color that a panel shows")
      .one_of({"curve", "measured"})
      .more(
          "curve is face, flop and travel. measured is a monotone curve through the rows, continued toward the mirror "
          "direction as fit-paint does.");
  spec.option("illuminant", "NAME,...", "D65,A,F11", &o.illuminants, "judge each paint in all of these lights")
      .more(
          "The names are " + color::spectral_illuminants() +
          ". A paint without spectra is left out with a warning. The table has a last column with the illuminant.");
  spec.heading = "verdict";
  spec.flag("worst", &o.worst, "write one row for each paint: its smallest index");
  spec.option("tolerance-for", "DEG", "1", &o.tolerance_for_deg, "judge the paints by every angle up to this one")
      .from(0, 90)
      .more(
          "The last column has the verdict. Paints that fail are listed on standard error, and the exit status is 1.");
  add_seam_options(spec, o.seam);
  spec.flag("advise", &o.advise, "tell which styling guidelines apply to the seam, with figures");
  spec.heading = "input and output";
  add_only_option(spec, o.only, "take only the paints of this name");
  spec.option("output,o", "FILE", "index.tsv", &o.output, "table to write; - is standard output");
  spec.option("curve", "FILE", "curve.svg", &o.curves, "difference of one paint against viewing angle, .csv or .svg")
      .more(
          "There is a curve for each light and misalignment, which breaks within glare. The name - writes the CSV to "
          "standard output, as for "
          "draw-plot(1).");
  spec.option("misalignments", "LIST", "1,2,3,5", &o.misalignments_deg, "angles of --curve, positive toward the light")
      .from(-90, 90)
      .in("degrees");
  spec.option("picture", "FILE", "seam.png", &o.picture, "PNG of the seam, colored by the difference of a paint")
      .more("{name}, {code} and {index} in it make a picture for each paint; without them there may be one paint.");
  cli::add_common_options(spec, o.common, {.explain = true});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"goniogeom-index testdata/paints.paints.xml --worst -o index.tsv",
       "find the angle at which each paint of a library shows a panel gap, in the geometries of an instrument"},
      {"goniogeom-index testdata/paints.paints.xml --only silver_fine --lights set:showroom --views set:showroom",
       "judge one paint under the lights of a showroom"},
      {"goniogeom-index testdata/paints.paints.xml --only silver_fine --lights 30,45 --curve curve.svg --curve "
       "curve.csv -o index.tsv",
       "show how far panels differ from every side, for misalignments of 1, 2, 3 and 5 degrees"},
      {"goniogeom-index testdata/paints.paints.xml --only silver_fine --mesh testdata/speed-shape.obj --seam "
       "Hood,Bumper_F --picture seam.png --advise -o seam.tsv",
       "judge the seam between hood and bumper in one silver by a table, a picture and advice"}};
  spec.report = {
      {"paints[].name", "the paint"},
      {"paints[].status", "one of done, and failed with a message: the paint has no color"},
      {"paints[].residual_de00",
       "worst row of the curve that was fitted; null where the paint states its curve; the largest of several lights"},
      {"paints[].geometries[].light_deg, view_deg, azimuth_deg, aspecular_deg, illuminant", "light and viewer"},
      {"paints[].geometries[].index_plus_deg, index_minus_deg",
       "first crossing for turns toward the light and away from it; null where there is none"},
      {"paints[].geometries[].de_at_1deg, de_at_2deg, de_at_5deg", "difference, the larger of both signs"},
      {"paints[].worst_deg, worst_deg", "smallest index of the paint, and of all; null where there is none"},
      {"left_out[]", "light_deg, view_deg, azimuth_deg and aspecular_deg of pairs near the mirror direction"},
      {"seam_length_m, unit_m, misalignment_deg, gap_mm, flush_mm, repairs",
       "with --mesh: the seam, with low, median and high values"},
      {"paints[].de_max, de_rms, over_threshold, seam[]",
       "with --mesh: largest and RMS difference, part of the seam that reaches the threshold, and rows of the table"},
      {"traced[].paint, worth_de76, noise_de76",
       "with --environment: change of the difference by the mesh, and its noise, at 95 % of the views"},
      {"traced[].panels_not_found", "panels that no ray found, and that get unoccluded light"},
      {"paints[].advice[]", "with --advise: one line for each guideline"},
      {"failing", "with --tolerance-for: names of the paints that do not stay under the threshold"}};
  spec.see_also = {"trompe-fit(1)", "paint-stats(1)", "goniochrome-panels(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "goniogeom-index", .summary = "the angle at which two panels of one paint stop matching"};
  spec.description = {
      "goniogeom-index finds the smallest angle between two panels of one paint at which their colors differ by "
      "--threshold. One panel is turned about the seam, with light and viewer at rest. There is an index for turns "
      "toward the light (positive) and one for turns away from it; none where the panels match at every angle.",
      "# The index\nEach panel shows its color at its own aspecular angle, times the cosine of its light. Gloss is "
      "left out, because highlights need not line up for panels to match. Pairs of light and viewer within 10 degrees "
      "of the mirror direction are left out. The index is the first crossing of the threshold, found in steps that "
      "cannot jump over one.",
      "# The table\nThe columns are name, light, view, azimuth, aspecular angle, index for + and for -, and the "
      "difference at 1, 2 and 5 degrees, the larger of both signs. With --worst and --tolerance-for there is one row "
      "for each paint.",
      "# Lights and views\n" + sets_text(),
      "# Seams of a mesh\nWith --mesh and --seam A,B, the panels are two parts of a mesh that meet at open edges, "
      "folds and tight bends. For every place along the seam, the table has the gap, the flush, the angle between the "
      "normals and its part about the seam (positive for a ridge), and the largest and the RMS difference. Lights and "
      "viewers stand to the first panel as to a flat one, or in the world by --light-from and --view-from. With "
      "--environment the light is a prefiltered environment, and the light that the mesh blocks and sends to the seam "
      "is traced, unless --open is given; elsewhere it is left out."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.inputs};
  add_geometry_options(spec, o.geometries, o.seam_deg);
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
