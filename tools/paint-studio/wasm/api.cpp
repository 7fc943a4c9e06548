// The functions that the page calls. A request is written into the memory that studio_request() gives; studio_call()
// answers it; studio_answer() tells where the answer stands. Texts are UTF-8.
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "platform.h"
#include "studio/studio.h"

// Hears which part of a long request is done.
extern "C" __attribute__((import_module("page"), import_name("progress"))) void page_progress(double part);

namespace {

std::string request_text, answer_text;

goniochrome::studio::Studio& session() {
  static auto& only = []() -> auto& {
    auto& made = *new goniochrome::studio::Studio;
    made.progress() = page_progress;
    return made;
  }();
  return only;
}

}  // namespace

#define STUDIO_EXPORT(name) extern "C" __attribute__((export_name(#name)))

// Memory for a request of that many bytes.
STUDIO_EXPORT(studio_request) char* studio_request(std::uint32_t bytes) {
  request_text.assign(bytes, ' ');
  return request_text.data();
}

// The number of bytes of the answer.
STUDIO_EXPORT(studio_call) std::uint32_t studio_call() {
  using goniochrome::Json;
  goniochrome::studio::written_text().clear();
  const Json request = goniochrome::parse_json(request_text);
  Json answer = request.is_discarded() ? Json{{"error", "the request is no JSON"}} : session().answer(request);
  if (!goniochrome::studio::written_text().empty()) answer["text"] = goniochrome::studio::written_text();
  answer_text = goniochrome::json_text(answer);
  return static_cast<std::uint32_t>(answer_text.size());
}

STUDIO_EXPORT(studio_answer) const char* studio_answer() {
  return answer_text.data();
}

// Memory for that many bytes, which the request "load" or "view" or studio_give() then takes.
STUDIO_EXPORT(studio_attach) char* studio_attach(std::uint32_t bytes) {
  std::string& attached = session().attached();
  attached.resize(bytes);
  return attached.data();
}

// Makes the attached bytes a file, whose name is what was written as a request; takes all files away where it is empty.
STUDIO_EXPORT(studio_give) void studio_give() {
  auto& files = goniochrome::studio::given_files();
  if (request_text.empty()) return files.clear();
  files[request_text] = std::exchange(session().attached(), {});
}

// Memory for the events of an XML text, see platform_xml.cpp.
STUDIO_EXPORT(studio_events) char* studio_events(std::uint32_t bytes) {
  std::string& text = goniochrome::studio::event_text();
  text.resize(bytes);
  return text.data();
}

// A list that an answer filled, by its number in Studio::List, and its size in bytes.
STUDIO_EXPORT(studio_list) const std::byte* studio_list(std::uint32_t which) {
  return session().list(static_cast<goniochrome::studio::Studio::List>(which)).data();
}
STUDIO_EXPORT(studio_list_bytes) std::uint32_t studio_list_bytes(std::uint32_t which) {
  return static_cast<std::uint32_t>(session().list(static_cast<goniochrome::studio::Studio::List>(which)).size());
}
