// Recordings of the server's rooms in files that other programs open (docs/recordings.md), asked for by operators. Not
// the command logs of `serve --record`: those repeat a run, these hold what its clients saw.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/rooms/room.h>
#include <spindrift/v1/api.pb.h>

namespace spindrift::service {

struct RecordingRules {
  std::filesystem::path folder{};                            ///< exists; empty: rooms are not recorded
  std::uint64_t folder_max_bytes = std::uint64_t{16} << 30;  ///< of all *.mcap in it
};

class RoomRecording;

/// At most one recording runs per room. Thread-safe; no call waits for a disk but start(), which makes a file, and
/// endAll().
class Recordings {
 public:
  /// `greeting`: makes the message with which a recording begins.
  using MakeGreeting = std::function<core::SharedBytes(const std::shared_ptr<rooms::Room>&)>;
  Recordings(RecordingRules rules, MakeGreeting greeting);
  ~Recordings();
  Recordings(const Recordings&) = delete;
  Recordings& operator=(const Recordings&) = delete;

  /// Errors: kInvalidInput for a name or a bound that is not allowed; kUnavailable when the server does not record, the
  /// room is recorded already, the folder is full, or the file cannot be made.
  core::Result<void> start(const std::shared_ptr<rooms::Room>& room, const v1::StartRecording& wanted);
  /// Ends the room's recording; `done` is called with all of the room when the files are finished. Returns false, and
  /// does not call it, if none runs.
  bool stop(const std::string& room, std::function<void(const v1::RecordingList&)> done);
  [[nodiscard]] v1::RecordingList list(const std::string& room) const;
  /// Ends all and waits for their files.
  void endAll(const std::string& why);

  // From the rooms and the encoder.
  void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
               const core::FrameLevels& levels);
  void tell(const std::string& room, const core::SharedBytes& message);
  void sceneChanged(const std::shared_ptr<rooms::Room>& room);
  void roomClosed(const std::string& room);

 private:
  /// Returns null if none runs.
  [[nodiscard]] std::shared_ptr<RoomRecording> running(const std::string& room) const;
  /// Returns the bytes that a new recording may have.
  [[nodiscard]] std::uint64_t freeBytes() const;

  const RecordingRules rules_;
  const MakeGreeting greeting_;
  std::mutex start_mutex_;  ///< held while a file is made, which may take long: rooms do not wait for it
  mutable std::mutex mutex_;
  std::deque<std::shared_ptr<RoomRecording>> recordings_;  ///< oldest first; of those that ended at most kEndedMaxCount
};

}  // namespace spindrift::service
