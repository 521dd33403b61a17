// Creates several device objects in a row and stops at the first error.
#pragma once

#include <optional>
#include <utility>

#include <spindrift/core/result.h>

namespace spindrift::sim {

/// `creation(&target, Result)…`: assigns successes, keeps the first error.
class Creation {
 public:
  template <typename T>
  Creation& operator()(T& target, core::Result<T>&& made) {
    if (made)
      target = *std::move(made);
    else if (!error_)
      error_ = made.error();
    return *this;
  }
  [[nodiscard]] const std::optional<core::Error>& error() const { return error_; }

 private:
  std::optional<core::Error> error_;
};

}  // namespace spindrift::sim
