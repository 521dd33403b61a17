// Format of packed objects in the water: what is known of each, and how its pose is predicted. Integers only, so that
// every client computes the same. Shared by encoder and decoder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

inline constexpr std::uint32_t kFloaterMaxCount = 1024;
/// Largest magnitude of a coordinate [quanta], and bounds of the quantum. [m]
inline constexpr std::int32_t kFloaterMaxPlace = 1 << 24;
inline constexpr double kFloaterMinQuantum_m = 1e-6;
inline constexpr double kFloaterMaxQuantum_m = 0.05;
/// Parts of a quaternion are integers, of which 2^rotation_bits is 1.
inline constexpr std::uint32_t kRotationMinBits = 6;
inline constexpr std::uint32_t kRotationMaxBits = 13;
/// Bound of the share of the motion that is expected to continue, in units of 1 / 256.
inline constexpr std::uint32_t kMotionWeightMax = 512;

/// An object, with the bytes of floaters_fixed28: its coordinates in quanta instead of millimetres, its quaternion in
/// units of 2^-rotation_bits.
struct FloaterRecord {
  std::uint32_t id = 0;
  std::array<std::int32_t, 3> place{};  ///< x, y, z
  std::array<std::int16_t, 4> turn{};   ///< x, y, z, w
  std::uint16_t size_cm = 0;
  std::uint8_t kind = 0;
  std::uint8_t flags = 0;
};
static_assert(sizeof(FloaterRecord) == 28);

/// The motion of an object, from which its next pose is predicted.
struct FloaterMotion {
  std::array<std::int32_t, 3> place{};  ///< change since the frame before
  std::array<std::int16_t, 4> turn{};   ///< likewise, with the signs of the newer quaternion
  /// Part of the quaternion that is not sent: not below 0, because the others with their signs give it.
  std::uint8_t derived = 0;
};

/// The objects of a frame.
struct FloaterList {
  std::uint32_t count = 0;
  std::array<FloaterRecord, kFloaterMaxCount> records;
  std::array<FloaterMotion, kFloaterMaxCount> motions;
};

constexpr std::int32_t shareOf(std::int32_t motion, std::uint32_t weight) {
  return static_cast<std::int32_t>((std::int64_t{motion} * weight + 128) >> 8);
}

/// A quaternion predicted for a frame in which the part `derived` is not below 0.
struct PredictedTurn {
  std::array<std::int32_t, 4> turn{};  ///< as predicted
  std::array<std::int32_t, 4> from{};  ///< the one before, with the signs that the new one will have
};
constexpr PredictedTurn predictTurn(const FloaterRecord& record, const FloaterMotion& motion, std::uint32_t derived,
                                    std::uint32_t weight) {
  // A quaternion and its negative are the same rotation.
  const std::int32_t sign = record.turn[derived] < 0 ? -1 : 1;
  PredictedTurn out;
  for (std::size_t k = 0; k < 4; ++k) {
    out.from[k] = sign * record.turn[k];
    out.turn[k] = out.from[k] + shareOf(sign * motion.turn[k], weight);
  }
  return out;
}

/// The parts of a quaternion that are sent: the k-th of the three.
constexpr std::uint32_t sentPart(std::uint32_t k, std::uint32_t derived) {
  return k < derived ? k : k + 1;
}

/// Returns the part of a unit quaternion that the three others leave, rounded down; -1 if they are longer than 1.
constexpr std::int32_t derivedPart(const std::array<std::int16_t, 4>& turn, std::uint32_t derived,
                                   std::uint32_t rotation_bits) {
  std::int64_t rest = std::int64_t{1} << (2 * rotation_bits);
  for (std::uint32_t k = 0; k < 4; ++k) {
    if (k != derived) rest -= std::int64_t{turn[k]} * turn[k];
  }
  if (rest < 0) return -1;
  std::int32_t root = 0;
  for (std::int32_t bit = 1 << rotation_bits; bit > 0; bit >>= 1) {
    if (std::int64_t{root + bit} * (root + bit) <= rest) root += bit;
  }
  return root;
}

}  // namespace spindrift::codec
