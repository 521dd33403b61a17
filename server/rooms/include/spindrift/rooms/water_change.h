// How the water of a room is replaced: by another scene, by the same water at another fidelity or with its particles
// laid out anew, or after the device failed. What takes long runs on other threads.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/rooms/command.h>
#include <spindrift/rooms/fidelity_governor.h>
#include <spindrift/rooms/room_data.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/water/room_water.h>
#include <spindrift/water/water_builder.h>

namespace spindrift::rooms {

/// A state machine. The room runs while other water is built. It stands still while its particles are laid out anew,
/// and after the device failed until new water is built. At most one water is being built and one layout prepared at a
/// time; water that is ready waits until the layout is done.
class WaterChange {
 public:
  using TimePoint = RoomTime::TimePoint;
  using Outcome = water::RoomWater::Outcome;

  explicit WaterChange(RoomData& room) : room_(room) {}

  [[nodiscard]] bool isLost() const { return is_lost_; }
  [[nodiscard]] bool stopsTime() const { return is_lost_ || relayout_; }
  /// Returns whether another build can begin.
  [[nodiscard]] bool mayBuild() const { return !build_; }
  /// Returns whether a command's scene or level is being built.
  [[nodiscard]] bool isBuildingForCommand() const { return build_ && build_->cause == Build::Cause::kCommand; }
  /// Returns when takeBuilt(), takeLayout() or watchDevice() has something to do; nullopt: not known yet. `ran`: begin
  /// of the last round.
  [[nodiscard]] std::optional<TimePoint> due(TimePoint ran) const;

  /// Begins a change of the scene or of its level. Returns the answer to the command; nullopt if takeBuilt() gives it
  /// later.
  std::optional<Outcome> beginScene(const Command& command);
  /// With `serve --adapt`: begins a change of the level if the machine asks for one. Call it after each tick.
  void adapt(TimePoint now);

  /// Outcome of a build.
  struct Built {
    bool answers_command = false;  ///< `outcome` answers that of beginScene()
    Outcome outcome{};
    enum class Water { kSame, kAtItsStart, kContinues } water = Water::kSame;
    std::string recovered{};  ///< one line for people, after the device failed
    std::string fidelity{};   ///< the same, after the fidelity changed
  };
  /// Ends the build if it is ready; nullopt otherwise. If the water was replaced, diary, time and costs know.
  std::optional<Built> takeBuilt(TimePoint now);

  /// Returns true and stops the room if the value lays out the particles anew.
  bool beginRelayout(const v1::SetParameter& change);
  /// Ends the layout if it is ready, and returns the answer; nullopt otherwise.
  std::optional<Outcome> takeLayout();
  /// Forgets the layout: the device has failed, or the room ends.
  void abandonLayout() { relayout_.reset(); }

  /// Asks the device whether it still works. If not, begins to build the same scene on a working device, and tries
  /// again while that fails. Returns whether the room is lost now.
  bool watchDevice(TimePoint now);

  /// Rejects if ticks would take longer than `max_ms` and longer than now while others than the sender are connected.
  [[nodiscard]] Outcome refuseSlow(const core::Sender& sender, const std::string& field, double tick_ms,
                                   double max_ms) const;

 private:
  struct Build {
    enum class Cause { kCommand, kDeviceFailure, kAdapting } cause = Cause::kCommand;
    std::future<water::WaterBuilder::Built> water{};
    bool goes_on = false;                                         ///< the present water continues in it
    std::optional<Command> command{};                             ///< if it is the cause
    FidelityGovernor::Step step = FidelityGovernor::Step::kNone;  ///< if adapting
    std::string why{};                                            ///< if adapting: for people
  };
  struct Relayout {
    water::RoomWater::Relayout inputs;  ///< without its basis
    std::future<water::WaterBuilder::Prepared> prepared;
  };

  /// Begins to build the scene.
  Build& begin(Build::Cause cause, v1::Scene scene);
  Built takeScene(TimePoint now, const Build& build, water::WaterBuilder::Built water);
  Built takeAdapted(TimePoint now, const Build& build, water::WaterBuilder::Built water);
  Built takeRebuilt(TimePoint now, water::WaterBuilder::Built water);
  /// Continues with new water at its start.
  Built startIn(std::unique_ptr<water::Water> water);
  /// Continues with the present water in `next`. `why`: for people, may be empty. On a rejection the room continues as
  /// before, and `next` is unchanged.
  Built continueIn(std::unique_ptr<water::Water>& next, const std::string& why);
  /// Continues in new water after the device failed, from what is kept; nullopt, with nothing changed, if nothing is.
  std::optional<Built> restoreIn(std::unique_ptr<water::Water>& water);
  /// Tells diary, time and costs about other water. `keeps_steps`: RoomTime::restart().
  void waterReplaced(bool keeps_steps);

  /// Returns the scene from which new water is built after the device failed.
  [[nodiscard]] v1::Scene sceneAfterLoss() const;
  /// Predicts how busy the thread is with the room at another level; infinite if the level is not possible.
  [[nodiscard]] double loadAt(v1::Fidelity level) const;

  RoomData& room_;
  std::optional<Build> build_;
  std::optional<Relayout> relayout_;
  bool is_lost_ = false;
  TimePoint next_rebuild_{};  ///< time of the next try after a failed build
  std::chrono::seconds rebuild_pause_{1};
  TimePoint next_scene_change_{};
  FidelityGovernor governor_;
};

}  // namespace spindrift::rooms
