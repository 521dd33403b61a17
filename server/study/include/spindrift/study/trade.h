// What there is to choose from when a scene is too dear or not true enough, one choice at a time.
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

/// The scene with one thing changed: steps, particles, resolution, stencil, kernels, solver, lattice, quantum,
/// coupling, the thesis's parameters, and another seed, which shows what chance alone does.
std::vector<TradeChoice> singleKnobs(const core::Scene& scene);

/// A run to judge others by: finer in every direction than `reference`, which is the finest that is offered.
core::Scene finerThan(const core::Scene& reference);

/// Pure particles, the pure wave, and both (thesis, tables 3.7 to 3.10): 8,192 to 65,536 particles, 64 to 1,024 cells a
/// side.
std::vector<TradeChoice> costSweep();

}  // namespace spindrift::study
