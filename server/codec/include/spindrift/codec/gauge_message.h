// What a gauge measured, as a message: in Diagnostics and in answers of the REST interface.
#pragma once

#include <spindrift/core/frame_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

void writeGauge(const core::DiagnosticsView::GaugeNow& gauge, v1::GaugeReading& out);

}  // namespace spindrift::codec
