#include "mild_slope.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace spindrift::study {

double SlopeToWall::depthAt_m(double x_m) const {
  return std::lerp(depth_m, wall_depth_m, std::clamp(x_m / length_m, 0.0, 1.0));
}

SlopeToWall::Response SlopeToWall::responseAt(double x_m, double omega_radps) const {
  // From the wall, where the slope of the surface is 0, toward x = 0 in steps of the method of Runge and Kutta.
  // State: eta and the flux C C_g eta'.
  const auto speeds = [&](double at_m) {
    const AiryWater water = waterAt(at_m);
    const double k = water.waveNumber_radpm(omega_radps);
    return std::array{water.phaseSpeed_mps(k) * water.groupSpeed_mps(k), k};
  };
  const auto rate = [&](double at_m, const std::array<double, 2>& state) {
    const auto [conductance, k] = speeds(at_m);
    return std::array{state[1] / conductance, -k * k * conductance * state[0]};
  };
  constexpr int kSteps = 2000;
  const double step_m = -length_m / kSteps;
  std::array<double, 2> state{1.0, 0.0};
  std::array<double, 2> found = state;
  double nearest_m = std::abs(x_m - length_m);
  for (int i = 0; i < kSteps; ++i) {
    const double at_m = length_m + i * step_m;
    const auto moved = [&](const std::array<double, 2>& slope, double share) {
      return std::array{state[0] + share * step_m * slope[0], state[1] + share * step_m * slope[1]};
    };
    const auto a = rate(at_m, state);
    const auto b = rate(at_m + 0.5 * step_m, moved(a, 0.5));
    const auto c = rate(at_m + 0.5 * step_m, moved(b, 0.5));
    const auto d = rate(std::max(at_m + step_m, 0.0), moved(c, 1.0));
    for (std::size_t j = 0; j < 2; ++j) state[j] += step_m * (a[j] + 2 * b[j] + 2 * c[j] + d[j]) / 6;
    if (std::abs(x_m - (at_m + step_m)) < nearest_m) {
      nearest_m = std::abs(x_m - (at_m + step_m));
      found = state;
    }
  }
  // At x = 0: eta = A e^(ikx) + B e^(-ikx), with the time factor e^(-i omega t); A is the incident wave.
  const auto [conductance, k] = speeds(0.0);
  const std::complex<double> incident = 0.5 * (state[0] + state[1] / conductance / std::complex<double>(0.0, k));
  return {found[0] / incident, found[1] / speeds(x_m)[0] / incident};
}

}  // namespace spindrift::study
