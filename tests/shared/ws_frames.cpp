#include "ws_frames.h"

namespace spindrift::test {
namespace {

constexpr std::size_t kLengthMaxInOneByte = 125;
constexpr std::uint8_t kSixteenBitMark = 126;
constexpr std::uint8_t kSixtyFourBitMark = 127;

std::string bigEndian(std::uint64_t value, int bytes_count) {
  std::string out;
  for (int shift = 8 * (bytes_count - 1); shift >= 0; shift -= 8) out.push_back(static_cast<char>(value >> shift));
  return out;
}

std::uint64_t fromBigEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<std::uint8_t>(byte);
  return value;
}

bool isControl(Opcode opcode) {
  return static_cast<std::uint8_t>(opcode) >= 8;
}

}  // namespace

std::string bytesOf(const Frame& frame) {
  const std::size_t size = frame.payload.size();
  LengthForm form = frame.length_form;
  if (form == LengthForm::kShortest && size > 0xffff) form = LengthForm::kSixtyFourBits;
  if (form == LengthForm::kShortest && size > kLengthMaxInOneByte) form = LengthForm::kSixteenBits;
  const unsigned mask_bit = frame.masked ? 0x80U : 0U;
  std::string out;
  out.push_back(static_cast<char>((frame.fin ? 0x80U : 0U) | static_cast<unsigned>(frame.reserved_bits) << 4 |
                                  static_cast<unsigned>(frame.opcode)));
  if (form == LengthForm::kShortest) {
    out.push_back(static_cast<char>(mask_bit | size));
  } else if (form == LengthForm::kSixteenBits) {
    out.push_back(static_cast<char>(mask_bit | kSixteenBitMark));
    out += bigEndian(size, 2);
  } else {
    out.push_back(static_cast<char>(mask_bit | kSixtyFourBitMark));
    out += bigEndian(size, 8);
  }
  if (!frame.masked) return out + frame.payload;
  constexpr std::string_view kMask = "\x12\x34\x56\x78";
  out += kMask;
  for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<char>(frame.payload[i] ^ kMask[i % 4]));
  return out;
}

Frame closeFrame(std::uint16_t code, std::string_view reason) {
  return {.opcode = Opcode::kClose, .payload = bigEndian(code, 2) + std::string(reason)};
}

std::string upgradeRequest(const std::string& headers) {
  static const std::string kUsual = "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==\r\n";
  return "GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n" +
         (headers.empty() ? kUsual : headers) + "\r\n";
}

bool FrameClient::connect(std::uint16_t port) {
  return tcp_.connect("127.0.0.1", port) && tcp_.send(upgradeRequest()) &&
         tcp_.receiveUntil("\r\n\r\n").starts_with("HTTP/1.1 101 ");
}

std::optional<Frame> FrameClient::receive() {
  const std::string head = tcp_.receive(2);
  if (head.size() < 2) return std::nullopt;
  const auto first = static_cast<std::uint8_t>(head[0]);
  const auto second = static_cast<std::uint8_t>(head[1]);
  Frame frame{.opcode = static_cast<Opcode>(first & 0x0fU), .fin = (first & 0x80U) != 0, .masked = false};
  std::uint64_t size = second;
  std::uint64_t size_min = 0;
  if (second == kSixteenBitMark || second == kSixtyFourBitMark) {
    const bool is_short = second == kSixteenBitMark;
    size = fromBigEndian(tcp_.receive(is_short ? 2 : 8));
    size_min = is_short ? kLengthMaxInOneByte + 1 : 0x10000;
  }
  const bool has_mask = (second & 0x80U) != 0;
  const bool has_reserved_bits = (first & 0x70U) != 0;
  if (has_mask || has_reserved_bits || size < size_min) return std::nullopt;
  if (isControl(frame.opcode) && (!frame.fin || size > kLengthMaxInOneByte)) return std::nullopt;
  frame.payload = tcp_.receive(size);
  if (frame.payload.size() < size) return std::nullopt;
  return frame;
}

std::uint16_t FrameClient::receiveClose() {
  while (const auto frame = receive()) {
    if (frame->opcode != Opcode::kClose) continue;
    constexpr std::uint16_t kNoStatus = 1005;
    return frame->payload.empty() ? kNoStatus : static_cast<std::uint16_t>(fromBigEndian(frame->payload.substr(0, 2)));
  }
  return 0;
}

bool FrameClient::waitClosed() {
  (void)tcp_.receiveAll();
  return tcp_.closed();
}

}  // namespace spindrift::test
