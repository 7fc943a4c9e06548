#include "formats/internal/xml_stream.h"

#include <libxml/SAX2.h>
#include <libxml/parser.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "base/text.h"

namespace goniochrome::formats {

namespace {

constexpr std::size_t kChunk = 1 << 16;
constexpr std::size_t kMostAttributes = 256, kMostNamespaces = 256;  // of one tag; of all open elements
constexpr std::size_t kMostPieces = 10000;  // of one text, which comments and the parser's buffer part

std::string_view view(const xmlChar* text) {
  return text ? std::string_view(reinterpret_cast<const char*>(text)) : std::string_view();
}

// Keeps libxml2 from printing: every error comes through the structured handlers below.
void silence(void*, const char*, ...) {}

// The meaning of libxml2's error for the person who wrote the file.
std::string explained(int code, std::string_view detail) {
  switch (code) {
    case XML_ERR_INVALID_CHAR:
    case XML_ERR_INVALID_ENCODING:
    case XML_ERR_UNKNOWN_ENCODING:
    case XML_ERR_UNSUPPORTED_ENCODING:
    case XML_I18N_CONV_FAILED:
    case XML_IO_ENCODER:
      return "a character is not valid UTF-8: save the file as UTF-8, without control characters";
    case XML_ERR_TAG_NAME_MISMATCH:
      return "the closing tag does not match the open element: close what was opened last";
    case XML_ERR_UNDECLARED_ENTITY:
    case XML_WAR_UNDECLARED_ENTITY:
    case XML_ERR_ENTITY_LOOP:
    case XML_ERR_ENTITYREF_SEMICOL_MISSING:
    case XML_ERR_NAME_REQUIRED:
      return "\"&\" or \"<\" begins no known name: write &amp; or &lt; for the character itself";
    case XML_ERR_LT_IN_ATTRIBUTE:
      return "\"<\" inside an attribute: write &lt;, or close the quotation mark before it";
    case XML_ERR_ATTRIBUTE_NOT_STARTED:
    case XML_ERR_ATTRIBUTE_WITHOUT_VALUE:
    case XML_ERR_SPACE_REQUIRED:
    case XML_ERR_GT_REQUIRED:
    case XML_ERR_EQUAL_REQUIRED:
    case XML_ERR_STRING_NOT_STARTED:
    case XML_ERR_STRING_NOT_CLOSED:
    case XML_ERR_ATTRIBUTE_NOT_FINISHED:
    case XML_NS_ERR_QNAME:
      return "a tag is not well-formed: write name=\"value\" with a space before it, and close the tag with >";
    case XML_ERR_ATTRIBUTE_REDEFINED:
      return "an attribute is given twice: give it once";
    case XML_NS_ERR_UNDEFINED_NAMESPACE:
      return "a prefix has no namespace: declare it with xmlns:prefix=\"...\"";
    case XML_ERR_DOCUMENT_END:
      return "there is more after the end of the document: give several documents as several files";
    case XML_ERR_DOCUMENT_EMPTY:
    case XML_ERR_DOCUMENT_START:
      return "this is not XML: it must begin with < and an element (paint-convert makes XML of paint tables)";
    case XML_WAR_NS_URI:
      return "a namespace is not a URI: write it as it is documented";
    case XML_ERR_RESERVED_XML_NAME:
    case XML_ERR_XMLDECL_NOT_STARTED:
    case XML_ERR_XMLDECL_NOT_FINISHED:
    case XML_ERR_VERSION_MISSING:
    case XML_ERR_UNKNOWN_VERSION:
    case XML_ERR_ENCODING_NAME:
      return "the first thing in a file, and only there, must be <?xml version=\"1.0\" encoding=\"UTF-8\"?>";
    default:
      break;
  }
  if (detail.find("uge") != std::string_view::npos || detail.find("too long") != std::string_view::npos)
    return fmt::format("one text or attribute is longer than {} bytes: shorten it", kLongestXmlToken);
  return fmt::format("not well-formed XML ({})", trimmed(detail));
}

// Counts the attributes of each tag on the way to the parser. libxml2 compares every attribute of a tag with every
// other, so that 10^5 of them in one tag take more than a minute.
class AttributeCounter {
 public:
  // False if a tag within `chunk`, or one that was begun before it, has more than kMostAttributes.
  bool pass(std::string_view chunk) {
    while (!chunk.empty()) {
      if (state_ == State::kText) {
        const auto at = chunk.find('<');
        if (at == std::string_view::npos) return true;
        chunk.remove_prefix(at + 1);
        state_ = State::kBegun, begin_.clear();
        continue;
      }
      if (!take(chunk.front())) return false;
      chunk.remove_prefix(1);
    }
    return true;
  }

