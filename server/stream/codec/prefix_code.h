// Prefix codes of at most 11 bits, canonical: the lengths say everything. Codes are numbered by length, then symbol,
// and stand in the stream with their highest bit first, as in deflate (RFC 1951, 3.2.2).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "bit_stream.h"

namespace spindrift::stream {

inline constexpr std::uint32_t kMaxCodeBits = 11;
inline constexpr std::size_t kMaxSymbolCount = 256;

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

/// A code to read with.
class PrefixReader {
 public:
  /// Nothing where the lengths are not those of a code that every sequence of bits has a meaning in.
  static std::optional<PrefixReader> create(std::span<const std::uint8_t> lengths);

  std::uint32_t get(BitReader& in) const {
    const std::uint32_t slot = slots_[in.peek() & ((1u << kMaxCodeBits) - 1)];
    in.take(slot >> 8);
    return slot & 0xffu;
  }

 private:
  std::array<std::uint16_t, 1 << kMaxCodeBits> slots_{};  ///< by the next bits: symbol | length << 8
};

/// The lengths that fit the counts, at most kMaxSymbolCount; at least two of them above 0.
void fitLengths(std::span<const std::uint32_t> counts, std::span<std::uint8_t> lengths);

/// A code for one frame, sent along with it: fitted to the counts of its symbols. Symbols 0 and 1 are in it in any
/// case.
PrefixWriter putFittedCode(std::span<const std::uint32_t> counts, BitWriter& out);
/// The same code; nothing where the bits are damaged.
std::optional<PrefixReader> getFittedCode(std::size_t symbol_count, BitReader& in);

}  // namespace spindrift::stream
