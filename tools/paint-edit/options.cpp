#include "tool.h"

#include "base/text.h"
#include "paint_stream.h"
#include "stated.h"

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

Result<std::optional<paint::Anisotropy>> alphas(const std::vector<double>& numbers) {
  if (numbers.empty()) return std::optional<paint::Anisotropy>();
  if (numbers.size() != 2)
    return usage_error("--anisotropy is given {} numbers: give two, as in --anisotropy 0.05,0.3", numbers.size());
  if ((numbers[0] == 0) != (numbers[1] == 0))
    return usage_error("--anisotropy is {},{}: give two numbers above 0, or 0,0 to take it away", shortest(numbers[0]),
                       shortest(numbers[1]));
  return std::optional(paint::Anisotropy{numbers[0], numbers[1]});
}

Result<std::optional<paint::Flakes>> flakes_in(const std::vector<double>& numbers) {
  if (numbers.empty()) return std::optional<paint::Flakes>();
  if (numbers.size() != 2 && numbers.size() != 3)
    return usage_error("--flakes is given {} numbers: give diameter and coverage, as in --flakes 30,0.5",
                       numbers.size());
  paint::Flakes flakes{numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : paint::Flakes().spread_deg};
  if ((flakes.diameter_um == 0) != (flakes.coverage == 0))
    return usage_error("--flakes is {},{}: give two numbers above 0, or 0,0 to take them away",
                       shortest(flakes.diameter_um), shortest(flakes.coverage));
  if (flakes.coverage > 1)
    return usage_error("--flakes has coverage {}: it is a part of the surface, up to 1", shortest(flakes.coverage));
  if (flakes.spread_deg > paint::kMostFlakeSpread_deg)
    return usage_error("--flakes has spread {}: one flake spreads light by up to {} deg", shortest(flakes.spread_deg),
                       shortest(paint::kMostFlakeSpread_deg));
  return std::optional(flakes);
}

// Checks which options about names can stand together.
Result<void> check_identity(const Options& o, bool many) {
  if (!o.rename.empty() && !o.suffix.empty()) return usage_error("--rename and --suffix exclude each other");
  if (o.new_name.empty()) return {};
  if (!o.inputs.empty()) return usage_error("--new makes a paint and reads none: leave {} out", o.inputs.front());
  if (!o.rename.empty() || !o.suffix.empty())
    return usage_error("--new names its paint: leave --rename and --suffix out");
  if (!o.only.empty()) return usage_error("--new makes one paint: leave --only out");
  if (many) return usage_error("--new makes one paint: pipe it into another paint-edit for variations and gradients");
  return {};
}

