#include "library/index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/file.h"
#include "base/scratch_for_test.h"
#include "formats/paint_source.h"
#include "formats/xml.h"
#include "library/internal/random_paints_for_test.h"
#include "library/search.h"

namespace goniochrome::library::index_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class LibraryIndexFile : public testing::Test {
 protected:
  void SetUp() override { write_library(100); }

  void write_library(int paints) {
    std::mt19937_64 random(3);
    auto writer = formats::PaintWriter::begin(OutputFile::create(path_).value()).value();
    for (int i = 0; i < paints; ++i)
      ASSERT_TRUE(writer.write(random_paints::paint(random, "p" + std::to_string(i), {15, 45, 110})).ok());
    ASSERT_TRUE(writer.finish().ok());
  }
  LibraryIndex opened() {
    auto index = LibraryIndex::open(path_);
    EXPECT_TRUE(index.ok()) << index.error().message;
    return std::move(index).value();
  }

  ScratchFolder folder_;
  const std::string path_ = folder_.path("library.paints.xml");
};

TEST_F(LibraryIndexFile, IsBuiltOnceAndThenMapped) {
  const LibraryIndex built = opened();
  EXPECT_EQ(built.origin(), LibraryIndex::Origin::kBuilt);
  EXPECT_EQ(built.note(), "there was none");
  const LibraryIndex mapped = opened();
  EXPECT_EQ(mapped.origin(), LibraryIndex::Origin::kMapped);
  ASSERT_EQ(mapped.size(), 100u);
  const auto paints = formats::read_paints(path_).value();
  for (std::size_t i = 0; i < paints.size(); ++i) {
    EXPECT_EQ(mapped.name(i), paints[i].name);
    EXPECT_EQ(mapped.code(i), paints[i].code);
    EXPECT_EQ(mapped.paint_class(i), paints[i].paint_class);
    for (const paint::MetricColumn& column : paint::metric_columns_without_fit()) {
      const double kept = mapped.metric(i, column), fresh = (*paint::metrics(paints[i])).*column.value;
      EXPECT_TRUE(kept == fresh || (std::isnan(kept) && std::isnan(fresh))) << column.name;
    }
  }
  ASSERT_EQ(mapped.sections().size(), 1u);
  EXPECT_EQ(mapped.sections()[0].geometries.size(), 3u);
  EXPECT_EQ(mapped.bytes(), fs::file_size(index_path(path_)));
}

// An index of an earlier version was taken as long as the library stayed the same.
TEST_F(LibraryIndexFile, AnotherVersionMakesItAnew) {
  for (const auto& [version, wanted] : {std::pair{"1", LibraryIndex::Origin::kBuilt},
                                        {"1", LibraryIndex::Origin::kMapped},
                                        {"2", LibraryIndex::Origin::kBuilt}}) {
    const auto index = LibraryIndex::open(path_, {}, version);
    ASSERT_TRUE(index.ok()) << index.error().message;
    EXPECT_EQ(index->origin(), wanted);
    const bool is_other = version[0] == '2';
    EXPECT_EQ(index->note() == "another version of this program made it", is_other);
  }
}

TEST_F(LibraryIndexFile, ChangedLibraryMakesItStale) {
  opened();
  write_library(101);
  const LibraryIndex again = opened();
  EXPECT_EQ(again.origin(), LibraryIndex::Origin::kBuilt);
  EXPECT_EQ(again.note(), "the library has changed");
  EXPECT_EQ(again.size(), 101u);

  // Same size, other content, other time: the checksum tells.
  std::string text = file_content(path_).value();
  text.replace(text.find("p100"), 4, "q100");
  std::ofstream(path_) << text;
  fs::last_write_time(path_, fs::last_write_time(path_) + std::chrono::seconds(5));
  EXPECT_EQ(opened().name(100), "q100");

  // Neither do size and time of modification tell two contents apart.
  const auto time = fs::last_write_time(path_);
  text.replace(text.find("q100"), 4, "r100");
  std::ofstream(path_) << text;
  fs::last_write_time(path_, time);
  EXPECT_EQ(opened().name(100), "r100");
}

TEST_F(LibraryIndexFile, TouchedLibraryIsStillTheSame) {
  opened();
  fs::last_write_time(path_, fs::last_write_time(path_) + std::chrono::seconds(5));
  EXPECT_EQ(opened().origin(), LibraryIndex::Origin::kMapped);
}

TEST_F(LibraryIndexFile, DamagedIndexIsRebuilt) {
  opened();
  const std::string whole = file_content(index_path(path_)).value();
  // Cut anywhere, or with a byte turned in the head, the directory or the numbers, which gave wrong answers in silence.
  for (std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{31}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(index_path(path_), std::ios::binary) << whole.substr(0, size);
    EXPECT_EQ(opened().origin(), LibraryIndex::Origin::kBuilt) << size;
  }
  std::mt19937_64 random(5);
  for (int i = 0; i < 600; ++i) {
    std::string damaged = whole;
    const std::size_t at = i % 3 == 0   ? random() % 64
                           : i % 3 == 1 ? whole.size() - 1 - random() % 2000
                                        : random() % whole.size();
    damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(1 + random() % 255));
    EXPECT_FALSE(LibraryIndex::from_bytes(damaged).ok()) << at;
  }
  std::ofstream(index_path(path_), std::ios::binary) << whole.substr(0, 63) + "!" + whole.substr(64);
  EXPECT_THAT(opened().note(), HasSubstr("damaged or of another version"));
  EXPECT_EQ(opened().origin(), LibraryIndex::Origin::kMapped);
}

TEST_F(LibraryIndexFile, StaysInMemoryWhereItCannotBeKept) {
  fs::create_directory(index_path(path_));
  const LibraryIndex index = opened();
  EXPECT_EQ(index.origin(), LibraryIndex::Origin::kInMemory);
  EXPECT_THAT(index.note(), HasSubstr("is a folder"));
  EXPECT_EQ(index.size(), 100u);
}

TEST_F(LibraryIndexFile, TellsWhatIsWrong) {
  EXPECT_THAT(LibraryIndex::open(folder_.path("none.xml")).error().message, HasSubstr("cannot be read"));
  EXPECT_THAT(LibraryIndex::open(folder_.path("")).error().message, HasSubstr("no plain file"));
  EXPECT_THAT(LibraryIndex::open("-").error().message, HasSubstr("-: cannot be read"));
  std::ofstream(path_) << "<paints";
  EXPECT_FALSE(LibraryIndex::open(path_).ok());
  EXPECT_FALSE(fs::exists(index_path(path_)));
}

}  // namespace
}  // namespace goniochrome::library::index_test
