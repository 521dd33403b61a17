// A thread that runs pieces of work beside the simulation, one at a time.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace spindrift::core {

/// Runs work in order of arrival. The callers bound the queue.
class Worker {
 public:
  /// `niceness`: 0 for normal priority, up to 19 for the lowest. `done` is called on the worker's thread after each
  /// piece of work.
  explicit Worker(int niceness, std::function<void()> done = {});
  /// Ends the thread after the current work; waiting pieces are called with runs = false.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  using Work = std::function<void(bool runs)>;
  /// Any thread.
  void push(Work work);
  /// Any thread. Changes the priority as soon as the current piece of work is done; threads that later pieces start
  /// inherit it. Only a privileged process can raise it again; where it cannot be changed, it stays.
  void setNiceness(int niceness);
  /// Any thread. From now on waiting and new pieces are called with runs = false; the current one continues.
  void end();
  /// Any thread. Returns whether no work waits or runs.
  [[nodiscard]] bool isIdle() const { return unfinished_count_ == 0; }

 private:
  void loop();

  std::atomic<int> niceness_;
  const std::function<void()> done_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Work> work_;
  std::atomic<std::size_t> unfinished_count_ = 0;
  bool is_ending_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace spindrift::core
