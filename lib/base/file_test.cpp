#include "base/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <string_view>

#include "base/hard_case_for_test.h"
#include "base/scratch_for_test.h"

namespace goniochrome::file_test {
namespace {

class Files : public testing::Test {
 protected:
  ScratchFolder folder_;
  std::string path_ = folder_.path("out.txt");
};

TEST_F(Files, WholeContentComesBack) {
  const std::string bytes("a\0b\nc", 5);
  ASSERT_TRUE(write_file(path_, bytes).ok());
  EXPECT_EQ(*file_content(path_), bytes);
  EXPECT_EQ(folder_.files(), 1u);
}

TEST_F(Files, MissingInputNamesThePath) {
  const auto content = file_content(path_);
  ASSERT_FALSE(content.ok());
  EXPECT_EQ(content.error().message, path_ + ": cannot be read: No such file or directory");
}

TEST_F(Files, FolderAsTargetIsRefused) {
  EXPECT_FALSE(write_file(folder_.path(""), "x").ok());
}

TEST_F(Files, FolderAsInputIsRefused) {
  EXPECT_THAT(file_content(folder_.path("")).error().message, testing::EndsWith("is a folder: name a file"));
  EXPECT_FALSE(file_content("").ok());
}

TEST_F(Files, PeekedBytesAreReadAgain) {
  ASSERT_TRUE(write_file(path_, "0123456789").ok());
  auto file = InputFile::open(path_).value();
  EXPECT_EQ(*file.peek(), "0123456789");
  std::string first;
  EXPECT_EQ(*file.read(first, 4), 4u);
  EXPECT_EQ(*file.rest(6), "456789");
  EXPECT_FALSE(InputFile::open(path_)->rest(9).ok());
}

// A plain file from where the first reader stands, and a pipe, of which the bytes come only once.
TEST_F(Files, ASecondReadingGivesTheSameBytes) {
  std::string content;
  for (int i = 0; content.size() < 3000000; ++i) content += std::to_string(i) + "\n";
  ASSERT_TRUE(write_file(path_, content).ok());
  auto file = InputFile::open(path_).value();
  std::string skipped;
  ASSERT_EQ(*file.read(skipped, 100), 100u);
  ASSERT_TRUE(file.peek().ok());
  auto second = file.second_reading();
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(second->name(), path_);
  EXPECT_EQ(*second->rest(content.size()), content.substr(100));
  EXPECT_EQ(*file.rest(content.size()), content.substr(100));

  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t writer = fork();
  if (writer == 0) {
    for (std::string_view left = content; !left.empty();) {
      const ssize_t count = write(ends[1], left.data(), left.size());
      if (count <= 0) _exit(1);
      left.remove_prefix(static_cast<std::size_t>(count));
    }
    _exit(0);
  }
  close(ends[1]);
  auto piped = InputFile::open("/proc/self/fd/" + std::to_string(ends[0])).value();
  close(ends[0]);
  ASSERT_TRUE(piped.peek().ok());
  auto again = piped.second_reading();
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(*again->rest(content.size()), content);
  EXPECT_EQ(*piped.rest(content.size()), content);
  int status = 0;
  waitpid(writer, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(Files, ScratchPathCanBeOpenedByName) {
  {
    auto file = OutputFile::create(path_);
    ASSERT_TRUE(file.ok());
    std::ofstream(file->scratch_path()) << "by name";
    ASSERT_TRUE(file->commit().ok());
  }
  EXPECT_EQ(*file_content(path_), "by name");
}

// The control writes in place, as fopen(path, "w") does, and dies: its old content is gone.
TEST_F(Files, HardCase_InterruptedLeavesTheOldFile) {
  ASSERT_TRUE(write_file(path_, "old").ok());
  const auto killed_while = [&](auto&& writing) {
    const pid_t child = fork();
    if (child == 0) {
      writing();
      raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
  };
  killed_while([&] {
    auto file = OutputFile::create(path_);
    (void)file->write("half of the new one");
    (void)file->flush();
  });
  EXPECT_EQ(folder_.files(), 1u) << "nothing may be left behind";
  const double lost = *file_content(path_) == "old" ? 0 : 3;
  killed_while([&] {
    std::FILE* control = std::fopen(path_.c_str(), "w");
    std::fputs("half of the new one", control);
    std::fflush(control);
  });
  hard_case("interrupted", {.what = "bytes of the old file lost when killed while writing",
                            .textbook = *file_content(path_) == "old" ? 0.0 : 3.0,
                            .ours = lost,
                            .bound = 0,
                            .unit = "bytes"});
}

TEST_F(Files, HardCase_InterruptedDiskFullIsAnError) {
  auto file = OutputFile::create("/dev/full");
  ASSERT_TRUE(file.ok());
  const auto written = file->write(std::string(1 << 20, 'x'));
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message.find("No space left"), std::string::npos);
  // The control asks the stream after writing and before its buffer reaches the disk.
  std::ofstream control("/dev/full");
  control << "x";
  hard_case("interrupted", {.what = "full disks that no error reports",
                            .textbook = control.good() ? 1.0 : 0.0,
                            .ours = written.ok() ? 1.0 : 0.0,
                            .bound = 0,
                            .unit = "files"});
}

}  // namespace
}  // namespace goniochrome::file_test
