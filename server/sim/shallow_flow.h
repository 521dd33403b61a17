// The flow of nonlinear shallow water on the device (BULK_NONLINEAR): velocities at the faces, and the water that they
// move. It takes the place of wave/momentum.comp in a wave step.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/state_buffer.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

class ShallowFlow {
 public:
  /// Errors: those of the buffers and programs.
  static core::Result<std::unique_ptr<ShallowFlow>> create(gpu::Context& ctx, const core::Scene& scene,
                                                           const WaveLayout& layout, const gpu::Defines& defines);

  /// nx x nz x 2 [units per cell]: the slopes that the dispersion filters, from ELEVATION, FLOW, BED and PRESSURE_HEAD,
  /// which the caller has bound for lookups. Only in scenes with dispersion.
  const gpu::TexelBuffer& findRise();
  /// Advances `flow` [nx x nz x 4: velocities m/s, moved water m^2/s] by a wave step. The caller has bound ELEVATION,
  /// BED, BASIN, PRESSURE_HEAD, DISPERSED, BREAKING and INCIDENT_SEA for lookups, as far as the scene has them, and
  /// TRANSFER and LIMIT_ARGS as storage. `sea`: a sea comes in.
  void advance(gpu::TexelBuffer& flow, bool sea);
  void declareState(StateBuffers& out);

 private:
  ShallowFlow(gpu::Context& ctx, const WaveLayout& layout) : ctx_(ctx), count_(layout.counts()) {}

  gpu::Context& ctx_;
  core::CellCounts count_;
  gpu::TexelBuffer next_flow_, rise_;
  gpu::Program momentum_[2], slope_;  ///< momentum by whether a sea comes in, as in Wave
};

}  // namespace spindrift::sim
