// The frames of this server's rooms, for nodes: which streams they watch, and what is published for them.
#include "feed.h"
#include "frame_head.h"

namespace spindrift::cluster {

void Feed::takeWatching(FedRoom& room, Link& link, const v1::Watching& watching) {
  StreamTable watched{};
  for (const v1::Watching::Stream& stream : watching.streams()) {
    const auto level = codec::fromWire(stream.level());
    if (stream.stream() >= codec::kStreamCount || !level || stream.watcher_count() == 0) continue;
    const auto& before = link.watched[stream.stream()][core::indexOf(*level)];
    core::DemandTable::Need& need = watched[stream.stream()][core::indexOf(*level)].emplace();
    need.level = *level;
    need.watcher_count = stream.watcher_count();
    if (stream.wants_keyframe() || (before && before->keyframe_from)) need.keyframe_from.emplace();
  }
  const std::uint32_t session_count = watching.session_count();
  // Told at every pulse, mostly without news.
  const bool is_news = (link.session_count == 0 && session_count > 0) || watched != link.watched;
  core::DemandTable& demand = *room.room->demand();
  demand.addSessions(std::ptrdiff_t{session_count} - std::ptrdiff_t{link.session_count});
  link.session_count = session_count;
  link.unlisted_count = watching.unlisted_count();
  for (std::size_t stream = 0; stream < watched.size(); ++stream) {
    for (std::size_t level = 0; level < core::kLevelCount; ++level) {
      auto& known = link.watched[stream][level];
      if (known == watched[stream][level]) continue;
      known = watched[stream][level];
      demand.set(stream, &known, known);
    }
  }
  if (is_news) room.room->wake();
}

void Feed::publish(const std::string& name, codec::Stream stream, const codec::EncodedFrame& frame,
                   const core::FrameLevels& levels) {
  const std::size_t index = codec::indexOf(stream);
  const core::Level level = levels.level;
  FrameHead head{.reduced_count = static_cast<std::uint16_t>(levels.reduced_count), .due = levels.due};
  bool is_watched = false;
  bool wants_keyframe = false;
  {
    const std::lock_guard lock(mutex_);
    const auto found = rooms_.find(name);
    if (found == rooms_.end()) return;
    FedRoom& room = found->second;
    head.run = room.run;
    head.sequence = ++room.sequences[index][core::indexOf(level)];
    for (auto& [node, link] : room.links) {
      for (const core::Level asked : core::kLevels) {
        auto& need = link.watched[index][core::indexOf(asked)];
        if (!levels.isOf(asked) || !need) continue;
        is_watched = true;
        if (!need->keyframe_from) continue;
        wants_keyframe = true;
        if (!frame.keyframe) continue;
        need->keyframe_from.reset();
        room.room->demand()->set(index, &need, need);
      }
    }
  }
  if (!is_watched) return;
  const auto send = [&](const std::string& subject, const core::SharedBytes& keyframe, const core::SharedBytes& delta) {
    head.keyframe_bytes = keyframe ? static_cast<std::uint32_t>(keyframe->size()) : 0;
    head.delta_bytes = delta ? static_cast<std::uint32_t>(delta->size()) : 0;
    core::Bytes bytes;
    bytes.reserve(kFrameHeadBytes + head.keyframe_bytes);
    const auto first = toBytes(head);
    bytes.insert(bytes.end(), first.begin(), first.end());
    if (keyframe) bytes.insert(bytes.end(), keyframe->begin(), keyframe->end());
    bus_.publish(subject, bytes, delta ? core::ByteView(*delta) : core::ByteView());
  };
  ++frame_count_;
  if (frame.keyframe && frame.delta && wants_keyframe)
    send(subjects_.keyframes(name, index, level), frame.keyframe, frame.delta);
  if (frame.delta)
    send(subjects_.frames(name, index, level), nullptr, frame.delta);
  else
    send(subjects_.frames(name, index, level), frame.keyframe, nullptr);
}

}  // namespace spindrift::cluster
