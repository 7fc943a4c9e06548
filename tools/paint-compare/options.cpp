#include "color/color_difference.h"
#include "color/spectrum.h"
#include "table_output.h"
#include "tool.h"

namespace goniochrome::tool {

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "standard";
  spec.option("standard,s", "FILE", "testdata/paints.paints.xml#candy_red", &o.standard,
              "paints that are the standards")
      .needed()
      .more("FILE#NAME picks one of a file. The standards are held in memory, the samples are not.");
  spec.option("pair", "HOW", "nearest", &o.pair, "how a sample finds its standard")
      .one_of({"auto", "name", "code", "nearest"})
      .more(
          "auto takes the only standard that there is, and else the one of the same name. nearest takes the standard "
          "that differs least by CIEDE2000, summed over the geometries. A sample without a standard is an error.");
  add_keep_going(spec, "keep-going,k", o.keep_going, "samples that cannot be read or compared");
  spec.heading = "comparison";
  spec.option("formula", "FORMULA,...", "cmc:2:1,din6175", &o.formulas, "formulas of the color difference dE")
      .more("They are " + color::formula_words() +
            ", and without the option those that limits name, or ciede2000. The first is the one of charts and of "
            "limits of dE. DIN 6175-2:2001 "
            "follows a public program of a color system and was not compared with the text of the standard.");
  spec.option("illuminant", "NAME,...", "A,F11", &o.illuminants, "tell the metamerism under these illuminants")
      .more("The names are " + color::spectral_illuminants() +
            ". Metamerism is the special index of CIE 15 at each geometry, by the first formula. It needs the spectra "
            "of both.");
  spec.heading = "limits";
  spec.option("limits,l", "FILE", "limits.csv", &o.limits, "table of limits by which samples pass or fail")
      .more("Without it, the limits count that a standard carries. \"LIMITS\" describes the table.");
  spec.option("make-limits", "FILE", "limits.csv", &o.make_limits, "make limits of the samples, which were accepted")
      .more(
          "They are the mean of each quantity at each geometry +- --spread standard deviations; dE has an upper limit "
          "alone. FILE is a table, or, where it ends in .xml, the standards with these limits in them. It takes three "
          "samples or more.");
  spec.option("spread", "K", "2.5", &o.spread, "standard deviations between mean and limit").from(0, 100);
  spec.option("share", "SHARE", "0.95", &o.share, "choose the least spread that this share of the samples keeps")
      .from(0, 1)
      .in("parts of all samples")
      .more("A sample keeps the limits where all of its quantities do. 0 leaves the choice to --spread.");
  spec.option("show-limit", "FILE", "limit.paints.xml", &o.show_limit, "write paints that just keep the limits")
      .more(
          "Each standard is followed by eight paints, which lie on its limits at every geometry: a lighter and a "
          "darker one, and six in directions of hue 60 degrees apart. render-osmesa(1) --sheet 3x3 and paint-book(1) "
          "--variations show them around the standard, and so does the page of --chart.");
  spec.heading = "output";
  add_table_options(spec, o.output, o.format, "the samples, each with its verdict in an element of its own", "sample");
  spec.option("chart", "PATH", "page.html", &o.chart, "page of charts to write, .html, or a folder of pages")
      .more(
          "A page shows up to 200 samples, those that fail first; a folder has a page for each. See Charts.");
  spec.option("mesh,m", "FILE", "testdata/speed-shape.obj", &o.mesh, "mesh of the pictures of --chart")
      .more("Without it they show a ball.");
  spec.option("env,e", "FILE", "studio.env.exr", &o.env, "prefiltered environment of the pictures of --chart")
      .more("Without it they show the light of two lamps.");
  cli::add_common_options(spec, o.common);
}

