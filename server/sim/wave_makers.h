// The wave-makers of a scene on the device: water through sides that are walls otherwise (sim_setup/incident_waves.h
// says how much). Their time is the scene's, so a reset begins them again and a replay repeats them.
#pragma once

#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/incident_waves.h>

#include "creation.h"

namespace spindrift::sim {

class WaveMakers {
 public:
  /// Precondition: hasMakers(scene).
  WaveMakers(Creation& create, const core::Scene& scene, const WaveLayout& layout);

  /// Takes on changed parameters (depth, gravity, step).
  void update(const core::Scene& scene, const WaveLayout& layout);
  /// Lets in and takes up the water of a wave step around middle_s [s since the start of the scene]. The caller has
  /// bound ELEVATION, OUTFLOW and ELEVATION_X as storage and BED for lookups, as far as the scene has them.
  void advance(double middle_s);

 private:
  struct Maker {
    core::Side side;
    IncidentWaves waves;
    gpu::Buffer uniforms;
  };
  /// Values from which the waves were computed.
  struct Inputs {
    double depth_m, gravity_mps2, dt_s;
    std::uint64_t seed;
    bool operator==(const Inputs&) const = default;
  };

  core::CellCounts count_;
  std::vector<Maker> makers_;
  Inputs inputs_{};
  Pass pass_;
};

}  // namespace spindrift::sim
