#include "script_client.h"

#include <cstdlib>
#include <utility>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::script {
namespace {

double since_s(ScriptClient::Clock::time_point begin) {
  return std::chrono::duration<double>(ScriptClient::Clock::now() - begin).count();
}

}  // namespace

ScriptClient::ScriptClient(const v1::ScriptClient& setup, net::ClientPool& pool, net::ClientUrl url)
    : setup_(setup), pool_(pool), url_([&] {
        if (!setup.room().empty()) url.path = "/ws/" + setup.room();
        if (url.path == "/") url.path = "/ws";
        return std::move(url);
      }()) {
  for (const v1::Subscribe& wanted : setup_.subscribe()) subscriptions_[wanted.layer()] = wanted;
}

void ScriptClient::connect() {
  const std::uint64_t number = ++connection_number_;
  welcome_.reset();
  end_.reset();
  refusal_.clear();
  const auto if_current = [this, number](auto action) {
    return [this, number, action](auto&&... values) {
      if (number == connection_number_) action(values...);
    };
  };
  connection_ = pool_.connect(
      url_, {},
      {.opened = if_current([this] {
         v1::ClientMessage message;
         v1::Hello& hello = *message.mutable_hello();
         hello.mutable_version()->set_major(wire::kWireMajor);
         hello.mutable_version()->set_minor(wire::kWireMinor);
         hello.set_client("spindrift script");
         hello.set_name(setup_.person());
         hello.set_resume_key(resume_key_);
         if (const char* token = setup_.token_env().empty() ? nullptr : std::getenv(setup_.token_env().c_str())) {
           hello.set_token(token);
         }
         send(message);
         for (const auto& [layer, wanted] : std::exchange(subscriptions_, {})) subscribe(wanted);
       }),
       .message = if_current([this](core::ByteView bytes) { take(bytes); }),
       .closed = if_current([this](std::uint16_t code, const std::string& reason) {
         end_ = End{code, refusal_.empty() ? reason : refusal_};
       })});
}

void ScriptClient::disconnect(bool vanish) {
  if (!connection_) return;
  vanish ? connection_->vanish() : connection_->close();
}

void ScriptClient::send(const v1::ClientMessage& message) {
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  if (connection_) (void)connection_->send(core::share(std::move(bytes)));
}

void ScriptClient::subscribe(const v1::Subscribe& wanted) {
  subscriptions_[wanted.layer()] = wanted;
  LayerTally& tally = tallies_[static_cast<std::size_t>(wanted.layer())];
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
  received_bytes_ += bytes.size();
  auto parsed = codec::parseServerMessage(bytes);
  if (!parsed) {
    ++malformed_count_;
    return;
  }
  const auto answered = [&](std::uint64_t id, Answer answer) {
    if (const auto sent = sent_at_.extract(id)) answer_times_ms_.push_back(1e3 * since_s(sent.mapped()));
    answers_[id] = std::move(answer);
  };
  switch (parsed->message_case()) {
    case v1::ServerMessage::kFrame: {
      v1::LayerFrame& received = *parsed->mutable_frame();
      if (!v1::Layer_IsValid(received.layer())) return;
      frame(received.layer(), received.state_id());
      newest_[static_cast<std::size_t>(received.layer())] = std::move(received);
      return;
    }
    case v1::ServerMessage::kDiagnostics:
      diagnostics_ = std::move(*parsed->mutable_diagnostics());
      return frame(v1::LAYER_DIAGNOSTICS, diagnostics_->state_id());
    case v1::ServerMessage::kAck:
      return answered(parsed->ack().command_id(), {.ack = parsed->ack(), .reject = {}});
    case v1::ServerMessage::kReject:
      return answered(parsed->reject().command_id(), {.ack = {}, .reject = parsed->reject()});
    case v1::ServerMessage::kWelcome:
      welcome_ = parsed->welcome();
      resume_key_ = welcome_->resume_key();
      return;
    case v1::ServerMessage::kPeople:
      people_ = std::move(*parsed->mutable_people());
      return;
    case v1::ServerMessage::kRoomEvent:
      ++events_[parsed->room_event().kind()];
      return;
    case v1::ServerMessage::kRefusal:
      refusal_ = parsed->refusal().message();
      return;
    default:
      return;
  }
}

void ScriptClient::frame(v1::Layer layer, std::uint64_t state_id) {
  LayerTally& tally = tallies_[static_cast<std::size_t>(layer)];
  ++tally.frame_count;
  // A server that does not number its states sends 0: then each frame counts.
  if (state_id == 0 || state_id != tally.state_id) ++tally.state_count;
  tally.state_id = state_id;
  if (tally.last) {
    const double gap_s = since_s(*tally.last);
    tally.longest_gap_s = std::max(tally.longest_gap_s, gap_s);
    tally.longest_gap_ever_s = std::max(tally.longest_gap_ever_s, gap_s);
  }
  tally.last = Clock::now();
}

double ScriptClient::takeLongestGap_s(v1::Layer layer) {
  LayerTally& tally = tallies_[static_cast<std::size_t>(layer)];
  const double open_s = tally.last ? since_s(*tally.last) : 0.0;
  return std::max(std::exchange(tally.longest_gap_s, 0.0), open_s);
}

const ScriptClient::Answer* ScriptClient::answerTo(std::uint64_t command_id) const {
  const auto found = answers_.find(command_id);
  return found == answers_.end() ? nullptr : &found->second;
}

const v1::LayerFrame* ScriptClient::newest(v1::Layer layer) const {
  const auto& frame = newest_[static_cast<std::size_t>(layer)];
  return frame ? &*frame : nullptr;
}

std::uint64_t ScriptClient::eventCount(v1::RoomEventKind kind) const {
  const auto found = events_.find(kind);
  return found == events_.end() ? 0 : found->second;
}

}  // namespace spindrift::script
