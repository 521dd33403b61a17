#include "remote_room.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/wire/client_message.h>

#include "feed.h"
#include "messages.h"

namespace spindrift::cluster {
namespace {

using namespace std::chrono_literals;

/// How often a lost room is looked for.
constexpr auto kAttachInterval = 150ms;
/// A room that is silent for so long is looked for anew.
constexpr auto kRoomPatience = 900ms;
/// Sessions that wait for a room longer than this are told so.
constexpr auto kArrivalPatience = 10s;
/// The link stays so long after the last session.
constexpr auto kIdlePatience = 10s;
/// Unanswered commands of a session; a room's queue takes no more from one sender either.
constexpr std::size_t kCommandMaxCount = 512;
/// Person numbers of watchers that the room does not list.
constexpr std::uint32_t kUnlistedPerson = 0x8000'0000u;

std::uint64_t newLinkNumber() {
  // Unique for this node also across its restarts.
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

core::Error unreachable() {
  return {core::ErrorCode::kUnavailable, "the room cannot be reached now: try again later"};
}

wire::CommandRejection unreachable(std::uint64_t command_id, const std::string& why) {
  return wire::rejection(v1::REJECT_REASON_BUSY, "", why, command_id);
}

}  // namespace

rooms::Command RemoteRoom::commandOf(core::SessionId session, std::uint64_t id) {
  rooms::Command command;
  command.sender.session_id = session;
  command.message.set_command_id(id);
  return command;
}

RemoteRoom::RemoteRoom(std::string name, std::string node, bus::Bus& bus, const Subjects& subjects,
                       service::Sessions& sessions)
    : name_(std::move(name)),
      node_(std::move(node)),
      bus_(bus),
      subjects_(subjects),
      sessions_(sessions),
      used_(Clock::now()) {
  const std::lock_guard lock(mutex_);
  attach(Clock::now());
}

void RemoteRoom::send(v1::ToRoom message) {
  message.set_node(node_);
  message.set_link(link_);
  bus_.publish(subjects_.room(name_), serialize(message));
}

void RemoteRoom::attach(Clock::time_point now) {
  tried_ = now;
  attached_ = false;
  link_ = std::max(newLinkNumber(), link_ + 1);
  sequence_ = 0;
  v1::ToRoom message;
  message.mutable_attach()->set_version(kClusterVersion);
  message.mutable_attach()->set_node_time_s(core::monotonic_s());
  send(std::move(message));
}

void RemoteRoom::detach() {
  Dropped dropped;
  const std::lock_guard lock(mutex_);
  v1::ToRoom message;
  message.mutable_detach();
  send(std::move(message));
  attached_ = false;
  closed_ = true;
  for (auto& levels : feeds_) {
    for (Feed& one : levels) {
      dropped.push_back(std::move(one.frames));
      dropped.push_back(std::move(one.keyframes));
    }
  }
}

void RemoteRoom::review(Clock::time_point now) {
  std::vector<rooms::Command> refused;
  std::vector<Arrived> hopeless;
  {
    Dropped dropped;
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    if (attached_ && now - heard_ > kRoomPatience) {
      spdlog::warn("room {}: its server is silent; looking for the room elsewhere", name_);
      ++stats_.lost_link_count;
      refused = loseLink();
    }
    if (!attached_ && now - tried_ > kAttachInterval) attach(now);
    const bool is_pulse_due = now - told_ >= kPulseInterval;
    for (auto guest = guests_.begin(); is_pulse_due && guest != guests_.end();) {
      if (guest->second.arrived && now - guest->second.since > kArrivalPatience) {
        hopeless.push_back(std::move(guest->second.arrived));
        guest = guests_.erase(guest);
      } else {
        ++guest;
      }
    }
    if (attached_) reviewStreams(now, is_pulse_due, dropped);
  }
  reject(refused, "the room's server is silent");
  for (const Arrived& arrived : hopeless) arrived(unreachable());
}

std::vector<rooms::Command> RemoteRoom::loseLink() {
  std::vector<rooms::Command> out;
  attached_ = false;
  if (!lost_since_) lost_since_ = heard_;
  for (auto& [session, guest] : guests_) {
    for (const std::uint64_t id : std::exchange(guest.commands, {})) out.push_back(commandOf(session, id));
  }
  return out;
}

void RemoteRoom::reject(const std::vector<rooms::Command>& commands, const std::string& why) {
  for (const rooms::Command& one : commands) {
    sessions_.commandRejected(one, unreachable(one.id(), why + "; whether the command was carried out is not known"));
  }
}

bool RemoteRoom::isIdle(Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  return closed_ || (guests_.empty() && demand_->sessionCount() == 0 && now - used_ > kIdlePatience);
}

LinkStats RemoteRoom::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

std::shared_ptr<const service::VenueView> RemoteRoom::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

std::shared_ptr<const rooms::LessonState> RemoteRoom::lesson() const {
  const std::lock_guard lock(mutex_);
  return lesson_;
}

v1::People RemoteRoom::people() const {
  const std::lock_guard lock(mutex_);
  return people_;
}

bool RemoteRoom::isOpen() const {
  const std::lock_guard lock(mutex_);
  return !closed_;
}

// From the sessions

void RemoteRoom::arrive(const rooms::Arrival& arrival, Arrived arrived) {
  // Without NATS nobody answers: the client hears it now, not after kArrivalPatience.
  if (!bus_.isConnected()) return arrived(unreachable());
  rooms::Admission unlisted;
  {
    const std::lock_guard lock(mutex_);
    used_ = Clock::now();
    Guest& guest = guests_[arrival.session];
    guest.arrival = arrival;
    guest.since = used_;
    guest.is_listed = arrival.role != core::Role::kViewer || people_.people_size() < kListedPeopleMaxCount;
    if (guest.is_listed) {
      guest.arrived = std::move(arrived);
      if (attached_) sendArrival(guest);
      return;
    }
    unlisted.person_id = kUnlistedPerson + ++last_unlisted_ % kUnlistedPerson;
  }
  arrived(unlisted);
}

void RemoteRoom::sendArrival(const Guest& guest) {
  v1::ToRoom message;
  v1::Arrive& who = *message.mutable_arrive();
  who.set_session(guest.arrival.session);
  who.set_role(wire::toWire(guest.arrival.role));
  who.set_name(guest.arrival.name);
  who.set_color_rgb(guest.arrival.color_rgb);
  who.set_resume_key(guest.arrival.resume_key);
  send(std::move(message));
}

void RemoteRoom::leave(core::SessionId session) {
  const std::lock_guard lock(mutex_);
  used_ = Clock::now();
  const auto node = guests_.extract(session);
  if (!node || !node.mapped().is_listed || !attached_) return;
  v1::ToRoom message;
  message.set_leave_session(session);
  send(std::move(message));
}

void RemoteRoom::watchesChanged() {
  offerKept();  // whoever is served by it needs no keyframe of the room
  Dropped dropped;
  const std::lock_guard lock(mutex_);
  if (attached_) reviewStreams(Clock::now(), false, dropped);
}

void RemoteRoom::command(const rooms::Command& command) {
  std::optional<std::string> why;
  {
    const std::lock_guard lock(mutex_);
    const auto guest = guests_.find(command.sender.session_id);
    if (!attached_ || guest == guests_.end()) {
      why = "the room cannot be reached now: try again";
    } else if (guest->second.commands.size() >= kCommandMaxCount) {
      why = fmt::format("{} commands wait for an answer: wait for some", kCommandMaxCount);
    } else {
      guest->second.commands.push_back(command.id());
      v1::ToRoom message;
      v1::RoomCommand& sent = *message.mutable_command();
      sent.set_session(command.sender.session_id);
      sent.set_person_id(command.sender.person_id);
      sent.set_role(wire::toWire(command.sender.role));
      if (command.sender.details) {
        sent.set_subject(command.sender.details->subject);
        sent.set_name(command.sender.details->name);
        sent.set_peer(command.sender.details->peer);
      }
      *sent.mutable_command() = command.message;
      send(std::move(message));
    }
  }
  if (why) sessions_.commandRejected(command, unreachable(command.id(), *why));
}

}  // namespace spindrift::cluster
