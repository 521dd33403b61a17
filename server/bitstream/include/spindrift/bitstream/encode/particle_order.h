// Sorts particles into the order of the wire: by cell, then by eighth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <spindrift/bitstream/format/particle_format.h>

namespace spindrift::codec {

/// A cell with particles.
struct OccupiedCell {
  std::uint32_t gap = 0;     ///< empty cells before it
  std::uint16_t halves = 0;  ///< particles in its eighths, two bits each, kManyCount at most
};

/// Reuses its memory from frame to frame.
class ParticleOrder {
 public:
  /// keys[i]: 8 * cell + eighth of particle i; items[i]: its data. Equal keys keep their order.
  void sort(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items, std::uint64_t cell_count);

  [[nodiscard]] std::span<const std::uint64_t> items() const { return items_; }
  [[nodiscard]] std::span<const OccupiedCell> cells() const { return cells_; }
  /// For each eighth with kManyCount particles or more: the number above kManyCount, in the order of the eighths.
  [[nodiscard]] std::span<const std::uint32_t> extras() const { return extras_; }

 private:
  bool sortByCounting(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                      std::uint64_t cell_count);
  void sortByDigits(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                    std::uint64_t cell_count);

  struct Entry {
    std::uint32_t key;
    std::uint32_t particle;
  };
  std::vector<std::uint64_t> items_;
  std::vector<OccupiedCell> cells_;
  std::vector<std::uint32_t> extras_;
  /// Number of particles in each eighth of a cell, one byte each; later the number of particles before it. All zero
  /// between two frames; the size is a multiple of 64.
  std::vector<std::uint64_t> counts_;
  std::vector<std::uint32_t> begins_;  ///< of cells
  std::vector<std::uint8_t> ranks_;    ///< of particles in their eighths
  std::vector<Entry> entries_, scratch_;
};

}  // namespace spindrift::codec
