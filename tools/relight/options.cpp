#include "color/spectrum.h"
#include "tool.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "relight", .summary = "convert an HDR image from one illuminant to another"};
  spec.description = {
      "relight reads an image that was made in light of one color, and writes what it would be in light of another. "
      "Every pixel is divided by the old illuminant and multiplied by the new one. This product of two colors is "
      "bilinear: each channel of the result takes a share from every pair of channels of light and reflectance, as "
      "overlapping spectra do. White light changes nothing, whatever the operator is.",
      "An illuminant is three linear working-space values R,G,B, where 1,1,1 is D65, or the name of a CIE illuminant. "
      "Some illuminants cannot be divided by, because a color channel would have to come out of nothing. They are "
      "refused, and the message tells their condition number.",
      "The output is an EXR in linear Rec.2020. Colors may become negative where the old light cannot have shown them. "
      "They are counted, and kept unless --negative says zero.",
      "# Operators\n" + color::operator_sentences()};
  spec.inputs = {"IMAGE", "an HDR image (EXR, HDR, TIFF or the like); - or none is standard input", &o.image, 0, 1};
  spec.heading = "light";
  spec.option("from", "LIGHT", "D65", &o.from, "illuminant of the image: R,G,B, " + color::spectral_illuminants());
  spec.option("to", "LIGHT", "0.2,0.4,1", &o.to, "illuminant to change to: R,G,B, " + color::spectral_illuminants());
  spec.heading = "product of colors";
  spec.option("operator", "OP[,SHARES]", "iso709", &o.op, "how colored light and surfaces multiply")
      .more("It is fitted, plain, iso, iso709, estimated or a JSON file. See Operators.");
  spec.option("transfer", "K,K,K", "0.1,0.1,0.1", &o.transfer, "what red, green and blue receive from other channels")
      .from(0, 1)
      .more(
          "The three numbers replace what the operator says, as those after a comma of --operator do. 0,0,0 is the "
          "plain product.");
  spec.option("estimate", "FILE", "functions.csv", &o.estimate, "estimate an operator and read no image")
      .more(
          "The operator is estimated from the color-matching functions of a color space, and written as JSON for "
          "--operator. The table is CSV with a wavelength and three values in each row, at equal steps; a first row "
          "may "
          "name its columns r, g and b or x, y and z, in any order; - is standard input. scripts/estimate-operator "
          "makes such a table from CIE tables and primaries.");
  spec.option("primaries", "NAME|X,Y,...", "rec709", &o.primaries, "color space of the table of --estimate")
      .more(
          "rec709, rec2020, or x and y of red, green and blue, and if wanted of white, which is D65 otherwise. The "
          "file then holds them, and whoever reads it takes the product in that space. Without this option the "
          "table is for linear Rec.2020.");
  spec.heading = "output";
  spec.option("negative", "WHAT", "zero", &o.negative, "what becomes of negative channels")
      .one_of({"keep", "zero"})
      .more("keep writes them as they are. zero writes 0 in their place.");
  spec.option("output,o", "FILE", "evening.exr", &o.output,
              "where the image goes, or with --estimate the operator; - is standard output");
  cli::add_common_options(spec, o.common, {.explain = true});
  spec.examples = {
      {"relight --from D65 --to A testdata/studio.exr -o evening.exr", "show a studio under incandescent lamps"},
      {"relight --from 0.4,0.9,1 --to 1,0.9,0.1 --report r.json testdata/outdoor.exr -o yellow.exr",
       "turn blue sky to a yellow lamp, and report the condition number of the division"},
      {"relight --from D65 --to 0.2,0.4,1 --transfer 0,0,0 testdata/studio.exr -o plain.exr",
       "take the plain product of each channel, for comparison"}};
  spec.report = {{"condition", "condition number of the old illuminant; null with --estimate"},
                 {"negative_fraction", "share of the pixels that have a negative channel, before --negative"},
                 {"matrix", "what each pixel is multiplied by, row by row"},
                 {"operator", "coefficients k of the operator, by output channel"},
                 {"pixels", "number of pixels"},
                 {"warnings[]", "negative colors, and what was done about them"}};
  spec.see_also = {"prefilter-envmap(1)", "render-osmesa(1)", "goniochrome-color(7)"};
  return spec;
}

}  // namespace goniochrome::tool
