// What prediction left over, in groups of up to 64 neighbours: a group's class says how large its residuals are, and
// each class has a fixed table. Nothing is learned on the way, so groups of any frame cost the same work.
//
// Classes: 0, all are zero and nothing follows; c = 1..17, mean magnitude about 2^((c - 13) / 2); c = 18..44 likewise,
// of which the lowest (c - 16) / 2 bits stand in the raw bits and the rest is coded with the table of 2.8 or 4. Tables
// are those of a normal distribution sampled at whole numbers (c >= 18: half-way between), with one slot at least for
// every value of their range and one for everything else, which stands in the raw bits as 16 bits.
#pragma once

#include <cstdint>
#include <span>

#include <spindrift/core/bytes.h>

#include "bit_stream.h"
#include "rans.h"

namespace spindrift::stream {

inline constexpr std::size_t kGroupMaxCount = 64;
inline constexpr std::uint32_t kResidualClassCount = 45;

/// Writes two streams: what the coder makes smaller, and raw bits.
class ResidualEncoder {
 public:
  /// Up to kGroupMaxCount residuals. `left` and `above`: the classes of the groups before it in two directions, 0 where
  /// there is none; along a line both are the one before. Returns the group's class.
  std::uint32_t putGroup(std::span<const std::int16_t> residuals, std::uint32_t left, std::uint32_t above);
  /// Any symbol of another table, in turn with the groups.
  void put(const SymbolTable& table, std::size_t symbol) { coder_.put(table, symbol, 0); }
  void putRaw(std::uint32_t value, int bit_count) { raw_.put(value, bit_count); }

  /// Appends: u32 bytes of the coded stream, the coded stream, the raw bits. Empty afterwards.
  void finish(core::Bytes& out);

 private:
  void putClass(std::uint32_t group_class, std::uint32_t left, std::uint32_t above);

  RansEncoder coder_;
  BitWriter raw_;
};

/// Reads what ResidualEncoder wrote, in the same order.
class ResidualDecoder {
 public:
  /// `bytes` to its end; an impossible length reads as an empty stream, and isAtEnd() is false then.
  explicit ResidualDecoder(core::ByteView bytes);

  std::uint32_t getGroup(std::span<std::int16_t> residuals, std::uint32_t left, std::uint32_t above);
  std::uint32_t get(const SymbolTable& table) { return coder_.get(table, 0); }
  std::uint32_t getRaw(int bit_count) { return raw_.get(bit_count); }

  /// Whether both streams were read to their ends, no more and no less: else the bytes are damaged.
  [[nodiscard]] bool isAtEnd() const { return coder_.isAtEnd() && raw_.isAtEnd(); }

 private:
  struct Parts {
    core::ByteView coded, raw;
  };
  static Parts split(core::ByteView bytes);
  explicit ResidualDecoder(const Parts& parts) : coder_(parts.coded), raw_(parts.raw) {}
  std::uint32_t getClass(std::uint32_t left, std::uint32_t above);

  RansDecoder coder_;
  BitReader raw_;
};

}  // namespace spindrift::stream
