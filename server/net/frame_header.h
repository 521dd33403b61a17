// The header of a WebSocket frame that a server sends: a whole binary message, not masked (RFC 6455 section 5.2).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace spindrift::net {

class FrameHeader {
 public:
  explicit FrameHeader(std::size_t payload_bytes_count) {
    bytes_[0] = kFinalBinary;
    if (payload_bytes_count < kTwoBytesFollow) {
      bytes_[1] = static_cast<std::uint8_t>(payload_bytes_count);
    } else if (payload_bytes_count <= 0xffff) {
      bytes_[1] = kTwoBytesFollow;
      putLength(payload_bytes_count, 2);
    } else {
      bytes_[1] = kEightBytesFollow;
      putLength(payload_bytes_count, 8);
    }
  }

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return std::span(bytes_).first(size_); }

 private:
  static constexpr std::uint8_t kFinalBinary = 0x82;
  static constexpr std::uint8_t kTwoBytesFollow = 126;
  static constexpr std::uint8_t kEightBytesFollow = 127;

  /// In network byte order.
  void putLength(std::uint64_t length, std::size_t bytes_count) {
    for (std::size_t k = 0; k < bytes_count; ++k)
      bytes_[2 + k] = static_cast<std::uint8_t>(length >> (8 * (bytes_count - 1 - k)));
    size_ = 2 + bytes_count;
  }

  std::array<std::uint8_t, 10> bytes_{};
  std::size_t size_ = 2;
};

}  // namespace spindrift::net
