// The thread that runs one room. Rooms share the device, the encoder and the disk, but no thread: a heavy room takes
// only its share of the processor from the others.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include <spindrift/rooms/room.h>

namespace spindrift::rooms {

class RoomThread {
 public:
  using Clock = std::chrono::steady_clock;

  /// The room's water is bound to no thread; from start() to stop() it is bound to this one. Takes Room::onWake().
  explicit RoomThread(std::shared_ptr<Room> room);
  ~RoomThread() { stop(); }
  RoomThread(const RoomThread&) = delete;
  RoomThread& operator=(const RoomThread&) = delete;

  [[nodiscard]] const std::shared_ptr<Room>& room() const { return room_; }
  /// Starts simulated time.
  void start();
  /// Ends after the present round; stop() waits for it, end() does not. Both idempotent.
  void end() { ring(*bell_, &Bell::stopping); }
  void stop();

  // Any thread.
  /// Lets the room run soon: it may be due earlier than it was.
  void wake() { ring(*bell_, &Bell::is_woken); }
  /// Share of its time that the thread worked lately, 0 to 1.
  [[nodiscard]] double busyShare() const { return busy_share_; }
  /// Seconds that the present round has taken so far; 0 between two rounds.
  [[nodiscard]] double roundTime_s() const;

 private:
  /// Outlives the thread: whoever holds the room may still wake it.
  struct Bell {
    std::mutex mutex;
    std::condition_variable rung;
    bool is_woken = false;  ///< since the begin of the last round
    bool stopping = false;
  };
  static void ring(Bell& bell, bool Bell::*why);
  void loop();

  const std::shared_ptr<Room> room_;
  const std::shared_ptr<Bell> bell_ = std::make_shared<Bell>();
  std::atomic<double> busy_share_{0.0};
  std::atomic<Clock::duration> round_began_{};  ///< since the clock's epoch; 0: no round runs
  std::thread thread_;
};

}  // namespace spindrift::rooms
