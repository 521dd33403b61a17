// Result and Error: how a module reports that something outside the program (a file, a device, a client) failed. Bugs
// in the program itself are assertions, not errors.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace spindrift::core {

/// Category of a failure; cli maps each to an exit code.
enum class ErrorCode {
  kInvalidInput,  ///< bad flag, scene, file, message: exit code 2
  kUnavailable,   ///< port in use, file missing, web client not built: exit code 2
  kNoDevice,      ///< no usable EGL device or OpenGL version: exit code 3
  kCheckFailed,   ///< a check or comparison failed: exit code 1
  kInternal,      ///< a driver or library refused what should work: exit code 1
};

/// One line for the user: what failed, the value, the bound, what to do. No trailing newline.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;
};

/// Returns the error of a wrong input.
inline Error invalid(std::string message) {
  return {ErrorCode::kInvalidInput, std::move(message)};
}

/// Returns the error of something outside the program that cannot be used.
inline Error unavailable(std::string message) {
  return {ErrorCode::kUnavailable, std::move(message)};
}

/// Returns the program's exit code for this category; never 0.
constexpr int exitCode(ErrorCode code) {
  if (code == ErrorCode::kNoDevice) return 3;
  return code == ErrorCode::kInvalidInput || code == ErrorCode::kUnavailable ? 2 : 1;
}

/// Either a T or an Error. Test with `if (!result)`, then read `*result` or `result.error()`.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT: implicit on purpose
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit on purpose

  explicit operator bool() const { return state_.index() == 0; }
  T& operator*() & { return std::get<0>(state_); }
  const T& operator*() const& { return std::get<0>(state_); }
  T&& operator*() && { return std::get<0>(std::move(state_)); }
  T* operator->() { return &std::get<0>(state_); }
  const T* operator->() const { return &std::get<0>(state_); }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT: implicit on purpose

  explicit operator bool() const { return !error_; }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

}  // namespace spindrift::core
