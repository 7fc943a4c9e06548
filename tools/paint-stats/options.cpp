#include "tool.h"

#include "color/color_difference.h"
#include "paint/metrics.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

// The columns as the manual lists them: their names come from the table that makes them.
std::string column_list() {
  std::string text = "The metrics are";
  for (const paint::MetricColumn& column : paint::metric_columns())
    text += std::string(&column == paint::metric_columns().data() ? " " : "; ") + column.name + ", " + column.meaning;
  return text + ".";
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "paint-stats",
      .summary = "tell flop, chroma and hue-shift index and other figures of paints, and pick paints by them"};
  spec.description = {
      "paint-stats reads paints and writes a table. Each paint has one line with its name, code and class, its "
      "metrics, the source of the colors behind them, and flags. With --where, only the paints for which a condition "
      "holds are written. With --format paints, the paints themselves are written, so that the tool stands as a filter "
      "between other tools. Paints go out in the order in which they came, each as soon as it is done, in constant "
      "memory.",
      column_list(),
      "The indices rest on the colors at 15, 45 and 110 degrees. The source of these colors is rows where all three "
      "are measured, curve where the paint states a curve, and fitted where a curve is fitted to its rows. A figure "
      "that does not apply is n/a, in JSON null: a hue shift of a paint without hue, or a residual where rows or curve "
      "are missing. A flop that is lighter than the face has a negative flop index.",
      "The flags are: dark, where the flop index moves by more than 1 when the L* behind it move by 0.1, so that it "
      "says nothing; achromatic, where the face has a chroma below 1 and so no hue; through_gray, where the color "
      "passes so close to gray that the sense of the hue travel is noise; gamut, where the working space loses more "
      "than 1 dE00 of some color; no_color, where there are neither rows nor a curve.",
      "The report and --format json hold the same figures as the table; and, as textures, what an instrument told of "
      "sparkle, graininess or coarseness, with its geometry, the version of its scale and the instrument.",
      "# Conditions\nA condition of --where compares metrics, numbers and the texts name, code, class, source and "
      "flags by < <= > >= == !=. Comparisons are joined by && || ! (or by the words and, or, not) and parentheses, as "
      "in \"class==metallic and not flags==dark\". A figure that does not apply makes a comparison false; "
      "hue_shift_index==na asks for it. Where no paint matches, the exit status is 1.",
      "# Scores\n--score compares the curve of a paint, its lobes and its color map, where it has them, with measured "
      "directions. Directions less than 10 degrees from specular or more than 75 degrees from the normal are left out "
      "and counted. The table has one line for each model: the number of directions, and the mean, the 95th percentile "
      "and the largest difference by --formula, and the mean and the 95th percentile of the CIE 1976 difference. A "
      "measured BRDF is for the paint that has the name of its file, or else for all paints.",
      "# Other light\n--illuminant adds a column inconstancy_NAME for each light: the color difference between the "
      "color under the illuminant of the readings and under this one, to an eye that has adapted to each of them by "
      "CMCCAT2000, at the geometry where it is largest. It is n/a for paints without spectra. With --standard there is "
      "also metamerism_NAME, the special metamerism index of CIE 15 at the geometry where it is largest: the "
      "difference under this light of two paints that match under the light of the readings. The columns stand behind "
      "all others, and --where does not know them."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.inputs};
  spec.heading = "selection";
  spec.option("where,w", "CONDITION", "'flop_index>=17 && chroma_index<5'", &o.where,
              "write only the paints for which this holds")
      .more(
          "Metrics, numbers and texts are compared by < <= > >= == !=, and joined by && || !. See Conditions.");
  spec.flag("classify", &o.classify, "infer the class of paints that state none from their readings")
      .more(
          "See goniochrome-paint(7), \"CLASSES\". --where and --format paints see the inferred class, and a "
          "last "
          "column of the table, class_source, tells it from a stated one. Where the readings decide nothing, the "
          "class stays unknown.");
  spec.heading = "comparison";
  spec.option("score", "TABLE", "cayman.brdf", &o.score, "compare the models of paints with measured directions")
      .more(
          "TABLE is a measured BRDF, or paint XML or CSV with readings of paints of the same names. See Scores.");
  spec.option("illuminant", "NAME,...", "A,F11", &o.illuminants, "tell how the colors change in other light")
      .more(
          "goniochrome-paint(5), \"ILLUMINANTS\", lists the names. See Other light.");
  spec.option("standard", "PAINT", "fitted.xml#candy_red", &o.standard, "pair each paint with this one")
      .more(
          "PAINT is a file with one paint, or FILE#NAME. With --illuminant the table has metamerism. See Other light.");
  spec.option("formula", "FORMULA", "cmc:2:1", &o.formula, "formula of these color differences")
      .more("It is one of " + color::formula_words() +
            "; see goniochrome-color(7), \"COLOR DIFFERENCES\". With --score its columns are named after it, de00 "
            "where it is CIEDE2000, and the readings are the standard.");
  add_keep_going(spec, "keep-going,k", o.keep_going, "paints that cannot be read");
  spec.heading = "output";
  add_table_options(spec, o.output, o.format, "the paints themselves, with every element kept", "paint");
  cli::add_common_options(spec, o.common, {.explain = true});
  spec.examples = {
      {"paint-stats testdata/paints.paints.xml", "print the table of a library"},
      {"paint-stats --where 'flop_index>=17 && chroma_index<5' testdata/paints.paints.xml",
       "list bright flops of constant color"},
      {"paint-stats -w 'class==metallic and L15>60' -f paints testdata/paints.paints.xml | fit-paint -q --basis "
       "testdata/b5.basis.xml -o light.paints.xml",
       "fit the light metallics of a library and leave the rest out"},
      {"paint-stats --classify -w 'class==metallic' -f paints testdata/paints.paints.xml -o metallics.paints.xml",
       "collect what seems to be a metallic in a table that knows no classes"},
      {"paint-stats -w 'flags==through_gray' -o turning.paints.xml testdata/paints.paints.xml",
       "collect the paints that change their hue by way of gray; the ending says that paints are wanted"}};
  spec.report = {{"paints[].name", "name of the paint; beside it stand code, class, source and flags[]"}};
  for (const paint::MetricColumn& column : paint::metric_columns())
    spec.report.push_back({std::string("paints[].") + column.name, column.meaning});
  spec.report.insert(
      spec.report.end(),
      {{"read", "number of paints read"},
       {"paints[].under.NAME",
        "with --illuminant: inconstancy and, with --standard, metamerism, each with "
        "its color difference by geometry"},
       {"paints[].textures[]", "quantity, geometry, version, instrument and value, where there are any"},
       {"paints[].class_source", "with --classify: stated, inferred, or - where the class is unknown"},
       {"inferred, undecided", "with --classify: number of paints that state no class and got one, or none"},
       {"matched", "number of paints written"},
       {"left_out", "number of paints that --keep-going left out"},
       {"scores[]",
        "with --score: name, model, rows, left_out, de00_mean, de00_p95, de00_max, or "
        "those of another formula, de76_mean and de76_p95 of each model of a paint"},
       {"paints_per_s", "paints a second, without reading and writing"},
       {"warnings[]", "messages about paints left out"}});
  spec.see_also = {"colorsnap(1)", "paint-convert(1)", "paint-edit(1)", "goniochrome-paint(7)"};
  return spec;
}

}  // namespace goniochrome::tool
