// The fixed codes of residuals, fitted to the shipped scenes' frames. The reader in TypeScript has the same strings.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "prefix_code.h"

namespace spindrift::stream {

inline constexpr std::uint32_t kLastSparseClass = 4;
inline constexpr std::uint32_t kLastFourClass = 9;
inline constexpr std::uint32_t kLastPairClass = 12;
inline constexpr std::uint32_t kLastUnshiftedClass = 17;
inline constexpr int kPairLargest = 4;
inline constexpr std::uint32_t kFourEscape = 81;  ///< 3^4
inline constexpr std::uint32_t kPairEscape = 81;  ///< 9^2
/// Whose code the residuals behind an escape of four or of two stand in.
inline constexpr std::uint32_t kFourEscapeClass = 13;
inline constexpr std::uint32_t kPairEscapeClass = 15;
inline constexpr std::uint32_t kRawResidualBits = 16;

/// How single residuals of a class are coded: symbol = ((r + 2^shift / 2) >> shift) + largest, and the low bits of that
/// sum raw; the symbol 2 * largest + 1 stands before 16 raw bits.
struct SingleCode {
  std::uint32_t coded_as;  ///< the class that the code belongs to
  int largest;
  std::uint32_t shift;
  [[nodiscard]] std::uint32_t escape() const { return 2 * static_cast<std::uint32_t>(largest) + 1; }
};
/// From class 13 on.
constexpr SingleCode singleCodeOf(std::uint32_t residual_class) {
  constexpr std::array kLargest = {6, 8, 12, 16, 24};
  const std::uint32_t coded_as = residual_class <= kLastUnshiftedClass ? residual_class : 16 + residual_class % 2;
  return {coded_as, kLargest[coded_as - kLastPairClass - 1], (residual_class - coded_as) / 2};
}

/// A group's class: symbol 0 is class 0, 1..17 are the expected class - 8 to + 8, 18 stands before 6 raw bits.
inline constexpr std::uint32_t kClassReach = 8;
inline constexpr std::uint32_t kClassEscape = 2 * kClassReach + 2;
inline constexpr std::uint32_t kRawClassBits = 6;
struct ClassExpectation {
  std::uint32_t expected;
  std::uint32_t code;  ///< which of the three
};
constexpr ClassExpectation expectClass(std::uint32_t left, std::uint32_t above) {
  if (left == 0 && above == 0) return {kClassReach + 1, 0};
  if (left == 0 || above == 0) return {left + above, 1};
  return {(left + above + 1) / 2, 2};
}

/// Writer or reader of every code.
template <typename Code>
struct ResidualCodes {
  std::vector<Code> of_class;       ///< [c - 5], c = 5..17
  std::vector<Code> of_class_step;  ///< three
  [[nodiscard]] const Code& ofClass(std::uint32_t c) const { return of_class[c - kLastSparseClass - 1]; }
};
const ResidualCodes<PrefixWriter>& residualWriters();
const ResidualCodes<PrefixReader>& residualReaders();

}  // namespace spindrift::stream
