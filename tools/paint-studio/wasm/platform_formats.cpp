// Formats whose libraries a page does not have: they are refused by name, or the browser unpacks them.
#include "base/file.h"
#include "formats/internal/zip_archive.h"
#include "image/hdr.h"
#include "image/icc.h"
#include "image/image.h"
#include "image/internal/exr.h"
#include "mesh/internal/gltf_packed.h"
#include "mesh/internal/polygons.h"
#include "platform.h"
#include "render/textures/sbrdf.h"

namespace goniochrome {

namespace formats {

struct ZipArchive::State {
  std::string folder;
  std::size_t bytes = 0;
};

ZipArchive::ZipArchive(std::unique_ptr<State> state) : state_(std::move(state)) {}
ZipArchive::ZipArchive(ZipArchive&&) noexcept = default;
ZipArchive& ZipArchive::operator=(ZipArchive&&) noexcept = default;
ZipArchive::~ZipArchive() = default;

std::optional<ZipArchive> ZipArchive::open(const std::string& name, std::string bytes) {
  const auto part = studio::given_files().lower_bound(name + "/");
  if (part == studio::given_files().end() || !part->first.starts_with(name + "/")) return std::nullopt;
  return ZipArchive(std::make_unique<State>(State{name + "/", bytes.size()}));
}
std::optional<ZipArchive::Part> ZipArchive::part(const std::string& name) const {
  if (!studio::given_files().contains(state_->folder + name)) return std::nullopt;
  return Part{state_->bytes, false};
}
Result<ZipArchive::Unpacking> ZipArchive::unpacking(const std::string& name) const {
  GONIO_ASSIGN(InputFile input, InputFile::open(state_->folder + name));
  const auto file = std::make_shared<InputFile>(std::move(input));
  return Unpacking([file](std::string& buffer, std::size_t most) { return file->read(buffer, most); });
}

}  // namespace formats

namespace image {

Result<ImagePart> read_image(const std::string& path, Inks) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::string content, input.rest(std::string::npos));
  if (is_exr(content)) return studio::decoded_exr(content, path);
  return decoded_hdr(content, path);
}
std::string image_file(const std::string& path) {
  return path;
}
// Radiance pictures have no profile.
int color_channels(const Image& image) {
  return image.channels;
}
Result<Image> image_through_icc(const Image&, const std::string&, const std::string& name, bool) {
  return input_error("{}: has an ICC profile, which a page does not read: save it without one", name);
}

}  // namespace image

namespace mesh {

Result<Polygons> polygons_from_soup(const std::string&, const std::string& extension, const Source& source) {
  return input_error("{}: is {}, and a page reads OBJ and glTF (.gltf, .glb): save it as one of these", source.name,
                     extension);
}
std::optional<std::string> acceptable_to_library(std::string_view) {
  return std::nullopt;
}
std::optional<std::string> meshopt_unpacked(const MeshoptView&) {
  return std::nullopt;
}
std::optional<DracoMesh> draco_unpacked(std::string_view, std::vector<DracoMesh::Attribute>&, std::size_t) {
  return std::nullopt;
}

}  // namespace mesh

namespace render {

// No part of a page's mesh has a mapped surface.
Result<void> SbrdfShader::has_all_maps() const {
  return {};
}

}  // namespace render
}  // namespace goniochrome
