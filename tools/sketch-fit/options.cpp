#include "options.h"

namespace goniochrome {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "sketch-fit";
  spec.summary = "the paint that an edited or drawn picture of a painted mesh shows";
  spec.description = {
      "Takes a picture that began as a rendering by render-osmesa(1) and was edited in an image editor, painted over "
      "or drawn on a trace of it, and the buffers that were rendered with it, and finds the paint: Lab at the export "
      "angles, face, flop, travel and gloss.",
      "Under one directional light the buffers tell the aspecular angle and the light's cosine of every pixel. Pixels "
      "of equal angles are gathered, outliers among them put aside, and a curve is fitted to them for each channel: "
      "cosine lobes, or, where it explains the pixels better, the clamped quadratic whose travel is scanned. With "
      "--env, the light is an environment: the lobes of any paint are found with the renderer's own equations on the "
      "buffers, without drawing again, then face, flop, travel and gloss where they explain the picture as well, with "
      "the effects that were drawn: Fresnel reflectance, the horizon and the operator of colored light. Brushed paint, "
      "travel of color maps and textures it does not know; it warns where the buffers have them.",
      "The picture may be of any format. Whole numbers (PNG, JPEG, TIFF) are what a display shows: sRGB, or what an "
      "embedded ICC profile says, be it of RGB, of gray or, in TIFF and JPEG, of CMYK, after the view and the exposure "
      "of render-osmesa; floats (EXR) are light. Pixels are left out at edges, at grazing light, near specular, where "
      "clipped or transparent, and outside the mask. Where a part of the picture was edited, the pixels that changed "
      "are taken; where none or more than half of them changed, all.",
      "Where the pixels show too few angles, or half of them differ by more than --max-de from the best paint, the "
      "answer is the matt color that explains them best; the report and a warning say so, and the exit status stays 0. "
      "A picture that seems to be moved against the buffers is told with the shift to give.",
      "Gloss comes from the shape of the highlight where it is seen unclipped, else from its contrast; with --env, and "
      "where other pixels contradict the highlight, from the search."};
  spec.options = {
      {.name = "image",
       .letter = 'i',
       .value = "FILE",
       .help = "the edited picture: PNG, JPEG, TIFF, EXR or any other format",
       .target = &o.image,
       .required = true},
      {.name = "buffers",
       .letter = 'b',
       .value = "FILE",
       .help = "EXR of render-osmesa --aov normal,aspecular,lambert,mask,part",
       .target = &o.buffers,
       .required = true},
      {.name = "env",
       .letter = 'e',
       .value = "FILE",
       .help = "prefiltered environment (*.env.exr) that the picture was rendered under",
       .target = &o.env},
      {.name = "basis",
       .value = "FILE",
       .help = "lobes that the picture was rendered with under a lamp; without it, seven from 1.3 to 3000",
       .target = &o.basis},
      {.name = "mask",
       .letter = 'm',
       .value = "FILE",
       .help = "image whose white pixels are taken, and no others",
       .target = &o.mask},
      {.name = "part",
       .value = "PART",
       .help = "take pixels of this part of the mesh; repeat for more",
       .target = &o.parts},
      {.name = "pixels",
       .value = "WHICH",
       .help = "the pixels that were edited, all of the paint, or as it seems",
       .target = &o.pixels,
       .choices = {"auto", "changed", "all"}},
      {.name = "shift",
       .value = "X,Y",
       .help = "the picture lies so many pixels to the right of and below the buffers",
       .target = &o.shift,
       .low = -4096,
       .high = 4096},
      {.name = "view",
       .value = "VIEW",
       .help = "what a display picture went through: the view Paint of render-osmesa, or nothing",
       .target = &o.view,
       .choices = {"paint", "plain"}},
      {.name = "exposure",
       .value = "STOPS",
       .help = "exposure of the picture, in stops, or auto as render-osmesa has it",
       .target = &o.exposure},
      {.name = "glare",
       .value = "DEG",
       .help = "aspecular angles below this are gloss and not the paint's color",
       .target = &o.glare_deg,
       .low = 0,
       .high = 45},
      {.name = "max-de",
       .value = "DE",
       .help = "median CIE 1976 difference above which the matt color is the answer",
       .target = &o.most_de76,
       .low = 0,
       .high = 200},
      {.name = "name", .value = "NAME", .help = "name of the paint found", .target = &o.name},
      {.name = "residual",
       .value = "FILE",
       .help = "PNG of the differences between the picture and the paint found",
       .target = &o.residual},
      {.name = "output", .letter = 'o', .value = "FILE", .help = "paint XML to write", .target = &o.output}};
  spec.examples = {
      {"fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && "
       "render-osmesa --mesh testdata/speed-shape.obj --paint fitted.xml#candy_red --light 30,50 --aov "
       "aspecular,lambert,mask,part -o scene.exr && "
       "render-osmesa --mesh testdata/speed-shape.obj --paint fitted.xml#candy_red --light 30,50 -o scene.png && "
       "sketch-fit --image scene.png --buffers scene.exr --residual residual.png -o sketch.paints.xml",
       "Finds the paint of a picture again; between the second and the third step scene.png may go through an image "
       "editor."},
      {"prefilter-envmap testdata/studio.exr --basis testdata/b7.basis.xml -o studio.env.exr && "
       "fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && "
       "render-osmesa --mesh testdata/speed-shape.obj --paint fitted.xml#candy_red --env studio.env.exr --aov "
       "normal,aspecular,lambert,mask,part -o studio-scene.exr && "
       "sketch-fit --image studio-scene.exr --buffers studio-scene.exr --env studio.env.exr -o sketch.paints.xml",
       "The same under a studio."}};
  spec.report = {
      {"status", "fitted, or diffuse_fallback"},
      {"reason", "of the fallback; else null"},
      {"mode", "point or environment"},
      {"model", "lobes, quadratic, search, search with free rows, search with free lobes, or diffuse"},
      {"rms_de76", "root mean square CIE 1976 difference of the used pixels from the paint found, relative to white"},
      {"median_de76", "their median, which outliers do not move"},
      {"travel_deg", "travel of the paint found"},
      {"face", "L*, a*, b* of its face"},
      {"flop", "of its flop"},
      {"rows[]: geometry, L, a, b", "its colors at the export angles"},
      {"extrapolated_deg[]", "those of the angles that no pixel shows"},
      {"gloss_60_gu", "its gloss at 60 degrees; null for the fallback"},
      {"gloss_from", "highlight, contrast or search"},
      {"condition", "condition number of the linear fit, or of the search at its end; null where nothing was fitted"},
      {"pixels_used", "pixels that the fit rests on"},
      {"pixels_changed", "pixels that could be used and were edited"},
      {"pixels_rule", "changed or all"},
      {"pixels_left_out", "how many pixels were left out, by reason"},
      {"aspecular_from_deg", "smallest aspecular angle seen; null with --env"},
      {"aspecular_to_deg", "largest"},
      {"suggested_shift[]", "pixels by which the picture seems moved to the right and down against the buffers"},
      {"color_space", "what the picture was taken for"},
      {"fit_s", "time of the fit, without reading and writing"}};
  spec.see_also = {"render-osmesa(1)", "fit-paint(1)", "paint-pick(1)", "goniochrome-theory(7)"};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome
