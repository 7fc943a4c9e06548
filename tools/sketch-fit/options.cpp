#include "tool.h"

namespace goniochrome::tool {

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "picture";
  spec.option("image,i", "FILE", "scene.png", &o.image, "the edited picture: PNG, JPEG, TIFF, EXR or any other format")
      .needed();
  spec.option("buffers,b", "FILE", "scene.exr", &o.buffers, "buffers that were rendered with it")
      .needed()
      .more(
          "An EXR of render-osmesa --aov normal,aspecular,lambert,mask,part has all that is needed. With transport "
          "among them the picture may have shadows and bounced light, and --env is not needed.");
  spec.option("view", "VIEW", "'ACES SDR'", &o.view, "view that a display picture went through")
      .more(
          "auto is the view that a PNG of render-osmesa names, or Paint where a picture names none; plain is no view. "
          "Other views are those of render-osmesa --view, and of the configuration of $OCIO. OpenColorIO inverts "
          "them.");
  spec.option("exposure", "STOPS", "0.5", &o.exposure, "exposure of the picture, or auto as render-osmesa has it");
  spec.option("shift", "X,Y", "2,-1", &o.shift, "how far the picture lies to the right of and below the buffers")
      .from(-4096, 4096);
  spec.option("register", "WHEN", "always", &o.registration, "when the picture is laid on the buffers by its edges")
      .one_of({"auto", "always", "never"})
      .more(
          "A scan has another size than the buffers, and may be turned, by up to 5 degrees, and moved. auto looks for "
          "scale, turn and shift where the sizes differ; never refuses such a picture.");
  spec.heading = "light";
  spec.option("env,e", "FILE", "studio.env.exr", &o.env, "prefiltered environment that the picture was rendered under");
  spec.option("basis", "FILE", "testdata/b7.basis.xml", &o.basis, "lobes that the picture was rendered with")
      .more(
          "They are those of a picture under a lamp; an environment brings its own. Without the option there are "
          "seven, "
          "with exponents from 1.3 to 3000.");
  spec.heading = "pixels";
  spec.option("mask,m", "FILE", "mask.png", &o.mask, "image whose white pixels are taken, and no others");
  spec.option("part", "PART", "Hood", &o.parts, "take the pixels of this part of the mesh")
      .more("Without the option all parts are taken but those that --trim of render-osmesa dressed.");
  spec.option("pixels", "WHICH", "all", &o.pixels, "pixels that are taken")
      .one_of({"auto", "changed", "all"})
      .more(
          "changed are those that were edited, all are those of the paint. auto takes the changed pixels where an edit "
          "is plain, and else all.");
  spec.option("glare", "DEG", "15", &o.glare_deg, "aspecular angle below which a pixel shows gloss and not the paint")
      .from(0, 45);
  spec.option("max-de", "DE", "5", &o.most_de76, "median difference above which the matt color is the answer")
      .from(0, 200)
      .in("units of CIE 1976 color difference")
      .more(
          "The matt color is also the answer where the pixels show too few angles. A warning says so, and the exit "
          "status stays 0.");
  spec.heading = "output";
  spec.option("start", "PAINT", "fitted.xml#candy_red", &o.start, "paint that the picture was drawn in before the edit")
      .more(
          "The paint found keeps its gloss where the picture does not tell another one, and its code. PAINT is "
          "FILE[#NAME]; NAME may be left out where the file holds only one paint.");
  spec.option("name", "NAME", "dawn", &o.name, "name of the paint found");
  spec.option("residual", "FILE", "residual.png", &o.residual, "PNG of picture, paint found and their difference")
      .more(
          "Left the used pixels, in the middle the paint found, right the differences, from black through red and "
          "yellow to white at 20 units of CIE 1976. Pixels left out are dark blue.");
  spec.option("output,o", "FILE", "sketch.paints.xml", &o.output, "paint XML to write; - is standard output");
  cli::add_common_options(spec, o.common, {.explain = true});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && "
       "render-osmesa --mesh testdata/speed-shape.obj --paint fitted.xml#candy_red --light 30,50 --aov "
       "aspecular,lambert,mask,part -o scene.exr && "
       "render-osmesa --mesh testdata/speed-shape.obj --paint fitted.xml#candy_red --light 30,50 -o scene.png && "
       "sketch-fit --image scene.png --buffers scene.exr --residual residual.png -o sketch.paints.xml",
       "find the paint of a picture again; before the last step, scene.png may go through an image editor"},
      {"prefilter-envmap testdata/studio.exr --basis testdata/b7.basis.xml -o studio.env.exr && "
       "fit-paint --basis testdata/b7.basis.xml testdata/paints.paints.xml -o fitted.xml && "
       "render-osmesa --mesh testdata/speed-shape.obj --paint fitted.xml#candy_red --env studio.env.exr --aov "
       "normal,aspecular,lambert,mask,part -o studio-scene.exr && "
       "sketch-fit --image studio-scene.exr --buffers studio-scene.exr --env studio.env.exr -o sketch.paints.xml",
       "do the same under a studio"},
      {"render-osmesa --mesh testdata/speed-shape.obj --paint testdata/paints.paints.xml#candy_red --light 30,50 --aov "
       "aspecular,lambert,mask,part -o scene.exr && sketch-fit --image scene.exr --buffers scene.exr --start "
       "testdata/paints.paints.xml#candy_red -o sketch.paints.xml",
       "take the light of an EXR, and the gloss of a known paint where the picture shows none"}};
  spec.report = {
      {"status", "one of fitted and diffuse_fallback"},
      {"reason", "reason of the fallback; else null"},
      {"mode", "one of point, environment and transport"},
      {"bounced_de00_p95",
       "with a transport: error of the bounced light that was scaled to the paint found, 95th percentile, CIEDE2000"},
      {"model", "one of lobes, quadratic, search, search with free rows, search with free lobes, and diffuse"},
      {"rms_de76", "root mean square CIE 1976 difference of the used pixels from the paint found, relative to white"},
      {"median_de76", "their median, which outliers do not move"},
      {"travel_deg", "travel of the paint found"},
      {"face", "L*, a*, b* of its face"},
      {"flop", "L*, a*, b* of its flop"},
      {"rows[]: geometry, L, a, b", "its colors at the export angles"},
      {"extrapolated_deg[]", "those of the angles that no pixel shows"},
      {"residual_angle",
       "angle that residual[] goes by: aspecular under lamps, view (of the viewer from the normal) in other light; "
       "null where the buffers tell neither"},
      {"residual[]: from_deg, to_deg, pixels, median_de76, L, a, b",
       "for each ten degrees with pixels: their number, the median CIE 1976 difference of picture and paint found, and "
       "the mean of picture less paint in L*, a* and b*"},
      {"gloss_60_gu", "its gloss at 60 degrees; null for the fallback, and where it is undetermined without --start"},
      {"gloss_from", "one of highlight, contrast, search, start and undetermined"},
      {"gloss_range_gu",
       "under lamps, the least and the largest gloss that explain the pixels as well, where they were looked for"},
      {"condition", "condition number of the linear fit, or of the search at its end; null where nothing was fitted"},
      {"pixels_used", "number of pixels that the fit rests on"},
      {"pixels_changed", "number of pixels that could be used and were edited"},
      {"pixels_rule", "one of changed and all"},
      {"pixels_compared_with",
       "the picture that the edit began as: picture, that of the buffers, or transport, which shows the paints that "
       "were worn in the light of the transport; null with --pixels all"},
      {"pixels_left_out", "number of pixels that were left out, by reason"},
      {"aspecular_from_deg", "smallest aspecular angle seen; null with --env"},
      {"aspecular_to_deg", "largest aspecular angle seen; null with --env"},
      {"suggested_shift[]", "pixels by which the picture seems moved to the right and down against the buffers"},
      {"registration",
       "scale, turn_deg (clockwise), shift[] (pixels of the picture, of its middle) and agreement (correlation of the "
       "edges) where the picture was laid on the buffers; else null"},
      {"color_space", "color space that the picture was taken for"},
      {"fit_s", "time of the fit, without reading and writing"},
      {"regions_de00[], unsure[]", "not written any more: see residual[]"}};
  spec.see_also = {"render-osmesa(1)", "fit-paint(1)", "paint-pick(1)", "goniochrome-sketches(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "sketch-fit",
                     .summary = "the paint that an edited or drawn picture of a painted mesh shows"};
  spec.description = {
      "sketch-fit finds the paint that a picture shows: Lab at the export angles, face, flop, travel and gloss. The "
      "picture began as a rendering by render-osmesa(1), and was then edited in an image editor, painted over, or "
      "drawn on a trace of it. Buffers that were rendered with it give the angles at every pixel.",
      "# Pictures\nThe picture is an EXR, HDR, PNG, JPEG, TIFF, PNM, DPX, WebP, BMP or TGA. Whole numbers are signals "
      "of a display: sRGB, or as an embedded ICC profile states, after the view and the exposure of render-osmesa. "
      "Floats are light. Pixels are left out at edges, at grazing light, near specular, where they are clipped or "
      "transparent, and outside the mask. For a picture that seems moved, a message names the shift to give.",
      "# Under one lamp\nPixels of equal angles are gathered, and a curve is fitted to them for each channel: cosine "
      "lobes, or the clamped quadratic where it explains the pixels better.",
      "# Under an environment\nWith --env, the lobes of any paint are found with the renderer's own equations on the "
      "buffers, and after them face, flop, travel and gloss where these explain the picture as well. Brushed paint, "
      "color maps and textures are not searched; a warning names them.",
      "# With a transport\nBuffers with a transport hold the light that each lobe gathers at every pixel, with shadows "
      "and light between parts. The picture is linear in the paint, and is solved in that light.",
      "# Gloss\nUnder a lamp that spans an angle, gloss is the reading that explains highlight and mirror image; it is "
      "undetermined where readings more than 10 units apart explain the pixels as well. Under a point, gloss comes "
      "from the shape of the highlight, or from its contrast where it is clipped.",
      "# Residual\nA warning names the export angles that no pixel shows, and the angles at which the picture is "
      "farthest from the paint found. The report has that difference for every ten degrees."};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
