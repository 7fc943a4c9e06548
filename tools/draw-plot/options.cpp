#include "options.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "draw-plot";
  spec.summary = "draw a table of points as a plot";
  spec.description = {
      "draw-plot reads a table of points and writes one plot as SVG, in the colors and with the axes of every other "
      "plot of Goniochrome. The table is CSV with the headings series, x and y in any order, and, if wanted, style "
      "(line, points, both, dashed or rings) and color (#rrggbb; where none is given, the next of seven that "
      "color-blind readers can tell apart), which are those of the first row of a series. Series are drawn in the "
      "order of their first rows and named in the legend, save one whose name is empty.",
      "A row without a number for x or y breaks the line of its series. On a logarithmic axis only values above 0 are "
      "drawn; how many points that leaves out is told.",
  };
  spec.inputs = {.value = "TABLE", .help = "CSV; standard input where none is given", .target = &o.table, .high = 1};
  spec.options = {
      {.name = "output", .letter = 'o', .value = "FILE", .help = "SVG to write", .target = &o.output},
      {.name = "title", .value = "TEXT", .help = "written above the plot", .target = &o.title},
      {.name = "x-label", .value = "TEXT", .help = "written along the x axis, with its unit", .target = &o.x_label},
      {.name = "y-label", .value = "TEXT", .help = "written along the y axis, with its unit", .target = &o.y_label},
      {.name = "logarithmic",
       .value = "AXES",
       .help = "axes that are logarithmic",
       .target = &o.logarithmic,
       .choices = {"none", "x", "y", "both"}},
      {.name = "width", .value = "PX", .help = "width", .target = &o.width, .low = 200, .high = 10000},
      {.name = "height", .value = "PX", .help = "height", .target = &o.height, .low = 150, .high = 10000},
  };
  spec.examples = {
      {"paint-stats testdata/paints.paints.xml | awk -F'\\t' 'BEGIN { print \"series,x,y,style\" } "
       "NR > 1 { print $3 \",\" $4 \",\" $6 \",points\" }' | "
       "draw-plot --x-label 'flop index' --y-label 'chroma index' -o library.svg",
       "draws a library by two of its indices, each class in its color."},
  };
  spec.report = {{"series[]: label, points, left_out", "what was drawn, and what an axis left out"}};
  spec.see_also = {"paint-stats(1)", "fit-basis(1)"};
  cli::add_common_options(spec, o.common, {});
  return spec;
}

}  // namespace goniochrome::tool
