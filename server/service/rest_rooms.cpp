// Requests that list, open and close rooms.
#include <utility>

#include <spindrift/core/room_name.h>
#include <spindrift/core/text.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/service/rest_api.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/api_message.h>

#include "rest_replies.h"

namespace spindrift::service {

using net::HttpReply;

void RestApi::rooms(const Call& call, net::HttpResponder respond) {
  if (call.request.method == "POST") return createRoom(call, std::move(respond));
  if (call.request.method != "GET") return respond(wrongMethod("GET, POST"));
  v1::RoomList out;
  for (const auto& room : rooms_->rooms()) {
    if (call.grant.allows(room->name())) fillRoomInfo(*room, *out.add_rooms());
  }
  respond(json(200, out));
}

void RestApi::createRoom(const Call& call, net::HttpResponder respond) {
  if (!call.isOperator()) return respond(problem(403, "opening a room takes the role of operator"));
  if (is_draining_) {
    HttpReply out = problem(503, "the server is about to end: it opens no more rooms");
    out.headers.emplace_back("Retry-After", "5");
    return respond(std::move(out));
  }
  if (!isJson(call.request.content_type)) return respond(bodyIsNotJson());
  const auto wanted = wire::parseCreateRoomJson(bodyOf(call.request));
  if (!wanted) return respond(problem(400, wanted.error().message));
  if (!core::isRoomName(wanted->name())) {
    return respond(problem(422, "name: a room's name has " + std::string(core::kRoomNameRule)));
  }
  if (!call.grant.allows(wanted->name())) return respond(problem(403, access::otherRoom(wanted->name())));
  auto tokens = makeTokens(*wanted);
  if (!tokens) return respond(problem(422, tokens.error().message));
  if (!rooms_->rules().scenes.has(wanted->scene())) {
    return respond(problem(404, "scene: there is no scene of that name; /api/v1/scenes lists all"));
  }
  if (!v1::Fidelity_IsValid(wanted->fidelity())) return respond(problem(422, "fidelity: no level of that number"));
  const auto fidelity =
      wanted->fidelity() == v1::FIDELITY_UNSPECIFIED ? std::nullopt : std::optional(wanted->fidelity());
  auto scene = rooms_->rules().scenes.load(wanted->scene(), fidelity);
  if (!scene) return respond(problem(500, "scene: " + core::firstLine(scene.error().message)));
  for (const v1::SetParameter& wish : wanted->parameters()) {
    if (const auto issue = scene::setParameter(*scene, wish.path(), wish.value()))
      return respond(problem(422, "parameters: " + issue->path + ": " + issue->message));
  }
  const auto done = [this, wanted = *wanted, who = call.details(wanted->name()), role = call.grant.role,
                     shown = std::move(tokens->shown),
                     respond = std::move(respond)](const core::Result<void>& opened) mutable {
    const std::string error = opened ? "" : core::firstLine(opened.error().message);
    access_.audit().request("room_opened", who, role, wire::toJson(wanted), error);
    if (!opened) return respond(problem(statusOf(opened.error()), error));
    v1::RoomInfo out;
    if (const auto room = rooms_->find(wanted.name())) fillRoomInfo(*room, out);
    out.mutable_tokens()->Swap(&shown);
    respond(json(201, out));
  };
  rooms::RoomSetup setup{.name = wanted->name(), .scene = *std::move(scene), .access = std::move(tokens->kept)};
  if (cluster_.cluster) return cluster_.cluster->openRoom(std::move(setup), done);
  rooms_->openRoom(std::move(setup), done);
}

void RestApi::closeRoom(const Call& call, net::HttpResponder respond) {
  if (!call.isOperator()) return respond(problem(403, "closing a room takes the role of operator"));
  const auto report = [this, who = call.details(call.path[1]), role = call.grant.role](const std::string& error) {
    access_.audit().request("room_closed", who, role, "", error);
  };
  rooms_->closeRoom(call.path[1], dismiss_, [report, respond = std::move(respond)](const core::Result<void>& closed) {
    report(closed ? "" : closed.error().message);
    if (!closed) return respond(problem(statusOf(closed.error()), closed.error().message));
    respond(HttpReply{.status = 204, .content_type = "application/json", .body = ""});
  });
}

void RestApi::fillRoomInfo(const rooms::Room& room, v1::RoomInfo& out) const {
  const auto snapshot = room.snapshot();
  const auto vitals = room.vitals();
  out.set_name(room.name());
  out.set_scene(snapshot->scene.name());
  out.set_title(snapshot->scene.title());
  out.set_paused(snapshot->paused);
  out.set_speed(snapshot->speed);
  out.set_asleep(vitals->asleep);
  out.set_tick(vitals->tick);
  out.set_time_s(vitals->time_s);
  out.set_real_time_factor(vitals->diagnostics.real_time_factor);
  out.set_session_count(static_cast<std::uint32_t>(room.demand()->sessionCount()));
  out.set_people_count(static_cast<std::uint32_t>(room.roster().presentCount()));
  out.set_boat_count(static_cast<std::uint32_t>(snapshot->boats.boats_size()));
  out.set_fidelity(snapshot->scene.fidelity());
}

}  // namespace spindrift::service
