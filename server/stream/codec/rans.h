// Range variant of asymmetric numeral systems (J. Duda, arXiv:1311.2540): symbols at close to their entropy, a
// multiplication each. Four lanes take turns, so that a reader or writer can work on several symbols at a time.
//
// Stream: the lanes' states (u32 each, little endian), then u16 words. A lane with state x and a table of 4,096 slots
// reads symbol s of slot x % 4096, x := frequency(s) * (x / 4096) + slot - start(s), and where x < 65536 then takes a
// word: x := x * 65536 + word. All lanes end at 65536, with no word left.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::stream {

inline constexpr int kSlotBits = 12;
inline constexpr std::uint32_t kSlotCount = 1u << kSlotBits;
inline constexpr std::uint32_t kLaneCount = 4;

/// How often each symbol is expected, of kSlotCount. One that is expected 0 times is not in the table.
class SymbolTable {
 public:
  /// At most 256 frequencies, which sum up to kSlotCount, each below it.
  explicit SymbolTable(std::span<const std::uint32_t> frequencies);

  struct Range {
    std::uint32_t start;
    std::uint32_t frequency;
  };
  [[nodiscard]] Range rangeOf(std::size_t symbol) const { return ranges_[symbol]; }
  /// symbol | frequency << 8 | slot - start << 20.
  [[nodiscard]] std::uint32_t slot(std::uint32_t slot) const { return slots_[slot]; }

 private:
  std::vector<Range> ranges_;
  std::array<std::uint32_t, kSlotCount> slots_;
};

/// Collects symbols in the order in which they will be read; the coder itself runs backward over them.
class RansEncoder {
 public:
  void put(const SymbolTable& table, std::size_t symbol, std::uint32_t lane) {
    const SymbolTable::Range range = table.rangeOf(symbol);
    symbols_.push_back(range.frequency | range.start << 12 | lane << 24);
  }
  /// The stream, appended to `out`. The encoder is empty afterwards and keeps its memory.
  void finish(core::Bytes& out);

 private:
  std::vector<std::uint32_t> symbols_;
  std::vector<std::uint16_t> words_;
};

/// Reads a stream; past its end it goes on with zeros, and isAtEnd() is false then.
class RansDecoder {
 public:
  explicit RansDecoder(core::ByteView stream);

  std::uint32_t get(const SymbolTable& table, std::uint32_t lane) {
    std::uint32_t& x = states_[lane];
    const std::uint32_t entry = table.slot(x % kSlotCount);
    x = (entry >> 8 & (kSlotCount - 1)) * (x >> kSlotBits) + (entry >> 20);
    if (x < kLow) x = x << 16 | nextWord();
    return entry & 0xffu;
  }
  /// Whether the stream was read to its last word and nothing is left over.
  [[nodiscard]] bool isAtEnd() const;

  static constexpr std::uint32_t kLow = 1u << 16;

 private:
  std::uint32_t nextWord();

  core::ByteView stream_;
  std::size_t at_ = 0;
  std::array<std::uint32_t, kLaneCount> states_{};
};

}  // namespace spindrift::stream
