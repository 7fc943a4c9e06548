#include "base/file_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/scratch_for_test.h"

namespace goniochrome::file_cache_test {
namespace {

using testing::HasSubstr;

class Caches : public testing::Test {
 protected:
  std::uint64_t bytes_kept() const {
    std::uint64_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) bytes += entry.file_size();
    return bytes;
  }
  std::vector<std::filesystem::path> files_kept() const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) files.push_back(entry.path());
    return files;
  }

  ScratchFolder folder_;
  std::string path_ = folder_.path("made/here");
  FileCache cache_{path_, ".bin", 1000};
};

TEST_F(Caches, ContentComesBackByItsKey) {
  EXPECT_FALSE(cache_.find("aa"));
  const std::string bytes("a\0b\nc", 5);
  ASSERT_TRUE(cache_.keep("aa", bytes).ok());
  ASSERT_TRUE(cache_.keep("ab", "").ok());
  EXPECT_EQ(cache_.find("aa"), bytes);
  EXPECT_EQ(cache_.find("ab"), "");
  EXPECT_FALSE(cache_.find("a"));
  // Another cache of the same folder knows it too, and files of other endings are not its own.
  EXPECT_EQ(FileCache(path_, ".bin", 1000).find("aa"), bytes);
  EXPECT_FALSE(FileCache(path_, ".txt", 1000).find("aa"));
}

TEST_F(Caches, TheFileUsedLongestAgoGoesFirst) {
  const std::string three_hundred(300, 'x');
  for (const char* key : {"a", "b", "c"}) {
    ASSERT_TRUE(cache_.keep(key, three_hundred).ok());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(cache_.find("a"));
  ASSERT_TRUE(cache_.keep("d", three_hundred).ok());
  EXPECT_TRUE(cache_.find("a"));
  EXPECT_FALSE(cache_.find("b"));
  EXPECT_TRUE(cache_.find("c"));
  EXPECT_LE(bytes_kept(), 1000U);
}

TEST_F(Caches, ContentLargerThanTheBoundIsNotKept) {
  ASSERT_TRUE(cache_.keep("a", std::string(900, 'x')).ok());
  const auto kept = cache_.keep("b", std::string(1001, 'x'));
  ASSERT_FALSE(kept.ok());
  EXPECT_THAT(kept.error().message, HasSubstr("has room for 1000 bytes, and this takes 1001"));
  EXPECT_TRUE(cache_.find("a"));
}

TEST_F(Caches, DamagedFileIsRemoved) {
  for (const std::string damage : {"", "12", "1x34", "123456"}) {
    ASSERT_TRUE(cache_.keep("a", "1234").ok());
    ASSERT_EQ(files_kept().size(), 1U);
    std::ofstream(files_kept().front(), std::ios::trunc) << damage;
    EXPECT_FALSE(cache_.find("a")) << damage;
    EXPECT_TRUE(files_kept().empty()) << damage;
  }
}

TEST_F(Caches, FolderThatCannotBeMadeIsAnError) {
  const FileCache sealed(folder_.file("file", "") + "/below", ".bin", 1000);
  EXPECT_FALSE(sealed.find("a"));
  const auto kept = sealed.keep("a", "1");
  ASSERT_FALSE(kept.ok());
  EXPECT_THAT(kept.error().message, HasSubstr("cannot be made a folder"));
}

TEST_F(Caches, ManyWritersLeaveWholeFilesWithinTheBound) {
  std::vector<std::thread> writers;
  for (int writer = 0; writer < 8; ++writer)
    writers.emplace_back([&, writer] {
      for (int i = 0; i < 20; ++i) {
        const std::string key(1, static_cast<char>('a' + (writer + i) % 5)), content(250, key[0]);
        const auto kept = cache_.keep(key, content);
        EXPECT_TRUE(kept.ok()) << kept.error().message;
        EXPECT_EQ(cache_.find(key).value_or(content), content);  // another writer may have taken its room
      }
    });
  for (std::thread& writer : writers) writer.join();
  ASSERT_TRUE(cache_.keep("f", std::string(250, 'f')).ok());
  EXPECT_LE(bytes_kept(), 1000U);
}

TEST(UserCacheFolder, FollowsTheEnvironment) {
  const char* old_cache = std::getenv("XDG_CACHE_HOME");
  const char* old_home = std::getenv("HOME");
  const std::string cache = old_cache ? old_cache : "", home = old_home ? old_home : "";
  setenv("XDG_CACHE_HOME", "/caches", 1);
  setenv("HOME", "/home/somebody", 1);
  EXPECT_EQ(user_cache_folder(), "/caches/goniochrome");
  setenv("XDG_CACHE_HOME", "relative", 1);
  EXPECT_EQ(user_cache_folder(), "/home/somebody/.cache/goniochrome");
  unsetenv("XDG_CACHE_HOME");
  unsetenv("HOME");
  EXPECT_EQ(user_cache_folder(), "");
  if (old_cache) setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  if (old_home) setenv("HOME", home.c_str(), 1);
}

}  // namespace
}  // namespace goniochrome::file_cache_test
