#include "formats/internal/xml_values.h"

#include <algorithm>

#include "base/text.h"
#include "base/utf8.h"

namespace goniochrome::formats {

namespace {

constexpr std::string_view kSchemaInstance = "http://www.w3.org/2001/XMLSchema-instance";

}  // namespace

Result<double> number_in(std::string_view text, Domain domain) {
  const std::string_view value = trimmed(text);
  if (value.empty()) return input_error("is empty: write a number");
  const auto number = parse_number(value);
  if (!number && value.find(',') != std::string_view::npos)
    return input_error("is \"{}\": write a decimal point", shown(value));
  const std::string word = lower(value.substr(0, 5));
  if (!number && (word.find("nan") != word.npos || word.find("inf") != word.npos))
    return input_error("is \"{}\": write a finite number", shown(value));
  if (!number) return input_error("is \"{}\": write a number such as 12.5", shown(value));
  if (domain == Domain::kNotNegative && *number < 0) return input_error("is {}: write 0 or more", value);
  if (domain == Domain::kPositive && *number <= 0) return input_error("is {}: write a number above 0", value);
  if (domain == Domain::kRefractiveIndex && *number < 1) return input_error("is {}: write 1 or more", value);
  return *number;
}

const XmlAttribute* XmlValues::find(std::string_view name) const {
  for (const XmlAttribute& attribute : tag_.attributes)
    if (attribute.name == name && attribute.space.empty()) return &attribute;
  return nullptr;
}

Result<void> XmlValues::check_names(std::string_view names) const {
  std::string listed;
  std::size_t known = 0;
  for (std::string_view name : split(names, ' ')) {
    if (name.empty()) break;
    const bool optional = name.ends_with('?');
    if (optional) name.remove_suffix(1);
    listed += fmt::format("{}{}", listed.empty() ? "" : ", ", name);
    if (has(name))
      ++known;
    else if (!optional)
      return error(fmt::format("<{}> has no {}: write {}=\"...\"", tag_.name, name, name));
  }
  if (known == tag_.attributes.size()) return {};
  for (const XmlAttribute& attribute : tag_.attributes) {
    if (attribute.space == kSchemaInstance) continue;
    const auto words = split(names, ' ');
    const bool ours = attribute.space.empty() && std::ranges::any_of(words, [&](std::string_view word) {
                        return word.substr(0, word.find('?')) == attribute.name;
                      });
    if (!ours)
      return input_error("{}:{}: <{}> takes no attribute \"{}\": it takes {}", file_, attribute.line, tag_.name,
                         attribute.name, listed.empty() ? "none" : listed);
  }
  return {};
}

std::string_view XmlValues::text(std::string_view name) const {
  const XmlAttribute* attribute = find(name);
  return attribute ? attribute->value : std::string_view();
}

Result<void> XmlValues::name(std::string_view name, std::string& target) const {
  target = text(name);
  if (!target.empty()) return {};
  return input_error("{}:{}: {} is empty: write something", file_, find(name) ? find(name)->line : tag_.line, name);
}

Result<void> XmlValues::number(std::string_view name, double& target, Domain domain) const {
  const auto value = number_in(text(name), domain);
  if (!value.ok())
    return input_error("{}:{}: {} {}", file_, find(name) ? find(name)->line : tag_.line, name, value.error().message);
  target = *value;
  return {};
}

Result<void> XmlValues::lab(color::Lab& target) const {
  GONIO_TRY(number("L", target.L));
  GONIO_TRY(number("a", target.a));
  return number("b", target.b);
}

Result<void> XmlValues::rgb(std::string_view prefix, color::Rgb& target) const {
  GONIO_TRY(number(fmt::format("{}r", prefix), target.x));
  GONIO_TRY(number(fmt::format("{}g", prefix), target.y));
  return number(fmt::format("{}b", prefix), target.z);
}

Error XmlValues::error(std::string_view name, std::string_view remedy) const {
  const XmlAttribute* attribute = find(name);
  return input_error("{}:{}: {} is \"{}\": {}", file_, attribute ? attribute->line : tag_.line, name, shown(text(name)),
                     remedy);
}

Error XmlValues::error(std::string_view what) const {
  return input_error("{}:{}: {}", file_, tag_.line, what);
}

}  // namespace goniochrome::formats
