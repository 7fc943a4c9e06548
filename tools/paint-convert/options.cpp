#include "tool.h"

#include "brdf/measured.h"
#include "color/spectrum.h"
#include "formats.h"

namespace goniochrome::tool {

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "input";
  spec.option("from", "FORMAT", "csv", &o.from, "format of every input").one_of(input_format_names());
  spec.option("illuminant", "NAME", "A", &o.illuminant, "illuminant of the readings, such as D65, D50 or A")
      .more(
          "It picks readings of CxF and CGATS, and spectra are integrated under it: " + color::spectral_illuminants() +
          ". auto takes the first readings, and D65 for spectra.");
  spec.option("observer", "DEG", "2", &o.observer, "observer of the readings")
      .one_of({"auto", "2", "10"})
      .more("It does the same as --illuminant. auto takes the first readings, and 10 degrees for spectra.");
  spec.option("scale", "SCALE", "percent", &o.scale, "what reflectances are written in")
      .one_of({"auto", "percent", "factor"})
      .more(
          "It holds for spectra and XYZ of files that do not state it. auto judges all spectra of a file together, and "
          "refuses a file that may be either; see goniochrome-paint(5), \"REFLECTANCES\".");
  spec.option("viewing", "WORDS=GEOMETRY", "SCE=45as45", &o.viewings, "geometry of readings whose file names none")
      .more(
          "Readings of a sphere, or of an unknown geometry, are left out. This option takes those whose viewing has "
          "the words; --viewing 45as45 takes all.");
  spec.option("aperture", "DEG", "2", &o.aperture_deg, "angle over which a measured BRDF is averaged")
      .from(0, 20)
      .more("It is the full angle of a detector; 0 is a single direction.");
  spec.flag("keep-going,k", &o.keep_going, "leave out what is wrong, and write the rest")
      .more(
          "Of a long table a row is left out, of other formats a paint. Each is named in a warning, and the exit "
          "status is 1.");
  spec.heading = "readings";
  spec.option("geometry", "LIST", "15,45,110", &o.geometry, "geometries to write, such as 15 or 45as25az90")
      .more("Several are separated by commas. Tables, CxF and CGATS get rows that are missing from the curve.");
  spec.flag("fit-appearance", &o.fit_appearance, "fit face, flop and travel to the rows of each measured paint")
      .more("The residual of the fit is written with them.");
  spec.option("average", "KEY", "name", &o.average, "write one paint for all readings of the same name, code or day")
      .one_of({"none", "name", "code", "date"})
      .more(
          "Numbers and dates in parentheses after a name do not count. date makes one paint for each name and day. "
          "Spectra are averaged where all readings have them, and else Lab. All paints are held in memory.");
  spec.option("outliers", "WHAT", "drop", &o.outliers, "what --average does with readings that stand apart")
      .one_of({"keep", "drop"})
      .more(
          "Each is named in a warning. See goniochrome-quality(7), \"REPEATED READINGS\". Fewer than four readings "
          "have no outliers.");
  spec.heading = "output";
  spec.option("output,o", "FILE", "paints.cxf", &o.output, "where to write; - is standard output");
  spec.option("to", "FORMAT", "wide", &o.to, "format of the output")
      .one_of(output_format_names())
      .more("xml is paint XML, csv a long table, wide a wide table, cxf CxF3, and cgats CGATS text.");
  spec.option("columns", "WHICH", "all", &o.columns, "columns of a table")
      .one_of({"core", "all"})
      .more(
          "core has names, conditions and Lab. all adds class, code, instrument, gloss, serial and date, and to a long "
          "table the spectra.");
  spec.flag("cxf-compat", &o.cxf_compat, "write CxF with one object for each angle")
      .more("Some programs take only the first Lab of an object. Such a file, too, is read back as one paint.");
  cli::add_common_options(spec, o.common, {.explain = true});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"paint-convert testdata/paints.csv -o paints.paints.xml", "turn a table into paint XML"},
      {"paint-convert testdata/paints.paints.xml --to wide --columns all -o table.csv",
       "turn paint XML into a wide table that keeps gloss and class"},
      {"paint-convert --geometry 25,45,75 --to csv testdata/paints.paints.xml | head",
       "show the readings of one set of angles"},
      {"paint-convert --average name --outliers drop testdata/paints.csv -o means.paints.xml",
       "make one paint of repeated readings"},
      {"paint-convert testdata/paints.paints.xml -o paints.cxf", "hand a library over as CxF3"},
      {"paint-convert testdata/paints.csv --fit-appearance | paint-edit --travel-shift 10 -o softer.paints.xml",
       "fit face, flop and travel, and go on in another tool"}};
  spec.report = {
      {"read", "number of paints read whole"},
      {"written", "number of paints written"},
      {"skipped", "number of rows or paints that --keep-going left out"},
      {"averages[].name, readings, kept",
       "with --average: name of each paint, how many readings it had and how many count"},
      {"averages[].date, serial", "span of the dates of the readings, and serials of their instruments"},
      {"averages[].geometries.NAME",
       "readings, standard deviations L, a and b, and mean_distance from the mean, CIE 1976"},
      {"averages[].outliers[]", "name, distance and median_distance of the readings that stand apart"},
      {"measured[].name", "name of the paint that a measured BRDF became"},
      {"measured[].format",
       "one of merl, cornell, mbsdf, rgl and openmaterial; description holds the file's own words"},
      {"measured[].illuminant", "illuminant that the Lab values are relative to; observer stands beside it"},
      {"measured[].samples", "how many numbers the file has; negative_share and zero_share are parts of them"},
      {"measured[].reciprocity_error", "median difference with light and viewer swapped, relative to the mean"},
      {"measured[].reciprocity_if_f_cos", "the same if the file held f cos(theta_o)"},
      {"measured[].values", "what reciprocity speaks for: f or f_cos; symmetric where the format cannot tell"},
      {"measured[].noise_floor", "reflectance factor below which a reading is noise"},
      {"measured[].albedo_45", "reflectance for light at 45 degrees, without gloss"},
      {"measured[].held_share", "share of X, Y or Z that comes from beyond the ends of the spectrum"},
      {"measured[].geometries[]",
       "geometry; gap_deg, the widest interpolated step; outside_deg, the distance to the nearest sample beyond the "
       "data; negative; below_noise"},
      {"warnings[]", "what was left out, assumed or lost, one line each"}};
  spec.see_also = {"fit-paint(1)", "paint-edit(1)", "goniochrome-paint(5)", "goniochrome-fitting(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{
      .name = "paint-convert",
      .summary =
          "convert paints between paint XML, tables, CxF and CGATS, and read files of instruments and measured BRDFs"};
  spec.description = {
      "paint-convert reads paints from any number of inputs, in any of the formats below, and writes them to one "
      "output, each as soon as it is read. The format of an input is found from its first bytes, and that of the "
      "output from its name; --from and --to overrule both. Standard output is paint XML unless --to says otherwise. A "
      "wrong value stops the conversion, and the output file stays as it was.",
      "# Tables\nThey are long (one row for each sample and geometry) or wide (columns L15, a15, b15 and so on), "
      "separated by commas, semicolons or tabs, with decimal points or commas, and headings like L*. The rows of one "
      "sample stand together. The columns class, code, instrument, gloss20, gloss60, gloss85, serial and date are read "
      "too.",
      "# CxF3 and CGATS.17\nColors that stand at an angle are read; a warning names the others. Where a sample has "
      "several illuminants or observers, the first counts, or the one of --illuminant and --observer. CxF is written "
      "with one color specification for each angle, and with the spectra that its schema allows.",
      "# Files of instruments\nQTX, MIF, XTF, MTF and JCAMP-DX are read with their spectra. Readings without a "
      "geometry are left out unless --viewing states one. See goniochrome-paint(5), \"FILES OF INSTRUMENTS\".",
      "# Workbooks\nAll sheets of a workbook (XLSX) are read. A table is found by its headings: L*, a* and b*, or "
      "wavelengths, with a column of geometries and one of names. The condition stands in the headings, as in L* "
      "(D65/10), or above the table. Where Lab and spectrum of a geometry disagree, the Lab is taken with a warning.",
      "# Measured BRDFs\nA measured BRDF (" + brdf::measured_formats() +
          ") becomes one paint with the readings of a multi-angle instrument at the geometries of --geometry, by "
          "default 15, 25, 45, 75 and 110 degrees. Spectra are integrated under --illuminant and --observer. RGB data "
          "stay the colors of the 2 degree observer under D65. The report has the quality of the data.",
      "# Measured and designed paints\nA paint that was only measured keeps its rows. A designed paint has a face, a "
      "flop and a travel; it is written at 15, 45 and 110 degrees and at 25, 45 and 75 degrees, by its rows, and by "
      "its curve where a row is missing. --geometry does the same for any list. The last column of a table, origin, "
      "is row or curve. A warning names what the output cannot hold.",
      "# Other light\nPaint XML keeps spectra. With --illuminant or --observer, a paint with spectra gets its readings "
      "in that light, and its face and flop are fitted again; lobes and color map are left out. A paint without "
      "spectra stays as it is, with a warning."};
  spec.inputs = {"INPUT",
                 "paint XML, tables, CxF, CGATS, files of instruments or measured BRDFs, or FILE#NAMES for some paints "
                 "of one; - or "
                 "none is standard input",
                 &o.inputs};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
