#include "water_builder.h"

#include <utility>

#include <sys/resource.h>

namespace spindrift::app {
namespace {

/// Of this thread alone, which Linux allows: ticks of running rooms come first. Best effort.
void lowerPriority() {
  constexpr int kNice = 10;
  (void)setpriority(PRIO_PROCESS, 0, kNice);
}

}  // namespace

WaterBuilder::WaterBuilder(gpu::DeviceChoice device, std::function<void()> done)
    : device_(std::move(device)), done_(std::move(done)), thread_([this] { loop(); }) {}

WaterBuilder::~WaterBuilder() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

std::future<WaterBuilder::Built> WaterBuilder::build(v1::Scene scene) {
  auto promise = std::make_shared<std::promise<Built>>();
  auto future = promise->get_future();
  push([this, promise, scene = std::move(scene)](bool runs) mutable {
    if (!runs) return promise->set_value(core::Error{core::ErrorCode::kUnavailable, "the server shuts down"});
    Built built = Water::create(device_, std::move(scene));
    if (built) (*built)->release();
    promise->set_value(std::move(built));
  });
  return future;
}

void WaterBuilder::dispose(std::unique_ptr<Water> water) {
  if (!water) return;
  water->release();
  push([kept = std::shared_ptr<Water>(std::move(water))](bool) mutable { kept.reset(); });
}

void WaterBuilder::push(std::function<void(bool runs)> work) {
  {
    const std::lock_guard lock(mutex_);
    work_.push_back(std::move(work));
  }
  wake_.notify_one();
}

void WaterBuilder::loop() {
  lowerPriority();
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stopping_ || !work_.empty(); });
    if (work_.empty()) return;
    auto work = std::move(work_.front());
    work_.pop_front();
    const bool runs = !stopping_;
    lock.unlock();
    work(runs);
    work = nullptr;
    if (done_) done_();
    lock.lock();
  }
}

}  // namespace spindrift::app
