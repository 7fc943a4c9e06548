// The entry points of libFuzzer. The target is the program's name without "fuzz-".
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "fuzz/targets.h"

namespace {
std::unique_ptr<goniochrome::fuzz::FuzzRun> run;
}

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
  const std::string program = std::filesystem::path((*arguments)[0]).filename().string();
  for (const goniochrome::fuzz::FuzzTarget& target : goniochrome::fuzz::fuzz_targets())
    if (program == "fuzz-" + std::string(target.name)) run = std::make_unique<goniochrome::fuzz::FuzzRun>(target);
  if (run) return 0;
  std::fprintf(stderr, "%s: call it fuzz-TARGET, where TARGET is one of:", program.c_str());
  for (const goniochrome::fuzz::FuzzTarget& target : goniochrome::fuzz::fuzz_targets())
    std::fprintf(stderr, " %s", std::string(target.name).c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  (*run)({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
