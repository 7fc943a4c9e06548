#include "tool.h"

namespace goniochrome::tool {

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "surface";
  spec.option("width", "W", "120", &o.width, "width of the surface in the photographs, in the unit of the table")
      .from(1e-9, 1e9)
      .in("the unit of the positions in the table")
      .more(
          "The height follows from the number of rows. The middle of the surface is the origin of the table, x runs "
          "right, y runs up, and z is the normal.");
  spec.option("texels", "WxH", "512x256", &o.texels, "texels of the map, for photographs with marked corners")
      .more("They are squares, so that W and H are in the proportion of the plate. See Photographs in perspective.");
  spec.option("mask", "FILE", "mask.png", &o.mask, "fit only where this image is white")
      .more("The alpha of the map is 1 there, and elsewhere it is 0 and the texels are black.");
  spec.option("normals", "FILE", "normals.png", &o.normals, "normal of each texel, where the surface is not flat")
      .more(
          "An image of whole numbers holds (n + 1)/2 of the unit normal, with y up, as normal maps of games do; one of "
          "floats holds the normal itself. The map keeps the normal, its lobes are those of the frame whose z it is, "
          "and "
          "pictures are drawn with it.");
  spec.heading = "how it is fitted";
  spec.option("lobes,n", "N", "1", &o.lobes, "lobes of each texel").from(1, 4);
  spec.option("method,m", "METHOD", "dictionary", &o.method, "how the lobes are found")
      .one_of({"best", "dictionary", "nonlinear"})
      .more("See Methods.");
  spec.option("noise", "SHARE", "0.01", &o.noise, "relative standard deviation of a value, besides its rounding")
      .from(1e-4, 0.5)
      .in("parts of the value")
      .more("How far a value may be off and still count is taken from the values themselves; this is where it begins.");
  spec.option("saturated", "V", "0.98", &o.saturated, "value from which a pixel of floats is saturated")
      .from(0)
      .in("pixel values")
      .more("Whole numbers are saturated where a channel has the largest one. No float is saturated by default.");
  spec.flag("mend-exposures", &o.mend_exposures, "correct exposures that are wrong by a factor")
      .more(
          "Each photograph is compared with what the others predict. One whose values are the same multiple of that "
          "everywhere, and off by more than a quarter of a stop, has a wrong exposure in the table. It is named, and "
          "left out unless this option is given.");
  spec.option("tile", "ROWS", "16", &o.tile_rows, "rows of all photographs that are in memory at once; 0 is 64 MB")
      .from(0, 1000000)
      .in("rows")
      .more("The photographs lie in a temporary file meanwhile. The map is the same for any number.");
  spec.heading = "check";
  spec.option("holdout,k", "K", "8", &o.holdout, "photographs that the fit does not see, to check it")
      .from(0, 1000)
      .more("They are spread evenly over the table.");
  cli::add_tolerance(spec, o.common, "X", "largest median relative error")
      .in("relative error")
      .more(
          "The error is that of the photographs held out, or else that of those fitted. It is the sum of the absolute "
          "errors of the three channels over the sum of the channels. A larger one makes the exit status 1.");
  spec.option("error-map", "FILE", "error.png", &o.error_map, "median relative error of each texel, .exr or .png")
      .more("In a PNG black is no error, white is 20 % or more, and uncertain texels are red.");
  spec.heading = "output";
  spec.option("output,o", "FILE", "map.sbrdf.exr", &o.output, "where the map goes; - is standard output");
  cli::add_common_options(spec, o.common, {.explain = true});
}

