// Planes in a row, each predicted from the two before it: the reading half of codec/plane_chain and
// codec/surface_predictor. All memory is the caller's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/surface_weights.h"
#include "residual_reader.h"

namespace spindrift::codec {

/// A grid of n x n samples in memory, with room around: two samples repeat the outermost ones, the others are anything
/// and let whole vectors be read and written.
struct PlaneLayout {
  static constexpr std::size_t kBorder = 2;
  static constexpr std::size_t kLeft = 8;
  static constexpr std::size_t kRight = 16;

  std::size_t n = 0;

  [[nodiscard]] std::size_t tilesCount() const { return (n + kTile - 1) / kTile; }
  [[nodiscard]] std::size_t stride() const { return kLeft + kTile * tilesCount() + kRight; }
  [[nodiscard]] std::size_t sampleCount() const { return stride() * (2 * kBorder + kTile * tilesCount()) + kRight; }
  /// Index of sample 0 of row z; rows begin at -2.
  [[nodiscard]] std::size_t placeOf(std::ptrdiff_t z) const {
    return static_cast<std::size_t>(z + static_cast<std::ptrdiff_t>(kBorder)) * stride() + kLeft;
  }
};

class PlaneRow {
 public:
  static constexpr std::size_t kMaxResolutionCount = 4096;
  static constexpr std::size_t kAlignment = alignof(ResidualGroup);

  /// What place() takes for n samples a side, in bytes.
  static std::size_t bytesFor(std::size_t n);
  /// Works in this memory from now on, aligned to kAlignment; there is no row yet. 1 <= n <= kMaxResolutionCount.
  void place(std::uint8_t* memory, std::size_t n);
  /// There is no row to continue any more.
  void forget() { has_row_ = false; }

  /// The payload of a frame that stands by itself, with BitSource::kSlackBytes of 0 behind it. False: it is damaged,
  /// and there is no row any more.
  bool readKeyframe(const std::uint8_t* payload, std::uint32_t byte_count, const SurfaceWeights& weights,
                    const SurfaceWeights& earlier_weights);
  /// The payload of a frame that continues the row. False: as above, or there is none.
  bool readDelta(const std::uint8_t* payload, std::uint32_t byte_count, const SurfaceWeights& weights);

  /// Whether there is a row; then row(z) holds n samples of the plane read last.
  [[nodiscard]] bool hasRow() const { return has_row_; }
  [[nodiscard]] std::size_t resolution() const { return layout_.n; }
  [[nodiscard]] const std::int16_t* row(std::size_t z) const {
    return before_ + layout_.placeOf(static_cast<std::ptrdiff_t>(z));
  }

 private:
  struct History {
    const std::int16_t *before, *earlier;  ///< null where there is none
  };
  /// The parts of the memory; how much they take in bytes. Memory null: nothing else.
  std::size_t takeParts(std::uint8_t* memory);
  void readPlane(ResidualReader& in, const History& history, const SurfaceWeights& weights, std::int16_t* plane);
  /// The residuals of a row of tiles.
  void readTiles(ResidualReader& in, std::size_t rows);
  void fillBorder(std::int16_t* plane) const;

  PlaneLayout layout_;
  std::int16_t *next_ = nullptr, *before_ = nullptr, *earlier_ = nullptr;
  ResidualGroup* residuals_ = nullptr;  ///< of a row of tiles, for each kTile rows of kTile
  std::uint32_t* sums_ = nullptr;       ///< of kTile rows, with room around
  std::uint8_t* classes_ = nullptr;     ///< of the tiles read last in each column
  bool has_row_ = false;
};

}  // namespace spindrift::codec
