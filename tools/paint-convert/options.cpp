#include "options.h"

#include "formats.h"

namespace goniochrome::tool {

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "paint-convert";
  spec.summary = "convert paints between paint XML, tables, CxF and CGATS, and read measured BRDFs";
  spec.description = {
      "paint-convert reads paints from any number of inputs and writes them to one output, each as soon as it is read, "
      "so that a library of any size passes in constant memory. The format of an input is found from its first bytes, "
      "that of the output from its name; --from and --to overrule both. Standard output is paint XML unless --to says "
      "otherwise.",
      "Tables are read as spreadsheets write them: long (one row for each sample and geometry) or wide (columns L15, "
      "a15, b15 and so on), separated by commas, semicolons or tabs, with decimal commas where those cannot be "
      "separators, with headings like L*, and with a byte order mark. The rows of one sample stand together. Columns "
      "class, code, instrument, gloss20, gloss60 and gloss85 are read where they are there.",
      "CxF3 and CGATS.17 are read from the programs of others, as far as their colors stand at an angle; what does not "
      "is named in a warning. Where a sample has readings under several illuminants or observers, the first counts, or "
      "the one of --illuminant and --observer. Spectra in CxF are integrated under what their specification states. "
      "CxF is written with one color specification for each angle; --cxf-compat writes one object for each angle, for "
      "programs that take only the first Lab of an object. Both come back as one paint.",
      "A measured BRDF (MERL .binary, Cornell .brdf, NVIDIA .mbsdf, RGL _rgb.bsdf) becomes one paint: what a "
      "multi-angle instrument would have read at the geometries of --geometry, by default 15, 25, 45, 75 and 110 "
      "degrees. Its spectra are integrated under --illuminant and --observer, by default D65 and 10 degrees; RGB data "
      "are what the 2 degree observer sees under D65, and stay that. The data are checked on the way: the report tells "
      "the share of negative samples, how far light and viewer can be swapped, whether the values are f or f cos, the "
      "noise floor, and which readings were interpolated and how far.",
      "A measured paint keeps the rows it has; --geometry selects among them and never interpolates. A designed paint, "
      "which has a face, a flop and a travel but no rows, gets rows when readings are written: at 15, 45 and 110 "
      "degrees and at 25, 45 and 75 degrees, the two sets of the industry, or at those of --geometry. What the output "
      "cannot hold is named in a warning.",
      "A wrong value stops the conversion, and an output file stays as it was. With --keep-going the row (of a long "
      "table) or the paint is left out with a warning, and the exit status is 1."};
  spec.inputs = {.value = "INPUT",
                 .help = "paint XML, tables, CxF, CGATS or measured BRDFs; - or none is standard input",
                 .target = &o.inputs};
  spec.options = {
      {.name = "output",
       .letter = 'o',
       .value = "FILE",
       .help = "where to write; - is standard output",
       .target = &o.output},
      {.name = "from",
       .value = "FORMAT",
       .help = "format of every input",
       .target = &o.from,
       .choices = input_format_names()},
      {.name = "to",
       .value = "FORMAT",
       .help = "format of the output: paint XML, long or wide table, CxF3, CGATS text",
       .target = &o.to,
       .choices = output_format_names()},
      {.name = "geometry",
       .value = "LIST",
       .help = "geometries to write, such as 15,45,110 or 45as-15,45as25az90; repeatable",
       .target = &o.geometry},
      {.name = "illuminant",
       .value = "NAME",
       .help = "illuminant of the readings to take from CxF and CGATS, or under which to see measured spectra (D65, "
               "D50, A)",
       .target = &o.illuminant},
      {.name = "observer",
       .value = "DEG",
       .help = "observer of the readings to take from CxF and CGATS, or that sees measured spectra",
       .target = &o.observer,
       .choices = {"auto", "2", "10"}},
      {.name = "aperture",
       .value = "DEG",
       .help = "full angle of the detector over which a measured BRDF is averaged; 0 is one direction",
       .target = &o.aperture_deg,
       .low = 0,
       .high = 20},
      {.name = "cxf-compat",
       .help = "write CxF with one object for each angle, for programs that take only the first Lab",
       .target = &o.cxf_compat},
      {.name = "columns",
       .value = "WHICH",
       .help = "columns of a table: core (names, conditions and Lab), or all, which adds class, code, instrument and "
               "gloss",
       .target = &o.columns,
       .choices = {"core", "all"}},
      {.name = "fit-appearance",
       .help = "fit face, flop and travel to the rows of each measured paint, with the residual",
       .target = &o.fit_appearance},
      {.name = "keep-going",
       .letter = 'k',
       .help = "leave out what is wrong, write the rest, exit with 1",
       .target = &o.keep_going},
  };
  spec.examples = {
      {"paint-convert testdata/paints.csv -o paints.paints.xml", "Turn a table into paint XML."},
      {"paint-convert testdata/paints.paints.xml --to wide --columns all -o table.csv",
       "Turn paint XML into a wide table that keeps gloss and class."},
      {"paint-convert --geometry 25,45,75 --to csv testdata/paints.paints.xml | head",
       "Show the readings of one set of angles."},
      {"paint-convert testdata/paints.paints.xml -o paints.cxf", "Hand a library over as CxF3."},
      {"paint-convert testdata/paints.csv --fit-appearance | paint-edit --travel-shift 10 -o softer.paints.xml",
       "Fit face, flop and travel, and go on in another tool."},
  };
  spec.report = {
      {"read", "paints read whole"},
      {"written", "paints written"},
      {"skipped", "rows or paints left out under --keep-going"},
      {"measured[].name", "name of the paint a measured BRDF became"},
      {"measured[].format", "merl, cornell, mbsdf or rgl; description holds the file's own words"},
      {"measured[].illuminant", "what the Lab values are relative to; also observer"},
      {"measured[].samples", "numbers in the file; negative_share and zero_share of them"},
      {"measured[].reciprocity_error", "median difference with light and viewer swapped, over the mean"},
      {"measured[].reciprocity_if_f_cos", "the same had the file held f cos(theta_o)"},
      {"measured[].values", "what reciprocity speaks for: f or f_cos; symmetric where the format cannot tell"},
      {"measured[].noise_floor", "reflectance factor below which a reading is noise"},
      {"measured[].albedo_45", "reflectance for light at 45 deg, without gloss"},
      {"measured[].held_share", "share of X, Y or Z from beyond the ends of the spectrum"},
      {"measured[].geometries[]",
       "geometry, gap_deg (widest step that was interpolated), outside_deg (distance to the "
       "nearest sample, beyond them), negative, below_noise"},
      {"warnings[]", "what was left out, assumed or lost, one line each"},
  };
  spec.see_also = {"fit-paint(1)", "paint-edit(1)", "goniochrome-paint(5)"};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome::tool
