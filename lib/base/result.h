// Errors as values: a Result<T> is a T, or an Error that says where something is wrong, what it is, and what to do.
#pragma once

#include <fmt/core.h>

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace goniochrome {

// The kind of an error decides the exit status of a tool: see exit_status() in cli/tool.h.
enum class ErrorKind {
  kUsage,  // the command line is off
  kInput,  // bad input or I/O
  kLimit,  // stopped by a time or memory limit
  kBug,    // an internal promise was broken
};

// `message` is one line for the person who gets it: `paints.xml:14: L* is "12,5": write a decimal point`.
struct Error {
  ErrorKind kind = ErrorKind::kInput;
  std::string message;
};

template <class... Args>
Error input_error(fmt::format_string<Args...> text, Args&&... args) {
  return {ErrorKind::kInput, fmt::format(text, std::forward<Args>(args)...)};
}

template <class... Args>
Error usage_error(fmt::format_string<Args...> text, Args&&... args) {
  return {ErrorKind::kUsage, fmt::format(text, std::forward<Args>(args)...)};
}

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}

  bool ok() const { return !error_; }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

}  // namespace goniochrome

// GONIO_TRY(statement) returns the error of a Result<void>, or goes on.
#define GONIO_TRY(expression)                                                              \
  do {                                                                                     \
    if (auto gonio_result = (expression); !gonio_result.ok()) return gonio_result.error(); \
  } while (false)

// GONIO_ASSIGN(declaration, expression) returns the error of a Result<T>, or moves its value into the declaration.
#define GONIO_ASSIGN(declaration, expression) \
  GONIO_ASSIGN_NAMED(GONIO_CONCAT(gonio_result_, __LINE__), declaration, expression)
#define GONIO_ASSIGN_NAMED(name, declaration, expression) \
  auto name = (expression);                               \
  if (!name.ok()) return name.error();                    \
  declaration = std::move(name).value()
#define GONIO_CONCAT(a, b) GONIO_CONCAT_INNER(a, b)
#define GONIO_CONCAT_INNER(a, b) a##b
