#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/foxglove/channels.h>
#include <spindrift/foxglove/schema_set.h>
#include <spindrift/recording/water_recorder.h>

namespace spindrift::recording {
namespace {

constexpr std::size_t kStateMaxCount = 256;

std::uint64_t nanoseconds(WaterRecorder::WallClock::time_point time) {
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
  return static_cast<std::uint64_t>(std::max<std::chrono::nanoseconds::rep>(since, 0));
}

/// Of a time from the wire, which may be anything.
std::uint64_t nanoseconds(double time_s) {
  constexpr double kMax_s = 1e9;
  return std::isfinite(time_s) ? foxglove::nanoseconds(std::min(time_s, kMax_s)) : 0;
}

core::SharedBytes shared(const std::string& bytes) {
  return core::share({bytes.begin(), bytes.end()});
}

/// All but the layers as they come, which have topics of their own here.
const foxglove::TopicSet kFoxgloveTopics = [] {
  foxglove::TopicSet out;
  for (std::size_t topic = 0; topic <= static_cast<std::size_t>(foxglove::Topic::kDiagnostics); ++topic) out.set(topic);
  return out;
}();

std::string topicName(v1::Layer layer) {
  std::string name = v1::Layer_Name(layer).substr(std::string_view("LAYER_").size());
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return "/spindrift/" + name;
}

std::map<std::string, std::string> describeGreeting(const v1::Greeting& greeting) {
  return {{"scene", greeting.scene().name()},
          {"seed", std::to_string(greeting.scene().seed())},
          {"server", greeting.server()},
          {"device", greeting.device()},
          {"room", greeting.room()},
          {"wire", fmt::format("{}.{}", greeting.version().major(), greeting.version().minor())}};
}

}  // namespace

core::Result<std::unique_ptr<WaterRecorder>> WaterRecorder::begin(RecorderSetup setup, WallClock::time_point now,
                                                                  OpenSink open) {
  auto files = RecordingFiles::begin(setup.files, std::move(open));
  if (!files) return files.error();
  return std::unique_ptr<WaterRecorder>(new WaterRecorder(std::move(setup), now, *std::move(files)));
}

WaterRecorder::WaterRecorder(RecorderSetup setup, WallClock::time_point now, RecordingFiles files)
    : setup_(std::move(setup)), begin_(now), files_(std::move(files)) {
  const auto& message = *v1::ServerMessage::descriptor();
  const auto topic = [&, set = shared(foxglove::schemaSetOf(message))](std::string name) {
    return Topic{.name = std::move(name), .schema_name = message.full_name(), .descriptor_set = set};
  };
  for (int layer = 0; layer < v1::Layer_ARRAYSIZE; ++layer)
    layer_topics_.push_back(topic(v1::Layer_IsValid(layer) ? topicName(static_cast<v1::Layer>(layer)) : ""));
  for (const foxglove::Channel& channel : foxglove::allChannels())
    foxglove_topics_.push_back({std::string(channel.name), channel.schema_name, shared(channel.schema)});
  greeting_topic_ = topic("/spindrift/greeting");
  state_topic_ = topic("/spindrift/state");
}

const Topic* WaterRecorder::topicOf(const v1::ServerMessage& message) const {
  switch (message.message_case()) {
    case v1::ServerMessage::kFrame: {
      const v1::Layer layer = message.frame().layer();
      const bool is_known = v1::Layer_IsValid(layer) && layer != v1::LAYER_UNSPECIFIED;
      return is_known ? &layer_topics_[static_cast<std::size_t>(layer)] : nullptr;
    }
    case v1::ServerMessage::kDiagnostics:
      return &layer_topics_[v1::LAYER_DIAGNOSTICS];
    case v1::ServerMessage::kGreeting:
      return &greeting_topic_;
    case v1::ServerMessage::kParameterChanged:
    case v1::ServerMessage::kRoomState:
    case v1::ServerMessage::kBoatList:
    case v1::ServerMessage::kRoomEvent:
      return &state_topic_;
    default:  // answers, and what tells of people
      return nullptr;
  }
}

void WaterRecorder::keep(const v1::ServerMessage& message, core::ByteView bytes) {
  core::Bytes copy(bytes.begin(), bytes.end());
  std::string replaces;
  switch (message.message_case()) {
    case v1::ServerMessage::kGreeting:
      greeting_ = std::move(copy);
      metadata_ = describeGreeting(message.greeting());
      converter_.take(message.greeting().boat_list());
      return states_.clear();  // a greeting includes them
    case v1::ServerMessage::kParameterChanged:
      replaces = "parameter " + message.parameter_changed().path();
      break;
    case v1::ServerMessage::kRoomState:
      replaces = "room state";
      break;
    case v1::ServerMessage::kBoatList:
      replaces = "boats";
      converter_.take(message.boat_list());
      break;
    default:  // an event has passed
      return;
  }
  if (states_.size() < kStateMaxCount || states_.contains(replaces)) states_[replaces] = std::move(copy);
}

core::Result<void> WaterRecorder::take(core::ByteView bytes, WallClock::time_point now) {
  if (end_) return {};
  const auto message = codec::parseServerMessage(bytes);
  if (!message) {
    ++counts_.malformed_count;
    return {};
  }
  const Topic* const topic = topicOf(*message);
  if (topic == nullptr || (greeting_.empty() && !message->has_greeting())) return {};
  log_time_ns_ = std::max(log_time_ns_, nanoseconds(now));  // the system's clock may be set back
  if (message->has_frame()) publish_time_ns_ = nanoseconds(message->frame().time_s());
  if (message->has_diagnostics()) publish_time_ns_ = nanoseconds(message->diagnostics().time_s());
  if (message->has_greeting()) {
    keep(*message, bytes);
    return describe(log_time_ns_);
  }
  auto added = add({.topic = *topic,
                    .data = bytes,
                    .is_whole = !message->has_frame() || message->frame().keyframe(),
                    .log_time_ns = log_time_ns_,
                    .publish_time_ns = publish_time_ns_});
  keep(*message, bytes);
  return added && !end_ && setup_.is_for_foxglove ? convert(*message) : added;
}

core::Result<void> WaterRecorder::convert(const v1::ServerMessage& message) {
  core::Result<std::vector<foxglove::Message>> made = std::vector<foxglove::Message>();
  if (message.has_frame()) made = converter_.convert(message.frame(), kFoxgloveTopics);
  if (message.has_diagnostics()) made = converter_.convert(message.diagnostics(), kFoxgloveTopics);
  if (!made) {
    ++counts_.skipped_count;
    return {};
  }
  for (const foxglove::Message& one : *made) {
    auto added = add({.topic = foxglove_topics_[static_cast<std::size_t>(one.topic)],
                      .data = core::viewOf(one.bytes),
                      .log_time_ns = log_time_ns_,
                      .publish_time_ns = one.time_ns});
    if (!added || end_) return added;
  }
  return {};
}

core::Result<void> WaterRecorder::describe(std::uint64_t log_time_ns) {
  if (auto written = files_.addMetadata("spindrift", metadata_); !written) return written;
  const auto write = [&](const Topic& topic, const core::Bytes& bytes) -> core::Result<void> {
    return add({.topic = topic, .data = bytes, .log_time_ns = log_time_ns, .publish_time_ns = publish_time_ns_});
  };
  if (auto added = write(greeting_topic_, greeting_); !added) return added;
  for (const auto& [replaces, bytes] : states_) {
    if (auto added = write(state_topic_, bytes); !added) return added;
  }
  return {};
}

core::Result<void> WaterRecorder::add(const Entry& entry) {
  using Outcome = RecordingFiles::Outcome;
  auto outcome = files_.add(entry);
  if (outcome && *outcome == Outcome::kNewFile) {
    wants_keyframes_ = true;
    if (auto described = describe(entry.log_time_ns); !described || end_) return described;
    outcome = files_.add(entry);
  }
  if (!outcome) return outcome.error();
  if (*outcome == Outcome::kSkipped) ++counts_.skipped_count;
  if (*outcome == Outcome::kFull)
    end_ = fmt::format("the recording has reached its bound of {} bytes", setup_.files.max_bytes);
  return {};
}

core::Result<void> WaterRecorder::review(WallClock::time_point now) {
  if (now - begin_ >= setup_.max_duration)
    end_ = fmt::format("the recording has reached its bound of {:g} s",
                       std::chrono::duration<double>(setup_.max_duration).count());
  return files_.review(nanoseconds(now));
}

WaterRecorder::Counts WaterRecorder::counts() const {
  Counts out = counts_;
  out.message_count = files_.messageCount();
  out.written_bytes = files_.writtenBytes();
  return out;
}

}  // namespace spindrift::recording
