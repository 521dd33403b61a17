// The encoder of residual_coder.h. It is inlined into callers that write many groups, so that pending bits stay in
// registers and the caller decides for which processor it is compiled.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <vector>

#include <spindrift/bitstream/encode/residual_coder.h>

#include "format/short_vectors.h"
#include "prefix_code.h"
#include "processor.h"

namespace spindrift::codec {

/// A group in registers, with operations on all its residuals at once.
class GroupRows {
 public:
  /// Loads eight rows of eight residuals, `stride` apart.
  SPINDRIFT_INLINE explicit GroupRows(const std::int16_t* first, std::size_t stride = 8) {
    for (std::size_t j = 0; j < 8; ++j) rows_[j] = loadVector<Shorts>(first + j * stride);
  }
  SPINDRIFT_INLINE void store(ResidualGroup& out) const {
    for (std::size_t j = 0; j < 8; ++j) storeVector(out.of.data() + 8 * j, rows_[j]);
  }
  [[nodiscard]] SPINDRIFT_INLINE bool areZero() const {
    Shorts any = rows_[0];
    for (std::size_t j = 1; j < 8; ++j) any |= rows_[j];
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(any);
    return (halves[0] | halves[1]) == 0;
  }
  /// The magnitude of -32768 counts as 32767.
  SPINDRIFT_INLINE void sumUp(std::uint32_t& magnitudes_sum, int& largest_magnitude, int& signed_sum) const {
    const Shorts ones{1, 1, 1, 1, 1, 1, 1, 1};
    const auto larger = [](Shorts a, Shorts b) { return a > b ? a : b; };
    Words sum{}, plain{};
    Shorts largest{};
    for (const Shorts& r : rows_) {
      const Shorts magnitude = magnitudesOf(r);
      sum += sumsOfProducts(magnitude, ones);
      plain += sumsOfProducts(r, ones);
      largest = larger(largest, magnitude);
    }
    // Both sums in one vector, two halves each.
    Words sums = interleaveLow(sum, plain) + interleaveHigh(sum, plain);
    sums += __builtin_shufflevector(sums, sums, 2, 3, 0, 1);
    largest = larger(largest, __builtin_shufflevector(largest, largest, 4, 5, 6, 7, 0, 1, 2, 3));
    largest = larger(largest, __builtin_shufflevector(largest, largest, 2, 3, 0, 1, 2, 3, 0, 1));
    magnitudes_sum = sums[0];
    signed_sum = static_cast<std::int32_t>(sums[1]);
    largest_magnitude = std::max(largest[0], largest[1]);
  }
  [[nodiscard]] SPINDRIFT_INLINE int sum() const {
    const Shorts ones{1, 1, 1, 1, 1, 1, 1, 1};
    Words sum{};
    for (const Shorts& r : rows_) sum += sumsOfProducts(r, ones);
    sum += __builtin_shufflevector(sum, sum, 2, 3, 0, 1);
    return static_cast<std::int32_t>(sum[0] + sum[1]);
  }
  /// Bit k: the magnitude of residual k exceeds `largest`. -32768 counts as 32767.
  [[nodiscard]] SPINDRIFT_INLINE std::uint64_t beyond(int largest) const {
    const Shorts bound = Shorts{} + static_cast<std::int16_t>(largest);
    const auto isBeyond = [&](Shorts r) { return Shorts(magnitudesOf(r) > bound); };
    std::uint64_t out = 0;
    for (std::size_t j = 0; j < 8; j += 2)
      out |= std::uint64_t{signBitsOf(isBeyond(rows_[j]), isBeyond(rows_[j + 1]))} << (8 * j);
    return out;
  }
  /// Bit k of `not_zero` and `below_zero`: residual k is not 0, or negative.
  SPINDRIFT_INLINE void signs(std::uint64_t& not_zero, std::uint64_t& below_zero) const {
    not_zero = below_zero = 0;
    for (std::size_t j = 0; j < 8; j += 2) {
      const Shorts a = rows_[j], b = rows_[j + 1];
      not_zero |= std::uint64_t{signBitsOf(Shorts(a != Shorts{}), Shorts(b != Shorts{}))} << (8 * j);
      below_zero |= std::uint64_t{signBitsOf(a, b)} << (8 * j);
    }
  }
  /// Computes one symbol per four residuals, all from -1 to 1; out[4 i] and out[4 i + 2] belong to row i.
  SPINDRIFT_INLINE void symbolsOfFours(std::uint32_t* out) const {
    const Shorts factors{1, 3, 9, 27, 1, 3, 9, 27};
    for (std::size_t j = 0; j < 8; ++j) {
      const Words pairs = sumsOfProducts(rows_[j], factors);
      storeVector(out + 4 * j, pairs + __builtin_shufflevector(pairs, pairs, 1, 1, 3, 3) + (1u + 3 + 9 + 27));
    }
  }
  /// Computes one symbol per two residuals, all from -4 to 4.
  SPINDRIFT_INLINE void symbolsOfPairs(std::uint32_t* out) const {
    const Shorts factors{1, 9, 1, 9, 1, 9, 1, 9};
    for (std::size_t j = 0; j < 8; ++j) storeVector(out + 4 * j, sumsOfProducts(rows_[j], factors) + (4u + 36));
  }

