// A heightfield from what is known of it: its two frames before and the samples already coded of this one. The wave
// equation says how: eta(t + dt) depends on eta(t) around the place and on eta(t - dt). The weights are not derived
// from the scene but fitted to each frame (fitWeights), which takes in depth, damping, the frame interval and the noise
// of the quanta. Whole numbers only, so that every reader comes to the same.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/surface_weights.h"
#include "residual_coder.h"

namespace spindrift::codec {

/// Samples of a square grid in quanta, row by row, with a border of two that repeats the outermost ones.
class SurfacePlane {
 public:
  static constexpr std::size_t kBorder = 2;

  /// Another size; the samples are anything until they are written.
  void resize(std::size_t resolution_count);

  [[nodiscard]] std::size_t resolution() const { return n_; }
  [[nodiscard]] std::size_t stride() const { return n_ + 2 * kBorder; }
  /// Row z from its sample 0 on; samples -2 to n + 1 are there, rows -2 to n + 1 likewise.
  [[nodiscard]] std::int16_t* row(std::ptrdiff_t z) { return samples_.data() + offsetOf(z); }
  [[nodiscard]] const std::int16_t* row(std::ptrdiff_t z) const { return samples_.data() + offsetOf(z); }
  /// n * n samples into the plane, borders as well.
  void assign(std::span<const std::int16_t> samples);
  void assign(std::span<const std::uint8_t> samples);
  /// Writes the border from the samples inside.
  void fillBorder();
  /// Whether sums of four samples fit into 16 bits for sure: known of planes that were assigned.
  [[nodiscard]] bool isSmall() const { return is_small_; }

 private:
  [[nodiscard]] std::size_t offsetOf(std::ptrdiff_t z) const {
    return static_cast<std::size_t>(z + static_cast<std::ptrdiff_t>(kBorder)) * stride() + kBorder;
  }

  std::size_t n_ = 0;
  bool is_small_ = false;
  std::vector<std::int16_t> samples_;
};

/// The frames that a plane is predicted from. Null where there is none: its weights are 0 then.
struct SurfaceHistory {
  const SurfacePlane* before = nullptr;
  const SurfacePlane* earlier = nullptr;
};

/// Codes a plane, in tiles of 8 x 8, row by row.
void encodePlane(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                 ResidualEncoder& out);

}  // namespace spindrift::codec