 private:
  enum class State { kText, kBegun, kTag, kQuoted, kSkipped };

  bool take(char c) {
    if (state_ == State::kQuoted) {
      if (c == quote_) state_ = State::kTag;
    } else if (state_ == State::kSkipped) {
      last_ = (last_ + c).substr(last_.size() < 3 ? 0 : 1);
      if (last_.ends_with(end_)) state_ = State::kText;
    } else if (state_ == State::kBegun && is_begin_of_skipped(c)) {
      // what it is will be seen with the next letters
    } else {
      state_ = State::kTag;
      if (c == '>') state_ = State::kText;
      if (c == '"' || c == '\'') state_ = State::kQuoted, quote_ = c;
      if (c == '=') return ++attributes_ <= kMostAttributes;
    }
    return true;
  }

  // True if what follows "<" may still be, or is, a comment, a CDATA section or an instruction, which have no
  // attributes.
  bool is_begin_of_skipped(char c) {
    if (begin_.empty()) attributes_ = 0;
    begin_ += c;
    for (const auto& [begin, end] :
         {std::pair<std::string_view, std::string_view>{"!--", "-->"}, {"![CDATA[", "]]>"}, {"?", "?>"}}) {
      if (begin_ == begin) state_ = State::kSkipped, end_ = end, last_.clear();
      if (begin.starts_with(begin_)) return true;
    }
    return false;
  }

  State state_ = State::kText;
  std::string begin_, last_;
  std::string_view end_;
  char quote_ = 0;
  std::size_t attributes_ = 0;
};

XmlBytes reading(InputFile input) {
  const auto file = std::make_shared<InputFile>(std::move(input));
  return [file](std::string& buffer, std::size_t most) { return file->read(buffer, most); };
}

}  // namespace

struct XmlStream::State {
  std::string name;
  XmlBytes input;
  XmlHandler& handler;
  xmlParserCtxtPtr parser = nullptr;
  XmlTag tag;                     // reused from element to element
  std::vector<std::string> open;  // names of the elements not yet closed
  std::optional<Error> error;
  bool has_root = false, at_end = false, finished = false;
  std::size_t bytes = 0, since_markup = 0;
  std::string chunk;
  AttributeCounter attributes;
  std::vector<int> namespaces;  // that each open element declares
  std::size_t all_namespaces = 0;
  std::size_t text_bytes = 0, text_pieces = 0;  // since the last tag

  State(std::string called, XmlBytes bytes_of, XmlHandler& told);
  ~State() { xmlFreeParserCtxt(parser); }

  int line() const { return parser->input ? parser->input->line : 1; }

  void fail(int at, const std::string& what) { fail(input_error("{}:{}: {}", name, at, what)); }
  void fail(const Error& what) {
    if (error) return;
    error = what;
    xmlStopParser(parser);
  }
  void accept(const Result<void>& result) {
    if (!result.ok()) fail(result.error());
  }

