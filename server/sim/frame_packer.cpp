#include "frame_packer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <shared/bindings.h>

#include <spindrift/sim_setup/frame_layout.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {

FramePacker::FramePacker(Creation& create, const core::Scene& scene, const Derived& derived) : ctx_(create.context()) {
  if (derived.wave) {
    surface_ = derived.wave->counts();
    pack_surface_ = create.pass("stream/pack_surface.comp");
  }
  if (derived.particles) pack_particles_ = create.pass("stream/pack_particles.comp");
  if (hasSurfaceFoam(scene)) pack_foam_ = create.pass("stream/pack_foam.comp");
  if (scene.boats) {
    pack_bodies_ = create.pass("stream/pack_bodies.comp");
    body_words_ = scene.boats->capacity_count * kWordsPerBody;
  }
  if (scene.floaters) {
    pack_floaters_ = create.pass("stream/pack_floaters.comp");
    floater_words_ = scene.floaters->capacity_count * kWordsPerBody;
  }
  resize(create, scene, derived);
}

void FramePacker::resize(Creation& create, const core::Scene& scene, const Derived& derived) {
  const std::size_t slot_bytes = frameSlotBytes(scene, derived);
  gpu::Buffer packed = create.buffer("packed frame", slot_bytes, gpu::BufferContent::kScratch);
  auto ring = create.ring("frames", slot_bytes, kFrameSlotCount);
  if (create.error()) return;
  packed.declareDisjointWrites();  // each layer and level writes its own part
  packed_ = std::move(packed);
  ring_ = std::move(ring);
  pending_.clear();
  particles_ = derived.particles ? derived.particles->count : 0;
  reduced_counts_ = core::reducedCounts(surface_, particles_);
}

core::CellCounts FramePacker::surfaceCount(core::Level level) const {
  return core::surfaceSamples(surface_, level);
}

core::CellCounts FramePacker::foamCount(core::Level level) const {
  return core::foamSamples(surfaceCount(level));
}

std::uint32_t FramePacker::particleBudget(core::Level level) const {
  return std::min(particles_, core::budgetOf(level).particle_count);
}

bool FramePacker::pack(std::uint64_t tick, double time_s, const core::Scene& scene, const Derived& derived,
                       const Parts& parts, const FrameRequest& request) {
  auto slot = ring_->begin();
  if (!slot) return false;
  Pending pending;
  core::FrameView& frame = pending.frame;
  frame.tick = tick;
  frame.time_s = time_s;
  frame.asked_s = request.asked_s;
  frame.state_id = request.state_id;
  frame.due = request.due;
  frame.reduced_counts = reduced_counts_;
  std::size_t at = 0;
  packed_.bindStorage(PACKED_WORDS);
  for (const core::Level level : core::kLevels) packLevel(level, request.at(level), scene, derived, parts, pending, at);
  if (parts.boats && request.bodies) {
    parts.boats->bind();
    pack_bodies_.setUniform("first_word", static_cast<std::uint32_t>(at));
    pack_bodies_.dispatchGroups(1);
    pending.bodies = at;
    frame.bodies = core::BodiesView{.count = parts.boats->count(), .words = {}};
    at += body_words_;
  }
  if (parts.floaters && request.floaters) {
    parts.floaters->bind();
    pack_floaters_.setUniform("first_word", static_cast<std::uint32_t>(at));
    pack_floaters_.dispatchGroups(1);
    frame.floaters = core::FloatersView{.count = parts.floaters->count(), .words = {}};
    pending.floaters = at;
    at += floater_words_;
  }
  if (at == 0) return false;
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);  // the next tick's passes write the buffers that were read here
  if (!slot->copyFrom(packed_, 0, at * 4, 0)) return false;
  pending.number = packed_count_++;
  slot->submit(pending.number);
  pending_.push_back(std::move(pending));
  return true;
}

