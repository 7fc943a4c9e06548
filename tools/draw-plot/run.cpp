#include "tool.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/csv_records.h"
#include "base/text.h"
#include "output_names.h"
#include "report/plot.h"

namespace goniochrome::tool {

namespace {

const std::map<std::string_view, report::Series::Style> kStyles = {{"line", report::Series::Style::kLine},
                                                                   {"points", report::Series::Style::kPoints},
                                                                   {"both", report::Series::Style::kLineAndPoints},
                                                                   {"dashed", report::Series::Style::kDashed},
                                                                   {"rings", report::Series::Style::kRings}};

constexpr double kMostCoordinate = 1e300;  // so that the length of an axis is a number too

// Where each heading stands among the words of a row; style and color may be missing.
struct Columns {
  std::vector<std::size_t> series;
  std::size_t x = 0, y = 0;
  std::vector<std::string> headings;
  std::optional<std::size_t> style, color;
};

Result<Columns> columns_of(const std::string& name, int line, const std::vector<std::string>& words,
                           const Options& options) {
  std::map<std::string, std::size_t> at;
  for (std::size_t i = 0; i < words.size(); ++i) at[lower(words[i])] = i;
  const auto found = [&](std::string_view heading) -> Result<std::size_t> {
    const auto place = at.find(lower(trimmed(heading)));
    if (place != at.end()) return place->second;
    return input_error(
        "{}:{}: there is no heading {}: begin with a line such as series,x,y, or name headings of the table by "
        "--series, "
        "--x and --y: {}",
        name, line, trimmed(heading), joined(words, ", "));
  };
  Columns columns;
  for (const std::string_view heading : split(options.series, ',')) {
    GONIO_ASSIGN(columns.series.emplace_back(), found(heading));
  }
  GONIO_ASSIGN(columns.x, found(options.x));
  GONIO_ASSIGN(columns.y, found(options.y));
  if (at.contains("style")) columns.style = at["style"];
  if (at.contains("color")) columns.color = at["color"];
  columns.headings = words;
  return columns;
}

// The series of a row: its cell or, where several columns tell series apart, each heading with its cell.
std::string label_of(const Columns& columns, const std::vector<std::string>& words) {
  if (columns.series.size() == 1) return words[columns.series.front()];
  return joined(columns.series, ", ", [&](std::size_t i) { return columns.headings[i] + " " + words[i]; });
}

// A number, or NaN where the table has none, which breaks a line.
Result<double> coordinate(const std::string& name, int line, const std::string& column, std::string_view text) {
  if (trimmed(text).empty() || trimmed(text) == "-" || trimmed(text) == "none")
    return std::numeric_limits<double>::quiet_NaN();
  if (const auto value = number_in_cell(trimmed(text))) {
    if (std::abs(*value) <= kMostCoordinate) return *value;
    return input_error("{}:{}: {} is {}: numbers beyond {} have no place in a plot", name, line, column, trimmed(text),
                       kMostCoordinate);
  }
  return input_error("{}:{}: {} is \"{}\": write a number such as 0.5, or nothing", name, line, column, trimmed(text));
}

// #rrggbb, or nothing for a color of the palette.
Result<std::string> color(const std::string& name, int line, std::string_view text) {
  const bool good = text.empty() || (text.size() == 7 && text.front() == '#' &&
                                     text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos);
  if (good) return std::string(text);
  return input_error("{}:{}: color is \"{}\": give #rrggbb such as #0072b2, or nothing", name, line, text);
}

Result<std::vector<report::Series>> read_table(const std::string& path, const Options& options) {
  const std::string name = path == "-" ? "standard input" : path;
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::vector<TableRow> rows, table_rows(CsvRecords(std::move(input))));
  std::vector<report::Series> all;
  std::map<std::string, std::size_t> number_of;  // where the series of a label stands
  std::optional<Columns> columns;
  for (const auto& [line, words] : rows) {
    if (!columns) {
      GONIO_ASSIGN(columns, columns_of(name, line, words, options));
      continue;
    }
    if (words.size() != columns->headings.size())
      return input_error("{}:{}: {} cells where the headings are {}", name, line, words.size(),
                         columns->headings.size());
    const std::string label = label_of(*columns, words);
    const auto [known, is_new] = number_of.try_emplace(label, all.size());
    if (is_new) all.push_back({.label = label, .x = {}, .y = {}});
    report::Series* series = &all[known->second];
    if (is_new) {
      series->style = kStyles.at(options.style);
      if (columns->style) {
        const std::string_view style = words[*columns->style];
        if (!kStyles.contains(style))
          return input_error("{}:{}: style is \"{}\": give line, points, both, dashed or rings", name, line, style);
        series->style = kStyles.at(style);
      }
      if (columns->color) {
        GONIO_ASSIGN(series->color, color(name, line, words[*columns->color]));
      }
    }
    GONIO_ASSIGN(const double x, coordinate(name, line, options.x, words[columns->x]));
    GONIO_ASSIGN(const double y, coordinate(name, line, options.y, words[columns->y]));
    series->x.push_back(x), series->y.push_back(y);
  }
  if (all.empty()) return input_error("{}: there is nothing to draw: give headings series,x,y and rows", name);
  return all;
}

// The number of points that have both numbers and that an axis cannot show.
int left_out(const report::Series& series, const report::Plot& plot) {
  int count = 0;
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i]))
      count += (plot.x.logarithmic && series.x[i] <= 0) || (plot.y.logarithmic && series.y[i] <= 0);
  return count;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_TRY(check_output_name(options.output, "an SVG", ".svg"));
  report::Plot plot;
  plot.title = options.title;
  plot.x = {options.x_label.empty() ? options.x : options.x_label,
            options.logarithmic == "x" || options.logarithmic == "both"};
  plot.y = {options.y_label.empty() ? options.y : options.y_label,
            options.logarithmic == "y" || options.logarithmic == "both"};
  plot.width = options.width, plot.height = options.height;
  GONIO_ASSIGN(plot.series, read_table(options.table.empty() ? "-" : options.table.front(), options));
  session.results()["series"] = Json::array();
  for (const report::Series& series : plot.series) {
    const int out = left_out(series, plot);
    if (out > 0)
      session.warn(fmt::format("{} points of \"{}\" are not above 0 and have no place on a logarithmic axis", out,
                               series.label));
    session.results()["series"].push_back({{"label", series.label}, {"points", series.x.size()}, {"left_out", out}});
  }
  GONIO_ASSIGN(OutputFile file, OutputFile::create(options.output));
  GONIO_TRY(file.write(report::svg(plot)));
  GONIO_TRY(file.commit());
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
