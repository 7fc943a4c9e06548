// Keeps an element that is not ours as text, so that it can be written again elsewhere.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "formats/internal/xml_stream.h"

namespace goniochrome::formats {

// Prefixes in scope and their namespaces, "" for the default one.
using XmlScope = std::map<std::string, std::string, std::less<>>;

// Serializes one element and all below it. Declares on it every prefix that is in scope where it stood, so that the
// text means the same under an element that declares `default_space` as its default namespace and nothing else.
// Comments and processing instructions are lost; character data stays, CDATA sections become escaped text.
class XmlCopy {
 public:
  explicit XmlCopy(std::string_view default_space) : default_space_(default_space) {}

  bool active() const { return depth_ > 0; }
  void start(const XmlTag& tag, const XmlScope& scope);
  void text(std::string_view text);
  // Returns whether the copied element itself has ended.
  bool end();
  std::size_t size() const { return text_.size(); }
  std::string take() { return std::move(text_); }

 private:
  void close_tag();

  std::string default_space_, text_;
  std::vector<std::string> names_;
  int depth_ = 0;
  bool tag_open_ = false;
};

}  // namespace goniochrome::formats
