// Prefix codes of at most 11 bits to read with: one look at the next bits gives symbol and length.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bit_source.h"
#include "format/prefix_lengths.h"

namespace spindrift::codec {

/// One symbol and the number of bits that its code takes.
struct Slot {
  std::uint8_t symbol = 0;
  std::uint8_t length = 0;
};

class PrefixSlots {
 public:
  /// False where the lengths are not those of a code that every sequence of bits has a meaning in.
  bool assign(std::span<const std::uint8_t> lengths);
  /// A code that was sent along. False: the bits are damaged. `symbol_count` <= kMaxSymbolCount.
  bool read(std::size_t symbol_count, BitSource& in);

  /// By the lowest bits of a window.
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
