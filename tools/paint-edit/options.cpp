#include "options.h"

#include "base/text.h"

namespace goniochrome::tool {

namespace {

Result<std::optional<double>> one(const char* option, const std::vector<double>& numbers) {
  if (numbers.empty()) return std::optional<double>();
  if (numbers.size() == 1) return std::optional<double>(numbers[0]);
  return usage_error("{} is given {} numbers: give one", option, numbers.size());
}

Result<std::optional<color::Lab>> triple(const char* option, const std::vector<double>& numbers) {
  if (numbers.empty()) return std::optional<color::Lab>();
  if (numbers.size() == 3) return std::optional<color::Lab>(color::Lab{numbers[0], numbers[1], numbers[2]});
  return usage_error("{} is given {} numbers: give three, as in {}=50,12.5,-3", option, numbers.size(), option);
}

Result<void> check_contradictions(const Options& o, const paint::Edit& edit) {
  const bool edits = paint::moves_color(edit) || paint::moves_gloss(edit);
  const bool averages = edit.average_hue_deg || edit.average_chroma || edit.average_lightness;
  if (edit.at_deg && averages)
    return usage_error("--at takes shifts: use --lightness-shift, --chroma-factor and --hue-shift with it");
  if (edit.at_deg && edit.tweak == paint::Tweak())
    return usage_error("--at lacks its move: add --lightness-shift, --chroma-factor or --hue-shift");
  if (edit.face && edit.face->L < 0) return usage_error("--face has L* {}: give 0 or more", shortest(edit.face->L));
  if (edit.flop && edit.flop->L < 0) return usage_error("--flop has L* {}: give 0 or more", shortest(edit.flop->L));
  if (edit.travel_deg && *edit.travel_deg <= 15)
    return usage_error("--travel is {}: it lies above 15 and up to 180", shortest(*edit.travel_deg));
  const bool many = !o.variations.empty() || o.gradient > 0;
  if (many && edits)
    return usage_error("variations and gradients take no other move: pipe one paint-edit into another");
  if (!o.variations.empty() && o.gradient > 0) return usage_error("--variations and --gradient exclude each other");
  if (many && !o.suffix.empty())
    return usage_error("--suffix is for moves: variations and gradients name their paints");
  if (!o.variations.empty() && o.step <= 0) return usage_error("--step is {}: give more than 0", shortest(o.step));
  if (o.gradient > 0 && !o.only.empty())
    return usage_error("--gradient joins the paints as they come: --only is not for it");
  if (!many && !edits) return usage_error("there is nothing to do: give a move, --variations or --gradient");
  return {};
}

}  // namespace

Result<paint::Edit> edit_of(const Options& o) {
  paint::Edit edit;
  GONIO_ASSIGN(edit.average_hue_deg, one("--hue", o.hue_deg));
  GONIO_ASSIGN(edit.average_chroma, one("--chroma", o.chroma));
  GONIO_ASSIGN(edit.average_lightness, one("--lightness", o.lightness));
  GONIO_ASSIGN(edit.at_deg, one("--at", o.at_deg));
  GONIO_ASSIGN(edit.face, triple("--face", o.face));
  GONIO_ASSIGN(edit.flop, triple("--flop", o.flop));
  GONIO_ASSIGN(const auto face_shift, triple("--face-shift", o.face_shift));
  GONIO_ASSIGN(const auto flop_shift, triple("--flop-shift", o.flop_shift));
  GONIO_ASSIGN(edit.travel_deg, one("--travel", o.travel_deg));
  GONIO_ASSIGN(edit.gloss, one("--gloss", o.gloss));
  edit.tweak = {o.lightness_shift, o.chroma_factor, o.hue_shift_deg};
  edit.face_shift = face_shift.value_or(color::Lab());
  edit.flop_shift = flop_shift.value_or(color::Lab());
  edit.travel_shift_deg = o.travel_shift_deg;
  edit.gloss_angle_deg = *parse_number(o.gloss_angle_deg);
  edit.gloss_shift = o.gloss_shift;
  GONIO_TRY(check_contradictions(o, edit));
  return edit;
}

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "paint-edit";
  spec.summary = "change the color, travel and gloss of paints, or make variations and gradients of them";
  spec.description = {
      "paint-edit reads paints, makes the moves it is told and writes them on. Moves are made in the order of the "
      "options below, whatever their order on the command line: first the average of the whole paint, then tweaks, "
      "face, flop, travel and gloss. Where an end is both set and shifted, it is set first.",
      "Hue, chroma and lightness are averages over the paint's curve at 15, 45 and 110 degrees. --at DEG makes the "
      "three shifts where a viewer sees that aspecular angle: at 15 degrees they fall on the face alone, from the "
      "travel on the flop alone, and between on both in proportion.",
      "On a picture of the paint the place is a pixel instead: --image names the buffers that render-osmesa(1) wrote "
      "with it, and --at-pixel X,Y makes the moves of --lighter, --chroma (a factor) and --hue (a turn) at the "
      "aspecular angle under that pixel; --travel-to X,Y ends the travel and --gloss-to X,Y the highlight there.",
      "A paint is edited in every form it has. Measured rows move by what the curve moves at their angle, so that what "
      "the curve did not explain of a measurement stays. A paint that has only rows is fitted first and carries face, "
      "flop and travel from then on. Lobes and color maps no longer hold after a move of the color, nor lobes after a "
      "move of the gloss: they are dropped with a word on standard error, and fit-paint makes new ones. Name, code and "
      "class stay.",
      "--variations writes each paint followed by its eight neighbors, named after the change: for face and flop "
      "lighter, darker, red, yellow, green, cyan, blue and magenta, each --step away in CIE 1976 color difference; for "
      "travel and gloss one to four steps either way. --gradient N writes the paints with N between each and the next, "
      "equally spaced in Lab at face, flop and every measured geometry that both have.",
      "A move that a paint cannot take, such as a hue for a gray, is left out with a warning; the other moves are made "
      "and the exit status is 1."};
  spec.inputs = {.value = "PAINTS",
                 .help = "paint XML files, or FILE#NAME for one paint of a file; standard input where none is given",
                 .target = &o.inputs};
  spec.options = {
      {.name = "output", .letter = 'o', .value = "FILE", .help = "paint XML to write", .target = &o.output},
      {.name = "only",
       .value = "NAME",
       .help = "edit the paints of this name, pass the others on; repeatable",
       .target = &o.only},
      {.name = "suffix", .value = "TEXT", .help = "appended to the name of every paint edited", .target = &o.suffix},
      {.name = "hue",
       .value = "DEG",
       .help = "average CIELAB hue to reach",
       .target = &o.hue_deg,
       .low = -360,
       .high = 360},
      {.name = "chroma", .value = "C", .help = "average chroma to reach", .target = &o.chroma, .low = 0, .high = 300},
      {.name = "lightness", .value = "L", .help = "average L* to reach", .target = &o.lightness, .low = 0, .high = 300},
      {.name = "hue-shift",
       .value = "DEG",
       .help = "hue turned by this, counterclockwise in a*b*",
       .target = &o.hue_shift_deg,
       .low = -360,
       .high = 360},
      {.name = "chroma-factor",
       .value = "K",
       .help = "chroma times this",
       .target = &o.chroma_factor,
       .low = 0,
       .high = 100},
      {.name = "lightness-shift",
       .value = "D",
       .help = "L* plus this",
       .target = &o.lightness_shift,
       .low = -300,
       .high = 300},
      {.name = "at",
       .value = "DEG",
       .help = "make the three shifts above at this aspecular angle, not everywhere",
       .target = &o.at_deg,
       .low = 0,
       .high = 180},
      {.name = "image",
       .value = "FILE",
       .help = "buffers of a picture of the paint, of render-osmesa --aov aspecular,mask",
       .target = &o.image},
      {.name = "at-pixel",
       .value = "X,Y",
       .help = "make the shifts at the aspecular angle under this pixel; --chroma is then a factor, --hue a turn",
       .target = &o.at_pixel,
       .low = 0,
       .high = 1048576},
      {.name = "lighter",
       .value = "D",
       .help = "L* plus this under the pixel of --at-pixel",
       .target = &o.lighter,
       .low = -300,
       .high = 300},
      {.name = "face", .value = "L,A,B", .help = "color at 15 degrees", .target = &o.face, .low = -300, .high = 300},
      {.name = "face-shift",
       .value = "L,A,B",
       .help = "added to the face",
       .target = &o.face_shift,
       .low = -300,
       .high = 300},
      {.name = "flop",
       .value = "L,A,B",
       .help = "color from the travel on",
       .target = &o.flop,
       .low = -300,
       .high = 300},
      {.name = "flop-shift",
       .value = "L,A,B",
       .help = "added to the flop",
       .target = &o.flop_shift,
       .low = -300,
       .high = 300},
      {.name = "travel",
       .value = "DEG",
       .help = "aspecular angle where the color stops changing",
       .target = &o.travel_deg,
       .low = 15,
       .high = 180},
      {.name = "travel-shift",
       .value = "DEG",
       .help = "added to the travel",
       .target = &o.travel_shift_deg,
       .low = -165,
       .high = 165},
      {.name = "travel-to",
       .value = "X,Y",
       .help = "let the color stop changing where this pixel of --image is",
       .target = &o.travel_to,
       .low = 0,
       .high = 1048576},
      {.name = "gloss", .value = "GU", .help = "gloss units to reach", .target = &o.gloss, .low = 0, .high = 100},
      {.name = "gloss-shift",
       .value = "GU",
       .help = "added to the gloss",
       .target = &o.gloss_shift,
       .low = -100,
       .high = 100},
      {.name = "gloss-to",
       .value = "X,Y",
       .help = "let the highlight fall to half its brightness at this pixel of --image",
       .target = &o.gloss_to,
       .low = 0,
       .high = 1048576},
      {.name = "gloss-angle",
       .value = "DEG",
       .help = "which gloss reading is meant",
       .target = &o.gloss_angle_deg,
       .choices = {"20", "60", "85"}},
      {.name = "variations",
       .value = "WHAT",
       .help = "write each paint and its eight neighbors",
       .target = &o.variations,
       .choices = {"face", "flop", "travel", "gloss"}},
      {.name = "step",
       .value = "X",
       .help = "how far the variations go: color difference, degrees or gloss units",
       .target = &o.step,
       .low = 0,
       .high = 165},
      {.name = "gradient",
       .value = "N",
       .help = "write N new paints between each paint and the next; 0 for none",
       .target = &o.gradient,
       .low = 0,
       .high = 100000}};
  spec.examples = {
      {"paint-edit testdata/paints.paints.xml --only candy_blue --hue 200 --suffix _green -o greener.paints.xml",
       "Turns a blue metallic toward green and keeps its travel."},
      {"paint-edit testdata/paints.paints.xml --at 45 --lightness-shift 4 --chroma-factor 1.1 -o brighter.paints.xml",
       "Lightens every paint where it is seen at 45 degrees, and face and flop each by its share."},
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 --size 640x400 --aov aspecular,mask -o scene.exr "
       "&& paint-edit testdata/paints.paints.xml#candy_red --image scene.exr --at-pixel 250,200 --lighter 3 --chroma "
       "1.1 -o tweaked.paints.xml",
       "Lightens a red where the pixel shows it."},
      {"paint-edit testdata/paints.paints.xml#silver_fine --variations flop --step 6 -o nine.paints.xml",
       "Writes a silver and the eight paints around it for a variations sheet."},
      {"paint-edit testdata/paints.paints.xml#ice_blue testdata/paints.paints.xml#candy_blue --gradient 6 -o "
       "facade.paints.xml",
       "Writes a sequence of eight metallics for a facade."}};
  spec.report = {
      {"read", "paints read"},
      {"written", "paints written"},
      {"pixels[].option", "an option that names a place in --image"},
      {"pixels[].x", "the place, in pixels from the left"},
      {"pixels[].y", "and from the top"},
      {"pixels[].aspecular_deg", "aspecular angle seen there"},
      {"changes[].name", "name of a paint that was edited or made"},
      {"changes[].from", "name of the paint it was made from; of both for a gradient"},
      {"changes[].fraction", "place in a gradient, 0 to 1"},
      {"changes[].before",
       "face, flop (L*, a*, b*), travel_deg and gloss (gloss_60_deg and so on) before; for a gradient absent"},
      {"changes[].after", "the same after"},
      {"changes[].de00_max", "largest CIEDE2000 between before and after at 15, 45 and 110 degrees"},
      {"changes[].fitted_de00", "worst row of the fit, where the paint had only rows"},
      {"changes[].dropped[]", "what no longer holds and was left out"},
      {"changes[].clipped[]", "values that a move took out of their domain and that were put at its edge"},
      {"changes[].skipped[]", "moves this paint cannot take, and why"}};
  spec.see_also = {"fit-paint(1)", "paint-convert(1)", "render-osmesa(1)"};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome::tool
