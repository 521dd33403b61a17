// Wave-making resistance of a pressure that moves steadily over the water, by linear theory (Airy waves).
#pragma once

#include <spindrift/study/hull_pressure.h>

namespace spindrift::study {

/// Water of constant depth. `disperses`: omega^2 = g k tanh(k d); otherwise omega^2 = g d k^2.
struct LinearWater {
  double gravity_mps2, depth_m;
  bool disperses;
  [[nodiscard]] double omega2(double k_radpm) const;  ///< [rad^2/s^2]
};

/// Resistance over the hull's weight in water without sides and losses, moving along its own axis (Havelock 1932, deep
/// water; here with omega(k) of any depth). With h the Fourier transform of the head and V its volume,
///   R / (rho g V) = 1 / (4 pi V) integral |h|^2 |k_x| omega^2 delta(U^2 k_x^2 - omega^2) dk_x dk_z
double openWaterResistance(const HullPressure& hull, const LinearWater& water, double speed_mps);

/// The same in a square basin with periodic sides and damping kappa, eta_tt + kappa eta_t = -omega^2 (eta + head), when
/// the motion is steady: a sum over the basin's wave numbers k, with A its area:
///   R / (rho g V) = 1 / (A V) sum |h|^2 k_x omega^2 kappa U k_x / ((U^2 k_x^2 - omega^2)^2 + (kappa U k_x)^2)
double basinResistance(const HullPressure& hull, const LinearWater& water, double speed_mps, double side_m,
                       double damping_per_s);

}  // namespace spindrift::study
