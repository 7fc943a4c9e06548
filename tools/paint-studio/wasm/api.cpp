// The functions that the page calls. A request is written into the memory that studio_request() gives; studio_call()
// answers it; studio_answer() tells where the answer stands. Texts are UTF-8.
#include <cstdint>
#include <string>

#include "platform.h"
#include "studio/studio.h"

namespace {

std::string request_text, answer_text;

goniochrome::studio::Studio& session() {
  static auto& only = *new goniochrome::studio::Studio;
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
  const Json request = Json::parse(request_text, nullptr, false);
  Json answer = request.is_discarded() ? Json{{"error", "the request is no JSON"}} : session().answer(request);
  if (!goniochrome::studio::written_text().empty()) answer["text"] = goniochrome::studio::written_text();
  answer_text = answer.dump(-1, ' ', false, Json::error_handler_t::replace);
  return static_cast<std::uint32_t>(answer_text.size());
}

STUDIO_EXPORT(studio_answer) const char* studio_answer() {
  return answer_text.data();
}

// The weights of the paint that was fitted last, and how many there are.
STUDIO_EXPORT(studio_weights) const float* studio_weights() {
  return session().weights().data();
}
STUDIO_EXPORT(studio_weight_count) std::uint32_t studio_weight_count() {
  return static_cast<std::uint32_t>(session().weights().size());
}
