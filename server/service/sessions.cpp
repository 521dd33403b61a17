#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/core/overloaded.h>
#include <spindrift/core/text.h>
#include <spindrift/service/sessions.h>
#include <spindrift/service/state_topics.h>
#include <spindrift/service/stream_index.h>
#include <spindrift/wire/client_message.h>
#include <spindrift/wire/server_message.h>

#include "greeting.h"

namespace spindrift::service {
namespace {

/// Messages that a client may send before its Hello is answered: its subscriptions and first commands.
constexpr std::size_t kWaitingMaxCount = 256;

}  // namespace

void Sessions::opened(net::SessionId session, const std::shared_ptr<Venue>& venue, const net::SessionOpening& opening) {
  const auto now = std::chrono::steady_clock::now();
  {
    const std::lock_guard lock(mutex_);
    sessions_.emplace(session, State{.venue = venue,
                                     .greeted = nullptr,
                                     .commands = {rules_.commands_per_s, rules_.command_burst_count, now},
                                     .peer = opening.peer,
                                     .is_onlooker = opening.is_onlooker});
  }
  spdlog::info("session {} from {} {} room {}", session, opening.peer, opening.is_onlooker ? "looks at" : "joins",
               venue->name());
  greet(session, *venue);
  hub().closeAt(session, now + rules_.hello_patience, net::CloseCode::kPolicy,
                "Hello did not arrive in time: send ClientMessage.hello first");
  // The room may have closed meanwhile, and dismiss() may have run before this session was in its list.
  if (!venue->isOpen()) refuse(session, net::CloseCode::kRoomClosed, "the room was closed");
}

void Sessions::greet(net::SessionId session, const Venue& venue) {
  const std::lock_guard in_order(greeting_mutex_);
  const auto view = venue.view();
  if (!view) return;
  std::shared_ptr<const VenueView> before;
  if (!with(session, [&](State& state) { before = std::exchange(state.greeted, view); })) return;
  if (before && before->room == view->room) return;
  hub().sendState(session, topic::kGreeting, greetingOf(venue, *view, session, rules_));
}

void Sessions::tellLesson(net::SessionId session, const Venue& venue) {
  // News that came between reading and sending would be followed by what it has replaced: then send it again.
  std::shared_ptr<const rooms::LessonState> sent;
  for (auto now = venue.lesson(); now != sent; now = venue.lesson()) {
    hub().sendState(session, topic::kLesson, wire::lesson(now->lesson));
    hub().sendState(session, topic::kGame, wire::game(now->game));
    sent = std::move(now);
  }
}

void Sessions::roomChanged(const Venue& venue) {
  std::vector<net::SessionId> members;
  std::vector<std::pair<net::SessionId, std::string>> outdated;
  const auto view = venue.view();
  if (!view) return;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [session, state] : sessions_) {
      if (state.venue->name() != venue.name()) continue;
      auto why = state.stage == Stage::kIn ? wire::checkWater(state.wire_minor, view->room->scene) : std::nullopt;
      if (why)
        outdated.emplace_back(session, *std::move(why));
      else
        members.push_back(session);
    }
  }
  for (const net::SessionId session : members) greet(session, venue);
  for (const auto& [session, why] : outdated) refuse(session, net::CloseCode::kPolicy, why);
}

void Sessions::dismiss(const std::string& room, net::CloseCode code, const std::string& why) {
  std::vector<net::SessionId> members;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [session, state] : sessions_) {
      if (state.venue->name() == room) members.push_back(session);
    }
  }
  for (const net::SessionId session : members) refuse(session, code, why);
}

