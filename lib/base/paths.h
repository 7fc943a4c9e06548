// Questions about names in the file system. Nothing here throws: what cannot be looked at (a loop of links, a forbidden
// folder, a name that is too long) is not there. std::filesystem::path may be used anywhere for the text of a name;
// every other part of std::filesystem is used behind these functions alone, and tools/modules_test.sh holds that.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "base/result.h"

namespace goniochrome {

bool is_there(const std::string& path);
bool is_folder(const std::string& path);
bool is_plain_file(const std::string& path);

// The target of a link, or nothing.
std::optional<std::string> link_target(const std::string& path);

// `path` as seen from `folder`; `path` as it stands where that cannot be told.
std::string relative_path(const std::string& path, const std::string& folder);

// Makes the folder and those above it, unless they are there. Error: the system's reason.
Result<void> make_folder(const std::string& path);

// The identity of a file: its device and number there. Nothing if there is no such file.
std::optional<std::pair<unsigned long, unsigned long>> file_identity(const std::string& path);

// True if OutputFile could write `path` now; nothing is left of the attempt. A device or a pipe is not tried.
Result<void> can_be_written(const std::string& path);

}  // namespace goniochrome
