#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/parallel.h"
#include "base/text.h"
#include "image/hdr.h"
#include "image/internal/exr.h"
#include "image/internal/turn.h"

// After lines of text, ended by an empty one and by a line such as "-Y height +X width", come rows of pixels: three
// mantissas and an exponent, value = mantissa 2^(exponent - 136). A row of 8 to 32767 pixels may begin 2, 2, high and
// low byte of its width; then its four components follow one after the other, each in runs: n > 128 means the next byte
// n - 128 times, n <= 128 that many bytes as they are. Other rows are plain, or in the runs of the format's first
// years: a pixel 1, 1, 1, n repeats the one before it n times, and a second one right behind it 256 n times, and so on.
// The lines of text say what was done to the values. [Ward, Radiance File Formats, Picture File Format]
//
// OpenImageIO reads such files as well and tells a cut one, but probes come in this format more than in any other, and
// to load that library costs far more than to read one: a picture of 256 x 128 pixels takes 290 ms of processor time
// and 123 MB with it, 4 ms and 5 MB here, and one of 2048 x 1024 takes 366 ms and 170 MB against 38 ms and 36 MB. Of
// what the lines say it leaves out the primaries, the exposure, the color correction and the order of the rows.

namespace goniochrome::image {

namespace {

constexpr std::size_t kMostRun = 127, kLeastRow = 8, kMostRow = 32767;

struct Header {
  int width = 0, rows = 0;  // of stored rows
  Turn turn;
  std::array<double, 3> gain = {1, 1, 1};  // of all EXPOSURE and COLORCORR lines
  std::optional<std::vector<float>> chromaticities;
  double gamma = 1;
  std::string view;     // of the last VIEW line
  std::size_t end = 0;  // where the pixels begin
};

// The numbers behind a keyword; none where they are not `count` finite numbers.
std::vector<double> numbers_of(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string_view word : split(text, ' ')) {
    if (trimmed(word).empty()) continue;
    const auto number = parse_number(trimmed(word));
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers.size() == count ? numbers : std::vector<double>();
}

// The lines before the pixels of a file.
class HeaderReader {
 public:
  HeaderReader(const std::string& content, const std::string& name) : content_(content), name_(name) {}

  Result<Header> header() {
    for (;;) {
      GONIO_ASSIGN(const std::string_view line, next_line());
      if (line.empty()) break;
      GONIO_TRY(take(line));
    }
    GONIO_ASSIGN(const std::string_view size, next_line());
    GONIO_TRY(take_size(size));
    header_.end = at_;
    return header_;
  }

 private:
  Result<std::string_view> next_line() {
    const std::size_t end = content_.find('\n', at_);
    if (end == std::string::npos) return input_error("{}: its header does not end: fetch it again", name_);
    std::string_view line(content_.data() + at_, end - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = end + 1;
    ++line_;
    return line;
  }

  Error refused(std::string_view line, const char* remedy) const {
    return input_error("{}:{}: \"{}\": {}", name_, line_, shown(line), remedy);
  }

  Result<void> take(std::string_view line) {
    const auto behind = [&](std::string_view keyword) -> std::optional<std::string_view> {
      if (!line.starts_with(keyword)) return std::nullopt;
      return trimmed(line.substr(keyword.size()));
    };
    if (const auto format = behind("FORMAT=")) {
      if (*format == "32-bit_rle_xyze") {
        header_.chromaticities = {1, 0, 0, 1, 0, 0, 1.0F / 3, 1.0F / 3};
        xyze_ = true;
      } else if (*format != "32-bit_rle_rgbe") {
        return refused(line, "32-bit_rle_rgbe and 32-bit_rle_xyze are read: convert it");
      }
    }
    if (const auto text = behind("EXPOSURE=")) {
      const auto number = numbers_of(*text, 1);
      if (number.empty() || !(number[0] > 0)) return refused(line, "write one number above 0");
      for (double& gain : header_.gain) gain *= number[0];
    }
    if (const auto text = behind("COLORCORR=")) {
      const auto number = numbers_of(*text, 3);
      if (number.empty() || !(std::ranges::min(number) > 0)) return refused(line, "write three numbers above 0");
      for (std::size_t c = 0; c < 3; ++c) header_.gain[c] *= number[c];
    }
    if (const auto text = behind("PRIMARIES=")) {
      const auto number = numbers_of(*text, 8);
      if (number.empty()) return refused(line, "write x and y of red, green, blue and white");
      // Some writers state eight zeros for primaries that they do not know.
      const bool stated = std::ranges::any_of(number, [](double value) { return value != 0; });
      if (!xyze_ && stated) header_.chromaticities.emplace(number.begin(), number.end());
    }
    if (const auto text = behind("VIEW=")) header_.view = *text;
    if (const auto text = behind("GAMMA=")) {
      const auto number = numbers_of(*text, 1);
      if (number.empty() || !(number[0] > 0)) return refused(line, "write one number above 0");
      header_.gamma = number[0];
    }
    return {};
  }

  // "-Y height +X width": the direction and the number of the rows, and then those of the pixels of a row. Y grows
  // upward and X to the right; where X comes first, rows are columns.
  Result<void> take_size(std::string_view line) {
    std::vector<std::string_view> words;
    for (const std::string_view word : split(line, ' '))
      if (!word.empty()) words.push_back(word);
    const auto is_axis = [](std::string_view word, char axis) {
      return word.size() == 2 && (word[0] == '+' || word[0] == '-') && word[1] == axis;
    };
    const bool y_first = words.size() == 4 && is_axis(words[0], 'Y') && is_axis(words[2], 'X');
    const bool x_first = words.size() == 4 && is_axis(words[0], 'X') && is_axis(words[2], 'Y');
    const auto rows = words.size() == 4 ? parse_integer(words[1]) : std::nullopt;
    const auto width = words.size() == 4 ? parse_integer(words[3]) : std::nullopt;
    if ((!y_first && !x_first) || !rows || !width || *rows < 1 || *width < 1 || *rows > INT32_MAX || *width > INT32_MAX)
      return refused(line, "a line such as \"-Y 512 +X 1024\" is to tell the size");
    header_.rows = static_cast<int>(*rows), header_.width = static_cast<int>(*width);
    const std::string_view x = words[x_first ? 0 : 2], y = words[x_first ? 2 : 0];
    header_.turn = {x_first, x[0] == '-', y[0] == '+'};
    return {};
  }

  const std::string& content_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 0;
  bool xyze_ = false;
  Header header_;
};

// Walks over the rows of a file, and then decodes each.
class Rows {
 public:
  Rows(const std::string& content, std::size_t width)
      : bytes_(reinterpret_cast<const std::uint8_t*>(content.data())), size_(content.size()), width_(width) {
    for (int e = 1; e < 256; ++e) scale_[static_cast<std::size_t>(e)] = std::ldexp(1.0F, e - 136);
  }

