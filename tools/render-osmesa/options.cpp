#include "color/spectrum.h"
#include "render/engine.h"
#include "tool.h"

namespace goniochrome::tool {

namespace {

// One sentence about each engine.
std::string engine_sentences() {
  std::string text;
  for (const render::EngineInfo* engine : render::engines())
    text += (text.empty() ? "" : " ") + std::string(engine->name) + " " + engine->sentence + ".";
  return text;
}

void add_surfaces(cli::ToolSpec& spec, Options& o) {
  spec.heading = "surfaces";
  spec.option("mesh,m", "FILE", "testdata/speed-shape.obj", &o.mesh,
              "mesh: OBJ or glTF 2.0 with parts, or OFF, PLY, STL")
      .more(
          "A name without an ending, such as that of a pipe, leaves it to the content to tell the format. Of glTF, as "
          ".gltf or .glb, each node of the scene that has a mesh is a part with the name of the node or else of the "
          "mesh, so that nodes of one name and material are one part; nodes of that name in another "
          "material are a part NAME.MATERIAL, and so is each material of a mesh in several. Nodes that "
          "KHR_node_visibility hides are left out. Meshes packed by Draco or meshoptimizer are unpacked.");
  spec.option("gbuffer", "FILE", "view.exr", &o.gbuffer, "shade the buffers of an earlier picture instead of a mesh")
      .more(
          "The file is an EXR that was made with --aov normal,part. Its buffers and its attributes goniochrome:rays, "
          "parts and materials hold all that the engine cpu needs, so that other paints or other light are shown "
          "without the mesh and without rasterizing. The picture is that of --samples 1, bit for bit; view and size "
          "are the file's, and with a transport --samples tells how many of its points are a pixel. Textures need the "
          "mesh. A file of --aov transport holds the light as well: without --env "
          "and --light it is shaded in that light, with its shadows. Bounced light, which was traced in other paints, "
          "is scaled to the new ones; the error of that is told, and where it is beyond --tolerance the exit status "
          "is 1.");
  spec.option("paint,p", "PAINT", "fitted.xml#candy_red", &o.paint, "paint of all parts that --part does not name")
      .more(
          "Several paints, one picture of each, are drawn where --output has words in braces, or with --sheet or --to: "
          "PAINT is then FILE for all paints of a file, FILE#NAMES for those whose names fit, in which * stands for "
          "any text, or - for a stream of paint XML on standard input.");
  spec.option("basis", "FILE", "b7.basis.xml", &o.basis, "fit paints without lobes to this basis, as fit-paint(1) does")
      .more("Without it, a paint that has no lobes cannot be drawn. It must be the basis of the environment.");
  spec.option("part", "PART=PAINT", "Glass=fitted.xml#silver_fine", &o.parts, "paint of a part or material")
      .more(
          "The part of that name is painted, or, where no part has it, every part of that material. The material of a "
          "part is that of its first face. In the place of a PAINT the word glass makes clear glass that is seen "
          "through, as in Glass=glass: each of its surfaces is a thin pane, which mirrors as both of its faces do "
          "together and lets the rest of the light pass straight on. What lies behind it is drawn as all else is, by "
          "the engines cpu, integral and path. Light that lights other surfaces passes glass as if it were not there. "
          "Glass needs --mesh.");
  spec.flag("trim", &o.trim, "dress glass, tires, rims, seams and the underside instead of painting them")
      .more(
          "Parts are known by words in their names or materials, such as glass, window, tire, rubber, rim, chrome, "
          "seam and underbody. Words are parted by all signs but letters, and by capitals, as in WindowGlass1. Where "
          "no word tells, a glTF material does that transmits light, is transparent or is polished metal without a "
          "clear coat, unless its name speaks of paint or body. A line says what was recognized. Glass is black under "
          "a coat, rubber, seams and the underside are matt black, and rims and metal are gray under a coat. --part "
          "goes before --trim, and --trim before --paint.");
  spec.option("split", "PAINT,PAINT", "a.xml#red,a.xml#blue", &o.split, "draw the halves of the picture in two paints")
      .more("Both stand in the place of --paint: the first on the left, the second on the right.");
  spec.option("texture", "PART=FILE[,WORD=VALUE]", "Hood=flakes.exr,project=decal,axis=y", &o.textures,
              "surface that varies over a part or material")
      .more(
          "The texture is an EXR of generalized cosine lobes, as paint-sbrdf(1) makes, and stands in the place of a "
          "paint. FILE*N repeats it N times. project=uv lays it by the texture coordinates of the mesh, and box along "
          "the coordinate axis that is nearest to the normal; without the word it is uv, or box where there are no "
          "coordinates, which is told. triplanar lays it along all three coordinate axes and blends what they show by "
          "the fourth powers of the normal's components, so that it has no seams. planar lays it along axis (x, y, z, "
          "-x, ... or X,Y,Z), so that it reads right "
          "from both sides; decal does so once and from one side, and the rest of the part shows the texels of its "
          "edge, or nothing of a map that has alpha; cylinder and sphere lay it around axis. scale is the width of the "
          "texture in units of the mesh, "
          "center "
          "(X,Y,Z) the place of its middle, and turn an angle in degrees. Without them the texture covers the parts "
          "once, about the middle of their box, and axis is y, or for planar the thinnest side of the box. "
          "A map that has alpha lies over what the part wears, its paint or the maps that were named before, and "
          "shows of it what it does not cover; several may lie over one another. Without the effect texture, the part "
          "shows the mean texel.");
  spec.option("texture-maps", "WHAT", "mip", &o.texture_maps, "where the lobes of textures are looked up")
      .one_of({"cubes", "mip"})
      .more(
          "The exponents of a texture lie between those of the environment, and are blended. cubes blends maps that "
          "have one exponent each. mip blends the levels of one cube, of which coarser ones hold wider lobes; it "
          "needs the sharpest exponent and its quarters, or the layout mip of prefilter-envmap(1). Lobes that are "
          "sharper or wider than all maps are an error, which names the command that makes the maps.");
}

void add_light(cli::ToolSpec& spec, Options& o) {
  spec.heading = "light";
  spec.option("env,e", "FILE", "studio.env.exr", &o.env, "prefiltered environment (*.env.exr)");
  spec.option("light", "WHERE[,LIGHT][@EXTENT]", "-60,20,0.5,0.5,0.6@2", &o.lights, "lamp")
      .in("degrees for angles and for the extent")
      .more(
          "WHERE is AZIMUTH,ELEVATION or a vector X,Y,Z toward a lamp that is far away, or place:X,Y,Z for a lamp that "
          "stands at that place, in units of the mesh. LIGHT may follow, R,G,B or a name as --spectral has it; it is "
          "what a perfect white diffuser shows that faces the lamp, and 1,1,1 if not given. EXTENT is the angle that "
          "the lamp spans, from 0 to 180, and 0.53 as that of the sun if not given. The lamp is a disc of even "
          "radiance, and a wider one sends as much light as a narrow one. Its highlight and its mirror image are those "
          "of the disc; with the extent 0 it is a point, which has no mirror image. A lamp at a place is a sphere, has "
          "that extent and that white in the middle of the mesh, and its light falls with the square of the distance. "
          "auto takes the engine path for it. cpu and gl draw it on textures, and on paint if it is a point, @0.");
  spec.option("emit", "PART=LIGHT", "Lamp=20,18,15", &o.emissions, "make a part or material shine by itself")
      .more(
          "LIGHT is the radiance of both sides of the part, beside what its paint reflects: R,G,B in linear Rec.2020, "
          "or a light by its name, with a factor, as in A*20. Only the engine path draws such parts, and auto takes it "
          "for them.");
  spec.option("spectral", "WHEN", "on", &o.spectral, "follow light in bands of wavelength")
      .one_of({"auto", "on", "off"})
      .more(
          "The engine path then multiplies light and paint in 31 bands from 400 to 700 nm, not in three channels, so "
          "that --operator has no part in it. Lamps need a spectrum: a LIGHT of --light and of --emit that is named, "
          "as D65, A or F11 (" +
          color::spectral_illuminants() +
          "), or a column of a table of spectra, as lights.csv#HP1. It has the luminance 1, and may be multiplied by "
          "numbers and by filters, which are columns of tables too: D65*filters.csv#cyan*20. Paints need spectra in "
          "their paint XML, unless their weights are gray, which is taken as even over all bands. Environments, "
          "textures and color maps have no spectra. auto follows bands where the engine path draws, a lamp is named, "
          "and nothing lacks a spectrum; what lacks one is told. on takes the engine path, and is an error where "
          "anything lacks a spectrum.");
  spec.option("floor", "WHAT[,HEIGHT]", "shadow", &o.floor, "level floor: none, shadow or a PAINT")
      .in("units of the mesh for the height")
      .more(
          "The floor reaches to the horizon, and lies at HEIGHT or, without it, at the lowest point of the mesh. "
          "shadow lays the lower half of the environment on the floor, as it was seen from --eye-height above the "
          "middle of the mesh; it is darkened where the mesh takes light from it, and lights the mesh from below. With "
          "--background env it is drawn unless another floor is asked for; --floor none and --effects auto,-rays leave "
          "it out. Only the engine path draws a floor that wears a paint, and a floor above the lowest point of the "
          "mesh; auto takes it for them.");
  spec.option("eye-height", "H", "1.5", &o.eye_height, "height above the floor that the environment was seen from")
      .in("units of the mesh")
      .from(0)
      .more("0 takes a third of the longest side of the mesh's box, which is 1.5 m for a car of 4.5 m.");
  spec.option("operator", "OP[,SHARES]", "iso,0.1", &o.reflection, "how colored light and paint multiply")
      .more(color::operator_sentences());
  spec.option("critical-angle", "NAME", "clip", &o.critical_angle, "what color maps do beyond the critical angle")
      .one_of({"clip", "slide", "slide-map", "index"})
      .more(
          "A color map shows its own colors under lights. Under an environment, the engines integral and path show "
          "it as well; cpu and gl show the tilted lobes of the paint, which stand for its map with the angle slide, "
          "or its lobes where it has none.");
  spec.option("exposure", "STOPS", "-1", &o.exposure, "power of two that brightens the picture, or auto")
      .more(
          "auto leaves an EXR as it is. In a PNG it makes a gray card of 18 % middle gray: the light on the card is "
          "the mean of that on a card that lies level and of that on one that faces the camera, of the first picture "
          "of a sequence. Where parts of the mesh are all the light there is, what is seen of the mesh is middle gray "
          "in the mean.");
  spec.option("background", "WHAT", "env", &o.background, "what is seen beside the mesh: none, env or R,G,B")
      .more("none is transparent, and in a PNG a gray of 18 %. env shows the environment.");
}

void add_camera(cli::ToolSpec& spec, Options& o) {
  spec.heading = "camera";
  spec.option("orbit", "AZ,EL[,DIST]", "60,20,0.9", &o.orbit, "camera around the mesh")
      .in("degrees for the angles")
      .more("At distance 1, which is the default, the mesh just fits from every azimuth.");
  spec.option("camera", "EYE,TARGET[,FOV]", "4,1,4,0,0,0", &o.camera, "camera anywhere, instead of --orbit")
      .in("units of the mesh, and in degrees for the field of view")
      .more("EYE and TARGET are three numbers each: where the camera stands and what it looks at.");
  spec.option("fov", "DEG", "50", &o.fov_deg, "vertical field of view").from(1, 150);
  spec.option("size,s", "WxH", "640x400", &o.size, "size of the picture; auto is 1280x720, or that of --gbuffer")
      .in("pixels");
  spec.option("samples", "N", "16", &o.samples, "samples in each pixel: 1, 4 or 16")
      .from(0, 16)
      .more(
          "0 takes 4, or 1 with --gbuffer. With a transport of --gbuffer, 4 shows 2x2 of its points as one pixel, so "
          "that edges are smooth and the picture is half as wide and high; 16 shows 4x4 of them.");
  spec.option("turntable", "N", "36", &o.turntable, "write N pictures with the camera going once around")
      .from(0, 9999)
      .more("The camera goes around the vertical axis. The pictures are NAME-0001.exr and so on.");
  spec.option("light-sweep", "N", "12", &o.light_sweep, "write N pictures with the first light going once around")
      .from(0, 9999);
}

void add_effects(cli::ToolSpec& spec, Options& o) {
  spec.heading = "effects";
  spec.option("effects", "WORDS", "auto,-fresnel", &o.effects,
              "effects to draw: auto, all or none, and then +NAME and -NAME")
      .more(
          "The names are diffuse, lobes, gloss, mirror, fresnel, coat, horizon, spots, anisotropy, travel, satin, "
          "stretch, tilts, texture, texture-filter (pixels show the mean of all texels that they cover), "
          "texture-lobes, "
          "operator, panes (what lies behind glass), lights and extent (of lamps). spots draws the bright spots of the "
          "environment, such as its sun, as lamps that each horizon cuts by itself, and needs horizon. lobe-20, "
          "gloss-900 and texture-0 (lobe0 of the textures) are single lobes. satin draws the rough coat of a paint as "
          "a surface of facets, which integral and path do. stretch "
          "draws its image light by several look-ups along the plane of incidence, where the other engines would look "
          "about the mirror direction alone; it needs an environment without lamps. tilts "
          "are the tilted lobes that stand for color maps under an environment, "
          "tilts-1 is the set with the fewest of them, and each finer set, as tilts-2, needs the one before; while "
          "they are drawn, the lobes of these paints are not. sums corrects what the diffuse part and the lobes up to "
          "exponent 100 gather of the environment by sums over its mirror part. Brushed parts, color maps, textures "
          "and the gloss of rough coats stay as maps "
          "have them, and a picture that lacks horizon or fresnel by name has no sums. Where no rays are traced it is "
          "drawn if it is named, as in auto,-rays,+sums. Three more are drawn by tracing rays: shadow (the mesh "
          "blocks light), self (lobes and mirror see the body instead of black) and bounce (the same for the diffuse "
          "part). The last two need shadow, and rays names all three. They are drawn at those pixels alone that can "
          "see the mesh, so that a convex shape is drawn as without them. Rays are traced wherever a mesh is given; "
          "auto,-rays traces none, which is much faster where the mesh blocks much light. Effects of rays that nobody "
          "names take at most 1024 samples of a point, and those that are named with a plus, as in auto,+rays, take as "
          "many as --tolerance needs. The effect floor is that of --floor shadow and needs shadow; +floor asks for it "
          "as --floor shadow does. An effect is drawn where the scene calls for it. auto leaves out the lobes and the "
          "look-ups of maps that change too little, as --tolerance says, and the first pass of the picture tells what "
          "rays and sums change: what stays below its part of the tolerance gets no second pass.");
  o.common.tolerance = 0.5;
  cli::add_tolerance(spec, o.common, "DE00", "largest difference from the truth, all errors together")
      .more(
          "Before drawing, what each lobe and look-up of the maps changes is tried out on some hundred points, and on "
          "highlights that may lie between them. What changes less than the tolerance, all together, at 95 of 100 "
          "points and at every highlight, is left out. --explain prints the table, and after the first pass what rays "
          "and sums change; the table is also in the report and in the header of an EXR. The effects of rays are drawn "
          "with samples until the standard deviation of their noise is within half of the tolerance at 95 of 100 "
          "points, which does not keep each point within it. What the prefiltered maps err by is told by --check. A "
          "picture for which nobody asks how accurate it is to be, nor how long it may take, is to cost seconds: "
          "without --tolerance, --time-limit and --check its noise may be the whole tolerance, and its rays take at "
          "most 16 million samples, or 8 of each point where those are more. --engine "
          "path, --aov transport and shadow, self, bounce or rays with a plus have no such limit. The engine "
          "integral makes its sums as coarse as this tolerance allows at 95 of 100 points.");
}

void add_engines(cli::ToolSpec& spec, Options& o) {
  spec.heading = "engines";
  spec.option("engine", "NAME", "cpu", &o.engine, "what shades the picture")
      .one_of(render::engine_choices())
      .more(engine_sentences() +
            " The pictures of cpu and gl are the same. auto draws by prefiltered maps and rays: it takes cpu. "
            "Prefiltered maps know one direction at each point. They cannot tell light that changes within that part "
            "of a broad lobe that is above the horizon, but for bright spots, and differ from the truth by some 0.2 to "
            "0.5 dE00 in the mean, and by more at single points. integral sums blocks of the image that are as coarse "
            "as --tolerance "
            "allows, and draws every effect. At the default tolerance it takes several hundred times as long as the "
            "others, and a brushed paint takes another 50 times as long. To pictures of "
            "these three, what the mesh does to light is added by rays, see --effects. path also draws parts that "
            "shine, lamps at a place with their extent and floors that wear a paint. It takes the light from the image "
            "that the "
            "environment was made from, and needs neither prefiltered maps nor OpenGL. It draws samples until the "
            "noise of the picture, estimated from them, is within --tolerance: that is the 95th percentile, over the "
            "visible pixels, of "
            "the CIEDE2000 difference of one standard deviation. A satin coat, see fit-paint --satin, is drawn by "
            "integral and path as the rough surface that has the readings of the paint, with which --check compares "
            "every picture. Prefiltered maps have lobes that stand for it. Without lamps they lie along the plane of "
            "incidence, and typically differ from the rough surface by .4 to 1.1 dE00 at 95 of 100 points in a studio, "
            "and by .6 to 1.7 in the sun; beside lamps they are round, and its light differs by 1.5 to 7. OpenGL is "
            "OSMesa where that is installed, and else the software renderer of EGL; --explain tells which. Where there "
            "is neither, rays find what is visible for the other engines, and gl is an error.");
  spec.flag("gpu", &o.gpu, "draw on a GPU, by the engine gl")
      .more(
          "The GPU is the first on which EGL makes an OpenGL 3.3 context; where there is none, it is an error. "
          "Pictures of GPUs have not been compared with those of the processor yet.");
  spec.option("bounces", "N", "8", &o.bounces, "surfaces that may pass light on to what is seen")
      .from(0, 4096)
      .more(
          "It holds for the engine path, for the effects of rays, for --aov transport and for --check-against truth. "
          "0 draws the light that comes from the environment, lights and shining parts without detour: surfaces that "
          "are seen in others are then black, but for what they emit.");
  spec.flag("print-shader", &o.print_shader, "print the OpenGL program of the scene on standard output")
      .more("Comments before it name what the picture shows and the program does not: color maps and rays.");
}

void add_checking(cli::ToolSpec& spec, Options& o) {
  spec.heading = "checking";
  spec.option("check", "N", "100", &o.check, "compare N random visible pixels with a reference")
      .from(0, 1e8)
      .more(
          "The reference applies the exact lobe model to every texel of the environment's source, without "
          "prefiltering. Differences are CIEDE2000, relative to the brightest that a white diffuser can be in this "
          "light, whatever the exposure is. --check-against says whether the reference knows that the mesh is in the "
          "way of light.");
  spec.option("check-against", "WHAT", "truth", &o.check_against, "what --check compares with")
      .one_of({"auto", "truth", "model"})
      .more(
          "auto takes truth where rays are traced, and else model. model has nothing in the way of light, and is "
          "compared with the picture without the effects of rays. truth adds paths for what the mesh does to light: "
          "shadows, the body mirrored in itself, and light that it passes on. They are traced until the standard "
          "error of the truth is below a tenth of the difference, or a warning says that it is not. The difference is "
          "then told by its causes, and if its 95th percentile is over --tolerance, the exit status is 1. A picture "
          "of the engine path is compared with paths of the same kind, only more of them, so that the check tells its "
          "noise alone. With --gbuffer the mesh is not known, and the comparison is with model.");
  spec.option("check-source", "FILE", "testdata/studio.exr", &o.check_source, "image the environment was made from")
      .more("It is needed where that image is no longer where the environment says. The engine integral uses it too.");
}

void add_output(cli::ToolSpec& spec, Options& o) {
  spec.heading = "output";
  spec.option("output,o", "FILE", "candy.png", &o.output, "picture to write: .exr or .png; - is EXR on standard output")
      .needed()
      .more(
          "With {name}, {code} or {index} in it, each paint of --paint gets a file of its own: by its name, by its "
          "code or, where it has none, its name, or by its number from 0001. Characters that a file's name cannot have "
          "become _, and of paints that would get the same file, the second gets -2, the third -3 and so on. The mesh, "
          "the environment and what is visible are read and made once for all paints. No effect is left out for one "
          "paint, since others may show it, and no rays are traced for each paint: a transport of --gbuffer brings "
          "shadows and bounced light. A paint that cannot be drawn is reported, the others are drawn, and the exit "
          "status is 1.");
  spec.option("sheet", "COLSxROWS", "3x3", &o.sheet, "contact sheets of several paints, with their names")
      .more(
          "The sheets are PNGs, and the pictures on them have the size of --size or of --gbuffer. If there may be more "
          "paints than fit on one sheet, --output must have {index}. On sheets of 3x3, a paint that is followed by its "
          "variations, as paint-edit(1) writes them, stands in the middle of a sheet of its own.");
  spec.option("to", "FORMAT", "y4m", &o.to, "write frames on standard output for programs that read films")
      .one_of({"y4m", "ppm", "exr"})
      .more(
          "There is a frame for each paint of --paint, or for each picture of --turntable or --light-sweep. y4m is "
          "YUV4MPEG2 with 4:4:4 samples by BT.709 and 25 frames a second; ppm is one PPM picture (P6) behind the "
          "other. exr is one scene-linear EXR picture of half floats behind the other, without compression, so that "
          "all of them have as many bytes as the first, unless a value is too large for a half float. "
          "It needs -o -.");
  spec.option("view", "NAME", "'ACES SDR'", &o.view, "display view of a PNG: Paint, ACES SDR or Un-tone-mapped")
      .more(
          "Paint, the default, keeps colors exact up to 80 % of display white, and the hue of every highlight. ACES "
          "SDR is the film-like rendering of ACES 1.0. Un-tone-mapped clips. Where $OCIO is set, the views are those "
          "of its configuration.");
  spec.option("aov", "NAMES", "normal,part", &o.aovs,
              "buffers to add to an EXR: normal, aspecular, lambert, mask, part, error, transport")
      .more(
          "error, of the engine path alone, is the noise of each pixel as CIEDE2000, one standard deviation. The "
          "others hold the pixel centers. normal is turned to the viewer (normal.X .Y .Z). aspecular is the angle in "
          "degrees between the view and the mirror direction of the first light, and lambert the cosine between normal "
          "and that light; without --light, it is the direction in which the environment's irradiance is largest, and "
          "goniochrome:aovLight holds it. mask is 1 on the mesh. part is a number from 1, and the attribute "
          "goniochrome:parts names the parts. More attributes say what is needed to shade the buffers again: "
          "goniochrome:rays (corner;right;down: the ray through the point x,y is the sum of the first, x times the "
          "second and y times the third, in pixels from the upper left), goniochrome:eye (where these rays begin), "
          "goniochrome:lights (direction, white and extent of each in degrees, and of a lamp at a place that place and "
          "its distance from the middle of the mesh), goniochrome:operator (the 27 coefficients k[c][d][e] of colored "
          "light, with e running fastest), "
          "goniochrome:samples (those of a pixel of the picture) and goniochrome:environment. transport brings all "
          "buffers and, in parts of their own, the light that each lobe of the basis gathers at each pixel, the mean "
          "over its --samples, with shadows and with light that surfaces send to each other; it is traced until its "
          "noise is within "
          "--tolerance. --gbuffer then shows other paints in it within milliseconds. goniochrome-paint(5) describes "
          "the parts. A part that wears a color map or a texture has no such light: what stands for a map are lobes in "
          "directions of its own, which differ from paint to paint and from view to view, and a transport holds the "
          "light about the mirror direction alone.");
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 -o shape.png",
       "draw the bare shape under one light"},
      {"fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && render-osmesa --mesh "
       "testdata/speed-shape.obj --paint fitted.xml#candy_red --part Glass=fitted.xml#silver_black_flop --light "
       "30,50 --light -60,20,0.5,0.5,0.6 --samples 16 -o candy.png",
       "draw it in a fitted paint, and its windows in another one"},
      {"prefilter-envmap testdata/studio.exr --basis testdata/b7.basis.xml -o studio.env.exr && fit-paint --basis "
       "testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && render-osmesa --mesh "
       "testdata/speed-shape.obj --paint fitted.xml#candy_red --env studio.env.exr --check 100 -o studio.png",
       "draw it in a photo studio, and tell how far the picture is from the reference integrator"},
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 --aov aspecular,lambert,mask,part -o buffers.exr",
       "write the buffers that a sketch is fitted from"},
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 --aov normal,part -o view.exr && render-osmesa "
       "--gbuffer view.exr --light 30,50 --light-sweep 12 -o sweep.png",
       "rasterize the mesh once, and move the light around it"},
      {"paint-edit testdata/paints.paints.xml#candy_red --variations face | render-osmesa --paint - --basis "
       "testdata/b7.basis.xml --mesh testdata/speed-shape.obj --light 30,50 --size 320x180 --sheet 3x3 -o sheet.png",
       "show a paint among its eight variations on one sheet"},
      {"render-osmesa --paint testdata/paints.paints.xml --basis testdata/b7.basis.xml --mesh testdata/speed-shape.obj "
       "--light 30,50 --size 320x180 -o '{name}.png'",
       "draw a picture of each paint of a library"}};
  spec.report = {
      {"plan[]: effect, needed, reason, de00_p95, decision",
       "what each effect changes, and whether it is drawn: of maps as it was tried out, of rays and sums as the first "
       "pass found it; with --check and --explain, truth_de00_p95 stands beside it"},
      {"rays: noise_de00_p95, samples, free_share, reached, ms",
       "how the effects of rays were drawn, where any were: the noise of the picture, the samples of a visible point, "
       "the share of points that needed none, whether the noise is as low as it was to be, and the time"},
      {"plan_de00_p95, plan_ms",
       "change by all effects of maps that are left out together, and the time that planning took"},
      {"plan_most_samples",
       "samples of rays that a picture may take, where neither accuracy nor time was asked for; null: no limit"},
      {"engine, engine_reason", "what shaded the picture (gl, cpu, integral, path or transport), and why"},
      {"transport: points, columns, bytes_per_point",
       "with --aov transport, or --gbuffer of it: visible pixels, columns of light, and what a pixel takes in memory"},
      {"transport: noise_de00_p95, noise_de00_mean, samples_mean, open_share, trace_s, reached",
       "with --aov transport: noise of the worst column of each pixel, directions traced for each, the part of the "
       "pixels above which nothing rises, the time, and whether the noise is within the tolerance"},
      {"transport: maps_miss_de00, summed",
       "with --aov transport: how far the open light of the maps is off (p95 of the gray paint of each lobe), and "
       "whether wide lobes were therefore summed"},
      {"transport: float_parts, half_error_de00", "parts written as floats, and the error of those in halves"},
      {"transport: load_ms, scale_ms, bounced_de00_p95, trace_again",
       "with --gbuffer: time to lay out the light and to scale what bounced, the error of that, and whether it is "
       "beyond the tolerance"},
      {"opengl", "the OpenGL renderer; null with --gbuffer, and where rays find what is visible"},
      {"opengl_library", "where it comes from: OSMesa or EGL; null without"},
      {"noise_de00_p95, noise_de00_mean",
       "of the engine path: CIEDE2000 of one standard deviation of the noise, over the visible pixels of the last "
       "picture"},
      {"noise_reached, samples_mean, path_s, bounces",
       "of the engine path: whether the noise is within the tolerance in all pictures, the samples of a visible "
       "pixel, the time that tracing them took, and --bounces"},
      {"spectral: bands, observer_deg, lacks, even",
       "where a lamp has a spectrum: bands of wavelength, or 0 where light has three channels; the standard observer; "
       "what lacks a spectrum; gray paints that were taken as even"},
      {"spectral: misfit_de00, readings_de00",
       "how far the lobes in bands are from those in three channels, by daylight, and how far from the spectra of the "
       "paints, by illuminant A: CIEDE2000 of the worst"},
      {"frames", "number of pictures written"},
      {"pictures[]: name, status, message, file, sheet, cell, time_ms",
       "with several paints: each of them in order, done or failed with a message, its file or its place on the "
       "sheets, counted from 1, and the time from when it was read to when it was written"},
      {"pictures[]: bounced_de00_p95", "with several paints and a transport: the error of scaling bounced light"},
      {"failed, files, pictures_per_s", "with several paints: those without a picture, files written, and the rate"},
      {"picture_ms: p50, p99, max", "with several paints: the time of a picture, from reading its paint to writing it"},
      {"gbuffer_ms", "time to rasterize the mesh once, be it for the plan or for the picture; 0 with --gbuffer"},
      {"frame_ms", "time to draw the picture with all samples, without reading and uploading"},
      {"triangles", "number of triangles of the mesh, where it was read"},
      {"mesh: longest_side, unit_m",
       "the longest side of the mesh's box in its units, and the meters of the unit that it is taken to be in"},
      {"parts[]: name, material, paint", "parts of the mesh and what they wear"},
      {"textures[]: part, file, projection, width",
       "what --texture laid where; projection is uv, planar, box, triplanar, cylinder, sphere or decal, and width that "
       "of the "
       "texture in units of the mesh, or null"},
      {"exposure_stops", "exposure in force"},
      {"view", "display and view of a PNG"},
      {"white_luminance", "the brightest that a white diffuser can be in this light"},
      {"repairs: normals_made, degenerate_dropped, polygons_split, triangles_turned", "what was mended in the mesh"},
      {"error: de00_mean, de00_p95, de00_max", "CIEDE2000 of the checked pixels against the reference"},
      {"error: checked_pixels, worst_x, worst_y, time_s",
       "how many pixels were checked, where the worst one is, and how long the check took"},
      {"error: source", "image that the reference integrator used"},
      {"error: against", "one of truth and model"},
      {"error: standard_error", "of the truth: the 95th percentile of its noise"},
      {"error: prefilter, occlusion, bounce, noise",
       "95th percentile of what each cause alone changes: maps and their look-up; shadow and self, if they were left "
       "out; bounce, if it was left out; the noise of the effects of rays"},
      {"error: worth",
       "what shadow, self, bounce and floor are worth in the truth, by the 95th percentile over the checked pixels, "
       "and for a floor over as many beside the mesh, as the first pass tells it"},
      {"error: fit", "95th percentile of what the paints of the pixels miss of their own readings"},
      {"left_out: de00_mean, de00_p95, de00_max",
       "with --check: how far the picture is from that with all effects, over all visible pixels"},
      {"left_out: shading_ms, shading_all_ms",
       "with --check: the time of one sample of each pixel as planned, and the same with all effects"}};
  spec.gone = {{"budget",
                "what lobes and look-ups may leave out is said by --tolerance, and how long rays may take by "
                "--time-limit"}};
  spec.see_also = {"fit-paint(1)", "prefilter-envmap(1)", "goniochrome-paint(5)", "goniochrome-theory(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "render-osmesa",
                     .summary = "draw painted meshes under image light and directional lights"};
  spec.description = {
      "render-osmesa draws a mesh whose parts wear paints that were fitted by fit-paint(1). The light is an "
      "environment that was prefiltered by prefilter-envmap(1), or directional lights, or both. The tool draws on the "
      "processor and needs neither a window nor a graphics card. The result is scene-linear radiance (OpenEXR, linear "
      "Rec.2020) or a display picture (PNG).",
      "A PAINT is FILE[#NAME], which is a paint of a paint XML file; NAME may be left out where the file holds only "
      "one. A part without a paint is matt gray of 18 %, and a warning says so. World axes are those of the "
      "environment: +Y is up, and the azimuth is 0 at +Z and grows toward +X."};
  add_surfaces(spec, o);
  add_light(spec, o);
  add_camera(spec, o);
  add_effects(spec, o);
  add_engines(spec, o);
  add_checking(spec, o);
  add_output(spec, o);
  cli::add_common_options(
      spec, o.common,
      {.explain = true,
       .time_limit = "each picture by the engine path, the effects of rays, and the tracing of --aov transport",
       .seed = "the pixels to check, and the samples of the engine path"});
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
