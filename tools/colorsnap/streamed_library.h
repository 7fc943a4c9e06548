// A library that comes through a pipe: it is read once and kept, with what stood before its paints.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paint_stream.h"

namespace goniochrome::tool {

struct StreamedLibrary {
  std::vector<paint::Paint> paints;
  Prolog prolog;

  // Nothing where `reference` names a plain file, or some of its paints. Error: the stream cannot be read.
  static Result<std::optional<StreamedLibrary>> open(const std::string& reference, cli::Session& session);

  // The paints one after the other.
  std::function<Result<std::optional<paint::Paint>>()> reader() const {
    return [this, next = std::size_t{0}]() mutable -> Result<std::optional<paint::Paint>> {
      return next < paints.size() ? std::optional(paints[next++]) : std::nullopt;
    };
  }
};

}  // namespace goniochrome::tool
