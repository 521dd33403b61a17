// Choices between cost and accuracy of a scene, changed one at a time.
#pragma once

#include <string>
#include <vector>

#include <spindrift/core/scene.h>

namespace spindrift::study {

struct TradeChoice {
  std::string knob;     ///< "wave resolution"
  std::string setting;  ///< "x 2"
  core::Scene scene;
};

/// Returns the scene with one change each: steps, particles, resolution, stencil, kernels, solver, lattice, quantum,
/// coupling, the thesis's parameters, and another seed, which shows the effect of chance.
std::vector<TradeChoice> singleKnobs(const core::Scene& scene);

/// Returns a scene to compare others with: finer in every direction than `reference`, the finest level. `wave_scale`:
/// factor on the wave's cells per side; particles per length get 1.25 times as many.
core::Scene finerThan(const core::Scene& reference, double wave_scale);

/// Returns the scene without the dispersion and the nonlinear bulk that it has: each alone, then both.
std::vector<TradeChoice> simplerWaves(const core::Scene& scene);

/// Particles alone, the wave alone, and both (thesis, tables 3.7 to 3.10): 8,192 to 65,536 particles, 64 to 1,024 cells
/// per side.
std::vector<TradeChoice> costSweep();

}  // namespace spindrift::study
