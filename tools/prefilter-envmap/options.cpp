#include "options.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "prefilter-envmap",
      .summary = "filter an HDR environment by every lobe of a basis",
      .description =
          {"Reads the light around a scene and writes it as a prefiltered environment (.env.exr): for the diffuse lobe "
           "and for each cosine lobe of the basis a cube map of the integral of radiance times max(0,cos)^E, "
           "normalized so that a constant environment stays itself, and the environment itself for the mirror lobe. "
           "render-osmesa(1) then lights a paint by one lookup a lobe.",
           "The image may be a lat-long map (2:1, +Y up, its center +Z, its left quarter +X), a cube as a strip of six "
           "faces (+X -X +Y -Y +Z -Z), a cross (4:3 or 3:4), or six square files, given one by one in that order or as "
           "one pattern with {face} in the place of px, nx, py and so on; a single square is an angular probe, what a "
           "mirror ball shows, unrolled about +Z. Faces are OpenGL's; an EXR whose envmap "
           "attribute says cube is read by OpenEXR's own convention. EXR and Radiance HDR are read "
           "directly, other formats (TIFF, PNG) through OpenImageIO. Values are linear Rec.709 unless the file says "
           "otherwise, and are converted to linear Rec.2020.",
           "Every texel counts as a patch of constant radiance with its exact solid angle; a lat-long map is not "
           "resampled first. The tolerance is relative to that sum in double precision, at each texel written, or to a "
           "thousandth of the map's mean where the texel is darker still; it covers the rounding of the file. Smooth "
           "lobes are filtered by zonal harmonics with a proven bound on the degrees left out; lobes that bend at the "
           "horizon by harmonics of all but the brightest texels, which are convolved one by one, or, for the diffuse "
           "lobe at the smallest tolerances, by sums along the arcs that a hemisphere cuts from the rows; very sharp "
           "and very wide ones by a walk over blocks of texels. --explain shows the choice for each lobe.",
           "Lobes may be named by a basis, by their exponents, or by the paints that need them (--for): then only the "
           "exponents that some paint reflects by are filtered, and --explain tells which were left out and why.",
           "--layout mip writes one mip-mapped cube for paints whose exponent varies from point to point: the sharpest "
           "exponent in the finest level, each coarser level the next one, a quarter as sharp after the last; its "
           "attribute goniochrome:exponents says which. --layout latlong and openexr write every lobe by "
           "OpenEXR's own conventions, for other programs.",
           "--verify measures what was written against the reference sum; with a texel outside the tolerance the exit "
           "status is 1."},
      .options =
          {{.name = "output",
            .letter = 'o',
            .value = "FILE",
            .help = "where the prefiltered environment goes, - is standard output",
            .target = &o.output},
           {.name = "basis",
            .letter = 'b',
            .value = "FILE",
            .help = "the basis whose exponents to filter by",
            .target = &o.basis},
           {.name = "exponents",
            .letter = 'e',
            .value = "LIST",
            .help = "exponents to filter by, in place of a basis; 0 to 1e6",
            .target = &o.exponents,
            .low = 0,
            .high = 1e6},
           {.name = "for",
            .letter = 'p',
            .value = "PAINTS",
            .help =
                "paints whose lobes to filter by, in place of a basis: only exponents that reflect more of the light "
                "than the tolerance in some paint",
            .target = &o.paints},
           {.name = "size",
            .letter = 's',
            .value = "N",
            .help = "texels along a face, for every lobe; auto gives each lobe what a bilinear lookup needs to err by "
                    "ten times the tolerance",
            .target = &o.size},
           {.name = "layout",
            .letter = 'l',
            .value = "WHAT",
            .help = "how the maps lie: an own cube for each lobe (env, what render-osmesa reads), lat-long maps of "
                    "2N x N (latlong), cubes with texel centers on the edges (openexr), or one cube whose mip levels "
                    "hold the lobes (mip)",
            .target = &o.layout,
            .choices = {"env", "latlong", "openexr", "mip"}},
           {.name = "rotate",
            .letter = 'r',
            .value = "LIST",
            .help = "turn the environment by so many degrees about +Y (positive takes +Z toward +X), and then, where "
                    "given, about +X and about +Z",
            .target = &o.rotate,
            .low = -360,
            .high = 360},
           {.name = "exposure",
            .letter = 'x',
            .value = "STOPS",
            .help = "multiply the radiance by two to this power",
            .target = &o.exposure,
            .low = -64,
            .high = 64},
           {.name = "horizon",
            .value = "DEG",
            .help = "take as black what lies below this elevation, once turned; -90 keeps all",
            .target = &o.horizon,
            .low = -90,
            .high = 90},
           {.name = "cache",
            .letter = 'c',
            .value = "DIR",
            .help = "a folder that keeps the lobes made, by the content of the environment and all that shapes a lobe, "
                    "and gives them back when they are asked for again",
            .target = &o.cache},
           {.name = "verify",
            .letter = 'v',
            .value = "N",
            .help =
                "random texels of each lobe to hold against the reference sum, and a tenth as many of the brightest "
                "and of the darkest",
            .target = &o.verify,
            .low = 0,
            .high = 10000000},
           {.name = "bad-pixels",
            .value = "WHAT",
            .help = "what to do about texels that are negative or not finite: refuse the image (error) or set them to "
                    "zero and count them (zero)",
            .target = &o.bad_pixels,
            .choices = {"error", "zero"}},
           {.name = "no-mirror", .help = "leave out the mirror lobe", .target = &o.no_mirror}},
      .inputs = cli::Positional{.value = "IMAGE",
                                .help = "an HDR image, - is standard input; or six, one for each face of a cube",
                                .target = &o.images,
                                .low = 0,
                                .high = 6},
      .examples = {{"prefilter-envmap --basis testdata/b7.basis.xml testdata/studio.exr -o studio.env.exr",
                    "filters a studio by the seven lobes of a basis, the diffuse and the mirror lobe"},
                   {"prefilter-envmap -e 6,70,900 --size 64 --verify 100 --report sky.json testdata/outdoor.exr -o "
                    "sky.env.exr",
                    "three lobes of 64 texels a face, each verified at 120 texels"},
                   {"prefilter-envmap -e 256,64,16,4 --layout mip --size 64 --rotate 90 testdata/studio.exr -o "
                    "studio.mip.exr",
                    "one mip-mapped cube of the studio, turned by a quarter"},
                   {"prefilter-envmap --basis testdata/b5.basis.xml --tolerance 1e-4 --explain testdata/studio.exr -o "
                    "fine.env.exr",
                    "shows the method, the error and the time of each lobe before it starts"}},
      .report = {{"lobes[].exponent", "exponent of the lobe; \"mirror\" for the environment itself"},
                 {"lobes[].size", "texels along a face"},
                 {"lobes[].method", "harmonics, harmonics+bright, arcs+bright, blocks or overlaps"},
                 {"lobes[].cached", "whether the lobe came from the cache"},
                 {"lobes[].degree", "degree of the harmonics"},
                 {"lobes[].storage", "half or float"},
                 {"lobes[].predicted_time_s", "time that was expected"},
                 {"lobes[].time_s", "time that it took; the first lobe of a method also pays for its tables"},
                 {"lobes[].predicted_error", "relative error that was allowed for, rounding included"},
                 {"lobes[].lookup_error", "relative error that a bilinear lookup between texels typically adds"},
                 {"lobes[].max_rel_error", "largest relative error of the verified texels; null without --verify"},
                 {"lobes[].mean_rel_error", "mean relative error of the verified texels; null without --verify"},
                 {"lobes[].verified_texels", "how many texels were verified"},
                 {"lobes[].energy_ratio", "flux of the lobe's map over the flux of the environment"},
                 {"layout", "how the maps lie: env, latlong, openexr or mip"},
                 {"left_out[].exponent", "exponent that the paints name but do not need"},
                 {"left_out[].share", "largest part of any paint's reflectance that it has"},
                 {"source.path", "the image"},
                 {"source.layout", "lat-long, cube, cube with texel centers on the edges, or angular probe"},
                 {"source.width", "texels across"},
                 {"source.height", "texels down"},
                 {"source.nan", "texels that were not a number, set to zero"},
                 {"source.infinite", "texels that were infinite, set to zero"},
                 {"source.negative", "texels that were negative, set to zero"},
                 {"source.out_of_gamut", "texels with a color beyond Rec.2020, clipped"},
                 {"read_s", "time of reading"},
                 {"filter_s", "time of filtering"},
                 {"verify_s", "time of verifying"},
                 {"write_s", "time of writing"},
                 {"warnings[]", "what was replaced or is outside the tolerance"}},
      .see_also = {"fit-basis(1)", "render-osmesa(1)", "goniochrome-paint(5)", "goniochrome-theory(7)"}};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain, cli::Common::kTolerance, cli::Common::kSeed});
  return spec;
}

}  // namespace goniochrome::tool
