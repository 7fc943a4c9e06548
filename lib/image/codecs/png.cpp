#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>

#include "image/codecs/decoders.h"

namespace goniochrome::image {

namespace {

// libpng leaves by a jump, which passes no destructors: decode() owns nothing that has one.
struct Job {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string problem;
  std::string_view rest;
  std::size_t file_bytes = 0;
  std::vector<png_byte> bytes;
  std::vector<png_bytep> rows;
  bool has_alpha = false;
  Picture* picture = nullptr;
};

void leave(png_structp png, png_const_charp text) {
  static_cast<Job*>(png_get_error_ptr(png))->problem = text;
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

void take_bytes(png_structp png, png_bytep to, std::size_t size) {
  auto* job = static_cast<Job*>(png_get_io_ptr(png));
  if (job->rest.size() < size) png_error(png, "the file is cut short");
  std::memcpy(to, job->rest.data(), size);
  job->rest.remove_prefix(size);
}

// sRGB where the file says nothing else.
std::string color_space(const Job& job) {
  int intent = 0;
  double gamma = 0;
  if (png_get_sRGB(job.png, job.info, &intent) || !png_get_gAMA(job.png, job.info, &gamma) || !(gamma > 0))
    return "sRGB";
  // Writers round what they store, as 45455 for 1/2.2.
  const double exponent = std::round(100 / gamma) / 100;
  if (exponent == 1) return "linear";
  char text[32];
  std::snprintf(text, sizeof text, "Gamma%.4g", exponent);
  return text;
}

void keep_words(Job& job) {
  Picture& picture = *job.picture;
  picture.color_space = color_space(job);
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(job.png, job.info, &texts, &count);
  for (int i = 0; i < count; ++i)
    if (std::strcmp(texts[i].key, "colorInteropID") == 0 && texts[i].text) picture.interop_id = texts[i].text;
  png_charp name = nullptr;
  png_bytep profile = nullptr;
  png_uint_32 size = 0;
  int method = 0;
  if (png_get_iCCP(job.png, job.info, &name, &method, &profile, &size))
    picture.icc_profile.assign(reinterpret_cast<const char*>(profile), size);
}

// Makes room for the picture and its rows as libpng hands them over.
void prepare(Job& job) {
  const std::size_t width = png_get_image_width(job.png, job.info), height = png_get_image_height(job.png, job.info);
  const int channels = png_get_channels(job.png, job.info);
  job.problem = set_size(*job.picture, width, height, color_names(channels), job.file_bytes);
  if (!job.problem.empty()) return;
  job.has_alpha = channels % 2 == 0;
  const std::size_t row_bytes = png_get_rowbytes(job.png, job.info);
  job.bytes.resize(row_bytes * height);
  for (std::size_t y = 0; y < height; ++y) job.rows.push_back(&job.bytes[y * row_bytes]);
}

void put_pixels(Job& job, bool two_bytes) {
  std::vector<float>& pixels = job.picture->pixels;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = two_bytes ? static_cast<float>(job.bytes[2 * i] << 8 | job.bytes[2 * i + 1]) / 65535.0F
                          : static_cast<float>(job.bytes[i]) / 255.0F;
  if (job.has_alpha) associate_alpha(*job.picture);
}

void decode(Job& job) {
  if (setjmp(png_jmpbuf(job.png)) != 0) return;
  png_set_read_fn(job.png, &job, take_bytes);
  png_read_info(job.png, job.info);
  png_set_expand(job.png);  // palettes, fewer than 8 bits, and a transparent color
  png_set_interlace_handling(job.png);
  png_read_update_info(job.png, job.info);
  prepare(job);
  if (!job.problem.empty()) return;
  png_read_image(job.png, job.rows.data());
  png_read_end(job.png, job.info);
  keep_words(job);
  put_pixels(job, png_get_bit_depth(job.png, job.info) == 16);
}

}  // namespace

std::string decode_png(std::string_view file, Picture& picture) {
  const auto job = std::make_unique<Job>();
  job->rest = file, job->file_bytes = file.size(), job->picture = &picture;
  job->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, job.get(), leave, ignore);
  job->info = job->png ? png_create_info_struct(job->png) : nullptr;
  if (!job->info) throw std::bad_alloc();
  decode(*job);
  png_destroy_read_struct(&job->png, &job->info, nullptr);
  return job->problem;
}

}  // namespace goniochrome::image
