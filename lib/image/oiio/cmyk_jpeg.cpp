#include "image/oiio/cmyk_jpeg.h"

#include <cerrno>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
// libjpeg's headers want <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

namespace goniochrome::image {

namespace {

// libjpeg leaves a decompression by a jump, which passes no destructors: nothing below owns anything.
struct Errors {
  jpeg_error_mgr manager;
  std::jmp_buf back;
  char text[JMSG_LENGTH_MAX];
};

void leave(j_common_ptr info) {
  auto* errors = reinterpret_cast<Errors*>(info->err);
  info->err->format_message(info, errors->text);
  std::longjmp(errors->back, 1);
}

// A cut file is an error; other warnings concern bytes between the pictures.
void take_message(j_common_ptr info, int level) {
  if (level < 0 && info->err->msg_code == JWRN_JPEG_EOF) leave(info);
}

struct Job {
  std::FILE* file;
  int width, height;
  JSAMPLE* row;   // of 4 width bytes
  float* pixels;  // of 4 width height
};

// Whether it worked; else errors.text says why.
bool decode(const Job& job, Errors& errors) {
  jpeg_decompress_struct info{};
  info.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = leave, errors.manager.emit_message = take_message;
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  jpeg_stdio_src(&info, job.file);
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_CMYK;
  jpeg_start_decompress(&info);
  if (static_cast<int>(info.output_width) != job.width || static_cast<int>(info.output_height) != job.height ||
      info.output_components != 4)
    ERREXIT(&info, JERR_BAD_STATE);
  const bool inverted = info.saw_Adobe_marker;  // Adobe's programs store paper as 255
  float* to = job.pixels;
  while (info.output_scanline < info.output_height) {
    JSAMPLE* row = job.row;
    jpeg_read_scanlines(&info, &row, 1);
    for (int i = 0; i < 4 * job.width; ++i)
      *to++ = static_cast<float>(inverted ? MAXJSAMPLE - row[i] : row[i]) / static_cast<float>(MAXJSAMPLE);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return true;
}

}  // namespace

std::string read_cmyk_jpeg(const char* path, int width, int height, std::vector<float>& pixels) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "rb"), &std::fclose);
  if (!file) return std::strerror(errno);
  std::vector<JSAMPLE> row(4 * static_cast<std::size_t>(width));
  const auto errors = std::make_unique<Errors>();
  if (decode({file.get(), width, height, row.data(), pixels.data()}, *errors)) return "";
  return errors->text;
}

}  // namespace goniochrome::image
