// Who holds the clock of a room, and how far it may go. No clock is read: the caller passes the wall time in.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/sender.h>

namespace spindrift::rooms {

/// Limit of holders of one clock.
inline constexpr std::size_t kClockHolderMaxCount = 16;

/// While somebody holds the clock, the room makes the ticks that all holders have asked for.
class HeldClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  struct Terms {
    double speed = 0.0;  ///< simulated seconds per wall second; 0: as fast as the machine can
    double timeout_s = 10.0;
  };
  struct Holder {
    core::Sender who{};  ///< a session
    std::string name{};  ///< for people
    Terms terms{};
    std::uint32_t ticks_to_come = 0;  ///< that it has asked for
    TimePoint waiting_since{};        ///< from when on the room waits for it; of use while no ticks are to come
  };

  [[nodiscard]] bool isHeld() const { return !holders_.empty(); }
  /// The holders, by their person's number.
  [[nodiscard]] const std::vector<Holder>& holders() const { return holders_; }
  /// Returns null if the sender's session does not hold the clock.
  [[nodiscard]] const Holder* find(const core::Sender& sender) const;
  /// Lowest speed that a holder asks for; 0: as fast as the machine can.
  [[nodiscard]] double speed() const;
  /// Ticks that all holders have asked for; 0 for a clock that nobody holds.
  [[nodiscard]] std::uint32_t ticksToCome() const;
  /// Returns when the first silent holder loses the clock; nullopt: the room waits for nobody.
  [[nodiscard]] std::optional<TimePoint> expiry() const;

  /// Adds a holder, or changes the terms of one. False: there are kClockHolderMaxCount others.
  [[nodiscard]] bool take(const core::Sender& who, std::string name, const Terms& terms, TimePoint now);
  /// Adds ticks to what a holder has asked for.
  void ask(const core::Sender& who, std::uint32_t tick_count);
  /// A tick was made at `now`.
  void ticked(TimePoint now);
  /// Forgets all ticks that were asked for. The time-outs begin anew.
  void dropTicks(TimePoint now);
  /// The time-out of this holder begins anew.
  void excuse(const core::Sender& who, TimePoint now);
  /// Removes the holders for which `holds` returns true, and returns them.
  std::vector<Holder> removeIf(const std::function<bool(const Holder&)>& holds);
  /// Returns whether the room has waited for this holder for longer than its time-out.
  [[nodiscard]] static bool isSilent(const Holder& holder, TimePoint now);

 private:
  [[nodiscard]] static TimePoint expiryOf(const Holder& holder);

  std::vector<Holder> holders_;
};

}  // namespace spindrift::rooms
