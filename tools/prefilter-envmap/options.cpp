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
          "found wherever it lies, and otherwise it touches the sides of a square picture. The camera is far away, at "
          "+Z, and +X is to the right in the picture. What the ball swallows is not made up for; see --exposure.");
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
          "The light of the spots is in the maps as well. render-osmesa cuts each of them by the horizon of every "
          "point, which the maps cannot do; more of them come nearer to the truth and take longer, see the effect "
          "spots there. An environment without small bright parts has none.");
  spec.flag("no-open-maps", &o.no_open_maps, "leave out the maps without bright spots, and the one under a coat")
      .more(
          "The file is then half as large and sooner written, and render-osmesa makes those maps that a picture "
          "needs at each start. Keeping them pays from the third start on where there are twelve spots, and from "
          "about the tenth on where there are three; one run that draws many paints is one start. Pictures are "
          "the same within the rounding of half floats.");
  spec.flag("sparkle", &o.sparkle, "add the root mean square of the light in each lobe, for the grain of flakes")
      .more(
          "render-osmesa draws the effect sparkle without these maps as well, but then lamps and bright spots alone "
          "make flakes sparkle. They are small, and the layout env alone has them. See goniochrome-flakes(7).");
  spec.option("layout,l", "WHAT", "latlong", &o.layout, "how the maps lie")
      .one_of({"env", "latlong", "openexr", "mip", "ktx2", "dds"})
      .more(
          "env has a cube for each lobe, and is what render-osmesa reads. latlong has lat-long maps of 2N x N texels, "
          "and openexr has cubes with texel centers on the edges; both follow OpenEXR's own conventions, for other "
          "programs. mip has one mip-mapped cube, for paints whose exponent varies from point to point. The sharpest "
          "exponent is in its finest level, and each coarser level has the next one, or a quarter of the exponent "
          "after the last; the attribute goniochrome:exponents says which. ktx2 and dds have the same levels as a cube "
          "texture in linear Rec.709, for real-time engines; ktx2 names the exponents under the key "
          "goniochrome:exponents, and dds has no place for them.");
  cli::add_tolerance(spec, o.common, "X", "largest error of a texel, relative to the texel")
      .more(
          "The error is the difference from the sum over all texels of the image in double precision, and includes the "
          "rounding of the file. Where a texel is darker than a thousandth of the map's mean, the error is relative to "
          "that thousandth.");
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
      .more(
          "Its maps are not compressed, because a picture is then drawn sooner. Compressed by ZIP, which is read as "
          "well, they take about half the room.");
  spec.option("picture", "FILE", "studio.png", &o.picture, "PNG to write that shows all maps side by side")
      .more(
          "Every map is a panorama with +Z in the middle, beside its exponent and its size. All of them have one "
          "exposure, which shows the mean of the light as middle gray.");
  cli::add_common_options(spec, o.common, {.explain = true, .seed = "the texels to verify"});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"prefilter-envmap --basis testdata/b7.basis.xml testdata/studio.exr -o studio.env.exr",
       "filter a studio by the seven lobes of a basis, the diffuse lobe and the mirror lobe"},
      {"prefilter-envmap -e 6,70,900 --size 64 --verify 100 --report sky.json testdata/outdoor.exr -o sky.env.exr",
       "make three lobes of 64 texels a face, and verify each at 120 texels"},
      {"prefilter-envmap --basis testdata/b5.basis.xml testdata/outdoor.exr --picture maps.png -o outdoor.env.exr",
       "show what each lobe makes of a sky"},
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
      {"lobes[].predicted_time_s", "time that was expected"},
      {"lobes[].time_s", "time that it took; the first lobe of a method also pays for its tables"},
      {"lobes[].predicted_error", "relative error that was allowed for, rounding included"},
      {"lobes[].lookup_error", "relative error that a bilinear look-up between texels typically adds"},
      {"lobes[].max_rel_error", "largest relative error of the verified texels; null without --verify"},
      {"lobes[].mean_rel_error", "mean relative error of the verified texels; null without --verify"},
      {"lobes[].verified_texels", "number of texels verified"},
      {"lobes[].energy_ratio", "flux of the lobe's map over the flux of the environment"},
      {"spots[].direction", "toward the middle of a bright spot: a unit vector"},
      {"spots[].radius_deg", "radius of its disc"},
      {"spots[].share", "part of it in the light of the environment"},
      {"layout", "how the maps lie: env, latlong, openexr, mip, ktx2 or dds"},
      {"clipped_to_rec709", "with ktx2 and dds, number of texels with a color beyond Rec.709, which were clipped"},
      {"left_out[].exponent", "exponent that the paints name but do not need"},
      {"left_out[].share", "largest part that it has in the reflectance of any paint"},
      {"source.path", "the image"},
      {"source.layout",
       "one of lat-long, cube, cube with texel centers on the edges, angular probe, and mirror ball, which is a "
       "lat-long map "
       "from there on"},
      {"source.ball.x", "middle of the ball: texels from the left edge of the picture"},
      {"source.ball.y", "middle of the ball: texels from the upper edge of the picture"},
      {"source.ball.radius", "radius of the ball in texels of the picture"},
      {"source.width", "texels across"},
      {"source.height", "texels down"},
      {"source.nan", "number of texels that were not a number and were set to zero"},
      {"source.infinite", "number of texels that were infinite and were set to zero"},
      {"source.negative", "number of texels that were negative and were set to zero"},
      {"source.out_of_gamut", "number of texels with a color beyond Rec.2020, which were clipped"},
      {"read_s", "time of reading"},
      {"filter_s", "time of filtering"},
      {"verify_s", "time of verifying"},
      {"open_maps_s", "time of the maps that follow from the others: under a coat, and without the bright spots"},
      {"sparkle_s", "time of the maps of --sparkle"},
      {"write_s", "time of writing"},
      {"warnings[]", "what was replaced or is outside the tolerance"}};
  spec.see_also = {"fit-basis(1)", "render-osmesa(1)", "goniochrome-paint(5)", "goniochrome-theory(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "prefilter-envmap", .summary = "filter an HDR environment by every lobe of a basis"};
  spec.description = {
      "prefilter-envmap reads the light around a scene and writes it as a prefiltered environment (.env.exr). For the "
      "diffuse lobe and for each cosine lobe of the basis, this is a cube map of the integral of radiance times "
      "max(0,cos)^E, normalized so that a constant environment stays itself. For the mirror lobe it is the environment "
      "itself. render-osmesa(1) then lights a paint by one look-up for each lobe.",
      "The image may be a lat-long map (2:1, +Y up, its center +Z, its left quarter +X). It may be a cube as a strip "
      "of six faces (+X -X +Y -Y +Z -Z), as a cross (4:3 or 3:4), or as six square files, which are given one by one "
      "in that order or as one pattern with {face} in the place of px, nx, py and so on. A single square is an angular "
      "probe, which is what a mirror ball shows, unrolled about +Z; the photograph of a ball itself takes --ball. A "
      "square with light in its corners, of which an angular probe has none, is reported as a likely photograph. "
      "Before "
      "a black ground the two cannot be told apart. Faces are those of OpenGL; an EXR whose envmap "
      "attribute says cube is read by OpenEXR's own convention. EXR, Radiance HDR, PNG, JPEG, TIFF and PNM are read "
      "directly; DPX, WebP, BMP and TGA through oiiotool, where OpenImageIO is installed. Values are Rec.709, linear "
      "in floats and sRGB in whole numbers, unless the file says otherwise, and are converted to linear Rec.2020.",
      "An EXR is read in its display window: black where it has no pixels, and without overscan. Its colors are the "
      "channels R, G and B, or Y, in any case; those without a layer, or else of the only layer that has them. "
      "FILE[LAYER] names one of several. Of Radiance HDR the order of rows and columns, PRIMARIES, EXPOSURE, "
      "COLORCORR and XYZE are heeded: values are those before any exposure. Values of XYZE are taken as they are, "
      "with even X, Y and Z as white. Other pictures are turned as their EXIF orientation says, and a PNG has the "
      "colors of its cICP or cHRM. ICC profiles, the primaries of a TIFF and the Adobe RGB of EXIF are heeded.",
      "Every texel counts as a patch of constant radiance with its exact solid angle; a lat-long map is not resampled "
      "first. Several methods are used. Smooth lobes are filtered by zonal harmonics, with a proven bound on the "
      "degrees that are left out. Lobes that bend at the horizon are filtered by harmonics of all but the brightest "
      "texels, which are convolved one by one. Lobes of exponents below 1 end too steeply at the horizon for harmonics "
      "alone, and so does the diffuse lobe at small tolerances: the texels in a band beside the horizon are summed one "
      "by one as well. Very sharp lobes are sums over the texels that they reach, or walks over blocks of texels where "
      "these are too many. --explain shows the choice for each lobe."};
  spec.inputs = {"IMAGE", "an HDR image, or six, one for each face of a cube; - or none is standard input", &o.images,
                 0, 6};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
