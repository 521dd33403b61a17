// What a running simulation hands to another one of the same water at another resolution.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/effects/effects.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/sea_state.h>

namespace spindrift::sim {

/// The state of the buffers that are declared as carried (state_buffer.h), as plain numbers: for changes of scene, and
/// for tests. Positions and velocities 4 floats per particle (xyz + id, xyz + foam), elevations nx x nz, x fastest [m].
struct StateCopy {
  std::vector<float> position, velocity;
  std::vector<float> density_kgpm3;
  std::vector<double> elevation_m;  ///< whole units of shaders/shared/fixed_point.h, which a double holds exactly
  /// Part of elevation_m that came through x faces, in a matched layer [units]; empty in scenes without one.
  std::vector<std::int32_t> elevation_x_units;
  std::vector<float> boats;         ///< layout: shaders/shared/boats.h; every slot
  std::vector<float> floaters;      ///< layout: shaders/shared/floaters.h; every slot
  std::vector<std::uint32_t> pool;  ///< shaders/shared/pool.h; two-way scenes
  std::vector<float> flow_m2ps;     ///< 2 (9-point stencil: 4) per cell: the faces owned by the cell
  std::vector<float> breaking;      ///< 4 per wave cell, as BREAKING; empty in scenes without
  std::vector<float> foam;          ///< 4 per foam sample, as FOAM_FIELD; empty in scenes without

  bool operator==(const StateCopy&) const = default;

  /// Calls `visit` with the name of a buffer and the array that has its words, for all except "elevation".
  template <typename Copy, typename Visit>
  static void forEachArray(Copy& copy, Visit visit) {
    visit("position", copy.position);
    visit("velocity", copy.velocity);
    visit("pool", copy.pool);
    visit("boats", copy.boats);
    visit("floaters", copy.floaters);
    visit("flow", copy.flow_m2ps);
    visit("elevation from x faces", copy.elevation_x_units);
    visit("breaking", copy.breaking);
    visit("foam", copy.foam);
  }
};

/// A slot of the boats; boat_id 0: free.
struct BoatPlace {
  std::uint32_t boat_id = 0;
  core::Boat boat;
  double moved_left_s = 0.0;  ///< for this time another program moves it; 0: the water does
};

/// Fixed data of a boat, sent to clients once; its position is in the frames.
struct BoatRecord {
  std::uint32_t boat_id = 0;
  double length_m = 0.0;
  double beam_m = 0.0;
  double height_m = 0.0;
  double draught_m = 0.0;  ///< at rest: height times density ratio
};

struct CarriedBoats {
  std::vector<BoatPlace> places;
  std::uint32_t first_id = 1;
  std::uint32_t next_id = 1;
};

/// A slot of the floaters; floater_id 0: free.
struct FloaterPlace {
  std::uint32_t floater_id = 0;
  core::Floater floater;
};

struct CarriedFloaters {
  std::vector<FloaterPlace> places;
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
  CarriedFloaters floaters{};
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
