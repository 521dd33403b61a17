#include <algorithm>
#include <cmath>

#include <spindrift/core/half.h>

namespace spindrift::core {
namespace {

constexpr int kMantissaBits = 10;
constexpr int kLeastExponent = -14;  ///< of a number with all its bits
constexpr int kExponentBias = 15;

/// Exponent of the half's last bit.
int lastBit(double value) {
  return std::max(std::ilogb(value), kLeastExponent) - kMantissaBits;
}

std::uint32_t bitsOf(double value) {
  const double magnitude = std::abs(roundToHalf(value));
  const std::uint32_t sign = std::signbit(value) ? 0x8000u : 0u;
  if (magnitude == 0.0) return sign;
  const int last = lastBit(magnitude);
  const auto mantissa = static_cast<std::uint32_t>(std::ldexp(magnitude, -last));
  const bool is_normal = mantissa >= 1u << kMantissaBits;
  const auto exponent = static_cast<std::uint32_t>(is_normal ? last + kMantissaBits + kExponentBias : 0);
  return sign | exponent << kMantissaBits | (mantissa & ((1u << kMantissaBits) - 1));
}

}  // namespace

double roundToHalf(double value) {
  if (value == 0.0) return value;
  const double clamped = std::clamp(value, -kLargestHalf, kLargestHalf);
  const int last = lastBit(clamped);
  return std::clamp(std::ldexp(std::nearbyint(std::ldexp(clamped, -last)), last), -kLargestHalf, kLargestHalf);
}

std::uint32_t packHalves(double low, double high) {
  return bitsOf(low) | bitsOf(high) << 16;
}

}  // namespace spindrift::core