void Sessions::drain(net::Server& network, std::chrono::milliseconds closes_in, const std::string& go_to) {
  /// A server that is started again can take this many clients per second: handshake, greeting and keyframes.
  constexpr double kReturnsPerS = 200.0;
  constexpr double kRestart_s = 1.0;  // shortest time in which a server comes back
  const double closes_in_s = std::chrono::duration<double>(closes_in).count();
  const double spread_s = static_cast<double>(network.stats().open_session_count) / kReturnsPerS;
  v1::Draining draining;
  draining.set_closes_in_s(closes_in_s);
  draining.set_go_to(go_to);
  draining.set_reconnect_after_min_s(go_to.empty() ? closes_in_s + kRestart_s : 0.0);
  draining.set_reconnect_after_max_s(go_to.empty() ? closes_in_s + kRestart_s + std::max(0.5, spread_s) : closes_in_s);
  network.drain(std::chrono::seconds(static_cast<std::int64_t>(std::ceil(closes_in_s + kRestart_s))));
  const core::SharedBytes message = wire::draining(draining);
  const std::lock_guard lock(mutex_);
  for (const auto& [session, state] : sessions_) {
    if (state.stage != Stage::kNew && state.wire_minor >= wire::kDrainingMinor)
      hub().sendState(session, topic::kDraining, message);
  }
}

void Sessions::displace(net::SessionId session) {
  refuse(session, net::CloseCode::kResumedElsewhere, "another connection continues in your place");
}

void Sessions::refuse(net::SessionId session, net::CloseCode code, const std::string& why) {
  hub().sendAnswer(session, wire::refusal(why));
  hub().close(session, code, why);
}

void Sessions::message(net::SessionId session, core::ByteView message) {
  std::optional<State> known;
  bool is_kept = false;
  const bool is_open = with(session, [&](State& state) {
    is_kept = state.stage == Stage::kArriving && state.waiting.size() < kWaitingMaxCount;
    if (is_kept)
      state.waiting.emplace_back(message.begin(), message.end());
    else if (state.stage != Stage::kArriving)
      known = state;
  });
  if (!is_open || is_kept) return;
  if (!known) {
    return refuse(session, net::CloseCode::kTryAgainLater,
                  fmt::format("more than {} messages before the answer to hello: wait for it", kWaitingMaxCount));
  }
  handle(session, *known, message);
}

void Sessions::handleWaiting(net::SessionId session) {
  while (true) {
    core::Bytes message;
    std::optional<State> known;
    with(session, [&](State& state) {
      if (state.waiting.empty()) {
        state.stage = Stage::kIn;  // from here on messages are handled where they come in
        return;
      }
      message = std::move(state.waiting.front());
      state.waiting.pop_front();
      known = state;
      known->waiting.clear();
      known->stage = Stage::kIn;
    });
    if (!known) return;
    handle(session, *known, message);
  }
}

void Sessions::handle(net::SessionId session, const State& state, core::ByteView message) {
  std::visit(core::Overloaded{
                 [&](const v1::Hello& said) { hello(session, state, said); },
                 [&](const wire::Subscribe& asked) { subscribe(session, state, asked); },
                 [&](v1::Command&& parsed) { command(session, state, std::move(parsed)); },
                 [&](const v1::Ping& ping) {
                   const double offset_s = state.greeted ? state.greeted->clock_offset_s : 0.0;
                   hub().sendAnswer(session, wire::pong(ping.client_time_s(), core::monotonic_s() + offset_s));
                 },
                 [&](const wire::CommandRejection& rejection) {
                   counters_.rejected(rejection.reason());
                   hub().sendAnswer(session, wire::reject(rejection));
                 },
                 [&](const core::Error& malformed) { refuse(session, net::CloseCode::kPolicy, malformed.message); },
             },
             wire::parseClientMessage(message));
}

