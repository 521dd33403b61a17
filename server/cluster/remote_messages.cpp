// The messages of a remote room: what it is, what changed, who was admitted, and the answers to commands.
#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/service/state_topics.h>
#include <spindrift/wire/server_message.h>

#include "remote_room.h"

namespace spindrift::cluster {
namespace {

std::array<std::uint32_t, codec::kStreamCount> fromMessage(const v1::ReducedCounts& message) {
  std::array<std::uint32_t, codec::kStreamCount> out{};
  std::ranges::copy_n(message.counts().begin(), std::min<std::ptrdiff_t>(message.counts_size(), codec::kStreamCount),
                      out.begin());
  return out;
}

}  // namespace

void RemoteRoom::take(const v1::FromRoom& message) {
  std::vector<rooms::Command> refused;
  {
    const std::lock_guard lock(mutex_);
    if (closed_ || message.link() != link_) return;
    heard_ = Clock::now();
    if (message.sequence() != sequence_ + 1 || (!attached_ && !message.has_view() && !message.has_refused())) {
      // Messages were lost, and with them perhaps answers and news: begin anew, which repeats all state.
      ++stats_.gap_count;
      refused = loseLink();
      attach(Clock::now());
    } else {
      ++sequence_;
    }
  }
  reject(refused, "a message of the room's server was lost");
  {
    const std::lock_guard lock(mutex_);
    if (message.link() != link_) return;
  }
  switch (message.message_case()) {
    case v1::FromRoom::kView:
      return takeView(message.view());
    case v1::FromRoom::kNews:
      return takeNews(message.news());
    case v1::FromRoom::kAdmitted:
      return takeAdmission(message.admitted());
    case v1::FromRoom::kOutcome:
      return takeOutcome(message.outcome());
    case v1::FromRoom::kQueryAnswered:
      return sessions_.queryAnswered(message.query_answered().session(), message.query_answered().answer());
    case v1::FromRoom::kDisplacedSession:
      return sessions_.displace(message.displaced_session());
    case v1::FromRoom::kClosed:
      return takeClosed();
    case v1::FromRoom::kReducedCounts: {
      Dropped dropped;
      const std::lock_guard lock(mutex_);
      reduced_counts_ = fromMessage(message.reduced_counts());
      return reviewStreams(Clock::now(), true, dropped);
    }
    case v1::FromRoom::kRefused:
      return spdlog::error("room {}: {}", name_, message.refused());
    default:
      return;
  }
}

void RemoteRoom::takeView(const v1::RoomView& message) {
  {
    Dropped dropped;
    const std::lock_guard lock(mutex_);
    const double now_s = core::monotonic_s();
    auto room = std::make_shared<rooms::RoomSnapshot>();
    room->scene = message.scene();
    room->paused = message.paused();
    room->speed = message.speed();
    room->clock_person_ids = {message.clock_person_ids().begin(), message.clock_person_ids().end()};
    room->boats = message.boats();
    // Half of the round trip has passed since the room read its clock.
    double offset_s = view_ ? view_->clock_offset_s : 0.0;
    if (message.node_time_s() > 0.0) offset_s = message.room_time_s() - (message.node_time_s() + now_s) / 2.0;
    view_ = std::make_shared<const service::VenueView>(
        service::VenueView{.room = std::move(room),
                           .levels = message.fidelity_levels(),
                           .device = message.device(),
                           .scenes = {message.scenes().begin(), message.scenes().end()},
                           .room_access = message.access(),
                           .grace = std::chrono::milliseconds(static_cast<std::int64_t>(message.grace_s() * 1e3)),
                           .clock_offset_s = offset_s});
    people_ = message.people();
    lesson_ = std::make_shared<const rooms::LessonState>(rooms::LessonState{message.lesson(), message.game()});
    // Perhaps another scene, or another run of the room: what was kept is out of date.
    for (auto& levels : feeds_) {
      for (Feed& one : levels) one.kept.forget();
    }
    reduced_counts_.reset();
    if (message.has_reduced_counts()) reduced_counts_ = fromMessage(message.reduced_counts());
    if (!attached_) {
      attached_ = true;
      for (const auto& [session, guest] : guests_) {
        if (guest.is_listed) sendArrival(guest);
      }
      if (lost_since_) {
        spdlog::info("room {}: reached again after {:.2f} s", name_,
                     std::chrono::duration<double>(Clock::now() - *lost_since_).count());
        lost_since_.reset();
      }
    }
    reviewStreams(Clock::now(), true, dropped);
  }
  sessions_.roomChanged(*this);
  sessions_.hub().broadcastState(name_, service::topic::kPeople, wire::people(people()));
  const auto lesson = this->lesson();
  sessions_.hub().broadcastState(name_, service::topic::kLesson, wire::lesson(lesson->lesson));
  sessions_.hub().broadcastState(name_, service::topic::kGame, wire::game(lesson->game));
}

void RemoteRoom::takeNews(const v1::RoomNews& message) {
  v1::ServerMessage content;
  if (!content.ParseFromString(message.message())) return;
  {
    // Keeps the view as the room has it, for the greetings of later sessions.
    const std::lock_guard lock(mutex_);
    if (!view_) return;
    if (content.has_people()) {
      people_ = content.people();
    } else if (content.has_lesson() || content.has_game()) {
      auto lesson = std::make_shared<rooms::LessonState>(*lesson_);
      if (content.has_lesson()) lesson->lesson = content.lesson();
      if (content.has_game()) lesson->game = content.game();
      lesson_ = std::move(lesson);
    } else if (content.has_room_state() || content.has_boat_list() || content.has_parameter_changed()) {
      auto room = std::make_shared<rooms::RoomSnapshot>(*view_->room);
      if (content.has_room_state()) {
        room->paused = content.room_state().paused();
        room->speed = content.room_state().speed();
        const auto& holders = content.room_state().clock_person_ids();
        room->clock_person_ids = {holders.begin(), holders.end()};
      } else if (content.has_boat_list()) {
        room->boats = content.boat_list();
      } else if (const auto error = scene::setParameter(room->scene, content.parameter_changed().path(),
                                                        content.parameter_changed().value())) {
        spdlog::error("room {}: the change of {} could not be followed: {}", name_, error->path, error->message);
      }
      auto view = std::make_shared<service::VenueView>(*view_);
      view->room = std::move(room);
      view_ = std::move(view);
    }
  }
  const net::StateTopic topic{.name = message.topic(), .scope = static_cast<net::StateTopic::Scope>(message.scope())};
  sessions_.hub().broadcastState(name_, topic, core::share({message.message().begin(), message.message().end()}));
}

void RemoteRoom::takeAdmission(const v1::Admitted& message) {
  const rooms::Admission admission{.person_id = message.person_id(),
                                   .resume_key = message.resume_key(),
                                   .resumed = message.resumed(),
                                   .displaced = std::nullopt};
  Arrived arrived;
  {
    const std::lock_guard lock(mutex_);
    const auto guest = guests_.find(message.session());
    if (guest == guests_.end()) return;
    guest->second.arrival.resume_key = admission.resume_key;  // after a loss of the link the same person comes back
    arrived = std::exchange(guest->second.arrived, nullptr);
  }
  if (arrived) return arrived(admission);
  sessions_.readmitted(message.session(), admission);
}

void RemoteRoom::takeOutcome(const v1::Outcome& message) {
  const std::uint64_t id = message.has_ack() ? message.ack().command_id() : message.reject().command_id();
  {
    const std::lock_guard lock(mutex_);
    const auto guest = guests_.find(message.session());
    if (guest == guests_.end()) return;
    auto& commands = guest->second.commands;
    const auto sent = std::ranges::find(commands, id);
    if (sent == commands.end()) return;
    commands.erase(sent);
  }
  const rooms::Command command = commandOf(message.session(), id);
  if (message.has_ack()) return sessions_.commandApplied(command, message.ack());
  sessions_.commandRejected(command, message.reject());
}

void RemoteRoom::takeClosed() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    attached_ = false;
  }
  sessions_.dismiss(name_);
}

}  // namespace spindrift::cluster
