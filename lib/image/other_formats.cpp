#include "image/internal/other_formats.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include "base/file.h"
#include "base/paths.h"
#include "base/text.h"
#include "image/exr.h"
#include "image/internal/content_format.h"

extern char** environ;

namespace goniochrome::image {

namespace {

constexpr const char* kProgram = "oiiotool";

// A folder of temporary files, which goes with this object.
class Scratch {
 public:
  Scratch() {
    const char* place = std::getenv("TMPDIR");
    path_ = std::string(place && *place ? place : "/tmp") + "/goniochrome-XXXXXX";
    if (!mkdtemp(path_.data())) path_.clear();
  }
  Scratch(const Scratch&) = delete;
  ~Scratch() {
    for (const std::string& file : files_) unlink(file.c_str());
    if (!path_.empty()) rmdir(path_.c_str());
  }
  bool is_there() const { return !path_.empty(); }
  std::string file(const std::string& name) {
    files_.push_back(path_ + "/" + name);
    return files_.back();
  }

 private:
  std::string path_;
  std::vector<std::string> files_;
};

// pip lays the program beside this one, and the folder need not be on the PATH.
std::string program_path() {
  const std::filesystem::path self = link_target("/proc/self/exe").value_or("");
  const std::string beside = (self.parent_path() / kProgram).string();
  return is_there(beside) ? beside : kProgram;
}

// Runs the program and waits for its end; its messages go into `words`. Returns its status, or nothing where it cannot
// be started.
std::optional<int> run(std::vector<std::string> arguments, const std::string& words, int processor_s) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, words.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed) return std::nullopt;
  const rlimit limit{static_cast<rlim_t>(processor_s), static_cast<rlim_t>(processor_s + 2)};
  prlimit(child, RLIMIT_CPU, &limit, nullptr);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return std::nullopt;
  return status;
}

// The text between the quotes behind `key: ` in the list of attributes that the program prints; "" where there is none.
std::string listed(std::string_view words, const std::string& key) {
  const std::string head = " " + key + ": \"";
  const std::size_t at = words.find(head);
  if (at == std::string_view::npos) return "";
  words.remove_prefix(at + head.size());
  return std::string(words.substr(0, words.find('"')));
}

// The reason among the words of a program that failed: its first error.
std::string reason_in(std::string_view words) {
  const std::size_t at = words.find("ERROR: ");
  if (at == std::string_view::npos) return "oiiotool gave up on it";
  words.remove_prefix(at + 7);
  return shown(words.substr(0, words.find('\n')));
}

void drop_alpha(Image& image) {
  for (std::size_t i = 0; i < image.data.size() / 4; ++i) std::copy_n(&image.data[4 * i], 3, &image.data[3 * i]);
  image.data.resize(image.data.size() / 4 * 3);
  image.channels = 3, image.channel_names = {"R", "G", "B"};
}

void associate_alpha(Image& image) {
  for (std::size_t i = 0; i < image.data.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c) image.data[i + c] *= image.data[i + 3];
}

}  // namespace

Result<ImagePart> decoded_by_oiiotool(const std::string& content, const std::string& format, const std::string& name) {
  if (const std::string misread = misread_colors(content, format); !misread.empty())
    return input_error("{}: {}", name, misread);
  Scratch scratch;
  if (!scratch.is_there())
    return input_error("{}: no temporary folder can be made ({}): set TMPDIR", name, std::strerror(errno));
  // The program knows a format by the ending.
  const std::string in = scratch.file("in." + (format == "targa" ? "tga" : format)), out = scratch.file("out.exr"),
                    words = scratch.file("words");
  GONIO_TRY(write_file(in, content));
  std::vector<std::string> command = {program_path(), "--threads", "1", "--nosoftwareattrib"};
  // Some versions hear the EXIF of a WebP file and others do not: exif_orientation() does in all of them.
  if (format != "webp") command.emplace_back("--autoorient");
  // A false alpha of 0 would make the picture black.
  const bool false_alpha = !has_alpha(content, format);
  if (false_alpha || format == "bmp")
    for (const char* word : {"--iconfig", "oiio:UnassociatedAlpha", "1"}) command.emplace_back(word);
  for (const char* word : {"--info", "-v"}) command.emplace_back(word);
  command.push_back(in);
  for (const char* word : {"-d", "float", "--compression", "none", "-o"}) command.emplace_back(word);
  command.push_back(out);
  const auto status = run(std::move(command), words, 60 + static_cast<int>(content.size() >> 20));
  // A shell says by 127 that it found no program, and so does posix_spawn() in some C libraries.
  if (!status || (WIFEXITED(*status) && WEXITSTATUS(*status) == 127))
    return input_error(
        "{}: is a picture of the format {}, which OpenImageIO reads, and its program oiiotool is not installed: "
        "install "
        "openimageio-tools, or OpenImageIO by pip, or convert the image to EXR, PNG or TIFF",
        name, upper(format));
  const auto said = file_content(words);
  if (*status != 0)
    return input_error("{}: cannot be read as an image: {}", name, reason_in(said.ok() ? said.value() : ""));
  GONIO_ASSIGN(auto parts, decoded_exr(file_content(out).value(), name));
  ImagePart part = std::move(parts.front());
  part.name.clear(), part.attributes.clear();
  if (part.image.channels == 4 && false_alpha) drop_alpha(part.image);
  if (part.image.channels == 4 && format == "bmp") associate_alpha(part.image);
  std::string space = listed(said.value(), "oiio:ColorSpace");
  // OpenImageIO names no color space for the densities of film, which are logarithms as KodakLog is, for depths, and
  // where the file does not tell; and none for the primaries of older television.
  const std::string transfer = listed(said.value(), "dpx:Transfer"),
                    primaries = listed(said.value(), "dpx:Colorimetric");
  for (const std::string_view other :
       {"Printing density", "ADX", "Z depth linear", "Z depth homogeneous", "User defined", "Undefined"})
    if (transfer == other) space = transfer;
  for (const std::string_view other :
       {"ITU-R 601-5 system B or G", "ITU-R 601-5 system M", "NTSC composite video", "PAL composite video"})
    if (primaries == other) space = primaries;
  if (!space.empty()) part.attributes["oiio:ColorSpace"] = space;
  part.attributes["goniochrome:integer"] = said->find(" channel, float ") == std::string::npos ? 1 : 0;
  return part;
}

}  // namespace goniochrome::image
