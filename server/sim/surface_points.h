// The surface at points that somebody asks for, in one dispatch for all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include <spindrift/sim/surface_sample.h>
#include <spindrift/sim_setup/derive.h>

#include "creation.h"
#include "surface_foam.h"
#include "wave.h"

namespace spindrift::sim {

/// A position in cells: whole numbers at the centres of cells.
struct CellPlace {
  float column = 0.0F;
  float row = 0.0F;
};
[[nodiscard]] CellPlace cellPlaceOf(const WaveLayout& layout, double x_m, double z_m);

class SurfacePoints {
 public:
  explicit SurfacePoints(Creation& create);

  /// Samples the present state at these points, at most kMaxSurfacePoints; `foam` may be null. The uniforms are bound.
  /// Returns false when all slots are in use.
  bool sample(std::span<const SurfacePoint> points, std::uint64_t number, const WaveLayout& layout, Wave& wave,
              SurfaceFoam* foam);
  /// Returns the samples that have arrived, oldest first. Never waits.
  std::vector<SurfaceSamples> poll();
  /// Calls of sample() whose result poll() has not yet returned.
  [[nodiscard]] std::size_t inFlightCount() const { return in_flight_.size(); }

 private:
  gpu::Context& ctx_;
  gpu::Buffer places_, values_;
  Pass pass_;
  std::unique_ptr<gpu::ReadbackRing> ring_;
  std::deque<SurfaceSamples> in_flight_;  ///< without samples yet
};

}  // namespace spindrift::sim
