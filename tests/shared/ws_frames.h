// A WebSocket client that sends exactly the frames it is told to, also those that no client may send (RFC 6455 section
// 5.2), and shows the frames that come back. Link spindrift::ws_client.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ws_client.h"

namespace spindrift::test {

enum class Opcode : std::uint8_t {
  kContinuation = 0,
  kText = 1,
  kBinary = 2,
  kReservedData = 3,
  kClose = 8,
  kPing = 9,
  kPong = 10,
  kReservedControl = 11,
};

/// How a frame's length is written; kShortest is the only one that is allowed.
enum class LengthForm { kShortest, kSixteenBits, kSixtyFourBits };

struct Frame {
  Opcode opcode = Opcode::kBinary;
  std::string payload{};
  bool fin = true;
  std::uint8_t reserved_bits = 0;  ///< 0..7
  bool masked = true;
  LengthForm length_form = LengthForm::kShortest;
};

/// The frame as bytes of a client.
std::string bytesOf(const Frame& frame);

/// A close frame with this code and reason.
Frame closeFrame(std::uint16_t code, std::string_view reason = "");

/// An upgrade request for `/ws`; `headers` takes the place of version and key where it is not empty.
std::string upgradeRequest(const std::string& headers = "");

class FrameClient {
 public:
  /// Connects, upgrades and reads up to the answer's end. False if it was not 101.
  bool connect(std::uint16_t port);

  bool send(const Frame& frame) { return tcp_.send(bytesOf(frame)); }
  /// The next frame; nullopt if the peer has hung up, sends nothing for kPatience, or breaks the rules for servers:
  /// no mask, no reserved bits, shortest length, control frames whole and at most 125 bytes.
  std::optional<Frame> receive();
  /// Receives and forgets up to the close frame. Its code, 1005 for one without; 0 if none came.
  std::uint16_t receiveClose();
  /// True once the peer has hung up.
  bool waitClosed();

  RawTcp& tcp() { return tcp_; }

 private:
  RawTcp tcp_;
};

}  // namespace spindrift::test
