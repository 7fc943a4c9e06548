// For tests: what a table says as a whole.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "base/scratch_for_test.h"
#include "formats/csv.h"

namespace goniochrome::formats::csv_for_test {

// Paints and messages as the reader gave them, messages without the folder.
struct Reading {
  std::vector<paint::Paint> paints;
  std::vector<int> lines;
  std::vector<std::string> errors, warnings, closing;
};

inline Reading reading_of(const std::string& path, Scale scale = Scale::kUnstated) {
  Reading reading;
  const auto named = [](const std::string& message) {
    const auto at = message.find("/p.csv");
    return at == std::string::npos ? message : message.substr(at + 1);
  };
  auto reader = CsvPaintReader::open(std::move(*InputFile::open(path)), scale);
  if (!reader.ok()) {
    reading.errors.push_back(named(reader.error().message));
    return reading;
  }
  for (const std::string& warning : reader->warnings()) reading.warnings.push_back(named(warning));
  for (;;) {
    auto paint = reader->next();
    if (!paint.ok()) {
      reading.errors.push_back(named(paint.error().message));
      continue;
    }
    if (!*paint) break;
    reading.paints.push_back(std::move(**paint));
    reading.lines.push_back(reader->line());
  }
  for (const std::string& warning : reader->closing_warnings()) reading.closing.push_back(named(warning));
  return reading;
}

inline Reading reading_of_text(const std::string& text, Scale scale = Scale::kUnstated) {
  const ScratchFolder folder;
  return reading_of(folder.file("p.csv", text), scale);
}

}  // namespace goniochrome::formats::csv_for_test
