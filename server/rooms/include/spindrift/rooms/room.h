// One room: a scene, its water, its clock, its people and their commands. Lives on one thread at a time (RoomThread),
// except for the functions marked "any thread".
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/demand_table.h>
#include <spindrift/core/result.h>
#include <spindrift/rooms/command.h>
#include <spindrift/rooms/command_desk.h>
#include <spindrift/rooms/room_actions.h>
#include <spindrift/rooms/room_data.h>
#include <spindrift/rooms/room_frames.h>
#include <spindrift/rooms/room_hulls.h>
#include <spindrift/rooms/room_keeping.h>
#include <spindrift/rooms/room_queries.h>
#include <spindrift/rooms/room_reports.h>
#include <spindrift/rooms/room_view.h>
#include <spindrift/rooms/water_change.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

class Room {
 public:
  using TimePoint = RoomTime::TimePoint;

  /// `water` is bound to the calling thread, which runs the room; it lives until releaseDevice(). `builder` makes the
  /// water of scene changes. `builder` and `outlets` outlive the room. With a kept room in `place`, `water` is built
  /// from its start_scene, and the room is at its snapshot. Before anything else restoreUntil() has to bring it where
  /// it was. Errors: kInvalidInput if the room cannot continue from there; those of the log.
  static core::Result<std::shared_ptr<Room>> begin(std::string name, std::unique_ptr<water::Water> water,
                                                   const RoomRules& rules, water::WaterBuilder& builder,
                                                   RoomOutlets& outlets, history::RoomPlace place,
                                                   v1::RoomAccess access);
  /// Repeats what happened after the snapshot, at least a tick and then until the deadline; with TimePoint::max() to
  /// the end. Returns whether the room is where it was; a new snapshot of it is then being written. Errors: those of
  /// begin(), and kUnavailable if the snapshot cannot be written; the room is of no use then.
  core::Result<bool> restoreUntil(TimePoint deadline);
  /// Waits until the deadline for the snapshot that restoreUntil() has begun. Returns whether the room can run: the
  /// snapshot is on the disk, or the disk has had RoomRules::disk_patience for it. Error: kUnavailable if it
  /// cannot be written; the room is of no use then.
  core::Result<bool> isOnDisk(TimePoint deadline) { return keeping_.isOnDisk(deadline); }

  // Any thread.
  [[nodiscard]] const std::string& name() const { return data_.name; }
  /// Digests of the tokens that were made for this room; never changes.
  [[nodiscard]] const v1::RoomAccess& access() const { return data_.access; }
  [[nodiscard]] std::shared_ptr<const RoomSnapshot> snapshot() const { return reports_.snapshot(); }
  [[nodiscard]] std::shared_ptr<const LessonState> lesson() const { return reports_.lesson(); }
  [[nodiscard]] std::shared_ptr<const RoomVitals> vitals() const { return vitals_.get(); }
  /// The people in the room.
  [[nodiscard]] Roster& roster() { return data_.roster; }
  [[nodiscard]] const Roster& roster() const { return data_.roster; }
  /// The only entry for commands, from sessions and requests: CommandDesk::admit().
  [[nodiscard]] std::optional<wire::CommandRejection> admit(Command command);
  /// Asks for the hash of the state between two ticks. `done` is called once, on the room's thread, or at once with
  /// kUnavailable when 16 others wait.
  void askStateHash(HashDone done);
  /// Asks for a snapshot on disk as soon as possible; returns false if the room is not kept.
  bool askForSnapshot();
  /// nullopt if the room is not kept on disk.
  [[nodiscard]] std::optional<history::StateKeeper::Status> keptStatus() const;
  /// Somebody without a session asks something of the room: keeps it awake for 10 s. Accepted commands do so, too.
  void use();
  /// Makes a room that stands still run soon: its sessions, or what they watch, have changed. Commands and people wake
  /// it by themselves.
  void wake();

  /// Returns the number of calls of run(). For tests.
  [[nodiscard]] std::uint64_t roundCount() const { return round_count_; }
  /// Returns what the sessions of the room need of its frames: they change it. Never null.
  [[nodiscard]] const std::shared_ptr<core::DemandTable>& demand() const { return data_.demand; }

