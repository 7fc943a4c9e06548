// Where tests and benchmarks find the files of testdata/.
#pragma once

#include <cstdlib>
#include <string>

namespace goniochrome {

// The path of a file of testdata/. The environment variable GONIOCHROME_TESTDATA names that folder, as ctest does;
// without it, the folder is the one of this name in the current folder.
inline std::string testdata(const std::string& name) {
  const char* folder = std::getenv("GONIOCHROME_TESTDATA");
  return std::string(folder ? folder : "testdata") + "/" + name;
}

}  // namespace goniochrome
