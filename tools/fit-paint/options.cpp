#include "options.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "fit-paint",
      .summary = "fit paints to a basis of cosine lobes",
      .description =
          {"Reads paints, fits each to the exponents of the basis, and writes it on with its lobes element: a constant "
           "and one non-negative weight per lobe and working-space channel, such that the color at the measured "
           "aspecular angles comes out as close as the basis allows. Everything else in the paint passes unchanged; "
           "lobes that were there are replaced. Paints are written in the order they came, as soon as they are done, "
           "in constant memory.",
           "The weights of l1 and l2 are the optimum of their norm, not an approximation, and the report holds the "
           "proof: the duality gap (l1) or the optimality residual (l2). deltae goes on from both to the nearest least "
           "color difference, and reports how far from stationary it ended. Compare paints by the color their lobes "
           "predict, never by the weights themselves: a tenth of a percent of noise moves weights by tens of percent "
           "while the color stays.",
           "Readings within 10 deg of the mirror direction hold glare and are left out. Lobes too sharp to be seen by "
           "any reading get no flake weight. Below the first reading the flake highlight goes on rising at the rate "
           "it had there, which is the least that any sum of lobes can do. Gloss readings (20, 60, 85 deg) set the "
           "gloss lobes and the mirror through a simulated gloss meter; what they cannot meet is told in the report.",
           "A measured BRDF (MERL .binary, Cornell .brdf, NVIDIA .mbsdf, RGL _rgb.bsdf) becomes one paint, fitted to "
           "all its directions but those within 10 deg of specular and near grazing, in and out of plane. What the "
           "flake leaves near specular goes to sharp lobes: gray gloss with the reflectance of a coat, which grows "
           "toward grazing, and flake in color. What the spike of the coat reads in the three gloss meters is "
           "reported.",
           "With --views every lobe has weights for several angles of the viewer, linear between them, which follow "
           "color that turns with the view and the two sides of specular of an interference paint. The weights for all "
           "views stay in front of them, and the report tells what the views gain. Readings of a multi-angle "
           "instrument see each view once or twice: between them the weights rest on smoothness, not on data.",
           "Readings at one aspecular angle that differ, as 45as15 and 45as-15 of many paints do, contradict each "
           "other for lobes that know the aspecular angle alone. The summary tells how near such lobes can come at "
           "best; --views auto gives those paints weights for the views of these readings.",
           "A paint that cannot be fitted (no reading, no appearance) is named, passes unchanged, and the exit status "
           "is 1."},
      .options =
          {{.name = "basis",
            .letter = 'b',
            .value = "FILE",
            .help = "the basis of exponents to fit to",
            .target = &o.basis,
            .required = true},
           {.name = "output",
            .letter = 'o',
            .value = "FILE",
            .help = "where the paints go, - is standard output",
            .target = &o.output},
           {.name = "method",
            .letter = 'm',
            .value = "METHOD",
            .help = "least absolute deviations (l1), least squares (l2), or least color difference at the readings "
                    "(deltae, slower)",
            .target = &o.method,
            .choices = {"l1", "l2", "deltae"}},
           {.name = "target",
            .letter = 't',
            .value = "TARGET",
            .help = "fit the readings with a monotone curve between them (measured), or the quadratic curve of face, "
                    "flop and travel (curve)",
            .target = &o.target,
            .choices = {"measured", "curve"}},
           {.name = "weights",
            .letter = 'w',
            .value = "WEIGHTS",
            .help = "weigh errors by their effect on lightness, so that a dark flop counts (perceptual), or all alike "
                    "(plain)",
            .target = &o.weights,
            .choices = {"perceptual", "plain"}},
           {.name = "gloss",
            .letter = 'g',
            .value = "GU|ANGLE:GU,...",
            .help = "gloss to assume for paints that state none: at 60 deg, or at several of 20, 60 and 85 deg as in "
                    "20:80,60:90; 0 leaves them matt",
            .target = &o.gloss},
           {.name = "lobes",
            .letter = 'n',
            .value = "N",
            .help = "use the best N flake lobes of the basis; of a measured BRDF at most N, as long as each lowers the "
                    "error by 1 %; 0 uses all",
            .target = &o.lobes,
            .low = 0,
            .high = 1000},
           {.name = "prune",
            .value = "DE00",
            .help = "drop flake lobes as long as no color moves by more than this; 0 drops none",
            .target = &o.prune_de00,
            .low = 0,
            .high = 100},
           {.name = "views",
            .value = "auto|DEG,...",
            .help =
                "fit weights for these angles of the viewer from the normal too, ascending, at least two; auto takes "
                "the views of readings that differ visibly at one aspecular angle, and none for other paints",
            .target = &o.views},
           {.name = "steepest",
            .value = "DEG",
            .help = "of measured BRDFs, leave out directions farther than this from the normal",
            .target = &o.steepest_deg,
            .low = 0,
            .high = 90},
           {.name = "paint-time-limit",
            .value = "S",
            .help = "seconds for one paint, after which the best weights so far are taken; 0 is none",
            .target = &o.paint_time_limit_s,
            .low = 0},
           {.name = "color-map",
            .value = "FOLDER",
            .help = "also make a color map of every paint that was read at two or more angles of incidence, as "
                    "FOLDER/name.exr, and name it in the paint",
            .target = &o.color_map}},
      .inputs = cli::Positional{.value = "PAINTS",
                                .help = "paint XML files or measured BRDFs, - is standard input",
                                .target = &o.paints,
                                .low = 0},
      .examples =
          {{"fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.paints.xml",
            "fits every sample paint and prints the worst"},
           {"paint-convert testdata/paints.csv -o - | fit-paint -b testdata/b7.basis.xml --gloss 90 -o car.paints.xml",
            "fits measurements from a CSV table, with the gloss of a clear coat"},
           {"fit-paint -b testdata/b5.basis.xml --method l2 --report fit.json testdata/paints.paints.xml -o /dev/null",
            "keeps only the report: the color difference at each geometry of each paint"}},
      .report = {{"paints[].name", "name of the paint"},
                 {"paints[].method", "l1, l2 or deltae"},
                 {"paints[].status",
                  "optimal; not_converged: a solver gave up, the best weights found; time_limit: the best until then; "
                  "failed: passed on unfitted"},
                 {"paints[].time_us", "time of the fit, without XML"},
                 {"paints[].objective", "weighted norm of the error over rows and channels, in L* if perceptual"},
                 {"paints[].plain_objective", "the same norm without weights, in reflectance factor"},
                 {"paints[].optimality_gap", "proven distance from the optimum, relative to the target's norm"},
                 {"paints[].active_lobes", "lobes with any weight, the mirror included"},
                 {"paints[].unseen_exponents", "lobes that no reading sees; flake weight 0"},
                 {"paints[].dropped_exponents", "lobes that --lobes or --prune left out"},
                 {"paints[].de00_max", "largest CIEDE2000 difference at the readings"},
                 {"paints[].de00_mean", "mean CIEDE2000 difference at the readings"},
                 {"paints[].de00_by_geometry", "the difference at each geometry"},
                 {"paints[].limit",
                  "why the worst reading is not met any better: the working space, two sides of specular, a channel "
                  "that grows away from specular, or the basis; empty below dE00 0.5"},
                 {"paints[].apart_de00", "the largest difference of two readings at one aspecular angle"},
                 {"paints[].floor_de00_mean",
                  "for such readings, what de00_mean of weights for all views cannot be below"},
                 {"paints[].gamut_de00", "color lost because the working space has no negative channels"},
                 {"paints[].glare_rows", "readings left out for being within 10 deg of specular"},
                 {"paints[].gloss[]",
                  "angle_deg, simulated_gu, and where the paint states it stated_gu and misfit_gu (simulated minus "
                  "stated)"},
                 {"paints[].brdf",
                  "of a measured BRDF: directions fitted, glare_directions and steep_directions left out, "
                  "relative_error_median and relative_error_p95 of the color triple, de00_median and de00_p95 over the "
                  "fitted ones, spike_albedo_45 of the coat, and for files that are a grid albedo_error: how much is "
                  "reflected elsewhere than measured, specular included, of light from 0, 10, ..., 80 deg"},
                 {"paints[].brdf.from_five_angles",
                  "how well lobes that know only the readings at 15, 25, 45, 75 and 110 deg predict the directions to "
                  "60 deg from the normal: directions, and the median relative error by the aspecular angle, and by "
                  "the angle of the flakes in the coat"},
                 {"paints[].views",
                  "with --views: de00_mean at the readings, or over the fitted directions of a measured BRDF, "
                  "de00_mean_without by the weights for all views, and their difference gain_de00"},
                 {"paints[].message", "why a paint failed"},
                 {"color_maps[].name", "with --color-map: the paint"},
                 {"color_maps[].file", "its map"},
                 {"color_maps[].rows", "readings that the map goes through"},
                 {"color_maps[].glare_rows", "readings left out for being within 10 deg of specular"},
                 {"color_maps[].grazing_rows", "readings left out for a direction more than 75 deg from the normal"},
                 {"color_maps[].illuminations", "different angles of incidence on the flakes, to 1 deg"},
                 {"color_maps[].held_out_de76", "mean CIE 1976 difference of a reading predicted from the others"},
                 {"color_maps[].negative_share", "share of the map that is outside the working space"},
                 {"without_color_map", "paints whose readings do not make a map"},
                 {"fits_per_s", "fits a second, without reading and writing"},
                 {"fitted", "paints that got lobes"},
                 {"failed", "paints passed on unfitted"},
                 {"de00_mean", "mean color difference over the readings of all paints"},
                 {"de00_p95", "95 % of the readings are below, to 0.01"},
                 {"worst[]", "the five worst paints: name, geometry, de00, limit"},
                 {"contradicting", "paints with readings at one aspecular angle that differ visibly"},
                 {"floor_de00_mean", "what de00_mean cannot be below by weights for all views"},
                 {"floor_de00_p95", "the same for de00_p95"},
                 {"warnings[]", "the first messages about failed paints"}},
      .see_also = {"paint-convert(1)", "render-osmesa(1)", "goniochrome-paint(5)", "goniochrome-theory(7)"}};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome::tool
