#include "brdf/measured.h"
#include "color/spectrum.h"
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
      .more(
          "It is " + color::spectral_illuminants() +
          ". The paints then leave with the readings for this illuminant, and in white light their lobes show what an "
          "eye sees that has adapted to it. A paint without spectra is not fitted, and a measured BRDF is converted by "
          "paint-convert --illuminant first. Without this option the paints are fitted under the illuminant of their "
          "readings.");
  spec.option("gloss,g", "GU|ANGLE:GU,...", "20:80,60:90", &o.gloss, "gloss of paints that state none")
      .in("gloss units")
      .more(
          "A single number is the gloss at 60 degrees. Several readings are written as angle and gloss, with the "
          "angles 20, 60 and 85. 0 leaves the paints matt.");
  spec.option("coat", "INDEX", "1.5", &o.coat, "refractive index of the clear coat of every paint; none is no coat")
      .more(
          "The coat takes from the base what it reflects itself. The base is fitted to what the coat leaves of it at "
          "each geometry, so that what is read stays the same. Readings that are met without a coat are met with it. "
          "Where no weights for all views do so, as where the base would have to grow away from specular, the paint "
          "gets weights for the views of its readings (see --views). auto gives a coat to every paint with gloss, "
          "stated or assumed, and to every paint that states a coat; its index is 1.5, or as much as the gloss asks "
          "for. Measured BRDFs have none unless it is given here.");
  spec.option("satin", "WHICH", "all", &o.satin, "which paints get the gloss of a rough coat, by views")
      .one_of({"several", "all", "none"})
      .more(
          "A satin coat is sharper and brighter toward grazing. From two or three readings the fit finds a rough "
          "dielectric that has them, and writes weights for several angles of the viewer. several does so for paints "
          "with two or three readings of gloss. all also takes paints with one reading, whose coat is then that of a "
          "usual series: 60 GU at 60 degrees go with 16 GU at 20 and 83 GU at 85 degrees. sketch-fit does not follow "
          "gloss that changes with the view, which is why all is not the default. With none, or for one reading, the "
          "lobes are those of the first reading for all views.");
  spec.option("steepest", "DEG", "60", &o.steepest_deg, "largest angle to the normal that counts in measured BRDFs")
      .from(0, 90);
  spec.heading = "how it is fitted";
  spec.option("method,m", "METHOD", "deltae", &o.method, "what the fit makes least")
      .one_of({"l1", "l2", "deltae"})
      .more(
          "l1 is the sum of absolute errors, l2 the sum of squares. The weights of both are the optimum and not an "
          "approximation, and the report holds the proof: the duality gap of l1, the optimality residual of l2. deltae "
          "starts from both and makes the squares of the color differences least, at the readings or over all "
          "directions of a measured BRDF. Its mean difference is nowhere more than 0.01 above that of l1. It is "
          "slower, and the report tells how far from stationary it ended.");
  spec.option("lobes,n", "N", "3", &o.lobes, "use the best N flake lobes of the basis; 0 uses all")
      .from(0, 1000)
      .more("Of a measured BRDF at most N lobes are used, and each of them has to lower the error by 1 %.");
  spec.option("prune", "DE00", "0.1", &o.prune_de00, "drop lobes as long as no color moves by more; 0 drops none")
      .from(0, 100)
      .more("Only flake lobes are dropped.");
  spec.option("views", "lost|auto|none|DEG,...", "0,30,60", &o.views,
              "also fit weights for several angles of the viewer")
      .in("degrees from the normal: two or more, ascending")
      .more(
          "Weights for several views follow a color that turns with the view, and the two sides of specular of an "
          "interference paint. Between the views they are linear. The weights for all views stay in front of them, and "
          "the report tells what the views gain. A multi-angle instrument sees each view once or twice; between its "
          "readings, the weights rest on smoothness and not on data. lost takes the views of all readings of a paint "
          "of which a coat would change what is read: where one is met without the coat and by no weights for all "
          "views under it. auto does so too, and takes the views of readings that differ visibly at one aspecular "
          "angle. none gives no paint such weights; what a coat changes is then told under lost_to_coat.");
  spec.option("paint-time-limit", "S", "0.5", &o.paint_time_limit_s, "longest time for one paint; 0 is no limit")
      .from(0)
      .more(
          "After this time the best weights so far are taken. It holds for all fits that a paint takes, also for those "
          "of the report.");
  spec.heading = "output";
  spec.option("output,o", "FILE", "fitted.paints.xml", &o.output, "where the paints go; - is standard output");
  spec.option("color-map", "FOLDER", "maps", &o.color_map, "also make color maps, as FOLDER/name.exr")
      .more(
          "A paint gets a map if its readings meet flakes at two or more angles of incidence, a degree apart within "
          "the "
          "coat, and the paint written names the map. Several views under one light do so: light at 45 degrees meets "
          "the flakes that show it at 15 and at 110 degrees from specular at different angles.");
  spec.option("color-map-model", "MODEL", "isolines", &o.color_map_model, "what carries readings to other directions")
      .one_of({"better", "isolines", "aspecular"})
      .more(
          "isolines see the same flakes at the same angle, which follows interference paints out of the plane. "
          "aspecular takes the color from the aspecular angle alone, which is closer on near-matt paints. better "
          "leaves out each reading in turn, predicts it from the others by both, and takes the model that errs "
          "less; the report and the file tell both errors. A message tells whether the two errors differ by more "
          "than two standard errors.");
  spec.option("tilts", "none|N,...", "8,16", &o.tilts, "look-ups of tilted lobes that stand for a color map")
      .more(
          "A paint that has a color map by isolines also gets tilted lobes, by which pictures under image light come "
          "close to the map. Each number makes a set that takes so many look-ups of prefiltered maps at a point; more "
          "look-ups are closer and slower, and render-osmesa chooses between the sets. A number that hardly helps "
          "makes no set. A paint gets none where its lobes are within a visible difference of the map, nor where its "
          "left-out readings do not tell, by two standard errors, that isolines are better than the aspecular angle, "
          "unless --color-map-model asks for isolines. A fit takes seconds.");
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
      {"paints[].name", "name of the paint"},
      {"paints[].method", "one of l1, l2 and deltae"},
      {"paints[].status",
       "one of optimal; not_converged, where a solver gave up and the best weights found are written; stalled, where "
       "deltae ended with a gap, as it may at nearly gray colors, whose hues jump; bounded, where it ended with a gap "
       "because "
       "its mean difference would have become larger than that of l1; "
       "time_limit, where the best weights until then are written; and failed, where the paint is passed on unfitted"},
      {"paints[].time_us", "time of the fit, without reading and writing XML"},
      {"paints[].objective", "weighted norm of the error over rows and channels, in L* if the weights are perceptual"},
      {"paints[].plain_objective", "the same norm without weights, in reflectance factor"},
      {"paints[].optimality_gap", "proven distance from the optimum, relative to the norm of the target"},
      {"paints[].active_lobes", "number of lobes that have any weight, including the mirror"},
      {"paints[].unseen_exponents", "lobes that no reading sees; their flake weight is 0"},
      {"paints[].dropped_exponents", "lobes that --lobes or --prune left out"},
      {"paints[].de00_max", "largest CIEDE2000 difference at the readings"},
      {"paints[].de00_mean", "mean CIEDE2000 difference at the readings"},
      {"paints[].de00_by_geometry", "difference at each geometry"},
      {"paints[].lost_to_coat",
       "the readings that are met exactly without the coat and not with it, with their differences; by deltae, those "
       "that the l1 fit misses from which it starts"},
      {"paints[].views_for_coat",
       "whether the paint has weights for the views of its readings because no others meet them under its coat"},
      {"paints[].limit",
       "what keeps the worst reading from being met better: the working space, two sides of specular, a channel that "
       "grows away from specular, or the basis; empty below dE00 0.5"},
      {"paints[].apart_de00", "largest difference of two readings at one aspecular angle"},
      {"paints[].floor_de00_mean", "for such readings, the least de00_mean that weights for all views can have"},
      {"paints[].incidences[]",
       "of a paint that was read at several angles of incidence, which are all fitted together: incidence_deg; "
       "readings, their number; de00_mean, their mean difference in this fit; and predicted_de00_mean, the same in a "
       "fit to the readings at the other angles alone, which tells by how much they disagree. Angles for which "
       "--paint-time-limit left no time are missing"},
      {"paints[].gamut_de00", "color that is lost because the working space has no negative channels"},
      {"paints[].glare_rows", "readings that are left out because they are within 10 degrees of specular"},
      {"paints[].gloss[]",
       "of each meter angle_deg and simulated_gu; where the paint states its gloss also stated_gu, and misfit_gu, "
       "which is the simulated gloss minus the stated one"},
      {"paints[].coat_range",
       "where several gloss readings are those of a coat of two scales: slopes, which is ggx or gaussian, and "
       "least_haze, probable and most_haze, each with the k, slope and haze of a coat (goniochrome-theory(7), SATIN). "
       "The probable coat is drawn. All coats between the other two have the same readings within two standard "
       "deviations of 0.1 GU, and look different"},
      {"paints[].brdf",
       "of a measured BRDF: the number of directions fitted; glare_directions and steep_directions, which are left "
       "out; relative_error_median and relative_error_p95 of the color triple, de00_median and de00_p95, all over the "
       "fitted directions; spike_albedo_45 of the coat; and, for files that are a grid, albedo_error, which is the "
       "share of the light from 0, 10, ..., 80 degrees that is reflected elsewhere than measured, specular included"},
      {"paints[].brdf.from_five_angles",
       "how well lobes that know only the readings at 15, 25, 45, 75 and 110 degrees predict the directions up to 60 "
       "degrees from the normal: directions is their number, and the median relative error is told by the aspecular "
       "angle (by_aspecular) and by the angle of the flakes in the coat (by_flake)"},
      {"paints[].views",
       "where there are weights for several views: de00_mean over the readings, or over the fitted directions of a "
       "measured BRDF; de00_mean_without, the same by the weights for all views; and their difference gain_de00"},
      {"paints[].message", "reason why a paint failed"},
      {"color_maps[].name", "with --color-map: the paint"},
      {"color_maps[].file", "file of its map"},
      {"color_maps[].rows", "readings that the map is made from"},
      {"color_maps[].glare_rows", "readings that are left out because they are within 10 degrees of specular"},
      {"color_maps[].grazing_rows", "readings left out for a direction more than 75 degrees from the normal"},
      {"color_maps[].illuminations", "number of different angles of incidence on the flakes, to 1 degree"},
      {"color_maps[].beyond_rows",
       "readings out of plane for which the map has no place, because they are beyond the critical angle; the map is "
       "compared with them"},
      {"color_maps[].model", "one of isolines and aspecular"},
      {"color_maps[].isolines_power",
       "1, 0.75 or 0.5, whichever predicts readings from others best: the smaller, the less a reading tells of other "
       "places"},
      {"color_maps[].isolines_de76", "mean CIE 1976 difference of a reading that isolines predict from the others"},
      {"color_maps[].aspecular_de76", "the same for the aspecular angle alone"},
      {"color_maps[].held_out_de76", "the one of these two for the model that the map has"},
      {"color_maps[].difference_error_de76",
       "standard error of the difference of both means, found from the lights, as readings of one light err together; "
       "null where there is only one"},
      {"color_maps[].compared_rows",
       "number of readings behind these figures; they are measured, and none of them is interpolated from others"},
      {"color_maps[].negative_share", "share of the map that is outside the working space"},
      {"without_tilts", "number of paints without tilted lobes because their readings do not support the map"},
      {"tilts[].name", "paint with a color map, unless --tilts is none"},
      {"tilts[].lobes_de00",
       "mean color difference between its lobes and the map, in lamps of several sizes all around"},
      {"tilts[].sets[].lookups", "look-ups of prefiltered maps that a set of tilted lobes takes"},
      {"tilts[].sets[].de00_mean", "mean color difference between the set and the map in the same lamps"},
      {"without_color_map", "number of paints whose readings do not make a map"},
      {"fits_per_s", "fits a second, without reading and writing"},
      {"fitted", "number of paints that got lobes"},
      {"failed", "number of paints that are passed on unfitted"},
      {"de00_mean", "mean color difference over the readings of all paints"},
      {"de00_p95", "difference that 95 % of the readings are below, to 0.01"},
      {"worst[]", "the five worst paints: name, geometry, de00 and limit"},
      {"contradicting", "number of paints with readings at one aspecular angle that differ visibly"},
      {"lost_to_coat", "number of readings that are met exactly without a coat and not with it"},
      {"views_for_coat", "number of paints with weights for views because no others meet their readings under a coat"},
      {"floor_de00_mean", "least de00_mean that weights for all views can have"},
      {"floor_de00_p95", "least de00_p95 that weights for all views can have"},
      {"warnings[]", "first messages about failed paints"}};
  spec.see_also = {"paint-convert(1)", "render-osmesa(1)", "goniochrome-paint(5)", "goniochrome-theory(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "fit-paint", .summary = "fit paints to a basis of cosine lobes"};
  spec.description = {
      "fit-paint reads paints, fits each of them to the exponents of a basis, and writes it on with its lobes. The "
      "lobes are a constant and, for each exponent and channel, one weight that is not negative; they bring the color "
      "at the measured aspecular angles as close as the basis allows. Everything else in a paint stays as it is, and "
      "lobes that it already had are replaced. Paints are written in the order in which they came, each as soon as it "
      "is done, so that a library of any size passes in constant memory.",
      "Compare two paints by the color that their lobes predict, and never by the weights themselves: noise of a tenth "
      "of a percent moves the weights by tens of percent while the color stays.",
      "Readings within 10 degrees of the mirror direction hold glare and are left out. A lobe that is too sharp for "
      "any reading to see gets no flake weight. Below the first reading, the flake highlight goes on rising at the "
      "rate that it had there, which is the least that any sum of lobes can do. Gloss readings at 20, 60 and 85 "
      "degrees set the gloss lobes and the mirror through a simulated gloss meter; what the lobes cannot meet is told "
      "in the report.",
      "A measured BRDF (" + brdf::measured_formats() +
          ") becomes one paint. It is fitted to all measured directions, in and out of plane, except those within 10 "
          "degrees of specular and those near grazing. What the flake leaves near specular goes to sharp lobes: to "
          "gray gloss with the reflectance of a coat, which grows toward grazing, and to colored flake. The report "
          "tells what the three gloss meters read of the coat's spike.",
      "Two readings at one aspecular angle may differ, as 45as15 and 45as-15 of many paints do. Lobes that know the "
      "aspecular angle alone cannot meet both. The summary tells how close such lobes can come at best; --views auto "
      "gives these paints weights for the views of these readings.",
      "A paint that has neither readings nor an appearance cannot be fitted. It is named, it passes unchanged, and the "
      "exit status is 1."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, FILE#NAMES, or measured BRDFs; standard input where "
                 "none is given",
                 &o.paints};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
