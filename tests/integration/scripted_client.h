// A client that speaks the wire: says hello, subscribes, sends commands, and waits for what it expects.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include <spindrift/v1/wire.pb.h>

#include "commands.h"
#include "ws_client.h"

namespace spindrift::test {

/// The identity in Hello.
struct Person {
  std::string name{};
  std::string token{};
  std::string resume_key{};
  std::uint32_t major = 1;
  std::uint32_t minor = 1;  ///< of the wire version
};

class ScriptedClient {
 public:
  /// Connects to a room ("" = the default one) and reads the greeting; isOpen() returns whether that worked.
  /// `receive_buffer_bytes`: size of the kernel's buffer for unread bytes; 0 = its choice.
  explicit ScriptedClient(std::uint16_t port, const std::string& room = "", int receive_buffer_bytes = 0);

  bool isOpen() const { return !ws_.closed() && greeting_.session_id() != 0; }
  const v1::Greeting& greeting() const { return greeting_; }
  WsClient& ws() { return ws_; }

  void hello(const Person& who = {});
  /// Returns the answer to hello(); empty if there was none. Waits for it the first time.
  const v1::Welcome& welcome();
  void subscribe(v1::Layer layer, double max_rate_hz = 60.0, v1::Packing packing = v1::PACKING_PLAIN);
  void subscribe(const v1::Subscribe& subscribe);
  void unsubscribe(v1::Layer layer) { subscribe(layer, 0.0); }
  void send(const v1::ClientMessage& message);

  using Wanted = std::function<bool(const v1::ServerMessage&)>;
  /// Returns the first message that `wanted` accepts; nullopt once closed or after kPatience. Frames and diagnostics
  /// before it are dropped; all other messages are kept, and a later call searches them first.
  std::optional<v1::ServerMessage> waitFor(const Wanted& wanted);
  std::optional<v1::ServerMessage> waitFor(v1::ServerMessage::MessageCase kind);
  std::optional<v1::LayerFrame> nextFrame(v1::Layer layer);

  /// Sends the command with a new id and waits for its Ack or Reject; an empty message if none came.
  v1::ServerMessage ask(v1::Command command);
  /// ask() for a valid command: the tick of its Ack; nullopt if there was none.
  std::optional<std::uint64_t> apply(v1::Command command);
  /// ask() for a command that is rejected: its Reject; empty if there was none.
  v1::Reject rejected(v1::Command command);

  /// Sends a ping and waits for its pong: everything that the server had queued for this client has then arrived. False
  /// if it is gone.
  bool barrier();
  /// Waits for the answer to hello() and drops the greetings until then: what changed while the client arrived is in a
  /// second one.
  bool settle();
  /// barrier(), then returns whether a message of the kind is among those kept.
  bool hasReceived(v1::ServerMessage::MessageCase kind);
  /// Lets the room run until its tick has grown by `ticks_count`; false if it does not.
  bool runFor(std::uint64_t ticks_count);

 private:
  WsClient ws_;
  v1::Greeting greeting_;
  std::optional<v1::Welcome> welcome_;
  std::deque<v1::ServerMessage> kept_;
  std::uint64_t last_command_id_ = 0;
  double last_ping_s_ = 0.0;
};

}  // namespace spindrift::test
