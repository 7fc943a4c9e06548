#include "tool.h"

#include <algorithm>

#include "base/text.h"
#include "color/spectrum.h"
#include "formulas.h"
#include "paint/metrics.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

Result<paint::Geometry> geometry_of(const char* option, std::string_view text) {
  auto geometry = paint::parse_geometry(trimmed(text));
  if (!geometry.ok()) return usage_error("{}: {}", option, geometry.error().message);
  return geometry;
}

Result<std::vector<paint::PaintClass>> classes_of(std::string_view text) {
  std::vector<paint::PaintClass> classes;
  for (const std::string_view word : split(text, ',')) {
    const auto found = paint::paint_class_of(trimmed(word));
    if (!found)
      return usage_error(
          "filter \"class={}\": there is no class \"{}\": use solid, metallic, pearl, interference or "
          "unknown",
          text, word);
    classes.push_back(*found);
  }
  return classes;
}

Result<paint::MetricRange> range_of(std::string_view text) {
  GONIO_ASSIGN(paint::MetricRange range, paint::parse_metric_range(text));
  const auto kept = paint::metric_columns_without_fit();
  if (std::ranges::find(kept, std::string_view(range.column->name), &paint::MetricColumn::name) == kept.end())
    return usage_error(
        "filter \"{}\": {} takes a curve fit and is not in the index: pick the library's paints by it with "
        "paint-stats --where first",
        text, range.column->name);
  return range;
}

}  // namespace

Result<library::LibrarySearchOptions> search_options(const Options& o) {
  library::LibrarySearchOptions search{.count = static_cast<std::size_t>(o.count), .mix_conditions = o.mix_observers};
  GONIO_ASSIGN(search.metric, formula_of(o.formula));
  if (o.method != "auto")
    search.method = o.method == "tree" ? library::SearchMethod::kTree : library::SearchMethod::kScan;
  for (const std::string& list : o.geometries)
    for (const std::string_view text : split(list, ',')) {
      GONIO_ASSIGN(const paint::Geometry geometry, geometry_of("--geometry", text));
      if (std::ranges::find(search.geometries, geometry) == search.geometries.end())
        search.geometries.push_back(geometry);
    }
  for (const std::string& list : o.weights)
    for (const std::string_view text : split(list, ',')) {
      const auto equals = text.find('=');
      const auto weight = equals == std::string_view::npos ? std::nullopt : parse_number(text.substr(equals + 1));
      if (!weight || *weight < 0 || *weight > 1e6)
        return usage_error("--weight is \"{}\": write GEOMETRY=NUMBER with a number from 0 to 1e6, as in 45as15=2",
                           text);
      GONIO_ASSIGN(const paint::Geometry geometry, geometry_of("--weight", text.substr(0, equals)));
      search.weights.emplace_back(geometry, *weight);
    }
  for (const std::string& text : o.filters) {
    if (text.starts_with("class=")) {
      GONIO_ASSIGN(search.classes, classes_of(std::string_view(text).substr(6)));
      continue;
    }
    GONIO_ASSIGN(const paint::MetricRange range, range_of(text));
    search.ranges.push_back(range);
  }
  return search;
}

