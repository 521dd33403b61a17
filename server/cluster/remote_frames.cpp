// The frames of a remote room: which streams come over the bus, what is passed on to the sessions, and what is kept for
// late ones.
#include <algorithm>
#include <utility>

#include "remote_room.h"

namespace spindrift::cluster {
namespace {

using namespace std::chrono_literals;

/// The stream of keyframes is taken so long after the last need of one.
constexpr auto kKeyframePatience = 2s;
/// Frames of one stream that wait in this process: more than a few are out of date.
constexpr std::size_t kFramesWaitingMaxBytes = 16u << 20;

}  // namespace

void RemoteRoom::reviewStreams(Clock::time_point now, bool must_tell, Dropped& dropped) {
  if (!reduced_counts_) return;
  v1::ToRoom message;
  v1::Watching& watching = *message.mutable_watching();
  for (const codec::Stream stream : codec::allStreams()) {
    const std::size_t index = codec::indexOf(stream);
    const std::uint32_t reduced_count = (*reduced_counts_)[index];
    const core::StreamDemand asked = demand_->of(index, now + aheadOf(index));
    const core::StreamDemand demand = core::demandOfFrame(asked, reduced_count);
    core::LevelSet wanting_keyframe;
    for (const core::Level level : core::kLevels) {
      const core::LevelDemand& wanted = demand[core::indexOf(level)];
      Feed& one = feed(index, level);
      if (wanted.watcher_count == 0) {
        if (one.frames) {
          dropped.push_back(std::move(one.frames));
          dropped.push_back(std::move(one.keyframes));
          one = Feed{};
          must_tell = true;
        }
        continue;
      }
      const auto subscribe = [&](const std::string& subject) {
        return bus_.subscribe(subject, kFramesWaitingMaxBytes,
                              [this, index, level](core::ByteView frame) { takeFrame(index, level, frame); });
      };
      if (!one.frames) {
        one.frames = subscribe(subjects_.frames(name_, index, level));
        must_tell = true;
      }
      const bool wants_keyframe = wanted.wants_keyframe || !one.is_whole || one.lacksKept();
      if (wants_keyframe) {
        one.keyframe_wanted = now;
        if (!one.keyframes) one.keyframes = subscribe(subjects_.keyframes(name_, index, level));
        must_tell = must_tell || !one.asked;
        one.asked = true;
      } else if (one.keyframes && now - one.keyframe_wanted > kKeyframePatience) {
        dropped.push_back(std::move(one.keyframes));
      }
      if (wants_keyframe) wanting_keyframe.insert(level);
    }
    // The levels as asked for: the room leaves out the frames that none of them takes.
    core::LevelSet told;
    for (const core::Level level : core::kLevels) {
      const std::size_t watcher_count = asked[core::indexOf(level)].watcher_count;
      if (watcher_count == 0) continue;
      told.insert(level);
      v1::Watching::Stream& entry = *watching.add_streams();
      entry.set_stream(static_cast<std::uint32_t>(index));
      entry.set_level(codec::toWire(level));
      entry.set_watcher_count(static_cast<std::uint32_t>(watcher_count));
      entry.set_wants_keyframe(wanting_keyframe.contains(core::effectiveLevel(level, reduced_count)));
    }
    must_tell = must_tell || told != told_levels_[index];
    told_levels_[index] = told;
  }
  if (!must_tell) return;
  told_ = now;
  watching.set_session_count(static_cast<std::uint32_t>(demand_->sessionCount()));
  watching.set_unlisted_count(static_cast<std::uint32_t>(
      std::ranges::count_if(guests_, [](const auto& guest) { return !guest.second.is_listed; })));
  send(std::move(message));
}

void RemoteRoom::takeFrame(std::size_t stream, core::Level level, core::ByteView message) {
  const auto frame = readFrame(message);
  if (!frame) return;
  Dropped dropped;  // destroyed without the locks
  const std::lock_guard in_order(frames_mutex_);
  const auto now = Clock::now();
  net::FrameBytes out{.keyframe = nullptr,
                      .delta = nullptr,
                      .levels = {.level = level, .reduced_count = frame->head.reduced_count, .due = frame->head.due}};
  {
    const std::lock_guard lock(mutex_);
    Feed& one = feed(stream, level);
    if (frame->head.run == one.run && frame->head.sequence <= one.sequence) return;  // came with its keyframe
    const bool follows = one.is_whole && frame->head.run == one.run && frame->head.sequence == one.sequence + 1;
    if (!follows && one.is_whole) ++stats_.gap_count;
    if (one.sequence != 0) {
      constexpr int kSmoothing = 8;
      one.interval += (std::min<Clock::duration>(now - one.came, 200ms) - one.interval) / kSmoothing;
    }
    one.came = now;
    one.run = frame->head.run;
    one.sequence = frame->head.sequence;
    one.reduced_count = frame->head.reduced_count;
    one.is_whole = follows || !frame->keyframe.empty();
    one.asked = false;
    ++stats_.frame_count;
    if (!frame->keyframe.empty()) out.keyframe = core::share({frame->keyframe.begin(), frame->keyframe.end()});
    // Without the frame before, nobody in this process can use the delta.
    if (follows && !frame->delta.empty()) out.delta = core::share({frame->delta.begin(), frame->delta.end()});
  }
  if (out.keyframe || out.delta) sessions_.hub().publish(name_, static_cast<net::StreamIndex>(stream), out);
  const std::lock_guard lock(mutex_);
  Feed& one = feed(stream, level);
  if (one.run == frame->head.run && one.sequence == frame->head.sequence) {  // it is still watched
    if (out.keyframe)
      one.kept.takeKeyframe(out.keyframe);
    else if (out.delta)
      one.kept.takeDelta(out.delta, one.isRare());
    else
      one.kept.forget();
  }
  if (!attached_ || !reduced_counts_) return;
  // Sessions may need a keyframe now. Only this stream is looked at, because this runs for every frame.
  const core::StreamDemand demand = demand_->of(stream, now + aheadOf(stream));
  const bool wants_keyframe = std::ranges::any_of(demand, &core::LevelDemand::wants_keyframe);
  if (wants_keyframe || !one.is_whole || one.lacksKept()) reviewStreams(now, false, dropped);
}

void RemoteRoom::offerKept() {
  // No frame may be published between the choice of a kept one and its way into the outboxes.
  const std::lock_guard in_order(frames_mutex_);
  std::vector<std::pair<net::StreamIndex, net::FrameBytes>> offers;
  {
    const std::lock_guard lock(mutex_);
    if (!attached_ || !reduced_counts_) return;
    for (const codec::Stream stream : codec::allStreams()) {
      const std::size_t index = codec::indexOf(stream);
      if (std::ranges::none_of(feeds_[index], [](const Feed& one) { return one.kept.isWhole(); })) continue;
      const core::StreamDemand demand =
          core::demandOfFrame(demand_->of(index, Clock::now()), (*reduced_counts_)[index]);
      for (const core::Level level : core::kLevels) {
        Feed& one = feed(index, level);
        if (!demand[core::indexOf(level)].has_newcomer || !one.kept.isWhole()) continue;
        offers.emplace_back(index, net::FrameBytes{.keyframe = one.kept.keyframe(),
                                                   .delta = nullptr,
                                                   .levels = {.level = level, .reduced_count = one.reduced_count}});
      }
    }
  }
  for (const auto& [stream, frame] : offers) {
    if (frame.keyframe) sessions_.hub().offerNewest(name_, stream, frame);
  }
}

RemoteRoom::Clock::duration RemoteRoom::aheadOf(std::size_t stream) const {
  // All levels of a stream have frames at similar intervals; the longest is that of the slowest level.
  Clock::duration ahead{};
  for (const Feed& one : feeds_[stream]) ahead = std::max(ahead, one.interval);
  return ahead;
}

}  // namespace spindrift::cluster
