// White water on the surface: (n/2)^2 samples, once per tick. See shaders/foam/advance.comp.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "boats.h"
#include "breakers.h"
#include "wave.h"

namespace spindrift::sim {

class SurfaceFoam {
 public:
  static core::Result<std::unique_ptr<SurfaceFoam>> create(gpu::Context& ctx, const core::Scene& scene,
                                                           const WaveLayout& layout, const gpu::Defines& defines);

  void clear();
  void declareState(StateBuffers& out);
  /// `boats` may be null.
  void advance(const Wave& wave, Breakers& breakers, const Boats* boats);
  /// Counts of absorbed particles per sample; null except in two-way scenes.
  [[nodiscard]] gpu::TexelBuffer* landed() { return has_landings_ ? &landed_ : nullptr; }
  /// Shares of white water by source: breaking, wake, landing, 0.
  [[nodiscard]] gpu::TexelBuffer& field() { return now_; }

 private:
  SurfaceFoam(gpu::Context& ctx, const WaveLayout& layout) : ctx_(ctx), count_(layout.foamCounts()) {}

  gpu::Context& ctx_;
  core::CellCounts count_;
  bool has_landings_ = false;
  gpu::TexelBuffer now_, before_, landed_;
  gpu::Program advance_;
};

}  // namespace spindrift::sim
