#include <algorithm>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include <spindrift/core/version.h>
#include <spindrift/recording/recording_files.h>
#include <spindrift/state/posix_file.h>

namespace spindrift::recording {
namespace {

namespace fs = std::filesystem;

class FileSink final : public mcap::Sink {
 public:
  explicit FileSink(state::File file) : file_(std::move(file)) {}

  core::Result<void> append(core::ByteView bytes) override {
    auto written = file_.writeAt(size_bytes_, bytes);
    if (written)
      size_bytes_ += bytes.size();
    else
      (void)file_.resize(size_bytes_);  // what a full disk took of it; the first error says more
    return written;
  }

 private:
  state::File file_;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace

bool isRecordingName(std::string_view name) {
  return !name.empty() && name.size() <= kNameMaxBytes && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

core::Result<void> checkBounds(const FilesSetup& setup) {
  if (setup.max_bytes < kFileMinBytes || setup.max_bytes > kRecordingMaxBytes) {
    return core::invalid(fmt::format("a recording of at most {} bytes: the bound has to be from {} to {}",
                                     setup.max_bytes, kFileMinBytes, kRecordingMaxBytes));
  }
  if (!setup.file_max_bytes) return {};
  const std::uint64_t min_bytes = std::max(kFileMinBytes, (setup.max_bytes + kFileMaxCount - 1) / kFileMaxCount);
  if (*setup.file_max_bytes < min_bytes || *setup.file_max_bytes > kRecordingMaxBytes) {
    return core::invalid(
        fmt::format("files of at most {} bytes: the bound has to be from {} to {} for a recording of {} bytes",
                    *setup.file_max_bytes, min_bytes, kRecordingMaxBytes, setup.max_bytes));
  }
  return {};
}

core::Result<std::unique_ptr<mcap::Sink>> openNewFile(const fs::path& path) {
  auto file = state::File::open(path, O_WRONLY | O_CREAT | O_EXCL);
  if (file) return std::unique_ptr<mcap::Sink>(std::make_unique<FileSink>(*std::move(file)));
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(path, ignored)))
    return core::invalid(path.string() + " exists already, and recordings replace no file: choose another name");
  return file.error();
}

core::Result<RecordingFiles> RecordingFiles::begin(FilesSetup setup, OpenSink open) {
  if (auto checked = checkBounds(setup); !checked) return checked.error();
  RecordingFiles out(std::move(setup), std::move(open));
  if (auto begun = out.beginFile(); !begun) return begun.error();
  return out;
}

core::Result<void> RecordingFiles::beginFile() {
  const std::size_t number = names_.size() + 1;
  const std::string name =
      setup_.file_max_bytes ? fmt::format("{}_{:04}.mcap", setup_.name, number) : setup_.name + ".mcap";
  auto sink = open_(setup_.folder / name);
  if (!sink) return sink.error();
  names_.push_back(name);
  auto writer = mcap::Writer::begin(*std::move(sink), {.profile = "", .library = std::string(core::nameAndVersion())});
  if (!writer) return writer.error();
  current_ = File{.writer = *std::move(writer), .number = number};
  return {};
}

std::uint64_t RecordingFiles::descriptionBytes(const File& file, const Topic& topic) {
  constexpr std::size_t kHeadMaxBytes = 64;
  if (file.channels.contains(topic.name)) return 0;
  std::size_t bytes = kHeadMaxBytes + topic.name.size();
  if (!file.schemas.contains(topic.schema_name))
    bytes += kHeadMaxBytes + topic.schema_name.size() + topic.descriptor_set->size();
  return 2 * bytes;  // in the open chunk and in the summary
}

core::Result<RecordingFiles::Outcome> RecordingFiles::add(const Entry& entry) {
  TopicState& topic = topics_[entry.topic.name];
  const bool is_handed_over = !entry.is_whole && previous_ && topic.file_number == previous_->number;
  const bool can_be_read = entry.is_whole || is_handed_over || topic.file_number == current_.number;
  if (!can_be_read || (setup_.file_max_bytes && entry.data.size() > *setup_.file_max_bytes / 2)) {
    topic.file_number = 0;
    return Outcome::kSkipped;
  }
  File& file = is_handed_over ? *previous_ : current_;
  const std::uint64_t file_bytes =
      file.writer->finishedMaxBytes(entry.data.size()) + descriptionBytes(file, entry.topic);
  std::uint64_t other_bytes = finished_bytes_;
  if (is_handed_over) other_bytes += current_.writer->finishedMaxBytes(0);
  if (!is_handed_over && previous_) other_bytes += previous_->writer->finishedMaxBytes(0);
  if (other_bytes + file_bytes > setup_.max_bytes) return Outcome::kFull;
  if (setup_.file_max_bytes) {
    const std::uint64_t max_bytes = *setup_.file_max_bytes;
    // The last part of a file is for deltas that wait for their topic's first message in the next one.
    if (!previous_ && file_bytes > max_bytes - max_bytes / 8) {
      File last = std::move(current_);
      if (auto begun = beginFile(); !begun) {
        current_ = std::move(last);
        return begun.error();
      }
      previous_ = std::move(last);
      handover_begin_ns_ = entry.log_time_ns;
      return Outcome::kNewFile;
    }
    if (file_bytes > max_bytes) {
      topic.file_number = 0;
      return Outcome::kSkipped;
    }
  }
  if (auto written = write(file, entry, topic); !written) return written.error();
  const auto is_left = [&](const auto& known) { return previous_ && known.second.file_number == previous_->number; };
  if (previous_ && std::ranges::none_of(topics_, is_left)) {
    if (auto finished = finishPrevious(); !finished) return finished.error();
  }
  return Outcome::kWritten;
}

core::Result<void> RecordingFiles::write(File& file, const Entry& entry, TopicState& topic) {
  auto channel = file.channels.find(entry.topic.name);
  if (channel == file.channels.end()) {
    auto schema = file.schemas.find(entry.topic.schema_name);
    if (schema == file.schemas.end()) {
      const std::uint16_t id = file.writer->addSchema(entry.topic.schema_name, "protobuf", *entry.topic.descriptor_set);
      schema = file.schemas.emplace(entry.topic.schema_name, id).first;
    }
    const std::uint16_t id = file.writer->addChannel(
        {.topic = entry.topic.name, .message_encoding = "protobuf", .schema_id = schema->second});
    channel = file.channels.emplace(entry.topic.name, id).first;
  }
  topic.file_number = file.number;
  return file.writer->add({.channel_id = channel->second,
                           .sequence = topic.sequence++,
                           .log_time_ns = entry.log_time_ns,
                           .publish_time_ns = entry.publish_time_ns,
                           .data = entry.data});
}

core::Result<void> RecordingFiles::addMetadata(const std::string& name,
                                               const std::map<std::string, std::string>& values) {
  return current_.writer->addMetadata(name, values);
}

core::Result<void> RecordingFiles::finishPrevious() {
  File file = std::move(*previous_);
  previous_.reset();
  auto finished = file.writer->finish();
  finished_bytes_ += file.writer->writtenBytes();
  finished_message_count_ += file.writer->messageCount();
  return finished;
}

core::Result<void> RecordingFiles::review(std::uint64_t now_ns) {
  const auto since = [now_ns](std::uint64_t begin_ns) {
    return std::chrono::nanoseconds(now_ns > begin_ns ? now_ns - begin_ns : 0);
  };
  if (previous_ && since(handover_begin_ns_) > kHandoverMax) {
    if (auto finished = finishPrevious(); !finished) return finished;
  }
  for (File* const file : {&current_, previous_ ? &*previous_ : nullptr}) {
    if (file == nullptr) continue;
    const auto begin_ns = file->writer->chunkBegin_ns();
    if (!begin_ns || since(*begin_ns) < kChunkMax) continue;
    if (auto written = file->writer->endChunk(); !written) return written;
  }
  return {};
}

core::Result<void> RecordingFiles::finish() {
  core::Result<void> previous = previous_ ? finishPrevious() : core::Result<void>();
  auto current = current_.writer->finish();
  return previous ? current : previous;
}

std::uint64_t RecordingFiles::messageCount() const {
  return finished_message_count_ + current_.writer->messageCount() +
         (previous_ ? previous_->writer->messageCount() : 0);
}

std::uint64_t RecordingFiles::writtenBytes() const {
  return finished_bytes_ + current_.writer->writtenBytes() + (previous_ ? previous_->writer->writtenBytes() : 0);
}

}  // namespace spindrift::recording
