// The paints of a page.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::tool {

// The paints of a page: an index that the compiled library searches, and a line of JSON for each paint. Lines of paints
// that hold nothing but readings and gloss are lists: the number of their layout, name, code, class, and then the
// numbers of all rows and gloss readings in the layout's order. Other lines are objects of file and paint.
class PackedLibrary {
 public:
  // Takes a paint of a file of that name, which is empty for a paint of the tool itself.
  void add(const std::string& file, const paint::Paint& paint);
  std::size_t size() const { return paints_.size(); }
  const std::vector<paint::Paint>& paints() const { return paints_; }
  const std::string& lines() const { return lines_; }
  const Json& layouts() const { return layouts_; }
  // The content of its index. Error: a paint whose metrics cannot be computed.
  Result<std::string> index() const;

 private:
  std::vector<paint::Paint> paints_;
  std::string lines_;
  Json layouts_ = Json::array();
  std::map<std::string, std::size_t> numbers_;  // of layouts, by their text
};

}  // namespace goniochrome::tool