void Sessions::hello(net::SessionId session, const State& state, const v1::Hello& hello) {
  if (auto why = wire::checkVersion(hello.version())) return refuse(session, net::CloseCode::kPolicy, *why);
  const auto view = state.venue->view();
  if (view) {
    if (auto why = wire::checkWater(hello.version().minor(), view->room->scene))
      return refuse(session, net::CloseCode::kPolicy, *why);
  }
  if (state.stage != Stage::kNew)
    return refuse(session, net::CloseCode::kPolicy, "Hello was sent before: send it once");
  const auto now = std::chrono::system_clock::now();
  const std::string& room = state.venue->name();
  const auto grant = access_.resolve(hello.token(), {{room, view ? view->room_access : v1::RoomAccess{}}}, now);
  auto details = std::make_shared<core::SenderDetails>(core::SenderDetails{
      .room = room, .subject = grant ? grant->subject : "", .name = hello.name(), .peer = state.peer});
  if (!grant && !view) {  // it may be a token of the room
    return refuse(session, net::CloseCode::kTryAgainLater, "the room cannot be reached now: try again later");
  }
  if (!grant || !grant->allows(room)) {
    const std::string why = grant ? access::otherRoom(room) : grant.error().message;
    access_.audit().refused(*details, why);
    return refuse(session, net::CloseCode::kUnauthorized, why);
  }
  if (!grant->name.empty()) details->name = core::cleanName(grant->name, wire::kPersonNameMaxBytes);
  auto end = std::chrono::steady_clock::time_point::max();  // replaces the deadline for Hello
  if (grant->expires) {
    const auto left = std::chrono::duration_cast<std::chrono::steady_clock::duration>(*grant->expires - now);
    end = std::chrono::steady_clock::now() + left;
  }
  hub().closeAt(session, end, net::CloseCode::kUnauthorized, "the token has expired: ask for a new one");
  const bool is_open = with(session, [&](State& kept) {
    kept.stage = Stage::kArriving;
    kept.details = details;
    if (grant->is_person) kept.person = grant->subject;
  });
  if (!is_open) return;
  if (state.is_onlooker) return arrived(session, hello, grant->role, rooms::Admission{});
  state.venue->arrive({.session = session,
                       .role = grant->role,
                       .name = details->name,
                       .color_rgb = hello.color_rgb(),
                       .resume_key = hello.resume_key()},
                      [this, session, hello, role = grant->role](const core::Result<rooms::Admission>& admission) {
                        arrived(session, hello, role, admission);
                      });
}

void Sessions::arrived(net::SessionId session, const v1::Hello& hello, core::Role role,
                       const core::Result<rooms::Admission>& admission) {
  if (!admission) return refuse(session, net::CloseCode::kTryAgainLater, admission.error().message);
  if (admission->displaced) displace(*admission->displaced);
  std::shared_ptr<Venue> venue;
  const bool is_open = with(session, [&](State& kept) {
    venue = kept.venue;
    kept.wire_minor = hello.version().minor();
    kept.role = role;
  });
  if (!is_open) return;  // it ended meanwhile; closed() has told the room
  spdlog::info("session {} is person {} ({}), {} {}", session, admission->person_id, core::roleName(role),
               hello.client(), admission->resumed ? "resumed" : "");
  welcome(session, *admission, role, *venue);
  // From here on the session gets the room's news, and the frames that it subscribes to. Send the changes since the
  // greeting.
  hub().join(session, venue->name(), venue->demand());
  venue->watchesChanged();
  if (const auto view = venue->view()) {
    if (auto why = wire::checkWater(hello.version().minor(), view->room->scene))
      return refuse(session, net::CloseCode::kPolicy, *why);
  }
  greet(session, *venue);
  hub().sendState(session, topic::kPeople, wire::people(venue->people()));
  tellLesson(session, *venue);
  handleWaiting(session);
}

void Sessions::welcome(net::SessionId session, const rooms::Admission& admission, core::Role role, const Venue& venue) {
  const bool is_open = with(session, [&](State& kept) {
    kept.person_id = admission.person_id;
    kept.resume_key = admission.resume_key;
  });
  if (!is_open) return;
  v1::Welcome message;
  message.set_role(wire::toWire(role));
  message.set_person_id(admission.person_id);
  message.set_resume_key(admission.resume_key);
  if (const auto view = venue.view()) message.set_grace_s(std::chrono::duration<double>(view->grace).count());
  message.set_resumed(admission.resumed);
  hub().sendAnswer(session, wire::welcome(message));
}

void Sessions::readmitted(net::SessionId session, const rooms::Admission& admission) {
  std::shared_ptr<Venue> venue;
  core::Role role{};
  with(session, [&](const State& state) {
    if (state.person_id == admission.person_id && state.resume_key == admission.resume_key) return;
    venue = state.venue;
    role = state.role;
  });
  if (!venue) return;
  spdlog::info("session {} is now person {}", session, admission.person_id);
  welcome(session, admission, role, *venue);
}

