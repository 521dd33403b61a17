// The pressure of a boat's hull on the water, as shaders/bodies/boat.glsl computes it.
#pragma once

#include <spindrift/core/scene.h>

namespace spindrift::study {

/// head(a, b) = peak exp(-(a/half_length)^4 - (b/half_beam)^4), a along the hull and b across from its centre, cut off
/// at HULL_REACH half lengths and half beams (shaders/shared/boats.h). It integrates to the volume that the boat
/// displaces.
struct HullPressure {
  double half_length_m, half_beam_m;
  double peak_m;  ///< height of water
  double volume_m3;

  [[nodiscard]] double head_m(double along_m, double across_m) const;
  /// Returns the Fourier transform: integral of head cos(k_along a) cos(k_across b). [m^3]
  [[nodiscard]] double spectrum_m3(double k_along_radpm, double k_across_radpm) const;
};

/// Returns the pressure of a settled boat on wave cells of `cell_m`. A hull narrower than three cells is spread over
/// three.
HullPressure hullPressure(const core::Boat& boat, double cell_m);

}  // namespace spindrift::study
