#include <algorithm>
#include <bit>
#include <cmath>

#include <spindrift/core/half.h>

namespace spindrift::core {
namespace {

constexpr int kMantissaBits = 10;
constexpr int kExponentBias = 15;
constexpr int kDroppedBits = 52 - kMantissaBits;  ///< of a double's mantissa
constexpr double kLeastNormal = 0x1p-14;          ///< smaller numbers are multiples of 2^-24

std::uint32_t bitsOf(double value) {
  const double magnitude = std::abs(roundToHalf(value));
  const std::uint32_t sign = std::signbit(value) ? 0x8000u : 0u;
  if (magnitude < kLeastNormal) return sign | static_cast<std::uint32_t>(magnitude * 0x1p24);
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(magnitude);
  constexpr std::uint64_t kBias = std::uint64_t{1023 - kExponentBias} << kMantissaBits;
  return sign | static_cast<std::uint32_t>((bits >> kDroppedBits) - kBias);
}

}  // namespace

double roundToHalf(double value) {
  const double clamped = std::clamp(value, -kLargestHalf, kLargestHalf);
  if (std::abs(clamped) < kLeastNormal) {
    // The last bit of the sum is that of the half.
    constexpr double kLastBit = 0x1.8p28;
    return std::copysign((clamped + kLastBit) - kLastBit, value);
  }
  std::uint64_t bits = std::bit_cast<std::uint64_t>(clamped);
  constexpr std::uint64_t kBelowHalf = (std::uint64_t{1} << (kDroppedBits - 1)) - 1;
  bits += kBelowHalf + ((bits >> kDroppedBits) & 1);
  return std::bit_cast<double>(bits >> kDroppedBits << kDroppedBits);
}

std::uint32_t packHalves(double low, double high) {
  return bitsOf(low) | bitsOf(high) << 16;
}

}  // namespace spindrift::core
