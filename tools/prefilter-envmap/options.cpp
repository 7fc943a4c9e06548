#include "options.h"

namespace goniochrome {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "prefilter-envmap",
      .summary = "filter an HDR environment by every lobe of a basis",
      .description =
          {"Reads the light around a scene and writes it as a prefiltered environment (.env.exr): for the diffuse lobe "
           "and for each cosine lobe of the basis a cube map of the integral of radiance times max(0,cos)^E, "
           "normalized "
           "so that a constant environment stays itself, and the environment itself for the mirror lobe. "
           "render-osmesa(1) then lights a paint by one lookup a lobe.",
           "The image may be a lat-long map (2:1, +Y up, its center +Z, its left quarter +X), a cube as a strip of six "
           "faces (+X -X +Y -Y +Z -Z), a cross (4:3 or 3:4), or six square files, given one by one in that order or as "
           "one pattern with {face} in the place of px, nx, py and so on. Faces are OpenGL's; an EXR whose envmap "
           "attribute says cube is read by OpenEXR's own convention. EXR is read directly, other formats (Radiance "
           "HDR, "
           "TIFF, PNG) through OpenImageIO. Values are linear Rec.709 unless the file says otherwise, and are "
           "converted "
           "to linear Rec.2020.",
           "Every texel counts as a patch of constant radiance with its exact solid angle; a lat-long map is not "
           "resampled first. The tolerance is relative to that sum in double precision, at each texel written, or to a "
           "thousandth of the map's mean where the texel is darker still; it covers the rounding of the file. Smooth "
           "lobes are filtered by zonal harmonics with a proven bound on the degrees left out; lobes that bend at the "
           "horizon by harmonics of all but the brightest texels, which are convolved one by one; very sharp and very "
           "wide ones by a walk over blocks of texels. --explain shows the choice for each lobe.",
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
           {.name = "size",
            .letter = 's',
            .value = "N",
            .help = "texels along a face, for every lobe; auto gives each lobe what a bilinear lookup needs to err by "
                    "ten times the tolerance",
            .target = &o.size},
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
                   {"prefilter-envmap --basis testdata/b5.basis.xml --tolerance 1e-4 --explain testdata/studio.exr -o "
                    "fine.env.exr",
                    "shows the method, the error and the time of each lobe before it starts"}},
      .report = {{"lobes[].exponent", "exponent of the lobe; \"mirror\" for the environment itself"},
                 {"lobes[].size", "texels along a face"},
                 {"lobes[].method", "harmonics, harmonics+bright, blocks or overlaps"},
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
                 {"source.path", "the image"},
                 {"source.layout", "lat-long, cube, or cube with texel centers on the edges"},
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

}  // namespace goniochrome
