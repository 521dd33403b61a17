// The cases, for the lists in accuracy.cpp and known_results.cpp.
#pragma once

#include <spindrift/study/accuracy.h>
#include <spindrift/study/known_results.h>

namespace spindrift::study {

using Outcome = core::Result<CaseResult>;
/// Relative error of a KnownResult.
using LevelError = core::Result<double>;

// wave_cases.cpp
Outcome eigenmode(gpu::Context& ctx, bool quick);
Outcome observedOrder(gpu::Context& ctx, bool quick);
Outcome phaseError(gpu::Context& ctx, bool quick);
Outcome roundHump(gpu::Context& ctx, bool quick);
Outcome waveEnergy(gpu::Context& ctx, bool quick);
Outcome dampedMode(gpu::Context& ctx, bool quick);

// dispersed_wave_cases.cpp
Outcome airyPhaseSpeed(gpu::Context& ctx, bool quick);
Outcome rippleSpeed(gpu::Context& ctx, bool quick);
Outcome drops(gpu::Context& ctx, bool quick);
Outcome wavePacket(gpu::Context& ctx, bool quick);
Outcome airyRings(gpu::Context& ctx, bool quick);

// dispersed_basin_cases.cpp
Outcome basinModes(gpu::Context& ctx, bool quick);
Outcome dispersedStillWater(gpu::Context& ctx, bool quick);
Outcome thinWalls(gpu::Context& ctx, bool quick);
Outcome dispersedEnergy(gpu::Context& ctx, bool quick);

// shoaling_and_gap_cases.cpp
Outcome shoaling(gpu::Context& ctx, bool quick);
Outcome diffraction(gpu::Context& ctx, bool quick);

// wake_cases.cpp
Outcome kelvinWake(gpu::Context& ctx, bool quick);
Outcome shallowWake(gpu::Context& ctx, bool quick);
LevelError wakeError(gpu::Context& ctx, const LevelScale& level);

// slope_and_side_cases.cpp
Outcome reflection(gpu::Context& ctx, bool quick);
Outcome greensLaw(gpu::Context& ctx, bool quick);

// bar_case.cpp
Outcome submergedBar(gpu::Context& ctx, bool quick);

// island_case.cpp
Outcome conicalIsland(gpu::Context& ctx, bool quick);

// bowl_cases.cpp
Outcome thackersBowl(gpu::Context& ctx, bool quick);
Outcome seiche(gpu::Context& ctx, bool quick);

// bore_cases.cpp
Outcome boreAtAWall(gpu::Context& ctx, bool quick);
Outcome overtopping(gpu::Context& ctx, bool quick);

// breaking_front_case.cpp
Outcome breakingFront(gpu::Context& ctx, bool quick);
LevelError boreError(gpu::Context& ctx, const LevelScale& level);

// momentum_cases.cpp
Outcome momentumAndEnergy(gpu::Context& ctx, bool quick);

// run_up_cases.cpp
Outcome solitaryRunUp(gpu::Context& ctx, bool quick);
Outcome runUpProfiles(gpu::Context& ctx, bool quick);
Outcome solitaryWave(gpu::Context& ctx, bool quick);
LevelError gentleRunUpError(gpu::Context& ctx, const LevelScale& level);
LevelError breakingRunUpError(gpu::Context& ctx, const LevelScale& level);
LevelError solitaryHeightError(gpu::Context& ctx, const LevelScale& level);

// shore_cases.cpp
Outcome damBreakOfShallowWater(gpu::Context& ctx, bool quick);
Outcome lakeWithIslands(gpu::Context& ctx, bool quick);

// wave_maker_case.cpp
Outcome waveMakers(gpu::Context& ctx, bool quick);

// sea_cases.cpp
Outcome windSea(gpu::Context& ctx, bool quick);

// one_step.cpp
Outcome oneStep(gpu::Context& ctx, bool quick);

// particle_cases.cpp
Outcome stillWater(gpu::Context& ctx, bool quick);
Outcome hydrostaticColumn(gpu::Context& ctx, bool quick);

// dam_break.cpp
Outcome damBreak(gpu::Context& ctx, bool quick);
LevelError damBreakError(gpu::Context& ctx, const LevelScale& level);

// taylor_green.cpp
Outcome taylorGreen(gpu::Context& ctx, bool quick);

// body_cases.cpp
Outcome floatingBody(gpu::Context& ctx, bool quick);
Outcome machWedge(gpu::Context& ctx, bool quick);
Outcome boatResistance(gpu::Context& ctx, bool quick);

// hull_force_cases.cpp
Outcome hullBuoyancy(gpu::Context& ctx, bool quick);
Outcome hullHeave(gpu::Context& ctx, bool quick);
Outcome hullInWaves(gpu::Context& ctx, bool quick);

// floater_cases.cpp
Outcome floatingObjects(gpu::Context& ctx, bool quick);
Outcome floaterMotion(gpu::Context& ctx, bool quick);
Outcome sinkingObjects(gpu::Context& ctx, bool quick);

}  // namespace spindrift::study
