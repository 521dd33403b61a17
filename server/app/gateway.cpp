#include "gateway.h"

#include <chrono>

#include <boost/json.hpp>
#include <spdlog/spdlog.h>

#include <spindrift/stream/client_message.h>
#include <spindrift/stream/server_message.h>

namespace spindrift::app {
namespace {

constexpr double kFrameRateMax_hz = 60.0;

double monotonic_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<v1::Layer> layersOf(const v1::Scene& scene) {
  std::vector<v1::Layer> layers;
  if (scene.has_wave()) layers.push_back(v1::LAYER_SURFACE);
  if (scene.has_particles()) layers.push_back(v1::LAYER_PARTICLES);
  if (scene.has_boats()) layers.push_back(v1::LAYER_BODIES);
  if (scene.foam().surface()) layers.push_back(v1::LAYER_FOAM);
  layers.push_back(v1::LAYER_DIAGNOSTICS);
  return layers;
}

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace

Gateway::Gateway(const SimulationThread& rooms, std::size_t message_max_bytes, double messages_per_s)
    : rooms_(rooms), message_max_bytes_(message_max_bytes), messages_per_s_(messages_per_s) {}

core::Result<void> Gateway::acceptSession(const std::string& room) {
  if (rooms_.find(room)) return {};
  std::string names;
  for (const auto& known : rooms_.rooms()) names += (names.empty() ? "" : ", ") + known->name();
  return core::Error{core::ErrorCode::kInvalidInput, "room '" + room + "' does not exist; rooms are: " + names};
}

void Gateway::sessionOpened(net::SessionId session, const std::string& room_name, const std::string& peer) {
  Room* room = rooms_.find(room_name);
  {
    const std::lock_guard lock(mutex_);
    sessions_[session] = {.room = room};
  }
  spdlog::info("session {} from {} joins room {}", session, peer, room->name());
  // The greeting comes first; a change that fell between it and joining makes a second one.
  const auto greeted = greet(session, *room);
  hub().join(session, room->name());
  if (room->snapshot() != greeted) greet(session, *room);
}

std::shared_ptr<const RoomSnapshot> Gateway::greet(net::SessionId session, const Room& room) {
  const auto snapshot = room.snapshot();
  stream::GreetingFacts facts;
  facts.server = "spindrift " SPINDRIFT_VERSION;
  facts.device = rooms_.deviceLine();
  facts.room = room.name();
  facts.session_id = session;
  facts.layers = layersOf(snapshot->scene);
  facts.message_max_bytes = static_cast<std::uint32_t>(message_max_bytes_);
  facts.commands_per_s = messages_per_s_;
  facts.frame_rate_max_hz = kFrameRateMax_hz;
  facts.server_time_s = monotonic_s();
  facts.paused = snapshot->paused;
  facts.speed = snapshot->speed;
  facts.boats = snapshot->boats;
  facts.scenes = rooms_.scenes().names();
  hub().sendControl(session, stream::greeting(facts, snapshot->scene));
  return snapshot;
}

void Gateway::sceneChanged(const Room& room) {
  std::vector<net::SessionId> members;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [session, state] : sessions_) {
      if (state.room == &room) members.push_back(session);
    }
  }
  for (const net::SessionId session : members) greet(session, room);
}

void Gateway::sessionMessage(net::SessionId session, core::ByteView message) {
  Session state;
  {
    const std::lock_guard lock(mutex_);
    const auto it = sessions_.find(session);
    if (it == sessions_.end()) return;
    state = it->second;
  }
  const auto refuse = [&](const std::string& why) {
    hub().sendControl(session, stream::refusal(why));
    hub().close(session, net::CloseCode::kPolicy, why.substr(0, 120));
  };
  std::visit(
      Overloaded{
          [&](const stream::Hello& hello) {
            if (auto why = stream::checkVersion(hello)) return refuse(*why);
            spdlog::debug("session {} is {}", session, hello.client);
            const std::lock_guard lock(mutex_);
            sessions_[session].said_hello = true;
          },
          [&](const stream::Subscribe& subscribe) {
            if (!state.said_hello) return refuse("subscribe before hello: send ClientMessage.hello first");
            // One packing at a time: asking for the other one stops this one.
            const stream::Stream wanted = stream::streamOf(subscribe.layer, subscribe.packing);
            for (const stream::Stream stream : stream::allStreams()) {
              if (stream.layer != wanted.layer) continue;
              const bool is_wanted = stream.packing == wanted.packing;
              hub().watch(session, static_cast<net::LayerIndex>(stream::indexOf(stream)),
                          is_wanted ? std::min(subscribe.max_rate_hz, kFrameRateMax_hz) : 0.0);
            }
          },
          [&](const core::Command& parsed) {
            core::Command command = parsed;
            command.session_id = session;
            if (!state.said_hello) {
              hub().sendControl(session, stream::reject(command.command_id, v1::REJECT_REASON_NO_HELLO, "",
                                                        "say hello before the first command"));
              return;
            }
            if (auto rejection = stream::checkAgainstScene(command, state.room->snapshot()->scene)) {
              rejection->command_id = command.command_id;
              hub().sendControl(session, stream::reject(*rejection));
              return;
            }
            const auto id = command.command_id;
            if (!state.room->submit(std::move(command))) {
              hub().sendControl(session, stream::reject(id, v1::REJECT_REASON_BUSY, "",
                                                        "the room's command queue is full: try again"));
            }
          },
          [&](const stream::Ping& ping) {
            hub().sendControl(session, stream::pong(ping.client_time_s, monotonic_s()));
          },
          [&](const stream::CommandRejection& rejection) { hub().sendControl(session, stream::reject(rejection)); },
          [&](const stream::Malformed& malformed) { refuse(malformed.message); },
      },
      stream::parseClientMessage(message));
}

void Gateway::sessionClosed(net::SessionId session, const net::SessionEnd& end) {
  {
    const std::lock_guard lock(mutex_);
    sessions_.erase(session);
  }
  spdlog::info("session {} ended: {} {}", session, end.code, end.reason);
}

std::optional<net::HttpReply> Gateway::httpRequest(const net::HttpRequest& request) {
  if (request.path == "/healthz" || request.path == "/readyz")
    return net::HttpReply{.status = 200, .content_type = "text/plain", .body = "ok\n"};
  if (request.path == "/api/v1/rooms" && request.method == "GET") {
    boost::json::array rooms;
    for (const auto& room : rooms_.rooms()) {
      const auto snapshot = room->snapshot();
      rooms.push_back(boost::json::object{{"name", room->name()},
                                          {"scene", snapshot->scene.name()},
                                          {"title", snapshot->scene.title()},
                                          {"paused", snapshot->paused},
                                          {"speed", snapshot->speed}});
    }
    return net::HttpReply{
        .status = 200, .content_type = "application/json", .body = boost::json::serialize(rooms) + "\n"};
  }
  return std::nullopt;
}

}  // namespace spindrift::app
