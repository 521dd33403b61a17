// Reads a sequence of bits, lowest first, as written by codec/bit_stream, through a window of 57 bits.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace spindrift::codec {

static_assert(std::endian::native == std::endian::little, "eight bytes are loaded as one little-endian word");

class BitSource {
 public:
  /// Number of zero bytes that must follow the input, so that a run of reads needs only one check of the position.
  static constexpr std::uint32_t kSlackBytes = 512;
  /// Largest number of bits between two calls of prepare(). A group whose residuals all use an escape takes 262 bytes.
  static constexpr std::uint32_t kRunMaxBits = 8 * (kSlackBytes - 2 * sizeof(std::uint64_t));
  /// Keeps positions in bits below 2^32.
  static constexpr std::uint32_t kMaxBytes = 1u << 28;

  /// `byte_count` <= kMaxBytes; kSlackBytes of 0 must follow the bytes.
  BitSource(const std::uint8_t* bytes, std::uint32_t byte_count) : bytes_(bytes), end_(8 * byte_count) {}

  /// Call it before reading at most kRunMaxBits. After a read beyond the end, reads return zeros and isAtEnd() is
  /// false.
  void prepare() {
    if (at_ <= end_) return;
    at_ = end_;
    is_past_end_ = true;
  }
  /// Returns at least the next 57 bits without consuming them.
  [[nodiscard]] std::uint64_t peek() const { return peekAt(at_); }
  void take(std::uint32_t bit_count) { at_ += bit_count; }
  /// bit_count <= 32.
  std::uint32_t get(std::uint32_t bit_count) {
    const std::uint64_t bits = peek() & ((std::uint64_t{1} << bit_count) - 1);
    take(bit_count);
    return static_cast<std::uint32_t>(bits);
  }
  /// Skips `bit_count` bits that are read separately with peekAt(). False: fewer are left.
  bool skip(std::uint64_t bit_count) {
    if (at_ > end_ || bit_count > end_ - at_) return false;
    at_ += static_cast<std::uint32_t>(bit_count);
    return true;
  }
  [[nodiscard]] std::uint32_t place() const { return at_; }
  /// Like peek(), at another position before the end.
  [[nodiscard]] std::uint64_t peekAt(std::uint32_t place) const {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes_ + place / 8, sizeof word);
    return word >> place % 8;
  }
  /// Returns whether everything except zero padding was read, and nothing beyond the end.
  [[nodiscard]] bool isAtEnd() const {
    return !is_past_end_ && at_ <= end_ && end_ - at_ < 8 && (at_ == end_ || peek() == 0);
  }

 private:
  const std::uint8_t* bytes_;
  std::uint32_t at_ = 0;  ///< in bits
  std::uint32_t end_;
  bool is_past_end_ = false;
};

}  // namespace spindrift::codec
