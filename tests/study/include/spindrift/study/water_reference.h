// Reference implementation of the solver in double precision: the same equations for every pair, without a grid.
#pragma once

#include <array>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::study {

using Vec3 = std::array<double, 3>;

/// The wave's surface as sampled for the coupling; n x n, x fastest. Empty = the flat floor.
struct ReferenceSurface {
  std::vector<double> eta_m, rate_mps, slope_x, slope_z, flow_x_mps, flow_z_mps;
};

/// Computes slopes, vertical speed and horizontal velocity from elevations and the flow through the faces (5-point
/// stencil).
ReferenceSurface surfaceFrom(const core::Scene& scene, const sim::Derived& derived, const std::vector<double>& eta,
                             const std::vector<float>& flow);

/// Densities [kg/m^3] of particles at `x`.
std::vector<double> referenceDensity(const core::Scene& scene, const sim::Derived& derived,
                                     const ReferenceSurface& surface, const std::vector<Vec3>& x);

/// Accelerations [m/s^2] of particles at `x` with velocities `v` and densities `rho`.
std::vector<Vec3> referenceAcceleration(const core::Scene& scene, const sim::Derived& derived,
                                        const ReferenceSurface& surface, const std::vector<Vec3>& x,
                                        const std::vector<Vec3>& v, const std::vector<double>& rho);

/// One iteration of the position-based solver at predicted positions `x`: density, multiplier, and the corrections by
/// the constraints before walls and floor limit them.
struct ReferenceProjection {
  std::vector<double> rho, lambda_m2;
  std::vector<Vec3> move_m;
};
ReferenceProjection referenceProjection(const core::Scene& scene, const sim::Derived& derived,
                                        const ReferenceSurface& surface, const std::vector<Vec3>& x);

/// One leapfrog step of the damped wave equation.
std::vector<double> referenceWaveStep(const core::Scene& scene, const sim::Derived& derived,
                                      const std::vector<double>& eta, const std::vector<double>& eta_previous);

}  // namespace spindrift::study
