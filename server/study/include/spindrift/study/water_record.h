// What a run of a scene looked like and what it cost, sampled on grids that do not depend on its resolution, so that
// two runs of the same scene can be compared whatever they are made of.
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

/// Bytes that a frame of all layers takes on the wire.
using FrameBytes = std::function<std::size_t(const core::FrameView& frame)>;

struct RecordOptions {
  double seconds = 4.0;            ///< simulated
  double sample_interval_s = 0.1;  ///< simulated
  bool has_samples = true;         ///< else costs alone
  FrameBytes frame_bytes;          ///< may be empty
  /// A run that took less wall time than this is repeated, three times in all, and each interval counts with its
  /// fastest time: a virtual machine's speed changes by a factor of two from minute to minute.
  double repeat_below_s = 3.0;
};

struct WaterRecord {
  // Cost. Sampling does not count.
  double wall_ms_per_s = 0.0;  ///< wall time of a simulated second
  std::vector<gpu::PassCost> passes;
  double seconds = 0.0;  ///< simulated
  std::uint64_t device_bytes = 0;
  double frame_bytes = 0.0;  ///< mean of the sampled frames
  std::uint32_t substeps_per_s_count = 0;
  std::uint32_t particle_count = 0;  ///< a pool's: its capacity
  std::uint32_t wave_cells_count = 0;
  std::uint64_t recovered_count = 0;

  /// A sample's fields, x fastest: elevation on kSurfaceCells^2 cells, averaged or interpolated [m]; volume of
  /// particles in columns of the box over its mean. Empty where the scene lacks the part.
  struct Sample {
    std::vector<double> surface_m;
    std::vector<double> column_m;
    std::optional<double> front_m;   ///< of a dam: where 99 % of its water lies behind
    double density_rms_ratio = 0.0;  ///< of max(rho / rho0 - 1, 0)
    double energy_j = 0.0;           ///< of waves and particles
  };
  std::vector<Sample> samples;
};

inline constexpr std::size_t kSurfaceCells = 64;
inline constexpr std::size_t kColumnsAlong = 20;

/// Runs the scene from its start; the same again gives the same samples.
core::Result<WaterRecord> record(gpu::Context& ctx, const core::Scene& scene, const RecordOptions& options);

/// How far a run is from another of the same scene. Ratios are over the root mean square of the other's field, or over
/// its largest energy.
struct RecordErrors {
  std::optional<double> surface_rms_ratio, surface_max_ratio;
  std::optional<double> spectrum_ratio;  ///< of the surface: sum |P - P_ref| / sum P_ref over rings of wave numbers
  std::optional<double> column_rms_ratio;
  std::optional<double> front_rms_ratio;
  std::optional<double> density_rms_ratio;  ///< the run's own, not a difference
  double energy_rms_ratio = 0.0;

  /// The one number that a trade is judged by: the water's height, from the surface, the columns where there are
  /// particles alone, and both where a wave carries a band of particles.
  double height_rms_ratio = 0.0;
};
RecordErrors compare(const WaterRecord& run, const WaterRecord& reference, const core::Scene& scene);

/// Which points have no other that is at most as dear and at most as far off, and better in one of the two by more than
/// that one's share in `chance`: smaller differences say nothing.
struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};
std::vector<bool> paretoFront(const std::vector<CostAndError>& points, const CostAndError& chance = {});

}  // namespace spindrift::study
