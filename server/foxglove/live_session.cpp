#include <boost/json.hpp>

#include <spindrift/codec/frame_decoder.h>

#include "live_state.h"

namespace spindrift::foxglove {
namespace live {
namespace {

std::string lineOf(const v1::Reject& reject) {
  return reject.field().empty() ? reject.message() : reject.field() + ": " + reject.message();
}

}  // namespace

std::vector<Outgoing> LiveSession::send(core::ByteView message) {
  std::vector<Outgoing> out;
  if (message.size() > 2 && message.front() == kOwnMessage) {
    out.push_back({core::share(core::Bytes(message.begin() + 2, message.end())), message[1] != 0});
    return out;
  }
  const auto parsed = codec::parseServerMessage(message);
  if (!parsed) return out;  // of a kind that is newer than this file
  switch (parsed->message_case()) {
    case v1::ServerMessage::kGreeting:
      greet(parsed->greeting(), out);
      break;
    case v1::ServerMessage::kFrame: {
      const auto messages = converter_.convert(parsed->frame(), subscribed());
      if (messages)
        forward(*messages, out);
      else
        out.push_back(status(StatusLevel::kError, messages.error().message));
      break;
    }
    case v1::ServerMessage::kDiagnostics:
      forward(converter_.convert(parsed->diagnostics(), subscribed()), out);
      break;
    case v1::ServerMessage::kBoatList:
      converter_.take(parsed->boat_list());
      break;
    case v1::ServerMessage::kParameterChanged:
      change(parsed->parameter_changed(), out);
      break;
    case v1::ServerMessage::kAck:
      end(parsed->ack().command_id(), parsed->ack(), nullptr, out);
      break;
    case v1::ServerMessage::kReject:
      end(parsed->reject().command_id(), {}, &parsed->reject(), out);
      break;
    case v1::ServerMessage::kRefusal:
      out.push_back(status(StatusLevel::kError, parsed->refusal().message()));
      break;
    case v1::ServerMessage::kRoomEvent:
      if (parsed->room_event().kind() != v1::ROOM_EVENT_KIND_CLOCK) clock_ns_.reset();  // time may go back
      out.push_back(status(StatusLevel::kInfo, parsed->room_event().message()));
      break;
    case v1::ServerMessage::kLevelChanged:
      out.push_back(status(StatusLevel::kInfo, "frames come at the level of detail '" +
                                                   v1::Level_Name(parsed->level_changed().level()) +
                                                   "' because of what the connection can carry"));
      break;
    case v1::ServerMessage::kDraining:
      out.push_back(status(StatusLevel::kWarning, "the server is about to end"));
      break;
    default:
      break;
  }
  return out;
}

void LiveSession::greet(const v1::Greeting& greeting, std::vector<Outgoing>& out) {
  const TopicSet topics = topicsOf(greeting);
  if (!is_greeted_) out.push_back(serverInfo(greeting));
  if (const TopicSet lost = offered_ & ~topics; lost.any()) {
    out.push_back(unadvertise(lost));
    std::erase_if(subscriptions_, [&](const auto& entry) { return lost[static_cast<std::size_t>(entry.second)]; });
  }
  if (const TopicSet added = topics & ~offered_; added.any()) out.push_back(advertise(added));
  if (!is_greeted_) out.push_back(advertiseServices());
  is_greeted_ = true;
  offered_ = topics;
  converter_.take(greeting.boat_list());
  parameters_.clear();
  for (const v1::ParameterDescription& parameter : greeting.parameters())
    parameters_[parameter.path()] = parameter.value();
  std::erase_if(watched_parameters_, [&](const std::string& name) { return !parameters_.contains(name); });
  if (!watched_parameters_.empty()) out.push_back(parameterValues(valuesOf(watched_parameters_), std::nullopt));
  clock_ns_.reset();
}

void LiveSession::change(const v1::ParameterChanged& changed, std::vector<Outgoing>& out) {
  const auto known = parameters_.find(changed.path());
  if (known == parameters_.end()) return;
  known->second = changed.value();
  if (watched_parameters_.contains(changed.path()))
    out.push_back(parameterValues({{changed.path(), changed.value()}}, std::nullopt));
}

void LiveSession::forward(const std::vector<Message>& messages, std::vector<Outgoing>& out) {
  for (const Message& message : messages) {
    // Frames of different layers overtake each other, but the client's time does not go back for them.
    if (!clock_ns_ || message.time_ns > *clock_ns_) {
      clock_ns_ = message.time_ns;
      out.push_back(time(message.time_ns));
    }
    for (const auto& [id, topic] : subscriptions_)
      if (topic == message.topic) out.push_back(data(id, message));
  }
}

void LiveSession::end(std::uint64_t command_id, const v1::Ack& ack, const v1::Reject* rejection,
                      std::vector<Outgoing>& out) {
  const auto ended = commands_.extract(command_id);
  if (!ended) return;
  if (const Call* call = std::get_if<Call>(&ended.mapped())) {
    if (rejection) {
      out.push_back(serviceFailure(call->service_id, call->call_id, lineOf(*rejection)));
      out.push_back(status(StatusLevel::kError, lineOf(*rejection)));
    } else {
      const boost::json::object response{{"applied_tick", ack.applied_tick()}};
      out.push_back(serviceResponse(call->service_id, call->call_id, boost::json::serialize(response)));
    }
    return;
  }
  const auto change = changes_.find(std::get<std::uint64_t>(ended.mapped()));
  if (rejection) out.push_back(status(StatusLevel::kError, lineOf(*rejection)));
  if (change == changes_.end() || --change->second.left_count > 0) return;
  if (change->second.id) out.push_back(parameterValues(valuesOf(change->second.names), change->second.id));
  changes_.erase(change);
}

}  // namespace live

std::unique_ptr<core::Translator> makeLiveSession(std::string token) {
  return std::make_unique<live::LiveSession>(std::move(token));
}

}  // namespace spindrift::foxglove
