#include "options.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "paint-pick";
  spec.summary = "paints from pictures: droppers for face, flop and gloss, palettes and mood boards";
  spec.description = {
      "Puts droppers on pictures of any format and makes a paint of what they find: --face the color near specular, "
      "--flop the color far from it, --gloss the contrast between a highlight and what is around it. A dropper is "
      "IMAGE@X,Y or IMAGE@X,Y,RADIUS in pixels from the upper left; colors are averaged in linear light over the disc, "
      "5 pixels without a radius. Where only one of face and flop is given the paint is solid.",
      "A face darker than its flop is rare: both are swapped, with a word, unless --retro says that it is meant.",
      "--palette N proposes up to N pairs of face and flop from one picture: its colors grouped by hue and chroma, "
      "each with its light and its dark end.",
      "--board FILE reads a mood board, a text file that names pictures and the droppers on them, and writes its "
      "paints; with -o *.html a page that needs nothing beside itself, with the pictures, the droppers on them and "
      "every paint drawn on --mesh under --env; a ball under two lamps where they are not given. The lines of a board "
      "are title TEXT, image NAME PATH (relative to the board), paint NAME, and below a paint face NAME@X,Y[,R], flop, "
      "gloss, travel DEG and retro; # begins a comment."};
  spec.inputs = {.value = "IMAGE", .help = "the picture of --palette", .target = &o.images, .low = 0, .high = 1};
  spec.options = {
      {.name = "face", .value = "DROPPER", .help = "where the color near specular is", .target = &o.face},
      {.name = "flop", .value = "DROPPER", .help = "where the color far from specular is", .target = &o.flop},
      {.name = "gloss", .value = "DROPPER", .help = "where a highlight and its surroundings are", .target = &o.gloss},
      {.name = "travel",
       .value = "DEG",
       .help = "aspecular angle where the color stops changing",
       .target = &o.travel_deg,
       .low = 15.001,
       .high = 180},
      {.name = "retro", .help = "a flop lighter than the face is meant", .target = &o.retro},
      {.name = "name", .value = "NAME", .help = "name of the paint; palettes number it", .target = &o.name},
      {.name = "palette",
       .value = "N",
       .help = "propose so many paints from one picture; 0 for none",
       .target = &o.palette,
       .low = 0,
       .high = 64},
      {.name = "board",
       .letter = 'b',
       .value = "FILE",
       .help = "take pictures and droppers from a mood board",
       .target = &o.board},
      {.name = "mesh",
       .letter = 'm',
       .value = "FILE",
       .help = "what the paints of a board's page are drawn on",
       .target = &o.mesh},
      {.name = "env",
       .letter = 'e',
       .value = "FILE",
       .help = "prefiltered environment (*.env.exr) they are drawn under",
       .target = &o.env},
      {.name = "basis",
       .value = "FILE",
       .help = "lobes they are drawn with, where there is no --env; without it, seven from 1.3 to 3000",
       .target = &o.basis},
      {.name = "output",
       .letter = 'o',
       .value = "FILE",
       .help = "paint XML to write, or the page of a board, .html",
       .target = &o.output}};
  spec.examples = {{"paint-pick --face testdata/contact-sheet.jpg@250,120 --flop testdata/contact-sheet.jpg@330,180 -o "
                    "picked.paints.xml",
                    "Makes a paint of two spots of a picture."},
                   {"paint-pick --palette 8 testdata/contact-sheet.jpg -o palette.paints.xml",
                    "Proposes eight paints from one picture."}};
  spec.report = {{"samples[].dropper", "face, flop or gloss"},
                 {"samples[].paint", "name of its paint"},
                 {"samples[].image", "its picture"},
                 {"samples[].x", "its place, in pixels from the left"},
                 {"samples[].y", "and from the top"},
                 {"samples[].radius", "of its disc, in pixels"},
                 {"samples[].pixels", "pixels averaged"},
                 {"samples[].clipped", "those that are as bright as the picture can show"},
                 {"samples[].lab", "L*, a*, b* of the mean light"},
                 {"samples[].gloss_gu", "gloss units by contrast"},
                 {"paints[].name", "name of a paint"},
                 {"paints[].face", "L*, a*, b* of its face"},
                 {"paints[].flop", "of its flop"},
                 {"paints[].travel_deg", "its travel"},
                 {"paints[].gloss_60_gu", "its gloss; null where no dropper says"},
                 {"paints[].swapped", "whether face and flop traded places"},
                 {"paints[].share", "part of the picture that has its colors; for a palette alone"}};
  spec.see_also = {"paint-edit(1)", "sketch-fit(1)", "fit-paint(1)", "goniochrome-theory(7)"};
  cli::add_common_options(spec, o.common, {});
  return spec;
}

}  // namespace goniochrome::tool
