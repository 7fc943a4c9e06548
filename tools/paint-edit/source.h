// The paints of several inputs as one stream.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paint_stream.h"

namespace goniochrome::tool {

// Reads FILE, FILE#NAMES and - one after the other, in constant memory. The first paint of each is read when the source
// is opened, so that the history of all is known before anything is written.
class PaintSource {
 public:
  // Error: a file that cannot be read, or a name that it does not have.
  static Result<PaintSource> open(const std::vector<std::string>& inputs, cli::Session& session);

  Result<std::optional<paint::Paint>> next();

  Prolog prolog();

 private:
  struct Input {
    formats::PaintSourcePointer source;
    std::optional<paint::Paint> first;  // read already

    Result<std::optional<paint::Paint>> next();
  };
  explicit PaintSource(cli::Session& session) : session_(session) {}

  cli::Session& session_;
  std::vector<Input> inputs_;
  std::size_t current_ = 0;
};

}  // namespace goniochrome::tool
