// Frames of WebSocket connections: their headers, written and followed (RFC 6455 section 5.2).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <boost/container/static_vector.hpp>

#include <spindrift/core/bytes.h>

namespace spindrift::net {

using FrameHeader = boost::container::static_vector<std::uint8_t, 10>;

/// Returns the header of a whole message of a server, which is not masked, with the shortest length that fits.
inline FrameHeader frameHeader(std::uint64_t payload_bytes_count, bool is_text = false) {
  constexpr std::uint8_t kFinalText = 0x81, kFinalBinary = 0x82, kTwoBytesFollow = 126, kEightBytesFollow = 127;
  const std::uint8_t first = is_text ? kFinalText : kFinalBinary;
  if (payload_bytes_count < kTwoBytesFollow) return {first, static_cast<std::uint8_t>(payload_bytes_count)};
  const bool is_short = payload_bytes_count <= 0xffff;
  FrameHeader out{first, is_short ? kTwoBytesFollow : kEightBytesFollow};
  for (int shift = is_short ? 8 : 56; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(payload_bytes_count >> shift));
  return out;
}

/// Follows the frames of one direction of a connection.
class FrameScanner {
 public:
  /// Takes the next bytes of the direction, split anywhere; the first call has the first byte after the handshake.
  void scan(core::ByteView bytes) {
    while (!bytes.empty()) {
      if (payload_left_bytes_ > 0) {
        const auto skipped = static_cast<std::size_t>(std::min<std::uint64_t>(payload_left_bytes_, bytes.size()));
        payload_left_bytes_ -= skipped;
        bytes = bytes.subspan(skipped);
        continue;
      }
      header_[header_bytes_++] = bytes.front();
      bytes = bytes.subspan(1);
      if (header_bytes_ == headerBytes()) endHeader();
    }
  }

  [[nodiscard]] bool isBetweenFrames() const { return header_bytes_ == 0 && payload_left_bytes_ == 0; }
  /// Returns whether the header of a close frame has passed.
  [[nodiscard]] bool hasClose() const { return has_close_; }
  /// Returns the number of fragments since the last call: headers of data frames without the FIN bit, empty or not.
  std::uint64_t takeFragmentCount() { return std::exchange(fragment_count_, 0); }

 private:
  static constexpr std::size_t kFirstBytes = 2;

  /// Returns the number of bytes of the length after the first two bytes of the header.
  [[nodiscard]] std::size_t lengthBytes() const {
    const int length = header_[1] & 0x7f;
    return length == 127 ? 8 : length == 126 ? 2 : 0;
  }
  /// Returns the size of the header, as far as its first two bytes tell.
  [[nodiscard]] std::size_t headerBytes() const {
    constexpr std::uint8_t kMasked = 0x80;
    constexpr std::size_t kMaskBytes = 4;
    if (header_bytes_ < kFirstBytes) return kFirstBytes;
    return kFirstBytes + lengthBytes() + ((header_[1] & kMasked) != 0 ? kMaskBytes : 0);
  }
  void endHeader() {
    constexpr std::uint8_t kFin = 0x80, kControl = 0x08, kOpcode = 0x0f, kClose = 0x08;
    if ((header_[0] & (kFin | kControl)) == 0) ++fragment_count_;
    if ((header_[0] & kOpcode) == kClose) has_close_ = true;
    payload_left_bytes_ = lengthBytes() == 0 ? header_[1] & 0x7f : 0;
    for (std::size_t k = 0; k < lengthBytes(); ++k)
      payload_left_bytes_ = payload_left_bytes_ << 8 | header_[kFirstBytes + k];
    header_bytes_ = 0;
  }

  std::array<std::uint8_t, 14> header_{};  ///< the longest possible header
  std::size_t header_bytes_ = 0;           ///< bytes of it received so far
  std::uint64_t payload_left_bytes_ = 0;   ///< left of the frame whose header was read last
  std::uint64_t fragment_count_ = 0;
  bool has_close_ = false;
};

}  // namespace spindrift::net
