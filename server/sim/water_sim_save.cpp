// WaterSim: its whole state as plain values, and a simulation of the same scene that continues from there bit for bit.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "water_sim_parts.h"

namespace spindrift::sim {
namespace {

/// What the same scene may lay out in another way after changes of its parameters: numbers of steps, and every value
/// that shaders see.
std::vector<std::uint32_t> layoutWords(const Derived& derived) {
  std::vector<std::uint32_t> out(sizeof(shared::SimUniforms) / sizeof(std::uint32_t));
  std::memcpy(out.data(), &derived.uniforms, sizeof(shared::SimUniforms));
  out.push_back(derived.substeps_count);
  out.push_back(derived.wave ? derived.wave->substeps_count : 0);
  return out;
}

}  // namespace

std::vector<gpu::Buffer*> WaterSim::Parts::lastingBuffers() {
  std::vector<gpu::Buffer*> out = checkpointBuffers();
  out.push_back(&uniforms);  // the pass that moves the patch of particles changes them
  if (particles) out.push_back(&particles->acceleration);
  if (wave && wave->pressureHead()) out.push_back(&wave->pressureHead());
  if (wind_sea) out.push_back(&wind_sea->incident());
  if (boats) out.push_back(&boats->state());
  if (foam && foam->landed()) out.push_back(foam->landed());
  return out;
}

SavedState WaterSim::savedState() {
  SavedState out;
  out.run_tick = tick_ - start_tick_;
  if (is_careful_) out.careful_ticks = careful_until_tick_ > tick_ ? careful_until_tick_ - tick_ : 0;
  out.particles = derived_.particles;
  out.layout = layoutWords(derived_);
  for (const gpu::Buffer* buffer : parts_->lastingBuffers())
    out.buffers.push_back(
        {buffer->name(), buffer->downloadVector<std::uint32_t>(buffer->sizeBytes() / sizeof(std::uint32_t))});
  out.effects = parts_->effects;
  if (parts_->boats) out.boats = parts_->boats->carried();
  if (parts_->wind_sea) {
    out.sea = parts_->wind_sea->carried();
    out.sea_step_count = parts_->wind_sea->stepCount();
  }
  if (parts_->follower) {
    out.patch_x_m = parts_->follower->x_m();
    out.patch_z_m = parts_->follower->z_m();
  }
  return out;
}

core::Result<void> WaterSim::restore(const SavedState& saved) {
  const auto differs = [&](const std::string& what) {
    return core::Error{core::ErrorCode::kInvalidInput,
                       fmt::format("scene {}: the saved state is of another version of this scene or program: {}; it "
                                   "cannot continue from there",
                                   scene_.name, what)};
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
  const std::vector<gpu::Buffer*> buffers = parts_->lastingBuffers();
  if (saved.layout != layoutWords(derived_)) {
    setCareful(false);
    return differs("its sizes or steps differ");
  }
  if (saved.buffers.size() != buffers.size())
    return differs(fmt::format("it has {} buffers, here are {}", saved.buffers.size(), buffers.size()));
  for (std::size_t k = 0; k < buffers.size(); ++k) {
    const SavedBuffer& from = saved.buffers[k];
    if (from.name != buffers[k]->name() || from.words.size() * sizeof(std::uint32_t) != buffers[k]->sizeBytes())
      return differs(fmt::format("its buffer {} has {} words, here it has {}", from.name, from.words.size(),
                                 buffers[k]->sizeBytes() / sizeof(std::uint32_t)));
  }
  if (parts_->boats && !parts_->boats->fits(saved.boats)) return differs("it has another number of places for boats");
  for (std::size_t k = 0; k < buffers.size(); ++k) buffers[k]->upload(saved.buffers[k].words);
  parts_->effects = saved.effects;
  if (parts_->boats) {
    parts_->boats->takeOver(saved.boats);
    first_boat_id_ = saved.boats.first_id;
  }
  if (parts_->wind_sea) parts_->wind_sea->resume(saved.sea, saved.sea_step_count);
  if (parts_->follower) parts_->follower->goTo(saved.patch_x_m, saved.patch_z_m);
  start_tick_ = tick_ - saved.run_tick;  // modulo 2^64
  careful_until_tick_ = tick_ + saved.careful_ticks.value_or(0);
  ledger_units_.reset();
  abandoned_until_tick_ = tick_;  // health in flight belongs to the start
  parts_->checkpoints->forget();
  parts_->checkpoints->save(tick_);  // confirmed by the health of the next ticks
  ++revision_;
  return {};
}

}  // namespace spindrift::sim
