// Particles in the order of the wire: cell by cell, eighth by eighth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/particle_format.h"

namespace spindrift::codec {

/// A cell that holds something.
struct OccupiedCell {
  std::uint32_t gap = 0;     ///< empty cells before it
  std::uint16_t halves = 0;  ///< particles in its eighths, two bits each, kManyCount at most
};

/// Keeps its memory from frame to frame.
class ParticleOrder {
 public:
  /// keys[i]: 8 * cell + eighth of particle i; items[i]: whatever belongs to it. Equal keys keep their order.
  void sort(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items, std::uint64_t cell_count);

  [[nodiscard]] std::span<const std::uint64_t> items() const { return items_; }
  [[nodiscard]] std::span<const OccupiedCell> cells() const { return cells_; }
  /// What each eighth with kManyCount or more holds above that, in their order.
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
  /// Particles in each eighth of a cell, a byte each; later the number of particles before it. All zero between two
  /// frames; the size is a multiple of 64.
  std::vector<std::uint64_t> counts_;
  std::vector<std::uint32_t> begins_;  ///< of cells
  std::vector<std::uint8_t> ranks_;    ///< of particles in their eighths
  std::vector<Entry> entries_, scratch_;
};

}  // namespace spindrift::codec
