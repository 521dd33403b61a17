// The wind sea on the device: what comes in through absorbing sides, in the layers of those sides. A sea that changes
// fades into the next one. The state is a function of the changes and their times, so that a run repeats.
#pragma once

#include <cstdint>
#include <optional>

#include <spindrift/core/scene.h>
#include <spindrift/sim/state_buffer.h>
#include <spindrift/sim_state/carried_state.h>

#include "creation.h"

namespace spindrift::sim {

class WindSea {
 public:
  /// Precondition: hasWindSea(scene), and the resolution is a multiple of SEA_BLOCK, as in every scene file.
  WindSea(Creation& create, const core::Scene& scene, const WaveLayout& layout);

  /// Calm water; the sea of the last fadeTo() then fades in.
  void clear();
  /// The sea to fade to: from the next step on, or after a fade in progress.
  void fadeTo(SeaState sea);

  /// The water's depth or gravity has changed at `time_s`: the waves that come in continue in the water that there is
  /// now.
  void continueIn(const core::Scene& scene, double time_s);

  /// Returns the sea for another simulation of the same water, which continues it by takeOver(): call that after
  /// clear() and fadeTo(), with the scene's time continuing.
  [[nodiscard]] CarriedSea carried() const;
  void takeOver(const CarriedSea& carried);
  /// Call it after takeOver() to continue exactly from there, with the content of the buffers that it declares.
  void resumeSteps(const CarriedSea& carried) { step_count_ = carried.step_count; }
  void declareState(StateBuffers& out) { out.push_back({.buffer = &incident_}); }

  /// Returns the sea during the step of dt_s that begins at begin_s, nx x nz texels (wave/incident_sea.comp); null
  /// while calm. BASIN and BED must be bound.
  const gpu::TexelBuffer* advance(double begin_s, double dt_s);

 private:
  void uploadTables();
  shared::SeaUniforms uniformsAt(double begin_s, double dt_s, double faded_ratio) const;

  WaveLayout layout_;
  SeaState shown_;   ///< the sea, and while fading the one before
  SeaState next_;    ///< while fading
  SeaState wanted_;  ///< of the last fadeTo()
  std::optional<double> fade_begin_s_;
  std::uint64_t step_count_ = 0;
  std::uint32_t block_count_ = 0;
  gpu::TexelBuffer blocks_, columns_, rows_;
  gpu::TexelBuffer incident_;  ///< nx x nz; 0 outside the layers
  gpu::Buffer uniforms_;
  Pass compute_;
};

}  // namespace spindrift::sim
