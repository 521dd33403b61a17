// A packet of plane waves that travels along +x.
#pragma once

#include <vector>

#include <spindrift/sim/water_sim.h>

#include "exact_linear_waves.h"

namespace spindrift::study {

/// Waves with amplitudes exp(-((k - k0) w/2)^2) that fit into a periodic side: an envelope exp(-(x/w)^2) around x = 0.
class WavePacket {
 public:
  WavePacket(const AiryWater& water, double side_m, double wavelength_m, double width_m);

  /// Mean group speed of its waves, by energy.
  [[nodiscard]] double groupSpeed_mps() const { return group_speed_mps_; }

  /// Elevation at a position and time over its largest, and flow [m/s] over that.
  [[nodiscard]] double elevationAt(double x_m, double time_s) const { return sum(x_m, time_s, false); }
  [[nodiscard]] double flowAt_mps(double x_m, double time_s) const { return sum(x_m, time_s, true); }

 private:
  struct Wave {
    double k_radpm, omega_radps, amplitude;
  };
  [[nodiscard]] double sum(double x_m, double time_s, bool is_flow) const;

  std::vector<Wave> waves_;
  double group_speed_mps_ = 0.0;
  double amplitude_sum_ = 0.0;
};

/// Sets surface and flow to a packet around `middle_m`, counted from the side at -x, over water of even depth.
void setPacket(sim::WaterSim& water, const WavePacket& packet, double amplitude_m, double middle_m);

}  // namespace spindrift::study
