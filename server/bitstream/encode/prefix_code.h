// Encoder of prefix codes of at most 11 bits. Codes are canonical: the lengths define them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <spindrift/bitstream/encode/bit_stream.h>

#include "format/prefix_lengths.h"

namespace spindrift::codec {

/// A code for writing.
class PrefixWriter {
 public:
  /// lengths[s]: bits of symbol s, 0 if it does not occur; at most kMaxSymbolCount. The code must be complete.
  explicit PrefixWriter(std::span<const std::uint8_t> lengths);

  void put(std::size_t symbol, BitCursor& out) const { out.put(words_[symbol] & 0xffffu, words_[symbol] >> 16); }
  /// Writes four symbols, at most 44 bits. They are joined in pairs, so that only one of three steps depends on the
  /// pending bits.
  void putFour(std::size_t a, std::size_t b, std::size_t c, std::size_t d, BitCursor& out) const {
    const std::uint32_t wa = words_[a], wb = words_[b], wc = words_[c], wd = words_[d];
    const std::uint64_t ab = (wa & 0xffffu) | std::uint64_t{wb & 0xffffu} << (wa >> 16);
    const std::uint64_t cd = (wc & 0xffffu) | std::uint64_t{wd & 0xffffu} << (wc >> 16);
    const std::uint32_t ab_bits = (wa >> 16) + (wb >> 16), cd_bits = (wc >> 16) + (wd >> 16);
    out.put(ab | cd << ab_bits, ab_bits + cd_bits);
  }

 private:
  std::array<std::uint32_t, kMaxSymbolCount> words_{};  ///< code | length << 16
};

/// Writes a code for one frame, fitted to the counts of its symbols. It always contains symbols 0 and 1.
PrefixWriter putFittedCode(std::span<const std::uint32_t> counts, BitWriter& out);

}  // namespace spindrift::codec
