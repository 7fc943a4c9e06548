#include "options.h"

#include <algorithm>

#include "base/text.h"
#include "paint/metrics.h"

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
  library::LibrarySearchOptions search{
      .count = static_cast<std::size_t>(o.count),
      .metric = o.metric == "de00" ? library::ColorMetric::kDe00 : library::ColorMetric::kDe76,
      .mix_conditions = o.mix_observers};
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

cli::ToolSpec tool_spec(Options& o) {
  cli::ToolSpec spec;
  spec.name = "colorsnap";
  spec.summary = "find the paints of a library nearest to a paint";
  spec.description = {
      "colorsnap reads paints, most often designs, and finds for each the nearest paints of a library, so that a "
      "formulation starts from the code of a paint that exists. The distance is the sum of the color differences at "
      "the geometries that are compared, each with its weight. The answer is exact in both metrics, and of equally "
      "near paints the one that stands first in the library comes first.",
      "A paint is compared by its measured rows, or where it has none by its curve at 15, 25, 45, 75 and 110 degrees. "
      "Without --geometry, a query is compared at the geometries that it shares with the most paints of the library, "
      "but at three at least as long as any paint has so many; library paints that lack one of them are left out with "
      "a warning. A query with no geometry in common is an error. Lab values of another illuminant or observer are "
      "refused unless --mix-observers is given, which compares the numbers as they are.",
      "The library is read once and indexed in FILE.snapindex beside it; later runs map that file and start in "
      "milliseconds. It is used only while size and time of modification of the library agree, or size and checksum; "
      "otherwise it is made anew, whole or not at all. Where the folder cannot be written the index stays in memory, "
      "with a word.",
      "The table has a line a match: query, rank, name, code and class of the paint, distance, the mean difference per "
      "unit of weight, what the query has more of in lightness (dL), chroma (dC) and hue (dH, CIELAB units, "
      "counterclockwise positive) as means over the geometries, the status of the query, and the difference at each "
      "geometry. With --format paints the matched paints themselves are written, each once, in the order they were "
      "first met, every element kept.",
      "Designs that cannot be made from the library are told by the status. outside: the nearest paint is farther than "
      "--threshold, so the design lies outside the library's gamut; dL, dC and dH say to which side, and the exit "
      "status is 1. off_radial: the flop leaves the face's hue line on another side, or farther, than that of the "
      "nearest paint does, so that its hue shift is not captured; a paint chemist has to be asked. no_match: the "
      "filters leave no paint; exit status 1."};
  spec.inputs = {.value = "PAINTS", .help = "paint XML files; standard input where none is given", .target = &o.inputs};
  spec.options = {
      {.name = "library",
       .letter = 'l',
       .value = "FILE",
       .help = "paint XML file to search, a plain file",
       .target = &o.library,
       .required = true},
      {.name = "count",
       .letter = 'k',
       .value = "N",
       .help = "matches for each paint",
       .target = &o.count,
       .low = 1,
       .high = 100000},
      {.name = "metric",
       .letter = 'm',
       .value = "METRIC",
       .help = "color difference: CIE 1976 (de76) or CIEDE2000 (de00)",
       .target = &o.metric,
       .choices = {"de76", "de00"}},
      {.name = "geometry",
       .letter = 'g',
       .value = "LIST",
       .help = "compare at these geometries, as in 45as15,45as45,45as110, and not at those that are shared",
       .target = &o.geometries},
      {.name = "weight",
       .letter = 'w',
       .value = "LIST",
       .help = "weights of geometries, as in 45as15=2,45as110=0.5; 1 for the others",
       .target = &o.weights},
      {.name = "filter",
       .value = "NAME=LOW:HIGH",
       .help = "consider only library paints with this metric (see paint-stats) in this range, either end left out for "
               "none; or class=solid,metallic,...; repeatable, all must hold",
       .target = &o.filters},
      {.name = "threshold",
       .value = "DE",
       .help = "mean difference per unit of weight beyond which a design is outside the library",
       .target = &o.threshold,
       .low = 0},
      {.name = "off-radial",
       .value = "DE",
       .help = "difference of the hue shifts of design and nearest paint that is told",
       .target = &o.off_radial,
       .low = 0},
      {.name = "method",
       .value = "METHOD",
       .help = "search by k-d tree, by scan, or by whichever is faster; the answer is the same",
       .target = &o.method,
       .choices = {"auto", "tree", "scan"}},
      {.name = "mix-observers",
       .help = "compare Lab values of different illuminants and observers as they are",
       .target = &o.mix_observers},
      {.name = "keep-going",
       .help = "leave out queries that cannot be read or compared, with a warning each; the exit status is then 1",
       .target = &o.keep_going},
      {.name = "output",
       .letter = 'o',
       .value = "FILE",
       .help = "where to write, - is standard output",
       .target = &o.output},
      {.name = "format",
       .letter = 'f',
       .value = "FORMAT",
       .help = "a table (tsv), JSON lines, one a query (json), the matched paints (paints), or by the output's ending: "
               ".xml is paints, .json or .jsonl is json, all else tsv (auto)",
       .target = &o.format,
       .choices = {"auto", "tsv", "json", "paints"}}};
  spec.examples = {
      {"paint-edit testdata/paints.paints.xml#candy_blue --hue-shift 4 | colorsnap --library "
       "testdata/paints.paints.xml -k 3",
       "Names the three paints nearest to a changed blue."},
      {"colorsnap -l testdata/paints.paints.xml --metric de00 --filter flop_index=3:10 --filter class=metallic "
       "testdata/paints.paints.xml -o near.tsv",
       "Looks among metallics of moderate flop, by CIEDE2000."},
      {"colorsnap -l testdata/paints.paints.xml -k 1 -w 45as110=2 testdata/paints.paints.xml -o start.paints.xml",
       "Writes the nearest paint of each, the flop counting twice, to start formulations from."}};
  spec.report = {{"queries[].name", "name of the query"},
                 {"queries[].status", "ok, or outside, off_radial, no_match"},
                 {"queries[].geometries[]", "where it was compared"},
                 {"queries[].hue_shift, matched_hue_shift", "signed distance of the flop from the face's hue line"},
                 {"queries[].matches[]", "name, code, class, distance, mean_de, dL, dC, dH, de_by_geometry{}"},
                 {"library_size", "paints in the library"},
                 {"candidates", "those that pass the filters and have a color"},
                 {"index", "mapped, built, or in_memory where it could not be written"},
                 {"index_s", "time to map the index, or to build and write it"},
                 {"read_s", "time to read the library, 0 where the index was mapped"},
                 {"index_bytes", "size of the index"},
                 {"method", "tree, scan, or both where parts of the library differ"},
                 {"query_us", "mean time of a search on one core"},
                 {"queries_per_s", "searches a second on all threads, without reading and writing"},
                 {"searched", "queries answered"},
                 {"outside, off_radial, no_match", "how many of them"},
                 {"left_out", "queries left out by --keep-going"},
                 {"warnings[]", "what was told"}};
  spec.see_also = {"paint-stats(1)", "paint-edit(1)", "paint-convert(1)"};
  cli::add_common_options(spec, o.common, {cli::Common::kExplain});
  return spec;
}

}  // namespace goniochrome::tool
