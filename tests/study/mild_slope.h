// Waves over a bed that rises evenly to a wall, by the mild-slope equation (Berkhoff 1972):
//   (C C_g eta')' + k^2 C C_g eta = 0
#pragma once

#include <complex>

#include "exact_linear_waves.h"

namespace spindrift::study {

/// Water of even depth that becomes shallower from x = 0 to a reflecting wall at x = `length_m`.
struct SlopeToWall {
  double gravity_mps2 = 9.81;
  double depth_m = 1.0;
  double wall_depth_m = 0.1;
  double length_m = 10.0;

  [[nodiscard]] double depthAt_m(double x_m) const;
  [[nodiscard]] AiryWater waterAt(double x_m) const { return {gravity_mps2, depthAt_m(x_m)}; }

  /// Elevation and its slope [1/m] at x, for an incident wave of amplitude 1 that comes from x < 0. Precondition:
  /// 0 <= x_m <= length_m.
  struct Response {
    std::complex<double> elevation, slope_pm;
  };
  [[nodiscard]] Response responseAt(double x_m, double omega_radps) const;
};

}  // namespace spindrift::study
