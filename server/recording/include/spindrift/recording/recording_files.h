// The files of one recording: one, or a series whose files are bounded and can each be read without the others.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>
#include <spindrift/mcap/writer.h>

namespace spindrift::recording {

inline constexpr std::uint64_t kFileMinBytes = 1u << 20;
inline constexpr std::uint64_t kFileMaxCount = 1000;
inline constexpr std::uint64_t kRecordingMaxBytes = std::uint64_t{1} << 40;
inline constexpr std::size_t kNameMaxBytes = 64;

/// Returns whether this is the name of a recording: 1 to kNameMaxBytes letters, digits, '_' or '-', and so no path.
bool isRecordingName(std::string_view name);

/// Folder, name and bounds of the files.
struct FilesSetup {
  std::filesystem::path folder;
  std::string name;  ///< without its ending
  /// Files NAME_0001.mcap, NAME_0002.mcap and so on, each with at most so many bytes; nullopt: NAME.mcap alone.
  std::optional<std::uint64_t> file_max_bytes;
  std::uint64_t max_bytes = 0;  ///< of all files together
};

/// Checks the bounds: kInvalidInput names the value and its range.
core::Result<void> checkBounds(const FilesSetup& setup);

/// Makes a new file; a file of that name is never replaced.
using OpenSink = std::function<core::Result<std::unique_ptr<mcap::Sink>>(const std::filesystem::path&)>;
core::Result<std::unique_ptr<mcap::Sink>> openNewFile(const std::filesystem::path& path);

/// A topic of a file, and what its messages are.
struct Topic {
  std::string name;
  std::string schema_name;           ///< full name of a Protobuf message
  core::SharedBytes descriptor_set;  ///< google.protobuf.FileDescriptorSet with that message
};

/// One message for a topic.
struct Entry {
  const Topic& topic;
  core::ByteView data;
  bool is_whole = true;  ///< can be read without the message before; false: a delta
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
};

/// One thread at a time. A delta goes into the file that has the message before it. So after a new file has begun, the
/// one before stays open until every topic has had a message that can be read alone, at most kHandoverMax.
class RecordingFiles {
 public:
  /// Makes the first file. Errors: those of the files, and of checkBounds().
  static core::Result<RecordingFiles> begin(FilesSetup setup, OpenSink open = openNewFile);
  static constexpr std::chrono::seconds kHandoverMax{10};
  /// An open chunk is written after this time, so that a program that is killed loses at most so much.
  static constexpr std::chrono::seconds kChunkMax{1};

  enum class Outcome : std::uint8_t {
    kWritten,
    kSkipped,  ///< a delta whose predecessor is in no open file, or a message over half of a file's bound
    kNewFile,  ///< the message begins a new file and is not written yet: write first what each file begins with
    kFull,     ///< the bound of all files is reached
  };
  /// Error: that of the disk. Only finish() may be called then.
  core::Result<Outcome> add(const Entry& entry);
  core::Result<void> addMetadata(const std::string& name, const std::map<std::string, std::string>& values);
  /// Writes what has waited too long. Call it some times per second. Error: that of the disk.
  core::Result<void> review(std::uint64_t now_ns);
  /// Ends all files properly. Error: the first.
  core::Result<void> finish();

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::uint64_t writtenBytes() const;
  /// Returns mcap::Writer::messageCount() of all files.
  [[nodiscard]] std::uint64_t messageCount() const;

 private:
  struct File {
    std::unique_ptr<mcap::Writer> writer;
    std::size_t number = 0;
    std::map<std::string, std::uint16_t> schemas{};   ///< by name
    std::map<std::string, std::uint16_t> channels{};  ///< by topic
  };
  struct TopicState {
    std::uint32_t sequence = 0;
    std::size_t file_number = 0;  ///< that has its newest message; 0: none
  };

  RecordingFiles(FilesSetup setup, OpenSink open) : setup_(std::move(setup)), open_(std::move(open)) {}
  core::Result<void> beginFile();
  core::Result<void> finishPrevious();
  core::Result<void> write(File& file, const Entry& entry, TopicState& topic);
  /// Returns a bound for what the topic's description adds to the file; 0 if the file has it.
  static std::uint64_t descriptionBytes(const File& file, const Topic& topic);

  FilesSetup setup_;
  OpenSink open_;
  File current_;
  std::optional<File> previous_;
  std::uint64_t handover_begin_ns_ = 0;
  std::uint64_t finished_bytes_ = 0;
  std::uint64_t finished_message_count_ = 0;
  std::map<std::string, TopicState> topics_;
  std::vector<std::string> names_;
};

}  // namespace spindrift::recording
