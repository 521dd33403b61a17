// The rooms of cases, for accuracy.cpp to list.
#pragma once

#include <spindrift/study/accuracy.h>

namespace spindrift::study {

using Rows = core::Result<std::vector<Row>>;

// wave_cases.cpp
Rows eigenmode(gpu::Context& ctx, bool quick);
Rows observedOrder(gpu::Context& ctx, bool quick);
Rows phaseError(gpu::Context& ctx, bool quick);
Rows waveEnergy(gpu::Context& ctx, bool quick);
Rows dampedMode(gpu::Context& ctx, bool quick);

// slope_and_side_cases.cpp
Rows reflection(gpu::Context& ctx, bool quick);
Rows greensLaw(gpu::Context& ctx, bool quick);

// one_step.cpp
Rows oneStep(gpu::Context& ctx, bool quick);

// particle_cases.cpp
Rows stillWater(gpu::Context& ctx, bool quick);
Rows hydrostaticColumn(gpu::Context& ctx, bool quick);

// dam_break.cpp
Rows damBreak(gpu::Context& ctx, bool quick);

// taylor_green.cpp
Rows taylorGreen(gpu::Context& ctx, bool quick);

// body_cases.cpp
Rows floatingBody(gpu::Context& ctx, bool quick);
Rows machWedge(gpu::Context& ctx, bool quick);

}  // namespace spindrift::study
