// Samples and cost of a run of a scene. The sampling grids do not depend on the scene's resolution, so that any two
// runs of the same scene can be compared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/pass_timer.h>

namespace spindrift::study {

/// Returns the size on the wire of a frame with all layers.
using FrameBytes = std::function<std::size_t(const core::FrameView& frame)>;

struct RecordOptions {
  double seconds = 4.0;            ///< simulated
  double sample_interval_s = 0.1;  ///< simulated
  bool has_samples = true;         ///< false: costs only
  FrameBytes frame_bytes;          ///< may be empty
  /// A run that costs less time than this is run three times, and the fastest time of each interval counts: the speed
  /// of a virtual machine changes by a factor of two from minute to minute.
  double repeat_below_s = 3.0;
};

struct WaterRecord {
  // Cost, without the time for sampling.
  /// Of a simulated second: processor time of all threads on a software rasteriser, otherwise wall time.
  double cost_ms_per_s = 0.0;
  std::vector<gpu::PassCost> passes;
  double seconds = 0.0;  ///< simulated
  std::uint64_t device_bytes = 0;
  double frame_bytes = 0.0;  ///< mean of the sampled frames
  std::uint32_t substeps_per_s_count = 0;
  std::uint32_t particle_count = 0;  ///< of a pool: its capacity
  std::uint32_t wave_cells_count = 0;
  std::uint64_t recovered_count = 0;

  /// Fields of a sample, x fastest: elevation on kSurfaceCells cells along x and as many across as make them about
  /// square, averaged or interpolated, on land in a nonlinear bulk the depth of the water on it [m]; volume of
  /// particles in columns of the box over the mean volume. Empty if the scene lacks the part.
  struct Sample {
    std::vector<double> surface_m;
    std::vector<double> column_m;
    std::optional<double> front_m;   ///< of a dam: 99 % of its water is behind it
    double density_rms_ratio = 0.0;  ///< of max(rho / rho0 - 1, 0)
    double energy_j = 0.0;           ///< of waves and particles
  };
  std::vector<Sample> samples;
};

inline constexpr std::size_t kSurfaceCells = 64;
inline constexpr std::size_t kColumnsAlong = 20;

/// Runs the scene from its start; a repetition gives the same samples.
core::Result<WaterRecord> record(gpu::Context& ctx, const core::Scene& scene, const RecordOptions& options);

/// Returns the hash of the water after its first ticks (sim::WaterSim::stateHash()).
core::Result<std::uint64_t> stateHashAfter(gpu::Context& ctx, const core::Scene& scene, int tick_count);

/// Difference of a run from another run of the same scene. Ratios are relative to the root mean square of the other
/// run's field, or to its largest energy.
struct RecordErrors {
  std::optional<double> surface_rms_ratio, surface_max_ratio;
  std::optional<double> spectrum_ratio;  ///< of the surface: sum |P - P_ref| / sum P_ref over rings of wave numbers;
                                         ///< square water only
  std::optional<double> column_rms_ratio;
  std::optional<double> front_rms_ratio;
  std::optional<double> density_rms_ratio;  ///< of this run, not a difference
  double energy_rms_ratio = 0.0;

  /// The number by which a choice is judged: the height of the water, from the surface, from the columns if there are
  /// only particles, and from both if a wave carries a band of particles.
  double height_rms_ratio = 0.0;
};
RecordErrors compare(const WaterRecord& run, const WaterRecord& reference, const core::Scene& scene);

/// Marks the points on the front of cost against error: no other point is at most as costly and at most as far off, and
/// better in one of the two by more than that one's share in `chance`. Smaller differences mean nothing.
struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};
std::vector<bool> paretoFront(const std::vector<CostAndError>& points, const CostAndError& chance = {});

}  // namespace spindrift::study