void FramePacker::packLevel(core::Level level, const LayerRequest& wanted, const core::Scene& scene,
                            const Derived& derived, const Parts& parts, Pending& pending, std::size_t& at) {
  Places& places = pending.places[indexOf(level)];
  core::LevelView& view = pending.frame.at(level);
  const auto take = [&at](std::size_t words) { return std::exchange(at, at + words); };
  const bool has_planes = isSent(level, reduced_counts_.planes);
  if (parts.wave && wanted.surface && has_planes) {
    const core::CellCounts count = surfaceCount(level);
    view.surface = core::SurfaceView{.count = count,
                                     .length_m = derived.wave->length_m,
                                     .width_m = derived.wave->width_m,
                                     .quantum_m = scene.stream.surface_quantum_m,
                                     .words = {}};
    places.surface = take(surfaceWords(count));
    parts.wave->elevation().bindTexel(ELEVATION);
    packPlane(pack_surface_, *places.surface, count, surfaceWords(count));
  }
  if (parts.foam && wanted.foam && has_planes) {
    const core::CellCounts count = foamCount(level);
    view.foam = core::FoamView{
        .count = count, .length_m = derived.wave->length_m, .width_m = derived.wave->width_m, .words = {}};
    places.foam = take(foamWords(count));
    parts.foam->field().bindTexel(FOAM_FIELD);
    packPlane(pack_foam_, *places.foam, count, foamWords(count));
  }
  if (parts.particles && wanted.particles && isSent(level, reduced_counts_.particles)) {
    view.particles = particleView(level, scene, derived);
    places.particles = take(particleWords(particleBudget(level)));
    packed_.clearRange(0, *places.particles * 4, kParticleHeaderWords * 4);
    parts.particles->position.bindTexel(POSITION);
    parts.particles->velocity.bindTexel(VELOCITY);
    parts.particles->acceleration.bindTexel(ACCELERATION);
    pack_particles_.setUniform("first_word", static_cast<std::uint32_t>(*places.particles));
    pack_particles_.setUniform("budget_count", particleBudget(level));
    parts.population->forParticles(pack_particles_);
  }
}

void FramePacker::packPlane(Pass& pass, std::size_t at, core::CellCounts count, std::size_t word_count) {
  pass.setUniform("first_word", static_cast<std::uint32_t>(at));
  pass.setUniform("target_nx", count.x);
  pass.setUniform("target_nz", count.z);
  pass.dispatch(static_cast<std::uint32_t>(word_count));
}

core::ParticleView FramePacker::particleView(core::Level level, const core::Scene& scene,
                                             const Derived& derived) const {
  core::ParticleView view;
  view.count = particleBudget(level);
  const shared::SimUniforms& u = derived.uniforms;
  const double low[3] = {u.frame_min_x_m, u.min_y_m, u.frame_min_z_m};
  const double high[3] = {u.frame_max_x_m, u.max_y_m, u.frame_max_z_m};
  std::ranges::copy(low, view.min_m);
  std::ranges::copy(high, view.max_m);
  view.max_speed_mps = scene.particles->max_speed_mps;
  view.radius_m = derived.particles->spacing_m / 2;
  return view;
}

namespace {

/// Adds what the packed words say: how many particles there are, and the words of these.
void takeParticles(std::span<const std::uint32_t> words, core::ParticleView& view) {
  view.count = std::min(words[0], view.count);
  const std::uint32_t live_count = words[1];
  // The particles of a sample are drawn larger, so that together they fill the same volume.
  const double thinning = view.count > 0 ? std::max(1.0, static_cast<double>(live_count) / view.count) : 1.0;
  view.radius_m *= std::cbrt(thinning);
  view.words = words.subspan(kParticleHeaderWords, std::size_t{view.count} * kWordsPerParticle);
}

}  // namespace

std::vector<core::FrameView> FramePacker::poll() {
  std::vector<core::FrameView> out;
  for (const auto& slot : ring_->poll()) {
    // A slot whose fence failed is never returned: skip it.
    while (pending_.front().number != slot->tag()) pending_.pop_front();
    const Pending pending = std::move(pending_.front());
    pending_.pop_front();
    core::FrameView frame = pending.frame;
    frame.lease = slot;
    const auto words = slot->words();
    for (const core::Level level : core::kLevels) {
      const Places& places = pending.places[indexOf(level)];
      core::LevelView& view = frame.at(level);
      if (view.surface) view.surface->words = words.subspan(*places.surface, surfaceWords(view.surface->count));
      if (view.particles) takeParticles(words.subspan(*places.particles), *view.particles);
      if (view.foam) view.foam->words = words.subspan(*places.foam, foamWords(view.foam->count));
    }
    if (frame.bodies) frame.bodies->words = words.subspan(*pending.bodies, frame.bodies->count * kWordsPerBody);
    if (frame.floaters) frame.floaters->words = words.subspan(*pending.floaters, frame.floaters->count * kWordsPerBody);
    out.push_back(std::move(frame));
  }
  return out;
}

}  // namespace spindrift::sim
