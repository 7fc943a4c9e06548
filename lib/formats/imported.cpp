#include "formats/imported.h"

#include <fmt/format.h>

#include <algorithm>

namespace goniochrome::formats {

void Remarks::note(const std::string& what, std::string_view example) {
  const auto known = std::ranges::find(kinds_, what, &Kind::what);
  if (known != kinds_.end()) {
    ++known->count;
    return;
  }
  kinds_.push_back({what, std::string(example), 1});
}

std::vector<std::string> Remarks::lines() const {
  std::vector<std::string> result;
  for (const Kind& kind : kinds_) {
    const std::string more = kind.count > 1 ? fmt::format(" and {} more", kind.count - 1) : "";
    result.push_back(kind.example.empty() && more.empty() ? kind.what
                                                          : fmt::format("{} ({}{})", kind.what, kind.example, more));
  }
  return result;
}

bool is_wanted(const color::ViewingCondition& condition, const ImportOptions& options) {
  return (options.illuminant.empty() || options.illuminant == condition.illuminant) &&
         (options.observer_deg == 0 || options.observer_deg == condition.observer_deg);
}

std::optional<paint::Measurement> measurement_of(const std::vector<SeenReading>& readings, const ImportOptions& options,
                                                 std::string_view paint, Remarks& remarks) {
  const auto first =
      std::ranges::find_if(readings, [&](const SeenReading& seen) { return is_wanted(seen.condition, options); });
  if (first == readings.end()) {
    if (!readings.empty()) remarks.note("no reading under the illuminant and observer asked for", paint);
    return std::nullopt;
  }
  paint::Measurement result{first->condition, "", {}};
  bool others = false;
  for (const SeenReading& seen : readings) {
    if (seen.condition != result.condition) {
      others = true;
      continue;
    }
    const bool known = std::ranges::any_of(
        result.rows, [&](const paint::LabReading& row) { return row.geometry == seen.reading.geometry; });
    if (known)
      remarks.note("several readings at one geometry: the first was taken",
                   fmt::format("{} at {}", paint, paint::geometry_name(seen.reading.geometry)));
    else
      result.rows.push_back(seen.reading);
  }
  if (others)
    remarks.note(fmt::format("readings under other illuminants or observers than {}/{} were left out: choose with "
                             "--illuminant and --observer",
                             result.condition.illuminant, result.condition.observer_deg),
                 paint);
  return result;
}

Result<std::string> whole_content(InputFile& input, std::size_t most) {
  constexpr std::size_t kChunk = 1 << 20;
  std::string content;
  for (;;) {
    GONIO_ASSIGN(const std::size_t count, input.read(content, kChunk));
    if (count == 0) return content;
    if (content.size() > most) return input_error("{}: is larger than {} bytes: split it", input.name(), most);
  }
}

std::string UniqueNames::own(const std::string& name, Remarks& remarks) {
  std::string own = name;
  for (int k = 2; !used_.insert(own).second; ++k) own = fmt::format("{} ({})", name, k);
  if (own != name) remarks.note("names that stood before got a number", own);
  return own;
}

}  // namespace goniochrome::formats
