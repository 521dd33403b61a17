// Decodes a sequence of planes, each predicted from the two before it. The decoder for codec/plane_chain and
// codec/surface_predictor. The caller owns all memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include <spindrift/bitstream/decode/residual_reader.h>
#include <spindrift/bitstream/format/surface_weights.h>

namespace spindrift::codec {

/// A grid of nx x nz samples in memory, with a border: two samples repeat the outermost ones, the rest is undefined and
/// only lets vectors be loaded and stored as a whole.
struct PlaneLayout {
  static constexpr std::size_t kLeft = 8;
  static constexpr std::size_t kRight = 16;

  std::size_t nx = 0;
  std::size_t nz = 0;

  /// Returns the number of tiles in a row.
  [[nodiscard]] std::size_t tilesCount() const { return (nx + kTile - 1) / kTile; }
  [[nodiscard]] std::size_t stride() const { return kLeft + kTile * tilesCount() + kRight; }
  [[nodiscard]] std::size_t sampleCount() const {
    return stride() * (2 * kBorder + (nz + kTile - 1) / kTile * kTile) + kRight;
  }
  /// Index of sample 0 of row z; rows begin at -2.
  [[nodiscard]] std::size_t placeOf(std::ptrdiff_t z) const {
    return static_cast<std::size_t>(z + static_cast<std::ptrdiff_t>(kBorder)) * stride() + kLeft;
  }
};

class PlaneRow {
 public:
  static constexpr std::size_t kMaxResolutionCount = 4096;
  static constexpr std::size_t kAlignment = alignof(ResidualGroup);

  /// Number of bytes that place() needs for nx x nz samples.
  static std::size_t bytesFor(std::size_t nx, std::size_t nz);
  /// Sets the memory to work in, aligned to kAlignment; there is no plane yet. 1 <= nx, nz <= kMaxResolutionCount.
  void place(std::uint8_t* memory, std::size_t nx, std::size_t nz);
  /// Forgets the planes, so that only a keyframe can follow.
  void forget() { has_row_ = false; }

  /// Decodes the payload of a keyframe, which BitSource::kSlackBytes of 0 must follow. False: it is damaged, and the
  /// planes are forgotten.
  bool readKeyframe(const std::uint8_t* payload, std::uint32_t byte_count, const SurfaceWeights& weights,
                    const SurfaceWeights& earlier_weights);
  /// Decodes the payload of a delta. False: it is damaged (as above), or there is no plane before it.
  bool readDelta(const std::uint8_t* payload, std::uint32_t byte_count, const SurfaceWeights& weights);

  /// Returns whether there is a plane; then row(z) holds nx samples of the newest one.
  [[nodiscard]] bool hasRow() const { return has_row_; }
  [[nodiscard]] std::size_t countX() const { return layout_.nx; }
  [[nodiscard]] std::size_t countZ() const { return layout_.nz; }
  [[nodiscard]] bool hasSize(std::size_t nx, std::size_t nz) const { return nx == layout_.nx && nz == layout_.nz; }
  [[nodiscard]] const std::int16_t* row(std::size_t z) const {
    return before_ + layout_.placeOf(static_cast<std::ptrdiff_t>(z));
  }
  /// Likewise, of the plane before the newest one.
  [[nodiscard]] const std::int16_t* earlierRow(std::size_t z) const {
    return earlier_ + layout_.placeOf(static_cast<std::ptrdiff_t>(z));
  }

 private:
  struct History {
    const std::int16_t *before, *earlier;  ///< null without such a frame
  };
  /// Assigns the parts of the memory and returns their size in bytes. With null memory it only returns the size.
  std::size_t takeParts(std::uint8_t* memory);
  void readPlane(ResidualReader& in, const History& history, const SurfaceWeights& weights, std::int16_t* plane);
  /// Reads the residuals of a row of tiles.
  void readTiles(ResidualReader& in, std::size_t rows);

  PlaneLayout layout_;
  std::int16_t *next_ = nullptr, *before_ = nullptr, *earlier_ = nullptr;
  ResidualGroup* residuals_ = nullptr;  ///< of a row of tiles, kTile rows of kTile each
  std::uint32_t* sums_ = nullptr;       ///< of kTile rows, with a border
  std::uint8_t* classes_ = nullptr;     ///< class of the newest tile in each column
  bool has_row_ = false;
};

}  // namespace spindrift::codec
