#include "base/paths.h"

#include <sys/stat.h>

#include <filesystem>
#include <system_error>

#include "base/file.h"

namespace goniochrome {

bool is_there(const std::string& path) {
  std::error_code failure;
  return std::filesystem::exists(path, failure);
}

bool is_folder(const std::string& path) {
  std::error_code failure;
  return std::filesystem::is_directory(path, failure);
}

bool is_plain_file(const std::string& path) {
  std::error_code failure;
  return std::filesystem::is_regular_file(path, failure);
}

std::optional<std::string> link_target(const std::string& path) {
  std::error_code failure;
  const std::string target = std::filesystem::read_symlink(path, failure).string();
  return failure ? std::nullopt : std::optional<std::string>(target);
}

std::string relative_path(const std::string& path, const std::string& folder) {
  // A name that is not there yet would stay relative to the current folder, and could not be seen from another one.
  std::error_code failure, wrong;
  const std::filesystem::path whole = std::filesystem::absolute(path, wrong);
  const std::string relative = std::filesystem::proximate(whole, folder, failure).string();
  return failure || wrong ? path : relative;
}

Result<void> make_folder(const std::string& path) {
  std::error_code failure;
  std::filesystem::create_directories(path, failure);
  if (is_folder(path)) return {};
  if (is_there(path)) return input_error("{}: is no folder: a file is in its place", path);
  return input_error("{}: cannot be made a folder: {}", path, failure.message());
}

std::optional<std::pair<unsigned long, unsigned long>> file_identity(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0) return std::nullopt;
  return std::pair<unsigned long, unsigned long>(status.st_dev, status.st_ino);
}

Result<void> can_be_written(const std::string& path) {
  if (path.empty() || path == "-" || (is_there(path) && !is_plain_file(path) && !is_folder(path))) return {};
  GONIO_ASSIGN(const OutputFile file, OutputFile::create(path));
  return {};
}

}  // namespace goniochrome
