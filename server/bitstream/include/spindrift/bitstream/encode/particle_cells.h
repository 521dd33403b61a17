// Codes particles as the contents of the cells of a grid. A cell is cut into eighths, whose counts replace the highest
// bit of each coordinate. The order of particles carries no information, so the counts cost less than those bits. Empty
// cells cost a run length. The other bits of a position are nearly random and are written unchanged.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <spindrift/bitstream/encode/particle_order.h>
#include <spindrift/bitstream/encode/residual_coder.h>
#include <spindrift/bitstream/format/particle_format.h>

namespace spindrift::codec {

/// Conversion of the words of core::ParticleView to quanta: place = u16 * scale along each axis, velocity = i8 *
/// speed_scale.
struct ParticleScale {
  std::array<float, 3> place{};
  float speed = 0.0f;  ///< 0..1
};

/// Converts particles of three words each: keys[i] = 8 * cell + eighth (x, z, y from the highest bit on). An item
/// holds, from the lowest bit: the low bits of x, z, y; from bit 32 the velocity along x, y, z, one signed byte each;
/// two bits of foam, three of tint.
void quantizeParticles(std::span<const std::uint32_t> words, const ParticleScale& scale, const CellGrid& grid,
                       std::span<std::uint32_t> keys, std::span<std::uint64_t> items);

/// Sorts the particles into the order of the wire and writes them: cells, positions within the cells, then in groups of
/// 64 particles the velocities along x, y, z, foam, tint. Reuses its memory.
class ParticleCellsEncoder {
 public:
  /// Three words per particle, as in core::ParticleView.
  void encode(std::span<const std::uint32_t> words, const ParticleScale& scale, const CellGrid& grid,
              ResidualEncoder& out);

 private:
  void putCells(BitWriter& out) const;
  void putPlaces(std::uint32_t bit_count, BitWriter& out) const;
  void putAttributes(ResidualEncoder& out) const;

  std::vector<std::uint32_t> keys_;
  std::vector<std::uint64_t> items_;
  ParticleOrder order_;
};

}  // namespace spindrift::codec
