#include "formats/internal/xml_copy.h"

namespace goniochrome::formats {

namespace {

std::string qualified(std::string_view prefix, std::string_view name) {
  return prefix.empty() ? std::string(name) : fmt::format("{}:{}", prefix, name);
}

}  // namespace

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
  for (const XmlNamespace& space : tag.namespaces)
    declared.insert_or_assign(std::string(space.prefix), std::string(space.uri));
  for (const auto& [prefix, uri] : declared)
    text_ += fmt::format(" {}=\"{}\"", prefix.empty() ? "xmlns" : "xmlns:" + prefix, xml_escaped(uri));
  for (const XmlAttribute& attribute : tag.attributes)
    text_ += fmt::format(" {}=\"{}\"", qualified(attribute.prefix, attribute.name), xml_escaped(attribute.value));
  tag_open_ = true;
  ++depth_;
}

void XmlCopy::text(std::string_view text) {
  close_tag();
  // Line ends and tabs may stand as they are between tags; only a lone carriage return would be lost.
  for (const char c : text)
    if (c == '\n' || c == '\t')
      text_ += c;
    else
      text_ += xml_escaped({&c, 1});
}

bool XmlCopy::end() {
  text_ += tag_open_ ? "/>" : "</" + names_.back() + ">";
  tag_open_ = false;
  names_.pop_back();
  return --depth_ == 0;
}

}  // namespace goniochrome::formats
