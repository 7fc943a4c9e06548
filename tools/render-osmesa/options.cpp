#include "options.h"

#include "render/engine.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "render-osmesa";
  spec.summary = "draw painted meshes under image light and directional lights";
  spec.description = {
      "Draws a mesh whose parts wear paints fitted by fit-paint(1), lit by an environment prefiltered by "
      "prefilter-envmap(1), by directional lights, or by both, with OpenGL on the processor: no window, no graphics "
      "card. The result is scene-linear radiance (OpenEXR, linear Rec.2020) or a display picture (PNG).",
      "A PAINT is FILE[#NAME], a paint of a paint XML file; NAME may be left out where the file holds only one. --part "
      "paints the part of that name, or, where no part has it, every part of that material (the material of a part's "
      "first face); --paint paints the others. A part without a paint is matt gray of 18 %, and the tool says so. "
      "World axes are those of the environment: +Y is up, azimuth 0 is +Z and grows toward +X.",
      "A light is AZIMUTH,ELEVATION or a vector X,Y,Z toward it, then, if wanted, R,G,B: what a perfect white diffuser "
      "facing it shows (1,1,1). Its mirror image is a point without extent and is not drawn.",
      "--exposure auto leaves an EXR as it is, and in a PNG brings the brightest that a white diffuser can be in this "
      "light to 1. The view Paint keeps colors exact up to 80 % of display white and the hue of every highlight; ACES "
      "SDR is the film-like rendering of ACES 1.0; Un-tone-mapped clips. Where $OCIO is set, the views are those of "
      "its configuration.",
      "--aov adds buffers of the pixel centers to an EXR: normal (normal.X .Y .Z, turned to the viewer), aspecular "
      "(the angle in degrees between the view and the mirror direction of the first light), lambert (the cosine "
      "between normal and that light), mask (1 on the mesh) and part (numbered from 1; the attribute goniochrome:parts "
      "names them). Without --light, the light of these two is the direction in which the environment's irradiance is "
      "largest; goniochrome:aovLight holds it. goniochrome:rays (corner;right;down, the ray through the point x,y "
      "being their sum with the second times x and the third times y, in pixels from the upper left), "
      "goniochrome:lights (direction and white of each), goniochrome:operator (the 27 coefficients k[c][d][e] of "
      "colored light, e running fastest), goniochrome:samples (of a pixel of the picture) and goniochrome:environment "
      "say what is needed to shade the buffers again.",
      "--gbuffer shades such an EXR again, in other paints or light, without the mesh and without rasterizing: its "
      "buffers normal and part, and goniochrome:rays, parts and materials, hold all that the engine cpu needs. The "
      "picture is that of --samples 1, bit for bit; view and size are the file's. Textures need the mesh.",
      "Before drawing, the effects that the scene calls for are priced: what each changes in the picture (CIEDE2000, "
      "the 95th percentile over visible pixels) and what it costs. What all together changes less than --tolerance is "
      "left out; with --budget, what is worth least for its time as well. --effects overrides: auto, all or none, then "
      "+NAME and -NAME, as in auto,-fresnel. The names are diffuse, lobes, gloss, mirror, fresnel, horizon, "
      "anisotropy, travel, texture, texture-lobes, operator and lights; lobe-20, gloss-900 and texture-0 (lobe0 of the "
      "textures) are single lobes. --explain prints the table, which is in the report and in the header of an EXR as "
      "well.",
      "Two engines draw the same picture: gl, in OpenGL, and cpu, which reads all lobes of a texel at once; auto takes "
      "the one predicted faster. Maps that know one direction cannot tell light that changes within the part of a "
      "broad lobe above the horizon: some 0.5 to 1 in the mean, and more at single points. The engine integral does "
      "without them: at every visible point it sums the image that the environment was made from (--check-source, "
      "where that has moved), by blocks as coarse as --tolerance lets 95 of 100 points be. It draws every effect, "
      "takes some 300 times as long at the default tolerance, and a brushed paint another 50 times; --explain "
      "foretells it.",
      "--operator says how colored light and paint multiply: iso, a bilinear product by the published table for camera "
      "sensors; rec2020, by one estimated from color-matching functions, which can make saturated colors negative; or "
      "none, each channel by itself. A number from 0 to 1 after a comma says how much the channels share, as in "
      "iso,0.1.",
      "Under lights, a paint with a color map shows the map's own colors; under an environment, its weights for "
      "several views. --texture gives a part a spatially varying surface of generalized cosine lobes (EXR) in the "
      "place of a paint; it is laid by the mesh's texture coordinates, or around the vertical axis where it has none. "
      "Without the effect texture, a part shows the mean texel of its texture. Exponents between those of the "
      "environment are blended: from a cube for each (--texture-maps cubes), or from one whose coarser levels hold "
      "wider lobes (mip), which needs the sharpest exponent and its quarters, or the layout mip of "
      "prefilter-envmap(1).",
      "--split draws the picture twice, its left half in the first paint and its right half in the second, both in the "
      "place of --paint. --turntable and --light-sweep write a sequence, NAME-0001.exr and so on: the camera, or the "
      "first light, goes once around the vertical axis.",
      "--check compares that many random pixel centers with the reference integrator: the exact lobe model against "
      "every texel of the environment's source, without prefiltering. The differences are CIEDE2000 relative to the "
      "brightest that a white diffuser can be in this light, whatever the exposure.",
  };
  spec.options = {
      {.name = "mesh",
       .letter = 'm',
       .value = "FILE",
       .help = "mesh: OBJ with parts, or OFF, PLY, STL",
       .target = &o.mesh},
      {.name = "gbuffer",
       .value = "FILE",
       .help = "shade the buffers of an EXR made with --aov normal,part, instead of --mesh",
       .target = &o.gbuffer},
      {.name = "part",
       .value = "PART=PAINT",
       .help = "paint of a part or material; repeat for more",
       .target = &o.parts},
      {.name = "paint", .letter = 'p', .value = "PAINT", .help = "paint of all other parts", .target = &o.paint},
      {.name = "texture",
       .value = "PART=FILE",
       .help = "texture of lobes of a part or material; repeat for more; FILE*N lays it N times",
       .target = &o.textures},
      {.name = "texture-maps",
       .value = "WHAT",
       .help = "where the lobes of textures look: cubes, one for each exponent, or mip, one with all in its levels",
       .target = &o.texture_maps,
       .choices = {"cubes", "mip"}},
      {.name = "env", .letter = 'e', .value = "FILE", .help = "prefiltered environment (*.env.exr)", .target = &o.env},
      {.name = "light",
       .value = "DIR[,RGB]",
       .help = "directional light: AZ,EL or X,Y,Z, then R,G,B; repeat for more",
       .target = &o.lights},
      {.name = "size",
       .letter = 's',
       .value = "WxH",
       .help = "picture size in pixels; auto is 1280x720, or that of --gbuffer",
       .target = &o.size},
      {.name = "orbit",
       .value = "AZ,EL[,DIST]",
       .help = "camera around the mesh, in degrees; at distance 1 the mesh just fits from every azimuth",
       .target = &o.orbit},
      {.name = "camera",
       .value = "EYE,TARGET[,FOV]",
       .help = "camera at EX,EY,EZ looking at TX,TY,TZ, with its field of view, instead of --orbit",
       .target = &o.camera},
      {.name = "fov", .value = "DEG", .help = "vertical field of view", .target = &o.fov_deg, .low = 1, .high = 150},
      {.name = "samples",
       .value = "N",
       .help = "samples a pixel: 1, 4 or 16; 0 is 4, or 1 with --gbuffer",
       .target = &o.samples,
       .low = 0,
       .high = 16},
      {.name = "background",
       .value = "WHAT",
       .help = "none (transparent; 18 % gray in a PNG), env, or a color R,G,B",
       .target = &o.background},
      {.name = "exposure", .value = "STOPS", .help = "brightens by 2^STOPS, or auto", .target = &o.exposure},
      {.name = "view",
       .value = "NAME",
       .help = "display view of a PNG: Paint, ACES SDR or Un-tone-mapped",
       .target = &o.view},
      {.name = "aov",
       .value = "NAMES",
       .help = "buffers to add to an EXR: normal, aspecular, lambert, mask, part",
       .target = &o.aovs},
      {.name = "effects",
       .value = "WORDS",
       .help = "auto, all or none, then +NAME and -NAME, separated by commas",
       .target = &o.effects},
      {.name = "budget",
       .value = "MS",
       .help = "most time for the shading of a frame, in ms; 0 is no limit",
       .target = &o.budget_ms,
       .low = 0,
       .high = 1e6},
      {.name = "engine",
       .value = "NAME",
       .help = "what shades",
       .target = &o.engine,
       .choices = render::engine_choices()},
      {.name = "operator",
       .value = "NAME[,SHARE]",
       .help = "how colored light and paint multiply: iso, rec2020 or none",
       .target = &o.reflection},
      {.name = "critical-angle",
       .value = "NAME",
       .help = "what color maps do beyond the critical angle under lights",
       .target = &o.critical_angle,
       .choices = {"clip", "slide", "slide-map", "index"}},
      {.name = "print-shader",
       .help = "print the OpenGL program of the scene on standard output",
       .target = &o.print_shader},
      {.name = "split",
       .value = "PAINT,PAINT",
       .help = "left and right half of the picture in two paints",
       .target = &o.split},
      {.name = "turntable",
       .value = "N",
       .help = "write N pictures from all around",
       .target = &o.turntable,
       .low = 0,
       .high = 9999},
      {.name = "light-sweep",
       .value = "N",
       .help = "write N pictures with the first light from all around",
       .target = &o.light_sweep,
       .low = 0,
       .high = 9999},
      {.name = "check",
       .value = "N",
       .help = "compare N random visible pixels with the reference integrator",
       .target = &o.check,
       .low = 0,
       .high = 1e8},
      {.name = "check-source",
       .value = "FILE",
       .help = "image that the environment was made from, where it has moved",
       .target = &o.check_source},
      {.name = "output",
       .letter = 'o',
       .value = "FILE",
       .help = "picture to write: .exr or .png; - is EXR on standard output",
       .target = &o.output,
       .required = true},
  };
  o.common.tolerance = 0.5;
  cli::add_common_options(spec, o.common, {cli::Common::kExplain, cli::Common::kTolerance, cli::Common::kSeed});
  spec.examples = {
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 -o shape.png",
       "draws the bare shape under one light."},
      {"fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && render-osmesa --mesh "
       "testdata/speed-shape.obj --paint fitted.xml#candy_red --part Glass=fitted.xml#silver_black_flop --light 30,50 "
       "--light -60,20,0.5,0.5,0.6 --samples 16 -o candy.png",
       "dresses it in a fitted paint, its windows in another."},
      {"prefilter-envmap testdata/studio.exr --basis testdata/b7.basis.xml -o studio.env.exr && "
       "fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && "
       "render-osmesa --mesh testdata/speed-shape.obj --paint fitted.xml#candy_red --env studio.env.exr --check 100 -o "
       "studio.png",
       "draws it in a photo studio, and tells how far the picture is from the reference integrator."},
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 --aov aspecular,lambert,mask,part -o buffers.exr",
       "writes the buffers that a sketch is fitted from."},
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 --aov normal,part -o view.exr && "
       "render-osmesa --gbuffer view.exr --light 30,50 --light-sweep 12 -o sweep.png",
       "rasterizes the mesh once, and moves the light around it."},
  };
  spec.report = {
      {"plan[]: effect, needed, reason, de00_p95, cost_ms, decision",
       "what each effect is worth, and whether it is drawn; with --check and --explain truth_de00_p95 as well"},
      {"plan_de00_p95, plan_ms", "what all that is left out changes together, and the time that planning took"},
      {"engine, engine_reason", "what shaded, gl or cpu, and why"},
      {"opengl", "the OpenGL renderer; null with --gbuffer"},
      {"frames", "pictures written"},
      {"gbuffer_ms", "time to rasterize the mesh once; 0 with --gbuffer"},
      {"frame_ms", "time to draw the picture, all samples, without reading and uploading"},
      {"triangles", "triangles of the mesh, where it was read"},
      {"parts[]: name, material, paint", "the parts of the mesh and what they wear"},
      {"exposure_stops", "exposure in force"},
      {"view", "display and view of a PNG"},
      {"white_luminance", "the brightest that a white diffuser can be in this light"},
      {"repairs: normals_made, degenerate_dropped, polygons_split, triangles_turned", "what was mended in the mesh"},
      {"error: de00_mean, de00_p95, de00_max", "CIEDE2000 of the checked pixels against the reference integrator"},
      {"error: checked_pixels, worst_x, worst_y, time_s", "how many, where it is worst, and how long the check took"},
      {"error: source", "the image that the reference integrator used"},
      {"left_out: de00_mean, de00_p95, de00_max",
       "with --check, how far the picture is from that of all effects, over all visible pixels"},
      {"left_out: shading_ms, shading_all_ms, predicted_ms",
       "the time of one sample of each pixel as planned, that with all effects, and what the plan expected"},
  };
  spec.see_also = {"fit-paint(1)", "prefilter-envmap(1)", "goniochrome-paint(5)", "goniochrome-theory(7)"};
  return spec;
}

}  // namespace goniochrome::tool