namespace {

void add_options(cli::ToolSpec& spec, Options& o) {
  spec.heading = "library";
  spec.option("library,l", "FILE", "testdata/paints.paints.xml", &o.library,
              "paints to search, in any format that paint-convert(1) reads")
      .needed()
      .more(
          "FILE#NAMES searches some of its paints. For these, and for a library that comes through a pipe (- is "
          "standard "
          "input), an index is made in memory.");
  spec.option("filter", "NAME=LOW:HIGH", "flop_index=3:10", &o.filters, "consider only library paints in this range")
      .more(
          "NAME is a metric of paint-stats(1). Either end of the range may be left out. class=solid,metallic picks "
          "paints by their class. Where several filters are given, a paint has to pass all of them.");
  spec.heading = "comparison";
  spec.option("count,k", "N", "3", &o.count, "number of matches for each paint").from(1, 100000);
  spec.option("formula,metric,m", "FORMULA", "ciede2000", &o.formula, "formula of the color difference")
      .more("It is one of " + color::formula_words() +
            ". See goniochrome-color(7), \"COLOR DIFFERENCES\". The query is the standard of those that are not "
            "symmetric.");
  spec.option("geometry,g", "LIST", "45as15,45as45,45as110", &o.geometries, "geometries at which paints are compared")
      .more("Where the option is given, the geometries that query and library share are not looked for.");
  spec.option("weight,w", "LIST", "45as15=2,45as110=0.5", &o.weights, "weights of geometries; 1 for the others");
  spec.option("illuminant", "NAME,...", "D65,A,F11", &o.illuminants, "compare paints in all of these lights")
      .more(
          "The names are " + color::spectral_illuminants() +
          ". The distance of two paints is then the largest in any of the lights, and a last column of the table names "
          "that light. The colors come from spectra; library paints without them are left out with a warning. The "
          "index is made in memory. Metrics of --filter are those in the first of the lights.");
  spec.flag("mix-observers", &o.mix_observers, "compare Lab values of different illuminants and observers as they are")
      .more("Without this option, such values are refused.");
  spec.option("method", "METHOD", "scan", &o.method, "search by k-d tree, by scan, or by whichever is faster")
      .one_of({"auto", "tree", "scan"})
      .more("The answer is the same.");
  spec.heading = "verdict";
  spec.option("threshold", "DE", "5", &o.threshold, "mean difference beyond which a design is outside the library")
      .from(0)
      .in("units of the formula per unit of weight");
  spec.option("off-radial", "DE", "3", &o.off_radial, "difference of hue shifts beyond which a design is off-radial")
      .from(0)
      .in("CIELAB units");
  spec.option("hue-travel", "DEG", "15", &o.hue_travel, "difference of hue travels beyond which a design turns")
      .from(0)
      .in("degrees");
  spec.heading = "input and output";
  add_table_options(spec, o.output, o.format,
                    "the matched paints themselves, each once, in the order in which they were first met, with every "
                    "element kept",
                    "query");
  spec.option("cloud", "FILE", "cloud.svg", &o.cloud, "SVG of the library in CIELAB with the queries in it")
      .more(
          "It shows the library from above (a* and b*) and from the side (a* and L*), at 45as45 or the middle one of "
          "the geometries. A line joins each query to its nearest paint. At most 20000 paints and 500 queries are "
          "drawn.");
  spec.flag("assign", &o.assign, "pass the queries on as paint XML, each with the code of its nearest paint")
      .more(
          "The code is where a formulation starts. A nearest paint without a code gives its name. A query without a "
          "match keeps its own code. paint-convert(1) --columns all hands the code over with the readings.");
  add_keep_going(spec, "keep-going", o.keep_going, "queries that cannot be read or compared");
  cli::add_common_options(spec, o.common, {.explain = true});
}

// The examples, the keys of --report, and the pages to see.
void add_report(cli::ToolSpec& spec) {
  spec.examples = {
      {"paint-edit testdata/paints.paints.xml#candy_blue --hue-shift 4 | colorsnap --library "
       "testdata/paints.paints.xml -k 3",
       "name the three paints that are nearest to a changed blue"},
      {"paint-edit testdata/paints.paints.xml --hue-shift 10 | colorsnap -l testdata/paints.paints.xml -k 1 --cloud "
       "cloud.svg -o near.tsv",
       "see where changed paints lie in a library"},
      {"colorsnap -l testdata/paints.paints.xml --metric de00 --filter flop_index=3:10 --filter class=metallic "
       "testdata/paints.paints.xml -o near.tsv",
       "look among metallics of moderate flop, by CIEDE2000"},
      {"colorsnap -l testdata/paints.paints.xml -k 1 -w 45as110=2 testdata/paints.paints.xml -o start.paints.xml",
       "write the paint nearest to each, with the flop counting twice, to start formulations from"},
      {"paint-edit testdata/paints.paints.xml#candy_blue --hue-shift 4 | colorsnap -l testdata/paints.paints.xml "
       "--assign | paint-convert --to csv --columns all -o handoff.csv",
       "hand a design over with the code of the paint nearest to it"}};
  spec.report = {
      {"queries[].name", "name of the query"},
      {"queries[].status", "ok, no_match, or those of outside, off_radial and hue_travel that hold, joined by commas"},
      {"queries[].geometries[]", "geometries at which it was compared"},
      {"queries[].hue_shift, matched_hue_shift",
       "signed distance of the flop from the face's hue line, for the query and for the nearest paint"},
      {"queries[].hue_travel_deg, matched_hue_travel_deg",
       "angle by which the hue turns from face to flop, for the query and for the nearest paint"},
      {"queries[].matches[]",
       "name, code, class, distance, mean_de, dL, dC, dH, de_by_geometry{}; with --illuminant also illuminant"},
      {"library_size", "number of paints in the library"},
      {"candidates", "number of paints that pass the filters and have a color"},
      {"index", "one of mapped, built, and in_memory where it could not be written"},
      {"index_s", "time to map the index, or to build and write it"},
      {"read_s", "time to read the library; 0 where the index was mapped"},
      {"index_bytes", "size of the index"},
      {"method", "one of tree, scan, and both where parts of the library differ"},
      {"query_us", "mean time of a search on one core"},
      {"queries_per_s", "searches a second on all threads, without reading and writing"},
      {"searched", "number of queries that were answered"},
      {"outside, off_radial, hue_travel, no_match", "number of queries with this status"},
      {"left_out", "number of queries that --keep-going left out"},
      {"warnings[]", "the warnings of the run"}};
  spec.see_also = {"paint-stats(1)", "paint-edit(1)", "paint-convert(1)", "goniochrome-search(7)"};
}

}  // namespace

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec{.name = "colorsnap", .summary = "find the paints of a library nearest to a paint"};
  spec.description = {
      "colorsnap finds the nearest paints of a library for each paint that it reads, so that a formulation can start "
      "from the code of a paint that exists. The distance of two paints is the sum of their color differences at the "
      "geometries that are compared, each with its weight. The answer is exact with every formula. Equally near paints "
      "keep the order of the library.",
      "# Geometries\nA paint is compared by its measured rows, or else by its curve at 15, 25, 45, 75 and 110 degrees. "
      "Without --geometry, a query is compared at the geometries that it shares with the most paints of the library, "
      "at least three if any paint has so many. Library paints that lack one of them are left out with a warning.",
      "# The index\nThe library is read once and indexed in FILE.snapindex beside it. Later runs map that file and "
      "start in milliseconds. A changed library, or another version of the program, makes it anew. Where the folder "
      "cannot be written, the index stays in memory.",
      "# The table\nEach match has a line: query, rank, name, code and class of the paint; distance, and the mean "
      "difference per unit of weight; query minus match in lightness (dL), chroma (dC) and hue (dH, counterclockwise "
      "positive), as means over the geometries; the status of the query; and the difference at each geometry.",
      "# The status\nIt names designs that cannot be made from the library:\n- outside: the nearest paint is farther "
      "than --threshold; dL, dC and dH give the side, and the exit status is 1.\n- off_radial: the flop leaves the "
      "face's hue line otherwise than that of the nearest paint; ask a paint chemist.\n- hue_travel: the hue turns "
      "from face to flop by another angle, by more than --hue-travel.\n- no_match: the filters leave no paint, and the "
      "exit status is 1.\nSeveral are joined by commas."};
  spec.inputs = {"PAINTS",
                 "paint XML, CSV, CxF and other files of paints, or FILE#NAMES; standard input where none is given",
                 &o.inputs};
  add_options(spec, o);
  add_report(spec);
  return spec;
}

}  // namespace goniochrome::tool
