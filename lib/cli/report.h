// The file of --report: figures of the whole run, and lists with an element for every paint.
#pragma once

#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "base/json.h"
#include "base/result.h"

namespace goniochrome::cli {

class Report {
 public:
  // The figures of the whole run.
  Json& results() { return results_; }

  // A list of `results`, empty at first.
  void begin_list(const std::string& list) { results_[list] = Json::array(); }

  // Appends to a list of `results`. The elements wait in a file without a name, so that a library of any size takes
  // constant memory. Where that file cannot be written, write() returns the error.
  void add(const std::string& list, const Json& element);

  // Writes the members of `head`, then `results`, to `path`, whole or not at all.
  Result<void> write(const std::string& path, const Json& head) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using Spool = std::unique_ptr<std::FILE, Close>;

  Json results_ = Json::object();
  std::map<std::string, Spool> spools_;  // elements of a list as text, without the brackets
};

}  // namespace goniochrome::cli
