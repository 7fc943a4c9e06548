#include "tool.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "paint-studio", .summary = "write a page in which a paint is designed by hand and eye"};
  spec.description = {
      "paint-studio packs a mesh, prefiltered environments, a basis and a library of paints into one HTML page. The "
      "page opens from a file in any browser that has WebGL 2, and needs no network. A designer starts from a paint of "
      "the library, changes its face, flop, travel, gloss and flakes, and sees it on the mesh at once, beside its "
      "curves, its nine variations and the paints of the library that are nearest to it. All of it works by mouse, "
      "touch and keyboard.",
      "On the picture, dragging goes around the mesh, turns the light, moves a lamp by its highlight, ends the "
      "travel, or sets the gloss by the width of the highlight. The page tells the aspecular angle under the pointer "
      "and the color that the paint has at this angle, and marks both in the curves. A cross has buttons that change "
      "the lightness, chroma or hue of exactly the color below it, as paint-edit --at does. Rings show where the mesh "
      "is seen at 15 and at 45 degrees and at the travel, and a checker shows the highlight. Angles are those to the "
      "lamp, or without it to the brightest light of the environment. A border divides the picture between the paint "
      "and another one, of the library, the palette or the history. The wheel comes closer where the picture has the "
      "focus, and with Ctrl; so do two fingers. Two fingers and the right button move what the camera goes around, and "
      "a double click puts it where the pointer is.",
      "Swatches show what a matt surface of their color shows in the picture. The wheel shows which colors a screen "
      "has at the lightness of the face, those of the print of --print-profile, dotted, and the way of the nearest "
      "paint, dashed; the page tells how far either shows a face or a flop off, with the nearest color that it has. A "
      "paint that is edited becomes a copy with a name that can be changed. Two or four whole cars stand side by side "
      "in step: the design, the paint that it is compared with, and the nearest paints. The words of the field have "
      "notes, a tour shows the page in two minutes, and its texts are English or German.",
      "Pictures can be added, dropped or pasted, and stand on boards with a zoom of their own. Droppers take the "
      "face, the flop and the gloss from them as paint-pick(1) does, and the page shows the command. The library is a "
      "list with a search by name and code and with filters by metrics, and a cloud of points in L*a*b* at a chosen "
      "angle. The page tells, as colorsnap(1) does, where a design lies outside the library and where its hue turns "
      "in another way than that of its nearest paint.",
      "The arithmetic of the page is that of the other tools: the same sources, compiled to WebAssembly. Edits are "
      "those of paint-edit(1), the lobes are fitted as fit-paint(1) does by default, distances are those of "
      "colorsnap(1), and the picture is drawn by the programs of the engine gl of render-osmesa(1). The page shows "
      "the command line that makes the same paint from the same library. It hands the paint over as paint XML, with "
      "the notes as a comment, as CSV, and as CxF with the code of the nearest paint. It saves the picture, a turn of "
      "the mesh as WebM, and sessions, which hold the pictures of the boards, the parts and notes; it prints a card "
      "of one sheet, and copies a link that holds the design and how it is seen. A browser keeps the sessions of its "
      "last eight tabs.",
      "Files are opened by one button, or dropped or pasted anywhere: paints in all formats of paint-convert(1), "
      "whose first becomes the design, with the error of its fit; meshes in OBJ and glTF, with the files that they "
      "name; pictures of light in Radiance HDR and OpenEXR, which are filtered for the basis of the page; pictures "
      "and sessions. The readers are those of the tools. OpenEXR is read as scan lines without compression or with "
      "RLE, ZIPS or ZIP; others, and glTF that is packed by Draco or meshoptimizer, are refused by name. Meshes and "
      "lights that were opened stay until the page is closed; sessions do not hold them.",
      "All parts of the mesh wear the design, but for those that nobody paints, such as glass and tires: these are "
      "told by their names, as in render-osmesa. A list has all parts, with what was recognized. There, or after a "
      "click on a part, it wears the paint, a second paint, glass, rubber or chrome, or is hidden. The ground of the "
      "environment lies below the mesh, with the shadow that the mesh throws on it for eight turns of the light, "
      "between which the page interpolates. The page finds the shadow of the mesh on itself, and the shadows of meshes "
      "and lights that are opened in it, while nothing else is to be done, from 128 directions. Painted "
      "parts send light to the ground and roughly to each other, and mirror it; the traced views of "
      "--transport follow it. Color maps are not shown, and a warning tells how many paints have them. "
      "Brushed paints take longer to draw. Flakes that the paint states sparkle in lamps and bright spots, where an "
      "eye sees single ones; slow computers draw them at rest. They draw moving pictures with fewer pixels, and keep "
      "the light of a view in up to 96 MB of the graphics' memory. At rest, pixels that differ from their neighbors "
      "get 4 samples, then 16.",
      "The compiled library lies in ../lib/goniochrome beside the program, as the files studio.wasm and "
      "studio.html, or in $GONIOCHROME_MODULE_PATH. Where the compiler for WebAssembly was missing when the tools "
      "were built, paint-studio says which packages it takes, and the exit status is 3.",
      "# Traced views\nThe page lists the views of --transport beside the lights. It shows every edit of the paint on "
      "them with shadows, with the floor and with the light that parts send to each other: direct light exactly, and "
      "bounced light scaled to the paint, as render-osmesa --gbuffer does from the same file. The page says where a "
      "paint is so far from the traced one that this is doubtful. Neither camera nor light of a view can be moved. Its "
      "light is packed in some 30 bytes a point, and the page tells the error."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.paints};
  spec.heading = "what the page holds";
  spec.option("mesh,m", "FILE", "testdata/speed-shape.obj", &o.mesh,
              "mesh that wears the paint (OBJ, glTF 2.0, OFF, PLY or STL); needed without --empty");
  spec.option("env,e", "FILE", "studio.env.exr", &o.environments,
              "prefiltered environment, made by prefilter-envmap(1); needed without --empty")
      .more("Each environment must have the lobes of the basis.");
  spec.option("transport", "FILE", "view.exr", &o.transports,
              "traced view of the mesh, made by render-osmesa(1) with --aov transport")
      .more("The file needs the lobes of the basis and the parts of the mesh. See Traced views.");
  spec.option("basis,b", "FILE", "testdata/b7.basis.xml", &o.basis, "basis that the page fits paints to")
      .more("Without it there are seven lobes, with exponents from 1.3 to 3000, and the mirror.");
  spec.flag("empty", &o.empty, "take a mesh, a light and paints of the tool itself where none is named")
      .more(
          "The page is the whole studio for somebody who has a browser alone: paints, meshes and light are opened in "
          "it.");
  spec.option("print-profile", "FILE", "coated.icc", &o.print_profile,
              "ICC profile of a printer, whose gamut the page shows");
  spec.option("title", "TEXT", "Spring", &o.title, "title of the page; the name of the mesh by default");
  spec.heading = "output";
  spec.option("output,o", "FILE", "studio.html", &o.output, "page to write; - is standard output");
  cli::add_common_options(spec, o.common, {.explain = true});
  spec.examples = {
      {"prefilter-envmap testdata/studio.exr --basis testdata/b5.basis.xml -o studio.env.exr && paint-studio --mesh "
       "testdata/speed-shape.obj --env studio.env.exr --basis testdata/b5.basis.xml testdata/paints.paints.xml -o "
       "studio.html",
       "make a page of the sample paints in the light of a photographer's studio"},
      {"paint-stats -w 'class==metallic' -f paints testdata/paints.paints.xml | paint-studio --mesh "
       "testdata/speed-shape.obj --env studio.env.exr --basis testdata/b5.basis.xml --title Metallics -o "
       "metallics.html",
       "make a page of the metallics alone, in the same light"},
      {"prefilter-envmap testdata/outdoor.exr --basis testdata/b5.basis.xml -o outdoor.env.exr && paint-studio --mesh "
       "testdata/speed-shape.obj --env studio.env.exr --env outdoor.env.exr --basis testdata/b5.basis.xml "
       "testdata/paints.paints.xml#candy* -o candies.html",
       "make a page of the candies with two lights"}};
  spec.report = {
      {"bytes", "size of the page"},
      {"code_bytes", "size of the page without its data: markup, scripts and the compiled library"},
      {"paints", "number of paints"},
      {"triangles", "number of triangles of the mesh"},
      {"environments[]", "name of each environment, and its bytes before they are compressed"},
      {"transports[]",
       "name, points and columns of each traced view, bytes before and page_bytes after they are compressed, "
       "rounding_de00_mean and rounding_de00_p95: what packing changes in paints of the page"},
      {"warnings[]", "the warnings of the run"}};
  spec.see_also = {"paint-edit(1)", "paint-pick(1)",    "fit-paint(1)",
                   "colorsnap(1)",  "render-osmesa(1)", "prefilter-envmap(1)"};
  return spec;
}

}  // namespace goniochrome::tool