Result<void> check_contradictions(const Options& o, const paint::Edit& edit) {
  const bool edits =
      paint::moves_color(edit) || paint::moves_gloss(edit) || edit.anisotropy || edit.flakes || moves_identity(o);
  const bool averages = edit.average_hue_deg || edit.average_chroma || edit.average_lightness;
  if (edit.at_deg && averages)
    return usage_error("--at takes shifts: use --lightness-shift, --chroma-factor and --hue-shift with it");
  if (edit.at_deg && edit.tweak == paint::Tweak())
    return usage_error("--at lacks its move: add --lightness-shift, --chroma-factor or --hue-shift");
  if (!edit.at_deg && edit.share == paint::Share::kSource) return usage_error("--share is for --at and --at-pixel");
  if (edit.keep_residual && !paint::states_appearance(edit))
    return usage_error("--keep-residual is for --face, --flop and --travel: other moves keep it anyway");
  if (edit.face && edit.face->L < 0) return usage_error("--face has L* {}: give 0 or more", shortest(edit.face->L));
  if (edit.flop && edit.flop->L < 0) return usage_error("--flop has L* {}: give 0 or more", shortest(edit.flop->L));
  if (edit.travel_deg && *edit.travel_deg <= 15)
    return usage_error("--travel is {}: it lies above 15 and up to 180", shortest(*edit.travel_deg));
  if (o.no_code && !o.code.empty()) return usage_error("--code and --no-code exclude each other");
  const bool many = !o.variations.empty() || o.gradient > 0;
  GONIO_TRY(check_identity(o, many));
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

bool moves_identity(const Options& o) {
  return !o.rename.empty() || !o.code.empty() || o.no_code || !o.paint_class.empty() || !o.new_name.empty();
}

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
  GONIO_ASSIGN(edit.readings, stated_readings(o.readings));
  GONIO_ASSIGN(edit.anisotropy, alphas(o.anisotropy));
  GONIO_ASSIGN(edit.flakes, flakes_in(o.flakes));
  edit.share = o.share == "source" ? paint::Share::kSource : paint::Share::kExact;
  edit.keep_residual = o.keep_residual;
  edit.tweak = {o.lightness_shift, o.chroma_factor, o.hue_shift_deg};
  edit.face_shift = face_shift.value_or(color::Lab());
  edit.flop_shift = flop_shift.value_or(color::Lab());
  edit.travel_shift_deg = o.travel_shift_deg;
  edit.gloss_angle_deg = *parse_number(o.gloss_angle_deg);
  edit.gloss_shift = o.gloss_shift;
  GONIO_TRY(check_contradictions(o, edit));
  return edit;
}

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  const auto lab = [&](const char* name, const char* example, std::vector<double>& target, const char* help) {
    spec.option(name, "L,A,B", example, &target, help).from(-300, 300).in("CIELAB units");
  };
  const auto pixel = [&](const char* name, std::vector<double>& target, const char* help) -> cli::Option& {
    return spec.option(name, "X,Y", "250,200", &target, help).from(0, 1048576);
  };
  spec.heading = "average of the whole paint";
  spec.option("hue", "DEG", "200", &o.hue_deg, "average CIELAB hue to reach")
      .from(-360, 360)
      .more("Averages are taken over the paint's curve at 15, 45 and 110 degrees.");
  spec.option("chroma", "C", "40", &o.chroma, "average chroma to reach").from(0, 300).in("CIELAB units");
  spec.option("lightness", "L", "60", &o.lightness, "average L* to reach").from(0, 300).in("CIELAB units");
  spec.heading = "shifts, of the whole paint or at one angle";
  spec.option("hue-shift", "DEG", "-10", &o.hue_shift_deg, "angle to turn the hue by, counterclockwise in a*b*")
      .from(-360, 360);
  spec.option("chroma-factor", "K", "1.1", &o.chroma_factor, "factor for the chroma").from(0, 100);
  spec.option("lightness-shift", "D", "4", &o.lightness_shift, "what is added to L*")
      .from(-300, 300)
      .in("CIELAB units");
  spec.option("at", "DEG", "45", &o.at_deg, "make the three shifts at this aspecular angle, not everywhere")
      .from(0, 180)
      .more(
          "Face and flop change as little as that needs: up to 15 degrees the face alone, from the travel on the flop "
          "alone.");
  spec.option("share", "HOW", "source", &o.share, "how a change at one angle is divided between face and flop")
      .one_of({"exact", "source"})
      .more(
          "exact makes the change in full. source blends face and flop as Shimizu's dissertation does, and makes less "
          "of it.");
  spec.heading = "moves at a place in a picture";
  spec.option("image", "FILE", "scene.exr", &o.image, "buffers of a picture of the paint")
      .more(
          "render-osmesa(1) writes them with --aov aspecular,mask. With transport among them, the angle is that of "
          "traced light.");
  pixel("at-pixel", o.at_pixel, "make shifts at the aspecular angle under this pixel")
      .more("The shifts are --lighter, --chroma (a factor) and --hue (a turn).");
  spec.option("lighter", "D", "3", &o.lighter, "what is added to L* under the pixel of --at-pixel")
      .from(-300, 300)
      .in("CIELAB units");
  pixel("travel-to", o.travel_to, "let the color stop changing at this pixel of --image");
  pixel("gloss-to", o.gloss_to, "let the highlight fall to half its brightness at this pixel of --image");
  spec.heading = "face, flop, travel and gloss";
  lab("face", "70,5,12", o.face, "color at 15 degrees");
  lab("face-shift", "5,0,0", o.face_shift, "what is added to the face");
  lab("flop", "20,2,-8", o.flop, "color from the travel on");
  lab("flop-shift", "-5,0,0", o.flop_shift, "what is added to the flop");
  spec.option("travel", "DEG", "60", &o.travel_deg, "aspecular angle where the color stops changing").from(15, 180);
  spec.option("travel-shift", "DEG", "10", &o.travel_shift_deg, "what is added to the travel").from(-165, 165);
  spec.flag("keep-residual", &o.keep_residual, "keep what the curve did not explain of the rows of a measured paint")
      .more("Without it, --face, --flop and --travel state the rows anew.");
  spec.option("set", "GEOMETRY=L,A,B", "45as45=50,12.5,-3", &o.readings, "what the paint shall read at this geometry")
      .more("The other rows stay, and face, flop and travel are fitted to all rows, unless one of them is given.");
  spec.option("gloss", "GU", "90", &o.gloss, "gloss to reach").from(0, 100);
  spec.option("gloss-shift", "GU", "-5", &o.gloss_shift, "what is added to the gloss").from(-100, 100);
  spec.option("gloss-angle", "DEG", "20", &o.gloss_angle_deg, "angle of the gloss reading that is moved")
      .one_of({"20", "60", "85"});
  spec.option("anisotropy", "AX,AY", "0.05,0.3", &o.anisotropy,
              "widths of a brushed surface along X and Y; 0,0 for none")
      .from(0, 10)
      .in("slopes, the alpha of Ward's model")
      .more("Flake reflection and gloss are both drawn out along the wider direction.");
  spec.option("flakes", "D,COVERAGE[,SPREAD]", "30,0.5", &o.flakes,
              "single flakes that sparkle; 0,0 for those of the class")
      .from(0, 1000)
      .in("micrometers, the part of the surface that they cover, and degrees")
      .more(
          "The spread is 0.5 degrees where it is left out. The color stays: flakes share out the light of the lobes.");
  spec.heading = "many paints from one or two";
  spec.option("variations", "WHAT", "flop", &o.variations, "write each paint and its eight neighbors")
      .one_of({"face", "flop", "travel", "gloss"})
      .more(
          "Neighbors of face and flop are lighter, darker, red, yellow, green, cyan, blue and magenta, each one --step "
          "away; those of travel and gloss are one to four steps away, either way.");
  spec.option("step", "X", "6", &o.step, "how far the variations go")
      .from(0, 165)
      .in("units of CIE 1976 color difference, in degrees or in gloss units");
  spec.option("gradient", "N", "6", &o.gradient, "write N new paints between each paint and the next; 0 for none")
      .from(0, 100000)
      .more("They are equally spaced in Lab at face, flop and every common geometry.");
  spec.heading = "input and output";
  add_only_option(spec, o.only, "edit the paints of this name, and pass the others on");
  spec.option("suffix", "TEXT", "_green", &o.suffix, "text to append to the names of edited paints");
  spec.option("rename", "NAME", "dune", &o.rename, "name of the paint that is edited, if only one is edited");
  spec.option("code", "CODE", "RM331", &o.code, "code of edited paints");
  spec.flag("no-code", &o.no_code, "take the code of edited paints away");
  spec.option("class", "CLASS", "metallic", &o.paint_class, "class of edited paints")
      .one_of({"solid", "metallic", "pearl", "interference", "unknown"});
  spec.option("new", "NAME", "dune", &o.new_name, "make a paint of this name from nothing, and read none")
      .more("It needs --face, or readings by --set; with --flop also --travel. Without a flop the paint is solid.");
  spec.option("output,o", "FILE", "edited.paints.xml", &o.output, "paint XML to write; - is standard output");
  cli::add_common_options(spec, o.common, {.explain = true});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"paint-edit testdata/paints.paints.xml --only candy_blue --hue 200 --suffix _green -o greener.paints.xml",
       "turn a blue metallic toward green and keep its travel"},
      {"paint-edit testdata/paints.paints.xml#silver_fine --face 45,55,30 --flop 20,25,12 --travel 70 -o "
       "design.paints.xml",
       "state the color of a paint outright, so that it reads exactly this at 15 and 110 degrees"},
      {"paint-edit --new dune --face 70,5,25 --flop 30,4,12 --travel 60 --gloss 90 --code S1 -o dune.paints.xml",
       "make a paint from nothing"},
      {"render-osmesa --mesh testdata/speed-shape.obj --light 30,50 --size 640x400 --aov aspecular,mask -o scene.exr "
       "&& paint-edit testdata/paints.paints.xml#candy_red --image scene.exr --at-pixel 250,200 --lighter 3 --chroma "
       "1.1 -o tweaked.paints.xml",
       "lighten a red where the pixel shows it"},
      {"paint-edit testdata/paints.paints.xml#silver_fine --variations flop --step 6 -o nine.paints.xml",
       "write a silver and the eight paints around it, for a variations sheet"},
      {"paint-edit testdata/paints.paints.xml#ice_blue testdata/paints.paints.xml#candy_blue --gradient 6 -o "
       "facade.paints.xml",
       "write a sequence of eight metallics"}};
  spec.report = {
      {"read", "number of paints read"},
      {"written", "number of paints written"},
      {"pixels[].option, x, y", "option that names a place in --image, and the place"},
      {"pixels[].aspecular_deg, traced", "aspecular angle there, and whether it is one of traced light"},
      {"changes[].name", "name of a paint that was edited or made"},
      {"changes[].from", "name of its origin; for a gradient, both names"},
      {"changes[].fraction", "place in a gradient, 0 to 1"},
      {"changes[].before",
       "face, flop (L*, a*, b*), travel_deg, gloss_60_deg and so on, anisotropy and flakes before the moves"},
      {"changes[].after", "the same after them"},
      {"changes[].de00_max", "largest CIEDE2000 difference between before and after at 15, 45 and 110 degrees"},
      {"changes[].fitted_de00", "worst row of the fit, where the paint had only rows or where readings were set"},
      {"changes[].restated_de00", "worst row against the curve before the rows were stated anew, where they were"},
      {"changes[].dropped[]", "what no longer holds and was left out"},
      {"changes[].clipped[]", "values that a move took out of their domain, and that were put at its edge"},
      {"changes[].skipped[]", "moves that it cannot take, and why"}};
  spec.see_also = {"fit-paint(1)", "paint-convert(1)", "render-osmesa(1)", "goniochrome-paint(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "paint-edit",
      .summary = "change the color, travel and gloss of paints, or make variations and gradients of them"};
  spec.description = {
      "paint-edit changes paints as a designer does: hue, chroma, lightness, face, flop, travel, single readings, "
      "gloss and anisotropy. It also makes new paints, variations and gradients.",
      "# Order of moves\nWhatever their order on the command line, moves are made in this order: the average of the "
      "whole paint, shifts, face, flop, travel, single readings and gloss. Setting comes before shifting. A move that "
      "a paint cannot take, as a gray has no hue to turn, is left out with a warning, and the exit status is 1.",
      "# Rows, curve and lobes\nMeasured rows move as the curve does at their angle. Where face, flop or "
      "travel are set outright, the rows are stated anew from the curve, so that the paint reads what was asked for; "
      "--keep-residual keeps their distance from the curve. A paint that has only rows is fitted first. Lobes and "
      "color maps are dropped after a move that changes them, with a message; fit-paint(1) makes new ones."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.inputs};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
