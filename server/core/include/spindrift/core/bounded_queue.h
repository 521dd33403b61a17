// A queue with a bound that is part of its construction; a full queue refuses, it never grows and never blocks.
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

namespace spindrift::core {

/// Many producers, one consumer. `tryPush` on a full queue returns false and leaves the value alone.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity_count) : capacity_count_(capacity_count) {}

  [[nodiscard]] bool tryPush(T&& value) {
    const std::lock_guard lock(mutex_);
    if (items_.size() >= capacity_count_) return false;
    items_.push_back(std::move(value));
    return true;
  }

  /// Everything queued so far, in arrival order; the queue is empty afterwards.
  [[nodiscard]] std::vector<T> drain() {
    const std::lock_guard lock(mutex_);
    std::vector<T> out(std::make_move_iterator(items_.begin()), std::make_move_iterator(items_.end()));
    items_.clear();
    return out;
  }

  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return items_.size();
  }

  [[nodiscard]] std::size_t capacity() const { return capacity_count_; }

 private:
  const std::size_t capacity_count_;
  mutable std::mutex mutex_;
  std::deque<T> items_;
};

}  // namespace spindrift::core
