// One room: a scene, its water, its clock and its waiting commands. Lives on the simulation thread, except for the
// functions marked "any thread".
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/rooms/command.h>
#include <spindrift/rooms/command_queue.h>
#include <spindrift/rooms/diary.h>
#include <spindrift/rooms/fidelity_governor.h>
#include <spindrift/rooms/frame_schedule.h>
#include <spindrift/rooms/growth_news.h>
#include <spindrift/rooms/repetition.h>
#include <spindrift/rooms/room_outlets.h>
#include <spindrift/rooms/room_time.h>
#include <spindrift/rooms/room_water.h>
#include <spindrift/rooms/roster.h>
#include <spindrift/rooms/scene_catalog.h>
#include <spindrift/rooms/state_store.h>
#include <spindrift/rooms/tick_cost.h>
#include <spindrift/rooms/tick_meter.h>
#include <spindrift/rooms/water_builder.h>
#include <spindrift/rooms/work_budget.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

/// Name in the URL (see core::isRoomName()), and the checked scene with its defaults filled in.
struct RoomSetup {
  std::string name;
  v1::Scene scene{};
  /// Continues where the room is kept on disk; `scene` is for a room of which nothing is there, and may then be empty.
  bool goes_on = false;
  v1::RoomAccess access{};  ///< digests of its tokens: kept with the room, not looked at
};

