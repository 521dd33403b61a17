#include <spindrift/study/accuracy.h>

#include "cases.h"

namespace spindrift::study {
namespace {

/// Turns the results of a device that was lost into an error: values read after the loss are meaningless.
Case unlessLost(Case measured) {
  measured.run = [run = std::move(measured.run)](gpu::Context& ctx, bool quick) -> Outcome {
    Outcome out = run(ctx, quick);
    if (out && ctx.isLost()) return core::Error{core::ErrorCode::kInternal, "the device was lost: run the study again"};
    return out;
  };
  return measured;
}

}  // namespace

const std::vector<Case>& accuracyCases() {
  static const std::vector<Case> cases = [] {
    std::vector<Case> all = {
        {"eigenmode", "Frequency of a standing mode between walls", eigenmode},
        {"observed-order", "How the wave's error falls with its resolution", observedOrder},
        {"phase-error", "Speed of short plane waves, along the axis and the diagonal", phaseError},
        {"round-hump", "Rings of a hump, with both stencils", roundHump},
        {"wave-energy", "Energy of undamped waves between walls", waveEnergy},
        {"damped-mode", "Decay of a damped mode", dampedMode},
        {"reflection", "What an absorbing side sends back", reflection},
        {"greens-law", "Height of a crest that runs up a slope", greensLaw},
        {"airy", "Speed of plane waves with dispersion", airyPhaseSpeed},
        {"ripples", "Speed of plane waves with surface tension", rippleSpeed},
        {"wave-packet", "Speed of a packet of waves with dispersion", wavePacket},
        {"airy-rings", "Rings of a hump with dispersion", airyRings},
        {"shoaling", "Waves with dispersion that run up a slope of 1:10", shoaling},
        {"diffraction", "Waves with dispersion past breakwaters", diffraction},
        {"basin-modes", "Modes of a basin with an L-shaped wall, with dispersion", basinModes},
        {"thin-walls", "Dispersion and walls of one cell", thinWalls},
        {"level-water", "Dispersion and level water", dispersedStillWater},
        {"dispersed-energy", "Energy of random waves with dispersion, without losses", dispersedEnergy},
        {"kelvin-wake", "Wake of a boat with dispersion, beside the exact linear waves", kelvinWake},
        {"shallow-wake", "Wake of a boat about as fast as long waves, beside the exact linear waves", shallowWake},
        {"wind-sea", "A wind sea that comes in from outside, in the middle of open water", windSea},
        {"shallow-dam-break", "Dam breaks of nonlinear shallow water", damBreakOfShallowWater},
        {"lake", "Nonlinear water at rest around islands", lakeWithIslands},
        {"thacker", "Water that swings in bowls, with a moving shore", thackersBowl},
        {"seiche", "Period and losses of nonlinear water in closed basins", seiche},
        {"bore", "A bore at a wall", boreAtAWall},
        {"overtopping", "Water that a bore throws over a breakwater", overtopping},
        {"breaking-front", "A wave that becomes a bore, at four resolutions and levels of fidelity", breakingFront},
        {"momentum", "Momentum and energy of nonlinear water", momentumAndEnergy},
        {"run-up", "Run-up of solitary waves on a plane beach", solitaryRunUp},
        {"run-up-profiles", "The surface of a wave that runs up a plane beach, over time", runUpProfiles},
        {"bar", "Harmonics of waves behind a submerged bar", submergedBar},
        {"island", "Solitary waves that meet a conical island", conicalIsland},
        {"solitary-wave", "A solitary wave that dispersion and nonlinearity hold in balance", solitaryWave},
        {"wave-makers", "Waves that are made at a side, and what a maker does with those that come back", waveMakers},
        {"one-step", "One step on the device and in double precision", oneStep},
        {"still-water", "Particles on a level wave that should not move", stillWater},
        {"hydrostatic", "Pressure in a column at rest", hydrostaticColumn},
        {"dam-break", "Front of a collapsing column", damBreak},
        {"drop", "Drops of particles with surface tension", drops},
        {"taylor-green", "Decay of vortices in a box without sides", taylorGreen},
        {"floating-body", "Draught of a boat at rest", floatingBody},
        {"mach-wedge", "Wake of a boat faster than the waves", machWedge},
        {"boat-resistance", "Wave-making resistance of a boat over its speed", boatResistance},
        {"hull-buoyancy", "Buoyancy of a hull that another program holds", hullBuoyancy},
        {"hull-heave", "Added mass and damping of a hull that heaves", hullHeave},
        {"hull-in-waves", "Forces of waves on a hull that is held fast", hullInWaves},
        {"floating-objects", "Draught of objects at rest", floatingObjects},
        {"floater-motion", "Heave, roll and loll of objects", floaterMotion},
        {"sinking-objects", "A ball that sinks, and a heap on the bed", sinkingObjects},
    };
    for (Case& each : all) each = unlessLost(std::move(each));
    return all;
  }();
  return cases;
}

}  // namespace spindrift::study
