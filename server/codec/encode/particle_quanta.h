// Particles as the GPU packed them -> what the coder sorts and writes.
#pragma once

#include <cstdint>
#include <span>

#include "particle_cells.h"

namespace spindrift::codec {

/// An item's parts: the low bits of x, z, y from the lowest on; velocity along x, y, z, a signed byte each, then two
/// bits of foam and three of tint.
inline std::uint32_t placeBitsOf(std::uint64_t item) {
  return static_cast<std::uint32_t>(item);
}
inline std::uint32_t attributesOf(std::uint64_t item) {
  return static_cast<std::uint32_t>(item >> 32);
}

/// Three words a particle; keys[i] = 8 * cell + eighth (x, z, y from the highest bit on).
void quantizeParticles(std::span<const std::uint32_t> words, const ParticleScale& scale, const CellGrid& grid,
                       std::span<std::uint32_t> keys, std::span<std::uint64_t> items);

}  // namespace spindrift::codec
