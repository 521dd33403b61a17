// Requests that record a room.
#include <utility>

#include <spindrift/service/rest_api.h>
#include <spindrift/wire/api_message.h>

#include "rest_replies.h"

namespace spindrift::service {

void RestApi::recording(const Call& call, const std::shared_ptr<rooms::Room>& room, net::HttpResponder respond) {
  const std::string& method = call.request.method;
  if (method != "GET" && method != "POST" && method != "DELETE") return respond(wrongMethod("GET, POST, DELETE"));
  if (!call.isOperator()) return respond(problem(403, "recordings take the role of operator"));
  if (method == "GET") return respond(json(200, recordings_.list(room->name())));
  const auto report = [&](const char* event, std::string content, const std::string& error) {
    access_.audit().request(event, call.details(room->name()), call.grant.role, std::move(content), error);
  };
  if (method == "DELETE") {
    const bool is_ending = recordings_.stop(
        room->name(), [respond](const v1::RecordingList& recordings) { respond(json(200, recordings)); });
    report("recording_stopped", "", is_ending ? "" : "the room is not recorded");
    if (!is_ending) respond(problem(409, "the room is not recorded now; GET lists what was"));
    return;
  }
  if (!isJson(call.request.content_type)) return respond(bodyIsNotJson());
  const auto wanted = wire::parseStartRecordingJson(bodyOf(call.request));
  if (!wanted) return respond(problem(400, wanted.error().message));
  const auto started = recordings_.start(room, *wanted);
  report("recording_started", wire::toJson(*wanted), started ? "" : started.error().message);
  if (started) {
    if (rooms_->find(room->name()) != room) recordings_.roomClosed(room->name());  // before the recording was known
    return respond(json(201, recordings_.list(room->name())));
  }
  respond(problem(started.error().code == core::ErrorCode::kInvalidInput ? 422 : 409, started.error().message));
}

}  // namespace spindrift::service
