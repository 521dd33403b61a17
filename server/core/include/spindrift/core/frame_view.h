// A frame from the simulation to the encoder: quantized integers as the GPU packed them. The view keeps their memory
// alive.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <spindrift/core/level.h>

namespace spindrift::core {

/// Elevations on a grid, row by row (x fastest), two samples in each word, low half first:
/// int16 = round(eta / quantum_m), saturating. Sample (i, k) sits at x = (i + 1/2) length/nx - length/2, z likewise.
struct SurfaceView {
  CellCounts count;
  double length_m = 0.0;  ///< along x
  double width_m = 0.0;   ///< along z
  double quantum_m = 0.0;
  std::span<const std::uint32_t> words;  ///< nx*nz/2 words, rounded up; what no sample needs is 0
};

/// Particles in the simulation's cell order (below Level::kFull: in any order), three little-endian words each:
///   word 0: x u16 | z u16 << 16                   position = min + (u16/65535) * (max - min), per axis
///   word 1: y u16 | velocity x i8 << 16 | velocity y i8 << 24
///   word 2: velocity z i8 | tint u8 << 8 | foam u8 << 16 | 0 << 24
/// velocity = i8/127 * max_speed_mps; tint = density/rho0 mapped from [0.5, 1.1] to 0..255; foam 0..255.
struct ParticleView {
  std::uint32_t count = 0;
  double min_m[3] = {0, 0, 0};
  double max_m[3] = {0, 0, 0};
  double max_speed_mps = 0.0;
  double radius_m = 0.0;
  std::span<const std::uint32_t> words;  ///< 3 * count words
};

/// Foam on the surface, one byte per sample, four samples in each word, low byte first: 0 none .. 255 white. The
/// samples lie like those of a surface.
struct FoamView {
  CellCounts count;
  double length_m = 0.0;
  double width_m = 0.0;
  std::span<const std::uint32_t> words;  ///< nx*nz/4 words, rounded up; what no sample needs is 0
};

/// Boats, seven words each: BodiesFixed28 in proto, little endian.
struct BodiesView {
  std::uint32_t count = 0;
  std::span<const std::uint32_t> words;  ///< 7 * count words
};

/// Floaters, seven words each: FloatersFixed28 in proto, little endian, in the order of their slots.
struct FloatersView {
  std::uint32_t count = 0;
  std::span<const std::uint32_t> words;  ///< 7 * count words
};

/// Health and cost of a room, measured once per frame.
struct DiagnosticsView {
  double step_ms = 0.0;           ///< wall time of step() per tick, mean since the last frame
  double real_time_factor = 0.0;  ///< simulated seconds per wall second, mean over the last second
  std::uint32_t substeps_count = 0;
  std::uint32_t particle_count = 0;
  double max_particle_speed_mps = 0.0;
  double max_elevation_m = 0.0;
  double kinetic_energy_j = 0.0;    ///< of the particles
  double potential_energy_j = 0.0;  ///< of the particles, against y = 0
  double wave_energy_j = 0.0;
  double mean_density_ratio = 0.0;  ///< rho / rho0
  double max_density_ratio = 0.0;
  std::uint64_t nonfinite_count = 0;  ///< values found non-finite since the start (0 in a healthy room)
  std::uint64_t escaped_count = 0;    ///< particles found outside the domain since the start (0 in a healthy room)
  std::uint64_t recovered_count = 0;  ///< watchdog interventions since the start
  std::uint32_t boat_count = 0;
  std::int64_t volume_error_units = 0;  ///< error of the water volume ledger; 0 in a healthy room
  double emitted_m3 = 0.0;              ///< water turned into particles since the start
  double absorbed_m3 = 0.0;             ///< particle volume returned to the surface
  double breaking_ratio = 0.0;          ///< share of the surface that is breaking
  struct PassTime {
    std::string name;  ///< shader folder: "grid", "sph", ...
    double ms = 0.0;   ///< mean per tick
  };
  std::vector<PassTime> passes;
  /// Reading of a gauge; as v1::GaugeReading.
  struct GaugeNow {
    std::string name;
    double x_m = 0.0;
    double z_m = 0.0;
    std::uint32_t gauge_id = 0;  ///< of one that a person has placed; 0: the scene's, as for the next
    std::uint32_t person_id = 0;
    bool is_unread = false;  ///< no tick was measured yet
    double elevation_m = 0.0;
    double velocity_x_mps = 0.0;
    double velocity_z_mps = 0.0;
    double highest_m = 0.0;
    double lowest_m = 0.0;
  };
  std::vector<GaugeNow> gauges{};  ///< in the order of the scene, then those of people, oldest first
  double gauges_time_s = 0.0;      ///< simulation time of their readings; 0 before the first
};

/// The layers of a frame that have levels of detail, at one level. Below Level::kFull the surface and the foam have
/// fewer samples, each the mean of the samples that it covers, and the particles are a subset, drawn larger. Whether a
/// particle is in a subset depends on the particle alone. Each subset contains that of the next coarser level.
struct LevelView {
  std::optional<SurfaceView> surface;
  std::optional<ParticleView> particles;
  std::optional<FoamView> foam;
};

/// One frame of one room. Each layer may be absent. The spans are valid while a copy of `lease` exists; the last copy
/// releases the readback slot.
struct FrameView {
  std::uint64_t tick = 0;
  double time_s = 0.0;                        ///< simulation time
  double asked_s = 0.0;                       ///< time when the frame was requested, on the server's monotonic clock
  std::uint64_t state_id = 0;                 ///< number of the room's state that the frame shows; 0: unknown
  std::array<LevelView, kLevelCount> levels;  ///< indexed by Level; see at()
  std::optional<BodiesView> bodies;
  std::optional<FloatersView> floaters;
  std::optional<DiagnosticsView> diagnostics;
  ReducedCounts reduced_counts;    ///< of the scene, whatever this frame contains
  LevelSet due = LevelSet::all();  ///< levels whose rate includes the frame
  std::shared_ptr<const void> lease;

  [[nodiscard]] const LevelView& at(Level level) const { return levels[indexOf(level)]; }
  [[nodiscard]] LevelView& at(Level level) { return levels[indexOf(level)]; }
};

}  // namespace spindrift::core
