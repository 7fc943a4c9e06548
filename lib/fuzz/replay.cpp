// Runs a reader on a corpus and on mutations of it, without a fuzzer. This is what ctest runs. The same seed gives the
// same inputs.
//
//   fuzz_replay TARGET CORPUS INPUTS SEED
//
// A crash leaves the input in the scratch folder that the last line names; each input has 20 s of processor
// time and, without sanitizers, 2 GB.
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "fuzz/targets.h"

namespace goniochrome::fuzz {
namespace {

using Corpus = std::vector<std::string>;

Corpus corpus_in(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  Corpus corpus;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

// Extreme numbers, and characters that part numbers and words.
const std::vector<std::string> kWords = [] {
  std::vector<std::string> words = {"0", "-1", "1e308", "-1e400", "1e-400", "nan", "inf", "4294967296"};
  for (const char* word : {"-9223372036854775809", "1.5,2", "</a>", "<!--", "]]>", "\xff\xff\xff\xff", "\xef\xbb\xbf",
                           "\xed\xa0\x80", "\r\n"})
    words.emplace_back(word);
  for (const char letter : {'\n', '\t', '\0', ',', ';', '"', '\'', '<', '>', '&', '/', '#'})
    words.emplace_back(1, letter);
  words.emplace_back(8, '\0');
  words.emplace_back(300, '9');
  return words;
}();

// Makes one to eight changes of the kinds that break readers: bits, bytes, cuts, repetitions, pieces of other inputs,
// and the words above.
class Mutator {
 public:
  Mutator(const Corpus& corpus, std::uint64_t seed) : corpus_(corpus), random_(seed) {}

  std::string operator()() {
    std::string bytes = any_input();
    for (std::size_t changes = 1 + below(8); changes > 0; --changes) change(bytes);
    return bytes.substr(0, kMost);
  }

 private:
  static constexpr std::size_t kMost = 1 << 20;

  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  const std::string& any_input() { return corpus_[below(corpus_.size())]; }

  void change(std::string& bytes) {
    const std::size_t at = below(bytes.size() + 1), length = below(bytes.size() - at + 1);
    switch (below(8)) {
      case 0:
        flip(bytes, at, static_cast<char>(1 << below(8)));
        break;
      case 1:
        flip(bytes, at, static_cast<char>(random_()));
        break;
      case 2:
        bytes.erase(at, std::min<std::size_t>(length, 1 + below(64)));
        break;
      case 3:
        bytes.resize(at);
        break;
      case 4:
        bytes.insert(at, bytes.substr(at, std::min<std::size_t>(length, 200)));
        break;
      case 5:
        bytes.insert(at, kWords[below(kWords.size())]);
        break;
      case 6: {
        const std::string& word = kWords[below(kWords.size())];
        bytes.replace(at, std::min(word.size(), bytes.size() - at), word);
        break;
      }
      default: {
        const std::string& other = any_input();
        const std::size_t from = below(other.size());
        bytes.replace(at, length, other, from, below(other.size() - from) + 1);
      }
    }
  }

  static void flip(std::string& bytes, std::size_t at, char mask) {
    if (at < bytes.size()) bytes[at] ^= mask;
  }

  const Corpus& corpus_;
  std::mt19937_64 random_;
};

int replay(const FuzzTarget& target, const std::string& folder, long inputs, std::uint64_t seed) {
  const Corpus corpus = corpus_in(folder);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: has no inputs\n", folder.c_str());
    return 3;
  }
#if !defined(__SANITIZE_ADDRESS__)
  const rlimit memory = {std::size_t{2} << 30, std::size_t{2} << 30};
  setrlimit(RLIMIT_AS, &memory);
#endif
  const FuzzRun run(target);
  std::printf("%s: inputs pass through %s\n", std::string(target.name).c_str(), run.path().c_str());
  std::fflush(stdout);
  const auto pass = [&](const std::string& bytes) {
    constexpr itimerval kTime = {{0, 0}, {20, 0}};
    setitimer(ITIMER_PROF, &kTime, nullptr);
    run(bytes);
  };
  for (const std::string& bytes : corpus) pass(bytes);
  Mutator mutate(corpus, seed);
  for (long i = 0; i < inputs; ++i) pass(mutate());
  std::printf("%s: %zu inputs of the corpus and %ld mutations of seed %lu: read or refused\n",
              std::string(target.name).c_str(), corpus.size(), inputs, static_cast<unsigned long>(seed));
  return 0;
}

}  // namespace
}  // namespace goniochrome::fuzz

int main(int count, char** arguments) {
  if (count == 5)
    for (const goniochrome::fuzz::FuzzTarget& target : goniochrome::fuzz::fuzz_targets())
      if (target.name == arguments[1])
        return goniochrome::fuzz::replay(target, arguments[2], std::atol(arguments[3]),
                                         std::strtoull(arguments[4], nullptr, 10));
  std::fprintf(stderr, "usage: fuzz_replay TARGET CORPUS INPUTS SEED\n");
  return 2;
}
