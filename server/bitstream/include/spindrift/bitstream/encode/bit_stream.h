// Writes a sequence of bits, least significant first, through a cursor that stays in registers.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include <spindrift/core/bytes.h>

namespace spindrift::codec {

static_assert(std::endian::native == std::endian::little, "eight bytes are stored as one little-endian word");

/// Write position of a BitWriter. At most 56 bits between two calls of flush().
struct BitCursor {
  std::uint8_t* at = nullptr;
  std::uint64_t pending = 0;
  std::uint32_t count = 0;

  /// Writes the low `bit_count` bits of value; all other bits must be 0.
  void put(std::uint64_t value, std::uint32_t bit_count) {
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
  /// Reserves `byte_count` more bytes and returns a cursor; the written bits count once the cursor is handed back.
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
  /// Appends the written bits, padded with zeros to whole bytes. The writer is empty afterwards and keeps its memory.
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

}  // namespace spindrift::codec
