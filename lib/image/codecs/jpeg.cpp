#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
// libjpeg's headers want <cstdio> before them.
#include <jerror.h>
#include <jpeglib.h>

#include "image/codecs/decoders.h"

namespace goniochrome::image {

namespace {

// libjpeg leaves a decompression by a jump, which passes no destructors: decode() owns nothing that has one.
struct Job {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  std::jmp_buf back;
  char text[JMSG_LENGTH_MAX] = "";
  std::string_view file;
  std::vector<JSAMPLE> row;
  Picture* picture = nullptr;
};

void leave(j_common_ptr info) {
  auto* job = static_cast<Job*>(info->client_data);
  info->err->format_message(info, job->text);
  std::longjmp(job->back, 1);
}

// A cut file is an error; other warnings concern bytes between the pictures.
void take_message(j_common_ptr info, int level) {
  if (level < 0 && info->err->msg_code == JWRN_JPEG_EOF) leave(info);
}

void keep_profile(Job& job) {
  JOCTET* bytes = nullptr;
  unsigned size = 0;
  if (jpeg_read_icc_profile(&job.info, &bytes, &size))
    job.picture->icc_profile.assign(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
}

std::string prepare(Job& job) {
  const bool inks = job.info.out_color_space == JCS_CMYK;
  job.picture->is_inks = inks;
  job.picture->color_space = "sRGB";
  keep_profile(job);
  std::vector<std::string> names = inks ? std::vector<std::string>{"C", "M", "Y", "K"}
                                        : color_names(job.info.out_color_space == JCS_GRAYSCALE ? 1 : 3);
  job.row.resize(names.size() * job.info.image_width);
  return set_size(*job.picture, job.info.image_width, job.info.image_height, std::move(names), job.file.size());
}

std::string decode(Job& job) {
  jpeg_decompress_struct& info = job.info;
  info.err = jpeg_std_error(&job.errors);
  info.client_data = &job;
  job.errors.error_exit = leave, job.errors.emit_message = take_message;
  if (setjmp(job.back) != 0) return job.text;
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(job.file.data()), job.file.size());
  jpeg_save_markers(&info, JPEG_APP0 + 2, 0xFFFF);
  jpeg_read_header(&info, TRUE);
  const J_COLOR_SPACE stored = info.jpeg_color_space;
  info.out_color_space = stored == JCS_CMYK || stored == JCS_YCCK ? JCS_CMYK
                         : stored == JCS_GRAYSCALE                ? JCS_GRAYSCALE
                                                                  : JCS_RGB;
  // The size is checked first: libjpeg takes memory for all of a progressive picture.
  if (std::string problem = prepare(job); !problem.empty()) return problem;
  jpeg_start_decompress(&info);
  if (info.output_components != job.picture->channels) ERREXIT(&info, JERR_BAD_STATE);
  const bool inverted = job.picture->is_inks && info.saw_Adobe_marker;  // Adobe's programs store paper as 255
  float* to = job.picture->pixels.data();
  while (info.output_scanline < info.output_height) {
    JSAMPLE* row = job.row.data();
    jpeg_read_scanlines(&info, &row, 1);
    for (const JSAMPLE value : job.row)
      *to++ = static_cast<float>(inverted ? MAXJSAMPLE - value : value) / static_cast<float>(MAXJSAMPLE);
  }
  jpeg_finish_decompress(&info);
  return "";
}

}  // namespace

std::string decode_jpeg(std::string_view file, bool keep_inks, Picture& picture) {
  const auto job = std::make_unique<Job>();
  job->file = file, job->picture = &picture;
  const std::string problem = decode(*job);
  jpeg_destroy_decompress(&job->info);
  if (problem.empty() && picture.is_inks && !keep_inks) mix_inks(picture);
  return problem;
}

}  // namespace goniochrome::image
