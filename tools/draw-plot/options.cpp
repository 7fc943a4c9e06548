#include "tool.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "draw-plot", .summary = "draw a table of points as a plot"};
  spec.description = {
      "draw-plot reads a table of points and writes one plot as SVG, in the colors and with the axes of every other "
      "plot of Goniochrome. The table has commas, semicolons or tabs, and the headings series, x and y in any order; "
      "--series, --x and --y name others, so that the tables of other tools can be drawn. Two more headings may "
      "be there: style (line, points, both, dashed or rings) and color (#rrggbb; where none is given, the next of "
      "seven "
      "colors that color-blind readers can tell apart). The first row of a series decides its style and color. Series "
      "are drawn in the order of their first rows, and the legend names them; a series without a name has no entry.",
      "A row that has no number for x or y (an empty cell, - or none) breaks the line of its series. A logarithmic "
      "axis shows only values above "
      "0, and a warning tells how many points that leaves out."};
  spec.inputs = {"TABLE", "table; standard input where none is given", &o.table, 0, 1};
  spec.heading = "columns";
  spec.option("series", "HEADINGS", "light_deg,misalignment_deg", &o.series, "columns that tell series apart");
  spec.option("x", "HEADING", "view_deg", &o.x, "column along the x axis");
  spec.option("y", "HEADING", "de", &o.y, "column along the y axis");
  spec.option("style", "STYLE", "points", &o.style, "style of a table without the heading style")
      .one_of({"line", "points", "both", "dashed", "rings"});
  spec.heading = "plot";
  spec.option("title", "TEXT", "Library", &o.title, "text above the plot");
  spec.option("x-label", "TEXT", "'angle (deg)'", &o.x_label, "text along the x axis, with its unit")
      .more("Without it the heading of the column stands there.");
  spec.option("y-label", "TEXT", "'L*'", &o.y_label, "text along the y axis, with its unit; as --x-label");
  spec.option("logarithmic", "AXES", "y", &o.logarithmic, "axes that are logarithmic")
      .one_of({"none", "x", "y", "both"});
  spec.option("width", "PX", "800", &o.width, "width of the plot").from(200, 10000);
  spec.option("height", "PX", "500", &o.height, "height of the plot").from(150, 10000);
  spec.heading = "output";
  spec.option("output,o", "FILE", "library.svg", &o.output, "SVG to write; - is standard output");
  cli::add_common_options(spec, o.common);
  spec.examples = {
      {"paint-stats testdata/paints.paints.xml | draw-plot --series class --x flop_index --y chroma_index --style "
       "points "
       "-o library.svg",
       "draw a library by two of its indices, each class in its color"},
      {"goniogeom-index testdata/paints.paints.xml#silver_fine --lights 30,45 --curve - -o index.tsv | draw-plot "
       "--series light_deg,misalignment_deg --x view_deg --y de -o curve.svg",
       "draw how far two panels of one paint differ from every side"},
      {"paint-stats testdata/paints.paints.xml | draw-plot --series class --x L15 --y L110 --style points -o light.svg",
       "draw the lightness of face and flop against each other"}};
  spec.report = {{"series[]: label, points, left_out", "what was drawn, and how many points an axis left out"}};
  spec.see_also = {"paint-stats(1)", "goniogeom-index(1)", "fit-basis(1)"};
  return spec;
}

}  // namespace goniochrome::tool
