// Records a room of any server, as one of its clients (docs/recordings.md).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/net/client.h>
#include <spindrift/recording/water_recorder.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::script {

struct RecordRoomOptions {
  net::ClientUrl url;
  std::string room;            ///< empty: that of the URL
  std::string ca_file;         ///< that of ClientPool
  std::string token_variable;  ///< environment variable with the token; empty: none
  std::vector<v1::Layer> layers;
  v1::Packing packing = v1::PACKING_PACKED;
  v1::Level level = v1::LEVEL_FULL;
  recording::RecorderSetup recorder;
};

struct RecordRoomReport {
  recording::WaterRecorder::Counts counts;
  std::vector<std::string> files;  ///< in the folder of the setup; empty: the room sent nothing
  std::string end;                 ///< why the recording has ended: a bound, or `is_stopped`
};

/// Records until a bound is reached or `is_stopped` returns true, which is asked some times per second. Follows a
/// server that drains. Errors: kUnavailable when the server cannot be reached, refuses or ends the connection, and for
/// the disk; those of WaterRecorder::begin(). What was recorded until then is in the files, which are finished.
core::Result<RecordRoomReport> recordRoom(const RecordRoomOptions& options, const std::function<bool()>& is_stopped);

}  // namespace spindrift::script
