// Decoding tables of prefix codes of at most 11 bits: one lookup of the next bits gives the symbol and its length.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <spindrift/bitstream/decode/bit_source.h>

#include "format/prefix_lengths.h"

namespace spindrift::codec {

/// One symbol and the number of bits of its code.
struct Slot {
  std::uint8_t symbol = 0;
  std::uint8_t length = 0;
};

class PrefixSlots {
 public:
  /// False if the lengths do not form a complete prefix code.
  bool assign(std::span<const std::uint8_t> lengths);
  /// Reads a code from the payload. False: the bits are damaged. `symbol_count` <= kMaxSymbolCount.
  bool read(std::size_t symbol_count, BitSource& in);

  /// Looks up the lowest bits of a window.
  [[nodiscard]] Slot operator[](std::uint64_t window) const { return slots_[window % (1u << kMaxCodeBits)]; }
  std::uint32_t get(BitSource& in) const {
    const Slot slot = (*this)[in.peek()];
    in.take(slot.length);
    return slot.symbol;
  }

 private:
  std::array<Slot, 1 << kMaxCodeBits> slots_{};
};

}  // namespace spindrift::codec
