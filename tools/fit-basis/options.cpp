#include "fitting.h"
#include "tool.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "fit-basis", .summary = "choose the lobe exponents that serve a whole paint library best"};
  spec.description = {
      "fit-basis reads paints and searches, for each number of lobes, the exponents that serve the library best: every "
      "paint is fitted to them as fit-paint(1) fits it, under its coat, and the largest error plus the mean error over "
      "the library is made least. An error is what a paint has beyond the error that a dense series of lobes leaves, "
      "since readings that contradict each other are met by no basis. The exponents are chosen once. After that, "
      "fit-paint(1) fits single paints to them in microseconds, and "
      "prefilter-envmap(1) filters an environment once for all of them.",
      "The search adds one lobe at a time to the best smaller set, from several starts, so that the error never rises "
      "with the number of lobes. A large library is searched on paints that represent it; see --representatives.",
      "The basis written is the one with the most lobes. The summary line names the number of lobes from which on no "
      "further lobe changes any paint of the library visibly."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, FILE#NAMES, or measured BRDFs; standard input where "
                 "none is given",
                 &o.paints};
  spec.heading = "search";
  spec.option("lobes,n", "N|A..B", "1..5", &o.lobes, "number of lobes, or a range of numbers");
  spec.option("method,m", "METHOD", "lm", &o.method, "how the exponents are searched")
      .one_of({"power-mean", "lm"})
      .more(
          "power-mean follows a power mean of the errors, which tends to their maximum, by a quasi-Newton search. lm "
          "is "
          "the Levenberg-Marquardt search of the source. Both end in a pattern search on the exact objective, and the "
          "errors reported are exact.");
  spec.option("starts", "N", "2", &o.starts, "number of starting points for each number of lobes").from(1, 1000);
  spec.option("representatives", "N", "0", &o.representatives,
              "number of paints on which a library of more than twice as many is searched; 0 searches all")
      .from(0, 1000000)
      .more(
          "The errors that are reported are those of the whole library. See goniochrome-lobes(7), \"The search\".");
  spec.option("visible", "DE00", "1", &o.visible_de00, "color difference below which a further lobe is invisible")
      .from(0);
  spec.heading = "what is fitted";
  add_target_options(spec, o.target, o.weights);
  spec.option("mirror", "WHICH", "yes", &o.mirror, "whether the basis has a mirror lobe, for clear coats")
      .one_of({"auto", "yes", "no"})
      .more("auto gives it one where a paint states gloss. The lobes then need not stand for the image in the coat.");
  spec.heading = "output";
  spec.option("output,o", "FILE", "my.basis.xml", &o.output,
              "where the basis with the most lobes goes; - is standard output");
  spec.option("name", "NAME", "car", &o.name, "name of the basis; b and the number of lobes if not given");
  spec.option("each", "PREFIX", "set-", &o.each, "write every set too, as PREFIX<number>.basis.xml");
  spec.option("table", "FILE", "sets.csv", &o.table, "write exponents and errors of every set as CSV");
  spec.option("plot", "FILE", "sets.svg", &o.plot, "draw exponents and errors against the number of lobes as SVG");
  cli::add_common_options(spec, o.common,
                          {.explain = true, .time_limit = "the search", .seed = "the starting points of the search"});
  spec.examples = {
      {"fit-basis --lobes 5 testdata/paints.paints.xml -o my.basis.xml",
       "choose five exponents for the sample library"},
      {"fit-basis --lobes 1..4 --starts 2 --table sets.csv --plot sets.svg testdata/paints.paints.xml -o my.basis.xml",
       "show what each further lobe gains"},
      {"fit-basis --lobes 3 'testdata/paints.paints.xml#silver_*' -o silver.basis.xml",
       "choose three exponents for the silvers alone"}};
  spec.report = {
      {"sets[].lobes", "number of lobes"},
      {"sets[].exponents", "the exponents, ascending"},
      {"sets[].max_error",
       "largest weighted RMS error of a paint beyond its floor, in L* if the weights are perceptual"},
      {"sets[].mean_error", "mean of this error over the paints"},
      {"sets[].objective", "the sum max_error + mean_error, which the search makes least"},
      {"sets[].de00_max", "largest color difference of any paint at any sample angle"},
      {"sets[].log_regularity",
       "squared correlation of the exponents' logarithms with their rank; 1 means that they are evenly spaced"},
      {"sets[].worst", "the paint with the largest error"},
      {"sets[].time_s", "time of the search for this number of lobes"},
      {"sets[].starts", "number of starting points that were tried"},
      {"sets[].evaluations", "number of evaluations of the objective"},
      {"sets[].searched_paints", "number of paints that the search looked at; the errors are those of all paints"},
      {"sets[].at_bound", "whether an exponent lies at the low or the high end of the domain"},
      {"floor_max, floor_mean",
       "the errors that a dense series of lobes leaves, the largest and the mean of the paints"},
      {"mirror", "whether the basis has a mirror lobe"},
      {"paints", "number of paints"},
      {"enough_lobes", "the number beyond which no paint changes by the color difference of --visible"}};
  spec.see_also = {"fit-paint(1)", "prefilter-envmap(1)", "goniochrome-lobes(7)"};
  return spec;
}

}  // namespace goniochrome::tool
