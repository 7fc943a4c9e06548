#include "base/file_names.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/text.h"

namespace goniochrome {

namespace {

constexpr std::size_t kMostBytes = 180;  // a file's name may have 255, and an ending and a number are to come
constexpr std::string_view kWords[] = {"name", "code", "index"};

// The bytes of the UTF-8 character that begins at `at`, or 1 where that is none.
std::size_t character_bytes(std::string_view text, std::size_t at) {
  const auto lead = static_cast<unsigned char>(text[at]);
  const std::size_t bytes = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
  return at + bytes <= text.size() ? bytes : 1;
}

// FNV-1a, 64 bits: two of a million names have the same hash with a chance of 3 in a hundred million.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char byte : text) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return hash;
}

// The word in braces that begins at `at`, where there is one that is closed.
std::optional<std::string> word_at(std::string_view pattern, std::size_t at) {
  if (pattern[at] != '{') return std::nullopt;
  const auto end = pattern.find('}', at);
  if (end == std::string_view::npos) return std::nullopt;
  return std::string(pattern.substr(at + 1, end - at - 1));
}

Error unknown_word(const std::string& pattern, const std::string& word, const std::vector<std::string>& words,
                   const std::string& option) {
  std::string known;
  for (const std::string& one : words) known += (known.empty() ? "{" : ", {") + one + "}";
  return usage_error("{} is \"{}\": {{{}}} is not known here: there is {}", option, pattern, word, known);
}

bool is_letters(std::string_view word) {
  return !word.empty() &&
         std::ranges::all_of(word, [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
}

}  // namespace

std::string safe_file_name(std::string_view text) {
  const std::string plain = plain_utf8(text);
  std::string safe;
  for (std::size_t at = 0; at < plain.size();) {
    const std::size_t bytes = character_bytes(plain, at);
    if (safe.size() + bytes > kMostBytes) break;
    const auto byte = static_cast<unsigned char>(plain[at]);
    const bool refused =
        byte < 0x20 || byte == 0x7F || std::string_view("/\\:*?\"<>|").find(plain[at]) != std::string::npos;
    safe += refused ? "_" : plain.substr(at, bytes);
    at += bytes;
  }
  if (!safe.empty() && safe.front() == '.') safe.front() = '_';
  for (std::size_t i = safe.size(); i > 0 && (safe[i - 1] == '.' || safe[i - 1] == ' '); --i) safe[i - 1] = '_';
  return safe.empty() ? "_" : safe;
}

bool FileNames::is_pattern(std::string_view text) {
  return std::ranges::any_of(kWords, [&](std::string_view word) {
    return text.find("{" + std::string(word) + "}") != std::string_view::npos;
  });
}

Result<void> FileNames::check(const std::string& path, const std::vector<std::string>& words,
                              const std::string& option) {
  for (std::size_t at = 0; at < path.size(); ++at)
    if (const auto word = word_at(path, at);
        word && is_letters(*word) && std::ranges::find(words, *word) == words.end())
      return unknown_word(path, *word, words, option);
  return {};
}

Result<FileNames> FileNames::create(const std::string& pattern, const std::vector<std::string>& words,
                                    const std::string& option) {
  FileNames names;
  std::string plain;
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    const auto word = word_at(pattern, at);
    if (!word) {
      plain += pattern[at];
      continue;
    }
    if (std::ranges::find(words, *word) == words.end()) return unknown_word(pattern, *word, words, option);
    if (!plain.empty()) names.pieces_.push_back({plain, false});
    plain.clear();
    names.pieces_.push_back({*word, true});
    at += word->size() + 1;
  }
  if (!plain.empty()) names.pieces_.push_back({plain, false});
  return names;
}

bool FileNames::has(std::string_view word) const {
  return std::ranges::any_of(pieces_, [&](const Piece& piece) { return piece.is_word && piece.text == word; });
}

bool FileNames::is_new(const std::string& path) {
  return taken_.emplace(hash_of(path), 1).second;
}

std::string FileNames::next(std::size_t index, const std::string& name, const std::string& code) {
  std::string text;
  for (const Piece& piece : pieces_) {
    if (!piece.is_word) {
      text += piece.text;
    } else if (piece.text == "index") {
      text += fmt::format("{:04}", index);
    } else {
      text += safe_file_name(piece.text == "code" && !code.empty() ? code : name);
    }
  }
  if (is_new(text)) return text;
  const std::filesystem::path path(text);
  while (true) {
    const std::string numbered =
        fmt::format("{}-{}{}", path.stem().string(), ++taken_[hash_of(text)], path.extension().string());
    std::string whole = (path.parent_path() / numbered).string();
    if (is_new(whole)) return whole;
  }
}

}  // namespace goniochrome
