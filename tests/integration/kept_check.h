// What state_kill_test and cluster_kill_test find in the files that a killed server has left behind.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/history/state_store.h>
#include <spindrift/v1/kept_state.pb.h>

#include "kill_load.h"

namespace spindrift::test {

/// Removes the newest snapshot of each room that has several: the rooms then continue from an older one with more logs.
void removeNewestSnapshots(const std::filesystem::path& state_folder);

/// Numbers of a room's snapshots, ascending.
std::vector<std::uint64_t> snapshotNumbers(const std::filesystem::path& state_folder, const std::string& room);
/// Highest number of a room's snapshots and logs; 0 without files.
std::uint64_t lastGeneration(const std::filesystem::path& state_folder, const std::string& room);
/// The content of a snapshot as the program wrote it; nullopt if the file is not there (any more).
std::optional<v1::KeptState> readSnapshot(const std::filesystem::path& state_folder, const std::string& room,
                                          std::uint64_t number);

/// The room as a restarted server has it: its snapshot with the logs carried out, and then run to `least_tick`, because
/// a newer snapshot may be ahead of the last record. nullopt: nothing usable is there.
core::Result<std::optional<v1::KeptState>> restoredRoom(history::StateStore& store, const std::string& room,
                                                        const gpu::DeviceChoice& device, std::uint64_t least_tick = 0);

/// Names what differs, with values; empty if the water, the time and the people are the same bit for bit.
std::vector<std::string> differences(const v1::KeptState& a, const v1::KeptState& b);

/// The room restored from its newest snapshot. Checks that an older one with more logs (`older`) gives the same.
std::optional<v1::KeptState> restoredTwice(history::StateStore& newest, history::StateStore& older,
                                           const std::string& room, const gpu::DeviceChoice& device);

/// A copy of a folder beside it; replaces an earlier one.
std::filesystem::path copyOf(const std::filesystem::path& folder, const std::string& name);

/// How a command is kept.
enum class Found { kInLog, kBeforeSnapshot, kNowhere };
/// `all`: every command sent to the room in this round.
Found find(const SentCommand& sent, const history::KeptRoom& kept, const std::vector<SentCommand>& all);

/// The acknowledged commands of one room.
struct KeptCommands {
  std::size_t in_log_count = 0;
  std::size_t before_snapshot_count = 0;
  std::vector<std::string> lost;  ///< a line for each that is nowhere
  [[nodiscard]] std::size_t checkedCount() const { return in_log_count + before_snapshot_count + lost.size(); }
};
/// Looks for each command that was acknowledged in this opening of the room. `all`: every command sent in this round.
KeptCommands findAll(std::vector<SentCommand> all, const std::string& room, std::uint64_t opening,
                     const history::KeptRoom& kept);

}  // namespace spindrift::test
