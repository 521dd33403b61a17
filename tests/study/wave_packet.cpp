#include "wave_packet.h"

#include <cmath>
#include <numbers>

namespace spindrift::study {

WavePacket::WavePacket(const AiryWater& water, double side_m, double wavelength_m, double width_m) {
  constexpr double kSmallest = 1e-4;
  const double k0_radpm = 2 * std::numbers::pi / wavelength_m;
  double weight = 0.0;
  for (int m = 1;; ++m) {
    const double k_radpm = 2 * std::numbers::pi * m / side_m;
    const double amplitude = std::exp(-std::pow(0.5 * (k_radpm - k0_radpm) * width_m, 2));
    if (amplitude < kSmallest && k_radpm > k0_radpm) break;
    if (amplitude < kSmallest) continue;
    waves_.push_back({k_radpm, water.omega_radps(k_radpm), amplitude});
    weight += amplitude * amplitude;
    group_speed_mps_ += amplitude * amplitude * water.groupSpeed_mps(k_radpm);
    amplitude_sum_ += amplitude;
  }
  group_speed_mps_ /= weight;
}

double WavePacket::sum(double x_m, double time_s, bool is_flow) const {
  double out = 0.0;
  for (const auto& [k_radpm, omega_radps, amplitude] : waves_)
    out += amplitude * (is_flow ? omega_radps / k_radpm : 1.0) * std::cos(k_radpm * x_m - omega_radps * time_s);
  return out / amplitude_sum_;
}

void setPacket(sim::WaterSim& water, const WavePacket& packet, double amplitude_m, double middle_m) {
  const sim::WaveLayout& layout = *water.derived().wave;
  const std::size_t nx = layout.count_x;
  sim::StateCopy state = water.copyState();
  for (std::size_t x = 0; x < nx; ++x) {
    const double x_m = (static_cast<double>(x) + 0.5) * layout.cell_m - middle_m;
    const double elevation_m = amplitude_m * packet.elevationAt(x_m, 0.0);
    // The flow of the face toward +x, half a step earlier.
    const auto flow =
        static_cast<float>(amplitude_m * packet.flowAt_mps(x_m + 0.5 * layout.cell_m, -0.5 * layout.dt_s));
    for (std::size_t z = 0; z < layout.count_z; ++z) {
      state.elevation_m[x + nx * z] = elevation_m;
      state.flow_m2ps[2 * (x + nx * z)] = flow;
      state.flow_m2ps[2 * (x + nx * z) + 1] = 0.0F;
    }
  }
  water.setState(state);
}

}  // namespace spindrift::study
