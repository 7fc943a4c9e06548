#include "base/file_cache.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

#include "base/digest.h"
#include "base/file.h"
#include "base/paths.h"
#include "base/text.h"

namespace goniochrome {

namespace {

// An unfinished file of a run that was killed, on a file system that gives such files a name. A run that lives writes
// its file within seconds.
constexpr std::string_view kUnfinished = ".goniochrome-";
constexpr std::time_t kAbandoned_s = 3600;

struct KeptFile {
  std::string name;
  std::uint64_t bytes = 0;
  timespec used = {};
};

// The plain files of a folder whose names begin and end so; none where it cannot be read.
std::vector<KeptFile> files_of(const std::string& folder, std::string_view beginning, std::string_view ending) {
  std::vector<KeptFile> files;
  const std::unique_ptr<DIR, int (*)(DIR*)> open(opendir(folder.c_str()), closedir);
  while (const dirent* entry = open ? readdir(open.get()) : nullptr) {
    const std::string name = entry->d_name;
    struct stat status;
    if (!name.starts_with(beginning) || !name.ends_with(ending)) continue;
    if (fstatat(dirfd(open.get()), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(status.st_mode))
      continue;
    files.push_back({name, static_cast<std::uint64_t>(status.st_size), status.st_mtim});
  }
  return files;
}

std::string digest_of(std::string_view content) {
  Digest digest;
  digest.add(content);
  return digest.hex();
}

// The value of a variable that names a folder; "" where it is no absolute path.
std::string folder_in(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && value[0] == '/' ? value : "";
}

}  // namespace

std::string user_cache_folder() {
  if (const std::string caches = folder_in("XDG_CACHE_HOME"); !caches.empty()) return caches + "/goniochrome";
  const std::string home = folder_in("HOME");
  return home.empty() ? "" : home + "/.cache/goniochrome";
}

std::optional<std::string> FileCache::find(const std::string& key) const {
  const std::string beginning = key + "-";
  for (const KeptFile& file : files_of(folder_, beginning, ending_)) {
    const std::string path = folder_ + "/" + file.name;
    auto content = file_content(path);
    if (!content.ok()) continue;
    if (beginning + digest_of(*content) + ending_ != file.name) {
      unlink(path.c_str());
      continue;
    }
    utimensat(AT_FDCWD, path.c_str(), nullptr, 0);  // where that is forbidden, the file ages
    return *std::move(content);
  }
  return std::nullopt;
}

Result<void> FileCache::keep(const std::string& key, std::string_view content) const {
  if (content.size() > most_bytes_)
    return input_error("{}: has room for {} bytes, and this takes {}", folder_, most_bytes_, content.size());
  GONIO_TRY(make_folder(folder_));
  const std::string name = key + "-" + digest_of(content) + ending_;
  make_room(content.size(), name);
  GONIO_TRY(write_file(folder_ + "/" + name, content));
  make_room(0, name);  // other runs may have written since
  return {};
}

// Removes files, but for one, until `bytes` more fit.
void FileCache::make_room(std::uint64_t bytes, const std::string& but) const {
  for (const KeptFile& file : files_of(folder_, kUnfinished, ".tmp"))
    if (std::time(nullptr) - file.used.tv_sec > kAbandoned_s) unlink((folder_ + "/" + file.name).c_str());
  std::vector<KeptFile> files = files_of(folder_, "", ending_);
  std::ranges::sort(files, [](const KeptFile& a, const KeptFile& b) {
    return std::pair(a.used.tv_sec, a.used.tv_nsec) < std::pair(b.used.tv_sec, b.used.tv_nsec);
  });
  std::uint64_t all = bytes;
  for (const KeptFile& file : files) all += file.bytes;
  for (const KeptFile& file : files) {
    if (all <= most_bytes_) return;
    if (file.name == but) continue;
    unlink((folder_ + "/" + file.name).c_str());
    all -= file.bytes;
  }
}

}  // namespace goniochrome
