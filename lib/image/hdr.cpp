#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/parallel.h"
#include "base/text.h"
#include "image/hdr.h"
#include "image/internal/exr.h"

// After lines of text, ended by an empty one and "-Y height +X width", come rows of pixels: three mantissas and an
// exponent, value = mantissa 2^(exponent - 136). A row of 8 to 32767 pixels may begin 2, 2, high and low byte of its
// width; then its four components follow one after the other, each in runs: n > 128 means the next byte n - 128 times,
// n <= 128 that many bytes as they are. Other rows are plain. [Ward, the Radiance picture format]
//
// OpenImageIO reads such files as well and tells a cut one, but probes come in this format more than in any other, and
// to load that library costs far more than to read one: a picture of 256 x 128 pixels takes 290 ms of processor time
// and 123 MB with it, 4 ms and 5 MB here, and one of 2048 x 1024 takes 366 ms and 170 MB against 38 ms and 36 MB.

namespace goniochrome::image {

namespace {

constexpr std::size_t kMostRun = 127, kLeastRow = 8, kMostRow = 32767;

struct Header {
  int width = 0, height = 0;
  std::size_t end = 0;  // where the pixels begin
};

// Nothing if the file is not of the common kind.
std::optional<Header> header_of(const std::string& content) {
  std::size_t at = 0;
  const auto next_line = [&]() -> std::optional<std::string_view> {
    const std::size_t end = content.find('\n', at);
    if (end == std::string::npos) return std::nullopt;
    const std::string_view line(content.data() + at, end - at);
    at = end + 1;
    return line;
  };
  bool rgbe = false;
  for (;;) {
    const auto line = next_line();
    if (!line) return std::nullopt;
    if (line->empty()) break;
    if (line->starts_with("FORMAT=")) rgbe = *line == "FORMAT=32-bit_rle_rgbe";
    if (line->starts_with("GAMMA=") && parse_number(line->substr(6)) != 1.0) return std::nullopt;
  }
  const auto size = next_line();
  if (!rgbe || !size || !size->starts_with("-Y ")) return std::nullopt;
  const std::size_t middle = size->find(" +X ");
  if (middle == std::string_view::npos) return std::nullopt;
  const auto height = parse_integer(size->substr(3, middle - 3)), width = parse_integer(size->substr(middle + 4));
  if (!height || !width || *height < 1 || *width < 1 || *height > INT32_MAX || *width > INT32_MAX) return std::nullopt;
  return Header{static_cast<int>(*width), static_cast<int>(*height), at};
}

// Walks over the rows of a file, and then decodes each.
class Rows {
 public:
  Rows(const std::string& content, std::size_t width)
      : bytes_(reinterpret_cast<const std::uint8_t*>(content.data())), size_(content.size()), width_(width) {
    for (int e = 1; e < 256; ++e) scale_[static_cast<std::size_t>(e)] = std::ldexp(1.0F, e - 136);
  }

  // Where the row that begins at `at` ends, or nothing where it does not end well.
  std::optional<std::size_t> end(std::size_t at) const {
    if (!in_runs(at)) return plain_end(at);
    at += 4;
    for (int component = 0; component < 4; ++component)
      for (std::size_t done = 0; done < width_;) {
        if (at >= size_ || bytes_[at] == 0) return std::nullopt;
        const bool run = bytes_[at] > 128;
        const std::size_t count = run ? bytes_[at] - 128U : bytes_[at];
        done += count;
        at += 1 + (run ? 1 : count);
        if (done > width_ || at > size_) return std::nullopt;
      }
    return at;
  }

  // Decodes a row that end() has found to be right.
  void decode(std::size_t at, std::vector<std::uint8_t>& scratch, float* rgb) const {
    const bool runs = in_runs(at);
    if (runs) unpack(at + 4, scratch);
    const std::uint8_t* from = runs ? scratch.data() : bytes_ + at;
    const std::size_t component = runs ? width_ : 1, pixel = runs ? 1 : 4;
    for (std::size_t i = 0; i < width_; ++i, from += pixel, rgb += 3) {
      const float scale = scale_[from[3 * component]];
      for (std::size_t c = 0; c < 3; ++c) rgb[c] = scale * static_cast<float>(from[c * component]);
    }
  }

 private:
  // In files from the format's first years a pixel 1, 1, 1, n repeats the pixel before it. No other pixel has mantissas
  // that are all below 128.
  std::optional<std::size_t> plain_end(std::size_t at) const {
    const std::size_t end = at + 4 * width_;
    if (end > size_) return std::nullopt;
    for (; at < end; at += 4)
      if (bytes_[at] == 1 && bytes_[at + 1] == 1 && bytes_[at + 2] == 1) return std::nullopt;
    return end;
  }

  bool in_runs(std::size_t at) const {
    return width_ >= kLeastRow && width_ <= kMostRow && at + 4 <= size_ && bytes_[at] == 2 && bytes_[at + 1] == 2 &&
           (bytes_[at + 2] << 8 | bytes_[at + 3]) == static_cast<int>(width_);
  }

  void unpack(std::size_t at, std::vector<std::uint8_t>& row) const {
    row.clear();
    while (row.size() < 4 * width_) {
      const std::uint8_t count = bytes_[at++];
      if (count > 128)
        row.insert(row.end(), count - 128U, bytes_[at++]);
      else
        row.insert(row.end(), bytes_ + at, bytes_ + at + count), at += count;
    }
  }

  const std::uint8_t* bytes_;
  std::size_t size_, width_;
  std::array<float, 256> scale_ = {};  // of each exponent; 0 is black
};

}  // namespace

bool is_radiance(std::string_view head) {
  return head.substr(0, 2) == "#?";
}

Result<std::optional<ImagePart>> decoded_hdr(const std::string& content, const std::string& name) {
  const auto header = header_of(content);
  if (!header) return std::optional<ImagePart>();
  const std::size_t width = static_cast<std::size_t>(header->width), height = static_cast<std::size_t>(header->height);
  // A forged size must not ask for more than the bytes can stand for: the shortest row is all runs.
  const std::size_t least = std::min(4 * width, 4 + 8 * ((width + kMostRun - 1) / kMostRun));
  if (width * height > kMostSamples / 3 || (content.size() - header->end) / least < height)
    return input_error(
        "{}: is cut short: its header says {} x {} pixels, and {} bytes of them are there: fetch it again", name, width,
        height, content.size() - header->end);
  const Rows rows(content, width);
  std::vector<std::size_t> start = {header->end};
  for (std::size_t y = 0; y < height; ++y) {
    const auto end = rows.end(start.back());
    if (!end) return input_error("{}: row {} is cut short or damaged: fetch the file again", name, y);
    start.push_back(*end);
  }
  std::optional<ImagePart> part(std::in_place);
  part->type = PixelType::kFloat;
  part->image = {header->width, header->height, 3, std::vector<float>(3 * width * height), {"R", "G", "B"}};
  part->attributes["oiio:ColorSpace"] = std::string("linear");
  part->attributes["goniochrome:integer"] = 0;
  parallel_for(height, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> scratch;
    for (std::size_t y = begin; y < end; ++y) rows.decode(start[y], scratch, &part->image.data[3 * width * y]);
  });
  return part;
}

}  // namespace goniochrome::image
