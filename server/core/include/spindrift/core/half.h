// Numbers of 16 bits (IEEE 754 binary16), as unpackHalf2x16 of GLSL reads them: for tables that a shader reads often.
#pragma once

#include <cstdint>

namespace spindrift::core {

/// Largest finite half.
inline constexpr double kLargestHalf = 65504.0;

/// Returns the nearest half, ties to even: 11 significant bits from 6.1e-5 on, multiples of 6.0e-8 below. Larger values
/// than kLargestHalf become kLargestHalf. Precondition: not a NaN.
[[nodiscard]] double roundToHalf(double value);

/// Bits of two numbers, the first in the low half of the word. Both are rounded as by roundToHalf().
[[nodiscard]] std::uint32_t packHalves(double low, double high);

}  // namespace spindrift::core
