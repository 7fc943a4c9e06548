#include "sink.h"

#include <unordered_map>

#include "base/text.h"

namespace goniochrome::tool {

namespace {

constexpr const char* kTableHead =
    "query\trank\tname\tcode\tclass\tdistance\tmean_de\tdL\tdC\tdH\tstatus\tde_by_geometry";

std::string table_lines(const Finding& finding, bool lights, const library::LibraryIndex& index) {
  const std::string query = table_field(finding.query), status = finding.status();
  if (finding.no_match())
    return query + "\t0\t\t\t\tn/a\tn/a\tn/a\tn/a\tn/a\t" + status + (lights ? "\t-\t-\n" : "\t-\n");
  std::vector<color::Lab> colors;
  for (const library::SearchTerm& term : finding.plan.terms) colors.push_back(term.lab);
  const int decimals = decimals_of(colors);
  std::string text;
  int rank = 0;
  for (const Neighbor& neighbor : finding.neighbors) {
    const std::size_t paint = neighbor.match.paint;
    text += fmt::format("{}\t{}\t{}\t{}\t{}", query, ++rank, table_field(std::string(index.name(paint))),
                        table_field(std::string(index.code(paint))), paint::paint_class_name(index.paint_class(paint)));
    for (const double value : {neighbor.match.distance, neighbor.mean_de, neighbor.dL, neighbor.dC, neighbor.dH})
      text += "\t" + table_number(value, decimals);
    text += "\t" + status + "\t";
    for (std::size_t i = 0; i < neighbor.de.size(); ++i)
      text += (i ? "," : "") + paint::geometry_name(finding.plan.geometries[i]) + "=" +
              table_number(neighbor.de[i], decimals);
    if (!neighbor.illuminant.empty()) text += "\t" + neighbor.illuminant;
    text += "\n";
  }
  return text;
}

}  // namespace

Json finding_json(const Finding& finding, const library::LibraryIndex& index) {
  Json geometries = Json::array(), matches = Json::array();
  for (const paint::Geometry& geometry : finding.plan.geometries) geometries.push_back(paint::geometry_name(geometry));
  for (const Neighbor& neighbor : finding.neighbors) {
    const std::size_t paint = neighbor.match.paint;
    Json differences = Json::object();
    for (std::size_t i = 0; i < neighbor.de.size(); ++i)
      differences[paint::geometry_name(finding.plan.geometries[i])] = json_number(neighbor.de[i]);
    matches.push_back({{"name", index.name(paint)},
                       {"code", index.code(paint)},
                       {"class", paint::paint_class_name(index.paint_class(paint))},
                       {"distance", json_number(neighbor.match.distance)},
                       {"mean_de", json_number(neighbor.mean_de)},
                       {"dL", json_number(neighbor.dL)},
                       {"dC", json_number(neighbor.dC)},
                       {"dH", json_number(neighbor.dH)},
                       {"de_by_geometry", differences}});
    if (!neighbor.illuminant.empty()) matches.back()["illuminant"] = neighbor.illuminant;
  }
  return {{"name", finding.query},
          {"status", finding.status()},
          {"geometries", geometries},
          {"hue_shift", json_number(finding.hue_shift)},
          {"matched_hue_shift", json_number(finding.matched_hue_shift)},
          {"hue_travel_deg", json_number(finding.hue_travel_deg)},
          {"matched_hue_travel_deg", json_number(finding.matched_hue_travel_deg)},
          {"matches", matches}};
}

Result<CodeSink> CodeSink::begin(OutputFile file, Prolog prolog, const cli::Session& session) {
  GONIO_ASSIGN(formats::PaintWriter writer, begin_paints(std::move(file), std::move(prolog), session));
  return CodeSink(std::move(writer));
}

Result<std::string> CodeSink::write(paint::Paint query, const Finding* finding, const library::LibraryIndex& index) {
  std::string without_code;
  if (finding != nullptr && !finding->no_match()) {
    const std::size_t nearest = finding->neighbors.front().match.paint;
    query.code = index.code(nearest);
    if (query.code.empty()) query.code = without_code = index.name(nearest);
  }
  GONIO_TRY(writer_.write(query));
  return without_code;
}

Result<Sink> Sink::begin(Format format, bool lights, OutputFile file) {
  Sink sink(format, lights, std::move(file));
  if (format == Format::kTable)
    GONIO_TRY(sink.file_.write(std::string(kTableHead) + (lights ? "\tilluminant\n" : "\n")));
  return sink;
}

Result<void> Sink::write(const Finding& finding, const library::LibraryIndex& index) {
  switch (format_) {
    case Format::kTable:
      return file_.write(table_lines(finding, lights_, index));
    case Format::kJson:
      return file_.write(json_text(finding_json(finding, index)) + "\n");
    case Format::kPaints:
      break;
  }
  for (const Neighbor& neighbor : finding.neighbors)
    if (met_.insert(neighbor.match.paint).second) wanted_.push_back(neighbor.match.paint);
  return {};
}

Result<void> Sink::finish(const std::string& library_path, const std::optional<StreamedLibrary>& streamed,
                          const cli::Session& session) {
  return format_ == Format::kPaints ? write_paints(library_path, streamed, session) : file_.commit();
}

Result<void> Sink::write_paints(const std::string& library_path, const std::optional<StreamedLibrary>& streamed,
                                const cli::Session& session) {
  if (streamed) {
    GONIO_ASSIGN(formats::PaintWriter writer, begin_paints(std::move(file_), streamed->prolog, session));
    for (const std::uint32_t place : wanted_) GONIO_TRY(writer.write(streamed->paints[place]));
    return writer.finish();
  }
  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(library_path));
  Prolog prolog;
  prolog.take(*source);
  std::unordered_map<std::uint32_t, paint::Paint> paints;
  for (std::uint32_t place = 0; paints.size() < wanted_.size(); ++place) {
    GONIO_ASSIGN(std::optional<paint::Paint> paint, source->next());
    if (!paint) return input_error("{}: it was changed while it was searched: run again", library_path);
    if (met_.contains(place)) paints.emplace(place, std::move(*paint));
  }
  GONIO_ASSIGN(formats::PaintWriter writer, begin_paints(std::move(file_), std::move(prolog), session));
  for (const std::uint32_t place : wanted_) GONIO_TRY(writer.write(paints.at(place)));
  return writer.finish();
}

}  // namespace goniochrome::tool
