// Predicts a heightfield from its two previous frames and from the samples of this frame that are already coded. The
// form follows the wave equation: eta(t + dt) depends on eta(t) around the position and on eta(t - dt). The weights are
// fitted to each frame (fitWeights), which includes depth, damping, the frame interval and the quantization noise.
// Integers only, so that every client computes the same result.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <spindrift/bitstream/encode/residual_coder.h>
#include <spindrift/bitstream/format/surface_weights.h>
#include <spindrift/core/cell_counts.h>

namespace spindrift::codec {

/// Samples of a grid in quanta, row by row, with a border of two that repeats the outermost samples.
class SurfacePlane {
 public:
  /// Changes the size; the samples are undefined until they are written.
  void resize(core::CellCounts count);

  [[nodiscard]] core::CellCounts count() const { return count_; }
  [[nodiscard]] std::size_t stride() const { return count_.x + 2 * kBorder; }
  /// Pointer to sample 0 of row z; samples from -2 to nx + 1 and rows from -2 to nz + 1 are valid.
  [[nodiscard]] std::int16_t* row(std::ptrdiff_t z) { return samples_.data() + offsetOf(z); }
  [[nodiscard]] const std::int16_t* row(std::ptrdiff_t z) const { return samples_.data() + offsetOf(z); }
  /// Copies nx * nz samples into the plane and fills the border.
  void assign(std::span<const std::int16_t> samples);
  void assign(std::span<const std::uint8_t> samples);
  /// Returns true if sums of four samples surely fit into 16 bits; known only after assign().
  [[nodiscard]] bool isSmall() const { return is_small_; }

 private:
  [[nodiscard]] std::size_t offsetOf(std::ptrdiff_t z) const {
    return static_cast<std::size_t>(z + static_cast<std::ptrdiff_t>(kBorder)) * stride() + kBorder;
  }

  core::CellCounts count_;
  bool is_small_ = false;
  std::vector<std::int16_t> samples_;
};

/// The frames that a plane is predicted from. Null without such a frame; its weights are then 0.
struct SurfaceHistory {
  const SurfacePlane* before = nullptr;
  const SurfacePlane* earlier = nullptr;
};

/// Returns the weights that fit best (weighted least squares) for some 4,096 samples, spread over the whole plane. Each
/// weight fits into 16 bits; those of frames that `history` lacks are 0. `guess`: weights of the frame before, or null.
/// They tell where the prediction is bad, at breakers and hulls; there samples count less, since a tile costs the
/// logarithm of its residuals and not their square.
SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights* guess);

/// Neighbours in this frame that are already decoded.
struct KnownSamples {
  std::int32_t west, north, north_west;
};
/// Predicts a sample from them and the weighted sum of the history, which includes one half for rounding.
std::int16_t predictionOf(std::int32_t from_history, const KnownSamples& known, const SurfaceWeights& weights);

/// Computes the residuals of row z of a known plane. `sums` is scratch memory.
void residualsOfRow(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                    std::size_t z, std::span<std::int32_t> sums, std::span<std::int16_t> out);

/// Codes a plane, in tiles of 8 x 8, row by row.
void encodePlane(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                 ResidualEncoder& out);

}  // namespace spindrift::codec
