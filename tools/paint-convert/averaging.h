// The option --average: readings wait for the others of their name, code or day, and go on as their mean.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cli/tool.h"
#include "paint/paint.h"
#include "tool.h"

namespace goniochrome::tool {

class Averaging {
 public:
  Averaging(const Options& options, cli::Session& session) : options_(options), session_(session) {}

  // `place` is where the reading stands. Error: it lacks the code or the date that is asked for.
  Result<void> take(paint::Paint reading, const std::string& place);

  // Gives `pass` the mean of each group, in the order of its first reading, and `skip` what has none.
  Result<void> finish(const std::function<Result<void>(paint::Paint, const std::string&)>& pass,
                      const std::function<Result<void>(const Error&)>& skip);

 private:
  struct Group {
    std::string key, place;
    std::vector<paint::Paint> readings;
  };
  std::string name_of(const Group& group);

  const Options& options_;
  cli::Session& session_;
  std::map<std::string, std::size_t> places_;
  std::vector<Group> groups_;
  std::set<std::string> names_;  // of the means of codes
};

}  // namespace goniochrome::tool
