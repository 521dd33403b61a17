// The state of a simulation as a message, and back.
#pragma once

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_state/saved_state.h>
#include <spindrift/v1/kept_state.pb.h>

namespace spindrift::water {

v1::Side toMessage(core::Side side);
v1::StrokeTool toMessage(sim::StrokeTool tool);
sim::StrokePart toStrokePart(const v1::Stroke& stroke);
v1::WaterState toMessage(const sim::SavedState& state);

/// Error: kInvalidInput for a message that no simulation can have made.
core::Result<sim::SavedState> toSavedState(const v1::WaterState& message);

}  // namespace spindrift::water
