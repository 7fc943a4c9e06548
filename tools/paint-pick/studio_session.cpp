#include "studio_session.h"

#include <algorithm>
#include <optional>

#include "base/encode.h"
#include "base/file.h"
#include "base/text.h"
#include "display/paint_view.h"
#include "studio/paint_json.h"

namespace goniochrome::tool {

namespace {

// The type of a picture that every browser reads.
std::optional<std::string> browser_type(std::string_view content) {
  if (content.starts_with("\x89PNG")) return "image/png";
  if (content.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  if (content.starts_with("RIFF") && content.substr(0, 12).ends_with("WEBP")) return "image/webp";
  return std::nullopt;
}

// The file itself where a browser reads it, so that droppers find the same pixels.
Result<std::string> picture_data(const PageImage& image) {
  GONIO_ASSIGN(const std::string content, file_content(image.image.path));
  if (const auto type = browser_type(content)) return fmt::format("data:{};base64,{}", *type, base64(content));
  GONIO_ASSIGN(const std::string png, shown_png(image, 1));
  return "data:image/png;base64," + base64(png);
}

Json state_of(const PageOfPaint& paint, const std::string& title) {
  return {{"own", {{"file", "picked.paints.xml"}, {"board", title}, {"paint", studio::paint_json(paint.picked.paint)}}},
          {"steps", Json::array()}};
}

Json lab_list(const color::Lab& lab) {
  return Json::array({lab.L, lab.a, lab.b});
}

}  // namespace

Result<std::string> studio_session(const sketch::Board& board, const std::vector<PageImage>& images,
                                   const std::vector<PageOfPaint>& paints) {
  if (paints.empty()) return input_error("the board has no paint: a session begins with one");
  const std::string title = plain_utf8(board.title.empty() ? "Mood board" : board.title);
  Json pictures = Json::array(), droppers = Json::array(), palette = Json::array();
  for (const PageImage& image : images) {
    GONIO_ASSIGN(std::string data, picture_data(image));
    pictures.push_back({{"name", plain_utf8(image.image.name)}, {"data", std::move(data)}});
  }
  for (const auto& [kind, sample] : paints.front().samples) {
    const auto at =
        std::ranges::find(images, sample.dropper.image, [](const PageImage& one) { return one.image.name; });
    if (at == images.end()) continue;
    droppers.push_back({{"kind", kind},
                        {"place", Json::array({0, at - images.begin()})},
                        {"at", Json::array({sample.dropper.x, sample.dropper.y})},
                        {"radius", sample.dropper.radius},
                        {"lab", lab_list(sample.lab)},
                        {"gloss", sample.gloss},
                        {"css", display::css_color(sample.lab, *color::white_point({}))}});
  }
  for (std::size_t i = 1; i < paints.size(); ++i) palette.push_back(state_of(paints[i], title));
  const Json open_board = {{"name", title}, {"zoom", 0}, {"pictures", std::move(pictures)}};
  const Json session = {
      {"kind", "paint-studio session"},
      {"version", 1},
      {"title", title},
      {"history", {{"at", 0}, {"states", Json::array({state_of(paints.front(), title)})}}},
      {"palette", std::move(palette)},
      {"pictures",
       {{"made", 1}, {"open", 0}, {"boards", Json::array({open_board})}, {"droppers", std::move(droppers)}}}};
  return json_text(session) + "\n";
}

}  // namespace goniochrome::tool
