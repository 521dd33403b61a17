#include "requests.h"

#include <memory>
#include <optional>
#include <utility>

#include <spindrift/core/room_name.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/api_message.h>
#include <spindrift/wire/client_message.h>

#include "messages.h"
#include "request_route.h"

namespace spindrift::cluster {
namespace {

using namespace std::chrono_literals;

/// Below the 30 s that a client's connection waits. Opening a room compiles its shaders.
constexpr auto kAnswerPatience = 25s;
constexpr auto kListPatience = 1s;

v1::Grant toMessage(const access::Grant& grant) {
  v1::Grant out;
  out.set_role(wire::toWire(grant.role));
  out.set_subject(grant.subject);
  out.set_is_person(grant.is_person);
  out.set_is_for_all_rooms(!grant.rooms);
  if (grant.rooms) out.mutable_rooms()->Assign(grant.rooms->begin(), grant.rooms->end());
  return out;
}

access::Grant fromMessage(const v1::Grant& grant) {
  access::Grant out{.role = wire::fromWire(grant.role()).value_or(core::Role::kViewer),
                    .subject = grant.subject(),
                    .is_person = grant.is_person()};
  if (!grant.is_for_all_rooms()) out.rooms.emplace(grant.rooms().begin(), grant.rooms().end());
  return out;
}

std::optional<net::HttpReply> toReply(const v1::HttpAnswer& answer) {
  if (answer.status() == 0) return std::nullopt;
  net::HttpReply out{.status = answer.status(), .content_type = answer.content_type(), .body = answer.body()};
  for (const auto& header : answer.headers()) out.headers.emplace_back(header.name(), header.value());
  return out;
}

}  // namespace

void Requests::send(const std::string& server, const net::HttpRequest& request, const Grant& grant,
                    std::chrono::milliseconds patience, Taken taken) {
  v1::HttpForward message;
  message.set_node(node_);
  message.set_method(request.method);
  message.set_path(request.path);
  message.set_query(request.query);
  message.set_body(request.body.data(), request.body.size());
  message.set_authorization(request.authorization);
  message.set_content_type(request.content_type);
  message.set_peer(request.peer);
  if (grant) *message.mutable_grant() = toMessage(*grant);
  {
    const std::lock_guard lock(mutex_);
    message.set_request(++last_request_);
    waiting_[last_request_] = {std::move(taken), Clock::now() + patience};
  }
  bus_.publish(subjects_.server(server), serialize(message));
}

void Requests::ask(const std::string& server, const net::HttpRequest& request, const Grant& grant,
                   net::HttpResponder respond) {
  send(server, request, grant, kAnswerPatience, [server, respond = std::move(respond)](const v1::HttpAnswer* answer) {
    if (answer) return respond(toReply(*answer));
    respond(problem(504, "server " + server + " of the cluster did not answer; what was asked for may still happen"));
  });
}

void Requests::askForRooms(const std::vector<std::string>& servers, const net::HttpRequest& request, const Grant& grant,
                           std::string own, const net::HttpResponder& respond) {
  struct Joined {
    std::mutex mutex;
    std::size_t missing_count;
    v1::RoomList list;
    std::optional<net::HttpReply> refusal;  ///< 401, …: the same from every server
    net::HttpResponder respond;
  };
  const auto joined = std::make_shared<Joined>();
  joined->missing_count = servers.size() + 1;
  joined->respond = respond;
  const auto add = [joined](const v1::HttpAnswer* answer) {
    std::unique_lock lock(joined->mutex);
    if (answer && answer->status() == 200) {
      if (const auto part = wire::parseRoomListJson(answer->body())) joined->list.MergeFrom(*part);
    } else if (answer && !joined->refusal) {
      joined->refusal = toReply(*answer);
    }
    if (--joined->missing_count > 0) return;
    lock.unlock();
    if (joined->refusal && joined->list.rooms().empty()) return joined->respond(joined->refusal);
    joined->respond(
        net::HttpReply{.status = 200, .content_type = "application/json", .body = wire::toJson(joined->list) + "\n"});
  };
  for (const std::string& server : servers) send(server, request, grant, kListPatience, add);
  if (own.empty()) return add(nullptr);
  v1::HttpAnswer here;
  here.set_status(200);
  here.set_body(std::move(own));
  add(&here);
}

void Requests::take(const v1::HttpAnswer& answer) {
  Taken taken;
  {
    const std::lock_guard lock(mutex_);
    if (auto node = waiting_.extract(answer.request())) taken = std::move(node.mapped().taken);
  }
  if (taken) taken(&answer);
}

void Requests::review(Clock::time_point now) {
  std::vector<Taken> late;
  {
    const std::lock_guard lock(mutex_);
    for (auto it = waiting_.begin(); it != waiting_.end();) {
      if (it->second.until > now) {
        ++it;
        continue;
      }
      late.push_back(std::move(it->second.taken));
      it = waiting_.erase(it);
    }
  }
  for (const Taken& taken : late) taken(nullptr);
}

std::optional<Requests::Grant> admit(service::AccessControl& access, const net::HttpRequest& request,
                                     const net::HttpResponder& respond) {
  auto grant = access.resolveForwarded(request.authorization, std::chrono::system_clock::now());
  if (grant) return *std::move(grant);
  access.audit().refused({.peer = request.peer}, grant.error().message);
  net::HttpReply refusal = problem(401, grant.error().message);
  refusal.headers.emplace_back("WWW-Authenticate", "Bearer");
  respond(std::move(refusal));
  return std::nullopt;
}

void answerForward(bus::Bus& bus, const Subjects& subjects, const v1::HttpForward& forward,
                   const Node::Answer& answer) {
  if (!core::isRoomName(forward.node())) return;  // no node has that name, and it is part of a subject
  const std::string& body = forward.body();
  const net::HttpRequest request{.method = forward.method(),
                                 .path = forward.path(),
                                 .query = forward.query(),
                                 .body = {reinterpret_cast<const std::uint8_t*>(body.data()), body.size()},
                                 .authorization = forward.authorization(),
                                 .content_type = forward.content_type(),
                                 .peer = forward.peer()};
  const auto respond = [&bus, subject = subjects.node(forward.node()),
                        number = forward.request()](std::optional<net::HttpReply> reply) {
    v1::ToNode message;
    v1::HttpAnswer& out = *message.mutable_http_answer();
    out.set_request(number);
    if (reply) {
      out.set_status(reply->status);
      out.set_content_type(reply->content_type);
      out.set_body(reply->body);
      for (const auto& [name, value] : reply->headers) {
        auto& header = *out.add_headers();
        header.set_name(name);
        header.set_value(value);
      }
    }
    bus.publish(subject, serialize(message));
  };
  answer(request, respond, forward.has_grant() ? std::optional(fromMessage(forward.grant())) : std::nullopt);
}

}  // namespace spindrift::cluster