void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"paint-compare --standard testdata/paints.paints.xml#candy_red testdata/paints.paints.xml#candy_red",
       "compare a paint with itself: every difference is 0"},
      {"printf 'geometry,quantity,low,high\\n*,dL,-1.5,1.5\\nmax,dE_cmc:2:1,,1.7\\n' > limits.csv && paint-edit "
       "testdata/paints.paints.xml#candy_red --lightness-shift 1 | paint-compare -s "
       "testdata/paints.paints.xml#candy_red -l limits.csv --chart page.html",
       "judge a batch by a table of limits, and draw its page"},
      {"paint-edit testdata/paints.paints.xml --lightness-shift 0.5 | paint-compare -s "
       "testdata/paints.paints.xml --formula ciede2000,cmc:2:1,din6175 --format json -o verdicts.jsonl",
       "compare a whole library by name with three formulas"},
      {"paint-edit testdata/paints.paints.xml#candy_red --variations face --step 0.5 | paint-compare -q -s "
       "testdata/paints.paints.xml#candy_red --make-limits limits.csv --share 0.9 -o accepted.tsv",
       "make the limits that nine tenths of the accepted panels keep"},
      {"printf 'geometry,quantity,low,high\\n*,dE,,2\\n' > limits.csv && paint-compare -q -s "
       "testdata/paints.paints.xml#candy_red -l limits.csv --show-limit limit.paints.xml "
       "testdata/paints.paints.xml#candy_red",
       "write the paints that just pass, to be drawn beside the standard"}};
  spec.report = {{"judgements[].sample, standard", "names of the pair"},
                 {"judgements[].verdict", "one of pass, fail, incomplete, and - where there are no limits"},
                 {"judgements[].verdicts.NAME", "the same at each place: a geometry, mean, max or paint"},
                 {"judgements[].failures[]",
                  "at, quantity, value, limit and words; the value of what was not measured is null"},
                 {"judgements[].geometries.NAME", "dL, da, db, dC, dH and dE by each formula: sample minus standard"},
                 {"judgements[].mean, max", "the same over the geometries"},
                 {"judgements[].others.NAME", "indices and gloss of the paint; textures and metamerism by geometry"},
                 {"standards", "number of standards"},
                 {"compared, passed, failed, incomplete, not_judged",
                  "numbers of samples: compared, and of each verdict"},
                 {"left_out", "number of samples that --keep-going left out"},
                 {"pairs_per_s", "pairs a second on all threads, without reading and writing"},
                 {"warnings[]", "the warnings of the run"}};
  spec.see_also = {"colorsnap(1)", "paint-convert(1)", "paint-stats(1)", "goniochrome-quality(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "paint-compare", .summary = "judge batches of paint against their standards"};
  spec.description = {
      "paint-compare compares samples with standards at every geometry that both have, and tells whether they keep "
      "limits. Every difference is sample minus standard. CIE94 and CMC take the standard first, which makes a "
      "difference: they are not symmetric. Samples pass in constant memory.",
      "The table has one line for each geometry of a sample, with dL, da, db, dC and dH in CIELAB units and dE by each "
      "formula; a line mean and a line max with the values of the largest size; and a line paint for the whole, whose "
      "verdict is that of all limits. The column other has quantity=value pairs: on the line paint the differences of "
      "flop index, chroma index, hue-shift index, hue travel and gloss; on the others those of textures, and "
      "metamerism. Textures are compared where instrument, quantity, version and geometry agree.",
      "Where standard and sample are stated for different illuminants or observers, the one that has spectra is "
      "brought to the light of the other, and a warning tells so; without spectra the pair is refused.",
      "# Verdicts\nThe verdict of a line is by the limits of that line, and the verdict of the line paint by all of "
      "the sample:\n- pass: every quantity that has a limit keeps it.\n- fail: one of them passes its limit.\n- "
      "incomplete: none of them passes its limit, and one was not measured, as where the sample lacks an angle of its "
      "standard. The largest and the mean dE and the indices are incomplete then, too.\n- a hyphen: no limit "
      "applies, and nothing was "
      "judged.",
      "The exit status is 1 where a sample fails or is incomplete. Each reason is a sentence, as in "
      "\"45as15: dL -2.1, limit -1.5: too dark near gloss\" or \"45as110: dL has a limit and was not measured\"; the "
      "line of a sample has the first four, and JSON, paint XML and the report have all. --quiet keeps these lines.",
      "# LIMITS\nThe table has the columns geometry, quantity, low and high, separated by commas, or by semicolons or "
      "tabs, "
      "where numbers may have a decimal comma. The geometry is a name, * for every "
      "geometry of the standard or for the paint, or mean or max for dE over the geometries. The quantity is dL, da, "
      "db, dC, dH, "
      "dE (by the first formula), dE_FORMULA, flop_index, chroma_index, hue_shift_index, hue_travel_deg, gloss20, "
      "gloss60, gloss85, metamerism_ILLUMINANT, or texture:NAME with the instrument's name of it. One of low and high "
      "may be empty. Formulas and illuminants that the limits name need no option. Numbers within 1e-9 of a limit "
      "keep it.",
      "# Charts\nThe page of --chart needs no other file and prints on A4. It has control charts of dL at each "
      "geometry from three samples on, against the date where every sample has one and else in the order of the "
      "samples, with points beyond three sigma in red. Each sample has its verdict, a picture that is split between "
      "standard and sample, the table, the a*b* plane with the tolerance of the first formula at each geometry, and dE "
      "by angle. Charts hold all samples in memory."};
  spec.inputs = {
      "PAINTS",
      "samples: paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
      &o.inputs};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
