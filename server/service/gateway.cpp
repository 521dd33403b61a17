#include <chrono>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/core/overloaded.h>
#include <spindrift/core/version.h>
#include <spindrift/service/gateway.h>
#include <spindrift/service/state_topics.h>
#include <spindrift/service/stream_index.h>
#include <spindrift/wire/client_message.h>
#include <spindrift/wire/server_message.h>

namespace spindrift::service {
namespace {

constexpr double kFrameRateMax_hz = 60.0;

std::vector<v1::Layer> layersOf(const v1::Scene& scene) {
  std::vector<v1::Layer> layers;
  if (scene.has_wave()) layers.push_back(v1::LAYER_SURFACE);
  if (scene.has_particles()) layers.push_back(v1::LAYER_PARTICLES);
  if (scene.has_boats()) layers.push_back(v1::LAYER_BODIES);
  if (scene.foam().surface()) layers.push_back(v1::LAYER_FOAM);
  layers.push_back(v1::LAYER_DIAGNOSTICS);
  return layers;
}

}  // namespace

Gateway::Gateway(GatewayOptions options, const MetricsSources& sources)
    : options_(std::move(options)),
      rest_(options_.access, counters_, sources,
            {[this](const rooms::Room& room) { dismiss(room); }, options_.on_drain}) {}

void Gateway::serve(rooms::SimulationThread& rooms, rooms::EncoderThread& encoder) {
  rooms_ = &rooms;
  encoder_ = &encoder;
  rest_.serve(rooms);
}

void Gateway::serverStarts(net::Hub& served) {
  hub_ = &served;
  rest_.serverStarts(served);
}

core::Result<void> Gateway::acceptSession(const std::string& room) {
  if (simulation().find(room)) return {};
  std::string names;
  for (const auto& known : simulation().rooms()) names += (names.empty() ? "" : ", ") + known->name();
  return core::Error{core::ErrorCode::kInvalidInput, "room '" + room + "' does not exist; rooms are: " + names};
}

void Gateway::sessionOpened(net::SessionId session, const std::string& room_name, const std::string& peer) {
  const std::shared_ptr<rooms::Room> room = simulation().find(room_name);
  if (!room) return refuse(session, net::CloseCode::kRoomClosed, "the room was closed");
  const auto now = std::chrono::steady_clock::now();
  {
    const std::lock_guard lock(mutex_);
    sessions_.emplace(session, SessionState{.room = room,
                                            .greeted = nullptr,
                                            .commands = {options_.commands_per_s, options_.command_burst_count, now}});
  }
  spdlog::info("session {} from {} joins room {}", session, peer, room->name());
  greet(session, *room);
  hub().closeAt(session, now + options_.hello_patience, net::CloseCode::kPolicy,
                "no hello came in time: send ClientMessage.hello first");
  // The room may have closed meanwhile, and dismiss() may have run before this session was in its list.
  if (simulation().find(room->name()) != room) refuse(session, net::CloseCode::kRoomClosed, "the room was closed");
}

void Gateway::greet(net::SessionId session, const rooms::Room& room) {
  const auto snapshot = room.snapshot();
  wire::GreetingFacts facts;
  facts.server = core::nameAndVersion();
  facts.device = simulation().deviceLine();
  facts.room = room.name();
  facts.session_id = session;
  facts.layers = layersOf(snapshot->scene);
  facts.message_max_bytes = static_cast<std::uint32_t>(options_.message_max_bytes);
  facts.commands_per_s = options_.commands_per_s;
  facts.command_burst_count = options_.command_burst_count;
  facts.messages_per_s = options_.messages_per_s;
  facts.message_burst_count = options_.message_burst_count;
  facts.hello_within_s = std::chrono::duration<double>(options_.hello_patience).count();
  facts.frame_rate_max_hz = kFrameRateMax_hz;
  facts.server_time_s = core::monotonic_s();
  facts.paused = snapshot->paused;
  facts.speed = snapshot->speed;
  facts.boats = snapshot->boats;
  facts.scenes = simulation().rules().scenes.names();
  hub().sendState(session, topic::kGreeting, wire::greeting(facts, snapshot->scene));
  const std::lock_guard lock(mutex_);
  if (const auto known = sessions_.find(session); known != sessions_.end()) known->second.greeted = snapshot;
}

void Gateway::sceneChanged(const rooms::Room& room) {
  std::vector<net::SessionId> members;
  std::vector<std::pair<net::SessionId, std::string>> outdated;
  const auto snapshot = room.snapshot();
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [session, state] : sessions_) {
      if (state.room.get() != &room) continue;
      auto why = state.said_hello ? wire::checkWater(state.wire_minor, snapshot->scene) : std::nullopt;
      if (why)
        outdated.emplace_back(session, *std::move(why));
      else
        members.push_back(session);
    }
  }
  for (const net::SessionId session : members) greet(session, room);
  for (const auto& [session, why] : outdated) refuse(session, net::CloseCode::kPolicy, why);
}

