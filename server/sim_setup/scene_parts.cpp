#include <algorithm>
#include <cmath>

#include <shared/side_bits.h>

#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {

using core::WaveBoundary;

std::array<WaterSide, 4> sidesOf(const core::WaveScene& wave) {
  return {{{core::Side::kMinusX, wave.boundary_minus_x, MINUS_X_BIT},
           {core::Side::kPlusX, wave.boundary_plus_x, PLUS_X_BIT},
           {core::Side::kMinusZ, wave.boundary_minus_z, MINUS_Z_BIT},
           {core::Side::kPlusZ, wave.boundary_plus_z, PLUS_Z_BIT}}};
}

bool isPeriodicX(const core::WaveScene& wave) {
  return wave.boundary_minus_x == WaveBoundary::kPeriodic;
}
bool isPeriodicZ(const core::WaveScene& wave) {
  return wave.boundary_minus_z == WaveBoundary::kPeriodic;
}

bool isNonlinear(const core::Scene& scene) {
  return scene.wave && scene.wave->bulk == core::Bulk::kNonlinear;
}

bool disperses(const core::Scene& scene) {
  return scene.wave && scene.wave->dispersion == core::Dispersion::kAiry;
}

bool hasRipples(const core::Scene& scene) {
  return scene.wave && scene.wave->surface_tension_npm > 0;
}

bool hasTension(const core::Scene& scene) {
  return scene.particles && scene.particles->surface_tension_npm > 0;
}

std::uint32_t sidesWith(const core::WaveScene& wave, WaveBoundary boundary) {
  std::uint32_t bits = 0;
  for (const WaterSide& each : sidesOf(wave)) {
    if (each.boundary == boundary) bits |= each.bit;
  }
  return bits;
}

bool isOpen(const core::Scene& scene) {
  return sidesWith(*scene.wave, WaveBoundary::kAbsorb) != 0;
}

bool hasMakers(const core::Scene& scene) {
  return scene.wave && !scene.wave_makers.empty();
}

std::uint32_t makerBit(core::Side side) {
  const auto sides = sidesOf({});
  const auto found = std::ranges::find(sides, side, &WaterSide::side);
  return found != sides.end() ? found->bit : PLUS_X_BIT;
}

std::uint32_t makerBits(const core::Scene& scene) {
  std::uint32_t out = 0;
  for (const core::WaveMaker& maker : scene.wave_makers) out |= makerBit(maker.side);
  return out;
}

bool exchangesWater(const core::Scene& scene) {
  return hasMakers(scene) || isOpen(scene);
}

bool hasMatchedLayer(const core::Scene& scene) {
  if (!scene.wave || !isOpen(scene)) return false;
  if (scene.wave->absorption) return *scene.wave->absorption == core::Absorption::kPml;
  return scene.wave->stencil == core::Stencil::kFivePoint;
}

bool hasWindSea(const core::Scene& scene) {
  return scene.storm && disperses(scene) && isOpen(scene);
}

bool changesWaves(const core::Scene& before, const core::Scene& after) {
  return before.gravity_mps2 != after.gravity_mps2 || before.wave->depth_m != after.wave->depth_m;
}

double keptFlowRatio(const core::Scene& before, const core::Scene& after) {
  if (!before.wave || !after.wave) return 1.0;
  double ratio = std::min(after.wave->depth_m / before.wave->depth_m, 1.0);
  if (after.gravity_mps2 < before.gravity_mps2) ratio *= std::sqrt(after.gravity_mps2 / before.gravity_mps2);
  return ratio;
}

bool isTwoWay(const core::Scene& scene) {
  return scene.coupling && scene.coupling->mode == core::CouplingMode::kTwoWay;
}
bool hasSurfaceFoam(const core::Scene& scene) {
  return scene.wave && scene.foam && scene.foam->surface;
}
bool hasPressureHead(const core::Scene& scene) {
  return scene.wave && (scene.boats || scene.floaters || isTwoWay(scene));
}
bool hasBreakers(const core::Scene& scene) {
  return scene.wave && (isTwoWay(scene) || hasSurfaceFoam(scene) || scene.wave->steepening_ratio > 0 ||
                        (isNonlinear(scene) && disperses(scene)));
}
bool isSampled(const core::Scene& scene) {
  return scene.wave && (scene.coupling || scene.boats || scene.floaters || hasBreakers(scene));
}

bool isVaried(const core::Scene& scene) {
  const core::WaveScene& w = *scene.wave;
  const bool has_walls = !isPeriodicX(w) || !isPeriodicZ(w);
  return isNonlinear(scene) || isOpen(scene) || !scene.obstacles.empty() || !scene.beaches.empty() || scene.bed ||
         (has_walls && w.stencil == core::Stencil::kNinePoint);
}

bool countsNeighbours(const core::Scene& scene) {
  return scene.particles && scene.foam && scene.foam->neighbours_count > 0;
}

bool storesFoamSource(const core::Scene& scene) {
  return countsNeighbours(scene) && scene.particles->solver == core::PressureSolver::kWeaklyCompressible;
}

int followNumber(const core::Scene& scene) {
  if (!scene.coupling || isTwoWay(scene)) return 0;
  switch (scene.coupling->patch_follow) {
    case core::PatchFollow::kEvent:
      return 1;
    case core::PatchFollow::kBoat:
      return 2;
    case core::PatchFollow::kNothing:
      break;
  }
  return 0;
}

bool asksForOtherCount(const core::Scene& before, const core::Scene& after) {
  return before.particles && after.particles && before.particles->count != after.particles->count;
}

}  // namespace spindrift::sim
