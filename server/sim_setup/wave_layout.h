// The cells of the wave and its largest step, for derive().
#pragma once

#include <string>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Lays out cells and speeds; substeps_count, dt_s and courant are left to derive(). Errors (kInvalidInput): cells that
/// do not fit, and choices of the wave that exclude each other. Precondition: the scene has a wave.
core::Result<WaveLayout> layOutWave(const core::Scene& scene);

/// Largest step of the wave. [s]
double waveMaxStep(const core::Scene& scene, const WaveLayout& layout);

/// The rule of waveMaxStep(), for people.
std::string waveRule(const core::Scene& scene);

}  // namespace spindrift::sim
