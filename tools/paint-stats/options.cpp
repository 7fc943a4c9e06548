#include "options.h"

#include "paint/metrics.h"

namespace goniochrome::tool {

namespace {

// The columns as the manual lists them: their names come from the table that makes them.
std::string column_list() {
  std::string text = "The metrics:";
  for (const paint::MetricColumn& column : paint::metric_columns())
    text += std::string(&column == paint::metric_columns().data() ? " " : "; ") + column.name + ", " + column.meaning;
  return text + ".";
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "paint-stats";
  spec.summary = "tell flop, chroma and hue-shift index and other figures of paints, and pick paints by them";
  spec.description = {
      "paint-stats reads paints and writes a table: one line a paint, with its name, code and class, its metrics, "
      "where the colors behind them come from, and flags. With --where it writes only the paints for which a condition "
      "holds; with --format paints it writes those paints themselves, every element kept, so that it stands as a "
      "filter between other tools. Paints go out in the order they came, as soon as they are done, in constant memory.",
      column_list(),
      "The indices rest on the colors at 15, 45 and 110 degrees: the measured rows where all three are there (source "
      "rows), else the curve the paint states (curve), else a curve fitted to its rows (fitted). A figure that does "
      "not apply is n/a, in JSON null: a hue shift without a hue, a residual without both rows and curve. A flop "
      "lighter than the face has a negative flop index.",
      "Flags: dark, the flop index moves by more than 1 when the L* behind it move by 0.1, so it says nothing; "
      "achromatic, the face has a chroma below 1 and no hue; through_gray, the color passes so close to gray that the "
      "sense of the hue travel is noise; gamut, the working space loses more than 1 dE00 of some color; no_color, "
      "neither rows nor a curve.",
      "A condition compares metrics, numbers and the texts name, code, class, source and flags by < <= > >= == !=, "
      "joined by && || ! (or: and, or, not) and parentheses: \"flop_index>=17 && chroma_index<5\", \"class==metallic "
      "and not flags==dark\". A figure that does not apply makes a comparison false; hue_shift_index==na asks for it. "
      "When no paint matches the exit status is 1.",
      "With --format json each paint is one JSON object on a line of its own. The report holds the same figures in one "
      "object, and takes memory for it."};
  spec.inputs = {.value = "PAINTS", .help = "paint XML files; standard input where none is given", .target = &o.inputs};
  spec.options = {
      {.name = "output",
       .letter = 'o',
       .value = "FILE",
       .help = "where to write, - is standard output",
       .target = &o.output},
      {.name = "format",
       .letter = 'f',
       .value = "FORMAT",
       .help = "a table (tsv), JSON lines (json), the paints themselves (paints), or by the output's ending: .xml is "
               "paints, .json or .jsonl is json, all else tsv (auto)",
       .target = &o.format,
       .choices = {"auto", "tsv", "json", "paints"}},
      {.name = "where",
       .letter = 'w',
       .value = "CONDITION",
       .help = "write only the paints for which this holds",
       .target = &o.where},
      {.name = "keep-going",
       .letter = 'k',
       .help = "leave out paints that cannot be read, with a warning each; the exit status is then 1",
       .target = &o.keep_going}};
  spec.examples = {
      {"paint-stats testdata/paints.paints.xml", "Prints the table of a library."},
      {"paint-stats --where 'flop_index>=17 && chroma_index<5' testdata/paints.paints.xml",
       "Lists bright flops of constant color."},
      {"paint-stats -w 'class==metallic and L15>60' -f paints testdata/paints.paints.xml | fit-paint -q --basis "
       "testdata/b5.basis.xml -o light.paints.xml",
       "Fits the light metallics of a library and leaves the rest out."},
      {"paint-stats -w 'flags==through_gray' -o turning.paints.xml testdata/paints.paints.xml",
       "Collects the paints that change their hue by way of gray; the ending says that paints are wanted."}};
  spec.report = {{"paints[].name", "name of the paint; also code, class, source and flags[]"}};
  for (const paint::MetricColumn& column : paint::metric_columns())
    spec.report.push_back({std::string("paints[].") + column.name, column.meaning});
  spec.report.insert(spec.report.end(), {{"read", "paints read"},
                                         {"matched", "paints written"},
                                         {"left_out", "paints left out by --keep-going"},
                                         {"paints_per_s", "paints a second, without reading and writing"},
                                         {"warnings[]", "messages about paints left out"}});
  spec.see_also = {"colorsnap(1)", "paint-convert(1)", "paint-edit(1)"};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome::tool
