#include "frame_packer.h"

#include <algorithm>

#include <shared/bindings.h>
#include <shared/boats.h>
#include <shared/pool.h>

#include "basin.h"
#include "create_all.h"

namespace spindrift::sim {
namespace {

constexpr std::size_t kSlotCount = 4;  ///< one being filled, one in flight, one at the encoder, one spare
constexpr std::size_t kWordsPerParticle = 3;
constexpr std::size_t kWordsPerBoat = 7;

}  // namespace

core::Result<std::unique_ptr<FramePacker>> FramePacker::create(gpu::Context& ctx, const core::Scene& scene,
                                                               const Derived& derived, const gpu::Defines& defines) {
  auto out = std::unique_ptr<FramePacker>(new FramePacker(ctx));
  Creation create;
  if (derived.wave) {
    const std::size_t n = derived.wave->resolution_count;
    out->surface_words_ = n * n / 2;
    create(out->packed_surface_, gpu::Buffer::create(ctx, "packed surface", out->surface_words_ * 4));
    create(out->pack_surface_, gpu::Program::create(ctx, "stream/pack_surface.comp", defines));
  }
  if (derived.particles) {
    create(out->pack_particles_, gpu::Program::create(ctx, "stream/pack_particles.comp", defines));
    out->is_pooled_ = isTwoWay(scene);
    out->pool_words_ = out->is_pooled_ ? POOL_WORDS : 0;
  }
  if (hasSurfaceFoam(scene)) {
    const std::size_t n = derived.wave->resolution_count / 2;
    out->foam_words_ = n * n / 4;
    create(out->packed_foam_, gpu::Buffer::create(ctx, "packed foam", out->foam_words_ * 4));
    create(out->pack_foam_, gpu::Program::create(ctx, "stream/pack_foam.comp", defines));
  }
  if (scene.boats) {
    out->body_words_ = std::size_t{MAX_BOATS} * kWordsPerBoat;
    create(out->packed_bodies_, gpu::Buffer::create(ctx, "packed bodies", out->body_words_ * 4));
    create(out->pack_bodies_, gpu::Program::create(ctx, "stream/pack_bodies.comp", defines));
  }
  if (create.error()) return *create.error();
  if (auto sized = out->resize(derived); !sized) return sized.error();
  return out;
}

core::Result<void> FramePacker::resize(const Derived& derived) {
  gpu::Buffer packed;
  std::unique_ptr<gpu::ReadbackRing> ring;
  const std::size_t particle_words = derived.particles ? std::size_t{derived.particles->count} * kWordsPerParticle : 0;
  const std::size_t words = surface_words_ + particle_words + pool_words_ + foam_words_ + body_words_;
  Creation create;
  if (particle_words > 0) create(packed, gpu::Buffer::create(ctx_, "packed particles", particle_words * 4));
  create(ring, gpu::ReadbackRing::create(ctx_, "frames", words * 4, kSlotCount));
  if (create.error()) return *create.error();
  packed_particles_ = std::move(packed);
  ring_ = std::move(ring);
  pending_.clear();
  particle_words_ = particle_words;
  particles_ = derived.particles ? derived.particles->count : 0;
  return {};
}

bool FramePacker::pack(std::uint64_t tick, double time_s, const Parts& parts) {
  auto slot = ring_->begin();
  if (!slot) return false;
  bool copied = true;
  std::size_t at = 0;
  const auto keep = [&](const gpu::Buffer& packed, std::size_t words) {
    copied = copied && slot->copyFrom(packed, 0, words * 4, at);
  };
  if (parts.wave) {
    parts.wave->elevation().bindTexel(ELEVATION);
    packed_surface_.bindStorage(PACKED_WORDS);
    pack_surface_.dispatch(static_cast<std::uint32_t>(surface_words_));
    keep(packed_surface_, surface_words_);
  }
  at += surface_words_ * 4;
  if (parts.particles) {
    parts.population->bind();
    parts.particles->position.bindTexel(POSITION);
    parts.particles->velocity.bindTexel(VELOCITY);
    parts.particles->acceleration.bindTexel(ACCELERATION);
    packed_particles_.bindStorage(PACKED_WORDS);
    parts.population->forParticles(pack_particles_);
    keep(packed_particles_, particle_words_);
    if (is_pooled_)
      copied =
          copied && slot->copyFrom(parts.population->pool()->words(), 0, pool_words_ * 4, at + particle_words_ * 4);
  }
  at += (particle_words_ + pool_words_) * 4;
  if (parts.foam) {
    parts.foam->field().bindTexel(FOAM_FIELD);
    packed_foam_.bindStorage(PACKED_WORDS);
    pack_foam_.dispatch(static_cast<std::uint32_t>(foam_words_));
    keep(packed_foam_, foam_words_);
  }
  at += foam_words_ * 4;
  if (parts.boats) {
    parts.boats->bind();
    packed_bodies_.bindStorage(PACKED_WORDS);
    pack_bodies_.dispatchGroups(1);
    keep(packed_bodies_, body_words_);
  }
  if (!copied) return false;
  slot->submit(tick);
  pending_.push_back({.tick = tick,
                      .time_s = time_s,
                      .has_surface = parts.wave != nullptr,
                      .has_particles = parts.particles != nullptr,
                      .has_foam = parts.foam != nullptr,
                      .boat_count = parts.boats ? parts.boats->count() : 0,
                      .has_boats = parts.boats != nullptr});
  return true;
}

std::vector<core::FrameView> FramePacker::poll(const core::Scene& scene, const Derived& derived) {
  std::vector<core::FrameView> out;
  for (const auto& slot : ring_->poll()) {
    const Pending pending = pending_.front();
    pending_.pop_front();
    core::FrameView frame;
    frame.tick = pending.tick;
    frame.time_s = pending.time_s;
    frame.lease = slot;
    const auto words = slot->words();
    std::size_t at = 0;
    if (pending.has_surface) {
      frame.surface = core::SurfaceView{.resolution_count = derived.wave->resolution_count,
                                        .side_m = derived.wave->side_m,
                                        .quantum_m = scene.stream.surface_quantum_m,
                                        .words = words.subspan(at, surface_words_)};
    }
    at += surface_words_;
    if (pending.has_particles) {
      const ParticleLayout& l = *derived.particles;
      core::ParticleView view;
      view.count = is_pooled_ ? std::min(words[at + particle_words_ + POOL_LIVE], particles_) : particles_;
      const shared::SimUniforms& u = derived.uniforms;
      const double low[3] = {u.frame_min_x_m, u.min_y_m, u.frame_min_z_m};
      const double high[3] = {u.frame_max_x_m, u.max_y_m, u.frame_max_z_m};
      std::ranges::copy(low, view.min_m);
      std::ranges::copy(high, view.max_m);
      view.max_speed_mps = scene.particles->max_speed_mps;
      view.radius_m = l.spacing_m / 2;
      view.words = words.subspan(at, std::size_t{view.count} * kWordsPerParticle);
      frame.particles = view;
    }
    at += particle_words_ + pool_words_;
    if (pending.has_foam) {
      frame.foam = core::FoamView{.resolution_count = derived.wave->resolution_count / 2,
                                  .side_m = derived.wave->side_m,
                                  .words = words.subspan(at, foam_words_)};
    }
    at += foam_words_;
    if (pending.has_boats) {
      frame.bodies =
          core::BodiesView{.count = pending.boat_count, .words = words.subspan(at, pending.boat_count * kWordsPerBoat)};
    }
    out.push_back(std::move(frame));
  }
  return out;
}

}  // namespace spindrift::sim
