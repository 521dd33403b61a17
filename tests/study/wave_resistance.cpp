#include "wave_resistance.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace spindrift::study {
namespace {

using std::numbers::pi;

/// Wave numbers beyond this many over the shorter half axis of a hull have no share: its transform is below 1e-4 of its
/// volume there.
constexpr double kLongestPhase = 25.0;

/// Wave number of the waves that stand still in the frame of a boat: U^2 k^2 cos^2 = omega^2. 0 if no wave does.
double standingWave(const LinearWater& water, double component_mps, double longest_radpm) {
  const auto lead = [&](double k) { return component_mps * component_mps * k * k - water.omega2(k); };
  double low = 1e-9 * longest_radpm;
  double high = longest_radpm;
  if (lead(low) >= 0 || lead(high) <= 0) return 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (lead(middle) < 0 ? low : high) = middle;
  }
  return high;
}

}  // namespace

double LinearWater::omega2(double k_radpm) const {
  return gravity_mps2 * k_radpm * (disperses ? std::tanh(k_radpm * depth_m) : k_radpm * depth_m);
}

double openWaterResistance(const HullPressure& hull, const LinearWater& water, double speed_mps) {
  const double longest = kLongestPhase / std::min(hull.half_length_m, hull.half_beam_m);
  if (!water.disperses) {
    // All waves that stand still have the direction cos = c/U; the delta function leaves the integral over k.
    const double share = std::sqrt(water.gravity_mps2 * water.depth_m) / speed_mps;
    if (share >= 1.0) return 0.0;
    const double sine = std::sqrt(1 - share * share);
    constexpr int kSteps = 2000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double k = (i + 0.5) * longest / kSteps;
      const double h = hull.spectrum_m3(k * share, k * sine);
      sum += k * k * h * h * longest / kSteps;
    }
    return sum * share * share / (2 * pi * sine * hull.volume_m3);
  }
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = (i + 0.5) * pi / 2 / kSteps;
    const double k = standingWave(water, speed_mps * std::cos(angle), longest);
    if (k == 0.0) continue;
    const double h = hull.spectrum_m3(k * std::cos(angle), k * std::sin(angle));
    const double kd = k * water.depth_m;
    // The derivative of U^2 k^2 cos^2 - omega^2 at its root, over k g.
    const double slope = std::tanh(kd) - kd / std::pow(std::cosh(std::min(kd, 300.0)), 2);
    sum += k * k * k * std::cos(angle) * h * h * std::tanh(kd) / slope * pi / 2 / kSteps;
  }
  return sum / (pi * hull.volume_m3);
}

double basinResistance(const HullPressure& hull, const LinearWater& water, double speed_mps, double side_m,
                       double damping_per_s) {
  const double step = 2 * pi / side_m;
  const auto count = [&](double half_m) { return static_cast<int>(kLongestPhase / half_m / step); };
  double sum = 0.0;
  for (int x = 1; x <= count(hull.half_length_m); ++x) {
    for (int z = 0; z <= count(hull.half_beam_m); ++z) {
      const double h = hull.spectrum_m3(x * step, z * step);
      const double omega2 = water.omega2(step * std::hypot(x, z));
      const double passed = speed_mps * x * step;
      const double lead = passed * passed - omega2;
      const double damping = damping_per_s * passed;
      // Four wave numbers with the signs of both components, two on the axis.
      sum += (z == 0 ? 2 : 4) * h * h * x * step * omega2 * damping / (lead * lead + damping * damping);
    }
  }
  return sum / (side_m * side_m * hull.volume_m3);
}

}  // namespace spindrift::study
