// Prefix codes of at most 11 bits to write with, canonical: the lengths say everything.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bit_stream.h"
#include "format/prefix_lengths.h"

namespace spindrift::codec {

/// A code to write with.
class PrefixWriter {
 public:
  /// lengths[s]: bits of symbol s, 0 where it does not occur; at most kMaxSymbolCount. They have to be complete.
  explicit PrefixWriter(std::span<const std::uint8_t> lengths);

  void put(std::size_t symbol, BitCursor& out) const { out.put(words_[symbol] & 0xffffu, words_[symbol] >> 16); }
  /// One behind the other, 44 bits at most. Joined in pairs, so that only one step of three waits for the bits before.
  void putFour(std::size_t a, std::size_t b, std::size_t c, std::size_t d, BitCursor& out) const {
    const std::uint32_t wa = words_[a], wb = words_[b], wc = words_[c], wd = words_[d];
    const std::uint64_t ab = (wa & 0xffffu) | std::uint64_t{wb & 0xffffu} << (wa >> 16);
    const std::uint64_t cd = (wc & 0xffffu) | std::uint64_t{wd & 0xffffu} << (wc >> 16);
    const std::uint32_t ab_bits = (wa >> 16) + (wb >> 16), cd_bits = (wc >> 16) + (wd >> 16);
    out.putLong(ab | cd << ab_bits, ab_bits + cd_bits);
  }

 private:
  std::array<std::uint32_t, kMaxSymbolCount> words_{};  ///< code | length << 16
};

/// The lengths that fit the counts, at most kMaxSymbolCount; at least two of them above 0.
void fitLengths(std::span<const std::uint32_t> counts, std::span<std::uint8_t> lengths);

/// A code for one frame, sent along with it: fitted to the counts of its symbols. Symbols 0 and 1 are in it in any
/// case.
PrefixWriter putFittedCode(std::span<const std::uint32_t> counts, BitWriter& out);

}  // namespace spindrift::codec
