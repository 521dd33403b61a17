// Format of residuals in the stream: classes of groups and the fixed codes of residuals, fitted to frames of the
// shipped scenes. Shared by encoder and decoder; residual_coder.h describes the classes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace spindrift::codec {

inline constexpr std::size_t kGroupMaxCount = 64;
inline constexpr std::uint32_t kResidualClassCount = 45;

/// The residuals of a group; those beyond its count are 0.
struct alignas(32) ResidualGroup {
  std::array<std::int16_t, kGroupMaxCount> of{};
};

inline constexpr std::uint32_t kLastSparseClass = 4;
inline constexpr std::uint32_t kLastFourClass = 9;
inline constexpr std::uint32_t kLastPairClass = 12;
inline constexpr std::uint32_t kLastUnshiftedClass = 17;
inline constexpr int kPairLargest = 4;
inline constexpr std::uint32_t kFourEscape = 81;  ///< 3^4
inline constexpr std::uint32_t kPairEscape = 81;  ///< 9^2
/// The class whose code is used for the residuals after an escape of a four or a pair.
inline constexpr std::uint32_t kFourEscapeClass = 13;
inline constexpr std::uint32_t kPairEscapeClass = 15;
inline constexpr std::uint32_t kRawResidualBits = 16;

/// Code of single residuals of a class: symbol = ((r + 2^shift / 2) >> shift) + largest, followed by the low bits of
/// that sum, raw; the symbol 2 * largest + 1 precedes 16 raw bits.
struct SingleCode {
  std::uint32_t coded_as;  ///< the class that the code belongs to
  int largest;
  std::uint32_t shift;
  [[nodiscard]] std::uint32_t escape() const { return 2 * static_cast<std::uint32_t>(largest) + 1; }
};
/// For class 13 and above.
constexpr SingleCode singleCodeOf(std::uint32_t residual_class) {
  constexpr std::array kLargest = {6, 8, 12, 16, 24};
  const std::uint32_t coded_as = residual_class <= kLastUnshiftedClass ? residual_class : 16 + residual_class % 2;
  return {coded_as, kLargest[coded_as - kLastPairClass - 1], (residual_class - coded_as) / 2};
}

/// A group's class: symbol 0 is class 0, 1..17 are the expected class - 8 to + 8, 18 precedes 6 raw bits.
inline constexpr std::uint32_t kClassReach = 8;
inline constexpr std::uint32_t kClassEscape = 2 * kClassReach + 2;
inline constexpr std::uint32_t kRawClassBits = 6;
struct ClassExpectation {
  std::uint32_t expected;
  std::uint32_t code;  ///< index of one of the three codes
};
constexpr ClassExpectation expectClass(std::uint32_t left, std::uint32_t above) {
  if (left == 0 && above == 0) return {kClassReach + 1, 0};
  if (left == 0 || above == 0) return {left + above, 1};
  return {(left + above + 1) / 2, 2};
}
/// A residual of a sparse group: its position, and a bit that is 1 for -1.
inline constexpr std::uint32_t kPlaceBits = 6;
/// Bits of the sum of all residuals at the end of a payload.
inline constexpr std::uint32_t kSumBits = 16;

/// Lengths of the symbols' codes, one base-16 digit each. Fours: r0 + 3 r1 + 9 r2 + 27 r3 with -1 as 0; pairs: r0 + 9
/// r1 with -4 as 0; both with the escape at the end.
inline constexpr std::array<std::string_view, 13> kResidualLengths = {
    "bbbbabbbbb9ba5bbbbbbbbbbbbbbbb86bbbbb5b616b5bbbbb58bbbbbbbbbbbbbbbb5ab9bbbbbabbbb2",
    "bbbb9bbbbb9b948b9bbbbb7bbbbb9b959b6b957515759b6b959b9bbbbb7bbbbb9b849b9bbbbb9bbbb4",
    "abbb8bbbbb9b959b8bbbbb6bbbba9b958b7b856515658b7b859b9abbbb6bbbbb8b849b9bbbbb8bbba4",
    "a9ba8bbbbb8b858a7bbaba6bbbb98b857a6b856515658b6a758b89bbbb6ababb7a758b8bbbbb8ab9a5",
    "a9ba8bbbba8b85897bb9a96bbbba8b85896b856515658b69758b8abbbb69a9bb79858b8abbbb8ab9a5",
    "bbbbbbbbbbbbb9bbbbbbb98bbbbbb9545bbbb9841489bbbb5359bbbbbb89bbbbbbb9bbbbbbbbbbbbb9",
    "bbbbbbbbbbbbbabbbbbba98abbbbb9534abbba83238abbba4358bbbbba89abbbbbbabbbbbbbbbbbbba",
    "bbbbbbbbbbbbabbbbbbb8778bbbba74348bbbb73337bbbb84346abbbb8778bbbbbbbabbbbbbbbbbbba",
    "a98642223589a9",
    "a987653232356789a9",
    "bbba988654333324567899bbb9",
    "bbbbba998775433434334567899aabbbbb",
    "bbbbbbbbba98877665544444444344556677889aabbbbbbbbb",
};
inline constexpr std::array<std::string_view, 3> kClassStepLengths = {
    "1256765566888775786",
    "1766665443556666777",
    "4977665422345567896",
};
constexpr std::uint8_t codeLengthOf(char digit) {
  return static_cast<std::uint8_t>(digit >= 'a' ? digit - 'a' + 10 : digit - '0');
}

}  // namespace spindrift::codec
