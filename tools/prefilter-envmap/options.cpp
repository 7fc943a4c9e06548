#include "tool.h"

namespace goniochrome::tool {

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "environment";
  spec.option("rotate,r", "LIST", "90", &o.rotate, "turn the environment about +Y, and then about +X and +Z")
      .from(-360, 360)
      .in("degrees: one to three angles")
      .more("A positive turn about +Y takes +Z toward +X.");
  spec.option("ball", "WHERE", "auto", &o.ball, "unroll the photograph of a mirror ball")
      .more(
          "WHERE is X,Y,RADIUS in texels from the upper left corner, or auto: in front of a dark ground the ball is "
          "found, and otherwise it touches the sides of a square picture. The camera is far away, at +Z, and +X is to "
          "the right in the picture.");
  spec.option("exposure,x", "STOPS", "1.5", &o.exposure, "multiply the radiance by two to this power").from(-64, 64);
  spec.option("horizon", "DEG", "0", &o.horizon, "take as black what lies below this elevation; -90 keeps all")
      .from(-90, 90)
      .more("The elevation is that after --rotate.");
  spec.option("bad-pixels", "WHAT", "zero", &o.bad_pixels, "what becomes of texels that are negative or not finite")
      .one_of({"error", "zero"})
      .more("error refuses the image. zero sets them to zero and counts them.");
  spec.heading = "lobes";
  spec.option("basis,b", "FILE", "testdata/b7.basis.xml", &o.basis, "basis whose exponents to filter by")
      .more("Without it, --exponents and --for, there are seven, from 1.3 to 3000.");
  spec.option("exponents,e", "N,...", "6,70,900", &o.exponents, "exponents to filter by, in place of a basis")
      .from(0, 1e6);
  spec.option("for,p", "PAINTS", "fitted.paints.xml", &o.paints, "paints whose lobes to filter by, in place of a basis")
      .more(
          "Only the exponents are filtered that reflect more of the light than the tolerance in some paint. --explain "
          "tells which were left out and why.");
  spec.flag("no-mirror", &o.no_mirror, "leave out the mirror lobe");
  spec.heading = "maps";
  spec.option("size,s", "N", "64", &o.size, "texels along a face, for every lobe")
      .more("auto gives each lobe as many as a bilinear look-up needs to err by ten times the tolerance.");
  spec.option("spots", "N", "4", &o.spots, "most bright spots to keep beside the maps, such as the sun")
      .from(0, envmap::kMostSpots)
      .more(
          "render-osmesa cuts each of them by the horizon of every point, which the maps cannot do; more of them are "
          "closer and take longer.");
  spec.flag("no-open-maps", &o.no_open_maps, "leave out the maps without bright spots, and the one under a coat")
      .more("The file is then half as large, and render-osmesa makes the maps that a picture needs at each start.");
  spec.flag("sparkle", &o.sparkle, "add root mean squares of light, for the grain of flakes")
      .more(
          "Without them, only lamps and bright spots sparkle. The layout env alone has them; see "
          "goniochrome-flakes(7).");
  spec.option("layout,l", "WHAT", "latlong", &o.layout, "how the maps lie")
      .one_of({"env", "latlong", "openexr", "mip", "ktx2", "dds"})
      .more(
          "They are:\n- env: a cube for each lobe, for render-osmesa.\n- latlong: lat-long maps of 2N x N texels; "
          "openexr: cubes with texel centers on the edges; for other programs.\n- mip: one mip-mapped cube, the "
          "sharpest exponent in its finest level, for maps of surfaces; the attribute goniochrome:exponents lists the "
          "levels.\n- ktx2 and dds: the same levels as a cube texture in linear Rec.709, for real-time engines.");
  cli::add_tolerance(spec, o.common, "X", "largest error of a texel, relative to the texel")
      .more(
          "The error is the difference from the exact sum over all texels, rounding included. Below a thousandth of "
          "the map's mean it is relative to that thousandth.");
  spec.option("cache,c", "DIR", "lobes", &o.cache, "folder that keeps the lobes made and gives them back")
      .more("They are known by the content of the environment and by all that shapes a lobe.");
  spec.heading = "checking and output";
  spec.option("verify,v", "N", "100", &o.verify, "compare N random texels of each lobe with the reference sum")
      .from(0, 10000000)
      .more(
          "A tenth as many of the brightest and of the darkest texels are compared as well. With a texel outside the "
          "tolerance, the exit status is 1.");
  spec.option("output,o", "FILE", "studio.env.exr", &o.output,
              "where the prefiltered environment goes; - is standard output")
      .more("Its maps are not compressed, so that they load faster.");
  spec.option("picture", "FILE", "studio.png", &o.picture, "PNG to write that shows all maps side by side")
      .more("Every map is a panorama with +Z in the middle, with its exponent and its size.");
  cli::add_common_options(spec, o.common, {.explain = true, .seed = "the texels to verify"});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"prefilter-envmap --basis testdata/b7.basis.xml testdata/studio.exr -o studio.env.exr",
       "filter a studio by the seven lobes of a basis, the diffuse lobe and the mirror lobe"},
      {"prefilter-envmap -e 6,70,900 --size 64 --verify 100 --report sky.json testdata/outdoor.exr -o sky.env.exr",
       "make three lobes of 64 texels a face, and verify each at 120 texels"},
      {"prefilter-envmap -e 256,64,16,4 --layout mip --size 64 --rotate 90 testdata/studio.exr -o studio.mip.exr",
       "make one mip-mapped cube of the studio, turned by a quarter"},
      {"prefilter-envmap -e 1024 --layout ktx2 --size 64 testdata/studio.exr -o studio.ktx2",
       "make a cube texture for an engine, whose levels are filtered by exponents from 1024 down to 1"},
      {"prefilter-envmap --basis testdata/b5.basis.xml --tolerance 1e-4 --explain testdata/studio.exr -o fine.env.exr",
       "show the method, the error and the time of each lobe before the work starts"}};
  spec.report = {
      {"lobes[].exponent", "exponent of the lobe; \"mirror\" for the environment itself"},
      {"lobes[].size", "texels along a face"},
      {"lobes[].method", "one of harmonics, harmonics+bright, harmonics+horizon, local sums, blocks and overlaps"},
      {"lobes[].cached", "whether the lobe came from the cache"},
      {"lobes[].degree", "degree of the harmonics"},
      {"lobes[].storage", "one of half and float"},
      {"lobes[].predicted_time_s, time_s", "expected and measured time"},
      {"lobes[].predicted_error", "relative error that was allowed for, rounding included"},
      {"lobes[].lookup_error", "relative error that a bilinear look-up between texels typically adds"},
      {"lobes[].max_rel_error, mean_rel_error, verified_texels", "of the verified texels; null without --verify"},
      {"lobes[].energy_ratio", "flux of the lobe's map over the flux of the environment"},
      {"spots[].direction, radius_deg, share", "unit vector toward a bright spot, its radius, its part of the light"},
      {"layout", "how the maps lie: env, latlong, openexr, mip, ktx2 or dds"},
      {"clipped_to_rec709", "with ktx2 and dds, number of texels with a color beyond Rec.709, which were clipped"},
      {"left_out[].exponent", "exponent that the paints name but do not need"},
      {"left_out[].share", "largest part that it has in the reflectance of any paint"},
      {"source.path", "the image"},
      {"source.layout", "lat-long, cube, cube with texel centers on the edges, angular probe or mirror ball"},
      {"source.ball.x, y, radius", "middle of the ball from the upper left corner, and its radius, in texels"},
      {"source.width, height", "texels across and down"},
      {"source.nan, infinite, negative", "number of texels of each kind, which were set to zero"},
      {"source.out_of_gamut", "number of texels with a color beyond Rec.2020, which were clipped"},
      {"read_s, filter_s, verify_s, open_maps_s, sparkle_s, write_s",
       "time of each stage; open maps are those without spots"},
      {"warnings[]", "what was replaced or is outside the tolerance"}};
  spec.see_also = {"fit-basis(1)", "render-osmesa(1)", "goniochrome-paint(5)", "goniochrome-prefiltering(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "prefilter-envmap", .summary = "filter an HDR environment by every lobe of a basis"};
  spec.description = {
      "prefilter-envmap reads the light around a scene and writes it as a prefiltered environment (.env.exr). For the "
      "diffuse lobe and for each cosine lobe of the basis, this is a cube map of the integral of radiance times "
      "max(0,cos)^E, normalized so that a constant environment stays itself. For the mirror lobe it is the environment "
      "itself. render-osmesa(1) then lights a paint by one look-up for each lobe.",
      "# Images\nThe layout of an image follows from its shape:\n- 2:1: a lat-long map, +Y up, its center +Z, its left "
      "quarter +X.\n- 6:1 or 1:6: a cube as a strip of faces (+X -X +Y -Y +Z -Z); 4:3 or 3:4: a cross.\n- Six square "
      "files, one by one in that order, or one pattern with {face} in the place of px, nx, py and so on.\n- A single "
      "square: an angular probe. The photograph of a mirror ball takes --ball.\nFaces are those of OpenGL; an EXR "
      "whose envmap attribute says cube is read by OpenEXR's own convention.",
      "# Formats and colors\nEXR, Radiance HDR, PNG, JPEG, TIFF and PNM are read directly; DPX, WebP, BMP and TGA "
      "through oiiotool. Values are Rec.709, linear in floats and sRGB in whole numbers, unless the file states "
      "otherwise, and are converted to linear Rec.2020. An EXR is read in its display window; FILE[LAYER] names one of "
      "several layers. Headers, EXIF and ICC profiles are heeded.",
      "# Methods\nEvery texel counts as a patch of constant radiance with its exact solid angle. --explain shows the "
      "method of each lobe: zonal harmonics with a proven bound for smooth lobes, brightest texels and bands along the "
      "horizon for lobes with a kink there, and sums over texels or blocks of texels for very sharp lobes."};
  spec.inputs = {"IMAGE", "an HDR image, or six, one for each face of a cube; - or none is standard input", &o.images,
                 0, 6};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
