// XML by the parser of the browser: the page turns a text into events, and they are told here. CMake compiles this file
// in the place of formats/internal/xml_stream.cpp.
#include <utility>

#include "base/text.h"
#include "formats/internal/xml_stream.h"
#include "platform.h"

// Fills event_text() with the events of a text, each field behind it closed by a zero byte:
//   <  line name prefix space, the number of namespaces, prefix and uri of each, the number of attributes, and name,
//      prefix, space, value and line of each
//   t  line text
//   /  line
//   !  line and what is wrong, in the place of all others
extern "C" __attribute__((import_module("page"), import_name("xml_events"))) void page_xml_events(const char* text,
                                                                                                  std::size_t bytes);

namespace goniochrome {

std::string& studio::event_text() {
  static auto& text = *new std::string;
  return text;
}

namespace formats {

struct XmlStream::State {
  std::string name;
  XmlBytes input;
  XmlHandler& handler;
  std::string events;
  std::size_t at = 0, bytes = 0;
  bool is_parsed = false;

  std::string_view field() {
    const std::size_t begin = at, end = std::min(events.find('\0', begin), events.size());
    at = end + 1;
    return std::string_view(events).substr(begin, end - begin);
  }
  int number() { return static_cast<int>(parse_integer(field()).value_or(0)); }

  Result<void> parse() {
    is_parsed = true;
    std::string text;
    for (std::size_t count = 1; count > 0;) {
      GONIO_ASSIGN(count, input(text, std::size_t{1} << 20));
    }
    bytes = text.size();
    if (text.empty()) return input_error("{}: is empty: give it a document", name);
    page_xml_events(text.data(), text.size());
    events = std::exchange(studio::event_text(), {});
    return {};
  }
  Result<void> start() {
    XmlTag tag;
    tag.line = number();
    tag.name = field(), tag.prefix = field(), tag.space = field();
    for (int count = number(); count > 0; --count) {
      const std::string_view prefix = field();
      tag.namespaces.push_back({prefix, field()});
    }
    for (int count = number(); count > 0; --count) {
      XmlAttribute attribute;
      attribute.name = field(), attribute.prefix = field(), attribute.space = field(), attribute.value = field();
      attribute.line = number();
      tag.attributes.push_back(attribute);
    }
    return handler.start(tag);
  }
  Result<void> tell() {
    const std::string_view kind = field();
    if (kind == "<") return start();
    const int line = number();
    if (kind == "t") return handler.text(field(), line);
    if (kind == "/") return handler.end(line);
    return input_error("{}:{}: {}", name, line, field());
  }
};

XmlStream::XmlStream(InputFile input, XmlHandler& handler) {
  std::string name = input.name();
  const auto file = std::make_shared<InputFile>(std::move(input));
  state_ = std::make_unique<State>(
      std::move(name), [file](std::string& buffer, std::size_t most) { return file->read(buffer, most); }, handler);
}
XmlStream::XmlStream(std::string name, XmlBytes input, XmlHandler& handler)
    : state_(std::make_unique<State>(std::move(name), std::move(input), handler)) {}
XmlStream::~XmlStream() = default;

// One event at a time.
Result<bool> XmlStream::advance() {
  State& state = *state_;
  if (!state.is_parsed) GONIO_TRY(state.parse());
  if (state.at >= state.events.size()) return false;
  const auto told = state.tell();
  if (told.ok()) return state.at < state.events.size();
  state.at = state.events.size();
  return told.error();
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

}  // namespace formats
}  // namespace goniochrome
