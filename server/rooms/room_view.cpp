#include <spindrift/rooms/room_view.h>

namespace spindrift::rooms {

std::vector<core::DiagnosticsView::GaugeNow> gaugesNow(const sim::WaterSim& water) {
  std::vector<core::DiagnosticsView::GaugeNow> out;
  if (!water.gauges()) return out;
  const std::vector<sim::GaugeHistory::Now> now = water.gauges()->now();
  for (std::size_t k = 0; k < now.size(); ++k) {
    out.push_back({.name = water.scene().gauges[k].name,
                   .elevation_m = now[k].reading.elevation_m,
                   .velocity_x_mps = now[k].reading.velocity_x_mps,
                   .velocity_z_mps = now[k].reading.velocity_z_mps,
                   .highest_m = now[k].highest_m,
                   .lowest_m = now[k].lowest_m});
  }
  return out;
}

core::DiagnosticsView diagnosticsOf(const sim::WaterSim& water, const TickMeter::Means& means,
                                    double real_time_factor) {
  const sim::Health& h = water.health();
  core::DiagnosticsView out;
  out.step_ms = means.step_ms;
  out.real_time_factor = real_time_factor;
  out.substeps_count = water.derived().substeps_count;
  out.particle_count = water.particleCount();
  out.max_particle_speed_mps = h.max_speed_mps;
  out.max_elevation_m = h.max_elevation_m;
  out.kinetic_energy_j = h.kinetic_energy_j;
  out.potential_energy_j = h.potential_energy_j;
  out.wave_energy_j = h.wave_energy_j;
  out.mean_density_ratio = h.mean_density_ratio;
  out.max_density_ratio = h.max_density_ratio;
  out.nonfinite_count = water.nonfiniteCount();
  out.escaped_count = water.escapedCount();
  out.recovered_count = water.recoveredCount();
  out.boat_count = water.boatCount();
  out.volume_error_units = h.volume_error_units;
  out.emitted_m3 = h.emitted_m3;
  out.absorbed_m3 = h.absorbed_m3;
  out.breaking_ratio = h.breaking_ratio;
  out.passes = means.passes;
  out.gauges = gaugesNow(water);
  return out;
}

}  // namespace spindrift::rooms
