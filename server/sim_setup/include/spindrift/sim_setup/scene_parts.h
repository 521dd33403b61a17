// The parts that a scene has.
#pragma once

#include <array>
#include <cstdint>

#include <spindrift/core/scene.h>

namespace spindrift::sim {

/// A side of the water, and what waves do there.
struct WaterSide {
  core::Side side = core::Side::kMinusX;
  core::WaveBoundary boundary = core::WaveBoundary::kPeriodic;
  std::uint32_t bit = 0;  ///< shared/side_bits.h
};
/// Returns the sides in the order -x, +x, -z, +z.
std::array<WaterSide, 4> sidesOf(const core::WaveScene& wave);
/// Returns the bits of the sides that have this boundary.
std::uint32_t sidesWith(const core::WaveScene& wave, core::WaveBoundary boundary);

/// Returns whether shaders need tables: the bed or the sides differ from a flat basin with periodic sides, or with
/// walls under the 5-point stencil.
bool isVaried(const core::Scene& scene);
/// Returns whether the water has its real depth, which wets and dries (BULK_NONLINEAR).
bool isNonlinear(const core::Scene& scene);
/// Returns whether short waves are slower than long ones.
bool disperses(const core::Scene& scene);
/// Returns whether the surface of the wave has tension.
bool hasRipples(const core::Scene& scene);
/// Returns whether the surface of the particles has tension.
bool hasTension(const core::Scene& scene);
/// Returns whether a side absorbs waves in a layer.
bool isOpen(const core::Scene& scene);
/// Returns whether a side has a wave-maker.
bool hasMakers(const core::Scene& scene);
/// Returns the bit of a side (shared/side_bits.h), and those of all sides with a wave-maker.
std::uint32_t makerBit(core::Side side);
std::uint32_t makerBits(const core::Scene& scene);
/// Returns whether water can leave or enter: a side absorbs, or has a wave-maker.
bool exchangesWater(const core::Scene& scene);
/// Returns whether absorbing sides have a perfectly matched layer, not a sponge.
bool hasMatchedLayer(const core::Scene& scene);

/// Returns whether the wind waves of a storm come in through absorbing sides (sea_state.h); in other scenes with a
/// storm they are gusts (scheduled_effects.h).
bool hasWindSea(const core::Scene& scene);
/// Returns whether particles or boats read the surface.
bool isSampled(const core::Scene& scene);
bool isTwoWay(const core::Scene& scene);
/// Returns whether waves travel at other speeds in `after`.
bool changesWaves(const core::Scene& before, const core::Scene& after);
/// Returns the share of the wave's flow that remains when a scene changes to another depth or gravity; 1 unless one of
/// them falls. Removed water takes its flow with it. Under less gravity waves keep their levels and become slower, and
/// their flow with them; flow that stayed as fast would pile up more water than there was.
double keptFlowRatio(const core::Scene& before, const core::Scene& after);
/// Returns whether the surface has external pressure: from hulls or falling particles.
bool hasPressureHead(const core::Scene& scene);
/// Returns whether any part needs the breaking map of the wave.
bool hasBreakers(const core::Scene& scene);
bool hasSurfaceFoam(const core::Scene& scene);
bool isPeriodicX(const core::WaveScene& wave);
bool isPeriodicZ(const core::WaveScene& wave);

/// Returns whether particles with few neighbours become foam; the weakly compressible solver then stores the neighbour
/// count of its density pass in one more buffer.
bool countsNeighbours(const core::Scene& scene);
bool storesFoamSource(const core::Scene& scene);

/// Returns the number of what the patch follows, see shaders/coupling/follow.comp; 0 = nothing.
int followNumber(const core::Scene& scene);

/// Returns whether a change of a scene with particles changes their number.
bool asksForOtherCount(const core::Scene& before, const core::Scene& after);

}  // namespace spindrift::sim
