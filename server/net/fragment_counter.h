// Counts the message fragments that a client sends, by the frame headers of RFC 6455 section 5.2. Needed because Beast
// reads fragments without reporting them, and an empty one costs the sender only six bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <spindrift/core/bytes.h>

namespace spindrift::net {

class FragmentCounter {
 public:
  /// Takes the next bytes of the stream, split anywhere; the first call has the stream's first byte. Returns how many
  /// fragment headers end in them: data frames (opcodes 0 to 7) without the FIN bit, empty or not.
  std::uint64_t count(core::ByteView bytes) {
    std::uint64_t fragment_count = 0;
    while (!bytes.empty()) {
      if (payload_left_bytes_ > 0) {
        const auto skipped = static_cast<std::size_t>(std::min<std::uint64_t>(payload_left_bytes_, bytes.size()));
        payload_left_bytes_ -= skipped;
        bytes = bytes.subspan(skipped);
        continue;
      }
      header_[header_bytes_++] = bytes.front();
      bytes = bytes.subspan(1);
      if (header_bytes_ < headerBytes()) continue;
      constexpr std::uint8_t kFin = 0x80, kControl = 0x08;
      if ((header_[0] & (kFin | kControl)) == 0) ++fragment_count;
      payload_left_bytes_ = payloadBytes();
      header_bytes_ = 0;
    }
    return fragment_count;
  }

 private:
  static constexpr std::size_t kFirstBytes = 2;
  static constexpr std::uint8_t kLengthMask = 0x7f, kSixteenBits = 126, kSixtyFourBits = 127;

  [[nodiscard]] std::uint8_t shortLength() const { return header_[1] & kLengthMask; }
  [[nodiscard]] std::size_t extendedBytes() const {
    return shortLength() == kSixtyFourBits ? 8 : shortLength() == kSixteenBits ? 2 : 0;
  }
  /// Length of the current header, as far as its first two bytes tell.
  [[nodiscard]] std::size_t headerBytes() const {
    constexpr std::uint8_t kMasked = 0x80;
    constexpr std::size_t kMaskBytes = 4;
    if (header_bytes_ < kFirstBytes) return kFirstBytes;
    return kFirstBytes + extendedBytes() + ((header_[1] & kMasked) != 0 ? kMaskBytes : 0);
  }
  [[nodiscard]] std::uint64_t payloadBytes() const {
    if (extendedBytes() == 0) return shortLength();
    std::uint64_t length = 0;
    for (std::size_t k = 0; k < extendedBytes(); ++k) length = length << 8 | header_[kFirstBytes + k];
    return length;
  }

  std::array<std::uint8_t, 14> header_{};  ///< the longest possible header
  std::size_t header_bytes_ = 0;           ///< bytes of it received so far
  std::uint64_t payload_left_bytes_ = 0;   ///< left of the frame whose header was read last
};

}  // namespace spindrift::net
