// XML in a stream: elements as they come, checked against a schema, in bounded memory, from untrusted files. Document
// types, entities, external files and the network are never used.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/input.h"
#include "base/result.h"

namespace goniochrome::formats {

// Views hold until the handler returns.
struct XmlAttribute {
  std::string_view name, prefix, space;  // local name, prefix, namespace ("" where it has none)
  std::string_view value;
  int line = 0;
};
struct XmlNamespace {
  std::string_view prefix, uri;  // prefix "" is the default namespace
};
struct XmlTag {
  std::string_view name, prefix, space;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlNamespace> namespaces;  // declared here
  int line = 0;                          // where the tag ends
};

// What is told of a document. An Error ends it. Comments and processing instructions are left out.
class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  virtual Result<void> start(const XmlTag& tag) = 0;
  virtual Result<void> end(int line) = 0;
  virtual Result<void> text(std::string_view text, int line) = 0;
  // The element that just started or ended breaks the schema; told after start() or end() of that element.
  virtual Result<void> invalid(int line, const std::string& why) = 0;
};

// No text, tag or attribute may be longer, nor elements be nested deeper.
constexpr std::size_t kLongestXmlToken = 1 << 20;
constexpr std::size_t kDeepestXml = 256;

class XmlStream {
 public:
  // Reads `input` and tells `handler`, which must outlive the stream. `schema` is the text of an XSD that lives as long
  // as the program, or nullptr.
  XmlStream(InputFile input, const char* schema, XmlHandler& handler);
  XmlStream(const XmlStream&) = delete;
  ~XmlStream();

  // Reads on, as far as one read of the input reaches. Returns whether there may be more. An error is final and names
  // file and line.
  Result<bool> advance();

  const std::string& name() const;
  // How many bytes were read so far.
  std::size_t bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// `text` with &, <, >, quotes and control characters escaped, for element content and for attribute values.
std::string xml_escaped(std::string_view text);

}  // namespace goniochrome::formats
