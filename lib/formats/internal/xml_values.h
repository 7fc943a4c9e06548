// The values of one tag's attributes, read with errors that name file, line and remedy.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "color/color.h"
#include "formats/internal/xml_stream.h"

namespace goniochrome::formats {

enum class Domain { kAny, kNotNegative, kPositive, kRefractiveIndex };

// The number that `text` spells. Error: `is "12,5": write a decimal point`, without place and name.
Result<double> number_in(std::string_view text, Domain domain = Domain::kAny);

class XmlValues {
 public:
  XmlValues(const std::string& file, const XmlTag& tag) : file_(file), tag_(tag) {}

  const XmlTag& tag() const { return tag_; }

  // `names` are separated by blanks; "?" behind a name says that it may be missing. Any other attribute is refused, but
  // for those of XML Schema itself (xsi:schemaLocation).
  Result<void> check_names(std::string_view names) const;

  bool has(std::string_view name) const { return find(name) != nullptr; }
  // The value, "" where the attribute is missing.
  std::string_view text(std::string_view name) const;
  // A text that must not be empty.
  Result<void> name(std::string_view name, std::string& target) const;
  Result<void> number(std::string_view name, double& target, Domain domain = Domain::kAny) const;
  // L, a and b.
  Result<void> lab(color::Lab& target) const;
  // Three channels: prefix + "r", "g", "b".
  Result<void> rgb(std::string_view prefix, color::Rgb& target) const;

  // `file:line: name is "value": remedy`
  Error error(std::string_view name, std::string_view remedy) const;
  // `file:line: what`
  Error error(std::string_view what) const;

 private:
  const XmlAttribute* find(std::string_view name) const;

  const std::string& file_;
  const XmlTag& tag_;
};

}  // namespace goniochrome::formats
