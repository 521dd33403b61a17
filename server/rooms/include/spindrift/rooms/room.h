// One room: a scene, its water, its clock, and the commands on their way to it. Lives on the simulation thread; the few
// functions that other threads may call say so.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/command.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/rooms/command_log.h>
#include <spindrift/rooms/command_queue.h>
#include <spindrift/rooms/growth_news.h>
#include <spindrift/rooms/real_time_clock.h>
#include <spindrift/rooms/room_outlets.h>
#include <spindrift/rooms/roster.h>
#include <spindrift/rooms/scene_catalog.h>
#include <spindrift/rooms/stage.h>
#include <spindrift/rooms/tick_cost.h>
#include <spindrift/rooms/water_builder.h>
#include <spindrift/rooms/work_budget.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

/// 1 to 32 letters, digits, '_' or '-'.
bool isRoomName(const std::string& name);

/// Name in the URL (letters, digits, '_', '-') and the checked scene with its defaults filled in.
struct RoomSetup {
  std::string name;
  v1::Scene scene;
};

/// What every room of a server has in common. Outlives the rooms.
struct RoomRules {
  SceneCatalog scenes;                      ///< what rooms can be changed to
  std::chrono::milliseconds grace{20'000};  ///< a lost connection's person and boats are kept so long
  std::filesystem::path record_folder;      ///< logs go here; empty: none are written
  std::uint32_t hash_interval_ticks = 60;   ///< of the logs
};

/// What other threads may know of a room: immutable, replaced when it changes.
struct RoomSnapshot {
  v1::Scene scene;  ///< with parameters as they are now
  bool paused = false;
  double speed = 1.0;
  v1::BoatList boats;  ///< on the water now
};

/// How a room does, for /metrics and lists; renewed a few times a second.
struct RoomVitals {
  std::uint64_t tick = 0;
  double time_s = 0.0;
  bool asleep = false;
  bool lost = false;  ///< the device failed; the water is being built anew
  std::uint32_t waiting_command_count = 0;
  std::uint64_t dropped_frame_count = 0;
  core::DiagnosticsView diagnostics;
};

class Room {
 public:
  using TimePoint = RealTimeClock::TimePoint;

  /// `water` is bound to the calling thread, which runs the room; it lives until releaseDevice(). `builder` makes what
  /// the room changes to; it and `outlets` outlive the room. Errors: those of the log.
  static core::Result<std::shared_ptr<Room>> create(std::string name, std::unique_ptr<Water> water,
                                                    const RoomRules& rules, WaterBuilder& builder,
                                                    RoomOutlets& outlets);

  // Any thread.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::shared_ptr<const RoomSnapshot> snapshot() const;
  [[nodiscard]] std::shared_ptr<const RoomVitals> vitals() const;
  /// Who is here.
  [[nodiscard]] Roster& roster() { return roster_; }
  [[nodiscard]] const Roster& roster() const { return roster_; }
  /// The one way in, for sessions and requests alike: checks the sender's role and the scene, and queues the command.
  /// Or why not, with the command's number; a full queue is BUSY.
  [[nodiscard]] std::optional<wire::CommandRejection> admit(core::Command command);

  // Simulation thread.
  void start(TimePoint now);
  /// When the room wants to run again.
  [[nodiscard]] TimePoint due(TimePoint now) const;
  /// Drains commands, steps if neither paused nor asleep, asks for a frame when one is due and watched, hands over
  /// finished ones. At most one tick a call, so that rooms share the thread.
  void run(TimePoint now);

  /// For the summary at the end.
  [[nodiscard]] const sim::WaterSim& water() const { return stage_->water(); }
  /// Ticks since the room began, whatever its scenes: never goes back.
  [[nodiscard]] std::uint64_t tick() const { return stage_->tick(); }
  /// Tells whoever still waits for an answer that there will be none.
  void abandonCommands();
  /// Ends the simulation; only the any-thread functions may be called afterwards.
  void releaseDevice() { stage_.reset(); }
  [[nodiscard]] double meanRealTimeFactor(TimePoint now) const;
  [[nodiscard]] std::uint64_t droppedFrameCount() const { return dropped_frames_; }

 private:
  using Outcome = Stage::Outcome;
  using Batch = CommandQueue::Batch;
  /// What became of a command; sent when everybody knows the state that it made.
  struct Answer {
    core::Command command;
    Outcome rejected;
    std::uint32_t boat_id = 0;
  };
  /// What people have yet to be told about.
  struct News {
    bool state = false;
    bool boats = false;
    bool reset = false;
    bool rebuilt = false;
    std::map<std::string, double> parameters;  ///< by path, as they are now
  };
  /// Other water under way, built beside the running one.
  struct WaterBuild {
    Batch commands;  ///< that asked for it: the same ChangeScene; empty where the device failed
    std::future<WaterBuilder::Built> water;
  };

  /// Values that one sender gave one parameter, the newest first tried: the first that the water takes is the last one.
  struct Values {
    Batch untried;              ///< oldest first
    std::vector<Answer> tried;  ///< newest first
  };
  /// A value on its way that lays the particles out anew; the room's ticks wait for it.
  struct Change {
    core::Command command;
    Values others;
    Stage::Relayout relayout;  ///< without its basis
    std::future<WaterBuilder::Prepared> prepared;
    TimePoint begin;
  };

  Room(std::string name, const RoomRules& rules, WaterBuilder& builder, RoomOutlets& outlets,
       std::unique_ptr<Stage> stage, std::unique_ptr<CommandLogWriter> log);

  void step(TimePoint now);
  void watchOverSleep(TimePoint now);
  TimePoint timedStep();
  void advancePaused(TimePoint now);

