// White water on the surface: (n/2)^2 samples, once per tick. See shaders/foam/advance.comp.
#pragma once

#include "boats.h"
#include "breakers.h"
#include "creation.h"
#include "wave.h"

namespace spindrift::sim {

class SurfaceFoam {
 public:
  SurfaceFoam(Creation& create, const core::Scene& scene, const WaveLayout& layout);

  void clear();
  void declareState(StateBuffers& out);
  /// `boats` may be null.
  void advance(const Wave& wave, Breakers& breakers, const Boats* boats);
  /// Counts of absorbed particles per sample; null except in two-way scenes.
  [[nodiscard]] gpu::TexelBuffer* landed() { return landed_ ? &landed_ : nullptr; }
  /// Shares of white water by source: breaking, wake, landing, 0.
  [[nodiscard]] gpu::TexelBuffer& field() { return now_; }

 private:
  core::CellCounts count_;
  gpu::TexelBuffer now_, before_, landed_;
  Pass advance_;
};

}  // namespace spindrift::sim
