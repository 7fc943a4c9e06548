#include "brdf/measured.h"
#include "fitting.h"
#include "tool.h"

namespace goniochrome::tool {

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "what is fitted";
  spec.option("basis,b", "FILE", "testdata/b7.basis.xml", &o.basis, "basis of exponents to fit to")
      .more("Without it there are seven, from 1.3 to 3000, and the mirror.");
  add_target_options(spec, o.target, o.weights);
  spec.option("illuminant", "NAME", "A", &o.illuminant, "fit the colors under this illuminant, from spectra")
      .more("goniochrome-paint(5), \"ILLUMINANTS\", lists the names. A paint without spectra is not fitted.");
  spec.option("gloss,g", "GU|ANGLE:GU,...", "20:80,60:90", &o.gloss, "gloss of paints that state none")
      .in("gloss units")
      .more("A single number is the gloss at 60 degrees; 0 is matt.");
  spec.option("coat", "INDEX", "1.5", &o.coat, "refractive index of the clear coat of every paint; none is no coat")
      .more(
          "auto gives a coat to paints with gloss and to paints that state one; its index is 1.5, or as the gloss asks "
          "for. See Coats.");
  spec.option("satin", "WHICH", "all", &o.satin, "which paints get the gloss of a rough coat, by views")
      .one_of({"several", "all", "none"})
      .more(
          "several takes paints with two or three readings of gloss, all also those with one, whose coat is that of a "
          "usual series.");
  spec.option("steepest", "DEG", "60", &o.steepest_deg, "largest angle to the normal that counts in measured BRDFs")
      .from(0, 90);
  spec.heading = "how it is fitted";
  spec.option("method,m", "METHOD", "deltae", &o.method, "what the fit makes least")
      .one_of({"l1", "l2", "deltae"})
      .more(
          "l1 is the sum of absolute errors, l2 the sum of squares, both with proof. deltae is the sum of squared "
          "color differences; it is slower, and keeps its mean within 0.01 of that of l1.");
  spec.option("lobes,n", "N", "3", &o.lobes, "use the best N flake lobes of the basis; 0 uses all")
      .from(0, 1000)
      .more("In a measured BRDF each has to lower the error by 1 %.");
  spec.option("prune", "DE00", "0.1", &o.prune_de00, "drop flake lobes as long as no color moves by more; 0 drops none")
      .from(0, 100);
  spec.option("views", "lost|auto|none|DEG,...", "0,30,60", &o.views,
              "also fit weights for several angles of the viewer")
      .in("degrees from the normal: two or more, ascending")
      .more(
          "lost: for paints of which a coat would change a reading. auto: also for readings that differ visibly at one "
          "aspecular angle. See Views.");
  spec.option("paint-time-limit", "S", "0.5", &o.paint_time_limit_s, "longest time for one paint; 0 is no limit")
      .from(0)
      .more("After this time the best weights so far are taken.");
  spec.heading = "output";
  spec.option("output,o", "FILE", "fitted.paints.xml", &o.output, "where the paints go; - is standard output");
  spec.option("color-map", "FOLDER", "maps", &o.color_map, "also make color maps, as FOLDER/name.exr")
      .more("The readings must meet flakes at two or more angles of incidence.");
  spec.option("color-map-model", "MODEL", "isolines", &o.color_map_model, "what carries readings to other directions")
      .one_of({"better", "isolines", "aspecular"})
      .more(
          "better takes the one that predicts left-out readings better.");
  spec.option("tilts", "none|N,...", "8,16", &o.tilts, "look-ups of tilted lobes that stand for a color map")
      .more(
          "Each number makes a set of so many look-ups; more are closer and slower. See Color maps.");
  cli::add_common_options(spec, o.common, {.explain = true});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.paints.xml",
       "fit every sample paint and print the worst"},
      {"paint-convert testdata/paints.csv -o - | fit-paint -b testdata/b7.basis.xml --gloss 90 -o car.paints.xml",
       "fit measurements from a CSV table, with the gloss of a clear coat"},
      {"fit-paint -b testdata/b5.basis.xml --method l2 --report fit.json testdata/paints.paints.xml -o /dev/null",
       "keep only the report, which has the color difference at each geometry of each paint"}};
  spec.report = {
      {"paints[].name, method", "name, and l1, l2 or deltae"},
      {"paints[].status",
       "optimal, not_converged, stalled (deltae ended with a gap), bounded (by the mean of l1), time_limit, or failed: "
       "passed on unfitted"},
      {"paints[].time_us", "time of the fit"},
      {"paints[].objective, plain_objective", "norm of the error, weighted in L*, and in reflectance factor"},
      {"paints[].optimality_gap", "proven distance from the optimum, relative to the norm of the target"},
      {"paints[].active_lobes", "lobes with weight, including the mirror"},
      {"paints[].unseen_exponents, dropped_exponents", "lobes that no reading sees, and that options left out"},
      {"paints[].de00_max, de00_mean, de00_by_geometry", "CIEDE2000 differences at the readings"},
      {"paints[].lost_to_coat, views_for_coat",
       "readings that the coat keeps from being met, and whether the paint has weights for views therefore"},
      {"paints[].limit",
       "limit of the worst reading: working space, two sides of specular, a channel that grows away from specular, or "
       "the basis; empty below dE00 0.5"},
      {"paints[].apart_de00, floor_de00_mean",
       "largest difference of two readings at one aspecular angle, and the least de00_mean of weights for all views"},
      {"paints[].incidences[]",
       "for several angles of incidence: incidence_deg, readings, de00_mean, and predicted_de00_mean by the other "
       "angles"},
      {"paints[].gamut_de00", "color that is lost because the working space has no negative channels"},
      {"paints[].glare_rows", "readings left out within 10 degrees of specular"},
      {"paints[].gloss[]", "angle_deg, simulated_gu, and for a stated gloss stated_gu and misfit_gu"},
      {"paints[].coat_range",
       "for a coat of two scales: slopes, and least_haze, probable and most_haze, each with k, slope and haze; see "
       "goniochrome-coats(7), \"SATIN\""},
      {"paints[].brdf",
       "number of directions; glare_directions and steep_directions left out; relative_error_median, "
       "relative_error_p95, de00_median, de00_p95; spike_albedo_45; for grids albedo_error"},
      {"paints[].brdf.from_five_angles",
       "prediction by lobes of five readings: directions, and median relative error by_aspecular and by_flake"},
      {"paints[].views", "with weights for views: de00_mean, de00_mean_without, gain_de00"},
      {"paints[].message", "reason of a failure"},
      {"color_maps[].name, file, rows", "with --color-map: paint, map, and number of readings"},
      {"color_maps[].glare_rows, grazing_rows, beyond_rows",
       "readings left out near specular, beyond 75 degrees, and beyond the critical angle"},
      {"color_maps[].illuminations", "number of angles of incidence on the flakes, to 1 degree"},
      {"color_maps[].model, isolines_power", "isolines or aspecular, and the power of the distance"},
      {"color_maps[].isolines_de76, aspecular_de76, held_out_de76",
       "mean CIE 1976 difference of left-out readings, by either model and by the one taken"},
      {"color_maps[].difference_error_de76, compared_rows", "standard error of the difference, and readings behind it"},
      {"color_maps[].negative_share", "share of the map outside the working space"},
      {"without_color_map, without_tilts", "paints without a map, and without tilted lobes"},
      {"tilts[].name, lobes_de00", "paint, and mean difference between its lobes and the map"},
      {"tilts[].sets[].lookups, de00_mean", "look-ups of a set, and mean difference between set and map"},
      {"fits_per_s", "fits a second, without files"},
      {"fitted, failed", "paints that got lobes, and that did not"},
      {"de00_mean, de00_p95", "color difference over the readings of all paints"},
      {"worst[]", "the five worst paints: name, geometry, de00 and limit"},
      {"contradicting", "paints whose readings at one aspecular angle differ visibly"},
      {"lost_to_coat, views_for_coat", "such readings, and such paints"},
      {"floor_de00_mean, floor_de00_p95", "least values that weights for all views can have"},
      {"warnings[]", "first messages about failed paints"}};
  spec.see_also = {"paint-convert(1)",       "render-osmesa(1)",       "goniochrome-paint(5)",
                   "goniochrome-fitting(7)", "goniochrome-coats(7)",   "goniochrome-interference(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "fit-paint", .summary = "fit paints to a basis of cosine lobes"};
  spec.description = {
      "fit-paint fits each paint to the exponents of a basis and writes it on with its lobes: a constant and, for each "
      "exponent and channel, one weight that is not negative. Everything else in a paint stays. A paint without "
      "readings and appearance passes unfitted, and the exit status is 1.",
      "# Judging a fit\nCompare two paints by the color that their lobes predict, never by the weights: noise of a "
      "tenth of a percent moves weights by tens of percent while the color stays. Readings within 10 degrees of the "
      "mirror direction hold glare and are left out.",
      "# Coats\nThe coat takes from the base the light that it reflects itself. The base is fitted to the rest, so "
      "that readings stay the same. Gloss readings set the gloss lobes and the mirror through a simulated meter. For a "
      "satin coat the fit finds a rough dielectric that has the readings, and writes weights for several angles of the "
      "viewer; sketch-fit does not follow these.",
      "# Views\nTwo readings at one aspecular angle may differ, as 45as15 and 45as-15 of many paints do; one weight "
      "for all views cannot meet both. Weights for several views can, and are linear between the views.",
      "# Measured BRDFs\nA measured BRDF (" + brdf::measured_formats() +
          ") becomes one paint. It is fitted to all measured directions except those within 10 degrees of specular and "
          "those near grazing. Light near specular goes to sharp lobes of gloss and flake.",
      "# Color maps\nA color map follows an interference paint out of the plane of measurement. Under image light "
      "tilted lobes stand for the map, unless lobes are visibly as good or readings do not support isolines."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, FILE#NAMES, or measured BRDFs; standard input where "
                 "none is given",
                 &o.paints};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