  // Where the row that begins at `at` ends, or nothing where it does not end well.
  std::optional<std::size_t> end(std::size_t at) const {
    if (!in_runs(at)) return pixels_end(at);
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
    if (!runs) return decode_pixels(at, rgb);
    unpack(at + 4, scratch);
    for (std::size_t i = 0; i < width_; ++i, rgb += 3)
      put(scratch[i], scratch[width_ + i], scratch[2 * width_ + i], scratch[3 * width_ + i], rgb);
  }

 private:
  void put(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t exponent, float* rgb) const {
    const float scale = scale_[exponent];
    rgb[0] = scale * static_cast<float>(r), rgb[1] = scale * static_cast<float>(g);
    rgb[2] = scale * static_cast<float>(b);
  }

  // True if a pixel repeats the one before it. No other pixel has mantissas that are all below 128.
  bool repeats(std::size_t at) const { return bytes_[at] == 1 && bytes_[at + 1] == 1 && bytes_[at + 2] == 1; }

  std::optional<std::size_t> pixels_end(std::size_t at) const {
    std::size_t done = 0;
    for (int shift = 0; done < width_; at += 4) {
      if (size_ - at < 4) return std::nullopt;
      if (repeats(at)) {
        if (done == 0 || shift > 16) return std::nullopt;
        done += std::size_t{bytes_[at + 3]} << shift;
        shift += 8;
      } else {
        ++done, shift = 0;
      }
    }
    if (done != width_) return std::nullopt;
    return at;
  }

  void decode_pixels(std::size_t at, float* rgb) const {
    int shift = 0;
    for (std::size_t done = 0; done < width_; at += 4) {
      if (!repeats(at)) {
        put(bytes_[at], bytes_[at + 1], bytes_[at + 2], bytes_[at + 3], rgb + 3 * done++);
        shift = 0;
        continue;
      }
      for (std::size_t left = std::size_t{bytes_[at + 3]} << shift; left > 0; --left, ++done)
        std::copy_n(rgb + 3 * (done - 1), 3, rgb + 3 * done);
      shift += 8;
    }
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

Result<ImagePart> decoded_hdr(const std::string& content, const std::string& name) {
  GONIO_ASSIGN(const Header header, HeaderReader(content, name).header());
  const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.rows);
  // A forged size must not ask for more than the bytes can stand for: the shortest row is a pixel that another
  // repeats, or all runs.
  const std::size_t least = std::min({4 * width, std::size_t{8}, 4 + 8 * ((width + kMostRun - 1) / kMostRun)});
  if (width * height > kMostSamples / 3 || (content.size() - header.end) / least < height)
    return input_error(
        "{}: is cut short: its header says {} x {} pixels, and {} bytes of them are there: fetch it again", name, width,
        height, content.size() - header.end);
  const Rows rows(content, width);
  std::vector<std::size_t> start = {header.end};
  for (std::size_t y = 0; y < height; ++y) {
    const auto end = rows.end(start.back());
    if (!end) return input_error("{}: row {} is cut short or damaged: fetch the file again", name, y);
    start.push_back(*end);
  }
  ImagePart part;
  part.type = PixelType::kFloat;
  part.image = {header.width, header.rows, 3, std::vector<float>(3 * width * height), {"R", "G", "B"}};
  part.attributes["oiio:ColorSpace"] =
      header.gamma == 1 ? std::string("linear") : "GammaCorrected" + shortest(header.gamma);
  part.attributes["goniochrome:integer"] = 0;
  if (!header.view.empty()) part.attributes["radiance:VIEW"] = header.view;
  if (header.chromaticities) part.attributes["chromaticities"] = *header.chromaticities;
  const bool is_changed = header.gain != std::array<double, 3>{1, 1, 1};
  parallel_for(height, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> scratch;
    for (std::size_t y = begin; y < end; ++y) {
      float* rgb = &part.image.data[3 * width * y];
      rows.decode(start[y], scratch, rgb);
      for (std::size_t i = 0; is_changed && i < 3 * width; ++i)
        rgb[i] = static_cast<float>(rgb[i] / header.gain[i % 3]);
    }
  });
  const auto is_finite = [](float value) { return std::isfinite(value); };
  if (is_changed && !std::ranges::all_of(part.image.data, is_finite))
    return input_error("{}: divided by its EXPOSURE and COLORCORR, a pixel is too large for a float: mend these lines",
                       name);
  if (header.turn.any())
    part.image.data = upright(part.image.data, part.image.width, part.image.height, 3, header.turn);
  return part;
}

}  // namespace goniochrome::image
