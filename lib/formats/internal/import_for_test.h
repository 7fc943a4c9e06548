// A test of one reader of foreign paints, on texts and files.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "base/file.h"
#include "formats/imported.h"
#include "formats/scratch_for_test.h"

namespace goniochrome::formats {

template <Result<ImportedPaints> (*Read)(InputFile, const ImportOptions&)>
class ImportTest : public testing::Test {
 protected:
  std::string path() const { return scratch_.path("paints"); }
  static Result<ImportedPaints> read_file(const std::string& path, const ImportOptions& options = {}) {
    auto input = InputFile::open(path);
    EXPECT_TRUE(input.ok());
    return Read(std::move(input).value(), options);
  }
  Result<ImportedPaints> read(std::string_view text, const ImportOptions& options = {}) const {
    return read_file(scratch_.file("paints", text), options);
  }
  ImportedPaints good(std::string_view text, const ImportOptions& options = {}) const {
    auto result = read(text, options);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(result).value() : ImportedPaints{};
  }
  std::string refusal(std::string_view text) const {
    const auto result = read(text);
    EXPECT_FALSE(result.ok());
    return result.ok() ? "" : result.error().message;
  }

 private:
  ScratchFolder scratch_;
};

}  // namespace goniochrome::formats
