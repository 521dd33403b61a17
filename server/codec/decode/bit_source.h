// Bits one behind the other, lowest first, as codec/bit_stream writes them: read through a window of 57.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace spindrift::codec {

static_assert(std::endian::native == std::endian::little, "eight bytes are loaded as one little-endian word");

class BitSource {
 public:
  /// Zeros that have to lie behind the bytes: a run of reads needs only one look at where it is.
  static constexpr std::uint32_t kSlackBytes = 512;
  /// Between two calls of prepare(): a group of residuals behind an escape each takes 262 bytes.
  static constexpr std::uint32_t kRunMaxBits = 8 * (kSlackBytes - 2 * sizeof(std::uint64_t));
  /// Places of bits fit into 32 of them.
  static constexpr std::uint32_t kMaxBytes = 1u << 28;

  /// `byte_count` <= kMaxBytes; kSlackBytes of 0 behind them.
  BitSource(const std::uint8_t* bytes, std::uint32_t byte_count) : bytes_(bytes), end_(8 * byte_count) {}

  /// To be called before reading at most kRunMaxBits. Who has read beyond the end reads zeros from there on, and
  /// isAtEnd() is false.
  void prepare() {
    if (at_ <= end_) return;
    at_ = end_;
    is_past_end_ = true;
  }
  /// The next 57 bits and perhaps more, without taking them.
  [[nodiscard]] std::uint64_t peek() const {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes_ + at_ / 8, sizeof word);
    return word >> at_ % 8;
  }
  void take(std::uint32_t bit_count) { at_ += bit_count; }
  /// bit_count <= 32.
  std::uint32_t get(std::uint32_t bit_count) {
    const std::uint64_t bits = peek() & ((std::uint64_t{1} << bit_count) - 1);
    take(bit_count);
    return static_cast<std::uint32_t>(bits);
  }
  /// `bit_count` bits that are read apart from the others, with peekAt(). False: there are not so many.
  bool skip(std::uint64_t bit_count) {
    if (at_ > end_ || bit_count > end_ - at_) return false;
    at_ += static_cast<std::uint32_t>(bit_count);
    return true;
  }
  [[nodiscard]] std::uint32_t place() const { return at_; }
  /// As peek(), of another place; before the end.
  [[nodiscard]] std::uint64_t peekAt(std::uint32_t place) const {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes_ + place / 8, sizeof word);
    return word >> place % 8;
  }
  /// Whether everything but the filling was read, and nothing beyond.
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
