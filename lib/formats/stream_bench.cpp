// Paints through the readers, the writers and the curve fit: paints per second, after a check that none was lost.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "formats/csv.h"
#include "formats/xml.h"
#include "paint/curve.h"

namespace goniochrome::formats {
namespace {

constexpr int kPaints = 20000;

paint::Paint sample_paint(int i) {
  paint::Paint paint;
  paint.name = "paint " + std::to_string(i);
  paint.paint_class = paint::PaintClass::kMetallic;
  paint.gloss = {{60, 92.1}};
  paint::Appearance appearance{{80, i % 61 - 30.25, 12.5}, {20, 3.75, i % 37 - 18.5}, 40.0 + i % 100, {}};
  paint.measurement.emplace().rows = paint::rows_of(appearance);
  return paint;
}

// A library on disk in both forms, made once.
struct Library {
  Library() {
    std::string folder = (std::filesystem::temp_directory_path() / "goniochrome-bench-XXXXXX").string();
    if (!mkdtemp(folder.data())) std::abort();
    path = folder;
    auto xml = PaintWriter::begin(*OutputFile::create(path + "/p.xml"));
    auto csv = CsvPaintWriter::begin(*OutputFile::create(path + "/p.csv"), {});
    for (int i = 0; i < kPaints; ++i)
      if (!xml->write(sample_paint(i)).ok() || !csv->write(sample_paint(i)).ok()) std::abort();
    if (!xml->finish().ok() || !csv->finish().ok()) std::abort();
  }
  ~Library() { std::filesystem::remove_all(path); }
  std::string path;
};

const Library& library() {
  static const Library made;
  return made;
}

template <class Reader>
int count(Reader& reader) {
  int paints = 0;
  for (;;) {
    const auto paint = reader.next();
    if (!paint.ok() || !*paint) return paints;
    ++paints;
  }
}

template <class Reader>
void read(benchmark::State& state, const char* name) {
  const std::string path = library().path + name;
  for (auto _ : state) {
    auto reader = Reader::open(path);
    if (count(*reader) != kPaints) state.SkipWithError("paints were lost");
  }
  state.counters["paints_per_s"] = benchmark::Counter(kPaints, benchmark::Counter::kIsIterationInvariantRate);
}

template <class Writer, class... Layout>
void write(benchmark::State& state, const Layout&... layout) {
  const paint::Paint paint = sample_paint(1);
  for (auto _ : state) {
    auto writer = Writer::begin(*OutputFile::create(library().path + "/out"), layout...);
    for (int i = 0; i < kPaints; ++i)
      if (!writer->write(paint).ok()) state.SkipWithError("a paint was refused");
  }
  state.counters["paints_per_s"] = benchmark::Counter(kPaints, benchmark::Counter::kIsIterationInvariantRate);
}

void fit(benchmark::State& state) {
  const paint::Paint paint = sample_paint(7);
  double residual = 0;
  for (auto _ : state) residual = *paint::appearance_from_rows(paint.measurement->rows)->appearance.residual_de00;
  if (residual > 1e-6) state.SkipWithError("the fit misses its own rows");
  state.counters["residual_de00"] = residual;
}

void read_xml(benchmark::State& state) {
  read<PaintReader>(state, "/p.xml");
}
void read_csv(benchmark::State& state) {
  read<CsvPaintReader>(state, "/p.csv");
}
void write_xml(benchmark::State& state) {
  write<PaintWriter>(state);
}
void write_csv(benchmark::State& state) {
  write<CsvPaintWriter>(state, CsvLayout{});
}

BENCHMARK(read_xml)->Unit(benchmark::kMillisecond);
BENCHMARK(read_csv)->Unit(benchmark::kMillisecond);
BENCHMARK(write_xml)->Unit(benchmark::kMillisecond);
BENCHMARK(write_csv)->Unit(benchmark::kMillisecond);
BENCHMARK(fit)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace goniochrome::formats
