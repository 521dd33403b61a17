// Bits one behind the other, least significant first: written in runs through a cursor that lives in registers.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include <spindrift/core/bytes.h>

namespace spindrift::stream {

static_assert(std::endian::native == std::endian::little,
              "eight bytes are stored and loaded as one little-endian word");

/// Where a BitWriter goes on writing. Between two flush() at most 56 bits.
struct BitCursor {
  std::uint8_t* at = nullptr;
  std::uint64_t pending = 0;
  std::uint32_t count = 0;

  /// The low `bit_count` bits of value; the others have to be 0. bit_count <= 32.
  void put(std::uint32_t value, std::uint32_t bit_count) {
    pending |= std::uint64_t{value} << count;
    count += bit_count;
  }
  /// Likewise; bit_count <= 56.
  void putLong(std::uint64_t value, std::uint32_t bit_count) {
    pending |= value << count;
    count += bit_count;
  }
  void flush() {
    std::memcpy(at, &pending, sizeof pending);
    at += count / 8;
    pending >>= count & ~7u;
    count &= 7;
  }
};

class BitWriter {
 public:
  /// Room for `byte_count` more bytes; the writer takes note of what was written when the cursor comes back.
  BitCursor begin(std::size_t byte_count) {
    if (bytes_.size() < used_ + byte_count + sizeof(std::uint64_t))
      bytes_.resize(2 * bytes_.size() + byte_count + sizeof(std::uint64_t));
    return {bytes_.data() + used_, pending_, count_};
  }
  void end(BitCursor cursor) {
    cursor.flush();
    used_ = static_cast<std::size_t>(cursor.at - bytes_.data());
    pending_ = cursor.pending;
    count_ = cursor.count;
  }
  /// bit_count <= 32.
  void put(std::uint32_t value, std::uint32_t bit_count) {
    BitCursor cursor = begin(8);
    cursor.put(value, bit_count);
    end(cursor);
  }
  /// Appends what was written, filled up with zero bits to whole bytes. Empty afterwards; keeps its memory.
  void finish(core::Bytes& out) {
    const auto begin = bytes_.begin();
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(used_ + (count_ > 0 ? 1 : 0)));
    used_ = 0;
    pending_ = 0;
    count_ = 0;
  }

 private:
  core::Bytes bytes_;
  std::size_t used_ = 0;
  std::uint64_t pending_ = 0;
  std::uint32_t count_ = 0;
};

/// Reads what BitWriter wrote. Beyond the end there are zeros, and isAtEnd() is false then.
class BitReader {
 public:
  explicit BitReader(core::ByteView bytes) : bytes_(bytes) {}

  /// The next bits without taking them; at least 32 are there.
  std::uint32_t peek() {
    if (count_ < 32) refill();
    return static_cast<std::uint32_t>(pending_);
  }
  /// Of those that were peeked at.
  void take(std::uint32_t bit_count) {
    pending_ >>= bit_count;
    count_ -= bit_count;
  }
  /// bit_count <= 31.
  std::uint32_t get(std::uint32_t bit_count) {
    const std::uint32_t value = peek() & ((1u << bit_count) - 1);
    take(bit_count);
    return value;
  }
  /// Whether everything but the filling was read, and nothing beyond.
  [[nodiscard]] bool isAtEnd() const {
    return at_ >= bytes_.size() && count_ >= 8 * (at_ - bytes_.size()) && count_ - 8 * (at_ - bytes_.size()) < 8 &&
           pending_ == 0;
  }

 private:
  void refill() {
    for (; count_ <= 56; count_ += 8, ++at_) {
      const std::uint64_t byte = at_ < bytes_.size() ? bytes_[at_] : 0;
      pending_ |= byte << count_;
    }
  }

  core::ByteView bytes_;
  std::size_t at_ = 0;  ///< of the byte read next, also beyond the end
  std::uint64_t pending_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace spindrift::stream