 private:
  Shorts rows_[8];
};

/// Returns the class from 5 on whose mean magnitude is nearest to sum / count.
SPINDRIFT_INLINE std::uint32_t meanClassOf(std::uint32_t sum, std::size_t count) {
  const std::uint64_t whole = std::uint64_t{sum} * 1024;
  const std::uint64_t scaled = count == kGroupMaxCount ? whole : whole * kGroupMaxCount / count;  // 65536 * mean
  const int bits = static_cast<int>(std::bit_width(scaled)) - 1;
  const std::uint64_t thousands = scaled * 1000 >> bits;  // from 1000 to 1999
  const int doubled_log2 = 2 * (bits - 16) + (thousands > 1189 ? 1 : 0) + (thousands > 1682 ? 1 : 0);
  return static_cast<std::uint32_t>(std::clamp(doubled_log2 + 13, 5, static_cast<int>(kResidualClassCount) - 1));
}

/// The writers of all fixed codes.
struct ResidualWriters {
  std::vector<PrefixWriter> of_class;       ///< [c - 5], c = 5..17
  std::vector<PrefixWriter> of_class_step;  ///< one per code of the class step: three
  [[nodiscard]] const PrefixWriter& ofClass(std::uint32_t c) const { return of_class[c - kLastSparseClass - 1]; }
};
const ResidualWriters& residualWriters();

/// Writes groups; made by ResidualEncoder::begin() and handed back with end().
struct GroupWriter {
  /// Room for a class and 64 residuals with an escape each.
  static constexpr std::size_t kGroupMaxBytes = 4 + kGroupMaxCount * 5;

  const ResidualWriters& codes;
  BitCursor out;
  std::uint32_t residual_sum = 0;

  /// Writes one group. `left` and `above`: the classes of the neighbouring groups, 0 at the edge; along a line both are
  /// the class of the group before. Returns the group's class.
  SPINDRIFT_INLINE std::uint32_t putGroup(const GroupRows& rows, std::size_t count, std::uint32_t left,
                                          std::uint32_t above) {
    assert(count >= 1 && count <= kGroupMaxCount);
    return rows.areZero() ? putZeros(left, above) : putRows(rows, count, left, above);
  }
  /// Writes a group of one residual; `before`: the class of the group before it.
  SPINDRIFT_INLINE std::uint32_t putOne(std::int16_t residual, std::uint32_t before) {
    if (residual == 0) return putZeros(before, before);
    const auto magnitude = static_cast<std::uint32_t>(std::min(std::abs(int{residual}), 32767));
    const std::uint32_t group_class = magnitude == 1 ? 1 : meanClassOf(magnitude, 1);
    putClass(group_class, before, before);
    if (magnitude == 1)
      out.put(residual < 0 ? 1u << kPlaceBits : 0, kPlaceBits + 1);
    else
      putSingles(&residual, 1, group_class);  // a single 2 already has class 15
    out.flush();
    residual_sum += static_cast<std::uint32_t>(int{residual});
    return group_class;
  }

 private:
  SPINDRIFT_INLINE std::uint32_t putZeros(std::uint32_t left, std::uint32_t above) {
    codes.of_class_step[expectClass(left, above).code].put(0, out);
    out.flush();
    return 0;
  }

