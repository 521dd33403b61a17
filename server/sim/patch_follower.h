// Moves the particle patch of a one-way scene to the newest splash, or with the first boat (thesis 3.6.4: shift and
// scale place the patch).
#pragma once

#include <spindrift/core/scene.h>

#include "boats.h"
#include "creation.h"

namespace spindrift::sim {

class PatchFollower {
 public:
  PatchFollower(Creation& create, const core::Scene& scene);

  /// Sets the position of the next event; the next move() moves the patch there.
  void goTo(double x_m, double z_m);
  [[nodiscard]] double x_m() const { return x_m_; }
  [[nodiscard]] double z_m() const { return z_m_; }
  /// Rewrites the patch in `sim_uniforms`. `boats` may be null.
  void move(const gpu::Buffer& sim_uniforms, const Boats* boats);

 private:
  core::WaveCells water_;
  double x_m_;
  double z_m_;
  Pass pass_;
};

}  // namespace spindrift::sim