  // The line of a byte that the parser has passed: its own, less the line ends since then. Values that libxml2 had to
  // copy lie elsewhere; they get the line of the tag's end.
  int line_of(const xmlChar* at) const {
    const xmlChar *base = parser->input->base, *now = parser->input->cur;
    if (std::less<>()(at, base) || !std::less<>()(at, now)) return line();
    return line() - static_cast<int>(std::count(at, now, '\n'));
  }

  static State& of(void* data) { return *static_cast<State*>(data); }
  static void on_start(void* data, const xmlChar* name, const xmlChar* prefix, const xmlChar* uri, int namespaces,
                       const xmlChar** namespace_parts, int attributes, int, const xmlChar** attribute_parts);
  static void on_end(void* data, const xmlChar*, const xmlChar*, const xmlChar*);
  static void on_text(void* data, const xmlChar* text, int length);
  static void on_doctype(void* data, const xmlChar*, const xmlChar*, const xmlChar*);
  static void on_error(void*, xmlErrorPtr problem);

  Result<void> read_chunk();
};

void XmlStream::State::on_start(void* data, const xmlChar* name, const xmlChar* prefix, const xmlChar* uri,
                                int namespaces, const xmlChar** namespace_parts, int attributes, int,
                                const xmlChar** attribute_parts) {
  State& state = of(data);
  if (state.error) return;
  // A tag that was cut off is told as if it were whole, and refused afterwards.
  const xmlChar next = *state.parser->input->cur;
  if (next != '>' && next != '/') return;
  state.text_bytes = state.text_pieces = 0;
  if (state.open.size() == kDeepestXml)
    return state.fail(state.line(), fmt::format("elements are nested more than {} deep: flatten them", kDeepestXml));
  XmlTag& tag = state.tag;
  tag.name = view(name), tag.prefix = view(prefix), tag.space = view(uri), tag.line = state.line();
  tag.namespaces.clear();
  for (int i = 0; i < namespaces; ++i)
    tag.namespaces.push_back({view(namespace_parts[2 * i]), view(namespace_parts[2 * i + 1])});
  tag.attributes.clear();
  for (int i = 0; i < attributes; ++i) {
    const xmlChar** part = attribute_parts + 5 * i;  // name, prefix, namespace, begin and end of the value
    const std::string_view value(reinterpret_cast<const char*>(part[3]), static_cast<std::size_t>(part[4] - part[3]));
    tag.attributes.push_back({view(part[0]), view(part[1]), view(part[2]), value, state.line_of(part[3])});
  }
  state.open.emplace_back(tag.name);
  state.namespaces.push_back(namespaces);
  state.all_namespaces += static_cast<std::size_t>(namespaces);
  if (state.all_namespaces > kMostNamespaces)
    return state.fail(state.line(),
                      fmt::format("more than {} namespaces are declared at once: declare fewer", kMostNamespaces));
  state.has_root = true;
  state.accept(state.handler.start(tag));
}

void XmlStream::State::on_end(void* data, const xmlChar*, const xmlChar*, const xmlChar*) {
  State& state = of(data);
  if (state.error) return;
  state.open.pop_back();
  state.text_bytes = state.text_pieces = 0;
  state.all_namespaces -= static_cast<std::size_t>(state.namespaces.back());
  state.namespaces.pop_back();
  state.accept(state.handler.end(state.line()));
}

void XmlStream::State::on_text(void* data, const xmlChar* text, int length) {
  State& state = of(data);
  if (state.error) return;
  state.text_bytes += static_cast<std::size_t>(length);
  const bool too_long = ++state.text_pieces > kMostPieces || state.text_bytes > kLongestXmlToken;
  const auto taken =
      too_long
          ? Result<void>(input_error("{}:{}: one text is longer than {} bytes, or in more than {} pieces: shorten it",
                                     state.name, state.line(), kLongestXmlToken, kMostPieces))
          : state.handler.text({reinterpret_cast<const char*>(text), static_cast<std::size_t>(length)}, state.line());
  // libxml2 2.9 crashes where it is stopped within a text. What follows in this chunk is passed over.
  if (!taken.ok()) state.error = taken.error();
}

// This is called before any entity is declared.
void XmlStream::State::on_doctype(void* data, const xmlChar*, const xmlChar*, const xmlChar*) {
  State& state = of(data);
  state.fail(state.line(), "<!DOCTYPE is not accepted, nor are the entities it declares: remove it");
}

void XmlStream::State::on_error(void*, xmlErrorPtr problem) {
  if (!problem->ctxt || problem->level == XML_ERR_WARNING) return;
  State& state = of(static_cast<xmlParserCtxtPtr>(problem->ctxt)->_private);
  if (state.at_end && state.bytes == 0) return state.fail(input_error("{}: is empty: give it a document", state.name));
  if (state.at_end && !state.open.empty())
    return state.fail(state.line(), fmt::format("the file ends inside <{}>: it was cut off", state.open.back()));
  if (state.at_end && !state.has_root)
    return state.fail(state.line(), "the file ends before its first element is complete: it was cut off");
  const int code = state.has_root && state.open.empty() ? XML_ERR_DOCUMENT_END : problem->code;
  state.fail(problem->line > 0 ? problem->line : state.line(),
             explained(code, problem->message ? problem->message : ""));
}

XmlStream::State::State(std::string called, XmlBytes bytes_of, XmlHandler& told)
    : name(std::move(called)), input(std::move(bytes_of)), handler(told) {
  xmlSetGenericErrorFunc(nullptr, silence);
  xmlSAXHandler own = {};
  own.initialized = XML_SAX2_MAGIC;
  own.startElementNs = on_start;
  own.endElementNs = on_end;
  own.characters = on_text;
  own.ignorableWhitespace = on_text;
  own.cdataBlock = on_text;
  own.internalSubset = on_doctype;
  own.serror = on_error;
  parser = xmlCreatePushParserCtxt(&own, this, nullptr, 0, nullptr);
  parser->_private = this;
  xmlCtxtUseOptions(parser, XML_PARSE_NONET | XML_PARSE_NOENT);
}

// One read of the input, handed to the parser; the end of the input ends the document.
Result<void> XmlStream::State::read_chunk() {
  chunk.clear();
  GONIO_ASSIGN(const std::size_t count, input(chunk, kChunk));
  at_end = count == 0;
  bytes += count;
  const auto last_markup = chunk.rfind('<');
  since_markup = last_markup == std::string::npos ? since_markup + count : count - last_markup;
  if (since_markup > kLongestXmlToken)
    fail(line(), fmt::format("one text or attribute is longer than {} bytes: shorten it", kLongestXmlToken));
  if (!attributes.pass(chunk))
    fail(line(), fmt::format("from here on, a tag has more than {} attributes: it takes fewer", kMostAttributes));
  if (!error) xmlParseChunk(parser, chunk.data(), static_cast<int>(count), at_end);
  finished = at_end;
  if (error) return *error;
  if (at_end && !parser->wellFormed) return input_error("{}:{}: not well-formed XML", name, line());
  return {};
}

XmlStream::XmlStream(InputFile input, XmlHandler& handler) {
  std::string name = input.name();
  state_ = std::make_unique<State>(std::move(name), reading(std::move(input)), handler);
}

XmlStream::XmlStream(std::string name, XmlBytes input, XmlHandler& handler)
    : state_(std::make_unique<State>(std::move(name), std::move(input), handler)) {}

XmlStream::~XmlStream() = default;

Result<bool> XmlStream::advance() {
  if (state_->finished || state_->error) return false;
  GONIO_TRY(state_->read_chunk());
  return !state_->finished;
}

Result<void> XmlStream::finish() {
  for (bool more = true; more;) {
    GONIO_ASSIGN(more, advance());
  }
  return {};
}

std::size_t XmlStream::bytes() const {
  return state_->bytes;
}

}  // namespace goniochrome::formats
