// The wave equation on the device: integer elevations, the flow through the faces between cells, and the surface for
// particles and boats. A step is momentum, then continuity. Without dispersion, eliminating the flow gives the thesis's
// leapfrog on three elevation levels (3.4, 3.6.3), with the same dispersion relation, and the volume is conserved to
// the last unit.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <shared/event_uniforms.h>

#include <spindrift/core/scene.h>
#include <spindrift/effects/splash_tiles.h>
#include <spindrift/sim/state_buffer.h>
#include <spindrift/sim_setup/basin_store.h>

#include "creation.h"
#include "dispersed_slope.h"
#include "wave_makers.h"

namespace spindrift::sim {

class Wave {
 public:
  /// `sampled`: particles or boats read the surface; creates the buffers for them, too. The basin has tables only if it
  /// is varied, and outflow is counted only if water can leave or enter. `basins`: that of WaterSim::create().
  Wave(Creation& create, const core::Scene& scene, const WaveLayout& layout, bool sampled, BasinStore* basins);

  /// Sets a level surface at rest, with dry ground above it in a nonlinear bulk, and the outflow to zero.
  void clear();
  /// Call it after other code has set the elevation or the flow: the next step then takes nothing from the last one.
  void forgetLastStep();
  /// Clears the external pressure on the surface; callers then add to pressureHead().
  void clearPressure();
  /// Uploads the tables for changed parameters (depth, gravity).
  void uploadBasin(const core::Scene& scene, const WaveLayout& layout);

  /// Multiplies the flow everywhere. Waits for the device: for rare changes only.
  void scaleFlow(double ratio);
  /// Call it after the bed has risen (shallower water, an older checkpoint). Cells whose surface is below their bed are
  /// filled up to it with water of the other cells, in proportion to their water; if that is not enough and sides are
  /// open, with water from outside, counted as outflow. Conserves the volume to the unit. Waits for the device: for
  /// rare changes only.
  void fillUpToBed(const core::Scene& scene, const WaveLayout& layout);

  /// Sets the volume that has left since the start, in units of a cell; 0 in basins that no water leaves or enters.
  void setOutflow(std::int64_t units);

  /// Advances one wave step: the flow driven by the slope plus this step's share of the active effects, limited to the
  /// water that cells hold. `breaking` may be null; empty `events` mean that no effect is active. `incident_sea`: what
  /// comes in through absorbing sides (wind_sea.h), null when nothing does. `middle_s`: time in the middle of the step
  /// since the start of the scene, for wave-makers.
  void advance(const gpu::TexelBuffer* breaking, const shared::EventUniforms& events,
               const gpu::TexelBuffer* incident_sea, double middle_s);
  /// Slopes, vertical speed and horizontal velocity of the surface, for particles and boats.
  void sampleSurface();

  void declareState(StateBuffers& out);

  [[nodiscard]] core::CellCounts cellCounts() const { return count_; }
  [[nodiscard]] gpu::TexelBuffer& elevation() { return elevation_; }  ///< nx x nz [units]
  /// nx x nz x 2 (9-point: 4) [m^2/s]. Nonlinear bulk: nx x nz x 4, velocities toward +x and +z [m/s], then the water
  /// that they moved [m^2/s].
  [[nodiscard]] gpu::TexelBuffer& flow() { return flow_; }
  /// nx x nz [units: low 24 bits, the rest]; null in scenes without.
  [[nodiscard]] gpu::TexelBuffer* outflow() { return outflow_ ? &outflow_ : nullptr; }
  /// null in scenes without.
  [[nodiscard]] WaveMakers* makers() { return makers_.get(); }
  /// Sum of the elevations of water at rest: ground above the still water counts in a nonlinear bulk.
  [[nodiscard]] std::int64_t restingUnits() const { return resting_units_; }
  /// Binds SURFACE and SURFACE_FLOW for lookups. Only in scenes whose surface is sampled.
  void bindSurface() const;
  /// Binds the effects of the last wave step.
  void bindEvents() const;
  /// Binds BASIN and BED if the scene has tables.
  void bindBasin() const;
  /// Binds TERRAIN and LANDING if the scene has a terrain.
  void bindTerrain() const;
  /// nx x nz [units]: pressure of hulls and falling particles. Only in scenes with boats or two-way coupling.
  [[nodiscard]] gpu::TexelBuffer& pressureHead() { return pressure_head_; }

 private:
  void accelerate(const gpu::TexelBuffer* breaking, const gpu::TexelBuffer* incident_sea);
  void displace(const shared::EventUniforms& events);
  void upload(const BasinTables& tables);
  void uploadOutflow(std::int64_t units);
  void limit();

  core::CellCounts count_;
  bool is_nonlinear_;
  bool had_events_ = false;
  // Buffers that the scene does not need are empty.
  gpu::TexelBuffer elevation_, flow_, basin_, bed_, outflow_;
  gpu::TexelBuffer next_flow_;  ///< of a nonlinear bulk: a step writes it, then it takes the place of flow_
  /// nx x nz x 2 [units per cell]: of a nonlinear bulk, the slopes that the dispersion filters.
  gpu::TexelBuffer rise_;
  /// nx x nz [units]: the part of the elevation that came through x faces, inside a matched layer
  /// (wave/continuity.comp); only in scenes with one. 0 outside the layer.
  gpu::TexelBuffer elevation_x_;
  gpu::TexelBuffer transfer_;     ///< nx x nz x 2 (9-point: 4) [units]
  gpu::TexelBuffer given_share_;  ///< nx x nz; written in steps that limit transfers
  gpu::Buffer limit_args_;        ///< groups of the two passes of the limit; 0 in most steps
  gpu::TexelBuffer tense_level_;  ///< nx x nz [units]; only where the surface of the wave has tension
  gpu::TexelBuffer pressure_head_, terrain_, landing_;
  gpu::TexelBuffer surface_, surface_flow_;
  std::unique_ptr<DispersedSlope> dispersed_slope_;  ///< null in scenes without dispersion
  std::unique_ptr<WaveMakers> makers_;               ///< null in scenes without wave-makers
  std::vector<std::int32_t> resting_elevation_;      ///< nx x nz [units]; empty if the bulk is linear
  std::int64_t resting_units_ = 0;
  gpu::Buffer event_uniforms_;
  SplashTiles splash_tiles_;
  gpu::Buffer splash_tiles_buffer_;
  gpu::TexelBuffer crest_profile_;  ///< crests x longer side of the domain; wave/crest_profile.comp
  Pass splash_, profile_crests_, find_share_, limit_, sample_surface_, slope_, tense_;
  Pass crest_[2];                     ///< by whether a crest has a finite width
  Pass momentum_[2], continuity_[2];  ///< by whether a sea comes in; the second only in scenes with a wind sea
};

}  // namespace spindrift::sim