  SPINDRIFT_INLINE std::uint32_t putRows(const GroupRows& rows, std::size_t count, std::uint32_t left,
                                         std::uint32_t above) {
    std::uint32_t sum = 0;
    int largest = 0, signed_sum = 0;
    rows.sumUp(sum, largest, signed_sum);
    residual_sum += static_cast<std::uint32_t>(signed_sum);
    const std::uint32_t c = largest <= 1 && sum <= kLastSparseClass ? sum : meanClassOf(sum, count);
    putClass(c, left, above);
    if (c <= kLastSparseClass) {
      putPlaces(rows);
      return c;
    }
    out.flush();
    if (c <= kLastFourClass) {
      putJoint<4, 1>(rows, count, largest > 1, codes.ofClass(c), kFourEscapeClass);
    } else if (c <= kLastPairClass) {
      putJoint<2, kPairLargest>(rows, count, largest > kPairLargest, codes.ofClass(c), kPairEscapeClass);
    } else {
      ResidualGroup residuals;
      rows.store(residuals);
      putSingles(residuals.of.data(), count, c);
    }
    return c;
  }

  SPINDRIFT_INLINE void putClass(std::uint32_t group_class, std::uint32_t left, std::uint32_t above) {
    const ClassExpectation expectation = expectClass(left, above);
    const PrefixWriter& code = codes.of_class_step[expectation.code];
    const std::uint32_t step = group_class + kClassReach + 1 - expectation.expected;
    if (step >= 1 && step < kClassEscape) {
      code.put(step, out);
    } else {
      code.put(kClassEscape, out);
      out.put(group_class, kRawClassBits);
    }
  }

  /// Writes the positions and signs of at most kLastSparseClass residuals that are not 0, after the class: less than 56
  /// bits.
  SPINDRIFT_INLINE void putPlaces(const GroupRows& rows) {
    std::uint64_t not_zero = 0, below_zero = 0;
    for (rows.signs(not_zero, below_zero); not_zero != 0; not_zero &= not_zero - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(not_zero));
      out.put(k | static_cast<std::uint32_t>(below_zero >> k & 1) << kPlaceBits, kPlaceBits + 1);
    }
    out.flush();
  }

  /// Writes the residuals as fours (Count 4) or pairs (Count 2).
  template <std::size_t Count, int Largest>
  SPINDRIFT_INLINE void putJoint(const GroupRows& rows, std::size_t count, bool has_larger, const PrefixWriter& code,
                                 std::uint32_t escape_class) {
    static_assert(kFourEscape == kPairEscape);
    std::uint32_t symbols[kGroupMaxCount / 2];
    if constexpr (Count == 4)
      rows.symbolsOfFours(symbols);
    else
      rows.symbolsOfPairs(symbols);
    const std::uint64_t larger = has_larger ? rows.beyond(Largest) : 0;
    ResidualGroup residuals;
    if (has_larger) rows.store(residuals);
    constexpr std::uint64_t kSymbol = (std::uint64_t{1} << Count) - 1,
                            kFourSymbols = (std::uint64_t{1} << 4 * Count) - 1;
    for (std::size_t i = 0; i < count; i += 4 * Count) {
      if ((larger >> i & kFourSymbols) == 0 && i + 4 * Count <= count) {
        code.putFour(symbols[i / 2], symbols[(i + Count) / 2], symbols[(i + 2 * Count) / 2],
                     symbols[(i + 3 * Count) / 2], out);
        out.flush();
        continue;
      }
      for (std::size_t k = i; k < std::min(i + 4 * Count, count); k += Count) {
        const bool is_escape = (larger >> k & kSymbol) != 0;
        code.put(is_escape ? kFourEscape : symbols[k / 2], out);
        out.flush();
        if (is_escape) putSingles(residuals.of.data() + k, Count, escape_class);
      }
    }
  }

  SPINDRIFT_INLINE void putSingles(const std::int16_t* residuals, std::size_t count, std::uint32_t as_class) {
    const SingleCode single = singleCodeOf(as_class);
    const PrefixWriter& code = codes.ofClass(single.coded_as);
    for (std::size_t i = 0; i < count; ++i) {
      const int raised = residuals[i] + (1 << single.shift >> 1);
      const auto symbol = static_cast<std::uint32_t>((raised >> single.shift) + single.largest);
      if (symbol < single.escape()) {
        code.put(symbol, out);
        out.put(static_cast<std::uint32_t>(raised) & ((1u << single.shift) - 1), single.shift);
      } else {
        code.put(single.escape(), out);
        out.put(static_cast<std::uint16_t>(residuals[i]), kRawResidualBits);
      }
      if (i % 2 != 0) out.flush();
    }
    out.flush();
  }
};

}  // namespace spindrift::codec
