#include "formats/internal/csv_header.h"

#include <algorithm>

#include "base/csv_records.h"
#include "base/text.h"

namespace goniochrome::formats {

namespace {

constexpr std::array<std::string_view, kColumns> kNames = {
    "sample", "geometry",   "illuminant", "observer", "l",       "a",      "b",    "class",
    "code",   "instrument", "gloss20",    "gloss60",  "gloss85", "origin", "date", "serial"};

// The words of other programs for these columns.
constexpr std::array<std::pair<std::string_view, std::string_view>, 26> kOtherNames = {{
    {"name", "sample"},
    {"paint", "sample"},
    {"samplename", "sample"},
    {"probe", "sample"},
    {"muster", "sample"},
    {"bezeichnung", "sample"},
    {"farbe", "sample"},
    {"farbton", "sample"},
    {"geometrie", "geometry"},
    {"winkel", "geometry"},
    {"messwinkel", "geometry"},
    {"lichtart", "illuminant"},
    {"normlichtart", "illuminant"},
    {"beobachter", "observer"},
    {"normalbeobachter", "observer"},
    {"gloss", "gloss60"},
    {"datetime", "date"},
    {"date/time", "date"},
    {"time", "date"},
    {"measuredate", "date"},
    {"measurementdate", "date"},
    {"datum", "date"},
    {"zeit", "date"},
    {"serialnumber", "serial"},
    {"instrumentserial", "serial"},
    {"seriennummer", "serial"},
}};

// A heading in lower case and without what spreadsheets and instruments add: `L*`, `L_15`, `L (15)`, `15° L*`,
// `15°:L*`.
std::string plain_heading(std::string_view heading) {
  std::string text = without_degree_sign(lower(heading));
  std::erase_if(text, [](char c) { return c == '*' || c == '_' || c == ' ' || c == '(' || c == ')' || c == ':'; });
  const bool angle_first = text.size() > 1 && (text[0] == '-' || (text[0] >= '0' && text[0] <= '9'));
  if (angle_first && std::string_view("lab").find(text.back()) != std::string_view::npos)
    std::rotate(text.begin(), text.end() - 1, text.end());
  const auto other = std::ranges::find(kOtherNames, text, &std::pair<std::string_view, std::string_view>::first);
  return other != kOtherNames.end() ? std::string(other->second) : text;
}

// Notes the column of a heading like `L45as15`. Error: the same column is there twice.
Result<bool> take_triple(CsvHeader& header, const std::string& heading, int index) {
  const auto channel = std::string_view("lab").find(heading.front());
  if (channel == std::string_view::npos || heading.size() < 2) return false;
  const auto geometry = paint::parse_geometry(std::string_view(heading).substr(1));
  if (!geometry.ok()) return false;
  auto triple = std::ranges::find(header.triples, *geometry, &CsvTriple::geometry);
  if (triple == header.triples.end()) triple = header.triples.insert(triple, {*geometry});
  if (triple->column[channel] >= 0)
    return input_error("two columns are named {}: keep one", shown(header.headings[index]));
  triple->column[channel] = index;
  return true;
}

}  // namespace

std::string without_degree_sign(std::string_view angle) {
  std::string text(angle);
  for (auto at = text.find("\xc2\xb0"); at != std::string::npos; at = text.find("\xc2\xb0")) text.erase(at, 2);
  return std::string(trimmed(text));
}

Result<CsvHeader> header_of(const std::vector<std::string>& cells) {
  CsvHeader header;
  header.headings = cells;
  header.column.fill(-1);
  for (int i = 0; i < static_cast<int>(cells.size()); ++i) {
    const std::string heading = plain_heading(cells[i]);
    const auto known = std::ranges::find(kNames, heading);
    if (known != kNames.end()) {
      int& column = header.column[known - kNames.begin()];
      const bool second_date = column >= 0 && known == kNames.begin() + kDate;
      if (column >= 0 && !second_date) return input_error("two columns are named {}: keep one", shown(cells[i]));
      if (!second_date) column = i;
      continue;
    }
    if (heading.empty()) continue;
    GONIO_ASSIGN(const bool taken, take_triple(header, heading, i));
    if (taken) continue;
    if (const auto nm = wavelength_in(cells[i])) {
      header.wavelengths.push_back({*nm, i});
      GONIO_TRY(take_scale(cells[i], header.scale));
    } else {
      header.unknown.push_back(cells[i]);
    }
  }
  if (header.wavelengths.size() < kFewestWavelengths) {
    for (const WavelengthColumn& column : header.wavelengths)
      header.unknown.push_back(cells[static_cast<std::size_t>(column.at)]);
    header.wavelengths.clear();
  }
  GONIO_TRY(sort_wavelengths(header.wavelengths));
  const bool has_colors = header.column[kGeometry] >= 0 || !header.triples.empty();
  const bool first_is_free = cells[0].empty() || (!header.unknown.empty() && header.unknown[0] == cells[0]);
  if (header.column[kSample] < 0 && has_colors && first_is_free) {
    header.taken_for_sample = cells[0].empty() ? "first" : cells[0];
    std::erase(header.unknown, cells[0]);
    header.column[kSample] = 0;
  }
  if (header.column[kSample] < 0) return input_error("the header has no column \"sample\": begin with {}", kLongHeader);
  if (header.is_wide() && !header.wavelengths.empty())
    return input_error(
        "the header has wavelengths and no column \"geometry\": say at which geometry each spectrum was measured");
  if (!header.is_wide()) {
    const bool has_no_lab = header.column[kL] < 0 && header.column[kA] < 0 && header.column[kB] < 0;
    if (has_no_lab && !header.wavelengths.empty()) return header;
    for (const CsvColumn channel : {kL, kA, kB})
      if (header.column[channel] < 0)
        return input_error("the header has no column \"{}\": begin with {}", "Lab"[channel - kL], kLongHeader);
    return header;
  }
  if (header.triples.empty())
    return input_error("the header has neither a column \"geometry\" nor columns like L15, a15, b15: begin with {}",
                       kLongHeader);
  for (const CsvTriple& triple : header.triples)
    for (int c = 0; c < 3; ++c)
      if (triple.column[c] < 0)
        return input_error("the header has no column {}{}: give L, a and b of every geometry", "Lab"[c],
                           paint::geometry_name(triple.geometry));
  return header;
}

}  // namespace goniochrome::formats
