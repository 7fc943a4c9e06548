#include "chart.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/encode.h"
#include "base/paths.h"
#include "base/text.h"
#include "display/paint_view.h"
#include "paint/date.h"
#include "paint_drawing.h"
#include "plots.h"

namespace goniochrome::tool {

namespace {

// The most samples that one page shows one by one; those that fail come first.
constexpr std::size_t kMostSections = 200;
// The most failures of a sample in words, which leave its section on one page.
constexpr std::size_t kMostFailures = 12;
// The most a*b* planes that are four in a row on paper; more are small, and six in a row.
constexpr std::size_t kFewPlanes = 8;
// The most standards whose limits are drawn.
constexpr std::size_t kMostFamilies = 12;

constexpr const char* kStyle = R"(
@page { size: A4; margin: 10mm; }
:root { font: 14px/1.4 system-ui, "DejaVu Sans", "Helvetica Neue", Arial, sans-serif; color: #1c1c1c; background: #fff; }
body { margin: 0 auto; padding: 12px; max-width: 748px; }
h1 { font-size: 22px; margin: 0 0 4px; } h2 { font-size: 17px; margin: 20px 0 4px; overflow-wrap: anywhere; }
p { margin: 3px 0; } .note { color: #555; font-size: 12.5px; }
.fail, .incomplete { color: #b3261e; font-weight: 600; } .pass { color: #1b6e3c; font-weight: 600; }
ul { margin: 4px 0; padding-left: 20px; } .failures { columns: 2; font-size: 12.5px; }
img, svg { display: block; max-width: 100%; height: auto; } .planes { display: flex; flex-wrap: wrap; }
.planes svg { width: 33.3%; } .many.planes svg { width: 25%; } .top { display: flex; align-items: center; gap: 1%; } .top img { width: 46%; } .top svg { width: 53%; }
table { border-collapse: collapse; font-size: 12px; font-variant-numeric: tabular-nums; margin: 6px 0; }
th, td { padding: 2px 7px; text-align: right; border-top: 1px solid #ccc; font-weight: 400; }
th:first-child, td:first-child { text-align: left; } thead th { color: #555; border: 0; }
.family { display: grid; grid-template-columns: repeat(3, 1fr); gap: 6px; }
.family figure { margin: 0; } .family img { width: 100%; } figcaption { font-size: 12px; color: #555; text-align: center; }
.swatch { display: inline-block; width: 34px; height: 15px; vertical-align: -3px; }
section, .chart, tr { break-inside: avoid; } section + section { break-before: page; }
@media print {
  body { padding: 0; max-width: none; } h2 { margin-top: 8px; }
  .planes svg { width: 24.5%; } .many.planes svg { width: 16.3%; }
  th, td { padding: 1px 7px; } .failures { font-size: 11px; }
}
)";

std::string page_of(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta name=\"generator\" content=\"Goniochrome "
      "paint-compare\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n{2}</body>\n</html>\n",
      xml_escaped(title, ""), kStyle, body);
}

// Both colors side by side, as a display shows them.
std::string swatches(const Judgement& judgement, const quality::AngleDifference& angle) {
  const auto white = color::white_point(paint::condition_of(judgement.standard->subject.paint));
  if (!white.ok()) return "";
  std::string text;
  for (const color::Lab& lab : {angle.standard, angle.sample})
    text += fmt::format("<span class=\"swatch\" style=\"background:{}\"></span>", display::css_color(lab, *white));
  return text;
}

// A number with two decimals, whose points stand below each other in a column.
std::string column_number(double value) {
  if (!std::isfinite(value)) return table_number(value, 2);
  const std::string text = fmt::format("{:.2f}", value);
  return text == "-0.00" ? "0.00" : text;
}

std::string table_of(const Judgement& judgement, const quality::CompareOptions& compare) {
  std::string text =
      "<table><thead><tr><th>geometry</th><th>standard, sample</th><th>dL*</th><th>da*</th><th>db*</th><th>dC*</th>"
      "<th>dH*</th>";
  for (const color::DifferenceFormula& formula : compare.formulas)
    text += "<th>" + quality::quantity_of(formula) + "</th>";
  text += "</tr></thead><tbody>\n";
  const auto row = [&](const std::string& at, const std::string& colors, const quality::AngleDifference& angle) {
    text += fmt::format("<tr><td>{}</td><td>{}</td>", at, colors);
    const auto cell = [&](const std::string& quantity, double value) {
      const bool fails = std::ranges::any_of(judgement.judged.excesses, [&](const quality::Excess& excess) {
        return excess.deviation.at == at && excess.deviation.quantity == quantity;
      });
      text += (fails ? "<td class=\"fail\">" : "<td>") + column_number(value) + "</td>";
    };
    const color::LabDifference& d = angle.lab;
    cell("dL", d.dL), cell("da", d.da), cell("db", d.db), cell("dC", d.dC), cell("dH", d.dH);
    for (std::size_t i = 0; i < compare.formulas.size(); ++i)
      cell(quality::quantity_of(compare.formulas[i]), angle.by_formula[i]);
    text += "</tr>\n";
  };
  for (const quality::AngleDifference& angle : judgement.comparison.angles)
    row(paint::geometry_name(angle.geometry), swatches(judgement, angle), angle);
  row(quality::kMean, "", judgement.comparison.mean), row(quality::kLargest, "", judgement.comparison.largest);
  text += "</tbody></table>\n<p class=\"note\">";
  for (const quality::Deviation& d : judgement.comparison.others)
    text += xml_escaped(fmt::format("{}{} {} ", d.at == quality::kWhole ? "" : d.at + " ", d.quantity,
                                    table_number(d.value, 2)),
                        "") +
            (&d == &judgement.comparison.others.back() ? "" : "&middot; ");
  return text + "</p>\n";
}

// The time of a reading, if its date is known.
std::optional<double> seconds_of(const paint::Paint& paint) {
  return paint.measurement ? paint::seconds_of_date(paint.measurement->date) : std::nullopt;
}

class Charts {
 public:
  Charts(const std::vector<ChartedSample>& samples, const quality::CompareOptions& compare, PaintDrawing drawing,
         cli::Session& session)
      : samples_(samples), compare_(compare), drawing_(std::move(drawing)), session_(session) {}

  // The heading, the count of verdicts, and the control charts.
  std::string overview() const {
    VerdictCount count;
    for (const ChartedSample& each : samples_) count.add(each.judgement);
    std::string text = fmt::format("<h1>{} sample{} against {}</h1>\n<p>", samples_.size(),
                                   samples_.size() == 1 ? "" : "s", standards_text());
    if (count.judged() > 0)
      text += fmt::format("<span class=\"{}\">{}.</span> ", count.negative() > 0 ? "fail" : "pass", count.words());
    text +=
        "Every difference is sample minus standard.</p>\n<p class=\"note\">Blue lines are the tolerance of " +
        color::formula_name(compare_.formulas.front()) +
        ", 1 where it has no limit; a ring marks the standard and a point the sample. Pictures show the standard on "
        "the left and the sample on the right, drawn " +
        xml_escaped(drawing_.described(), "") + ".</p>\n";
    return text + control_charts();
  }

  // The paints that just keep the limits around their standard, and each split with it.
  Result<std::string> limit_section(const LimitFamily& family) {
    constexpr std::size_t kCenter = 4;
    const paint::Paint& standard = family.front();
    GONIO_ASSIGN(const image::Image middle, drawing_.image(standard));
    std::vector<std::string> figures;
    for (const paint::Paint& paint : family) {
      const bool is_standard = &paint == &standard;
      GONIO_ASSIGN(const std::string picture, drawing_.split_png(middle, paint));
      const std::string caption = is_standard ? "the standard" : paint.name.substr(paint.name.rfind('-') + 1);
      figures.push_back(
          fmt::format("<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption>"
                      "</figure>\n",
                      caption, base64(picture)));
    }
    // The standard stands in the middle of three rows.
    std::rotate(figures.begin(), figures.begin() + 1, figures.begin() + kCenter + 1);
    return fmt::format(
        "<section><h2>The tolerance of {}</h2>\n<p class=\"note\">Each picture shows the standard on the left and, on "
        "the "
        "right, a paint that just keeps the limits at every angle.</p>\n<div class=\"family\">\n{}</div></section>\n",
        xml_escaped(standard.name, ""), joined(figures, ""));
  }

  Result<std::string> section(const ChartedSample& each) {
    const Judgement& judgement = each.judgement;
    const std::string verdict = judgement.verdict();
    std::string text =
        fmt::format("<section><h2>{}{}</h2>\n<p class=\"note\">against {}</p>\n",
                    verdict == "-" ? "" : fmt::format("<span class=\"{0}\">{0}</span> ", verdict),
                    xml_escaped(judgement.comparison.sample, ""), xml_escaped(judgement.comparison.standard, ""));
    if (!judgement.judged.excesses.empty()) {
      text += "<ul class=\"failures\">";
      for (const std::string& words : judgement.words(kMostFailures)) text += "<li>" + xml_escaped(words, "") + "</li>";
      text += "</ul>\n";
    }
    const auto picture = picture_of(each);
    text += "<div class=\"top\">";
    if (picture.ok())
      text += fmt::format("<img alt=\"standard and sample\" src=\"data:image/png;base64,{}\">\n", base64(*picture));
    else
      session_.warn(fmt::format("paint \"{}\": there is no picture: {}", each.sample.name, picture.error().message));
    const bool many = judgement.comparison.angles.size() > kFewPlanes;
    text += report::svg(angle_plot(judgement, compare_)) + "</div>\n" + table_of(judgement, compare_) +
            fmt::format("<div class=\"{}planes\">", many ? "many " : "");
    for (const quality::AngleDifference& angle : judgement.comparison.angles)
      text += report::svg(plane_plot(judgement, angle, compare_, many));
    return text + "</div></section>\n";
  }

 private:
  // Standards are drawn once.
  Result<std::string> picture_of(const ChartedSample& each) {
    const Standard* standard = each.judgement.standard;
    if (!standards_.contains(standard)) {
      GONIO_ASSIGN(standards_[standard], drawing_.image(standard->subject.paint));
    }
    return drawing_.split_png(standards_[standard], each.sample);
  }

  std::string standards_text() const {
    std::map<const Standard*, int> met;
    for (const ChartedSample& each : samples_) ++met[each.judgement.standard];
    return met.size() == 1 ? xml_escaped(met.begin()->first->subject.paint.name, "")
                           : fmt::format("{} standards", met.size());
  }

  // Charts of the geometries that all samples have, in their order.
  std::string control_charts() const {
    constexpr std::size_t kFewest = 3;
    std::vector<std::pair<double, const Judgement*>> charted;  // with their dates
    bool dated = true;
    for (const ChartedSample& each : samples_) {
      const auto same = [](const quality::AngleDifference& x, const quality::AngleDifference& y) {
        return x.geometry == y.geometry;
      };
      if (std::ranges::equal(each.judgement.comparison.angles, samples_.front().judgement.comparison.angles, same))
        charted.emplace_back(seconds_of(each.sample).value_or(0), &each.judgement),
            dated = dated && seconds_of(each.sample);
    }
    if (charted.size() < kFewest) return "";
    std::vector<double> times_s;
    if (dated) std::ranges::stable_sort(charted, {}, [](const auto& pair) { return pair.first; });
    std::vector<const Judgement*> judgements;
    for (const auto& [time_s, judgement] : charted) {
      judgements.push_back(judgement);
      if (dated) times_s.push_back(time_s);
    }
    std::string text = fmt::format(
        "<h2>Control charts</h2>\n<p class=\"note\">{} samples {}. Red points lie more than three sigma from the mean; "
        "sigma is the mean moving range divided by "
        "1.128.</p>\n",
        judgements.size(), dated ? "by their dates" : "in their order");
    for (std::size_t i = 0; i < judgements.front()->comparison.angles.size(); ++i)
      text += "<div class=\"chart\">" + report::svg(control_plots(judgements, i, times_s), 1) + "</div>\n";
    return text;
  }

  const std::vector<ChartedSample>& samples_;
  const quality::CompareOptions& compare_;
  PaintDrawing drawing_;
  std::map<const Standard*, image::Image> standards_;
  cli::Session& session_;
};

// The samples in the order of a page: those that fail first.
std::vector<const ChartedSample*> in_order(const std::vector<ChartedSample>& samples) {
  std::vector<const ChartedSample*> order;
  for (const ChartedSample& each : samples) order.push_back(&each);
  std::ranges::stable_partition(order,
                                [](const ChartedSample* each) { return !each->judgement.judged.excesses.empty(); });
  return order;
}

Result<void> write_folder(const std::string& folder, Charts& charts, const std::vector<const ChartedSample*>& order,
                          const std::string& limits) {
  GONIO_TRY(make_folder(folder));
  const auto file = [&](const std::string& name) { return (std::filesystem::path(folder) / name).string(); };
  std::string list = "<ul>";
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::string name = fmt::format("{:04}.html", i + 1), sample = order[i]->sample.name;
    GONIO_ASSIGN(const std::string section, charts.section(*order[i]));
    GONIO_TRY(write_file(file(name), page_of(sample, section)));
    const std::string verdict = order[i]->judgement.verdict();
    list += fmt::format("<li><a href=\"{}\">{}</a> <span class=\"{}\">{}</span></li>\n", name, xml_escaped(sample, ""),
                        verdict, verdict);
  }
  return write_file(file("index.html"), page_of("Samples", charts.overview() + list + "</ul>\n" + limits));
}

}  // namespace

Result<void> write_charts(const Options& options, const std::vector<ChartedSample>& samples,
                          const std::vector<LimitFamily>& families, const quality::CompareOptions& compare,
                          cli::Session& session) {
  if (samples.empty()) return {};
  GONIO_ASSIGN(PaintDrawing drawing, PaintDrawing::make({options.mesh, options.env, ""}));
  for (const std::string& remark : drawing.remarks()) session.warn(remark);
  Charts charts(samples, compare, std::move(drawing), session);
  std::vector<const ChartedSample*> order = in_order(samples);
  std::string limits;
  for (const LimitFamily& family : families) {
    if (&family - families.data() == kMostFamilies) {
      session.warn(fmt::format("the page shows the limits of {} of {} standards", kMostFamilies, families.size()));
      break;
    }
    session.progress(fmt::format("{}: drawing the limits of {}", session.tool(), family.front().name));
    GONIO_ASSIGN(const std::string section, charts.limit_section(family));
    limits += section;
  }
  if (!options.chart.ends_with(".html")) return write_folder(options.chart, charts, order, limits);
  std::string body = charts.overview() + limits;
  if (order.size() > kMostSections) {
    session.warn(
        fmt::format("the page shows {} of {} samples one by one, those that fail first: --chart FOLDER shows all",
                    kMostSections, order.size()));
    order.resize(kMostSections);
  }
  for (const ChartedSample* each : order) {
    session.progress(fmt::format("{}: drawing {}", session.tool(), each->sample.name));
    GONIO_ASSIGN(const std::string section, charts.section(*each));
    body += section;
  }
  return write_file(options.chart, page_of("Paints against their standards", body));
}

}  // namespace goniochrome::tool