  // room_commands.cpp
  void applyCommands(TimePoint now);
  /// One or more commands by one piece of work.
  void apply(Batch batch);
  Outcome apply(const core::Command& command);
  /// The stage's part of a command, and its line in the log.
  Outcome applyToWater(const core::Command& command);
  void recordCommand(const core::Command& command);
  Outcome setParameter(const core::Command& command, const core::SetParameter& change);
  Outcome reset(const core::Command& command);
  Outcome spawnBoat(const core::Command& command);
  Outcome controlBoat(const core::Command& command, std::uint32_t boat_id);
  Outcome removeBoat(const core::Command& command, std::uint32_t boat_id);
  Outcome takeBoat(const core::Sender& sender, std::uint32_t boat_id);
  Outcome setPaused(bool paused);
  Outcome advance(const core::Step& step);
  /// Notes what became of each command.
  void answer(Batch batch, const Outcome& outcome);
  /// Tells everybody what is new, then the senders what became of their commands.
  void announce();
  /// Tells the senders what became of their commands.
  void deliverAnswers();
  /// Boats whose people went away stop; news of people go out.
  void settlePeople(TimePoint now);
  [[nodiscard]] bool isOnTheWater(std::uint32_t boat_id) const;
  /// Boats came or went: owners of those that are gone have them no more, and people are told.
  void boatsChanged();
  /// The boats on the water, if they are others than those announced last.
  void announceBoats();
  void announceRecovery(TimePoint now);

  // room_change.cpp
  void applyNewest(Values values);
  /// The newest of them is taken, or none: answers them all.
  void conclude(Values values);
  /// Whether the value lays the particles out anew, which has begun then.
  bool beginChange(const core::Command& command, Values& others);
  /// Goes on with the particles that were laid out, if they are there.
  void finishChange();
  /// Answers what the change would have answered.
  void abandonChange(const wire::CommandRejection& rejection);
  [[nodiscard]] Outcome refuseSlowChange(const core::Command& command, const core::SetParameter& change) const;
  void parameterChanged(const core::SetParameter& change);

  // room_scene.cpp
  void beginScene(Batch batch);
  /// Goes on with the water that was built, if it is there.
  void adoptWater(TimePoint now);
  /// Forgets what belonged to the water before.
  void restartScene();
  /// Refuses ticks that take longer than `max_ms`, and longer than now, while others than the sender are connected.
  [[nodiscard]] Outcome refuseSlow(const core::Sender& sender, const std::string& field, double tick_ms,
                                   double max_ms) const;
  /// Goes on with other water from its start.
  void replaceWater(std::unique_ptr<Water> water);
  /// Asks the device whether it still works; if not, has the same scene built anew, on a device that does, and answers
  /// whoever asks for something meanwhile. True while it does not.
  bool isLost(TimePoint now);
  void finishRebuild(TimePoint now, WaterBuilder::Built water);
  /// Says in the vitals that the device failed, without asking it for anything.
  void publishLoss();

  /// While the room runs.
  [[nodiscard]] bool isFrameDue(TimePoint now) const;
  void requestFrame(TimePoint now);
  /// Whether the next frame holds the level: all do while the room is paused, then every so many.
  [[nodiscard]] bool isDue(core::Level level) const;
  void handOverFrames();
  core::DiagnosticsView diagnostics();
  void watchRealTime(TimePoint now);
  void publishSnapshot();
  void publishVitals(TimePoint now);
  void record(v1::Record record);

  const std::string name_;
  const RoomRules& rules_;
  WaterBuilder& builder_;
  RoomOutlets& outlets_;
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<CommandLogWriter> log_;  ///< null: no log
  CommandQueue commands_;
  WorkBudget heavy_budget_;
  std::vector<Answer> answers_;  ///< since the last announce()
  News news_;
  std::optional<WaterBuild> build_;
  std::optional<Change> change_;
  bool is_lost_ = false;      ///< the device failed: nothing runs until other water is there
  TimePoint next_rebuild_{};  ///< a build that failed is tried again
  std::chrono::seconds rebuild_pause_{1};
  std::size_t session_count_ = 0;  ///< of all rooms, as of this round
  TickCost tick_cost_;
  Roster roster_;
  RealTimeClock clock_;
  bool paused_ = false;
  bool asleep_ = false;
  TimePoint last_watched_{};
  std::uint32_t pending_tick_count_ = 0;  ///< of Step: ticks that the paused room still advances
  v1::BoatList boats_;                    ///< as announced last
  GrowthNews recovery_news_{std::chrono::seconds(1)};
  std::uint64_t logged_recovery_count_ = 0;
  bool has_people_news_ = false;
  TimePoint next_people_news_{};
  TimePoint next_vitals_{};
  TimePoint next_scene_change_{};
  double next_frame_s_ = 0.0;      ///< simulation time
  std::uint64_t frame_count_ = 0;  ///< that were due
  TimePoint next_idle_frame_{};    ///< wall time, while paused
  TimePoint last_frame_{};         ///< wall time of the last request
  bool wants_diagnostics_ = false;
  std::uint64_t dropped_frames_ = 0;

  double step_ms_sum_ = 0.0;  ///< since the last diagnostics
  std::uint32_t step_count_ = 0;
  double last_step_ms_ = 0.0;
  std::vector<core::DiagnosticsView::PassTime> last_passes_;
  double run_s_ = 0.0;  ///< simulated seconds since the start, resets not counted back
  double unpaused_wall_s_ = 0.0;
  TimePoint last_run_{};
  TimePoint slow_since_{};
  TimePoint next_slow_warning_{};

  mutable std::mutex snapshot_mutex_;
  std::shared_ptr<const RoomSnapshot> snapshot_;
  std::shared_ptr<const RoomVitals> vitals_;
};

}  // namespace spindrift::rooms
