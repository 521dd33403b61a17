// The commands of a room: takes them from any thread, carries them out in the order of their senders' turns, and
// answers each once.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include <spindrift/rooms/command.h>
#include <spindrift/rooms/command_queue.h>
#include <spindrift/rooms/room_actions.h>
#include <spindrift/rooms/room_data.h>
#include <spindrift/rooms/room_view.h>
#include <spindrift/rooms/water_change.h>
#include <spindrift/water/room_water.h>

namespace spindrift::rooms {

/// A token bucket of time, which limits the share of a kind of work; no clock is read. `share` seconds are added per
/// second, up to `burst`. Work may start while the balance is positive and may overdraw it, since its cost is known
/// only afterwards; the next work then waits until the debt is paid.
class WorkBudget {
 public:
  using Clock = std::chrono::steady_clock;

  WorkBudget(double share, Clock::duration burst) : share_(share), burst_(burst), left_(burst) {}

  [[nodiscard]] bool isOpen(Clock::time_point now) {
    const auto gained = std::chrono::duration_cast<Clock::duration>((now - updated_) * share_);
    left_ = updated_ == Clock::time_point{} ? burst_ : std::min(burst_, left_ + gained);
    updated_ = now;
    return left_ > Clock::duration{};
  }
  void spend(Clock::duration cost) { left_ -= cost; }

 private:
  double share_;
  Clock::duration burst_;
  Clock::duration left_;
  Clock::time_point updated_{};
};

/// Lives on the simulation thread, except for the functions marked "any thread".
class CommandDesk {
 public:
  using TimePoint = CommandQueue::TimePoint;
  using Outcome = water::RoomWater::Outcome;

  /// The arguments outlive this.
  CommandDesk(RoomData& room, RoomActions& actions, WaterChange& change);

  /// Any thread. Checks the sender's role, the lesson and the scene, then queues the command. Otherwise returns the
  /// rejection with the command's number; a full queue is BUSY.
  [[nodiscard]] Outcome admit(Command command, const RoomSnapshot& room);
  /// Any thread. Number of commands that wait.
  [[nodiscard]] std::size_t waitingCount() const { return queue_.size(); }

  /// Returns whether carryOut() has something to do, now or soon.
  [[nodiscard]] bool hasWork() const { return waitingCount() > 0 || (values_ && !values_->relaid); }
  /// Carries out what waits, heavy commands within their share of the time.
  void carryOut(TimePoint now);
  /// Any thread. CommandQueue::isBusyWith().
  [[nodiscard]] bool isBusyWith(const core::Sender& sender) const { return queue_.isBusyWith(sender); }
  /// Answers the steps whose ticks are done.
  void finishSteps();
  /// Takes over particles that are laid out anew, if they are ready.
  void finishRelayout();
  /// Answers the commands that asked for another scene: WaterChange::Built::outcome.
  void sceneChanged(const Outcome& outcome);
  /// Rejects everything that waits but commands whose scene is being built.
  void rejectAll(const wire::CommandRejection& rejection);
  /// Tells the senders the outcomes of their commands, after making sure that what is promised is on disk.
  void sendAnswers();
  /// The room ends: rejects all commands and tells their senders.
  void close();

 private:
  using Batch = CommandQueue::Batch;
  struct Answer {
    Command command;
    Outcome rejected{};
    v1::Ack ack{};  ///< with the ids that the command gave out
  };
  /// Values of one sender for one parameter. Tried from the newest on, until the water accepts one.
  struct Values {
    Batch untried;                    ///< oldest first
    std::vector<Answer> tried{};      ///< newest first
    std::optional<Command> relaid{};  ///< the value whose particles are being laid out; the room stands still
    TimePoint begin{};                ///< of that layout
  };

  /// Row of the table in command_desk.cpp: one kind of command.
  struct Kind;
  static const Kind& kindOf(const v1::Command& command);
  friend const CommandTraits& traitsOf(const v1::Command& command);

  void apply(Batch batch);
  void beginScene(Batch batch);
  /// Answers a Step now, unless it waits for its ticks.
  void beginStep(Batch batch);
  void setParameters(Batch values) { tryNewest({.untried = std::move(values)}); }
  void tryNewest(Values values);
  /// Leaves the values to a later round; their sender's later commands wait for them.
  void putOff(Values values);
  /// Takes back values that were left.
  Values resume();
  /// Answers all commands of `values`: untried ones are acknowledged as superseded, tried ones get their outcomes.
  void conclude(Values values);
  /// Returns why the scene, or the time of a tick, does not allow the value.
  [[nodiscard]] Outcome refuseValue(const Command& command) const;
  /// Checks the command against the scene again if the scene changed since the command was admitted.
  [[nodiscard]] Outcome checkAgain(const Command& command) const;
  void answer(Batch batch, const Outcome& outcome, const v1::Ack& ack = {});

  RoomData& room_;
  RoomActions& actions_;
  WaterChange& change_;
  CommandQueue queue_;
  WorkBudget heavy_budget_;
  std::optional<Values> values_;  ///< that are not concluded; no heavy command is carried out meanwhile
  Batch scene_batch_;             ///< equal commands whose scene is being built
  std::vector<Answer> answers_;   ///< since the last sendAnswers()
};

}  // namespace spindrift::rooms
