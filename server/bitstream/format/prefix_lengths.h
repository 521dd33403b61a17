// Canonical prefix codes from their lengths: codes are numbered by length, then by symbol, and written highest bit
// first, as in deflate (RFC 1951, 3.2.2). Shared by encoder and decoder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace spindrift::codec {

inline constexpr std::uint32_t kMaxCodeBits = 11;
inline constexpr std::size_t kMaxSymbolCount = 256;
/// Bits per length of a symbol's code, where the payload contains the code.
inline constexpr std::uint32_t kLengthBits = 4;

/// Calls use(symbol, code, length) for each symbol of a code; `code` is bit-reversed. False: the lengths form no
/// complete code.
template <typename Use>
constexpr bool forEachCode(std::span<const std::uint8_t> lengths, Use use) {
  std::array<std::uint32_t, kMaxCodeBits + 1> count_of{};
  for (const std::uint8_t length : lengths) {
    if (length > kMaxCodeBits) return false;
    ++count_of[length];
  }
  std::array<std::uint32_t, kMaxCodeBits + 1> next{};
  std::uint32_t code = 0;
  count_of[0] = 0;
  for (std::uint32_t length = 1; length <= kMaxCodeBits; ++length) {
    code = (code + count_of[length - 1]) << 1;
    next[length] = code;
  }
  if (code + count_of[kMaxCodeBits] != 1u << kMaxCodeBits) return false;
  for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    const std::uint32_t length = lengths[symbol];
    if (length == 0) continue;
    std::uint32_t reversed = 0;
    for (std::uint32_t bit = 0, c = next[length]++; bit < length; ++bit, c >>= 1) reversed = reversed << 1 | (c & 1u);
    use(symbol, reversed, length);
  }
  return true;
}

}  // namespace spindrift::codec
