#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/service/recordings.h>

#include "room_recording.h"

namespace spindrift::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEndedMaxCount = 64;
constexpr std::uint64_t kFileBytes = std::uint64_t{512} << 20;
constexpr std::uint64_t kRecordingBytes = std::uint64_t{4} << 30;
constexpr double kDuration_s = 3600.0;
constexpr double kDurationMax_s = 7 * 86400.0;

std::uint64_t recordedBytes(const fs::path& folder) {
  std::uint64_t out = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    std::error_code unknown;
    if (entry->path().extension() != ".mcap" || !entry->is_regular_file(unknown)) continue;
    const std::uint64_t bytes = entry->file_size(unknown);
    if (!unknown) out += bytes;
  }
  return out;
}

core::Result<std::vector<codec::Stream>> streamsOf(const v1::StartRecording& wanted) {
  const bool is_plain = wanted.plain() || wanted.foxglove();
  std::vector<codec::Stream> out;
  for (int number = v1::LAYER_UNSPECIFIED + 1; number < v1::Layer_ARRAYSIZE; ++number) {
    if (!wanted.layers().empty() && std::ranges::find(wanted.layers(), number) == wanted.layers().end()) continue;
    if (v1::Layer_IsValid(number))
      out.push_back(codec::streamOf(static_cast<v1::Layer>(number), is_plain ? v1::PACKING_PLAIN : v1::PACKING_PACKED));
  }
  for (const int layer : wanted.layers()) {
    if (!v1::Layer_IsValid(layer) || layer == v1::LAYER_UNSPECIFIED)
      return core::invalid(fmt::format("layers: {} is not a layer", layer));
  }
  return out;
}

}  // namespace

Recordings::Recordings(RecordingRules rules, MakeGreeting greeting)
    : rules_(std::move(rules)), greeting_(std::move(greeting)) {}

Recordings::~Recordings() = default;

std::uint64_t Recordings::freeBytes() const {
  std::uint64_t used = recordedBytes(rules_.folder);
  const std::lock_guard lock(mutex_);
  for (const auto& recording : recordings_) {
    if (recording->isRunning()) used += recording->maxBytes() - recording->state().written_bytes();
  }
  return rules_.folder_max_bytes - std::min(used, rules_.folder_max_bytes);
}

core::Result<void> Recordings::start(const std::shared_ptr<rooms::Room>& room, const v1::StartRecording& wanted) {
  if (rules_.folder.empty()) {
    return core::unavailable("the server records no rooms: start it with --recordings FOLDER");
  }
  if (!recording::isRecordingName(wanted.name()))
    return core::invalid(
        fmt::format("name: a recording's name has 1 to {} letters, digits, '_' or '-'", recording::kNameMaxBytes));
  const auto streams = streamsOf(wanted);
  if (!streams) return streams.error();
  const auto level = codec::fromWire(wanted.level());
  if (!level) return core::invalid(fmt::format("level: {} is not a level", static_cast<int>(wanted.level())));
  const double max_s = wanted.max_s() == 0.0 ? kDuration_s : wanted.max_s();
  if (!std::isfinite(max_s) || max_s < 0.0 || max_s > kDurationMax_s)
    return core::invalid(fmt::format("max_s: {:g} is not a duration from 0 to {:g} s", max_s, kDurationMax_s));

  const std::lock_guard one_at_a_time(start_mutex_);
  if (const auto known = running(room->name()))
    return core::unavailable("the room is recorded already, as '" + known->state().name() + "': end that first");
  const std::uint64_t free_bytes = freeBytes();
  const std::uint64_t max_bytes = wanted.max_bytes() > 0 ? wanted.max_bytes() : std::min(free_bytes, kRecordingBytes);
  if (free_bytes < std::max(max_bytes, recording::kFileMinBytes)) {
    return core::unavailable(fmt::format(
        "max_bytes: {} of the {} bytes of --recordings-max-mib are free: ask for fewer, or remove recordings",
        free_bytes, rules_.folder_max_bytes));
  }
  const std::uint64_t file_bytes = wanted.file_max_bytes() > 0 ? wanted.file_max_bytes() : kFileBytes;
  auto recorder = recording::WaterRecorder::begin(
      {.files = {.folder = rules_.folder, .name = wanted.name(), .file_max_bytes = file_bytes, .max_bytes = max_bytes},
       .max_duration = std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(1e3 * max_s)),
       .is_for_foxglove = wanted.foxglove()},
      std::chrono::system_clock::now());
  if (!recorder) return recorder.error();
  spdlog::info("room {}: is recorded as {} in {}", room->name(), wanted.name(), rules_.folder.string());
  const auto described = room->snapshot();
  auto recording = std::make_shared<RoomRecording>(RoomRecordingSetup{.name = wanted.name(),
                                                                      .room = room->name(),
                                                                      .demand = room->demand(),
                                                                      .streams = *streams,
                                                                      .level = *level,
                                                                      .max_bytes = max_bytes},
                                                   *std::move(recorder), greeting_(room));
  room->wake();
  std::vector<std::shared_ptr<RoomRecording>> forgotten;  // destroyed without the lock
  {
    const std::lock_guard lock(mutex_);
    recordings_.push_back(recording);
    for (auto oldest = recordings_.begin(); recordings_.size() > kEndedMaxCount && oldest != recordings_.end();) {
      if (!(*oldest)->isRunning()) forgotten.push_back(std::move(*oldest));
      oldest = *oldest ? std::next(oldest) : recordings_.erase(oldest);
    }
  }
  if (room->snapshot() != described) recording->tell(greeting_(room));  // it changed before the recording was known
  return {};
}

v1::RecordingList Recordings::list(const std::string& room) const {
  const std::lock_guard lock(mutex_);
  v1::RecordingList out;
  for (const auto& recording : recordings_) {
    if (recording->room() == room) *out.add_recordings() = recording->state();
  }
  return out;
}

std::shared_ptr<RoomRecording> Recordings::running(const std::string& room) const {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::find_if(recordings_, [&](const auto& known) { return known->room() == room && known->isRunning(); });
  return found == recordings_.end() ? nullptr : *found;
}

bool Recordings::stop(const std::string& room, std::function<void(const v1::RecordingList&)> done) {
  const auto recording = running(room);
  if (!recording) return false;
  recording->end("it was stopped", [this, room, done = std::move(done)] { done(list(room)); });
  return true;
}

void Recordings::endAll(const std::string& why) {
  std::deque<std::shared_ptr<RoomRecording>> ended;
  {
    const std::lock_guard lock(mutex_);
    ended.swap(recordings_);
  }
  for (const auto& recording : ended) recording->end(why);
}

void Recordings::publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                         const core::FrameLevels& levels) {
  if (const auto recording = running(room)) recording->publish(stream, frame, levels);
}

void Recordings::tell(const std::string& room, const core::SharedBytes& message) {
  if (const auto recording = running(room)) recording->tell(message);
}

void Recordings::sceneChanged(const std::shared_ptr<rooms::Room>& room) {
  if (const auto recording = running(room->name())) recording->tell(greeting_(room));
}

void Recordings::roomClosed(const std::string& room) {
  if (const auto recording = running(room)) recording->end("the room was closed");
}

}  // namespace spindrift::service
