#include "tool.h"

namespace goniochrome::tool {

namespace {

void add_pattern(cli::ToolSpec& spec, Options& o) {
  spec.heading = "where each surface lies";
  spec.option("stripe", "FROM,TO", "0.4,0.6", &o.stripe, "lay the second surface as a stripe over the first")
      .in("heights on the map, from 0 at the bottom to 1 at the top")
      .from(-10, 10)
      .more("With more surfaces there are more stripes: --stripe 0.3,0.4,0.6,0.7 takes three.");
  spec.flag("gradient", &o.gradient, "go from the first surface at the left to the last at the right")
      .more("All surfaces between lie at equal steps.");
  spec.option("mask", "IMAGE", "mask.png", &o.mask, "choose the surface by the gray of a picture of the whole map")
      .more(
          "Black is the first surface and white the last, and those between lie at equal steps of gray. A gray between "
          "two steps is a mixture of both.");
  spec.option("decal", "IMAGE", "letters.png", &o.decal, "lay the second surface where a picture is white")
      .more("A picture that has alpha is laid where it is opaque, such as lettering on nothing.");
  spec.option("place", "X,Y,WIDTH", "0.5,0.5,0.8", &o.place, "middle and width of the decal")
      .in("shares of the map's width and height, y up")
      .from(-10, 10)
      .more("Without the option it is 0.5,0.5,0.5. The decal keeps its shape.");
  spec.flag("invert", &o.invert, "exchange black and white of --mask or --decal");
  spec.option("mosaic", "N", "5", &o.mosaic, "lay all surfaces side by side in N columns; 0 for none").from(0, 1000);
  spec.option("mix", "SHARE", "0.5", &o.mix, "mix the surfaces everywhere, with this share of the second")
      .from(0, 1)
      .in("shares of the whole")
      .more("With more surfaces it takes a list: the share of each surface but the first.");
  spec.option("angle", "DEG", "30", &o.angle_deg, "turn stripes, gradient or decal counterclockwise").from(-360, 360);
}

void add_changes(cli::ToolSpec& spec, Options& o) {
  spec.heading = "how the map is changed";
  spec.option("size", "WxH", "512x512", &o.size, "size of the map")
      .in("texels")
      .more(
          "Without the option it is the size of the largest map, picture or mask, or 256x256. Maps of another size are "
          "resampled: a texel becomes the mixture of those that it covers.");
  spec.option("crop", "X,Y,W,H", "0,0,64,64", &o.crop, "keep this part, from its upper left corner")
      .from(0, 1048576)
      .in("texels");
  spec.option("tile", "CxR", "2x3", &o.tile, "repeat it in so many columns and rows");
  spec.option("turn", "DEG", "45", &o.turn_deg, "turn the direction of brushing counterclockwise").from(-360, 360);
  spec.option("polish", "AMOUNT|IMAGE", "0.5", &o.polish, "make lobes narrow, to a quarter of their width at 1")
      .more(
          "Exponents grow by up to 16 times, and the light that each lobe reflects stays. A picture lies over the "
          "whole "
          "map, before --crop and --tile.");
  spec.option("wear", "AMOUNT|IMAGE", "worn.png", &o.wear, "make lobes wide, to four times their width at 1")
      .more("Exponents fall to a sixteenth, and the light that each lobe reflects stays.");
  spec.option("gloss", "AMOUNT|IMAGE", "gloss.png", &o.gloss, "add this share of the gloss of a smooth coat")
      .more("It reflects as a surface of index 1.5 does, more at grazing angles, with the exponent of --mirror.");
}

void add_lobes(cli::ToolSpec& spec, Options& o) {
  spec.heading = "lobes";
  spec.option("lobes", "N", "3", &o.lobes, "most lobes of a texel; 0 for as many as mixtures need")
      .from(0, 16)
      .more("With 0, a map that is resampled keeps its number of lobes, and no texel has more than 16. See Mixtures.");
  spec.option("mirror", "EXPONENT", "3000", &o.mirror, "exponent of the lobes that mirrors become; 0 to choose")
      .from(0, 1e6)
      .in("the exponent of a cosine")
      .more(
          "0 takes the sharpest lobe of the files of the paints, since prefiltered environments of their basis hold "
          "it, "
          "or 1000 where there are no paints.");
}

void add_output(cli::ToolSpec& spec, Options& o) {
  spec.heading = "output";
  spec.option("output,o", "FILE", "hood.sbrdf.exr", &o.output, "map to write; - is standard output");
  cli::add_common_options(spec, o.common, {.explain = true});
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "paint-sbrdf",
      .summary = "make maps of surfaces that vary from place to place, of paints, pictures and other maps"};
  spec.description = {
      "paint-sbrdf writes a map (*.sbrdf.exr), each texel of which is a surface of its own, for render-osmesa(1) "
      "--texture. It takes surfaces in order and one option that says where each of them lies. Without such an option "
      "it takes one surface and changes it.",
      "A surface is a fitted paint (FILE#NAME of a paint XML file; a name with * is several surfaces), a map, or a "
      "picture, whose colors become the diffuse part. Paints keep the exponents that they were fitted with, so that an "
      "environment that was prefiltered for their basis serves the map. Their mirror becomes the sharpest lobe, and "
      "what the coat lets through is that of 45 degrees. The word none is a surface that is not there: where it lies, "
      "the "
      "map has an alpha below 1 and shows what lies beneath it, such as the paint of a car beneath a decal.",
      "Where surfaces meet in a texel, their reflections are mixed, and not the parameters of their lobes. The mean of "
      "the parameters of two lobes is a third lobe that looks like neither. Normals of maps stay; where texels with "
      "different ones are mixed, the normal is their mean, and the lobes are as much wider.",
      "# Mixtures\nA mixture is the sum of the lobes of its surfaces, which is exact: where two surfaces are brushed "
      "in different directions, each lobe keeps its own. A renderer takes as much longer as there are more lobes. "
      "Where a texel has room for fewer, new lobes in one common direction are fitted to samples of that sum."};
  spec.inputs = {"SURFACE",
                 "paints (FILE#NAME), maps (*.sbrdf.exr), pictures and none; - is paints or a map from standard input",
                 &o.inputs, 1};
  add_pattern(spec, o);
  add_changes(spec, o);
  add_lobes(spec, o);
  add_output(spec, o);
  spec.examples = {
      {"fit-paint -q --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.paints.xml && paint-sbrdf "
       "fitted.paints.xml#silver_fine fitted.paints.xml#candy_red --stripe 0.45,0.55 -o stripe.sbrdf.exr",
       "lay a red stripe on silver"},
      {"paint-sbrdf none testdata/nameplate.sbrdf.exr --stripe 0.4,0.6 -o strip.sbrdf.exr",
       "make a strip that is laid on any paint"},
      {"paint-sbrdf testdata/brushed.sbrdf.exr testdata/wood.sbrdf.exr --mosaic 2 -o both.sbrdf.exr",
       "set two maps side by side"},
      {"paint-sbrdf testdata/brushed.sbrdf.exr testdata/nameplate.sbrdf.exr --mix 0.5 --lobes 3 --size 16x16 -o "
       "alloy.sbrdf.exr",
       "mix two maps half and half, with three lobes a texel"},
      {"paint-sbrdf testdata/contact-sheet.jpg --gloss 1 --size 256x128 -o poster.sbrdf.exr",
       "make a glossy poster of a picture"},
      {"paint-sbrdf testdata/wood.sbrdf.exr --wear 0.5 | paint-sbrdf - --tile 2x2 -o worn.sbrdf.exr",
       "wear the varnish of wood, and repeat it"}};
  spec.report = {
      {"size", "width and height of the map in texels"},
      {"lobes", "lobes of a texel"},
      {"lobe_frames", "whether lobes have directions of their own, since those of a texel differ"},
      {"exponents", "lowest and highest exponent of a lobe that reflects; null where none does"},
      {"mirror_exponent", "exponent of the lobes that mirrors became"},
      {"surfaces[].name", "name of the paint, or file"},
      {"surfaces[].kind", "one of paint, map, picture and nothing"},
      {"surfaces[].share", "share of the map that it covers"},
      {"surfaces[].strength_error",
       "mean relative error of the gloss of a paint over viewing angles up to 80 degrees; 0 where it has none"},
      {"refitted_texels", "texels whose lobes were fitted, since a texel has no room for all"},
      {"refit_error_mean", "mean relative error of these (root mean square over light and viewer)"},
      {"refit_error_max", "the largest"},
      {"albedo_max", "largest share of even light that a texel sends back along the normal"},
      {"alpha_mean", "mean alpha: 1 where the map covers all that lies beneath it"}};
  spec.see_also = {"render-osmesa(1)", "fit-paint(1)", "prefilter-envmap(1)", "goniochrome-paint(5)",
                   "goniochrome-surfaces(7)"};
  return spec;
}

}  // namespace goniochrome::tool
