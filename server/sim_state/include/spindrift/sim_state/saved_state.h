// The whole state of a simulation, so that another one of the same scene on the same device continues from it bit for
// bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/effects/effects.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_state/carried_state.h>

namespace spindrift::sim {

/// A buffer of the device whose content lasts (StateBuffer::lasts).
struct SavedBuffer {
  std::string name;
  std::vector<std::uint32_t> words;  ///< those that count (StateBuffer::wordCount)
  bool operator==(const SavedBuffer&) const = default;
};

/// Made by WaterSim::savedState(). Plain values. Not part of it: the scene with its parameters, and what gauges have
/// recorded.
struct SavedState {
  std::uint64_t run_tick = 0;  ///< ticks since the start or the last reset
  /// Ticks for which the watchdog's half steps still last, 0 in the last of them; nullopt: none are taken.
  std::optional<std::uint64_t> careful_ticks;
  /// Layout of the particles. It is that of the moment when their number changed last, whatever the parameters are now.
  std::optional<ParticleLayout> particles;
  std::vector<std::uint32_t> layout;  ///< sizes and steps that follow from the scene; restore() compares them
  std::vector<SavedBuffer> buffers;
  HostState host;
};

/// Returns 64-bit FNV-1a over all values of the state. States with the same scene, parameters and hash continue in the
/// same way on the same device.
[[nodiscard]] std::uint64_t hashOf(const SavedState& state);

}  // namespace spindrift::sim
