// Messages of a client of Foxglove's protocol, one after the other, with answers of the server between them. The first
// byte of each says which it is: 't' text, 'b' binary, anything else a message of the server.
#include <algorithm>
#include <string>
#include <string_view>
#include <variant>

#include <spindrift/foxglove/channels.h>
#include <spindrift/foxglove/live_session.h>
#include <spindrift/wire/client_message.h>

#include "fuzz.h"

namespace spindrift::fuzz {
namespace {

constexpr std::string_view kMark = "\xff\xff====";

core::ByteView viewOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string greeting() {
  v1::ServerMessage message;
  for (int layer = v1::LAYER_SURFACE; layer <= v1::LAYER_FLOATERS; ++layer)
    message.mutable_greeting()->add_layers(static_cast<v1::Layer>(layer));
  v1::ParameterDescription& parameter = *message.mutable_greeting()->add_parameters();
  parameter.set_path("wave.depth_m");
  parameter.set_value(2.0);
  return message.SerializeAsString();
}

void checkSent(const std::vector<core::Translator::Outgoing>& sent, std::size_t max_count) {
  must(sent.size() <= max_count, "the number of messages to the client is bounded");
  for (const auto& message : sent)
    must(message.bytes && !message.bytes->empty(), "a message to the client is not empty");
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  using fuzz::must;
  static const std::string greeting = fuzz::greeting();
  const auto session = foxglove::makeLiveSession("");
  (void)session->open();
  (void)session->send(fuzz::viewOf(greeting));
  std::string_view left(reinterpret_cast<const char*>(data), size);
  std::size_t under_way_count = 0;
  while (!left.empty()) {
    const std::size_t end = std::min(left.find(fuzz::kMark), left.size());
    std::string_view message = left.substr(0, end);
    left.remove_prefix(std::min(left.size(), end + fuzz::kMark.size()));
    const char kind = message.empty() ? 't' : message.front();
    if (!message.empty()) message.remove_prefix(1);
    if (kind != 't' && kind != 'b') {
      // Each boat, object and gauge of a frame takes more bytes than messages.
      fuzz::checkSent(session->send(fuzz::viewOf(message)), message.size() + 8);
      continue;
    }
    const auto incoming = session->receive(fuzz::viewOf(message), kind == 't');
    must(incoming.answers.size() <= 2, "a message has a status and an answer at most");
    for (const core::SharedBytes& answer : incoming.answers) {
      const auto sent = session->send(*answer);
      must(sent.size() == 1, "an answer of the session's own is one message");
      fuzz::checkSent(sent, 1);
    }
    for (const core::Bytes& said : incoming.messages) {
      const wire::ClientMessage parsed = wire::parseClientMessage(said);
      must(!std::holds_alternative<core::Error>(parsed), "what it says for the client is of the wire");
      under_way_count += std::holds_alternative<v1::Command>(parsed) ? 1 : 0;
    }
    must(under_way_count <= foxglove::kLiveCommandMaxCount + size, "commands under way are bounded");
  }
  return 0;
}
