// How water answers a flow through one of its sides, per frequency: what a wave-maker has to let in, and what level it
// then finds in the cells beside it.
#pragma once

#include <complex>
#include <optional>
#include <vector>

namespace spindrift::sim {

/// For waves of small height along the normal of a side, in half a space of level bed behind it. The side is closed for
/// the pressure, as in the solver: the dispersion sees the water mirrored there.
///
/// With q exp(i w t) let in, the cell at the side has the elevation Z q, and the wave that travels away q/Y:
///   Z = (2/pi) integral over k from 0 to pi/dx of i w cos^2(k dx/2) / (w(k)^2 - w^2),   Y = dw^2/dk / (2 w cos(k
///   dx/2)).
/// Y is the group speed, not the phase speed: through a closed side no pressure of the wave outside does work. The
/// imaginary part of Z belongs to waves that do not travel and stay beside the side.
///
/// A maker sees the level after a step less half of what it lets in itself (wave/maker.comp). With q in the middle of
/// the step that is (Z exp(i w dt/2) - dt/(2 dx)) q.
class SideResponse {
 public:
  /// `dt_s`: the step. `disperses`: w^2 = g k tanh(k d), otherwise that of the grid's shallow water.
  SideResponse(double gravity_mps2, double depth_m, double cell_m, double dt_s, bool disperses);

  struct Answer {
    double wavenumber_radpm;
    double flow_mps;            ///< Y: flow per elevation of the wave that travels away
    std::complex<double> edge;  ///< level at the side per elevation of that wave, as a maker sees it
    double absorbing_mps;       ///< c_a: flow per such level with which a side sends back least of such a wave
    double sent_back;           ///< that least, over the wave that comes
  };
  /// nullopt if the grid has no travelling wave of this frequency, or one of fewer than four cells.
  [[nodiscard]] std::optional<Answer> at(double omega_radps) const;

  /// Flow per level of a wave that is not free but forced all along the water, with this frequency and wave number,
  /// that makes no free wave of the frequency beside it. Precondition: at() answers for the frequency, k_radpm is not
  /// that of the free wave.
  [[nodiscard]] double forcedFlow_mps(double omega_radps, double k_radpm) const;

  /// The same for the longest waves.
  [[nodiscard]] double longEdge() const { return 1 - 0.5 * dt_s_ / cell_m_ * long_mps_; }
  [[nodiscard]] double longAbsorbing_mps() const { return long_mps_ / (1 + 0.5 * dt_s_ / cell_m_ * long_mps_); }
  /// Highest frequency with an answer. [rad/s]
  [[nodiscard]] double highest_radps() const { return highest_radps_; }
  /// Speed of long waves, sqrt(g d).
  [[nodiscard]] double longWave_mps() const { return long_mps_; }

 private:
  [[nodiscard]] double square(double k_radpm) const;       ///< w^2
  [[nodiscard]] double squareSlope(double k_radpm) const;  ///< d w^2/dk
  [[nodiscard]] double wavenumber(double omega_radps) const;

  double gravity_mps2_, depth_m_, cell_m_, dt_s_;
  bool disperses_;
  double long_mps_ = 0.0;
  double highest_radps_ = 0.0;
  std::vector<double> k_radpm_, weight_, square_;  ///< nodes of the integral
};

}  // namespace spindrift::sim
