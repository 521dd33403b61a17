#include <utility>

#include <spindrift/rooms/room_thread.h>

namespace spindrift::rooms {
namespace {

/// Share of its time that a thread works, over the last window that is complete.
class BusyShare {
 public:
  using Clock = std::chrono::steady_clock;
  explicit BusyShare(Clock::time_point now) : begin_(now) {}
  void waited(Clock::time_point from, Clock::time_point to) {
    waited_ += to - from;
    if (to - begin_ < kWindow) return;
    share_ = 1.0 - std::chrono::duration<double>(waited_) / std::chrono::duration<double>(to - begin_);
    begin_ = to;
    waited_ = {};
  }
  [[nodiscard]] double value() const { return share_; }

 private:
  static constexpr std::chrono::seconds kWindow{2};
  Clock::time_point begin_;
  Clock::duration waited_{};
  double share_ = 0.0;
};

}  // namespace

RoomThread::RoomThread(std::shared_ptr<Room> room) : room_(std::move(room)) {
  room_->onWake([bell = bell_] { ring(*bell, &Bell::is_woken); });
}

void RoomThread::start() {
  if (!thread_.joinable()) thread_ = std::thread([this] { loop(); });
}

void RoomThread::stop() {
  end();
  if (thread_.joinable()) thread_.join();
}

void RoomThread::ring(Bell& bell, bool Bell::*why) {
  {
    const std::lock_guard lock(bell.mutex);
    bell.*why = true;
  }
  bell.rung.notify_one();
}

double RoomThread::roundTime_s() const {
  const Clock::duration began = round_began_;
  if (began == Clock::duration::zero()) return 0.0;
  return std::chrono::duration<double>(Clock::now().time_since_epoch() - began).count();
}

void RoomThread::loop() {
  room_->start(Clock::now());
  BusyShare busy(Clock::now());
  Bell& bell = *bell_;
  std::unique_lock lock(bell.mutex);
  while (!bell.stopping) {
    bell.is_woken = false;
    lock.unlock();
    if (const auto now = Clock::now(); room_->due() <= now) {
      round_began_ = now.time_since_epoch();
      room_->run(now);
      round_began_ = Clock::duration::zero();
    }
    const auto due = room_->due();
    lock.lock();
    const auto idle_since = Clock::now();
    bell.rung.wait_until(lock, due, [&] { return bell.stopping || bell.is_woken; });
    busy.waited(idle_since, Clock::now());
    busy_share_ = busy.value();
  }
  lock.unlock();
  room_->unbind();
}

}  // namespace spindrift::rooms
