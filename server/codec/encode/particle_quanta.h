// Converts particles as packed by the GPU to the keys and items that the coder sorts and writes.
#pragma once

#include <cstdint>
#include <span>

#include "particle_cells.h"

namespace spindrift::codec {

/// An item holds, from the lowest bit: the low bits of x, z, y; velocity along x, y, z, one signed byte each; two bits
/// of foam, three of tint.
inline std::uint32_t placeBitsOf(std::uint64_t item) {
  return static_cast<std::uint32_t>(item);
}
inline std::uint32_t attributesOf(std::uint64_t item) {
  return static_cast<std::uint32_t>(item >> 32);
}

/// Three words per particle; keys[i] = 8 * cell + eighth (x, z, y from the highest bit on).
void quantizeParticles(std::span<const std::uint32_t> words, const ParticleScale& scale, const CellGrid& grid,
                       std::span<std::uint32_t> keys, std::span<std::uint64_t> items);

}  // namespace spindrift::codec