void Gateway::dismiss(const rooms::Room& room) {
  std::vector<net::SessionId> members;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [session, state] : sessions_) {
      if (state.room.get() == &room) members.push_back(session);
    }
  }
  for (const net::SessionId session : members) refuse(session, net::CloseCode::kRoomClosed, "the room was closed");
}

void Gateway::drain(const v1::Draining& draining) {
  rest_.drain();
  const core::SharedBytes message = wire::draining(draining);
  const std::lock_guard lock(mutex_);
  for (const auto& [session, state] : sessions_) {
    if (state.said_hello && state.wire_minor >= wire::kDrainingMinor)
      hub().sendState(session, topic::kDraining, message);
  }
}

void Gateway::refuse(net::SessionId session, net::CloseCode code, const std::string& why) {
  constexpr std::size_t kReasonMaxBytes = 120;
  hub().sendAnswer(session, wire::refusal(why));
  hub().close(session, code, why.substr(0, kReasonMaxBytes));
}

void Gateway::sessionMessage(net::SessionId session, core::ByteView message) {
  std::optional<SessionState> known;
  {
    const std::lock_guard lock(mutex_);
    const auto it = sessions_.find(session);
    if (it == sessions_.end()) return;
    known = it->second;
  }
  const SessionState& state = *known;
  std::visit(core::Overloaded{
                 [&](const wire::Hello& said) { hello(session, state, said); },
                 [&](const wire::Subscribe& asked) { subscribe(session, state, asked); },
                 [&](v1::Command&& parsed) { command(session, state, std::move(parsed)); },
                 [&](const wire::Ping& ping) {
                   hub().sendAnswer(session, wire::pong(ping.client_time_s, core::monotonic_s()));
                 },
                 [&](const wire::CommandRejection& rejection) {
                   counters_.rejected(rejection.reason);
                   hub().sendAnswer(session, wire::reject(rejection));
                 },
                 [&](const wire::Malformed& malformed) { refuse(session, net::CloseCode::kPolicy, malformed.message); },
             },
             wire::parseClientMessage(message));
}

void Gateway::hello(net::SessionId session, const SessionState& state, const wire::Hello& hello) {
  if (auto why = wire::checkVersion(hello)) return refuse(session, net::CloseCode::kPolicy, *why);
  if (auto why = wire::checkWater(hello.minor, state.room->snapshot()->scene))
    return refuse(session, net::CloseCode::kPolicy, *why);
  if (state.said_hello) return refuse(session, net::CloseCode::kPolicy, "hello was said before: once is enough");
  const auto now = std::chrono::system_clock::now();
  const auto grant = options_.access.resolve(hello.token, now);
  if (!grant) return refuse(session, net::CloseCode::kUnauthorized, grant.error().message);
  auto end = std::chrono::steady_clock::time_point::max();  // replaces the deadline for Hello
  if (grant->expires) {
    const auto left = std::chrono::duration_cast<std::chrono::steady_clock::duration>(*grant->expires - now);
    end = std::chrono::steady_clock::now() + left;
  }
  hub().closeAt(session, end, net::CloseCode::kUnauthorized, "the token has expired: ask for a new one");
  const rooms::Admission admission = state.room->roster().arrive({.session = session,
                                                                  .role = grant->role,
                                                                  .name = hello.name,
                                                                  .color_rgb = hello.color_rgb,
                                                                  .resume_key = hello.resume_key});
  if (admission.displaced) {
    refuse(*admission.displaced, net::CloseCode::kResumedElsewhere, "another connection goes on in your place");
  }
  std::shared_ptr<const rooms::RoomSnapshot> greeted;
  {
    const std::lock_guard lock(mutex_);
    SessionState& kept = sessions_.at(session);
    greeted = kept.greeted;
    kept.said_hello = true;
    kept.wire_minor = hello.minor;
    kept.role = grant->role;
    kept.person_id = admission.person_id;
  }
  spdlog::info("session {} is person {} ({}), {} {}", session, admission.person_id, core::roleName(grant->role),
               hello.client, admission.resumed ? "resumed" : "");
  v1::Welcome welcome;
  welcome.set_role(wire::toWire(grant->role));
  welcome.set_person_id(admission.person_id);
  welcome.set_resume_key(admission.resume_key);
  welcome.set_grace_s(std::chrono::duration<double>(state.room->roster().grace()).count());
  welcome.set_resumed(admission.resumed);
  hub().sendAnswer(session, wire::welcome(welcome));
  // From here on the session gets the room's news, and the frames that it subscribes to. Send the changes since the
  // greeting.
  hub().join(session, state.room->name());
  if (const auto now_there = state.room->snapshot(); now_there != greeted) {
    if (auto why = wire::checkWater(hello.minor, now_there->scene))
      return refuse(session, net::CloseCode::kPolicy, *why);
    greet(session, *state.room);
  }
  hub().sendState(session, topic::kPeople, wire::people(state.room->roster().people()));
}

