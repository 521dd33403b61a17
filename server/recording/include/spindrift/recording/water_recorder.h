// Records what a room sends: takes its messages as they are on the wire, and writes them into MCAP files that describe
// themselves. docs/recordings.md says what is in them.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>
#include <spindrift/foxglove/converter.h>
#include <spindrift/recording/recording_files.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::recording {

struct RecorderSetup {
  FilesSetup files;
  std::chrono::milliseconds max_duration{};  ///< by the wall clock
  bool is_for_foxglove = false;              ///< also records messages of Foxglove's schemas; takes plain layers
};

/// One thread at a time.
class WaterRecorder {
 public:
  using WallClock = std::chrono::system_clock;

  /// Makes the first file. Errors: those of RecordingFiles::begin().
  static core::Result<std::unique_ptr<WaterRecorder>> begin(RecorderSetup setup, WallClock::time_point now,
                                                            OpenSink open = openNewFile);

  /// Takes a ServerMessage: frames, diagnostics, greetings and what changes them are recorded; others are ignored. The
  /// first is a greeting. Error: that of the disk; only finish() may be called then.
  core::Result<void> take(core::ByteView message, WallClock::time_point now);
  /// Writes what has waited too long, and looks at the time. Call it some times per second. Error as take().
  core::Result<void> review(WallClock::time_point now);
  /// Returns true once after a new file has begun: packed layers need keyframes to begin in it.
  [[nodiscard]] bool takeKeyframeWish() { return std::exchange(wants_keyframes_, false); }
  /// Returns the bound that has ended the recording; nullopt: it continues.
  [[nodiscard]] const std::optional<std::string>& end() const { return end_; }
  /// Ends the files properly; the last call. Error: the first.
  core::Result<void> finish() { return files_.finish(); }

  struct Counts {
    std::uint64_t message_count = 0;
    std::uint64_t skipped_count = 0;    ///< Outcome::kSkipped, or not to be converted
    std::uint64_t malformed_count = 0;  ///< messages that could not be parsed
    std::uint64_t written_bytes = 0;
  };
  [[nodiscard]] Counts counts() const;
  [[nodiscard]] const std::vector<std::string>& files() const { return files_.names(); }

 private:
  WaterRecorder(RecorderSetup setup, WallClock::time_point now, RecordingFiles files);
  core::Result<void> add(const Entry& entry);
  /// Writes what each file begins with: metadata, and the messages that describe the room now.
  core::Result<void> describe(std::uint64_t log_time_ns);
  /// Adds the messages of Foxglove's schemas that are made from this one.
  core::Result<void> convert(const v1::ServerMessage& message);
  /// Keeps a message that describes the room until another one replaces it.
  void keep(const v1::ServerMessage& message, core::ByteView bytes);
  [[nodiscard]] const Topic* topicOf(const v1::ServerMessage& message) const;

  const RecorderSetup setup_;
  const WallClock::time_point begin_;
  RecordingFiles files_;
  std::vector<Topic> layer_topics_;     ///< by v1::Layer
  std::vector<Topic> foxglove_topics_;  ///< by foxglove::Topic
  Topic greeting_topic_;
  Topic state_topic_;
  foxglove::Converter converter_;
  std::map<std::string, std::string> metadata_;  ///< of the newest greeting
  core::Bytes greeting_;                         ///< the newest; empty: none has come
  std::map<std::string, core::Bytes> states_;    ///< since then, by what they replace; at most kStateMaxCount
  std::uint64_t log_time_ns_ = 0;
  std::uint64_t publish_time_ns_ = 0;
  Counts counts_;
  bool wants_keyframes_ = false;
  std::optional<std::string> end_;
};

}  // namespace spindrift::recording
