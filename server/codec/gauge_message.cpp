#include <spindrift/codec/gauge_message.h>

namespace spindrift::codec {

void writeGauge(const core::DiagnosticsView::GaugeNow& gauge, v1::GaugeReading& out) {
  out.set_name(gauge.name);
  out.set_elevation_m(gauge.elevation_m);
  out.set_velocity_x_mps(gauge.velocity_x_mps);
  out.set_velocity_z_mps(gauge.velocity_z_mps);
  out.set_highest_m(gauge.highest_m);
  out.set_lowest_m(gauge.lowest_m);
}

}  // namespace spindrift::codec
