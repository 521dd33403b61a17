// Exact linear waves on water of even depth (Airy): omega^2 = (g k + sigma k^3 / rho) tanh(k d). Closed forms that the
// simulation is compared with; double precision, on the host.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace spindrift::study {

/// Water of even depth.
struct AiryWater {
  double gravity_mps2 = 9.81;
  double depth_m = 1.0;
  double tension_m3ps2 = 0.0;  ///< sigma / rho; omega and the phase speed know it

  [[nodiscard]] double omega_radps(double k_radpm) const;
  /// Phase speed omega/k; sqrt(g d) at k = 0.
  [[nodiscard]] double phaseSpeed_mps(double k_radpm) const;
  /// d omega / d k.
  [[nodiscard]] double groupSpeed_mps(double k_radpm) const;
  /// Wave number of waves of a frequency, by Newton's method.
  [[nodiscard]] double waveNumber_radpm(double omega_radps) const;
  /// Wave number of the waves that stand still beside something that moves at `speed_mps`: U^2 = (g/k) tanh(k d).
  /// 0 at sqrt(g d) and faster.
  [[nodiscard]] double stationaryWaveNumber_radpm(double speed_mps) const;
};

/// A round hump of height 1 at its middle: exp(-(r/w)^2), or with a trough around it that holds as much water,
/// (1 - (r/w)^2) exp(-(r/w)^2).
enum class Hump { kGaussian, kRicker };

[[nodiscard]] double humpAt(Hump hump, double r_over_width);

/// The rings of a hump that is at rest at t = 0:
///   eta(r, t) = Int H(k) J0(k r) cos(omega(k) t) k dk, H the Hankel transform of the hump
/// (Lamb 1932, section 238), for r from 0 to `reach_m`.
class AiryRings {
 public:
  AiryRings(const AiryWater& water, Hump hump, double width_m, double time_s, double reach_m);
  /// Elevation over the height of the hump. Precondition: r_m <= reach_m.
  [[nodiscard]] double at(double r_m) const;

 private:
  double step_m_;
  std::vector<double> eta_;
};

/// Linear water on a square of n x n cells with periodic sides, under a pressure that changes with time. Each Fourier
/// mode obeys eta_tt + omega^2 (eta + head) = 0, which is solved exactly for a head that changes linearly in time.
class LinearSea {
 public:
  /// Starts level and at rest, without pressure. `n`: a power of two.
  LinearSea(const AiryWater& water, std::size_t n, double side_m);

  /// Advances to the time at which the pressure has this head [m]: n x n, x fastest.
  void advance(std::span<const double> head_m, double dt_s);
  /// Elevation [m], n x n, x fastest.
  [[nodiscard]] std::vector<double> surface() const;

 private:
  using Complex = std::complex<double>;
  [[nodiscard]] std::vector<Complex> spectrumOf(std::span<const double> field) const;

  std::size_t n_;
  /// Modes in columns of equal kx, kx from 0 to n/2, kz fastest.
  std::vector<double> omega_radps_;
  std::vector<Complex> elevation_m_, rate_mps_, head_m_;
};

}  // namespace spindrift::study
