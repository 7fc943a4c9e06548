// XML as a stream, in bounded memory, from files that nobody vouches for: elements as they come, the values of their
// attributes, and elements of other vocabularies kept as text. Document types, entities, external files and the network
// are never used.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/result.h"
#include "color/color.h"
#include "formats/imported.h"

namespace goniochrome::formats {

// The views hold until the handler returns.
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

// Hears of a document from beginning to end, without its comments and processing instructions. An Error ends it.
class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  virtual Result<void> start(const XmlTag& tag) = 0;
  virtual Result<void> end(int line) = 0;
  virtual Result<void> text(std::string_view text, int line) = 0;
};

// A text, tag or attribute that is longer is refused, and so are elements that are nested more deeply.
constexpr std::size_t kLongestXmlToken = 1 << 20;
constexpr std::size_t kDeepestXml = 256;

// Appends bytes to the first argument, as many as the second or fewer, and returns how many; 0 at the end.
using XmlBytes = std::function<Result<std::size_t>(std::string&, std::size_t)>;

class XmlStream {
 public:
  // Reads `input` and tells `handler`, which must outlive the stream.
  XmlStream(InputFile input, XmlHandler& handler);
  // Likewise from anywhere else; errors call it `name`.
  XmlStream(std::string name, XmlBytes input, XmlHandler& handler);
  XmlStream(const XmlStream&) = delete;
  ~XmlStream();

  // Reads on, as far as one read of the input reaches. Returns whether there may be more. An error is final and names
  // file and line.
  Result<bool> advance();

  // Reads to the end.
  Result<void> finish();

  // How many bytes were read so far.
  std::size_t bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The values of one tag's attributes. Errors name the file, the attribute's line and the remedy.
class XmlValues {
 public:
  XmlValues(const std::string& file, const XmlTag& tag) : file_(file), tag_(tag) {}

  const XmlTag& tag() const { return tag_; }

  // Checks that the tag has the attributes `names`, which are separated by blanks; one with a "?" behind its name may
  // be missing. Any other attribute is refused, except those of XML Schema itself (xsi:schemaLocation).
  Result<void> check_names(std::string_view names) const;

  bool has(std::string_view name) const { return find(name) != nullptr; }
  // The value; "" where the attribute is missing.
  std::string_view text(std::string_view name) const;
  // A text that must not be empty.
  Result<void> name(std::string_view name, std::string& target) const;
  Result<void> number(std::string_view name, double& target, Domain domain = Domain::kAny) const;
  // The value as `parse` reads it: class_in() or observer_in().
  template <class T>
  Result<void> word(std::string_view name, T& target, Result<T> (*parse)(std::string_view)) const {
    const Result<T> value = parse(text(name));
    if (!value.ok()) return error_at(name, value.error().message);
    target = *value;
    return {};
  }
  // L, a and b.
  Result<void> lab(color::Lab& target) const;
  // Three channels: prefix + "r", "g", "b".
  Result<void> rgb(std::string_view prefix, color::Rgb& target) const;

  // `file:line: name is "value": remedy`
  Error error(std::string_view name, std::string_view remedy) const;
  // `file:line: what`
  Error error(std::string_view what) const;

 private:
  const XmlAttribute* find(std::string_view name) const;
  Error error_at(std::string_view name, std::string_view what) const;  // `file:line: name what`

  const std::string& file_;
  const XmlTag& tag_;
};

// Prefixes in scope and their namespaces, "" for the default one.
using XmlScope = std::map<std::string, std::string, std::less<>>;

// `scope` with what a tag declares.
void declare(const XmlTag& tag, XmlScope& scope);

// Writes one element, and all inside it, as text that can be written again elsewhere. It declares every prefix that is
// in scope where the element stood, so that the text means the same under an element that declares `default_space` as
// its default namespace and nothing else. Comments and processing instructions are lost; character data stays, and
// CDATA sections become escaped text.
class XmlCopy {
 public:
  explicit XmlCopy(std::string_view default_space) : default_space_(default_space) {}

  bool active() const { return depth_ > 0; }
  void start(const XmlTag& tag, const XmlScope& scope);
  void text(std::string_view text);
  // Returns whether the copied element itself has ended.
  bool end();
  std::string take() { return std::move(text_); }

 private:
  void close_tag();

  std::string default_space_, text_;
  std::vector<std::string> names_;
  int depth_ = 0;
  bool tag_open_ = false;
};

}  // namespace goniochrome::formats
