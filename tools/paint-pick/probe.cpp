#include "probe.h"

#include "base/file.h"
#include "base/text.h"
#include "paint_stream.h"
#include "sketch/probe.h"
#include "table_output.h"

namespace goniochrome::tool {

namespace {

constexpr const char* kHead = "x\ty\tpart\tmaterial\taspecular_deg\tview_deg\tnormal\trgb\tL\ta\tb\n";

struct Pixel {
  int x = 0, y = 0;
};

// "X,Y". `where` begins the error.
Result<Pixel> pixel_of(std::string_view text, const std::string& where) {
  const auto pieces = split(text, ',');
  if (pieces.size() == 2) {
    const auto x = parse_integer(trimmed(pieces[0])), y = parse_integer(trimmed(pieces[1]));
    constexpr std::int64_t kMost = 1 << 20;
    if (x && y && std::abs(*x) < kMost && std::abs(*y) < kMost)
      return Pixel{static_cast<int>(*x), static_cast<int>(*y)};
  }
  return usage_error("{} is \"{}\": write X,Y, in pixels from the upper left", where, shown(text));
}

std::string list(const std::vector<double>& values, int digits) {
  std::string text;
  for (const double value : values) text += fmt::format("{}{:.{}f}", text.empty() ? "" : ";", value, digits);
  return text;
}

std::string row(const sketch::Probe& p) {
  const std::string angles = p.on_mesh ? list(p.aspecular_deg, 3) + "\t" + fmt::format("{:.3f}", p.view_deg) + "\t" +
                                             list({p.normal.x, p.normal.y, p.normal.z}, 5)
                                       : "\t\t";
  return fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{:.3f}\t{:.3f}\t{:.3f}\n", p.x, p.y, table_field(p.part),
                     table_field(p.material), angles, list({p.rgb.x, p.rgb.y, p.rgb.z}, 6), p.lab.L, p.lab.a, p.lab.b);
}

// Writes a row for each pixel as soon as it is asked for.
class Probing {
 public:
  Probing(const image::AovFile& file, OutputFile out, cli::Session& session)
      : file_(file), out_(std::move(out)), session_(session) {
    session.begin_list("probes");
  }

  Result<void> begin() { return out_.write(kHead); }

  Result<void> take(std::string_view text, const std::string& where) {
    GONIO_ASSIGN(const Pixel pixel, pixel_of(text, where));
    GONIO_ASSIGN(const sketch::Probe found, sketch::probe(file_, pixel.x, pixel.y));
    session_.add("probes", [&] {
      return Json{{"x", found.x},
                  {"y", found.y},
                  {"part", found.on_mesh ? Json(found.part) : Json(nullptr)},
                  {"material", found.on_mesh ? Json(found.material) : Json(nullptr)},
                  {"aspecular_deg", found.aspecular_deg},
                  {"view_deg", found.on_mesh ? Json(found.view_deg) : Json(nullptr)},
                  {"normal", found.on_mesh ? Json{found.normal.x, found.normal.y, found.normal.z} : Json(nullptr)},
                  {"rgb", {found.rgb.x, found.rgb.y, found.rgb.z}},
                  {"lab", lab_json(found.lab)}};
    });
    GONIO_TRY(out_.write(row(found)));
    return out_.flush();
  }

  // A pixel in each line of standard input, as they come.
  Result<void> take_lines() {
    GONIO_ASSIGN(InputFile in, InputFile::open("-"));
    std::string buffer;
    int number = 0;
    for (bool more = true; more;) {
      GONIO_ASSIGN(const std::size_t count, in.read(buffer, 1 << 16));
      more = count > 0;
      if (!more && !buffer.empty() && buffer.back() != '\n') buffer += '\n';
      std::size_t begin = 0;
      for (std::size_t end = buffer.find('\n'); end != std::string::npos; end = buffer.find('\n', begin)) {
        const std::string_view line = trimmed(std::string_view(buffer).substr(begin, end - begin));
        begin = end + 1, ++number;
        if (!line.empty()) GONIO_TRY(take(line, fmt::format("standard input:{}", number)));
      }
      buffer.erase(0, begin);
    }
    return {};
  }

  Result<void> finish() { return out_.commit(); }

 private:
  const image::AovFile& file_;
  OutputFile out_;
  cli::Session& session_;
};

}  // namespace

Result<cli::Verdict> run_probe(const Options& options, cli::Session& session) {
  if (options.images.empty()) return usage_error("--probe takes a picture with buffers: name one");
  GONIO_ASSIGN(const image::AovFile file, image::read_aov_file(options.images.front()));
  GONIO_ASSIGN(OutputFile out, OutputFile::create(options.output));
  Probing probing(file, std::move(out), session);
  GONIO_TRY(probing.begin());
  for (const std::string& text : options.probes) {
    if (text == "-") {
      GONIO_TRY(probing.take_lines());
    } else {
      GONIO_TRY(probing.take(text, "--probe"));
    }
  }
  GONIO_TRY(probing.finish());
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
