// The kernel sets and solvers of the particle cases, and their names in tables.
#pragma once

#include <array>

#include <spindrift/core/scene.h>

namespace spindrift::study {

inline constexpr std::array kKernelSets = {core::KernelSet::kMuller, core::KernelSet::kCubicSpline,
                                           core::KernelSet::kWendlandC2};
inline constexpr std::array kSolvers = {core::PressureSolver::kWeaklyCompressible,
                                        core::PressureSolver::kPositionBased};

inline const char* nameOf(core::KernelSet set) {
  switch (set) {
    case core::KernelSet::kMuller:
      return "Mueller";
    case core::KernelSet::kCubicSpline:
      return "cubic spline";
    case core::KernelSet::kWendlandC2:
      break;
  }
  return "Wendland C2";
}

inline const char* nameOf(core::PressureSolver solver) {
  return solver == core::PressureSolver::kPositionBased ? "position-based" : "weakly compressible";
}

}  // namespace spindrift::study
