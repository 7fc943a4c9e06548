#include "tool.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "paint-pick",
                     .summary = "paints from pictures: droppers for face, flop and gloss, palettes and mood boards"};
  spec.description = {
      "paint-pick puts droppers on pictures (EXR, HDR, PNG, JPEG, TIFF, PNM, DPX, WebP, BMP or TGA) and makes a paint "
      "of what they find. A dropper is IMAGE@X,Y "
      "or IMAGE@X,Y,RADIUS, in pixels from the upper left. Colors are averaged in linear light over the disc of the "
      "dropper, which has a radius of 5 pixels where none is given. Where only one of face and flop is picked, the "
      "paint is solid.",
      "Instead of single droppers, --palette proposes paints for one picture, and --board reads a whole mood board.",
      "# Mood boards\nA mood board is a text file. Its lines are title TEXT, image NAME PATH (relative to the board) "
      "and paint NAME, and below a paint face NAME@X,Y[,R], flop, gloss, travel DEG and retro; # begins a comment. The "
      "page needs no other file; it shows the pictures, the droppers on them, and a drawing of every paint. Where the "
      "name of the output ends in .session.json, it is a session of paint-studio(1) with the pictures and the droppers "
      "of the first paint; the other paints stand in its palette.",
      "# Pixels\nFor --probe the picture is an EXR of render-osmesa(1) with --aov normal,part. The columns are:\n- the "
      "part and its material;\n- the angle between the mirror direction of the viewer and each light of the picture "
      "or, where it has none, the direction of the largest irradiance of the environment;\n- the angle of the viewer "
      "from the normal, and the normal;\n- the radiance in linear Rec.2020, without the exposure of the file;\n- L*, "
      "a* and b* of that radiance relative to the brightest that a white diffuser can be in this light.\nBeside the "
      "mesh there is a color alone."};
  spec.inputs = {"IMAGE", "the picture of --palette or --probe", &o.images, 0, 1};
  spec.heading = "droppers";
  spec.option("face", "DROPPER", "sheet.jpg@250,120", &o.face, "where the color near specular is");
  spec.option("flop", "DROPPER", "sheet.jpg@330,180", &o.flop, "where the color far from specular is");
  spec.option("gloss", "DROPPER", "sheet.jpg@240,90,12", &o.gloss, "where a highlight and its surroundings are")
      .more("The gloss is found from the contrast between the two.");
  spec.option("travel", "DEG", "45", &o.travel_deg, "aspecular angle where the color stops changing").from(15.001, 180);
  spec.flag("retro", &o.retro, "keep a flop that is lighter than the face")
      .more("Such paints are rare. Without this option the two are swapped, and a message says so.");
  spec.option("buffers", "FILE", "view.exr", &o.buffers, "light that was traced for the picture under the droppers")
      .more(
          "render-osmesa(1) writes it with --aov transport. The color found is then that of the matt surface which "
          "would show what the dropper sees in this light, with shadows and with light that other surfaces send. "
          "Pictures without linear light must have render-osmesa's default view and automatic exposure. Without this "
          "option a dropper in a shadow finds a darker paint.");
  spec.heading = "palettes and mood boards";
  spec.option("palette", "N", "8", &o.palette, "propose up to N paints from one picture; 0 for none")
      .from(0, 64)
      .more(
          "The colors of the picture are grouped by hue and chroma. Each group gives a paint of its light and its "
          "dark end.");
  spec.option("board,b", "FILE", "spring.board", &o.board, "take pictures and droppers from a mood board")
      .more(
          "The output is the paints, or a page where its name ends in .html. See Mood boards.");
  spec.heading = "single pixels";
  spec.option("probe", "X,Y", "320,180", &o.probes, "tell what this pixel of a picture with buffers shows")
      .in("pixels from the upper left, from 0")
      .more(
          "- takes pixels from the lines of standard input, and answers each at once. See Pixels.");
  spec.heading = "page of a board";
  spec.option("mesh,m", "FILE", "testdata/speed-shape.obj", &o.mesh,
              "mesh that the paints are drawn on; glass, tires and the like are dressed")
      .more("Without it they are drawn on a ball.");
  spec.option("env,e", "FILE", "studio.env.exr", &o.env, "prefiltered environment that the paints are drawn under")
      .more("Without it they are drawn under two lamps.");
  spec.option("basis", "FILE", "testdata/b7.basis.xml", &o.basis, "lobes that the paints are drawn with under lamps")
      .more("Without it there are seven, with exponents from 1.3 to 3000. An environment brings its own.");
  spec.option("studio", "FILE", "studio.html", &o.studio, "page of paint-studio(1) in which each paint can be opened")
      .more(
          "Each paint of the page gets a link, at which the studio starts from it. The studio's page need not be there "
          "yet, and both pages must be moved together.");
  spec.heading = "output";
  spec.option("name", "NAME", "spring", &o.name, "name of the paint; palettes number it");
  spec.option("output,o", "FILE", "picked.paints.xml", &o.output,
              "paint XML to write, the page of a board, .html, its session, .session.json, or the table of --probe");
  cli::add_common_options(spec, o.common);
  spec.examples = {{"paint-pick --face testdata/contact-sheet.jpg@250,120 --flop testdata/contact-sheet.jpg@330,180 -o "
                    "picked.paints.xml",
                    "make a paint of two spots of a picture"},
                   {"paint-pick --palette 8 testdata/contact-sheet.jpg -o palette.paints.xml",
                    "propose eight paints from one picture"},
                   {"render-osmesa -q --mesh testdata/speed-shape.obj --light 30,50 --aov normal,part -o view.exr && "
                    "paint-pick view.exr --probe 640,360",
                    "tell which part is in the middle of a picture, at which angles, and its color"}};
  spec.report = {{"samples[].dropper", "one of face, flop and gloss"},
                 {"samples[].paint", "name of its paint"},
                 {"samples[].image", "its picture"},
                 {"samples[].x", "its place, in pixels from the left"},
                 {"samples[].y", "its place, in pixels from the top"},
                 {"samples[].radius", "radius of its disc, in pixels"},
                 {"samples[].pixels", "number of pixels averaged"},
                 {"samples[].clipped", "number of pixels that are as bright as the picture can show"},
                 {"samples[].lab", "L*, a*, b* of the mean light, or with --buffers of the reflectance found"},
                 {"samples[].lit", "whether the light under the dropper was taken from --buffers"},
                 {"samples[].gloss_gu", "gloss by contrast, in gloss units"},
                 {"probes[]: x, y, part, material, aspecular_deg, view_deg, normal, rgb, lab",
                  "each pixel of --probe, with one aspecular angle for each light; null where the mesh is not seen"},
                 {"paints[].name", "name of a paint"},
                 {"paints[].face", "L*, a*, b* of its face"},
                 {"paints[].flop", "L*, a*, b* of its flop"},
                 {"paints[].travel_deg", "its travel"},
                 {"paints[].gloss_60_gu", "its gloss at 60 degrees; null where no dropper tells it"},
                 {"paints[].swapped", "whether face and flop were swapped"},
                 {"paints[].share", "part of the picture that has its colors; only for a palette"}};
  spec.see_also = {"paint-edit(1)", "sketch-fit(1)", "fit-paint(1)", "goniochrome-sketches(7)"};
  return spec;
}

}  // namespace goniochrome::tool