/// Settings shared by all rooms of a server. Outlives the rooms.
struct RoomRules {
  SceneCatalog scenes;                      ///< scenes that a room can change to
  std::chrono::milliseconds grace{20'000};  ///< how long a lost connection's person and boats are kept
  std::filesystem::path record_folder;      ///< folder for logs; empty: no logs
  std::uint32_t hash_interval_ticks = 60;   ///< interval of the state hashes in logs
  std::shared_ptr<StateStore> states;       ///< where the rooms are kept on disk; null: nowhere
  /// How long the start and the end wait for the disk: for the first and for the last snapshots of all rooms.
  std::chrono::milliseconds disk_patience{5'000};
  bool opens_kept_rooms = true;  ///< at the start; false where a cluster decides which server runs a room
  bool adapts = false;           ///< lowers a room's fidelity where the machine cannot keep up
};

/// State of a room for other threads: immutable, replaced when it changes.
struct RoomSnapshot {
  v1::Scene scene;                  ///< with current parameter values
  std::uint64_t scene_version = 0;  ///< RoomWater::sceneVersion()
  bool paused = false;
  double speed = 1.0;
  v1::BoatList boats;                               ///< boats on the water now
  std::shared_ptr<const sim::GaugeHistory> gauges;  ///< null in scenes without gauges
};

/// Condition of a room, for /metrics and lists; updated a few times per second.
struct RoomVitals {
  std::uint64_t tick = 0;
  double time_s = 0.0;
  bool asleep = false;
  bool lost = false;  ///< the device failed; new water is being built
  std::uint32_t waiting_command_count = 0;
  std::uint64_t dropped_frame_count = 0;
  TickTimes tick_times;  ///< since the room opened
  core::DiagnosticsView diagnostics;
};

/// Returns what the gauges of the water read now.
std::vector<core::DiagnosticsView::GaugeNow> gaugesNow(const sim::WaterSim& water);

class Room {
 public:
  using TimePoint = RoomTime::TimePoint;

  /// `water` is bound to the calling thread, which runs the room; it lives until releaseDevice(). `builder` makes the
  /// water of scene changes. `builder` and `outlets` outlive the room. With a kept room in `place`, the room continues
  /// from there; `water` is then built from its start_scene. Errors:
  /// kInvalidInput if the room cannot continue from there; those of the log; kUnavailable if the first snapshot cannot
  /// be written.
  static core::Result<std::shared_ptr<Room>> create(std::string name, std::unique_ptr<Water> water,
                                                    const RoomRules& rules, WaterBuilder& builder, RoomOutlets& outlets,
                                                    RoomPlace place = {}, v1::RoomAccess access = {});
  /// The same, but a kept room is only at its snapshot. Before anything else it has to be brought where it was, by
  /// restoreUntil().
  static core::Result<std::shared_ptr<Room>> begin(std::string name, std::unique_ptr<Water> water,
                                                   const RoomRules& rules, WaterBuilder& builder, RoomOutlets& outlets,
                                                   RoomPlace place, v1::RoomAccess access);
  /// Repeats what happened after the snapshot, at least a tick and then until the deadline; with TimePoint::max() to
  /// the end. Returns whether the room is where it was; a new snapshot of it is then being written. Errors: those of
  /// create(); the room is of no use then.
  core::Result<bool> restoreUntil(TimePoint deadline);
  /// Waits until the deadline for the snapshot that restoreUntil() has begun. Returns whether the room can run: the
  /// snapshot is on the disk, or the disk has had RoomRules::disk_patience for it. Errors: those of create(); the room
  /// is of no use then.
  core::Result<bool> isOnDisk(TimePoint deadline);

  // Any thread.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Digests of the tokens that were made for this room; never changes.
  [[nodiscard]] const v1::RoomAccess& access() const { return access_; }
  [[nodiscard]] std::shared_ptr<const RoomSnapshot> snapshot() const;
  [[nodiscard]] std::shared_ptr<const RoomVitals> vitals() const;
  /// The people in the room.
  [[nodiscard]] Roster& roster() { return roster_; }
  [[nodiscard]] const Roster& roster() const { return roster_; }
  /// The only entry for commands, from sessions and requests: checks the sender's role and the scene, then queues the
  /// command. Otherwise returns the rejection with the command's number; a full queue is BUSY.
  [[nodiscard]] std::optional<wire::CommandRejection> admit(Command command);
  /// Asks for a snapshot on disk as soon as possible; returns false if the room is not kept.
  bool askForSnapshot();
  /// nullopt if the room is not kept on disk.
  [[nodiscard]] std::optional<StateKeeper::Status> keptStatus() const;
  /// Makes a room that stands still run soon: its sessions, or what they watch, have changed. Commands and people wake
  /// it by themselves.
  void wake();

  // Simulation thread.
  void start(TimePoint now);
  /// `on_wake` is called on any thread when due() has come nearer, at most once per run(). Set it before other threads
  /// know the room.
  void onWake(std::function<void()> on_wake) { on_wake_ = std::move(on_wake); }
  /// Returns the time of the next needed run(): of the next tick, or for a room that stands still, of what it waits
  /// for.
  [[nodiscard]] TimePoint due() const;
  /// Takes commands, steps unless paused or asleep, requests a frame when one is due and watched, and passes on
  /// finished frames. At most one tick per call, so that rooms share the thread. `thread_load`: share of its time that
  /// the thread was busy lately, with all rooms.
  void run(TimePoint now, double thread_load = 0.0);

  /// For the summary at the end.
  [[nodiscard]] const sim::WaterSim& water() const { return water_->sim(); }
  /// Ticks since the room started, across scene changes: never decreases.
  [[nodiscard]] std::uint64_t tick() const { return water_->tick(); }
  /// Of the water: sim::WaterSim::stateHash(). Waits for the device.
  [[nodiscard]] std::uint64_t stateHash() { return water_->sim().stateHash(); }
  /// Rejects the commands that still wait.
  void abandonCommands();
  /// Writes a snapshot and waits for it until the deadline. Errors: those of the files; kUnavailable when the device
  /// does not answer, or the deadline passes: a snapshot that has begun is written nevertheless, and the log holds the
  /// rest.
  core::Result<void> saveUntil(TimePoint deadline);
  /// Ends the simulation; only the any-thread functions may be called afterwards.
  void releaseDevice() {
    water_.reset();
    if (diary_.keeper()) diary_.keeper()->finish();
  }
  [[nodiscard]] double meanRealTimeFactor(TimePoint now) const { return time_.meanRealTimeFactor(now); }
  [[nodiscard]] std::uint64_t droppedFrameCount() const { return dropped_frames_; }

 private:
  using Outcome = RoomWater::Outcome;
  using Batch = CommandQueue::Batch;
  /// Outcome of a command; sent after all clients have been told the new state.
  struct Answer {
    Command command;
    Outcome rejected;
    std::uint32_t boat_id = 0;
  };
  /// Changes that the clients have not been told about yet.
  struct News {
    bool state = false;
    bool boats = false;
    bool reset = false;
    std::string rebuilt{};                     ///< for people, after the device failed
    std::map<std::string, double> parameters;  ///< current values by path
  };
  /// New water that is being built while the old one runs.
  struct WaterBuild {
    Batch commands{};  ///< the equal ChangeScene commands that started it
    std::future<WaterBuilder::Built> water{};
    enum class Cause { kCommand, kDeviceFailure, kAdapting } cause = Cause::kCommand;
    bool goes_on = false;  ///< the present water continues in it, at another fidelity
    FidelityGovernor::Step step = FidelityGovernor::Step::kNone;  ///< if adapting
    std::string why{};                                            ///< if adapting: for people
  };

  /// Values of one sender for one parameter. Tried from the newest on, until the water accepts one.
  struct Values {
    Batch untried;              ///< oldest first
    std::vector<Answer> tried;  ///< newest first
  };
  /// A parameter change that lays out the particles anew; the room's ticks wait for it.
  struct Change {
    Command command;
    Values others;
    RoomWater::Relayout relayout;  ///< without its basis
    std::future<WaterBuilder::Prepared> prepared;
    TimePoint begin;
  };

  Room(std::string name, const RoomRules& rules, WaterBuilder& builder, RoomOutlets& outlets,
       std::unique_ptr<RoomWater> room_water, Diary diary);

  void step(TimePoint now);
  TimePoint timedStep();
  void advancePaused(TimePoint now);

  // room_commands.cpp
  void applyCommands(TimePoint now);
  /// What the server knows about one kind of command: see the table in room_commands.cpp.
  struct CommandKind;
  static const CommandKind& kindOf(const v1::Command& command);
  friend const CommandTraits& traitsOf(const v1::Command& command);
  friend class RoomWater;
  /// Carries out a batch of commands together.
  void apply(Batch batch);
  /// Checks the command against the scene again if the scene changed since the command was admitted.
  [[nodiscard]] Outcome checkAgain(const Command& command) const;
  /// Applies the command to the water, and writes it to the diary.
  Outcome applyToWater(const Command& command);
  Outcome reset(const Command& command);
  /// Resets a scene that repeats itself, as a command would: logs hold it.
  void restartIfOver();
  Outcome spawnBoat(const Command& command);
  Outcome controlBoat(const Command& command);
  Outcome removeBoat(const Command& command);
  Outcome takeBoat(const Command& command);
  Outcome setPaused(const Command& command);
  Outcome setSpeed(const Command& command);
  Outcome advance(const Command& command);
  /// Stores the outcome of each command; `boat_id`: the boat that they added, 0: none.
  void answer(Batch batch, const Outcome& outcome, std::uint32_t boat_id = 0);
  /// Tells all clients the changes, then the senders the outcomes of their commands.
  void announce();
  /// Tells the senders the outcomes of their commands.
  void deliverAnswers();
  /// Stops boats whose people have left, and announces changes of the people.
  void settlePeople(TimePoint now);
  [[nodiscard]] bool isOnTheWater(std::uint32_t boat_id) const;
  /// Called after boats were added or removed: ends the ownership of removed boats and announces the boats.
  void boatsChanged();
  /// Announces the boats on the water if they differ from the last announcement.
  void announceBoats();
  void announceRecovery(TimePoint now);

  // room_keeping.cpp
  /// Writes the command to the diary before it is carried out; a rejection if that is not possible.
  [[nodiscard]] Outcome keep(const Command& command) { return diary_.writeAhead(tick(), command.message); }
  /// Rejects what the disk refused, before the answers are sent.
  void flushKept();
  /// Writes a snapshot when one is due, otherwise how far the room has come.
  void keepState(TimePoint now);
  /// Begins to write a snapshot. Error: the device does not answer.
  core::Result<void> save();
  [[nodiscard]] core::Error cannotBeWritten(const core::Error& why) const;
  /// The state between two ticks; nullopt when the device does not answer.
  std::optional<v1::KeptState> stateNow();
  /// What a room that begins still needs.
  struct Restoration {
    std::unique_ptr<StateKeeper> keeper;
    std::optional<Repetition> repetition;
  };
  core::Result<Repetition> beginRepetition(KeptRoom kept);
  /// As restoreUntil().
  core::Result<bool> repeatUntil(Repetition& repetition, TimePoint deadline);
  /// The people and what the other threads know, after the water.
  void restorePeople(const KeptRoom& kept);
  /// Continues in new water after the device failed, from what is kept; returns false, with nothing changed, if nothing
  /// is.
  bool restoreAfterLoss(std::unique_ptr<Water>& water);

  // room_change.cpp
  void setParameters(Batch values);
  void applyNewest(Values values);
  /// Answers all commands of `values`: untried ones are acknowledged as superseded, tried ones get their outcomes.
  void conclude(Values values);
  /// Starts the change and returns true if the value lays out the particles anew.
  bool beginChange(const Command& command, Values& others);
  /// Adopts the new particles if their layout is finished.
  void finishChange();
  /// Gives every command of the change, and of values that were put off, this rejection where it has no outcome yet.
  void abandonChanges(const wire::CommandRejection& rejection);
  /// Leaves the untried values to a later round; their sender's later commands wait for them.
  void putOff(Values values);
  /// Continues with values that were put off; returns false if there are none.
  bool resumeValues();
  /// Returns why the scene, or the time of a tick, does not allow the value.
  [[nodiscard]] Outcome refuseChange(const Command& command) const;
  void parameterChanged(const v1::SetParameter& change);

  // room_scene.cpp
  void beginScene(Batch batch);
  /// Adopts the new water if it is built.
  void adoptWater(TimePoint now);
  /// Clears the state that belonged to the previous water, and records another scene. `goes_on`: the same water at
  /// another level or on another device, which the caller records; boats keep their owners.
  void restartScene(bool goes_on);
  /// Rejects if ticks would take longer than `max_ms` and longer than now while others than the sender are connected.
  [[nodiscard]] Outcome refuseSlow(const core::Sender& sender, const std::string& field, double tick_ms,
                                   double max_ms) const;
  /// Continues with new water at its start.
  void replaceWater(std::unique_ptr<Water> water);

  // room_fidelity.cpp
  /// Returns the room's scene at another level, with the present parameters.
  [[nodiscard]] core::Result<v1::Scene> sceneAt(v1::Fidelity level) const;
  /// Continues with the present water in `next`, and announces it. `why`: for people, may be empty. On a rejection the
  /// room continues as before, and `next` is unchanged.
  Outcome goOnIn(std::unique_ptr<Water>& next, const std::string& why);
  /// With `serve --adapt`: starts a change of the level if the machine asks for one.
  void adaptFidelity(TimePoint now);
  /// Adopts the water of such a change, or notes that it cannot.
  void adoptAdapted(TimePoint now, const WaterBuild& build, WaterBuilder::Built water);
  /// Predicts how busy the thread is with the room at another level; infinite if the level is not possible.
  [[nodiscard]] double loadAt(v1::Fidelity level) const;
  /// Asks the device whether it still works. If not, starts building the same scene on a working device and rejects
  /// commands meanwhile. Returns true until that is done.
  bool isLost(TimePoint now);
  void finishRebuild(TimePoint now, WaterBuilder::Built water);
  /// From which new water is built after the device failed.
  [[nodiscard]] v1::Scene sceneAfterLoss() const;
  /// Marks the device as failed in the vitals, without calling it.
  void publishLoss();

  /// Requests what is watched of a frame that these levels take.
  void requestFrame(TimePoint now, core::LevelSet due);
  void handOverFrames();
  core::DiagnosticsView diagnostics();
  void publishSnapshot();
  void publishVitals(TimePoint now);

  const std::string name_;
  v1::RoomAccess access_;  ///< set by create() only
  const RoomRules& rules_;
  WaterBuilder& builder_;
  RoomOutlets& outlets_;
  std::unique_ptr<RoomWater> water_;
  Diary diary_;
  std::unique_ptr<Restoration> restoration_;  ///< until the room is where it was
  TimePoint first_snapshot_until_{};
  CommandQueue commands_;
  WorkBudget heavy_budget_;
  std::vector<Answer> answers_;    ///< since the last announce()
  std::uint32_t new_boat_id_ = 0;  ///< boat id that the command being carried out added; 0: none
  News news_;
  std::optional<WaterBuild> build_;
  std::optional<Change> change_;
  std::optional<Values> put_off_;  ///< no heavy command is taken while it is set
  bool is_lost_ = false;           ///< the device failed: the room does not run until new water is there
  TimePoint next_rebuild_{};       ///< time of the next try after a failed build
  std::chrono::seconds rebuild_pause_{1};
  std::size_t session_count_ = 0;  ///< in all rooms, as of this round
  TickCost tick_cost_;
  double thread_load_ = 0.0;  ///< as of this round
  FidelityGovernor governor_;
  v1::Fidelity chosen_fidelity_;  ///< of the scene, or chosen by a person; adapting never goes above it
  Roster roster_;
  RoomTime time_;
  v1::BoatList boats_;  ///< as last announced
  GrowthNews recovery_news_{std::chrono::seconds(1)};
  bool has_people_news_ = false;
  TimePoint next_people_news_{};
  TimePoint next_vitals_{};
  TimePoint next_scene_change_{};
  FrameSchedule frames_;
  bool wants_diagnostics_ = false;
  std::uint64_t dropped_frames_ = 0;

  TickMeter tick_meter_;
  TimePoint ran_{};                    ///< begin of the last run()
  std::atomic<bool> is_woken_{false};  ///< since the last run()
  std::function<void()> on_wake_;

  mutable std::mutex snapshot_mutex_;
  std::shared_ptr<const RoomSnapshot> snapshot_;
  std::shared_ptr<const RoomVitals> vitals_;
};

}  // namespace spindrift::rooms
