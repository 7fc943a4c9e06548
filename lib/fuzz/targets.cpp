#include "fuzz/targets.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "brdf/measured.h"
#include "color/reflection_file.h"
#include "envmap/prefiltered.h"
#include "formats/basis.h"
#include "formats/csv.h"
#include "formats/cxf.h"
#include "formats/importers.h"
#include "formats/xml.h"
#include "image/aov_file.h"
#include "image/hdr.h"
#include "image/image.h"
#include "image/surface_file.h"
#include "library/index.h"
#include "mesh/mesh.h"

namespace goniochrome::fuzz {

namespace {

// Ends the program if something does not hold for what a reader has accepted.
void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

void demand_message(const Error& error) {
  demand(!error.message.empty(), "an error without a message");
  demand(error.kind != ErrorKind::kBug, "an error that calls itself a bug");
}

void demand_paint(const paint::Paint& paint) {
  demand(!paint.name.empty(), "a paint without a name");
  if (!paint.measurement) return;
  for (const paint::LabReading& row : paint.measurement->rows)
    demand(std::isfinite(row.lab.L + row.lab.a + row.lab.b + row.geometry.aspecular_deg),
           "a reading that is no number");
}

// Calls next() to the end of a stream of paints. A stream that gives more than `most` errors and paints does not end.
template <class Reader>
void drain(Reader& reader, std::size_t most) {
  for (std::size_t i = 0;; ++i) {
    demand(i <= most, "more paints and errors than the file has bytes");
    const auto paint = reader.next();
    if (!paint.ok()) {
      demand_message(paint.error());
    } else if (!*paint) {
      return;
    } else {
      demand_paint(**paint);
    }
  }
}

void read_paint_xml(const std::string& path) {
  auto reader = formats::PaintReader::open(path);
  if (!reader.ok()) return demand_message(reader.error());
  drain(*reader, std::filesystem::file_size(path) + 2);
}

void read_basis_xml(const std::string& path) {
  const auto basis = formats::read_basis(path);
  if (!basis.ok()) return demand_message(basis.error());
  for (const double e : basis->exponents) demand(std::isfinite(e) && e >= 0, "an exponent that is none");
}

void read_csv(const std::string& path) {
  auto reader = formats::CsvPaintReader::open(path);
  if (!reader.ok()) return demand_message(reader.error());
  drain(*reader, std::filesystem::file_size(path) + 2);
}

template <Result<formats::ImportedPaints> (*import)(InputFile, const formats::ImportOptions&)>
void read_imported(const std::string& path) {
  auto input = InputFile::open(path);
  if (!input.ok()) return demand_message(input.error());
  formats::ImportOptions options;
  options.viewings = {{"", {}}};  // so that files without a geometry are read to their end
  const auto imported = import(std::move(*input), options);
  if (!imported.ok()) return demand_message(imported.error());
  for (const paint::Paint& paint : imported->paints) demand_paint(paint);
}

void read_measured_file(const std::string& path) {
  const auto brdf = brdf::read_measured(path);
  if (!brdf.ok()) return demand_message(brdf.error());
  brdf::checks(**brdf);
  for (const double aspecular : {15.0, 110.0})
    for (const color::ViewingCondition& condition : {color::ViewingCondition{"D65", 2}, {"A", 10}}) {
      const auto color = brdf::measured_color(**brdf, {{{45, aspecular}}, condition});
      if (!color.ok()) {
        demand_message(color.error());
        continue;
      }
      for (const brdf::MeasuredReading& reading : color->readings)
        demand(std::isfinite(reading.lab.L + reading.lab.a + reading.lab.b), "a color that is no number");
    }
}

void read_env_file(const std::string& path) {
  const auto env = envmap::read_env(path);
  if (!env.ok()) demand_message(env.error());
}

void read_probe(const std::string& path) {
  const auto probe = image::decoded_hdr(file_content(path).value(), path);
  if (!probe.ok()) return demand_message(probe.error());
  for (const float value : probe->image.data) demand(std::isfinite(value), "a radiance that is no number");
}

void read_picture(const std::string& path) {
  const auto part = image::read_image(path, image::Inks::kKept);
  if (!part.ok()) return demand_message(part.error());
  const image::Image& image = part->image;
  demand(image.data.size() == static_cast<std::size_t>(image.width) * image.height * image.channels,
         "a picture whose size is not that of its pixels");
}

void read_texture(const std::string& path) {
  const auto texture = image::read_sbrdf(path);
  if (!texture.ok()) demand_message(texture.error());
}

void read_buffers(const std::string& path) {
  const auto buffers = image::read_aov_file(path);
  if (!buffers.ok()) demand_message(buffers.error());
}

void read_mesh(const std::string& path) {
  const auto mesh = mesh::read_mesh(path);
  if (!mesh.ok()) demand_message(mesh.error());
}

void read_operator(const std::string& path) {
  const auto op = color::read_reflection_operator(path);
  if (!op.ok()) demand_message(op.error());
}

}  // namespace

const std::vector<FuzzTarget>& fuzz_targets() {
  static const std::vector<FuzzTarget> targets = {
      {"paint-xml", "a.paints.xml", read_paint_xml},
      {"basis-xml", "a.basis.xml", read_basis_xml},
      {"csv", "a.csv", read_csv},
      {"cxf", "a.cxf", read_imported<formats::read_cxf>},
      {"cgats", "a.txt", read_imported<formats::read_cgats>},
      {"workbook", "a.xlsx", read_imported<formats::read_workbook>},
      {"qtx", "a.qtx", read_imported<formats::read_qtx>},
      {"mif", "a.mif", read_imported<formats::read_mif>},
      {"xtf", "a.xtf", read_imported<formats::read_xtf>},
      {"mtf", "a.mtf", read_imported<formats::read_mtf>},
      {"jcamp", "a.jdx", read_imported<formats::read_jcamp>},
      {"measured", "a.brdf", read_measured_file},
      {"env-exr", "a.env.exr", read_env_file},
      {"obj", "a.obj", read_mesh},
      {"gltf", "a.gltf", read_mesh},
      {"off", "a.off", read_mesh},
      {"ply", "a.ply", read_mesh},
      {"stl", "a.stl", read_mesh},
      {"image-png", "a.png", read_picture},
      {"image-jpeg", "a.jpg", read_picture},
      {"image-tiff", "a.tif", read_picture},
      {"image-other", "a.image", read_picture},
      {"sbrdf-exr", "a.sbrdf.exr", read_texture},
      {"buffers-exr", "a.exr", read_buffers},
      {"probe-hdr", "a.hdr", read_probe},
      {"operator-json", "a.json", read_operator},
  };
  return targets;
}

FuzzRun::FuzzRun(const FuzzTarget& target) : target_(target) {
  // The folder is in memory if the system has such a place, since a disk would be slower than the readers.
  const char* top = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
  folder_ = std::string(top) + "/gonio-fuzz-" + std::to_string(getpid());
  std::filesystem::create_directories(folder_);
  path_ = folder_ + "/" + std::string(target.file_name);
}

FuzzRun::~FuzzRun() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void FuzzRun::operator()(std::string_view bytes) const {
  std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  target_.read(path_);
}

}  // namespace goniochrome::fuzz
