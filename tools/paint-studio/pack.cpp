#include "pack.h"

#include <algorithm>
#include <optional>
#include <set>

#include "base/text.h"
#include "library/index.h"
#include "studio/paint_json.h"

namespace goniochrome::tool {

void PackedLibrary::add(const std::string& file, const paint::Paint& paint) {
  Json json = studio::paint_json(paint);
  const std::set<std::string> brief = {"name", "code", "class", "measurement", "gloss"};
  const std::set<std::string> of_measurement = {"illuminant", "observer", "instrument", "rows"};
  const auto only = [](const Json& object, const std::set<std::string>& names) {
    return std::ranges::all_of(object.items(), [&](const auto& member) { return names.contains(member.key()); });
  };
  Json line;
  if (json.contains("measurement") && only(json, brief) && only(json["measurement"], of_measurement)) {
    Json layout = json["measurement"], numbers = Json::array();
    layout["file"] = file, layout["rows"] = Json::array(), layout["gloss"] = Json::array();
    for (const Json& row : json["measurement"]["rows"]) {
      layout["rows"].push_back(row["geometry"]);
      for (const Json& number : row["lab"]) numbers.push_back(number);
    }
    for (const paint::GlossReading& reading : paint.gloss) {
      layout["gloss"].push_back(reading.angle_deg);
      numbers.push_back(reading.gloss_units);
    }
    const auto number = numbers_.try_emplace(json_text(layout), layouts_.size());
    if (number.second) layouts_.push_back(std::move(layout));
    line = {number.first->second, json["name"], json.value("code", ""), json.value("class", "")};
    line.insert(line.end(), numbers.begin(), numbers.end());
  } else {
    line = {{"file", file}, {"paint", std::move(json)}};
  }
  if (!lines_.empty()) lines_ += '\n';
  lines_ += json_text(line);
  paints_.push_back(paint);
}

Result<std::string> PackedLibrary::index() const {
  auto next = paints_.begin();
  GONIO_ASSIGN(const library::LibraryIndex index,
               library::LibraryIndex::from_paints([&]() -> Result<std::optional<paint::Paint>> {
                 return next == paints_.end() ? std::optional<paint::Paint>() : std::optional(*next++);
               }));
  return std::string(index.content());
}

}  // namespace goniochrome::tool
