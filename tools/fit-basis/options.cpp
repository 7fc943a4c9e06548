#include "options.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "fit-basis",
      .summary = "choose the lobe exponents that serve a whole paint library best",
      .description = {"Reads paints and searches, for each number of lobes, the exponents for which the largest plus "
                      "the mean error over the library is least after every paint has been fitted to them. The "
                      "exponents are chosen once; fit-paint then fits single paints to them in microseconds, and "
                      "prefilter-envmap filters an environment once for all of them.",
                      "The search adds one lobe at a time to the best smaller set, from several starts. Its error "
                      "never rises with the number of lobes. The default method follows a power mean of the errors, "
                      "which tends to their maximum, by a quasi-Newton search; lm is the Levenberg-Marquardt search of "
                      "the source. Both end in a pattern search on the exact objective, and the errors reported are "
                      "exact.",
                      "The basis written is the one with the most lobes. The summary line "
                      "names the number of lobes from which on no "
                      "further lobe changes any paint of the library visibly."},
      .options = {{.name = "output",
                   .letter = 'o',
                   .value = "FILE",
                   .help = "where the basis with the most lobes goes, - is standard "
                           "output",
                   .target = &o.output},
                  {.name = "lobes",
                   .letter = 'n',
                   .value = "N|A..B",
                   .help = "number of lobes, or a range of numbers",
                   .target = &o.lobes},
                  {.name = "name",
                   .value = "NAME",
                   .help = "name of the basis; b and the number of lobes if not given",
                   .target = &o.name},
                  {.name = "mirror", .help = "give the basis a mirror lobe for clear coats", .target = &o.mirror},
                  {.name = "method",
                   .letter = 'm',
                   .value = "METHOD",
                   .help = "how the exponents are searched",
                   .target = &o.method,
                   .choices = {"power-mean", "lm"}},
                  {.name = "starts",
                   .value = "N",
                   .help = "starting points for each number of lobes",
                   .target = &o.starts,
                   .low = 1,
                   .high = 1000},
                  {.name = "angles",
                   .value = "N",
                   .help = "sample angles of each paint",
                   .target = &o.angles,
                   .low = 3,
                   .high = 1000},
                  {.name = "target",
                   .letter = 't',
                   .value = "TARGET",
                   .help = "what is sampled: the readings with a monotone curve "
                           "between them (measured), or the quadratic of face, "
                           "flop and travel (curve)",
                   .target = &o.target,
                   .choices = {"measured", "curve"}},
                  {.name = "weights",
                   .letter = 'w',
                   .value = "WEIGHTS",
                   .help = "weigh errors by their effect on lightness (perceptual), "
                           "or all alike (plain)",
                   .target = &o.weights,
                   .choices = {"perceptual", "plain"}},
                  {.name = "visible",
                   .value = "DE00",
                   .help = "the color difference below which a further lobe counts as "
                           "invisible",
                   .target = &o.visible_de00,
                   .low = 0},
                  {.name = "each",
                   .value = "PREFIX",
                   .help = "write every set too, as PREFIX<number>.basis.xml",
                   .target = &o.each},
                  {.name = "table",
                   .value = "FILE",
                   .help = "write exponents and errors of every set as CSV",
                   .target = &o.table},
                  {.name = "plot",
                   .value = "FILE",
                   .help = "draw exponents and errors against the number of lobes as SVG",
                   .target = &o.plot}},
      .inputs = cli::Positional{.value = "PAINTS",
                                .help = "paint XML files or measured BRDFs, - is standard input",
                                .target = &o.paints,
                                .low = 0},
      .examples = {{"fit-basis --lobes 5 testdata/paints.paints.xml -o my.basis.xml",
                    "chooses five exponents for the sample library"},
                   {"fit-basis --lobes 1..4 --starts 2 --table sets.csv --plot "
                    "sets.svg testdata/paints.paints.xml -o my.basis.xml",
                    "shows what each further lobe gains"}},
      .report = {{"sets[].lobes", "number of lobes"},
                 {"sets[].exponents", "ascending"},
                 {"sets[].max_error", "largest weighted RMS error of a paint, in L* if perceptual"},
                 {"sets[].mean_error", "mean over the paints"},
                 {"sets[].objective", "max_error + mean_error, what the search makes least"},
                 {"sets[].de00_max", "largest color difference of any paint at any sample angle"},
                 {"sets[].log_regularity",
                  "squared correlation of the exponents' logarithms with their rank, 1 is regular"},
                 {"sets[].worst", "the paint with the largest error"},
                 {"sets[].time_s", "time of the search for this number"},
                 {"sets[].starts", "starting points tried"},
                 {"sets[].evaluations", "evaluations of the objective"},
                 {"paints", "number of paints"},
                 {"enough_lobes",
                  "the number beyond which no paint changes by "
                  "the color difference of --visible"}},
      .see_also = {"fit-paint(1)", "prefilter-envmap(1)"},
  };
  add_common_options(spec, o.common, {cli::Common::kExplain, cli::Common::kTimeLimit, cli::Common::kSeed});
  return spec;
}

}  // namespace goniochrome::tool
