#include "options.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "relight",
      .summary = "an HDR image from one illuminant to another",
      .description =
          {"Reads an image made in light of one color and writes what it would be in light of another: every pixel is "
           "divided by the old illuminant and multiplied by the new one. The product of two colors is bilinear: each "
           "channel of the result takes from every pair of channels of light and reflectance, as overlapping spectra "
           "do, so that a red wall keeps some red in cyan light and a blue one is not black in yellow. White light "
           "changes nothing, whatever the operator.",
           "An illuminant is three linear working-space values, R,G,B with 1,1,1 for D65, or the name of a CIE "
           "illuminant. One that cannot be divided by, because a color channel would have to come out of nothing, is "
           "refused with its condition number.",
           "The output is linear Rec.2020, as an EXR. Colors may become negative where the old light cannot have shown "
           "them; they are counted, and kept unless --negative says zero.",
           "With --estimate no image is read: the operator of a color space is estimated from its color-matching "
           "functions and written as JSON, for --operator. scripts/estimate-operator makes such a table from CIE "
           "tables and primaries."},
      .options = {{.name = "output",
                   .letter = 'o',
                   .value = "FILE",
                   .help = "where the image goes (EXR), or with --estimate the operator; - is standard output",
                   .target = &o.output},
                  {.name = "from",
                   .value = "LIGHT",
                   .help = "the illuminant of the image: R,G,B or D65, D50, A",
                   .target = &o.from},
                  {.name = "to",
                   .value = "LIGHT",
                   .help = "the illuminant to change to: R,G,B or D65, D50, A",
                   .target = &o.to},
                  {.name = "operator",
                   .value = "OP",
                   .help = "the product of colors: the published table for camera sensors (iso), estimated for the "
                           "working space (working), channel by channel (plain), or a JSON file",
                   .target = &o.op},
                  {.name = "transfer",
                   .value = "LIST",
                   .help = "how much red, green and blue receive from the other channels, 0 to 1, in place of what the "
                           "operator says; 0,0,0 is the plain product",
                   .target = &o.transfer,
                   .low = 0,
                   .high = 1},
                  {.name = "negative",
                   .value = "WHAT",
                   .help = "what to do about negative channels: write them (keep) or 0 in their place (zero)",
                   .target = &o.negative,
                   .choices = {"keep", "zero"}},
                  {.name = "estimate",
                   .value = "FILE",
                   .help =
                       "estimate the operator from a table of color-matching functions, CSV of wavelength and three "
                       "values at equal steps, - is standard input",
                   .target = &o.estimate}},
      .inputs = cli::Positional{.value = "IMAGE",
                                .help = "an HDR image of any format, - is standard input",
                                .target = &o.image,
                                .low = 0,
                                .high = 1},
      .examples = {{"relight --from D65 --to A testdata/studio.exr -o evening.exr",
                    "a studio under incandescent lamps"},
                   {"relight --from 0.4,0.9,1 --to 1,0.9,0.1 --report r.json testdata/outdoor.exr -o "
                    "yellow.exr",
                    "blue sky to a yellow lamp, and the condition number of the division"},
                   {"relight --from D65 --to 0.2,0.4,1 --transfer 0,0,0 testdata/studio.exr -o plain.exr",
                    "the plain product of each channel, for comparison"}},
      .report = {{"condition", "condition number of the old illuminant; null with --estimate"},
                 {"negative_fraction", "share of pixels with a negative channel, before --negative"},
                 {"matrix", "what each pixel is multiplied by, row by row"},
                 {"operator", "its coefficients k, by output channel"},
                 {"pixels", "how many there are"},
                 {"warnings[]", "negative colors, and what was done about them"}},
      .see_also = {"prefilter-envmap(1)", "render-osmesa(1)", "goniochrome-theory(7)"}};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome::tool
