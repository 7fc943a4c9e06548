#include "options.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "plot-paint",
      .summary = "draw paints, their curves and their lobes",
      .description =
          {"Reads paints and draws each: L*, a* and b* against aspecular angle, with the readings as points, the curve "
           "that a fit follows and the color of the lobes; every lobe's own part; a polar diagram and a surface of the "
           "flake for each channel, with light from 45 deg; and, for several angles of incidence, the hemisphere of "
           "viewers as a square of colors, target beside fit. One paint makes a page, several a sheet with a row "
           "each.",
           "The surfaces show the square root of the reflectance factor, so that the body under the highlight is seen.",
           "The target of a square is the curve of the paint, which knows the aspecular angle alone, or a measured "
           "BRDF that is given for it and named like it. The square is the map of Shirley and Chiu with equal areas: "
           "the normal in the middle, grazing views on the border, light from the left, its mirror direction on the "
           "right. A black dot marks the mirror direction; target and fit have one exposure.",
           "A PNG is made by rsvg-convert, which must be there for it (Debian package librsvg2-bin)."},
      .options = {{.name = "output",
                   .letter = 'o',
                   .value = "FILE",
                   .help = "where the page or sheet goes, as PNG if it ends in .png, else as SVG; - is standard output",
                   .target = &o.output},
                  {.name = "pages",
                   .value = "FOLDER",
                   .help = "write a page for every paint, as FOLDER/name.svg or .png, instead of a sheet",
                   .target = &o.pages},
                  {.name = "format",
                   .value = "FORMAT",
                   .help = "of the pages",
                   .target = &o.format,
                   .choices = {"svg", "png"}},
                  {.name = "paint",
                   .letter = 'p',
                   .value = "NAME",
                   .help = "draw this paint only; may be given several times",
                   .target = &o.names},
                  {.name = "brdf",
                   .value = "FILE",
                   .help = "a measured BRDF to hold against the paint of the same name; may be given several times",
                   .target = &o.brdfs},
                  {.name = "incidence",
                   .value = "DEG,...",
                   .help = "angles of the light for the squares",
                   .target = &o.incidence_deg,
                   .low = 0,
                   .high = 89}},
      .inputs =
          cli::Positional{
              .value = "PAINTS", .help = "paint XML files, - is standard input", .target = &o.libraries, .low = 0},
      .examples = {{"plot-paint --paint candy_red testdata/paints.paints.xml -o candy_red.svg",
                    "draws the readings and curve of one paint"},
                   {"fit-paint -q -b testdata/b7.basis.xml testdata/paints.paints.xml | plot-paint -o sheet.svg",
                    "draws a sheet of all paints with their lobes"}},
      .report = {{"paints[].name", "name of the paint"},
                 {"paints[].file", "where it was drawn"},
                 {"paints[].lobes", "lobes drawn; 0 where it was not fitted"},
                 {"paints[].target", "what the squares compare with: measured BRDF, curve or none"}},
      .see_also = {"fit-paint(1)", "paint-convert(1)", "goniochrome-theory(7)"}};
  cli::add_common_options(spec, o.common, {});
  return spec;
}

}  // namespace goniochrome::tool