void Gateway::subscribe(net::SessionId session, const SessionState& state, const wire::Subscribe& subscribe) {
  if (!state.said_hello) {
    return refuse(session, net::CloseCode::kPolicy, "subscribe before hello: send ClientMessage.hello first");
  }
  // One packing at a time: a subscription to the other packing stops this one.
  const codec::Stream wanted = codec::streamOf(subscribe.layer, subscribe.packing);
  const bool has_levels = codec::hasLevels(subscribe.layer);
  for (const codec::Stream stream : codec::allStreams()) {
    if (stream.layer != wanted.layer) continue;
    const bool is_wanted = stream.packing == wanted.packing;
    hub().watch(session, streamIndex(stream),
                {.max_rate_hz = is_wanted ? std::min(subscribe.max_rate_hz, kFrameRateMax_hz) : 0.0,
                 .level = has_levels ? subscribe.level : core::Level::kFull,
                 .adapts = has_levels && subscribe.adapts});
  }
}

void Gateway::sessionLevelChanged(net::SessionId session, core::Level level) {
  spdlog::info("session {} now gets level {}", session, codec::nameOf(level));
  hub().sendState(session, topic::kLevel, wire::levelChanged(level));
}

void Gateway::command(net::SessionId session, const SessionState& state, v1::Command message) {
  const rooms::Command command{.sender = {.session_id = session, .person_id = state.person_id, .role = state.role},
                               .message = std::move(message)};
  if (!state.said_hello) {
    return commandRejected(command, {.command_id = command.id(),
                                     .reason = v1::REJECT_REASON_NO_HELLO,
                                     .field = "",
                                     .message = "say hello before the first command"});
  }
  if (!takeCommand(session)) {
    return commandRejected(command,
                           {.command_id = command.id(),
                            .reason = v1::REJECT_REASON_BUSY,
                            .field = "",
                            .message = fmt::format("more than {:g} commands a second after a burst of {:g}: slow down",
                                                   options_.commands_per_s, options_.command_burst_count)});
  }
  if (auto rejection = state.room->admit(command)) return commandRejected(command, *rejection);
}

bool Gateway::takeCommand(net::SessionId session) {
  const std::lock_guard lock(mutex_);
  const auto known = sessions_.find(session);
  return known != sessions_.end() && known->second.commands.take(std::chrono::steady_clock::now());
}

// Reports of rooms

void Gateway::timeChanged(const rooms::Room& room, bool paused, double speed) {
  hub().broadcastState(room.name(), topic::kRoomState, wire::roomState(paused, speed));
}

void Gateway::parameterChanged(const rooms::Room& room, const std::string& path, double value) {
  hub().broadcastState(room.name(), topic::ofParameter(path), wire::parameterChanged(path, value, room.tick()));
}

void Gateway::boatsChanged(const rooms::Room& room, const v1::BoatList& boats) {
  hub().broadcastState(room.name(), topic::kBoats, wire::boatList(boats));
}