  // The room's thread.
  void start(TimePoint now) { data_.time.start(now); }
  /// `on_wake` is called on any thread when due() has come nearer, at most once per run(). Set it before other threads
  /// know the room.
  void onWake(std::function<void()> on_wake) { on_wake_ = std::move(on_wake); }
  /// `load` is called on the room's thread. Without it the room has the server to itself.
  void loadFrom(std::function<ServerLoad()> load) { data_.load = std::move(load); }
  /// Returns the time of the next needed run(): of the next tick, or for a room that stands still, of what it waits
  /// for.
  [[nodiscard]] TimePoint due() const;
  /// Takes commands, steps unless paused or asleep, requests a frame when one is due and watched, and passes on
  /// finished frames. At most one tick per call.
  void run(TimePoint now);
  /// Unbinds the water, so that another thread can run the room.
  void unbind() { data_.water->release(); }

  [[nodiscard]] const sim::WaterSim& water() const { return data_.water->sim(); }
  /// Ticks since the room started, across scene changes: never decreases.
  [[nodiscard]] std::uint64_t tick() const { return data_.water->tick(); }
  /// Returns sim::WaterSim::stateHash() of the water. Waits for the device.
  [[nodiscard]] std::uint64_t stateHash() { return data_.water->sim().stateHash(); }
  /// Rejects the commands that still wait, and ends the queries.
  void abandonCommands() {
    desk_.close();
    queries_.endAll("the room was closed");
    answerHashes("the room was closed");
  }
  /// Writes a snapshot and waits for it until the deadline. Errors: those of the files; kUnavailable when the device
  /// does not answer, or the deadline passes: a snapshot that has begun is written nevertheless, and the log holds the
  /// rest.
  core::Result<void> saveUntil(TimePoint deadline);
  /// Ends the simulation; only the any-thread functions may be called afterwards.
  void releaseDevice();
  /// Returns one line for the end of the server.
  [[nodiscard]] std::string summary(TimePoint now) const;

 private:
  Room(std::string name, const RoomRules& rules, water::WaterBuilder& builder, RoomOutlets& outlets,
       std::unique_ptr<water::RoomWater> room_water, history::Diary diary, v1::RoomAccess access);

  /// Returns whether time has to advance: a room that nobody needs sleeps.
  [[nodiscard]] bool isNeeded(TimePoint now) const;
  /// Passes on what the device has finished.
  void handOver();
  void step(TimePoint now);
  void advancePaused(TimePoint now);
  /// Makes a tick if the holders of the clock have asked for it, and frames.
  void advanceHeld(TimePoint now);
  /// Returns whether there are such ticks to make, and nothing that has to come before them.
  [[nodiscard]] bool hasHeldTicks() const;
  /// Answers those who have asked for a hash; with an error, if there is one.
  void answerHashes(const std::string& error = "");
  /// Makes a tick; returns its end.
  TimePoint timedStep();
  /// Resets a scene that repeats itself, as a command would: logs hold it.
  void restartIfOver();

  /// Tells the clients about new water and answers those who asked for it.
  void waterChanged(const WaterChange::Built& built, TimePoint now);
  /// Rejects what waits for a device that has failed.
  void standStill();
  /// Stops boats whose people have left, and announces changes of the people.
  void settlePeople(TimePoint now);
  /// Tells all clients the changes, then the senders the outcomes of their commands.
  void announce();
  void publishVitals(TimePoint now);

  RoomData data_;
  RoomReports reports_{data_};
  RoomFrames frames_{data_};
  RoomQueries queries_{data_};
  RoomHulls hulls_{data_};
  WaterChange change_{data_};
  RoomActions actions_{data_};
  CommandDesk desk_{data_, actions_, change_};
  RoomKeeping keeping_{data_};

  TimePoint next_vitals_{};
  TimePoint ran_{};                    ///< begin of the last run()
  std::atomic<bool> is_woken_{false};  ///< since the last run()
  std::atomic<std::uint64_t> round_count_{0};
  std::atomic<TimePoint> used_until_{};
  std::function<void()> on_wake_;
  mutable std::mutex hash_mutex_;
  std::vector<HashDone> hash_asked_;  ///< guarded by hash_mutex_
  Published<RoomVitals> vitals_;
};

}  // namespace spindrift::rooms
