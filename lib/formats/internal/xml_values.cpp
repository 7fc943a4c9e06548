// The values of tags, and copies of elements, whatever parses the XML.
#include <algorithm>

#include "base/text.h"
#include "formats/internal/xml_stream.h"

namespace goniochrome::formats {

namespace {

constexpr std::string_view kSchemaInstance = "http://www.w3.org/2001/XMLSchema-instance";

std::string qualified(std::string_view prefix, std::string_view name) {
  return prefix.empty() ? std::string(name) : fmt::format("{}:{}", prefix, name);
}

}  // namespace

const XmlAttribute* XmlValues::find(std::string_view name) const {
  for (const XmlAttribute& attribute : tag_.attributes)
    if (attribute.name == name && attribute.space.empty()) return &attribute;
  return nullptr;
}

Result<void> XmlValues::check_names(std::string_view names) const {
  const std::vector<std::string_view> words = split(names, ' ');
  std::size_t known = 0;
  for (std::string_view name : words) {
    if (name.empty()) break;
    const bool optional = name.ends_with('?');
    if (optional) name.remove_suffix(1);
    if (has(name))
      ++known;
    else if (!optional)
      return error(fmt::format("<{}> has no {}: write {}=\"...\"", tag_.name, name, name));
  }
  if (known == tag_.attributes.size()) return {};
  for (const XmlAttribute& attribute : tag_.attributes) {
    if (attribute.space == kSchemaInstance) continue;
    const bool ours = attribute.space.empty() && std::ranges::any_of(words, [&](std::string_view word) {
                        return word.substr(0, word.find('?')) == attribute.name;
                      });
    if (ours) continue;
    std::vector<std::string> listed;
    for (const std::string_view word : words) listed.emplace_back(word.substr(0, word.find('?')));
    return input_error("{}:{}: <{}> takes no attribute \"{}\": it takes {}", file_, attribute.line, tag_.name,
                       attribute.name, names.empty() ? "none" : joined(listed, ", "));
  }
  return {};
}

std::string_view XmlValues::text(std::string_view name) const {
  const XmlAttribute* attribute = find(name);
  return attribute ? attribute->value : std::string_view();
}

Result<void> XmlValues::name(std::string_view name, std::string& target) const {
  target = text(name);
  return target.empty() ? error_at(name, "is empty: write something") : Result<void>();
}

Result<void> XmlValues::number(std::string_view name, double& target, Domain domain) const {
  const auto value = number_in(text(name), domain);
  if (!value.ok()) return error_at(name, value.error().message);
  target = *value;
  return {};
}

Result<void> XmlValues::lab(color::Lab& target) const {
  GONIO_TRY(number("L", target.L, Domain::kLab));
  GONIO_TRY(number("a", target.a, Domain::kLab));
  return number("b", target.b, Domain::kLab);
}

Result<void> XmlValues::rgb(std::string_view prefix, color::Rgb& target) const {
  GONIO_TRY(number(fmt::format("{}r", prefix), target.x));
  GONIO_TRY(number(fmt::format("{}g", prefix), target.y));
  return number(fmt::format("{}b", prefix), target.z);
}

Error XmlValues::error_at(std::string_view name, std::string_view what) const {
  const XmlAttribute* attribute = find(name);
  return input_error("{}:{}: {} {}", file_, attribute ? attribute->line : tag_.line, name, what);
}

Error XmlValues::error(std::string_view name, std::string_view remedy) const {
  return error_at(name, fmt::format("is \"{}\": {}", shown(text(name)), remedy));
}

Error XmlValues::error(std::string_view what) const {
  return input_error("{}:{}: {}", file_, tag_.line, what);
}

void declare(const XmlTag& tag, XmlScope& scope) {
  for (const XmlNamespace& space : tag.namespaces)
    scope.insert_or_assign(std::string(space.prefix), std::string(space.uri));
}

void XmlCopy::close_tag() {
  if (tag_open_) text_ += '>';
  tag_open_ = false;
}

void XmlCopy::start(const XmlTag& tag, const XmlScope& scope) {
  if (depth_ == 0) text_.clear(), names_.clear();
  close_tag();
  names_.push_back(qualified(tag.prefix, tag.name));
  text_ += "<" + names_.back();
  XmlScope declared;
  if (depth_ == 0) {
    declared = scope;
    declared.try_emplace("", "");
    if (declared[""] == default_space_) declared.erase("");
  }
  declare(tag, declared);
  for (const auto& [prefix, uri] : declared)
    text_ += fmt::format(" {}=\"{}\"", prefix.empty() ? "xmlns" : "xmlns:" + prefix, xml_escaped(uri));
  for (const XmlAttribute& attribute : tag.attributes)
    text_ += fmt::format(" {}=\"{}\"", qualified(attribute.prefix, attribute.name), xml_escaped(attribute.value));
  tag_open_ = true;
  ++depth_;
}

void XmlCopy::text(std::string_view text) {
  close_tag();
  text_ += xml_escaped(text, "\r");  // between tags only a carriage return would be lost
}

bool XmlCopy::end() {
  text_ += tag_open_ ? "/>" : "</" + names_.back() + ">";
  tag_open_ = false;
  names_.pop_back();
  return --depth_ == 0;
}

}  // namespace goniochrome::formats
