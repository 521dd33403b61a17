// Moves the particle patch of a one-way scene to the newest splash, or with the first boat (thesis 3.6.4: shift and
// scale place the patch).
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "boats.h"

namespace spindrift::sim {

class PatchFollower {
 public:
  static core::Result<std::unique_ptr<PatchFollower>> create(gpu::Context& ctx, const core::Scene& scene,
                                                             const gpu::Defines& defines);

  /// Sets the position of the next event; the next move() moves the patch there.
  void goTo(double x_m, double z_m);
  [[nodiscard]] double x_m() const { return x_m_; }
  [[nodiscard]] double z_m() const { return z_m_; }
  /// Rewrites the patch in `sim_uniforms`. `boats` may be null.
  void move(const gpu::Buffer& sim_uniforms, const Boats* boats);

 private:
  PatchFollower(gpu::Context& ctx, const core::Scene& scene);

  gpu::Context& ctx_;
  double length_m_;  ///< of the water
  double width_m_;
  double x_m_;
  double z_m_;
  gpu::Program program_;
};

}  // namespace spindrift::sim
