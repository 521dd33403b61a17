// What a room is opened with, and the settings that all rooms of a server share.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <spindrift/history/state_store.h>
#include <spindrift/v1/kept_state.pb.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/water/scene_catalog.h>

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
  water::SceneCatalog scenes;                   ///< scenes that a room can change to
  std::chrono::milliseconds grace{20'000};      ///< how long a lost connection's person and boats are kept
  std::filesystem::path record_folder;          ///< folder for logs; empty: no logs
  std::uint32_t hash_interval_ticks = 60;       ///< interval of the state hashes in logs
  std::shared_ptr<history::StateStore> states;  ///< where the rooms are kept on disk; null: nowhere
  /// Time that the start and the end wait for the disk: for the first and for the last snapshots of all rooms.
  std::chrono::milliseconds disk_patience{5'000};
  bool opens_kept_rooms = true;  ///< at the start; false where a cluster decides which server runs a room
  bool adapts = false;           ///< lowers a room's fidelity where the machine cannot keep up
};

}  // namespace spindrift::rooms