void Gateway::peopleChanged(const rooms::Room& room, const v1::People& people) {
  hub().broadcastState(room.name(), topic::kPeople, wire::people(people));
}

void Gateway::wasReset(const rooms::Room& room) {
  hub().broadcastState(room.name(), topic::kReset,
                       wire::roomEvent(v1::ROOM_EVENT_KIND_RESET, room.tick(), "somebody started the scene again"));
}

void Gateway::hasRecovered(const rooms::Room& room, const std::string& how) {
  hub().broadcastState(room.name(), topic::kRecovered,
                       wire::roomEvent(v1::ROOM_EVENT_KIND_RECOVERED, room.tick(), how));
}

void Gateway::fidelityChanged(const rooms::Room& room, const std::string& how) {
  hub().broadcastState(room.name(), topic::kFidelity, wire::roomEvent(v1::ROOM_EVENT_KIND_FIDELITY, room.tick(), how));
}

void Gateway::closed(const rooms::Room& room) {
  encoder_->forget(room.name());
}

void Gateway::frameReady(const rooms::Room& room, core::FrameView frame) {
  encoder_->submit(room.name(), std::move(frame));
}

rooms::WatchedLayers Gateway::watched(const rooms::Room& room, const core::ReducedCounts& counts) const {
  rooms::WatchedLayers out;
  for (const codec::Stream& stream : codec::allStreams()) {
    const auto of_levels = demand(room.name(), stream, codec::reducedCountOf(stream.layer, counts));
    const auto is_watched = [](const core::LevelDemand& level) { return level.watcher_count > 0; };
    const auto note = [&](bool sim::LayerRequest::*layer) {
      for (std::size_t k = 0; k < core::kLevelCount; ++k) out.levels[k].*layer |= is_watched(of_levels[k]);
    };
    switch (stream.layer) {
      case v1::LAYER_SURFACE:
        note(&sim::LayerRequest::surface);
        break;
      case v1::LAYER_PARTICLES:
        note(&sim::LayerRequest::particles);
        break;
      case v1::LAYER_FOAM:
        note(&sim::LayerRequest::foam);
        break;
      case v1::LAYER_BODIES:
        out.bodies |= is_watched(of_levels[core::indexOf(core::Level::kFull)]);
        break;
      case v1::LAYER_DIAGNOSTICS:
        out.diagnostics |= is_watched(of_levels[core::indexOf(core::Level::kFull)]);
        break;
      default:
        break;
    }
  }
  return out;
}

std::size_t Gateway::sessionCount(const rooms::Room& room) const {
  return hub().sessionCount(room.name());
}

std::size_t Gateway::sessionCount() const {
  return hub().sessionCount();
}

core::StreamDemand Gateway::demand(const std::string& room, codec::Stream stream, std::uint32_t reduced_count) const {
  return demandOf(hub(), room, stream, reduced_count);
}

void Gateway::publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                      core::Level level, std::uint32_t reduced_count) {
  publishTo(hub(), room, stream, frame, level, reduced_count);
}

void Gateway::commandApplied(const rooms::Command& command, std::uint64_t tick, std::uint32_t boat_id) {
  counters_.applied();
  if (command.sender.request_id != 0) return rest_.commandApplied(command, tick, boat_id);
  hub().sendAnswer(command.sender.session_id, wire::ack(command.id(), tick, boat_id));
}

void Gateway::commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) {
  counters_.rejected(rejection.reason);
  if (command.sender.request_id != 0) return rest_.commandRejected(command, rejection);
  hub().sendAnswer(command.sender.session_id, wire::reject(rejection));
}

void Gateway::sessionClosed(net::SessionId session, const net::SessionEnd& end) {
  std::shared_ptr<rooms::Room> room;
  {
    const std::lock_guard lock(mutex_);
    if (auto node = sessions_.extract(session)) room = std::move(node.mapped().room);
  }
  if (room) room->roster().leave(session, rooms::Roster::Clock::now());
  spdlog::info("session {} ended: {} {}", session, end.code, end.reason);
}

void Gateway::httpRequest(const net::HttpRequest& request, net::HttpResponder respond) {
  rest_.answer(request, std::move(respond));
}

}  // namespace spindrift::service
