#include "formats/internal/zip_archive.h"

#include <zip.h>

#include <algorithm>
#include <utility>

namespace goniochrome::formats {

struct ZipArchive::State {
  std::string bytes;
  zip_t* archive = nullptr;
  ~State() {
    if (archive) zip_discard(archive);
  }
};

ZipArchive::ZipArchive(std::unique_ptr<State> state) : state_(std::move(state)) {}
ZipArchive::ZipArchive(ZipArchive&&) noexcept = default;
ZipArchive& ZipArchive::operator=(ZipArchive&&) noexcept = default;
ZipArchive::~ZipArchive() = default;

std::optional<ZipArchive> ZipArchive::open(const std::string&, std::string bytes) {
  auto state = std::make_unique<State>();
  state->bytes = std::move(bytes);
  zip_error_t problem;
  zip_error_init(&problem);
  zip_source_t* source = zip_source_buffer_create(state->bytes.data(), state->bytes.size(), 0, &problem);
  if (source) {
    state->archive = zip_open_from_source(source, ZIP_RDONLY, &problem);
    if (!state->archive) zip_source_free(source);
  }
  zip_error_fini(&problem);
  return state->archive ? std::optional(ZipArchive(std::move(state))) : std::nullopt;
}

std::optional<ZipArchive::Part> ZipArchive::part(const std::string& name) const {
  zip_stat_t about;
  if (zip_stat(state_->archive, name.c_str(), 0, &about) != 0) return std::nullopt;
  const bool tells = (about.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0;
  return Part{about.comp_size, tells && about.encryption_method != ZIP_EM_NONE};
}

Result<ZipArchive::Unpacking> ZipArchive::unpacking(const std::string& name) const {
  const std::shared_ptr<zip_file_t> file(zip_fopen(state_->archive, name.c_str(), 0),
                                         [](zip_file_t* open) { return open ? zip_fclose(open) : 0; });
  if (!file) return input_error("{}", zip_strerror(state_->archive));
  return Unpacking([file](std::string& buffer, std::size_t wanted) -> Result<std::size_t> {
    const std::size_t before = buffer.size();
    buffer.resize(before + wanted);
    const zip_int64_t got = zip_fread(file.get(), buffer.data() + before, wanted);
    buffer.resize(before + static_cast<std::size_t>(std::max<zip_int64_t>(got, 0)));
    if (got < 0) return input_error("it is damaged");
    return static_cast<std::size_t>(got);
  });
}

}  // namespace goniochrome::formats
