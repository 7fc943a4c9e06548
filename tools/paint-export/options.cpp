#include "materials/material.h"
#include "table_output.h"
#include "tool.h"

namespace goniochrome::tool {

namespace {

// The targets as the manual lists them; the library knows them.
std::string target_list() {
  std::string text = "The targets are";
  for (const materials::Target* target : materials::targets())
    text += std::string(target == materials::targets().front() ? " " : "; ") + target->name + ", " + target->what +
            " (" + target->ending + ")";
  return text + ".";
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const materials::Target* target : materials::targets()) names.emplace_back(target->name);
  return names;
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "paint-export",
                     .summary = "write fitted paints as materials of other renderers, and tell what these will show"};
  spec.description = {
      "paint-export reads paints with lobes, as fit-paint makes them, and writes one file for each. " + target_list(),
      "It prints a table with a line for each paint: its name, its file, and the mean and the largest CIEDE2000 "
      "difference between the lobes and what the target will show. The target is evaluated by its own model at 17 "
      "geometries: light at 15, 45 and 65 degrees, viewers in the plane of incidence from 15 to 110 degrees off the "
      "mirror direction, and one beside the plane. The column readings is the mean difference from the readings of the "
      "paint itself, which the error of its fit is part of; it is n/a where it has none.",
      "A table for Mitsuba holds every paint, but not a mirror: the mirror image in the coat is widened to an orange "
      "peel with slopes of 0.01. The bands of a spectral table come from the spectra that a paint keeps, and a colored "
      "paint without spectra has none. Where nothing else is said, files have linear Rec.709 colors. Graphs of "
      "MaterialX "
      "whose paint is outside of Rec.709 say that they are in ACEScg, and a renderer that works in Rec.709 cuts their "
      "colors. In a table of RGB, a color outside of Rec.709 has a value below 0, which Mitsuba carries through to its "
      "picture. The other targets know no light below 0, and what they show of such a color is cut; the difference "
      "tells how much that is.",
      "A material of MDL has two files: NAME.mdl lays the mirror of the coat, as a layer, over the table NAME.mbsdf, "
      "whose cells are 1 degree wide. Lobes of an exponent of 1000 and more are narrower than these, and the mirror "
      "gets "
      "their light. Neither file says what space its colors are in. The table of the target mdl is in Rec.709, where a "
      "color outside of it is the nearest one inside, and the tool tells the difference: 6.5 dE00 in the mean for a "
      "strong turquoise metallic paint. A renderer that works in ACEScg shows such a paint by the table of the target "
      "mdl-acescg within 0.1 dE00; elsewhere that table shows other colors.",
      "A file for Radiance is a tree whose leaves have one color each, up to 65536 of them for each of 128 angles of "
      "incidence, and nothing is interpolated between them: a metallic paint is some 0.3 dE00 off in the mean and "
      "takes "
      "60 MB. It stands on the side of the normal, with its chromaticities relative to the illuminant E, which is the "
      "white of Radiance; versions that know no color in trees show its Y.",
      "A material of ASAM OpenMATERIAL 3D has two files: NAME.xomp names NAME_brdf.xompt, a table of wavelength, "
      "incidence, exit, azimuth and f for paints with spectra, and for gray ones. The azimuth is 0 toward the light "
      "and "
      "pi beyond the mirror direction, and the other half of the circle is the mirror image. The format does not say "
      "what lies between its rows: the difference assumes a line in each angle, and rows stand at most angles of "
      "instruments, where it is 0; between them it is 0.2 dE00 in the mean for a metallic paint. A file has 26 MB. The "
      "mirror is widened to the cells of the table, 2.5 degrees. Owner, license and author are not stated, and the "
      "file says so where the format demands them.",
      "The targets other than tables have few parameters, and the nearest are taken by the color difference over all "
      "angles. A graph of MaterialX has many lobes. glTF gets a thin film where that brings the colors nearer by 0.1 "
      "or "
      "more. Standard Surface, OpenPBR, glTF, USD and Enterprise PBR have one roughness, and a "
      "metallic paint is several dE00 off in them.",
      "A material for the Enterprise PBR Shading Model 2022x of Dassault Systemes is glTF with the extensions that the "
      "model maps to its parameters: albedo, metallic, roughness, specular, specular tint, index of refraction and "
      "clearcoat. Renderers that read such a file as plain glTF show another color.",
      "What no instrument has measured is not invented: no target gets sparkle, and MaterialX alone gets the flakes "
      "that a paint states. Color maps and anisotropy of "
      "a paint are left out, with a warning. AxF is not written: the layers of paint in its container are not openly "
      "specified, and there is no reader to test a writer with.",
      "# Names\nIn the names of files and of materials, every character of a name but ASCII letters, digits and "
      "underscores is an underscore, an underscore stands before a digit at the beginning, and names that would be "
      "equal get a number. The file keeps the name of the paint too. The folder must be there. A pattern without "
      "{name} is the file of a single paint; with - the table is left out."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.inputs};
  spec.heading = "target";
  spec.option("to,t", "TARGET", materials::targets().front()->name, &o.to, "what the files are for")
      .one_of(target_names())
      .needed();
  add_keep_going(spec, "keep-going,k", o.keep_going, "paints that cannot be read or have no lobes");
  spec.heading = "output";
  spec.option("output,o", "PATTERN", "car-{name}", &o.output, "names of the files; {name} stands for the paint")
      .more(
          "A pattern that ends in {name} gets the ending of the target; - is standard output of one paint; see Names.");
  cli::add_common_options(spec, o.common, {.explain = true});
  spec.examples = {
      {"fit-paint -q --basis testdata/b7.basis.xml testdata/paints.paints.xml#silver_fine | paint-export --to rgl -o "
       "silver.bsdf",
       "write a table of a fitted paint for Mitsuba"},
      {"fit-paint -q --basis testdata/b7.basis.xml testdata/paints.paints.xml | paint-export --to materialx --report "
       "export.json",
       "write every paint of a library as a graph of MaterialX, and keep the figures"},
      {"fit-paint -q --basis testdata/b7.basis.xml 'testdata/paints.paints.xml#candy*' | paint-export --to gltf -o "
       "'web-{name}'",
       "write some paints for web viewers, with a prefix before each name"},
  };
  spec.report = {{"paints[].name", "name of the paint"},
                 {"paints[].target", "the target"},
                 {"paints[].file", "the file that was written"},
                 {"paints[].companion", "the second file of a target that has two; null for others"},
                 {"paints[].de00_mean", "mean CIEDE2000 difference of the target from the lobes, over the geometries"},
                 {"paints[].de00_max", "the largest of these differences"},
                 {"paints[].de00_by_geometry", "the difference at each geometry"},
                 {"paints[].readings_de00_mean", "mean difference from the readings; null where there are none"},
                 {"paints[].left_out[]", "what of the paint the target does not have"},
                 {"written", "number of files written"},
                 {"left_out", "number of paints that --keep-going left out"},
                 {"de00_mean", "mean of paints[].de00_mean"},
                 {"paints_per_s", "paints a second, without reading"},
                 {"warnings[]", "messages about paints and parts of paints that are left out"}};
  spec.see_also = {"fit-paint(1)", "paint-convert(1)", "render-osmesa(1)", "goniochrome-export(7)"};
  return spec;
}

}  // namespace goniochrome::tool
