// Resamples the state of a running simulation for another resolution of the same water. A pure function, without a
// device.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_state/carried_state.h>

namespace spindrift::sim {

struct ResampledState {
  StateCopy state;                 ///< sizes as `derived` says; boats are copied
  std::int64_t outflow_units = 0;  ///< minus the sum of the elevations and the spray: the ledger starts exact
};

/// `scene` and `derived` are of the new simulation; isSameWater(before.scene, scene).
///
/// Elevation: means over the new cells (resample.h). The volume of surface and spray together stays the same to half a
/// unit of a new cell; what shores and walls that fall on other cells gain or lose is spread evenly over the water. No
/// elevation is above or below all old ones by more than that. Level water stays level to the unit, cells below a bed
/// that is higher now are filled up (fill_up.h).
/// Flow: means over the new faces, 0 on closed ones. It is the flow half a wave step ago, as before; where the steps
/// differ, by half their difference (milliseconds), which makes waves of below 1 % that run back.
/// Spray: as many drops of the new size as the old ones hold, at their positions; the rest of less than a drop goes to
/// the surface. Bulk and bands of particles: a new lattice with the old motion (relay_particles.h). Breaking and foam:
/// the nearest cell, and means.
ResampledState resampleState(const CarriedState& before, const core::Scene& scene, const Derived& derived);

}  // namespace spindrift::sim
