// Bytes that a WebSocket client has read ahead, cut at the ends of frames (RFC 6455 section 5.2).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::net {

/// At first the bytes are the response to an upgrade, cut at the end of its head; after beginFrames() they are frames.
/// A reader that takes no more than next() at a time never has a byte of the frame after the one that it reads, so
/// that takeMessage() can give a whole message past it.
class FrameCutter {
 public:
  explicit FrameCutter(std::size_t kept_max_bytes) : kept_(std::max(kept_max_bytes, kHeaderMaxBytes)) {}

  /// Returns the free space to read into; never empty while next() is empty. Call it only then, and added() with the
  /// number of bytes that were read.
  std::span<std::uint8_t> room() {
    std::copy(kept_.begin() + begin_, kept_.begin() + end_, kept_.begin());  // at most the beginning of a header
    end_ -= begin_;
    begin_ = 0;
    head_end_.reset();
    return std::span(kept_).subspan(static_cast<std::size_t>(end_));
  }
  void added(std::size_t bytes_count) {
    const Place before = end_;
    end_ += static_cast<Place>(bytes_count);
    if (!is_framed_ && !head_has_ended_) findHeadEnd(before);
  }

  /// Returns bytes up to the end of the response's head or of the frame; empty: none have come, or not enough to know
  /// the size of the frame.
  [[nodiscard]] core::ByteView next() const {
    const core::ByteView kept = waiting();
    if (!is_framed_) return head_end_ && begin_ < *head_end_ ? kept.first(sizeOf(*head_end_ - begin_)) : kept;
    if (frame_left_bytes_ > 0) return firstOf(kept, frame_left_bytes_);
    const auto frame = frameAt(kept);
    return frame ? firstOf(kept, frame->size()) : core::ByteView();
  }
  /// The reader has taken so many bytes of next().
  void taken(std::size_t bytes_count) {
    if (is_framed_) {
      if (frame_left_bytes_ == 0) frame_left_bytes_ = frameAt(waiting())->size();
      frame_left_bytes_ -= bytes_count;
    }
    begin_ += static_cast<Place>(bytes_count);
  }

  /// The reader has the head of the response, and the connection is a WebSocket one.
  void beginFrames() { is_framed_ = true; }

  /// Takes a message of at most `max_bytes` out if the bytes begin with one that has come whole, in one frame; the view
  /// is valid until room() is called. Otherwise the reader takes the bytes: control frames, parts of messages, faults.
  std::optional<core::ByteView> takeMessage(std::size_t max_bytes) {
    const core::ByteView kept = waiting();
    if (!is_framed_ || frame_left_bytes_ > 0) return std::nullopt;
    const auto frame = frameAt(kept);
    if (!frame || !frame->is_whole_message || frame->payload_bytes > max_bytes || frame->size() > kept.size())
      return std::nullopt;
    begin_ += static_cast<Place>(frame->size());
    return kept.subspan(frame->header_bytes, static_cast<std::size_t>(frame->payload_bytes));
  }

 private:
  using Place = std::ptrdiff_t;
  struct Frame {
    std::size_t header_bytes = 0;
    std::uint64_t payload_bytes = 0;
    bool is_whole_message = false;  ///< text or binary, not continued, not masked, without extension
    [[nodiscard]] std::uint64_t size() const {
      // A length near 2^64 is a fault, which the reader finds in the header.
      return std::min(payload_bytes, std::numeric_limits<std::uint64_t>::max() / 2) + header_bytes;
    }
  };
  static constexpr std::size_t kHeaderMaxBytes = 14;
  static constexpr std::size_t kMaskBytes = 4;

  static std::size_t sizeOf(Place length) { return static_cast<std::size_t>(length); }
  static core::ByteView firstOf(core::ByteView bytes, std::uint64_t count) {
    return bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(count, bytes.size())));
  }
  [[nodiscard]] core::ByteView waiting() const {
    return core::ByteView(kept_).subspan(sizeOf(begin_), sizeOf(end_ - begin_));
  }

  /// Returns the frame whose header the bytes begin with; nullopt if it has not come whole.
  static std::optional<Frame> frameAt(core::ByteView bytes) {
    if (bytes.size() < 2) return std::nullopt;
    const bool is_masked = (bytes[1] & 0x80U) != 0;
    const std::uint8_t length = bytes[1] & 0x7fU;
    const std::size_t length_bytes = length == 126 ? 2 : length == 127 ? 8 : 0;
    Frame out{.header_bytes = 2 + length_bytes + (is_masked ? kMaskBytes : 0), .payload_bytes = length};
    if (bytes.size() < out.header_bytes) return std::nullopt;
    if (length_bytes > 0) out.payload_bytes = 0;
    for (const std::uint8_t byte : bytes.subspan(2, length_bytes)) out.payload_bytes = out.payload_bytes << 8 | byte;
    out.is_whole_message = (bytes[0] == kFinalText || bytes[0] == kFinalBinary) && !is_masked;
    return out;
  }
  static constexpr std::uint8_t kFinalText = 0x81;
  static constexpr std::uint8_t kFinalBinary = 0x82;

  void findHeadEnd(Place from) {
    static constexpr std::array<std::uint8_t, 4> kEnd{'\r', '\n', '\r', '\n'};
    for (Place at = from; at < end_; ++at) {
      const std::uint8_t byte = kept_[sizeOf(at)];
      matched_count_ = byte == kEnd[matched_count_] ? matched_count_ + 1 : byte == '\r' ? 1 : 0;
      if (matched_count_ < kEnd.size()) continue;
      head_end_ = at + 1;
      head_has_ended_ = true;
      return;
    }
  }

  std::vector<std::uint8_t> kept_;
  Place begin_ = 0;
  Place end_ = 0;
  bool is_framed_ = false;
  std::uint64_t frame_left_bytes_ = 0;  ///< of the frame that the reader has begun
  bool head_has_ended_ = false;
  std::optional<Place> head_end_;  ///< where it ended among the bytes that wait
  std::size_t matched_count_ = 0;  ///< bytes of the empty line that ends the head
};

}  // namespace spindrift::net
