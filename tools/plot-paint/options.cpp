#include "tool.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "plot-paint", .summary = "draw paints, their curves and their lobes"};
  spec.description = {
      "plot-paint reads paints and draws each of them: L*, a* and b* against the aspecular angle, with the readings as "
      "points, the curve that a fit follows and the color of the lobes; on a page also the way of the color through "
      "the "
      "a*b* plane, in a ring of hues and with an arrow in the direction of the travel, and the colors side by side; "
      "the "
      "part of every lobe; for each channel, a "
      "polar diagram and a surface of the flake with light from 45 degrees; and, for several angles of incidence, the "
      "hemisphere of viewers as a square of colors, the target beside the fit. One paint makes a page. Several make a "
      "sheet with a row for each.",
      "The surfaces show the square root of the reflectance factor, so that the body under the highlight can be seen.",
      "The target of a square is the curve of the paint, which knows the aspecular angle alone, or a measured BRDF of "
      "the same name. The square is the map of Shirley and Chiu, which keeps areas equal: the normal is in the middle, "
      "grazing views are on the border, the light comes from the left, and a black dot on the right marks the mirror "
      "direction. Target and fit have the same exposure.",
      "A PNG is made by the program rsvg-convert, which must be installed (Debian package librsvg2-bin)."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.libraries};
  spec.heading = "what is drawn";
  spec.option("paint,p", "NAME", "candy_red", &o.names, "draw this paint only");
  spec.option("brdf", "FILE", "candy_red.binary", &o.brdfs, "measured BRDF to compare with the paint of the same name");
  spec.option("incidence", "DEG,...", "15,45,65", &o.incidence_deg, "angles of the light for the squares")
      .from(0, 89)
      .in("degrees from the normal");
  spec.flag("color-map", &o.color_map, "draw the color map of each paint instead")
      .more(
          "The page has the colors in the plane of incidence over the angles of light and viewer, and the "
          "hemisphere of viewers as squares of colors. Directions that no reading covers are hatched: those within "
          "10 degrees of specular or more than 75 degrees from the normal, those beyond the critical angle of the "
          "coat, where isolines do not reach, and those more than 10 degrees from the nearest reading. Paints "
          "without a color map are left out, and a warning says so.");
  spec.flag("sparkle", &o.sparkle, "draw the contrast of the grain of each paint against distance instead")
      .more(
          "The contrast is the standard deviation over the mean of patches one minute of arc wide, in the sun at 45 "
          "degrees, for viewers 15, 25 and 45 degrees from specular; see goniochrome-flakes(7). Below are plates as an "
          "eye sees them from 0.3, 1 and 3 m, in the sun and under a cloud. What an instrument tells of sparkle stands "
          "beside it as it is. Paints without flakes or without lobes are left out, and a warning says so.");
  spec.option("hud", "VIEW", "view.exr", &o.hud, "draw the rings of each paint on this view instead")
      .more(
          "VIEW is a picture of render-osmesa --aov aspecular. The lines are where the aspecular angle to the first "
          "light is 15 degrees, 45 degrees, and that at which the paint stops traveling; below the picture is the "
          "color of the paint at each. The lines follow the mesh, so that one sees where on a body a change of face, "
          "flop or travel will be seen.");
  spec.heading = "output";
  spec.option("output,o", "FILE", "sheet.svg", &o.output, "where the page or sheet goes; - is standard output")
      .more(
          "It is a PNG if the name ends in .png, else an SVG. With {name}, {code} or {index} in it, every paint gets a "
          "page of its own, as in -o 'page-{name}.svg'.");
  spec.option("pages", "FOLDER", ".", &o.pages, "write a page for every paint, as FOLDER/name.svg or .png");
  spec.option("format", "FORMAT", "png", &o.format, "format of these pages").one_of({"svg", "png"});
  cli::add_common_options(spec, o.common);
  spec.examples = {
      {"plot-paint --paint candy_red testdata/paints.paints.xml -o candy_red.svg",
       "draw the readings and the curve of one paint"},
      {"fit-paint -q -b testdata/b7.basis.xml testdata/paints.paints.xml | plot-paint -o sheet.svg",
       "draw a sheet of all paints with their lobes"},
      {"render-osmesa -q --mesh testdata/speed-shape.obj --light 30,50 --aov aspecular -o view.exr && plot-paint -p "
       "candy_red --hud view.exr testdata/paints.paints.xml -o rings.svg",
       "draw where on a body the face, the middle and the flop of a paint are seen"}};
  spec.report = {{"paints[].name", "name of the paint"},
                 {"paints[].file", "file that it was drawn to"},
                 {"paints[].lobes", "number of lobes drawn; 0 where the paint was not fitted"},
                 {"paints[].model", "with --color-map: isolines or aspecular"},
                 {"paints[].flakes_assumed", "with --sparkle: whether the flakes are usual ones of the class"},
                 {"paints[].target", "what the squares compare with: measured BRDF, curve or none"}};
  spec.see_also = {"fit-paint(1)", "paint-convert(1)", "goniochrome-flakes(7)", "goniochrome-lobes(7)"};
  return spec;
}

}  // namespace goniochrome::tool
