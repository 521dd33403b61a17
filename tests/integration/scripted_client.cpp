#include "scripted_client.h"

#include <algorithm>
#include <chrono>

#include <spindrift/codec/frame_decoder.h>

namespace spindrift::test {
namespace {

using Clock = std::chrono::steady_clock;

bool isKept(const v1::ServerMessage& message) {
  return !message.has_frame() && !message.has_diagnostics();
}

}  // namespace

ScriptedClient::ScriptedClient(std::uint16_t port, const std::string& room, int receive_buffer_bytes) {
  ws_.setReceiveBuffer(receive_buffer_bytes);
  if (!ws_.connect("127.0.0.1", port, room.empty() ? "/ws" : "/ws/" + room)) return;
  const auto first = ws_.receive();
  if (!first) return;
  if (auto message = codec::parseServerMessage(*first)) greeting_ = message->greeting();
}

void ScriptedClient::hello(const Person& who) {
  v1::ClientMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.mutable_version()->set_major(who.major);
  hello.mutable_version()->set_minor(who.minor);
  hello.set_client("scripted client");
  hello.set_name(who.name);
  hello.set_token(who.token);
  hello.set_resume_key(who.resume_key);
  send(message);
}

const v1::Welcome& ScriptedClient::welcome() {
  if (!welcome_) {
    const auto message = waitFor(v1::ServerMessage::kWelcome);
    welcome_ = message ? message->welcome() : v1::Welcome{};
  }
  return *welcome_;
}

void ScriptedClient::subscribe(v1::Layer layer, double max_rate_hz, v1::Packing packing) {
  v1::Subscribe wanted;
  wanted.set_layer(layer);
  wanted.set_max_rate_hz(max_rate_hz);
  wanted.set_packing(packing);
  subscribe(wanted);
}

void ScriptedClient::subscribe(const v1::Subscribe& subscribe) {
  v1::ClientMessage message;
  *message.mutable_subscribe() = subscribe;
  send(message);
}

void ScriptedClient::send(const v1::ClientMessage& message) {
  const std::string bytes = message.SerializeAsString();
  (void)ws_.sendBinary({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

std::optional<v1::ServerMessage> ScriptedClient::waitFor(const Wanted& wanted) {
  if (const auto found = std::ranges::find_if(kept_, wanted); found != kept_.end()) {
    v1::ServerMessage message = std::move(*found);
    kept_.erase(found);
    return message;
  }
  const auto deadline = Clock::now() + kPatience;
  while (Clock::now() < deadline) {
    const auto bytes = ws_.receive(std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()));
    if (!bytes) return std::nullopt;
    auto message = codec::parseServerMessage(*bytes);
    if (!message) return std::nullopt;
    if (wanted(*message)) return *std::move(message);
    if (isKept(*message)) kept_.push_back(*std::move(message));
  }
  return std::nullopt;
}

std::optional<v1::ServerMessage> ScriptedClient::waitFor(v1::ServerMessage::MessageCase kind) {
  return waitFor([kind](const v1::ServerMessage& message) { return message.message_case() == kind; });
}

std::optional<v1::LayerFrame> ScriptedClient::nextFrame(v1::Layer layer) {
  auto message = waitFor([layer](const v1::ServerMessage& candidate) {
    return candidate.has_frame() && candidate.frame().layer() == layer;
  });
  if (!message) return std::nullopt;
  return message->frame();
}

v1::ServerMessage ScriptedClient::ask(v1::Command command) {
  const std::uint64_t id = ++last_command_id_;
  command.set_command_id(id);
  v1::ClientMessage message;
  *message.mutable_command() = std::move(command);
  send(message);
  return waitFor([id](const v1::ServerMessage& answer) {
           return (answer.has_ack() && answer.ack().command_id() == id) ||
                  (answer.has_reject() && answer.reject().command_id() == id);
         })
      .value_or(v1::ServerMessage{});
}

std::optional<std::uint64_t> ScriptedClient::apply(v1::Command command) {
  const v1::ServerMessage answer = ask(std::move(command));
  if (!answer.has_ack()) return std::nullopt;
  return answer.ack().applied_tick();
}

v1::Reject ScriptedClient::rejected(v1::Command command) {
  return ask(std::move(command)).reject();
}

bool ScriptedClient::barrier() {
  const double now_s = ++last_ping_s_;
  v1::ClientMessage message;
  message.mutable_ping()->set_client_time_s(now_s);
  send(message);
  return waitFor([now_s](const v1::ServerMessage& answer) {
           return answer.has_pong() && answer.pong().client_time_s() == now_s;
         })
      .has_value();
}

bool ScriptedClient::settle() {
  if (welcome().person_id() == 0 || !barrier()) return false;
  std::erase_if(kept_, [](const v1::ServerMessage& message) { return message.has_greeting(); });
  return true;
}

bool ScriptedClient::hasReceived(v1::ServerMessage::MessageCase kind) {
  (void)barrier();
  return std::ranges::any_of(kept_, [kind](const auto& message) { return message.message_case() == kind; });
}

bool ScriptedClient::runFor(std::uint64_t ticks_count) {
  // Any command that changes nothing: its answer contains the tick at which it was applied.
  const double speed = greeting_.room_state().speed();
  const auto begin = apply(setSpeed(speed));
  const auto deadline = Clock::now() + kPatience;
  auto now = begin;
  while (now && *now < *begin + ticks_count && Clock::now() < deadline) now = apply(setSpeed(speed));
  return now && *now >= *begin + ticks_count;
}

}  // namespace spindrift::test
