#include <algorithm>
#include <string_view>
#include <utility>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/room_name.h>
#include <spindrift/core/text.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/service/rest_api.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/api_message.h>

#include "rest_replies.h"

namespace spindrift::service {
namespace {

using core::ErrorCode;
using net::HttpReply;

constexpr std::string_view kRoot = "/api/v1/";

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> out;
  while (!path.empty()) {
    const std::size_t slash = path.find('/');
    out.emplace_back(path.substr(0, slash));
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return out;
}

}  // namespace

unsigned httpStatusOf(v1::RejectReason reason) {
  switch (reason) {
    case v1::REJECT_REASON_MALFORMED:
      return 400;
    case v1::REJECT_REASON_FORBIDDEN:
    case v1::REJECT_REASON_NOT_YOURS:
      return 403;
    case v1::REJECT_REASON_UNKNOWN_BOAT:
    case v1::REJECT_REASON_UNKNOWN_FLOATER:
    case v1::REJECT_REASON_UNKNOWN_GAUGE:
    case v1::REJECT_REASON_UNKNOWN_PERSON:
    case v1::REJECT_REASON_UNKNOWN_SCENE:
    case v1::REJECT_REASON_UNKNOWN_PARAMETER:
      return 404;
    case v1::REJECT_REASON_NOT_NOW:
    case v1::REJECT_REASON_CLOCK_HELD:
      return 409;
    case v1::REJECT_REASON_BUSY:
      return 503;
    default:
      return 422;
  }
}

RestApi::RestApi(AccessControl& access, CommandCounters& counters, const MetricsSources& sources,
                 Recordings& recordings, std::function<void(const rooms::Room&)> dismiss,
                 std::function<void()> on_drain)
    : access_(access),
      counters_(counters),
      sources_(sources),
      recordings_(recordings),
      dismiss_(std::move(dismiss)),
      on_drain_(std::move(on_drain)) {}

void RestApi::answer(const net::HttpRequest& request, net::HttpResponder respond,
                     const std::optional<access::Grant>& decided) {
  /// Far longer than any tick that a room allows while people are connected.
  constexpr double kStuck_s = 5.0;
  const bool is_probe = request.path == "/healthz" || request.path == "/readyz" || request.path == "/metrics";
  if (is_probe && request.method != "GET") return respond(wrongMethod("GET"));
  if (request.path == "/healthz") return respond(text(200, "ok\n"));
  if (request.path == "/readyz") {
    if (is_draining_) return respond(text(503, "draining\n"));
    const double since_s = rooms_->sinceLastRound_s();
    if (since_s >= kStuck_s)
      return respond(text(503, "the simulation has stood still for " + std::to_string(since_s) + " s\n"));
    for (const auto& room : rooms_->rooms()) {
      if (room->vitals()->lost)
        return respond(text(503, "room " + room->name() + ": the device failed, its water is being built again\n"));
    }
    return respond(text(200, "ready\n"));
  }
  if (request.path == "/metrics") {
    return respond(HttpReply{.status = 200,
                             .content_type = "text/plain; version=0.0.4; charset=utf-8",
                             .body = metricsText(*rooms_, counters_, access_, sources_) +
                                     (cluster_.metrics ? cluster_.metrics() : std::string())});
  }
  if (!request.path.starts_with(kRoot)) return respond(std::nullopt);

  const auto grant = decided ? core::Result<access::Grant>(*decided) : resolve(request.authorization);
  if (!grant) {
    access_.audit().refused({.peer = request.peer}, grant.error().message);
    return respond(unauthorized(grant.error().message));
  }
  const Call call{request, split(std::string_view(request.path).substr(kRoot.size())), *grant};
  if (call.path.empty()) return respond(std::nullopt);
  if (call.path[0] == "scenes" && call.path.size() == 1) {
    if (request.method != "GET") return respond(wrongMethod("GET"));
    v1::SceneList out;
    for (const std::string& name : rooms_->rules().scenes.names()) out.add_scenes(name);
    return respond(json(200, out));
  }
  if (call.path[0] == "join" && call.path.size() == 1) {
    if (request.method != "GET") return respond(wrongMethod("GET"));
    v1::JoinInfo out;
    if (pad_urls_) {
      for (std::string& url : pad_urls_()) out.add_urls(std::move(url));
    }
    return respond(json(200, out));
  }
  if (call.path[0] == "drain" && call.path.size() == 1) return drainServer(call, respond);
  if (call.path[0] != "rooms") return respond(std::nullopt);
  if (call.path.size() == 1) return rooms(call, std::move(respond));
  room(call, std::move(respond));
}

core::Result<access::Grant> RestApi::resolve(const std::string& authorization) const {
  const auto token = access::Access::bearerToken(authorization);
  if (!token) return token.error();
  std::vector<RoomTokens> of_rooms;
  for (const auto& room : rooms_->rooms()) of_rooms.push_back({room->name(), room->access()});
  return access_.resolve(*token, of_rooms, std::chrono::system_clock::now());
}

void RestApi::room(const Call& call, net::HttpResponder respond) {
  if (!call.grant.allows(call.path[1]) && core::isRoomName(call.path[1]))
    return respond(problem(403, access::otherRoom(call.path[1])));
  const auto room = rooms_->find(call.path[1]);
  if (!room || call.path[1].empty()) {
    // Repeat only a valid room name: any other could contain arbitrary bytes.
    const std::string named =
        core::isRoomName(call.path[1]) ? "there is no room '" + call.path[1] + "'" : "there is no such room";
    return respond(problem(404, named + "; /api/v1/rooms lists what there is"));
  }
  const std::string& method = call.request.method;
  if (call.path.size() == 2) {
    if (method == "DELETE") return closeRoom(call, std::move(respond));
    if (method != "GET") return respond(wrongMethod("GET, DELETE"));
    v1::RoomInfo out;
    fillRoomInfo(*room, out);
    return respond(json(200, out));
  }
  room->use();
  if (call.path[2] == "surface" && call.path.size() == 3) return surface(call, room, std::move(respond));
  if (call.path[2] == "state_hash" && call.path.size() == 3) return stateHash(call, *room, respond);
  if (call.path[2] == "gauges") return gauges(call, *room, respond);
  if (call.path.size() != 3) return respond(std::nullopt);
  const std::string& part = call.path[2];
  if (part == "commands") {
    if (method != "POST") return respond(wrongMethod("POST"));
    return command(call, room, std::move(respond));
  }
  if (part == "snapshot") {
    if (method != "POST") return respond(wrongMethod("POST"));
    return snapshot(call, *room, respond);
  }
  if (part == "recording") return recording(call, room, std::move(respond));
  if (part != "scene" && part != "parameters" && part != "changes" && part != "people" && part != "ground")
    return respond(std::nullopt);
  if (method != "GET") return respond(wrongMethod("GET"));
  if (part == "ground") {
    const auto ground = ground_.of(room);
    if (!ground) return respond(problem(404, "the scene has no wave, and so no ground"));
    return respond(HttpReply{.status = 200, .content_type = "application/x-protobuf", .body = *ground});
  }
  if (part == "scene") return respond(json(200, scene::forClients(room->snapshot()->scene)));
  if (part == "people") return respond(json(200, room->roster().people()));
  const auto snapshot = room->snapshot();
  v1::ParameterList out;
  if (part == "changes") {
    const auto file = rooms_->rules().scenes.load(snapshot->scene.name(), snapshot->scene.fidelity());
    if (!file) return respond(problem(404, "the scene's file: " + core::firstLine(file.error().message)));
    for (auto& changed : scene::changedParameters(*file, snapshot->scene)) *out.add_parameters() = std::move(changed);
  } else {
    for (auto& known : scene::describeParameters(snapshot->scene)) *out.add_parameters() = std::move(known);
  }
  respond(json(200, out));
}

void RestApi::snapshot(const Call& call, rooms::Room& room, const net::HttpResponder& respond) {
  if (!call.isOperator()) return respond(problem(403, "a snapshot takes the role of operator"));
  if (!call.request.body.empty()) return respond(bodyIsNotEmpty());
  const bool is_kept = room.askForSnapshot();
  access_.audit().request("snapshot_asked", call.details(room.name()), call.grant.role, "",
                          is_kept ? "" : "the server keeps no state on disk");
  if (!is_kept) return respond(problem(409, "the server keeps no state on disk: start it with --state-dir FOLDER"));
  respond(HttpReply{.status = 202, .content_type = "application/json", .body = "{}\n"});
}

void RestApi::stateHash(const Call& call, rooms::Room& room, const net::HttpResponder& respond) {
  if (call.request.method != "GET") return respond(wrongMethod("GET"));
  // The room stands still while its state is copied.
  if (!call.isOperator()) return respond(problem(403, "the hash of the state takes the role of operator"));
  room.askStateHash([respond](const core::Result<rooms::HashedState>& state) {
    if (!state) return respond(problem(503, state.error().message));
    v1::StateHash out;
    out.set_tick(state->tick);
    out.set_state_hash(state->hash);
    respond(json(200, out));
  });
}

void RestApi::gauges(const Call& call, const rooms::Room& room, const net::HttpResponder& respond) {
  if (call.path.size() > 4) return respond(std::nullopt);
  if (call.request.method != "GET") return respond(wrongMethod("GET"));
  if (call.path.size() == 3) {
    v1::GaugeList out;
    for (const core::DiagnosticsView::GaugeNow& gauge : room.vitals()->diagnostics.gauges)
      codec::writeGauge(gauge, *out.add_gauges());
    return respond(json(200, out));
  }
  const auto snapshot = room.snapshot();
  v1::GaugeSeries out;
  sim::GaugeHistory::Series series;
  const auto& of_scene = snapshot->scene.gauges();
  const auto gauge = std::ranges::find(of_scene, call.path[3], &v1::Gauge::name);
  const auto placed = std::ranges::find(snapshot->placed_gauges, call.path[3], &rooms::PlacedGauge::name);
  if (gauge != of_scene.end() && snapshot->gauges) {
    out.set_x_m(gauge->x_m());
    out.set_z_m(gauge->z_m());
    series = snapshot->gauges->series(static_cast<std::size_t>(gauge - of_scene.begin()));
  } else if (placed != snapshot->placed_gauges.end()) {
    out.set_x_m(placed->x_m);
    out.set_z_m(placed->z_m);
    series = placed->history->series(0);
  } else {
    return respond(problem(404, "the room has no such gauge; /api/v1/rooms/ROOM/gauges lists what there is"));
  }
  out.set_name(call.path[3]);
  for (std::size_t k = 0; k < series.time_s.size(); ++k) {
    out.add_time_s(series.time_s[k]);
    out.add_elevation_m(series.readings[k].elevation_m);
    out.add_velocity_x_mps(series.readings[k].velocity_x_mps);
    out.add_velocity_z_mps(series.readings[k].velocity_z_mps);
  }
  respond(json(200, out));
}

void RestApi::drainServer(const Call& call, const net::HttpResponder& respond) {
  if (call.request.method != "POST") return respond(wrongMethod("POST"));
  if (!call.isOperator() || call.grant.rooms)
    return respond(problem(403, "ending the server takes the role of operator in all rooms"));
  if (!on_drain_) return respond(problem(409, "this server is part of another program, which has to end it"));
  if (!call.request.body.empty()) return respond(bodyIsNotEmpty());
  access_.audit().request("drain_asked", call.details(""), call.grant.role, "", "");
  // Once: a client may repeat a request whose answer was lost, and a second signal would end the wait for the clients.
  if (!is_draining_.exchange(true)) on_drain_();
  respond(HttpReply{.status = 202, .content_type = "application/json", .body = "{}\n"});
}

void RestApi::command(const Call& call, const std::shared_ptr<rooms::Room>& room, net::HttpResponder respond) {
  // A form on a foreign page cannot send this content type (protection against cross-site requests).
  if (!isJson(call.request.content_type)) return respond(bodyIsNotJson());
  auto parsed = wire::parseCommandJson(bodyOf(call.request));
  if (parsed && std::holds_alternative<v1::Command>(*parsed) && std::get<v1::Command>(*parsed).has_query())
    return respond(
        problem(400, "query: this address answers with an Ack; POST the query to /api/v1/rooms/ROOM/surface"));
  submit(call, room, std::move(parsed), {.respond = std::move(respond)});
}

void RestApi::submit(const Call& call, const std::shared_ptr<rooms::Room>& room, ParsedCommand parsed,
                     Pending pending) {
  if (!parsed) {
    counters_.rejected(v1::REJECT_REASON_MALFORMED);
    return pending.respond(problem(400, parsed.error().message));
  }
  if (const auto* rejection = std::get_if<wire::CommandRejection>(&*parsed)) {
    counters_.rejected(rejection->reason());
    return pending.respond(rejected(*rejection));
  }
  rooms::Command command;
  command.sender.request_id = ++last_request_id_;
  command.sender.role = call.grant.role;
  command.sender.details = std::make_shared<const core::SenderDetails>(call.details(room->name()));
  command.message = std::get<v1::Command>(*std::move(parsed));
  {
    const std::lock_guard lock(mutex_);
    pending_[command.sender.request_id] = std::move(pending);
  }
  const auto rejection = access_.takeCommand(call.grant.is_person ? call.grant.subject : "")
                             ? room->admit(command)
                             : wire::rejection(v1::REJECT_REASON_BUSY, "", access_.busy(), command.id());
  if (rejection) commandRejected(command, *rejection);
}

RestApi::Pending RestApi::takePending(std::uint64_t request_id) {
  const std::lock_guard lock(mutex_);
  auto node = pending_.extract(request_id);
  return node ? std::move(node.mapped()) : Pending();
}

void RestApi::commandApplied(const rooms::Command& command, const v1::Ack& ack) {
  if (command.message.has_query()) return;  // queryAnswered() follows
  const auto respond = takePending(command.sender.request_id).respond;
  if (!respond) return;
  v1::CommandAnswer out;
  *out.mutable_ack() = ack;
  respond(json(200, out));
}

void RestApi::commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) {
  counters_.rejected(rejection.reason());
  access_.audit().rejected(command, rejection);
  if (const auto respond = takePending(command.sender.request_id).respond) respond(rejected(rejection));
}

}  // namespace spindrift::service
