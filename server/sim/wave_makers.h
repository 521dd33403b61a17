// The wave-makers of a scene on the device: water through sides that are walls otherwise (sim_setup/incident_waves.h
// says how much). Their time is the scene's, so a reset begins them again and a replay repeats them.
#pragma once

#include <memory>
#include <vector>

#include <shared/maker_uniforms.h>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/incident_waves.h>

namespace spindrift::sim {

class WaveMakers {
 public:
  /// Errors: those of the buffers and the program. Precondition: hasMakers(scene).
  static core::Result<std::unique_ptr<WaveMakers>> create(gpu::Context& ctx, const core::Scene& scene,
                                                          const WaveLayout& layout, const gpu::Defines& defines);

  /// Takes on changed parameters (depth, gravity, step).
  void update(const core::Scene& scene, const WaveLayout& layout);
  /// Lets in and takes up the water of a wave step around middle_s [s since the start of the scene]. The caller has
  /// bound ELEVATION, OUTFLOW and ELEVATION_X as storage and BED for lookups, as far as the scene has them.
  void advance(double middle_s);

 private:
  explicit WaveMakers(gpu::Context& ctx) : ctx_(ctx) {}

  struct Maker {
    core::Side side;
    IncidentWaves waves;
    gpu::Buffer uniforms;
  };
  /// Values from which the waves were computed.
  struct Inputs {
    double depth_m, gravity_mps2, dt_s;
    bool operator==(const Inputs&) const = default;
  };

  gpu::Context& ctx_;
  core::CellCounts count_;
  std::vector<Maker> makers_;
  Inputs inputs_{};
  gpu::Program program_;
};

}  // namespace spindrift::sim
