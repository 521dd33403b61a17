// WaterSim: its whole state as plain values, and a simulation that continues from there: of the same scene bit for bit,
// or of the same water.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include <fmt/format.h>
#include <shared/pool.h>

#include <spindrift/sim_state/resample_state.h>

#include "water_sim_parts.h"

namespace spindrift::sim {
namespace {

/// What the same scene may lay out in another way after changes of its parameters: numbers of steps, and every value
/// that shaders see.
std::vector<std::uint32_t> layoutWords(const Derived& derived) {
  std::vector<std::uint32_t> out(sizeof(shared::SimUniforms) / sizeof(std::uint32_t));
  std::memcpy(out.data(), &derived.uniforms, sizeof(shared::SimUniforms));
  // Scenes without surface tension keep the hashes and the saved states that they had before there was any.
  const shared::SimUniforms& u = derived.uniforms;
  if (u.capillary_ratio == 0.0f && u.tension_area_ps2 == 0.0f) out.resize(kUniformWordsBeforeTension);
  out.push_back(derived.substeps_count);
  out.push_back(derived.wave ? derived.wave->substeps_count : 0);
  return out;
}

}  // namespace

StateBuffers WaterSim::stateBuffers() {
  return parts_->stateBuffers();
}

HostState WaterSim::hostState() const {
  HostState out{.effects = parts_->effects, .boats = {{}, first_boat_id_, first_boat_id_}};
  if (parts_->boats) out.boats = parts_->boats->carried();
  if (parts_->floaters) out.floaters = parts_->floaters->carried();
  if (parts_->wind_sea) out.sea = parts_->wind_sea->carried();
  if (parts_->follower) {
    out.patch_x_m = parts_->follower->x_m();
    out.patch_z_m = parts_->follower->z_m();
  }
  return out;
}

std::size_t WaterSim::Parts::liveCount(const Derived& derived) const {
  if (!derived.particles) return 0;
  if (!pool) return derived.particles->count;
  std::uint32_t live_count = 0;
  pool->words().download(std::span(&live_count, 1), POOL_LIVE * sizeof live_count);
  return std::min(live_count, derived.particles->count);
}

SavedState WaterSim::savedState() {
  SavedState out;
  out.run_tick = tick_ - start_tick_;
  if (is_careful_) out.careful_ticks = careful_until_tick_ > tick_ ? careful_until_tick_ - tick_ : 0;
  out.particles = derived_.particles;
  out.layout = layoutWords(derived_);
  const std::size_t live_count = parts_->liveCount(derived_);
  for (const StateBuffer& each : parts_->stateBuffers()) {
    if (!each.lasts) continue;
    out.buffers.push_back(
        {each.buffer->name(), each.buffer->downloadVector<std::uint32_t>(each.wordCount(live_count))});
  }
  out.host = hostState();
  return out;
}

std::uint64_t WaterSim::stateHash() {
  return hashOf(savedState());
}

core::Result<void> WaterSim::restore(const SavedState& saved) {
  const auto differs = [&](const std::string& what) {
    return core::invalid(
        fmt::format("scene {}: the saved state is of another version of this scene or program: {}; it cannot continue "
                    "from there",
                    scene_.name, what));
  };
  if (saved.particles != derived_.particles) {
    if (!saved.particles || !derived_.particles || parts_->pool)
      return differs("its particles are laid out differently");
    // Refused before anything of that size is allocated.
    const auto has_positions = [&](const SavedBuffer& buffer) {
      return buffer.name == parts_->particles->position.name() &&
             buffer.words.size() == std::size_t{saved.particles->count} * 4;
    };
    if (std::ranges::none_of(saved.buffers, has_positions)) return differs("it has another number of particles");
    auto derived = derive(scene_, &*saved.particles);
    if (!derived) return derived.error();
    if (auto sized = parts_->resize(ctx_, scene_, *derived); !sized) return sized;
    derived_ = *std::move(derived);
    parts_->particles->setDensity(scene_.particles->rest_density_kgpm3);
  }
  setCareful(saved.careful_ticks.has_value());
  StateBuffers buffers = parts_->stateBuffers();
  std::erase_if(buffers, [](const StateBuffer& each) { return !each.lasts; });
  if (saved.layout != layoutWords(derived_)) {
    setCareful(false);
    return differs("its sizes or steps differ");
  }
  if (saved.buffers.size() != buffers.size())
    return differs(fmt::format("it has {} buffers, here are {}", saved.buffers.size(), buffers.size()));
  std::vector<const SavedBuffer*> sources;
  for (const StateBuffer& each : buffers) {
    const auto from = std::ranges::find(saved.buffers, each.buffer->name(), &SavedBuffer::name);
    if (from == saved.buffers.end()) return differs(fmt::format("it has no buffer {}", each.buffer->name()));
    const std::size_t word_count = each.wordCount(derived_.particles ? derived_.particles->count : 0);
    const bool fits =
        parts_->pool && each.per_particle ? from->words.size() <= word_count : from->words.size() == word_count;
    if (!fits)
      return differs(
          fmt::format("its buffer {} has {} words, here it has {}", from->name, from->words.size(), word_count));
    sources.push_back(&*from);
  }
  if (parts_->boats && !parts_->boats->fits(saved.host.boats)) return differs("it has another limit of boats");
  if (parts_->floaters && !parts_->floaters->fits(saved.host.floaters))
    return differs("it has another limit of floaters");
  for (std::size_t k = 0; k < buffers.size(); ++k) buffers[k].buffer->upload(sources[k]->words);
  continueWith(saved.host, saved.run_tick);
  if (parts_->wind_sea) parts_->wind_sea->resumeSteps(saved.host.sea);
  careful_until_tick_ = tick_ + saved.careful_ticks.value_or(0);
  return {};
}

CarriedState WaterSim::carriedState() {
  return {.scene = scene_, .derived = derived_, .time_s = time_s(), .state = copyState(), .host = hostState()};
}

core::Result<void> WaterSim::takeOver(const CarriedState& carried) {
  if (!isSameWater(carried.scene, scene_)) {
    return core::invalid("scene " + scene_.name + ": its sides, bed or parts differ, so it cannot continue from there");
  }
  const ResampledState resampled = resampleState(carried, scene_, derived_);
  setState(resampled.state);
  if (parts_->wave) parts_->wave->setOutflow(resampled.outflow_units);
  if (const double ratio = keptFlowRatio(carried.scene, scene_); ratio != 1.0) parts_->wave->scaleFlow(ratio);
  continueWith(carried.host, static_cast<std::uint64_t>(std::llround(carried.time_s / derived_.tick_s)));
  if (parts_->wind_sea && changesWaves(carried.scene, scene_)) parts_->wind_sea->continueIn(scene_, carried.time_s);
  parts_->pressBodies();
  return {};
}

void WaterSim::continueWith(const HostState& host, std::uint64_t run_tick) {
  parts_->effects = host.effects;
  if (parts_->boats) {
    parts_->boats->takeOver(host.boats);
    if (parts_->boats->anyMoved()) {
      if (auto ready = prepareMovedBoats(); !ready) device_error_ = ready.error();
    }
  }
  first_boat_id_ = host.boats.first_id;
  if (parts_->floaters) parts_->floaters->takeOver(host.floaters);
  if (parts_->wind_sea) parts_->wind_sea->takeOver(host.sea);
  if (parts_->follower) parts_->follower->goTo(host.patch_x_m, host.patch_z_m);
  start_tick_ = tick_ - run_tick;  // modulo 2^64
  ledger_units_.reset();
  abandoned_until_tick_ = tick_;  // health in flight belongs to the start
  parts_->checkpoints->forget();
  parts_->checkpoints->save(tick_);  // confirmed by the health of the next ticks
  ++revision_;
}

}  // namespace spindrift::sim
