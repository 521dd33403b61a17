// What a running simulation hands to another one of the same water at another resolution.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/effects/effects.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/sea_state.h>
#include <spindrift/sim_state/state_copy.h>

namespace spindrift::sim {

/// A slot of the boats; boat_id 0: free.
struct BoatPlace {
  std::uint32_t boat_id = 0;
  core::Boat boat;
};

struct CarriedBoats {
  std::vector<BoatPlace> places;
  std::uint32_t first_id = 1;
  std::uint32_t next_id = 1;
};

/// A wind sea as it comes in: what is shown, and what it fades into, since when in the scene's time.
struct CarriedSea {
  SeaState shown;
  SeaState next;
  std::optional<double> fade_begin_s;
  std::uint64_t step_count = 0;  ///< wave steps in which it came in; begins anew at another resolution
};

/// State outside device buffers that lasts from one tick to the next. Parts that the scene lacks have none.
struct HostState {
  Effects effects{};
  CarriedBoats boats{};
  CarriedSea sea{};
  double patch_x_m = 0.0;  ///< where the patch of particles follows to
  double patch_z_m = 0.0;
};

/// Made by WaterSim::carriedState(). Plain values.
struct CarriedState {
  core::Scene scene{};
  Derived derived{};
  double time_s = 0.0;
  StateCopy state{};
  HostState host{};
};

/// Returns whether both scenes are the same water at different resolutions, so that one can continue the other: equal
/// sides, bed, obstacles, solvers and parts. Numbers that change while a room runs may differ.
[[nodiscard]] bool isSameWater(const core::Scene& a, const core::Scene& b);

}  // namespace spindrift::sim
