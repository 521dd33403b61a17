#include "frame_packer.h"

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {
namespace {

constexpr std::size_t kSlotCount = 4;  ///< one being filled, one in flight, one at the encoder, one spare
constexpr std::size_t kWordsPerParticle = 3;

}  // namespace

core::Result<std::unique_ptr<FramePacker>> FramePacker::create(gpu::Context& ctx, const Derived& derived,
                                                               const gpu::Defines& defines) {
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
  }
  if (create.error()) return *create.error();
  if (auto sized = out->resize(derived); !sized) return sized.error();
  return out;
}

core::Result<void> FramePacker::resize(const Derived& derived) {
  gpu::Buffer packed;
  std::unique_ptr<gpu::ReadbackRing> ring;
  const std::size_t particle_bytes =
      derived.particles ? std::size_t{derived.particles->count} * kWordsPerParticle * 4 : 0;
  Creation create;
  if (particle_bytes > 0) create(packed, gpu::Buffer::create(ctx_, "packed particles", particle_bytes));
  create(ring, gpu::ReadbackRing::create(ctx_, "frames", surface_words_ * 4 + particle_bytes, kSlotCount));
  if (create.error()) return *create.error();
  packed_particles_ = std::move(packed);
  ring_ = std::move(ring);
  pending_.clear();
  particles_ = derived.particles ? derived.particles->count : 0;
  return {};
}

bool FramePacker::pack(std::uint64_t tick, double time_s, const ParticleBuffers* particles, Wave* wave) {
  auto slot = ring_->begin();
  if (!slot) return false;
  bool copied = true;
  if (wave) {
    wave->elevation().bindTexel(ELEVATION);
    packed_surface_.bindStorage(PACKED_WORDS);
    pack_surface_.dispatch(static_cast<std::uint32_t>(surface_words_));
    copied = slot->copyFrom(packed_surface_, 0, packed_surface_.sizeBytes(), 0);
  }
  if (particles) {
    particles->position.bindTexel(POSITION);
    particles->velocity.bindTexel(VELOCITY);
    particles->acceleration.bindTexel(ACCELERATION);
    packed_particles_.bindStorage(PACKED_WORDS);
    pack_particles_.dispatch(particles_);
    copied = copied && slot->copyFrom(packed_particles_, 0, packed_particles_.sizeBytes(), surface_words_ * 4);
  }
  if (!copied) return false;
  slot->submit(tick);
  pending_.push_back({tick, time_s, wave != nullptr, particles != nullptr});
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
    if (pending.has_surface) {
      frame.surface = core::SurfaceView{.resolution_count = derived.wave->resolution_count,
                                        .side_m = derived.wave->side_m,
                                        .quantum_m = scene.stream.surface_quantum_m,
                                        .words = words.subspan(0, surface_words_)};
    }
    if (pending.has_particles) {
      const ParticleLayout& l = *derived.particles;
      core::ParticleView view;
      view.count = l.count;
      for (int axis = 0; axis < 3; ++axis) {
        view.min_m[axis] = l.min_m[axis];
        view.max_m[axis] = l.max_m[axis];
      }
      view.max_speed_mps = scene.particles->max_speed_mps;
      view.radius_m = l.spacing_m / 2;
      view.words = words.subspan(surface_words_, std::size_t{particles_} * kWordsPerParticle);
      frame.particles = view;
    }
    out.push_back(std::move(frame));
  }
  return out;
}

}  // namespace spindrift::sim