void add_report(cli::ToolSpec& spec) {
  spec.report = {{"texels", "number of texels inside the mask"},
                 {"uncertain", "how many of them are uncertain"},
                 {"width", "columns of the map"},
                 {"height", "rows of the map"},
                 {"lobes", "lobes of each texel"},
                 {"rel_error_median", "median relative error over the photographs that were fitted"},
                 {"holdout_rel_error", "the same over those held out; null where there is none"},
                 {"left_out_share", "share of the values that were taken for shadows or outliers"},
                 {"method", "the method that made the map"},
                 {"methods[].method", "a method that was tried on a sample of texels"},
                 {"methods[].rel_error", "its median relative error over photographs that it did not see"},
                 {"methods[].texel_us", "its time for a texel, without neighbors, on one thread"},
                 {"images[].image", "file of a photograph"},
                 {"images[].exposure_factor", "its values over those that the other photographs predict"},
                 {"images[].wrong_exposure", "whether this factor says that its exposure is wrong"},
                 {"images[].held_out", "whether it was held out"},
                 {"images[].rel_error", "its median relative error"},
                 {"images[].saturated_share", "share of its pixels that are saturated"},
                 {"images[].black_share", "share of its pixels that are black"},
                 {"read_s", "time of reading the photographs"},
                 {"fit_s", "time of the fit"},
                 {"texels_per_s", "texels fitted in a second"},
                 {"warnings[]", "exposures that are wrong, and how many texels are uncertain"}};
  spec.see_also = {"render-osmesa(1)", "goniochrome-paint(5)", "goniochrome-surfaces(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "fit-sbrdf", .summary = "fit a map of lobes to photographs of a surface"};
  spec.description = {
      "fit-sbrdf reads a table of photographs of a surface, each with the place of its light and of its camera, and "
      "writes the map of a spatially varying surface (*.sbrdf.exr): for every texel a diffuse part, one to four "
      "generalized cosine lobes and the direction to which they are turned, as render-osmesa --texture draws it. "
      "Further channels hold alpha; certainty, which is 0 where the photographs do not settle the lobes of a texel; "
      "and error, the median relative error of the texel. A texel is uncertain where too few values count, where more "
      "than a third of them had to be left out, where none was taken within 20 degrees of the mirror direction, where "
      "a lobe was never seen at a tenth of its peak, or where its "
      "strength had to be bounded.",
      "The photographs are registered: they have the same size, and a pixel of each is the same place of the surface; "
      "or the corners of the surface are marked in them. 8 and 16 bit PNG, EXR and other formats are read; whole "
      "numbers are decoded as sRGB unless they state another color space. goniochrome-surfaces(7) says how to take "
      "photographs.",
      "The table is text (CSV) whose first row names its columns. image is a path relative to the table. light_x, "
      "light_y, light_z and camera_x, camera_y, camera_z are places, with the middle of the surface as the origin and "
      "z along its normal. With a column light_distance or camera_distance, x, y and z are a direction and the "
      "distance "
      "is taken from there, in the same unit; inf means parallel rays. exposure is the linear value, 1 being the "
      "largest of whole numbers, that a white matte surface would have that faces the light at distance 1, in the unit "
      "of the table; it is measured once with a white card. Twice the exposure time doubles it. Lines that begin with "
      "# are remarks.",
      "# Photographs in perspective\nThe columns corner1_x, corner1_y to corner4_x, corner4_y hold the corners of the "
      "surface in a photograph: upper left, upper right, lower right, lower left, in pixels from the upper left edge "
      "of the photograph; the middle of its first pixel is at .5, .5. With --texels such photographs are rectified, so "
      "that cameras and sizes may differ. A texel is the mean, in linear light, of the pixels that it covers. Rows "
      "without corners are of the size of the map already. The column k1 is the distortion of the lens: what is to be "
      "at the distance r from the middle of the photograph, in half diagonals, is seen at r (1 + k1 r^2). Without it, "
      "remove the distortion before.",
      "# Methods\ndictionary chooses lobes from a dictionary by weights that are not negative, weighs shadows, "
      "saturated values and outliers down, refines the lobes, and takes neighbors into account. nonlinear is least "
      "squares from one start, for each texel by itself, with one or two lobes, as in the first paper on such maps; it "
      "takes less time and takes every value for good. best tries both on 64 texels, a fifth of whose photographs it "
      "does not show them, and takes nonlinear where that predicts them better by a tenth."};
  spec.inputs = {"TABLE", "table of photographs (CSV); - or none is standard input", &o.table, 0, 1};
  add_options(spec, o);
  spec.examples = {
      {"fit-sbrdf testdata/capture/photos.csv -n 1 --width 2 -o varnish.sbrdf.exr",
       "fit the sample photographs of varnished stripes"},
      {"fit-sbrdf testdata/capture/photos.csv -n 1 --width 2 -k 3 --error-map error.png --report fit.json -o "
       "varnish.sbrdf.exr",
       "hold three photographs out, and show where the map is off"},
      {"fit-sbrdf testdata/capture/photos.csv -n 1 --width 2 -o varnish.sbrdf.exr && render-osmesa --mesh "
       "testdata/speed-shape.obj --texture Hood=varnish.sbrdf.exr --light 30,50 --size 320x180 -o hood.png",
       "see the map on a hood under a lamp"}};
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
