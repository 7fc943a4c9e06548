#include <algorithm>
#include <filesystem>

#include "base/file.h"
#include "base/text.h"
#include "sketch/pick.h"

namespace goniochrome::sketch {

namespace {

// One board as it is read line by line.
class BoardReader {
 public:
  explicit BoardReader(const std::string& path) : path_(path), folder_(std::filesystem::path(path).parent_path()) {}

  Result<Board> read(const std::string& content) {
    for (const std::string_view text : split(content, '\n')) {
      ++line_;
      const std::string_view stated = trimmed(text);
      if (stated.empty() || stated.front() == '#') continue;
      const auto space = stated.find_first_of(" \t");
      const std::string word(stated.substr(0, space));
      const std::string rest(space == std::string_view::npos ? "" : trimmed(stated.substr(space)));
      GONIO_TRY(take(word, rest));
    }
    if (board_.paints.empty())
      return input_error("{}: has no paint: add a line \"paint NAME\" and its droppers", path_);
    for (const PaintPick& paint : board_.paints)
      if (!paint.face && !paint.flop)
        return input_error("{}: the paint {} has neither face nor flop: add a line \"face IMAGE@x,y\"", path_,
                           paint.name);
    return board_;
  }

 private:
  template <class... Args>
  Error error(fmt::format_string<Args...> text, Args&&... args) const {
    return input_error("{}:{}: {}", path_, line_, fmt::format(text, std::forward<Args>(args)...));
  }

  Result<void> take(const std::string& word, const std::string& rest) {
    const bool alone = word == "retro";
    if (alone && !rest.empty()) return error("\"retro\" stands alone");
    if (!alone && rest.empty()) return error("\"{}\" lacks what it says", word);
    if (word == "title") return void(board_.title = rest), Result<void>();
    if (word == "image") return take_image(rest);
    if (word == "paint") return take_paint(rest);
    constexpr const char* kOfPaint[] = {"face", "flop", "gloss", "travel", "retro"};
    if (std::find(std::begin(kOfPaint), std::end(kOfPaint), word) == std::end(kOfPaint))
      return error("\"{}\" is none of title, image, paint, face, flop, gloss, travel, retro", word);
    if (board_.paints.empty()) return error("\"{}\" belongs below a line \"paint NAME\"", word);
    PaintPick& paint = board_.paints.back();
    if (word == "retro") return void(paint.retro = true), Result<void>();
    if (word == "travel") return take_travel(rest, paint);
    return take_dropper(word, rest, word == "face" ? paint.face : word == "flop" ? paint.flop : paint.gloss);
  }

  Result<void> take_image(const std::string& rest) {
    const auto space = rest.find_first_of(" \t");
    if (space == std::string::npos) return error("image is \"{}\": write image NAME PATH", rest);
    const std::string name = rest.substr(0, space);
    if (find_image(name)) return error("there are two images named {}", name);
    const std::filesystem::path file(std::string(trimmed(std::string_view(rest).substr(space))));
    board_.images.push_back({name, file.is_absolute() ? file.string() : (folder_ / file).string()});
    return {};
  }

  Result<void> take_paint(const std::string& name) {
    const bool known =
        std::any_of(board_.paints.begin(), board_.paints.end(), [&](const auto& p) { return p.name == name; });
    if (known) return error("there are two paints named {}", name);
    board_.paints.push_back({});
    board_.paints.back().name = name;
    return {};
  }

  Result<void> take_travel(const std::string& rest, PaintPick& paint) {
    const auto travel = parse_number(rest);
    if (!travel || *travel <= 15 || *travel > 180)
      return error("travel is \"{}\": it lies above 15 and up to 180 degrees", rest);
    paint.travel_deg = *travel;
    return {};
  }

  Result<void> take_dropper(const std::string& word, const std::string& rest, std::optional<Dropper>& to) {
    if (to) return error("the paint {} has two droppers for its {}", board_.paints.back().name, word);
    const auto dropper = parse_dropper(rest, word);
    if (!dropper.ok()) return error("{}", dropper.error().message);
    if (!find_image(dropper->image))
      return error("{} names the image \"{}\", which no line \"image NAME PATH\" above has", word, dropper->image);
    to = *dropper;
    return {};
  }

  bool find_image(const std::string& name) const {
    return std::any_of(board_.images.begin(), board_.images.end(),
                       [&](const auto& image) { return image.name == name; });
  }

  std::string path_;
  std::filesystem::path folder_;
  int line_ = 0;
  Board board_;
};

}  // namespace

Result<Board> read_board(const std::string& path) {
  GONIO_ASSIGN(const std::string content, file_content(path));
  return BoardReader(path).read(content);
}

}  // namespace goniochrome::sketch
