// Decodes packed particles into the words of plain ones, in the quanta of the packed form. The decoder for
// codec/particle_cells.
#pragma once

#include <cstddef>
#include <cstdint>

#include <spindrift/bitstream/format/particle_format.h>

namespace spindrift::codec {

inline constexpr std::uint32_t kParticleReadMaxCount = 4 * 1024 * 1024;
inline constexpr std::size_t kParticleWordBytes = 12;
/// readParticles() may write this many bytes after the last particle.
inline constexpr std::size_t kParticleSlackBytes = 64;

/// Writes `count` particles in the order of the wire, kParticleWordBytes each: positions along x, z, y in quanta (u16),
/// velocity along x, y, z (i8, -127..127), tint (u8, 0..255 in eight steps), foam (u8, in four steps), 0. `out` has
/// room for `count` of them and kParticleSlackBytes; the payload is followed by BitSource::kSlackBytes of 0. False:
/// there are more than kParticleReadMaxCount particles, the grid has more than kCoordinateMaxCount quanta along an axis
/// or kCellMaxCount cells, or the bytes are damaged; the contents of `out` are then undefined.
bool readParticles(const std::uint8_t* payload, std::uint32_t byte_count, std::uint32_t count, const CellGrid& grid,
                   std::uint8_t* out);

}  // namespace spindrift::codec
