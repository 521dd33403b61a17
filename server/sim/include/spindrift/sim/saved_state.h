// The whole state of a simulation, so that another one of the same scene on the same device continues from it bit for
// bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/sim/carried_state.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/effects.h>

namespace spindrift::sim {

/// A buffer of the device whose content continues from one tick to the next.
struct SavedBuffer {
  std::string name;
  std::vector<std::uint32_t> words;
};

/// Made by WaterSim::savedState(). Plain values. Not part of it: the scene with its parameters, and what gauges have
/// recorded.
struct SavedState {
  std::uint64_t run_tick = 0;  ///< ticks since the start or the last reset
  /// Ticks for which the watchdog's half steps still last, 0 in the last of them; nullopt: none are taken.
  std::optional<std::uint64_t> careful_ticks;
  /// Of the particles. It is that of the moment when their number changed last, whatever the parameters are now.
  std::optional<ParticleLayout> particles;
  std::vector<std::uint32_t> layout;  ///< sizes and steps that follow from the scene; restore() compares them
  std::vector<SavedBuffer> buffers;
  Effects effects;
  CarriedBoats boats;
  CarriedSea sea;
  std::uint64_t sea_step_count = 0;
  double patch_x_m = 0.0;
  double patch_z_m = 0.0;
};

}  // namespace spindrift::sim
