#include "feed.h"

#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/core/room_name.h>
#include <spindrift/wire/client_message.h>

#include "messages.h"
#include "node_name.h"

namespace spindrift::cluster {
namespace {

/// Session ids of this process are below; those of nodes have their link's prefix above.
constexpr unsigned kPrefixShift = 40;
constexpr std::size_t kRequestsWaitingMaxBytes = 8u << 20;
/// Of one node in one room.
constexpr std::size_t kArrivedMaxCount = 4096;
/// The count of people who only watch changes in the list of people at most this often.
constexpr std::chrono::seconds kUnlistedInterval{1};

core::SessionId sessionOf(std::uint32_t prefix, std::uint64_t session) {
  return (core::SessionId{prefix} << kPrefixShift) | session;
}

/// Returns the number that the session has at its node.
std::uint64_t numberAtNode(core::SessionId session) {
  return session & ((core::SessionId{1} << kPrefixShift) - 1);
}

v1::ReducedCounts toWire(const core::ReducedCounts& counts) {
  v1::ReducedCounts out;
  out.mutable_counts()->Resize(codec::kStreamCount, 0);
  for (const codec::Stream& stream : codec::allStreams())
    out.set_counts(static_cast<int>(codec::indexOf(stream)), codec::reducedCountOf(stream, counts));
  return out;
}

}  // namespace

void Feed::review(const std::vector<std::shared_ptr<rooms::Room>>& rooms, const rooms::RoomHost& simulation,
                  Clock::time_point now) {
  std::vector<std::unique_ptr<bus::Subscription>> ended;  // destroyed without the lock, which their handlers take
  const std::lock_guard lock(mutex_);
  for (const auto& room : rooms) {
    FedRoom& fed = rooms_[room->name()];
    if (fed.room == room) continue;
    ended.push_back(std::move(fed.requests));
    fed = FedRoom{};
    fed.room = room;
    fed.run = newRun();
    fed.device = simulation.deviceLine();
    fed.scenes = simulation.rules().scenes.names();
    fed.requests = bus_.subscribe(subjects_.room(room->name()), kRequestsWaitingMaxBytes,
                                  [this, name = room->name()](core::ByteView message) { take(name, message); });
  }
  const bool is_pulse_due = now >= next_pulse_;
  if (is_pulse_due) next_pulse_ = now + kPulseInterval;
  for (auto& [name, room] : rooms_) {
    for (auto link = room.links.begin(); link != room.links.end();) {
      if (now - link->second.heard > kLinkPatience) {
        spdlog::warn("room {}: node {} with {} sessions is silent; its people leave", name, link->first,
                     link->second.session_count);
        ++lost_link_count_;
        endLink(room, link->second);
        by_prefix_.erase(link->second.prefix);
        link = room.links.erase(link);
        continue;
      }
      if (is_pulse_due) {
        v1::FromRoom pulse;
        pulse.mutable_pulse();
        send(name, link->first, link->second, std::move(pulse));
      }
      ++link;
    }
    if (const auto counts = room.room->snapshot()->reduced_counts; counts != room.reduced_counts) {
      room.reduced_counts = counts;
      for (auto& [node, link] : room.links) {
        v1::FromRoom out;
        *out.mutable_reduced_counts() = toWire(counts);
        send(name, node, link, std::move(out));
      }
    }
    if (now < room.next_unlisted) continue;
    std::uint32_t unlisted_count = 0;
    for (const auto& [node, link] : room.links) unlisted_count += link.unlisted_count;
    if (unlisted_count == room.told_unlisted_count) continue;
    room.told_unlisted_count = unlisted_count;
    room.next_unlisted = now + kUnlistedInterval;
    room.room->roster().setUnlistedCount(unlisted_count);
  }
}

void Feed::send(const std::string& room, const std::string& node, Link& link, v1::FromRoom message) const {
  message.set_room(room);
  message.set_link(link.number);
  message.set_sequence(++link.sequence);
  v1::ToNode out;
  *out.mutable_from_room() = std::move(message);
  bus_.publish(subjects_.node(node), serialize(out));
}

void Feed::sendView(const std::string& name, FedRoom& room, const std::string& node, Link& link,
                    double node_time_s) const {
  const auto snapshot = room.room->snapshot();
  v1::FromRoom message;
  v1::RoomView& view = *message.mutable_view();
  *view.mutable_scene() = snapshot->scene;
  view.set_paused(snapshot->paused);
  view.set_speed(snapshot->speed);
  for (const std::uint32_t person_id : snapshot->clock_person_ids) view.add_clock_person_ids(person_id);
  *view.mutable_boats() = snapshot->boats;
  view.set_device(room.device);
  for (const std::string& scene : room.scenes) view.add_scenes(scene);
  *view.mutable_fidelity_levels() = room.room->vitals()->fidelity_levels;
  view.set_grace_s(std::chrono::duration<double>(room.room->roster().grace()).count());
  *view.mutable_people() = room.room->roster().people();
  const auto lesson = room.room->lesson();
  *view.mutable_lesson() = lesson->lesson;
  *view.mutable_game() = lesson->game;
  view.set_node_time_s(node_time_s);
  view.set_room_time_s(core::monotonic_s());
  *view.mutable_access() = room.room->access();
  *view.mutable_reduced_counts() = toWire(snapshot->reduced_counts);
  send(name, node, link, std::move(message));
}

void Feed::endLink(FedRoom& room, Link& link) {
  takeWatching(room, link, {});
  const auto now = rooms::Roster::Clock::now();
  for (const std::uint64_t session : link.arrived) room.room->roster().leave(sessionOf(link.prefix, session), now);
}

// From nodes

void Feed::attach(FedRoom& room, const v1::ToRoom& message) {
  Link& link = room.links[message.node()];
  if (link.number != message.link()) {
    endLink(room, link);
    by_prefix_.erase(link.prefix);
    link = Link{};
    link.number = message.link();
    link.prefix = ++last_prefix_;
    by_prefix_[link.prefix] = {room.room->name(), message.node()};
  }
  link.heard = Clock::now();
  if (message.attach().version() != kClusterVersion) {
    v1::FromRoom refused;
    refused.set_refused("this server speaks version " + std::to_string(kClusterVersion) +
                        " of the cluster's messages, the node version " + std::to_string(message.attach().version()) +
                        ": run the same version of the program on all machines");
    return send(room.room->name(), message.node(), link, std::move(refused));
  }
  spdlog::info("room {}: node {} attaches", room.room->name(), message.node());
  sendView(room.room->name(), room, message.node(), link, message.attach().node_time_s());
}

void Feed::take(const std::string& name, core::ByteView bytes) {
  auto parsed = parse<v1::ToRoom>(bytes);
  if (!parsed || !core::isRoomName(parsed->node())) return;
  v1::ToRoom& message = *parsed;
  std::unique_lock lock(mutex_);
  const auto found = rooms_.find(name);
  if (found == rooms_.end()) return;
  FedRoom& room = found->second;
  if (message.has_attach()) return attach(room, message);
  const auto known = room.links.find(message.node());
  if (known == room.links.end() || known->second.number != message.link()) return;  // it will notice, and attach again
  Link& link = known->second;
  link.heard = Clock::now();
  switch (message.message_case()) {
    case v1::ToRoom::kWatching:
      return takeWatching(room, link, message.watching());
    case v1::ToRoom::kArrive: {
      const v1::Arrive& who = message.arrive();
      if (link.arrived.size() >= kArrivedMaxCount) return;
      const rooms::Admission admission =
          room.room->roster().arrive({.session = sessionOf(link.prefix, who.session()),
                                      .role = wire::fromWire(who.role()).value_or(core::Role::kViewer),
                                      .name = who.name(),
                                      .color_rgb = who.color_rgb(),
                                      .resume_key = who.resume_key()});
      link.arrived.insert(who.session());
      v1::FromRoom answer;
      v1::Admitted& admitted = *answer.mutable_admitted();
      admitted.set_session(who.session());
      admitted.set_person_id(admission.person_id);
      admitted.set_resume_key(admission.resume_key);
      admitted.set_resumed(admission.resumed);
      send(name, message.node(), link, std::move(answer));
      if (!admission.displaced) return;
      v1::FromRoom notice;
      notice.set_displaced_session(numberAtNode(*admission.displaced));
      lock.unlock();
      if (!sendToNodeOf(*admission.displaced, std::move(notice))) events_.displaced(*admission.displaced);
      return;
    }
    case v1::ToRoom::kLeaveSession: {
      if (link.arrived.erase(message.leave_session()) > 0)
        room.room->roster().leave(sessionOf(link.prefix, message.leave_session()), rooms::Roster::Clock::now());
      return;
    }
    case v1::ToRoom::kCommand: {
      v1::RoomCommand& sent = *message.mutable_command();
      rooms::Command command;
      command.sender.session_id = sessionOf(link.prefix, sent.session());
      command.sender.person_id = sent.person_id();
      command.sender.role = wire::fromWire(sent.role()).value_or(core::Role::kViewer);
      command.sender.details = std::make_shared<const core::SenderDetails>(
          core::SenderDetails{.room = name, .subject = sent.subject(), .name = sent.name(), .peer = sent.peer()});
      command.message = std::move(*sent.mutable_command());
      const std::shared_ptr<rooms::Room> target = room.room;
      lock.unlock();
      if (const auto rejection = target->admit(command)) events_.rejected(command, *rejection);
      return;
    }
    case v1::ToRoom::kDetach:
      endLink(room, link);
      by_prefix_.erase(link.prefix);
      room.links.erase(known);
      return;
    default:
      return;
  }
}

// To nodes

void Feed::sceneChanged(const rooms::Room& room) {
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(room.name());
  if (found == rooms_.end() || found->second.room.get() != &room) return;
  for (auto& [node, link] : found->second.links) sendView(room.name(), found->second, node, link, 0.0);
}

void Feed::stateChanged(const rooms::Room& room, const net::StateTopic& topic, const core::SharedBytes& message) {
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(room.name());
  if (found == rooms_.end()) return;
  for (auto& [node, link] : found->second.links) {
    v1::FromRoom out;
    out.mutable_news()->set_topic(topic.name);
    out.mutable_news()->set_scope(static_cast<std::uint32_t>(topic.scope));
    out.mutable_news()->set_message(message->data(), message->size());
    send(room.name(), node, link, std::move(out));
  }
}

void Feed::closed(const rooms::Room& room) {
  events_.closed(room.name());
  std::unique_ptr<bus::Subscription> ended;  // destroyed without the lock, which its handler takes
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(room.name());
  if (found == rooms_.end() || found->second.room.get() != &room) return;
  for (auto& [node, link] : found->second.links) {
    v1::FromRoom out;
    out.mutable_closed();
    send(room.name(), node, link, std::move(out));
    by_prefix_.erase(link.prefix);
  }
  ended = std::move(found->second.requests);
  rooms_.erase(found);
}

void Feed::giveUp(const std::string& name) {
  FedRoom ended;  // destroyed without the lock, which the handler of its subscription takes
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(name);
  if (found == rooms_.end()) return;
  for (const auto& [node, link] : found->second.links) by_prefix_.erase(link.prefix);
  ended = std::move(found->second);
  rooms_.erase(found);
}

bool Feed::sendToNodeOf(core::SessionId session, v1::FromRoom message) {
  const auto prefix = static_cast<std::uint32_t>(session >> kPrefixShift);
  if (prefix == 0) return false;
  const std::lock_guard lock(mutex_);
  const auto whose = by_prefix_.find(prefix);
  if (whose == by_prefix_.end()) return true;  // its link has ended: nobody waits for the answer
  const auto& [name, node] = whose->second;
  const auto room = rooms_.find(name);
  if (room == rooms_.end()) return true;
  const auto link = room->second.links.find(node);
  if (link != room->second.links.end()) send(name, node, link->second, std::move(message));
  return true;
}

bool Feed::commandApplied(const rooms::Command& command, const v1::Ack& ack) {
  v1::FromRoom message;
  v1::Outcome& outcome = *message.mutable_outcome();
  outcome.set_session(numberAtNode(command.sender.session_id));
  *outcome.mutable_ack() = ack;
  return sendToNodeOf(command.sender.session_id, std::move(message));
}

bool Feed::commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) {
  v1::FromRoom message;
  v1::Outcome& outcome = *message.mutable_outcome();
  outcome.set_session(numberAtNode(command.sender.session_id));
  *outcome.mutable_reject() = rejection;
  return sendToNodeOf(command.sender.session_id, std::move(message));
}

bool Feed::queryAnswered(const core::Sender& sender, const v1::QueryAnswer& answer) {
  v1::FromRoom message;
  v1::QueryAnswered& answered = *message.mutable_query_answered();
  answered.set_session(numberAtNode(sender.session_id));
  *answered.mutable_answer() = answer;
  return sendToNodeOf(sender.session_id, std::move(message));
}

bool Feed::hullsFelt(const core::Sender& sender, const v1::HullForces& forces) {
  v1::FromRoom message;
  v1::HullsFelt& felt = *message.mutable_hulls_felt();
  felt.set_session(numberAtNode(sender.session_id));
  *felt.mutable_forces() = forces;
  return sendToNodeOf(sender.session_id, std::move(message));
}

}  // namespace spindrift::cluster
