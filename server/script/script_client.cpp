#include "script_client.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <spindrift/client/join.h>
#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>

namespace spindrift::script {

ScriptClient::ScriptClient(const v1::ScriptClient& setup, net::ClientPool& pool, const net::ClientUrl& url,
                           ListenerSetup listener)
    : setup_(setup), pool_(pool), listener_(std::move(listener)), url_(url.inRoom(setup.room())) {
  if (listener_.message) url_.path += "?onlooker";
  for (const v1::Subscribe& wanted : setup_.subscribe()) subscriptions_[wanted.layer()] = wanted;
}

void ScriptClient::connect() {
  const std::uint64_t number = ++connection_number_;
  welcome_.reset();
  end_.reset();
  last_end_.reset();
  refusal_.clear();
  const auto if_current = [this, number](auto action) {
    return [this, number, action](auto&&... values) {
      if (number == connection_number_) action(values...);
    };
  };
  connection_ = pool_.connect(
      url_, {},
      {.opened = if_current([this] {
         const char* token = setup_.token_env().empty() ? nullptr : std::getenv(setup_.token_env().c_str());
         send(client::hello({.program = listener_.message ? listener_.program : "spindrift script",
                             .name = setup_.person(),
                             .token = token == nullptr ? "" : token,
                             .resume_key = resume_key_}));
         for (const auto& [layer, wanted] : std::exchange(subscriptions_, {})) subscribe(wanted);
       }),
       .message = if_current([this](core::ByteView bytes) { take(bytes); }),
       .closed = if_current([this](std::uint16_t code, const std::string& reason) {
         ended({code, refusal_.empty() ? reason : refusal_});
       })});
}

void ScriptClient::ended(const End& end) {
  constexpr std::chrono::milliseconds kPause{500};
  last_end_ = end;
  welcome_.reset();
  const auto now = Clock::now();
  if (!move_ || now >= move_->gives_up) {
    move_.reset();
    end_ = end;
  } else if (move_->next == Clock::time_point::max()) {  // an attempt failed
    move_->next = now + kPause;
  }
}

void ScriptClient::planMove(const v1::Draining& draining) {
  constexpr std::chrono::seconds kPatience{30};
  auto planned = client::planMove(draining, url_);
  if (!planned) {
    ++received.malformed_count;
    return;
  }
  move_ = Move{.url = std::move(planned->url), .next = planned->at, .gives_up = planned->at + kPatience};
}

void ScriptClient::followDraining() {
  if (!move_ || Clock::now() < move_->next) return;
  if (isWelcome()) connection_->close();
  url_ = move_->url;
  move_->next = Clock::time_point::max();  // until this attempt has failed
  connect();
}

void ScriptClient::disconnect(bool vanish) {
  if (!connection_) return;
  if (move_ && !isWelcome()) end_ = last_end_;
  move_.reset();
  vanish ? connection_->vanish() : connection_->close();
}

void ScriptClient::send(const v1::ClientMessage& message) {
  if (connection_) (void)connection_->send(codec::serialized(message));
}

void ScriptClient::subscribe(const v1::Subscribe& wanted) {
  subscriptions_[wanted.layer()] = wanted;
  LayerTally& tally = received.tallies[wanted.layer()];
  tally.last = wanted.max_rate_hz() > 0 ? std::optional(Clock::now()) : std::nullopt;
  v1::ClientMessage message;
  *message.mutable_subscribe() = wanted;
  send(message);
}

void ScriptClient::needLayer(v1::Layer layer) {
  constexpr double kRate_hz = 60.0;
  const auto known = subscriptions_.find(layer);
  if (known != subscriptions_.end() && known->second.max_rate_hz() > 0 &&
      known->second.packing() == v1::PACKING_PLAIN) {
    return;
  }
  v1::Subscribe wanted;
  wanted.set_layer(layer);
  wanted.set_max_rate_hz(kRate_hz);
  subscribe(wanted);
}

std::uint64_t ScriptClient::command(v1::Command command) {
  const std::uint64_t id = ++last_command_id_;
  command.set_command_id(id);
  sent_at_[id] = Clock::now();
  v1::ClientMessage message;
  *message.mutable_command() = std::move(command);
  send(message);
  return id;
}

void ScriptClient::take(core::ByteView bytes) {
  received.byte_count += bytes.size();
  if (listener_.message) listener_.message(bytes);
  auto parsed = codec::parseServerMessage(bytes);
  if (!parsed) {
    ++received.malformed_count;
    return;
  }
  const auto answered = [&](std::uint64_t id) {
    if (const auto sent = sent_at_.extract(id)) received.answer_times_ms.push_back(1e3 * since_s(sent.mapped()));
    received.answers[id] = *std::move(parsed);
  };
  switch (parsed->message_case()) {
    case v1::ServerMessage::kFrame: {
      v1::LayerFrame& newest = *parsed->mutable_frame();
      if (!v1::Layer_IsValid(newest.layer())) return;
      frame(newest.layer(), newest.state_id(), newest.tick());
      received.newest[newest.layer()] = std::move(newest);
      return;
    }
    case v1::ServerMessage::kDiagnostics:
      received.diagnostics = std::move(*parsed->mutable_diagnostics());
      return frame(v1::LAYER_DIAGNOSTICS, received.diagnostics.state_id(), received.diagnostics.tick());
    case v1::ServerMessage::kAck:
      return answered(parsed->ack().command_id());
    case v1::ServerMessage::kReject:
      return answered(parsed->reject().command_id());
    case v1::ServerMessage::kGreeting:
      if (parsed->greeting().scene().tick_rate_hz() > 0)
        received.tick_rate_hz = parsed->greeting().scene().tick_rate_hz();
      return;
    case v1::ServerMessage::kWelcome:
      welcome_ = parsed->welcome();
      resume_key_ = welcome_->resume_key();
      move_.reset();
      return;
    case v1::ServerMessage::kPeople:
      received.people = std::move(*parsed->mutable_people());
      return;
    case v1::ServerMessage::kRoomEvent:
      ++received.event_counts[parsed->room_event().kind()];
      return;
    case v1::ServerMessage::kDraining:
      return planMove(parsed->draining());
    case v1::ServerMessage::kRefusal:
      refusal_ = parsed->refusal().message();
      return;
    default:
      return;
  }
}

void ScriptClient::frame(v1::Layer layer, std::uint64_t state_id, std::uint64_t tick) {
  LayerTally& tally = received.tallies[layer];
  ++tally.frame_count;
  // A server that does not number its states sends 0: then each frame counts.
  if (state_id == 0 || state_id != tally.state_id) ++tally.state_count;
  tally.state_id = state_id;
  tally.tick = tick;
  if (tally.last) {
    const double gap_s = since_s(*tally.last);
    tally.longest_gap_s = std::max(tally.longest_gap_s, gap_s);
    tally.longest_gap_ever_s = std::max(tally.longest_gap_ever_s, gap_s);
  }
  tally.last = Clock::now();
}

double ScriptClient::takeLongestGap_s(v1::Layer layer) {
  LayerTally& tally = received.tallies[layer];
  const double open_s = tally.last ? since_s(*tally.last) : 0.0;
  return std::max(std::exchange(tally.longest_gap_s, 0.0), open_s);
}

}  // namespace spindrift::script
