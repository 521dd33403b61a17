// WaterSim: changes of its scene, and its start.

#include <string>
#include <utility>

#include <shared/bindings.h>

#include <spindrift/sim_state/relay_particles.h>

#include "fits_device.h"
#include "shader_defines.h"
#include "water_sim_parts.h"

namespace spindrift::sim {
namespace {

/// Returns startingPositions() after `settle_s` without events, in which once per second all speeds are set to zero: a
/// lattice is not the solver's state of rest, and releases its surplus energy when it slides into a looser order.
core::Result<std::vector<float>> settledPositions(gpu::Context& ctx, const core::Scene& scene) {
  constexpr double kCalmInterval_s = 1.0;
  core::Scene quiet = scene;
  quiet.events.clear();
  quiet.storm.reset();
  quiet.wave_makers.clear();
  quiet.particles->settle_s = 0;
  auto water = WaterSim::create(ctx, quiet);
  if (!water) return water.error();
  double calm_at_s = kCalmInterval_s;
  while ((*water)->time_s() < scene.particles->settle_s) {
    (*water)->step();
    if ((*water)->deviceError()) return *(*water)->deviceError();
    if ((*water)->time_s() < calm_at_s) continue;
    calm_at_s += kCalmInterval_s;
    StateCopy state = (*water)->copyState();
    state.velocity.assign(state.velocity.size(), 0.0f);
    (*water)->setState(state);
  }
  return (*water)->copyState().position;
}

}  // namespace

// Creation

core::Result<std::unique_ptr<WaterSim>> WaterSim::create(gpu::Context& ctx, const core::Scene& scene,
                                                         BasinStore* basins) {
  auto derived = derive(scene);
  if (!derived) return derived.error();
  // Water settles before this one has its buffers, so that the device never holds both.
  std::vector<float> settled_positions;
  if (scene.particles && scene.particles->settle_s > 0 && !isTwoWay(scene)) {
    auto settled = settledPositions(ctx, scene);
    if (!settled) return settled.error();
    settled_positions = *std::move(settled);
  }
  auto sim = std::unique_ptr<WaterSim>(new WaterSim(ctx, scene, *std::move(derived)));
  if (auto built = sim->build(basins); !built) return built.error();
  sim->parts_->settled_positions = std::move(settled_positions);
  sim->reset();
  return sim;
}

// Changes

core::Result<void> WaterSim::setScene(const core::Scene& scene) {
  auto prepared = prepareScene(scene, sceneBasis(scene));
  if (!prepared) return prepared.error();
  return adopt(*std::move(prepared));
}

bool WaterSim::relaysParticles(const core::Scene& scene) const {
  return asksForOtherCount(scene_, scene) && !parts_->pool;
}

SceneBasis WaterSim::sceneBasis(const core::Scene& scene) {
  SceneBasis out{.scene = scene_, .derived = derived_, .state = {}, .revision = revision_};
  if (!relaysParticles(scene)) return out;
  const std::size_t n = std::size_t{derived_.particles->count} * 4;
  out.state.position = parts_->particles->position.downloadVector<float>(n);
  out.state.velocity = parts_->particles->velocity.downloadVector<float>(n);
  if (parts_->wave) out.state.elevation_m = copyElevation();
  return out;
}

core::Result<void> WaterSim::adopt(PreparedScene prepared) {
  if (prepared.revision != revision_) {
    return core::Error{core::ErrorCode::kUnavailable,
                       "the room has changed while this change was prepared (another change, a reset, or the watchdog "
                       "acted): try again"};
  }
  if (prepared.particles) {
    if (auto replaced = replaceParticles(prepared); !replaced) return replaced;
  }
  if (prepared.flow_ratio != 1.0) {
    parts_->wave->scaleFlow(prepared.flow_ratio);
    parts_->checkpoints->scaleFlow(prepared.flow_ratio);
  }
  if (parts_->wind_sea && changesWaves(scene_, prepared.scene)) parts_->wind_sea->continueIn(prepared.scene, time_s());
  const bool changes_gravity = prepared.scene.gravity_mps2 != scene_.gravity_mps2;
  scene_ = std::move(prepared.scene);
  setCareful(is_careful_);
  // Water that lands presses as high a column as gives its momentum under the gravity before.
  if (changes_gravity) parts_->pressBodies();
  if (prepared.flow_ratio != 1.0) parts_->wave->fillUpToBed(scene_, *derived_.wave);  // the water is shallower
  ++revision_;
  return {};
}

core::Result<void> WaterSim::replaceParticles(const PreparedScene& prepared) {
  if (auto fits = fitsDevice(ctx_, prepared.scene, prepared.derived); !fits) return fits;
  if (auto sized = parts_->resize(ctx_, prepared.scene, prepared.derived); !sized) {
    // The device has no memory for the new sizes. It just held the old ones; the particles have not changed.
    if (auto back = parts_->resizeBack(ctx_, scene_, derived_); !back) device_error_ = back.error();
    return sized;
  }
  derived_ = prepared.derived;
  parts_->particles->position.upload(prepared.particles->position);
  parts_->particles->velocity.upload(prepared.particles->velocity);
  parts_->particles->setDensity(prepared.scene.particles->rest_density_kgpm3);
  abandoned_until_tick_ = tick_;  // health in flight belongs to the old particles
  return {};
}

core::Result<void> WaterSim::placeGauges(std::span<const GaugePlace> places) {
  if (!derived_.wave) return core::invalid("the scene has no wave to measure");
  if (scene_.gauges.size() + places.size() > core::kMaxGauges) {
    return core::invalid(std::to_string(places.size()) + " gauges and " + std::to_string(scene_.gauges.size()) +
                         " of the scene are more than " + std::to_string(core::kMaxGauges));
  }
  Creation create(ctx_, shaderDefines(scene_));
  parts_->diagnostics->placeGauges(create, scene_, *derived_.wave, places);
  if (create.error()) return *create.error();
  PlacedGauges kept;
  for (const GaugePlace& place : places) {
    const auto known = placed_gauges_.find(place.gauge_id);
    kept[place.gauge_id] = known != placed_gauges_.end() ? known->second : std::make_shared<GaugeHistory>(1);
  }
  placed_gauges_ = std::move(kept);
  return {};
}

std::shared_ptr<const GaugeHistory> WaterSim::placedGauge(std::uint32_t gauge_id) const {
  const auto found = placed_gauges_.find(gauge_id);
  return found != placed_gauges_.end() ? found->second : nullptr;
}

void WaterSim::Parts::pressBodies() {
  if (!wave) return;
  wave->clearPressure();
  uniforms.bindUniform(SIM_UNIFORMS);
  if (boats) boats->press(*wave);
  if (floaters) floaters->press(wave->pressureHead());
}

// The start

const std::vector<float>& WaterSim::Parts::startOf(const core::Scene& scene, const ParticleLayout& layout) {
  const std::size_t wanted = std::size_t{layout.count} * 4;
  if (settled_positions.size() == wanted) return settled_positions;  // false after a change of the particle count
  const bool is_known =
      start_layout == layout && start_jitter_ratio == scene.particles->jitter_ratio && start_seed == scene.seed;
  if (!is_known) {
    starting_positions = startingPositions(scene, layout);
    start_layout = layout;
    start_jitter_ratio = scene.particles->jitter_ratio;
    start_seed = scene.seed;
  }
  return starting_positions;
}

void WaterSim::uploadStartingState() {
  if (parts_->wave) parts_->wave->clear();
  if (parts_->wind_sea) parts_->wind_sea->clear();
  if (parts_->breakers) parts_->breakers->clear();
  if (parts_->foam) parts_->foam->clear();
  if (parts_->boats) parts_->boats->reset(scene_);
  if (parts_->floaters) parts_->floaters->reset(scene_);
  if (parts_->pool) {
    parts_->pool->clear();
  } else if (parts_->particles) {
    parts_->particles->position.upload(parts_->startOf(scene_, *derived_.particles));
    parts_->particles->velocity.clear();
    // A first frame may be packed before the first step, so the density must be set.
    parts_->particles->setDensity(scene_.particles->rest_density_kgpm3);
  }
}

void WaterSim::reset() {
  parts_->effects.clear();
  start_tick_ = tick_;
  abandoned_until_tick_ = tick_;
  health_ = {};
  ledger_units_.reset();
  if (gauges_) gauges_->clear();
  for (const auto& [gauge_id, history] : placed_gauges_) history->clear();
  setCareful(false);
  uploadStartingState();
  parts_->checkpoints->forget();
  ++revision_;
}

void WaterSim::resetWith(std::uint64_t seed) {
  if (seed != 0) scene_.seed = seed;
  if (parts_->floaters) parts_->floaters->numberAfresh();
  numberBoatsFrom(1);
  reset();
}

/// The basin's tables depend on the scene only. Uploading them is the slowest part of a reset, so it is skipped when
/// unchanged.
void WaterSim::uploadBasin() {
  if (!parts_->wave) return;
  const BasinInputs inputs(scene_, *derived_.wave);
  if (parts_->basin_inputs == inputs) return;
  parts_->wave->uploadBasin(scene_, *derived_.wave);
  parts_->basin_inputs = inputs;
}

}  // namespace spindrift::sim
