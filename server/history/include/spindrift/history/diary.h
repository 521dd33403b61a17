// What happens to the water of a room, in order: the commands that it carried out, new scenes, people. It goes to the
// log of `serve --record`, and to the log of the room's state on disk, where the room has one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/history/command_log.h>
#include <spindrift/history/state_keeper.h>
#include <spindrift/v1/record.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/water/room_water.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::history {

class Diary {
 public:
  /// `water` outlives it. `record_folder`: for the log of `serve --record`; empty: no such log. A room that continues
  /// from its state on disk has none either, because a log begins with a scene. Errors: those of the log.
  static core::Result<Diary> create(const std::string& room, water::RoomWater& water,
                                    const std::filesystem::path& record_folder, std::uint32_t hash_interval_ticks,
                                    bool is_continued);
  /// From now on the state is kept on disk, too.
  void keepIn(std::unique_ptr<StateKeeper> keeper) { keeper_ = std::move(keeper); }
  /// Null if the state is not kept.
  [[nodiscard]] StateKeeper* keeper() const { return keeper_.get(); }

  /// Writes a command before it is carried out, so that nothing is lost that was acknowledged; a rejection if the disk
  /// refuses. A command that the water then refuses is refused again when it is repeated.
  [[nodiscard]] std::optional<wire::CommandRejection> writeAhead(const v1::Command& command);
  /// A command has changed the water that could not be written ahead, because its work began in an earlier round.
  void carriedOutLate(const v1::Command& command);
  /// The water of another scene is at its start.
  void beganScene();
  /// The same water continues at the fidelity of this scene, as that water was built.
  void continuedIn(const v1::Scene& built);
  /// The water went back to an earlier state; a replay does not repeat it.
  void recovered();
  /// A tick has passed. What the watchdog restored in it does not follow from the logs: a snapshot is wanted then.
  void ticked();
  /// Writes who is here if `version` is another one than in the last call.
  void people(std::uint64_t version, const std::function<v1::RoomPeople()>& people);
  /// Other water is there; a snapshot of it is wanted.
  void waterReplaced();

  /// Call it before answers are sent: they must not promise what the disk refused.
  core::Result<void> flush();

 private:
  Diary(water::RoomWater& water, std::unique_ptr<CommandLogWriter> log) : water_(water), log_(std::move(log)) {}
  /// Returns a record of this tick, without content.
  [[nodiscard]] v1::Record recordNow() const;
  /// Writes what has happened into both logs.
  void write(const v1::Record& record);

  water::RoomWater& water_;
  std::unique_ptr<CommandLogWriter> log_;
  std::unique_ptr<StateKeeper> keeper_;
  std::uint64_t recovered_count_ = 0;  ///< sim::WaterSim::recoveredCount() as of the last tick
  std::uint64_t kept_people_version_ = 0;
};

}  // namespace spindrift::history
