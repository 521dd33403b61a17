// Decodes packed particles into the words of plain ones, in the quanta of the packed form. The decoder for
// codec/particle_cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

/// Values from a frame's header. readParticles() refuses values beyond the bounds.
struct ParticleShape {
  std::uint32_t count = 0;                     ///< at most kParticleReadMaxCount
  std::array<std::uint32_t, 3> cells_count{};  ///< along x, y, z; cells << offset_bits at most 2^16, in all 2^24
  std::uint32_t offset_bits = 0;               ///< 1..8
};
inline constexpr std::uint32_t kParticleReadMaxCount = 4 * 1024 * 1024;
inline constexpr std::size_t kParticleWordBytes = 12;
/// readParticles() may write this many bytes after the last particle.
inline constexpr std::size_t kParticleSlackBytes = 64;

/// Writes particles in the order of the wire, kParticleWordBytes each: positions along x, z, y in quanta (u16),
/// velocity along x, y, z (i8, -127..127), tint (u8, 0..255 in eight steps), foam (u8, in four steps), 0. `out` has
/// room for `count` of them and kParticleSlackBytes; the payload is followed by BitSource::kSlackBytes of 0. False: the
/// shape is beyond the bounds or the bytes are damaged; the contents of `out` are then undefined.
bool readParticles(const std::uint8_t* payload, std::uint32_t byte_count, const ParticleShape& shape,
                   std::uint8_t* out);

}  // namespace spindrift::codec
