#include "cli/report.h"

#include "base/file.h"

namespace goniochrome::cli {

namespace {

constexpr int kIndent = 2;

// The text of `value` as it stands `depth` levels deep in a document. Its first line follows a key and has no margin.
std::string text_at(const Json& value, int depth) {
  // Strings hold no raw newline, so each one here begins a line of the document.
  const std::string margin = "\n" + std::string(depth * kIndent, ' ');
  std::string text;
  for (const char c : json_text(value, kIndent)) {
    if (c == '\n')
      text += margin;
    else
      text += c;
  }
  return text;
}

Error unkept() {
  return input_error("the lists of --report cannot be kept for writing: make room in the folder for temporary files");
}

// Copies all of `spool` to `file`.
Result<void> copy(std::FILE* spool, OutputFile& file) {
  if (!spool || std::fflush(spool) != 0 || std::ferror(spool)) return unkept();
  std::rewind(spool);
  char buffer[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(buffer, 1, sizeof buffer, spool)) > 0) GONIO_TRY(file.write({buffer, count}));
  return std::ferror(spool) ? Result<void>(unkept()) : Result<void>();
}

}  // namespace

void Report::add(const std::string& list, const Json& element) {
  const auto [at, first] = spools_.try_emplace(list);
  if (first) {
    begin_list(list);
    at->second.reset(std::tmpfile());
  }
  if (!at->second) return;
  const std::string text = (first ? "\n      " : ",\n      ") + text_at(element, 3);
  std::fwrite(text.data(), 1, text.size(), at->second.get());
}

Result<void> Report::write(const std::string& path, const Json& head) const {
  GONIO_ASSIGN(OutputFile file, OutputFile::create(path));
  GONIO_TRY(file.write("{\n"));
  for (const auto& [key, value] : head.items())
    GONIO_TRY(file.write("  " + json_text(Json(key)) + ": " + text_at(value, 1) + ",\n"));
  GONIO_TRY(file.write("  \"results\": {"));
  const char* separator = "\n    ";
  for (const auto& [key, value] : results_.items()) {
    GONIO_TRY(file.write(separator + json_text(Json(key)) + ": "));
    separator = ",\n    ";
    const auto spool = spools_.find(key);
    if (spool == spools_.end()) {
      GONIO_TRY(file.write(text_at(value, 2)));
      continue;
    }
    GONIO_TRY(file.write("["));
    GONIO_TRY(copy(spool->second.get(), file));
    GONIO_TRY(file.write("\n    ]"));
  }
  GONIO_TRY(file.write(results_.empty() ? "}\n}\n" : "\n  }\n}\n"));
  return file.commit();
}

}  // namespace goniochrome::cli
