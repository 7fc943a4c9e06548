#include "color/spectrum.h"
#include "render/engine.h"
#include "setup.h"
#include "tool.h"

namespace goniochrome::tool {

namespace {

// A list item for each engine.
std::string engine_items() {
  std::string text;
  for (const render::EngineInfo* engine : render::engines())
    text += "\n- " + std::string(engine->name) + " " + engine->sentence + ".";
  return text;
}

void add_surfaces(cli::ToolSpec& spec, Options& o) {
  spec.heading = "surfaces";
  spec.option("mesh,m", "FILE", "testdata/speed-shape.obj", &o.mesh,
              "mesh: OBJ or glTF 2.0 with parts, or OFF, PLY, STL")
      .more(
          "Each node of a glTF scene with a mesh is a part of its name, or else of that of the mesh. Nodes of one name "
          "and material are one part; another material makes the part NAME.MATERIAL.");
  spec.option("gbuffer", "FILE", "view.exr", &o.gbuffer, "shade the buffers of an earlier picture instead of a mesh")
      .more(
          "View and size are those of the file:\n- Buffers of --aov normal,part are shaded in other paints or light, "
          "without textures and glass.\n- A transport holds light as well, and without --env and --light is shaded in "
          "that, with its shadows. Bounced light is scaled to other paints; beyond --tolerance the exit status is 1.");
  spec.option("paint,p", "PAINT", "fitted.xml#candy_red", &o.paint, "paint of all parts that --part does not name")
      .more(
          "PAINT is FILE or FILE#NAME: paint XML, or readings in a workbook (XLSX), a table (CSV), CxF or CGATS. "
          "Paints without lobes are fitted to --basis. Several are drawn, a picture each, where --output has words in "
          "braces, or with --sheet or --to: FILE then means all of its paints, FILE#NAMES those that fit, where * is "
          "any text, and - standard input.");
  spec.option("basis", "FILE", "b7.basis.xml", &o.basis, "lobes that paints are fitted to, as fit-paint(1) does")
      .more("Without it there are seven, from 1.3 to 3000, and the mirror. A prefiltered environment must have them.");
  spec.option("part", "PART=PAINT", "Glass=fitted.xml#silver_fine", &o.parts, "paint of a part or material")
      .more(
          "The part of that name is painted or, where there is none, every part whose first face has that material. "
          "The word glass as PAINT makes panes that are seen through by the engines cpu, integral and path: they "
          "mirror, and let other light pass straight on.");
  spec.flag("trim", &o.trim, "dress glass, tires, rims, seams and the underside instead of painting them")
      .more(
          "Words in the names of parts and materials tell them, or else glTF materials that transmit light, are "
          "transparent or are polished metal. --part goes before --trim, and --trim before --paint.");
  spec.option("split", "PAINT,PAINT", "a.xml#red,a.xml#blue", &o.split, "draw the halves of the picture in two paints");
  spec.option("texture", "PART=FILE[,WORD=VALUE]", "Hood=flakes.exr,project=decal,axis=y", &o.textures,
              "surface that varies over a part or material")
      .more(
          "FILE is an EXR of generalized cosine lobes, as of paint-sbrdf(1); FILE*N repeats it N times. A map with "
          "alpha lies over what was there before. The words, see SPATIALLY VARYING SURFACES in goniochrome-paint(5), "
          "are project (uv, box, triplanar, planar, decal, cylinder or sphere), axis (x, -z or X,Y,Z), scale (width in "
          "units of the mesh), center (X,Y,Z) and turn (degrees).");
  spec.option("texture-maps", "WHAT", "mip", &o.texture_maps, "where the lobes of textures are looked up")
      .one_of({"cubes", "mip"})
      .more(
          "cubes blends maps of one exponent each. mip blends the levels of one cube, and needs the sharpest exponent "
          "and its quarters.");
}

void add_light(cli::ToolSpec& spec, Options& o) {
  spec.heading = "light";
  spec.option("env,e", "FILE", "testdata/studio.exr", &o.env, "environment: an image, or prefiltered (*.env.exr)")
      .more(
          "An image, of any kind that prefilter-envmap(1) reads, is filtered by the lobes of the paints. The result is "
          "kept in $XDG_CACHE_HOME/goniochrome or ~/.cache/goniochrome, and found again by the content of the image, "
          "the lobes and the version of the program. Up to 2 GiB are kept; what was used longest ago goes first.");
  spec.flag("no-cache", &o.no_cache, "filter the image of --env anew, and keep nothing");
  spec.option("light", "WHERE[,LIGHT][@EXTENT]", "-60,20,0.5,0.5,0.6@2", &o.lights, "lamp")
      .in("degrees for angles and for the extent")
      .more(
          "Its parts are:\n- WHERE: AZIMUTH,ELEVATION or X,Y,Z toward a lamp far away, or place:X,Y,Z in units of the "
          "mesh.\n- LIGHT: R,G,B or a name as in --spectral, the radiance of a white diffuser that faces the lamp "
          "[1,1,1].\n- EXTENT: the angle of its disc, from 0, a point, to 180 [0.53]. It does not change the light.\nA "
          "lamp at a place has that extent and light in the middle of the mesh, and takes the engine path; cpu draws "
          "it as a point alone.");
  spec.option("emit", "PART=LIGHT", "Lamp=20,18,15", &o.emissions, "make a part or material shine by itself")
      .more(
          "LIGHT is the radiance of both sides of the part: R,G,B, or a name and a factor, as A*20. It takes the "
          "engine path.");
  spec.option("spectral", "WHEN", "on", &o.spectral, "follow light in bands of wavelength")
      .one_of({"auto", "on", "guess", "off"})
      .more(
          "The engine path then multiplies light and paint in 31 bands from 400 to 700 nm. auto does so where a lamp "
          "is named and nothing lacks a spectrum; on is an error where anything does, and guess takes for it the "
          "smoothest "
          "spectrum of its color, and says for what. Lamps are named " +
          color::spectral_illuminants() +
          ", or by tables, see TABLES OF SPECTRA in goniochrome-paint(5). Paints need measured spectra, unless they "
          "are gray; environments and textures have none.");
  spec.option("floor", "WHAT[,HEIGHT][,eye=H]", "shadow,eye=1.5", &o.floor, "level floor: none, shadow or a PAINT")
      .in("units of the mesh for heights")
      .more(
          "It reaches to the horizon, at HEIGHT or the lowest point of the mesh. shadow shows the lower half of the "
          "environment as it was seen from H above the floor, by default a third of the longest side of the mesh. auto "
          "is shadow with --background env, and else none. A floor that wears a paint, or lies above the lowest point, "
          "takes the engine path.");
  spec.option("operator", "OP[,SHARES]", "iso,0.1", &o.reflection, "how colored light and paint multiply")
      .more(
          "It is fitted (to published spectra), plain (each channel by itself), iso (the table for camera sensors), "
          "iso709, estimated (from color-matching functions) or a JSON file; see goniochrome-color(7), \"COLORED "
          "LIGHT\". SHARES, one number from 0 to 1 or three, are what each channel takes from the others.");
  spec.option("critical-angle", "NAME", "clip", &o.critical_angle, "what color maps do beyond the critical angle")
      .one_of({"clip", "slide", "slide-map", "index"})
      .more("Under an environment only integral and path show color maps; the others show tilted lobes.");
  spec.option("exposure", "STOPS", "-1", &o.exposure, "power of two that brightens the picture, or auto")
      .more(
          "auto leaves an EXR as it is. In a PNG it makes a gray card of 18 % middle gray or, where parts of the mesh "
          "are all the light, the mesh.");
  spec.option("background", "WHAT", "env", &o.background, "what is seen beside the mesh: none, env or R,G,B")
      .more("none is transparent, and in a PNG a gray of 18 %.");
}

void add_camera(cli::ToolSpec& spec, Options& o) {
  spec.heading = "camera";
  spec.option("camera", "WHERE[,FOV]", "60,20,0.9", &o.camera, "camera around the mesh, or anywhere")
      .in("degrees for angles and units of the mesh for places")
      .more(
          "WHERE is one of these, and FOV the vertical field of view [30]:\n- AZIMUTH,ELEVATION[,DISTANCE]: around the "
          "mesh, which just fits at distance 1. FOV needs the distance.\n- X,Y,Z,X,Y,Z: where it stands, and what it "
          "looks at.");
  spec.option("size,s", "WxH", "640x400", &o.size, "size of the picture; auto is 1280x720, or that of --gbuffer")
      .in("pixels");
  spec.option("samples", "N", "16", &o.samples, "samples in each pixel: 1, 4 or 16")
      .from(0, 16)
      .more(
          "0 takes 4, or 1 with --gbuffer. With a transport, 4 shows 2x2 of its points as one pixel, and 16 shows "
          "4x4.");
  spec.option("turntable", "N", "36", &o.turntable, "write N pictures with the camera going once around")
      .from(0, 9999)
      .more("The pictures are NAME-0001.exr and so on.");
  spec.option("light-sweep", "N", "12", &o.light_sweep, "write N pictures with the first light going once around")
      .from(0, 9999);
}

void add_effects(cli::ToolSpec& spec, Options& o) {
  spec.heading = "effects";
  spec.option("effects", "WORDS", "auto,-fresnel", &o.effects_text,
              "effects to draw: auto, all or none, and then +NAME and -NAME")
      .more(
          "auto draws what the scene calls for, but what changes too little. The names are:" + render::effect_items() +
          "\nRays that are not named take at most 1024 samples of a point. auto,-rays is faster.");
  o.common.tolerance = 1;
  cli::add_tolerance(spec, o.common, "DE00", "what the finished picture may miss of the truth, at 95 of 100 pixels")
      .more(
          "What is approximate keeps to it; --check measures it:\n- Lobes and look-ups are left out where all together "
          "change less; --explain prints the table.\n- Rays are traced until errors of maps and rays together are "
          "within it, and the engine path to all of it as one standard deviation.\n- The engine integral sums blocks "
          "as coarse as it allows.\nWithout --tolerance, --time-limit and --check, a picture takes seconds: rays and "
          "smoothed paths end after 5 s, rays also with 8 samples of each point.");
  spec.option("tilts", "N|ERROR", "16", &o.tilts, "tilted normals that draw a brushed paint, or their error")
      .more("ERROR, below 1, is relative to the peak of a lobe; --explain says how many normals it takes.");
  spec.option("bounces", "N", "8", &o.bounces, "surfaces that may pass light on to what is seen")
      .from(0, 4096)
      .more(
          "It holds for rays, the engine path, and the truth of --check. With 0, surfaces show only light that comes "
          "without detour.");
}

void add_engines(cli::ToolSpec& spec, Options& o) {
  spec.heading = "engines";
  std::vector<std::string> choices = render::engine_choices();
  choices.emplace_back(kGpu);
  spec.option("engine", "NAME", "path", &o.engine, "what shades the picture")
      .one_of(std::move(choices))
      .more(
          "auto takes cpu or, where the scene needs it, path, smoothed. Rays add what the mesh does to light to "
          "pictures of all but path." +
          engine_items() +
          "\n- gpu is gl on the first GPU with OpenGL 3.3.\nPictures of cpu and gl are the same; they differ from the "
          "truth by 0.2 to 0.5 dE00 in the mean. integral takes several hundred times as long. It and path draw rough "
          "coats as facets, and the others lobes that stand for them.");
  spec.flag("print-shader", &o.print_shader, "print the OpenGL program of the scene on standard output")
      .more("Comments before it name what it does not show.");
}

void add_checking(cli::ToolSpec& spec, Options& o) {
  spec.heading = "checking";
  spec.option("check", "N[,AGAINST]", "100,model", &o.check_text, "compare N random visible pixels with a reference")
      .more(
          "Differences are CIEDE2000, relative to the brightest white diffuser. AGAINST is truth where rays are "
          "traced, and else model:\n- model: exact lobes of every texel of the image, with nothing in the way of "
          "light.\n- truth: with shadows and bounced light, traced until their standard error is below a tenth of the "
          "difference or a twentieth of --tolerance.\nThe range "
          "behind p95 is its standard error. Where p95 is above --tolerance, the exit status is 1.");
  spec.option("check-source", "FILE", "testdata/studio.exr", &o.check_source,
              "image that a prefiltered environment was made from, if it was moved")
      .more("The engines integral and path use it too.");
}

void add_output(cli::ToolSpec& spec, Options& o) {
  spec.heading = "output";
  spec.option("output,o", "FILE", "candy.png", &o.output, "picture to write: .exr or .png; - is EXR on standard output")
      .needed()
      .more(
          "With {name}, {code} or {index} in it, each paint of --paint gets a file by its name, code or number. "
          "Characters that no file name can have become _, and names that come again get -2, -3 and so on. No rays are "
          "traced for each paint; a transport of --gbuffer brings their light. A paint that cannot be drawn is "
          "reported, and the exit status is 1.");
  spec.option("sheet", "COLSxROWS", "3x3", &o.sheet, "contact sheets of several paints, with their names")
      .more(
          "Sheets are PNGs. Where there may be more than one, --output needs {index}. On sheets of 3x3, a paint before "
          "its variations, as paint-edit(1) writes them, stands in the middle.");
  spec.option("to", "FORMAT", "y4m", &o.to, "write frames on standard output for programs that read films")
      .one_of({"y4m", "ppm", "exr"})
      .more(
          "There is a frame for each paint, or for each picture of --turntable or --light-sweep, one behind the other. "
          "It needs -o -. y4m is YUV4MPEG2 with 4:4:4 samples by BT.709, ppm is P6, and exr has half floats without "
          "compression.");
  spec.option("view", "NAME", "'ACES SDR'", &o.view, "display view of a PNG: Paint, ACES SDR or Un-tone-mapped")
      .more(
          "Paint, the default, keeps colors exact up to 80 % of display white. ACES SDR is the rendering of ACES 1.0. "
          "Un-tone-mapped clips. Where $OCIO is set, the views are its own.");
  spec.option("aov", "NAMES", "normal,part", &o.aovs,
              "buffers to add to an EXR: normal, aspecular, lambert, mask, part, error, transport")
      .more(
          "goniochrome-paint(5), \"BUFFERS\", describes them. error is of the engine path. transport brings all "
          "others and "
          "the light that each lobe gathers, with shadows and bounced light, traced to --tolerance; --gbuffer shows "
          "other paints in it. Color maps and textures have none.");
}

void add_examples(cli::ToolSpec& spec) {
  spec.examples = {
      {"render-osmesa --mesh testdata/speed-shape.obj --paint testdata/paints.csv#candy_red --env testdata/studio.exr "
       "-o studio.png",
       "draw a shape in a paint as it was measured, in a photo studio as it was photographed"},
      {"fit-paint testdata/paints.paints.xml -o fitted.xml && render-osmesa --mesh testdata/speed-shape.obj --paint "
       "fitted.xml#candy_red --part Glass=fitted.xml#silver_black_flop --light 30,50 --light -60,20,0.5,0.5,0.6 "
       "--samples 16 -o candy.png",
       "draw it in a fitted paint, and its windows in another one"},
      {"paint-edit testdata/paints.paints.xml#candy_red --variations face | render-osmesa --paint - --mesh "
       "testdata/speed-shape.obj --light 30,50 --size 320x180 --sheet 3x3 -o sheet.png",
       "show a paint among its eight variations on one sheet"},
      {"render-osmesa --paint testdata/paints.csv --mesh testdata/speed-shape.obj --light 30,50 --size 320x180 -o "
       "'{name}.png'",
       "draw a picture of each paint of a library"}};
}

void add_report(cli::ToolSpec& spec) {
  spec.report = {
      {"plan[]: effect, needed, reason, de00_p95, decision, truth_de00_p95",
       "what each effect changes; the truth with --check and --explain"},
      {"plan_de00_p95, plan_ms, plan_quick",
       "what is left out of maps changes, the plan's time, and whether rays end after 5 s"},
      {"filtering: was_kept, time_s", "with an image as --env: whether an earlier run filtered it, else the time"},
      {"maps: de00_p95, points", "errors of prefiltered maps in open light"},
      {"rays: noise_de00_p95, error_de00_p95, samples, free_share, reached, ms",
       "errors of rays, and with those of maps; samples of a point"},
      {"enlarged_from: width, height", "pixels drawn"},
      {"engine, engine_reason", "what shaded the picture: gl, cpu, integral, path or transport"},
      {"transport: points, columns, bytes_per_point", "visible pixels, columns of light, memory of a pixel"},
      {"transport: noise_de00_p95, noise_de00_mean, shown_noise_de00_p95, samples_mean, open_share, trace_s, reached",
       "with --aov transport: noise of the worst column, noise in these paints, directions traced"},
      {"transport: maps_miss_de00, summed", "with --aov transport: what maps miss, and whether wide lobes were summed"},
      {"transport: float_parts, half_error_de00", "parts written as floats, and the error of those in halves"},
      {"transport: load_ms, scale_ms, bounced_de00_p95, trace_again",
       "with --gbuffer: times, the error of scaling bounced light, and whether it is beyond the tolerance"},
      {"opengl, opengl_library", "the OpenGL renderer, and OSMesa or EGL; null where none is used"},
      {"noise_de00_p95, noise_de00_mean, noise_reached, samples_mean, path_s, bounces", "of the engine path"},
      {"spectral: bands, observer_deg, lacks, even, guessed",
       "bands or 0, what lacks a spectrum, and gray paints that were taken as even"},
      {"spectral: misfit_de00, readings_de00", "of the worst paint: bands to three channels, and to its spectra"},
      {"frames", "pictures written"},
      {"pictures[]: name, status, message, file, sheet, cell, time_ms, bounced_de00_p95",
       "of several paints each, done or failed; places are counted from 1"},
      {"failed, files, pictures_per_s, picture_ms", "of several paints; picture_ms has p50, p99 and max"},
      {"gbuffer_ms, frame_ms", "time to find what one sample shows, and to draw all"},
      {"triangles, mesh: longest_side, unit_m", "of the mesh; unit_m are the meters that its unit is taken for"},
      {"parts[]: name, material, paint", "what parts wear"},
      {"textures[]: part, file, projection, width", "what --texture laid where"},
      {"exposure_stops, view, white_luminance",
       "exposure, display and view of a PNG, and the brightest that a white diffuser can be"},
      {"repairs: normals_made, degenerate_dropped, polygons_split, triangles_turned", "of the mesh"},
      {"error: de00_p95_low, de00_p95_high", "its range of one standard error; null: too few pixels"},
      {"error: de00_mean, de00_p95, de00_max, checked_pixels, worst_x, worst_y, time_s, source, against",
       "of --check; source: the image of the reference"},
      {"error: standard_error, fit", "95th percentiles of the noise of the truth, and of what fits miss of readings"},
      {"error: prefilter, occlusion, bounce, noise, worth",
       "95th percentiles of what each cause alone changes, and each effect of rays in the truth"},
      {"left_out: de00_mean, de00_p95, de00_max, shading_ms, shading_all_ms",
       "with --check: all pixels beside those with all effects of maps, and times"}};
}

void add_gone(cli::ToolSpec& spec) {
  spec.gone = {
      {"budget",
       "what lobes and look-ups may leave out is said by --tolerance, and how long rays may take by --time-limit"},
      {"orbit", "give the same numbers to --camera"},
      {"fov", "write it behind the camera, as in --camera 35,12,1,50 or --camera 4,1,4,0,0,0,50"},
      {"eye-height", "write it behind the floor, as in --floor shadow,eye=1.5"},
      {"gpu", "give --engine gpu"},
      {"check-against", "write it behind the number of pixels, as in --check 100,model"}};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "render-osmesa",
                     .summary = "draw painted meshes under image light and directional lights"};
  spec.description = {
      "render-osmesa draws a mesh whose parts wear measured paints. The light is an image of an environment, or lamps, "
      "or both. The result is scene-linear radiance (OpenEXR, linear Rec.2020) or a display picture (PNG).",
      "A part without a paint is matt gray of 18 %, and a warning says so. World axes are those of the environment: +Y "
      "is up, and the azimuth is 0 at +Z and grows toward +X."};
  add_surfaces(spec, o);
  add_light(spec, o);
  add_camera(spec, o);
  add_effects(spec, o);
  add_engines(spec, o);
  add_checking(spec, o);
  add_output(spec, o);
  cli::add_common_options(spec, o.common,
                          {.explain = true,
                           .time_limit = "each picture by the engine path, rays, and --aov transport",
                           .stopped = "the exit status is 4 where --tolerance was given and missed. A picture with "
                                      "rays has as many pixels as there is time for, enlarged",
                           .seed = "the pixels to check, and the samples of the engine path"});
  add_examples(spec);
  add_report(spec);
  add_gone(spec);
  spec.see_also = {"fit-paint(1)",        "prefilter-envmap(1)", "goniochrome-paint(5)", "goniochrome-rendering(7)",
                   "goniochrome-plan(7)", "goniochrome-paths(7)"};
  return spec;
}

}  // namespace goniochrome::tool
