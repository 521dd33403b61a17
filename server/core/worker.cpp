#include <utility>

#include <sys/resource.h>

#include <spindrift/core/worker.h>

namespace spindrift::core {

Worker::Worker(int niceness, std::function<void()> done)
    : niceness_(niceness), done_(std::move(done)), thread_([this] { loop(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = is_ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void Worker::end() {
  const std::lock_guard lock(mutex_);
  is_ending_ = true;
}

void Worker::push(Work work) {
  ++unfinished_count_;
  {
    const std::lock_guard lock(mutex_);
    work_.push_back(std::move(work));
  }
  wake_.notify_one();
}

void Worker::setNiceness(int niceness) {
  if (niceness_.exchange(niceness) != niceness) push([](bool) {});
}

void Worker::loop() {
  int niceness = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stopping_ || !work_.empty(); });
    if (work_.empty()) return;
    Work work = std::move(work_.front());
    work_.pop_front();
    const bool runs = !is_ending_;
    lock.unlock();
    // On Linux this sets the priority of this thread alone.
    if (const int wanted = niceness_; std::exchange(niceness, wanted) != wanted)
      (void)setpriority(PRIO_PROCESS, 0, wanted);
    work(runs);
    work = nullptr;
    --unfinished_count_;
    if (done_) done_();
    lock.lock();
  }
}

}  // namespace spindrift::core
