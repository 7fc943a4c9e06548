// Values of JSON objects, read without exceptions, which WebAssembly does not have.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "color/color.h"

namespace goniochrome::studio {

// Reads members of one object. The first that is missing or of another kind is the error(); all others are then empty.
class JsonReader {
 public:
  explicit JsonReader(const Json& object) : object_(object) {
    if (!object.is_object()) fail("an object", "the text");
  }

  bool has(const char* key) const { return object_.is_object() && object_.contains(key) && !object_.at(key).is_null(); }
  // A member that may be absent: null then.
  const Json& member(const char* key) const {
    static const Json kNone;
    return has(key) ? object_.at(key) : kNone;
  }
  double number(const char* key) {
    const Json& value = member(key);
    if (!value.is_number()) return fail("a number", key), 0;
    return value.get<double>();
  }
  double number(const char* key, double otherwise) { return has(key) ? number(key) : otherwise; }
  std::string text(const char* key) {
    const Json& value = member(key);
    if (!value.is_string()) return fail("a text", key), "";
    return value.get<std::string>();
  }
  std::string text(const char* key, const std::string& otherwise) { return has(key) ? text(key) : otherwise; }
  bool flag(const char* key) {
    const Json& value = member(key);
    if (!value.is_null() && !value.is_boolean()) fail("true or false", key);
    return value.is_boolean() && value.get<bool>();
  }
  // The numbers of a list; `count` of them, or any number for 0.
  std::vector<double> numbers(const char* key, std::size_t count = 0) {
    std::vector<double> result;
    const Json& list = member(key);
    bool right = list.is_array() && (count == 0 || list.size() == count);
    for (std::size_t i = 0; right && i < list.size(); ++i) {
      right = list[i].is_number();
      if (right) result.push_back(list[i].get<double>());
    }
    if (!right) fail(count == 0 ? "a list of numbers" : "a list of that many numbers", key);
    if (!right) result.assign(count, 0);
    return result;
  }
  color::Lab lab(const char* key) {
    const std::vector<double> of = numbers(key, 3);
    return {of[0], of[1], of[2]};
  }
  // The elements of a list that may be absent.
  const Json& list(const char* key) {
    static const Json kNone = Json::array();
    const Json& value = member(key);
    if (value.is_null()) return kNone;
    if (!value.is_array()) return fail("a list", key), kNone;
    return value;
  }

  void fail(const char* wanted, const char* key) {
    if (error_.ok()) error_ = input_error("\"{}\": {} is wanted", key, wanted);
  }
  const Result<void>& status() const { return error_; }

 private:
  const Json& object_;
  Result<void> error_;
};

}  // namespace goniochrome::studio