void Sessions::subscribe(net::SessionId session, const State& state, const wire::Subscribe& subscribe) {
  if (state.stage != Stage::kIn) {
    return refuse(session, net::CloseCode::kPolicy, "subscribe before hello: send ClientMessage.hello first");
  }
  // One packing at a time: a subscription to the other packing stops this one.
  const bool knows_packing = subscribe.layer != v1::LAYER_FLOATERS || state.wire_minor >= wire::kPackedFloatersMinor;
  const codec::Stream wanted = codec::streamOf(subscribe.layer, knows_packing ? subscribe.packing : v1::PACKING_PLAIN);
  const bool is_first = subscribe.max_rate_hz > 0.0 && noteWatched(session, subscribe.layer);
  for (const codec::Stream stream : codec::allStreams()) {
    if (stream.layer != wanted.layer) continue;
    const bool is_wanted = stream.packing == wanted.packing;
    hub().watch(session, streamIndex(stream),
                {.max_rate_hz = is_wanted ? std::min(subscribe.max_rate_hz, kFrameRateMax_hz) : 0.0,
                 .level = subscribe.level,
                 .adapts = codec::hasLevels(subscribe.layer) && subscribe.adapts,
                 .is_first = is_first});
  }
  state.venue->watchesChanged();
}

bool Sessions::noteWatched(net::SessionId session, v1::Layer layer) {
  bool is_new = false;
  with(session, [&](State& state) {
    const std::uint32_t before =
        std::exchange(state.watched_layers, state.watched_layers | 1u << static_cast<unsigned>(layer));
    is_new = state.watched_layers != before;
  });
  return is_new;
}

void Sessions::levelChanged(net::SessionId session, core::Level level) {
  spdlog::info("session {} now gets level {}", session, codec::nameOf(level));
  hub().sendState(session, topic::kLevel, wire::levelChanged(level));
}

void Sessions::command(net::SessionId session, const State& state, v1::Command message) {
  const rooms::Command command{
      .sender = {.session_id = session, .person_id = state.person_id, .role = state.role, .details = state.details},
      .message = std::move(message)};
  const auto reject = [&](v1::RejectReason reason, std::string why) {
    commandRejected(command, wire::rejection(reason, "", std::move(why), command.id()));
  };
  if (state.stage != Stage::kIn)
    return reject(v1::REJECT_REASON_NO_HELLO, "a command before Hello: send ClientMessage.hello first");
  if (!takeCommand(session)) {
    return reject(v1::REJECT_REASON_BUSY,
                  fmt::format("more than {:g} commands per second after a burst of {:g}: slow down",
                              rules_.commands_per_s, rules_.command_burst_count));
  }
  if (state.is_onlooker)
    return reject(v1::REJECT_REASON_FORBIDDEN, "an onlooker sends no commands: connect without ?onlooker");
  if (!access_.takeCommand(state.person)) return reject(v1::REJECT_REASON_BUSY, access_.busy());
  state.venue->command(command);
}

bool Sessions::takeCommand(net::SessionId session) {
  bool is_taken = false;
  with(session, [&](State& state) { is_taken = state.commands.take(std::chrono::steady_clock::now()); });
  return is_taken;
}

void Sessions::commandApplied(const rooms::Command& command, const v1::Ack& ack) {
  hub().sendAnswer(command.sender.session_id, wire::ack(ack));
}

void Sessions::queryAnswered(net::SessionId session, const v1::QueryAnswer& answer) {
  if (std::ranges::any_of(answer.results(), &v1::QueryResult::last))
    return hub().sendAnswer(session, wire::queryAnswer(answer));
  hub().sendState(session, topic::kQueries, wire::queryAnswer(answer));
}

void Sessions::hullsFelt(net::SessionId session, const v1::HullForces& forces) {
  hub().sendState(session, topic::kHullForces, wire::hullForces(forces));
}

void Sessions::commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) {
  counters_.rejected(rejection.reason());
  access_.audit().rejected(command, rejection);
  hub().sendAnswer(command.sender.session_id, wire::reject(rejection));
}

void Sessions::closed(net::SessionId session, const net::SessionEnd& end) {
  std::shared_ptr<Venue> venue;
  {
    const std::lock_guard lock(mutex_);
    if (auto node = sessions_.extract(session)) venue = std::move(node.mapped().venue);
  }
  if (venue) venue->leave(session);
  spdlog::info("session {} ended: {} {}", session, end.code, end.reason);
}

}  // namespace spindrift::service
