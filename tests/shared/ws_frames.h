// A WebSocket client that sends exactly the given frames, including those that no client may send (RFC 6455 section
// 5.2), and returns the received frames. Link spindrift::ws_client.
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

/// Form of a frame's length; only kShortest is allowed.
enum class LengthForm { kShortest, kSixteenBits, kSixtyFourBits };

struct Frame {
  Opcode opcode = Opcode::kBinary;
  std::string payload{};
  bool fin = true;
  std::uint8_t reserved_bits = 0;  ///< 0..7
  bool masked = true;
  LengthForm length_form = LengthForm::kShortest;
};

/// Returns the bytes of a client's frame.
std::string bytesOf(const Frame& frame);

/// Returns a close frame with this code and reason.
Frame closeFrame(std::uint16_t code, std::string_view reason = "");

/// Returns an upgrade request for `/ws`; `headers`, if not empty, replaces version and key.
std::string upgradeRequest(const std::string& headers = "");

class FrameClient {
 public:
  /// Connects, upgrades and reads the whole answer. False if it was not 101.
  bool connect(std::uint16_t port);

  bool send(const Frame& frame) { return tcp_.send(bytesOf(frame)); }
  /// Returns the next frame; nullopt if the peer has disconnected, sends nothing for kPatience, or breaks the rules for
  /// servers: no mask, no reserved bits, shortest length, control frames unfragmented and at most 125 bytes.
  std::optional<Frame> receive();
  /// Receives and drops frames up to the close frame. Returns its code, 1005 for one without; 0 if none came.
  std::uint16_t receiveClose();
  /// True once the peer has disconnected.
  bool waitClosed();

  RawTcp& tcp() { return tcp_; }

 private:
  RawTcp tcp_;
};

}  // namespace spindrift::test
