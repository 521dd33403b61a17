// The cases, for the list in accuracy.cpp.
#pragma once

#include <spindrift/study/accuracy.h>

namespace spindrift::study {

using Outcome = core::Result<CaseResult>;

// wave_cases.cpp
Outcome eigenmode(gpu::Context& ctx, bool quick);
Outcome observedOrder(gpu::Context& ctx, bool quick);
Outcome phaseError(gpu::Context& ctx, bool quick);
Outcome roundHump(gpu::Context& ctx, bool quick);
Outcome waveEnergy(gpu::Context& ctx, bool quick);
Outcome dampedMode(gpu::Context& ctx, bool quick);

// slope_and_side_cases.cpp
Outcome reflection(gpu::Context& ctx, bool quick);
Outcome greensLaw(gpu::Context& ctx, bool quick);

// one_step.cpp
Outcome oneStep(gpu::Context& ctx, bool quick);

// particle_cases.cpp
Outcome stillWater(gpu::Context& ctx, bool quick);
Outcome hydrostaticColumn(gpu::Context& ctx, bool quick);

// dam_break.cpp
Outcome damBreak(gpu::Context& ctx, bool quick);

// taylor_green.cpp
Outcome taylorGreen(gpu::Context& ctx, bool quick);

// body_cases.cpp
Outcome floatingBody(gpu::Context& ctx, bool quick);
Outcome machWedge(gpu::Context& ctx, bool quick);

}  // namespace spindrift::study
