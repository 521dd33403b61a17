#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <spindrift/net/server.h>

#include "session_link.h"

namespace spindrift::net {

void Hub::add(SessionId session, std::shared_ptr<SessionLink> link) {
  const std::lock_guard lock(mutex_);
  members_[session].link = std::move(link);
}

void Hub::remove(SessionId session) {
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(session);
  if (found == members_.end()) return;
  leaveRoom(session, found->second);
  members_.erase(found);
}

void Hub::sendAnswer(SessionId session, core::SharedBytes message) {
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(session);
  if (found != members_.end()) found->second.link->sendAnswer(std::move(message));
}

void Hub::sendState(SessionId session, const StateTopic& topic, core::SharedBytes message) {
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(session);
  if (found != members_.end()) found->second.link->sendState(topic, std::move(message));
}

void Hub::broadcastState(const std::string& room, const StateTopic& topic, core::SharedBytes message) {
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(room);
  if (found == rooms_.end()) return;
  for (const Watcher& session : found->second.sessions) session.link->sendState(topic, message);
}

void Hub::publish(const std::string& room, StreamIndex stream, const FrameBytes& frame) {
  assert(stream < kMaxStreamCount && (frame.keyframe || frame.delta));
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(room);
  if (found == rooms_.end() || stream >= kMaxStreamCount) return;
  Group& group = found->second;
  const bool gathers = later_ && group.sessions.size() >= kGatherSessionCount;
  const auto wake = gathers ? SessionLink::Wake::kLater : SessionLink::Wake::kNow;
  for (const Watcher& watcher : group.watchers[stream]) watcher.link->offerFrame(stream, frame, wake);
  if (gathers && !std::exchange(group.will_wake, true)) later_([this, room] { wakeRoom(room); });
}

void Hub::wakeRoom(const std::string& room) {
  std::vector<std::vector<std::shared_ptr<SessionLink>>> woken;
  {
    const std::lock_guard lock(mutex_);
    const auto found = rooms_.find(room);
    if (found == rooms_.end()) return;
    found->second.will_wake = false;
    for (const Watcher& session : found->second.sessions) {
      if (!session.link->takesFrames()) continue;
      if (woken.empty() || woken.back().size() == kWokenTogetherCount) woken.emplace_back();
      woken.back().push_back(session.link);
    }
  }
  for (auto& links : woken) {
    soon_([links = std::move(links)] {
      for (const auto& link : links) link->writeNow();
    });
  }
}

void Hub::offerNewest(const std::string& room, StreamIndex stream, const FrameBytes& frame) {
  assert(stream < kMaxStreamCount && frame.keyframe);
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(room);
  if (found == rooms_.end() || stream >= kMaxStreamCount) return;
  for (const Watcher& watcher : found->second.watchers[stream]) watcher.link->offerNewest(stream, frame);
}

void Hub::join(SessionId session, const std::string& room, std::shared_ptr<core::DemandTable> demand) {
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(session);
  if (found == members_.end() || found->second.room == room) return;
  leaveRoom(session, found->second);
  enterRoom(session, found->second, room);
  found->second.link->enterRoom(std::move(demand));
}

void Hub::watch(SessionId session, StreamIndex stream, const Watch& watch) {
  assert(stream < kMaxStreamCount);
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(session);
  if (found == members_.end() || stream >= kMaxStreamCount) return;
  Member& member = found->second;
  const bool wanted = std::isfinite(watch.max_rate_hz) && watch.max_rate_hz > 0.0;
  member.link->setWatch(stream, wanted ? std::optional(watch) : std::nullopt);
  if (std::exchange(member.watches[stream], wanted) == wanted || !member.room) return;
  std::vector<Watcher>& watchers = rooms_[*member.room].watchers[stream];
  if (wanted) {
    watchers.push_back({session, member.link});
  } else {
    std::erase_if(watchers, [session](const Watcher& watcher) { return watcher.session == session; });
  }
}

void Hub::close(SessionId session, CloseCode code, std::string reason) {
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(session);
  if (found != members_.end()) found->second.link->close(code, std::move(reason));
}

void Hub::closeAt(SessionId session, std::chrono::steady_clock::time_point when, CloseCode code, std::string reason) {
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(session);
  if (found != members_.end()) found->second.link->closeAt(when, code, std::move(reason));
}

Waiting Hub::waiting() const {
  const std::lock_guard lock(mutex_);
  Waiting out;
  for (const auto& [session, member] : members_) {
    const Waiting waits = member.link->waiting();
    out.answer_count += waits.answer_count;
    out.state_count += waits.state_count;
    out.frame_count += waits.frame_count;
  }
  return out;
}

std::size_t Hub::roomCount() const {
  const std::lock_guard lock(mutex_);
  return rooms_.size();
}

void Hub::enterRoom(SessionId session, Member& member, const std::string& room) {
  Group& entered = rooms_[room];
  entered.sessions.push_back({session, member.link});
  member.room = room;
  for (std::size_t stream = 0; stream < kMaxStreamCount; ++stream) {
    if (member.watches[stream]) entered.watchers[stream].push_back({session, member.link});
  }
}

void Hub::leaveRoom(SessionId session, Member& member) {
  if (!member.room) return;
  const auto left = rooms_.find(*member.room);
  const auto isIt = [session](const Watcher& watcher) { return watcher.session == session; };
  for (std::vector<Watcher>& watchers : left->second.watchers) std::erase_if(watchers, isIt);
  std::erase_if(left->second.sessions, isIt);
  // Remove empty rooms, so that their number stays bounded by the sessions.
  if (left->second.sessions.empty()) rooms_.erase(left);
  member.room.reset();
  member.link->enterRoom(nullptr);
}

}  // namespace spindrift::net
