#include "frame_packer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <shared/bindings.h>
#include <shared/boats.h>

#include <spindrift/sim_setup/basin.h>

#include "create_all.h"

namespace spindrift::sim {
namespace {

constexpr std::size_t kSlotCount = 4;  ///< one being filled, one in flight, one at the encoder, one spare
/// Number of packed particles, number of live particles.
constexpr std::size_t kParticleHeaderWords = 2;
constexpr std::size_t kWordsPerParticle = 3;
constexpr std::size_t kWordsPerBoat = 7;
constexpr std::size_t kBodyWords = std::size_t{MAX_BOATS} * kWordsPerBoat;

std::size_t surfaceWords(core::CellCounts count) {
  return (count.total() + 1) / 2;
}
std::size_t foamWords(core::CellCounts count) {
  return (count.total() + 3) / 4;
}
std::size_t particleWords(std::uint32_t count) {
  return kParticleHeaderWords + std::size_t{count} * kWordsPerParticle;
}

}  // namespace

core::Result<std::unique_ptr<FramePacker>> FramePacker::create(gpu::Context& ctx, const core::Scene& scene,
                                                               const Derived& derived, const gpu::Defines& defines) {
  auto out = std::unique_ptr<FramePacker>(new FramePacker(ctx));
  Creation create;
  if (derived.wave) {
    out->surface_ = derived.wave->counts();
    create(out->pack_surface_, gpu::Program::create(ctx, "stream/pack_surface.comp", defines));
  }
  if (derived.particles) create(out->pack_particles_, gpu::Program::create(ctx, "stream/pack_particles.comp", defines));
  if (hasSurfaceFoam(scene)) {
    out->has_foam_ = true;
    create(out->pack_foam_, gpu::Program::create(ctx, "stream/pack_foam.comp", defines));
  }
  if (scene.boats) create(out->pack_bodies_, gpu::Program::create(ctx, "stream/pack_bodies.comp", defines));
  if (create.error()) return *create.error();
  if (auto sized = out->resize(derived); !sized) return sized.error();
  return out;
}

core::Result<void> FramePacker::resize(const Derived& derived) {
  const std::uint32_t particles = derived.particles ? derived.particles->count : 0;
  const core::ReducedCounts reduced_counts = core::reducedCounts(surface_, particles);
  // The slot has room for all levels at once.
  std::size_t words = pack_bodies_ ? kBodyWords : 0;
  for (const core::Level level : core::kLevels) {
    if (isSent(level, reduced_counts.planes)) {
      words += surfaceWords(surfaceCount(level)) + (has_foam_ ? foamWords(foamCount(level)) : 0);
    }
    if (particles > 0 && isSent(level, reduced_counts.particles)) {
      words += particleWords(std::min(particles, core::budgetOf(level).particle_count));
    }
  }
  gpu::Buffer packed;
  std::unique_ptr<gpu::ReadbackRing> ring;
  Creation create;
  create(packed, gpu::Buffer::create(ctx_, "packed frame", words * 4, gpu::BufferUse::kDeviceOnly,
                                     gpu::BufferContent::kScratch));
  create(ring, gpu::ReadbackRing::create(ctx_, "frames", words * 4, kSlotCount));
  if (create.error()) return *create.error();
  packed.declareDisjointWrites();  // each layer and level writes its own part
  packed_ = std::move(packed);
  ring_ = std::move(ring);
  pending_.clear();
  particles_ = particles;
  reduced_counts_ = reduced_counts;
  return {};
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

bool FramePacker::pack(std::uint64_t tick, double time_s, const Parts& parts, const FrameRequest& request) {
  auto slot = ring_->begin();
  if (!slot) return false;
  Pending pending;
  pending.tick = tick;
  pending.time_s = time_s;
  pending.asked_s = request.asked_s;
  pending.state_id = request.state_id;
  pending.due = request.due;
  std::size_t at = 0;
  packed_.bindStorage(PACKED_WORDS);
  for (const core::Level level : core::kLevels) {
    pending.places[indexOf(level)] = packLevel(level, request.at(level), parts, at);
  }
  if (parts.boats && request.bodies) {
    parts.boats->bind();
    pack_bodies_.setUniform("first_word", static_cast<std::uint32_t>(at));
    pack_bodies_.dispatchGroups(1);
    pending.bodies = at;
    pending.boat_count = parts.boats->count();
    at += kBodyWords;
  }
  if (at == 0) return false;
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);  // the next tick's passes write the buffers that were read here
  if (!slot->copyFrom(packed_, 0, at * 4, 0)) return false;
  pending.number = packed_count_++;
  slot->submit(pending.number);
  pending_.push_back(pending);
  return true;
}

FramePacker::Places FramePacker::packLevel(core::Level level, const LayerRequest& wanted, const Parts& parts,
                                           std::size_t& at) {
  Places places;
  const auto take = [&at](std::size_t words) { return std::exchange(at, at + words); };
  const bool has_planes = isSent(level, reduced_counts_.planes);
  if (parts.wave && wanted.surface && has_planes) {
    const std::size_t words = surfaceWords(surfaceCount(level));
    places.surface = take(words);
    parts.wave->elevation().bindTexel(ELEVATION);
    packPlane(pack_surface_, *places.surface, surfaceCount(level), words);
  }
  if (parts.foam && wanted.foam && has_planes) {
    const std::size_t words = foamWords(foamCount(level));
    places.foam = take(words);
    parts.foam->field().bindTexel(FOAM_FIELD);
    packPlane(pack_foam_, *places.foam, foamCount(level), words);
  }
  if (parts.particles && wanted.particles && isSent(level, reduced_counts_.particles)) {
    places.particles = take(particleWords(particleBudget(level)));
    packed_.clearRange(0, *places.particles * 4, kParticleHeaderWords * 4);
    parts.population->bind();
    parts.particles->position.bindTexel(POSITION);
    parts.particles->velocity.bindTexel(VELOCITY);
    parts.particles->acceleration.bindTexel(ACCELERATION);
    pack_particles_.setUniform("first_word", static_cast<std::uint32_t>(*places.particles));
    pack_particles_.setUniform("budget_count", particleBudget(level));
    parts.population->forParticles(pack_particles_);
  }
  return places;
}

void FramePacker::packPlane(gpu::Program& program, std::size_t at, core::CellCounts count, std::size_t word_count) {
  program.setUniform("first_word", static_cast<std::uint32_t>(at));
  program.setUniform("target_nx", count.x);
  program.setUniform("target_nz", count.z);
  program.dispatch(static_cast<std::uint32_t>(word_count));
}

std::vector<core::FrameView> FramePacker::poll(const core::Scene& scene, const Derived& derived) {
  std::vector<core::FrameView> out;
  for (const auto& slot : ring_->poll()) {
    // A slot whose fence failed is never returned: skip it.
    while (pending_.front().number != slot->tag()) pending_.pop_front();
    const Pending pending = pending_.front();
    pending_.pop_front();
    core::FrameView frame;
    frame.tick = pending.tick;
    frame.time_s = pending.time_s;
    frame.asked_s = pending.asked_s;
    frame.state_id = pending.state_id;
    frame.due = pending.due;
    frame.reduced_counts = reduced_counts_;
    frame.lease = slot;
    const auto words = slot->words();
    for (const core::Level level : core::kLevels) {
      const Places& places = pending.places[indexOf(level)];
      core::LevelView& view = frame.at(level);
      if (places.surface) view.surface = surfaceView(words.subspan(*places.surface), level, scene, derived);
      if (places.particles) view.particles = particleView(words.subspan(*places.particles), level, scene, derived);
      if (places.foam) view.foam = foamView(words.subspan(*places.foam), level, derived);
    }
    if (pending.bodies) {
      frame.bodies = core::BodiesView{.count = pending.boat_count,
                                      .words = words.subspan(*pending.bodies, pending.boat_count * kWordsPerBoat)};
    }
    out.push_back(std::move(frame));
  }
  return out;
}

core::SurfaceView FramePacker::surfaceView(std::span<const std::uint32_t> words, core::Level level,
                                           const core::Scene& scene, const Derived& derived) const {
  const core::CellCounts count = surfaceCount(level);
  return {.count = count,
          .length_m = derived.wave->length_m,
          .width_m = derived.wave->width_m,
          .quantum_m = scene.stream.surface_quantum_m,
          .words = words.first(surfaceWords(count))};
}

core::FoamView FramePacker::foamView(std::span<const std::uint32_t> words, core::Level level,
                                     const Derived& derived) const {
  const core::CellCounts count = foamCount(level);
  return {.count = count,
          .length_m = derived.wave->length_m,
          .width_m = derived.wave->width_m,
          .words = words.first(foamWords(count))};
}

core::ParticleView FramePacker::particleView(std::span<const std::uint32_t> words, core::Level level,
                                             const core::Scene& scene, const Derived& derived) const {
  core::ParticleView view;
  view.count = std::min(words[0], particleBudget(level));
  const std::uint32_t live_count = words[1];
  const shared::SimUniforms& u = derived.uniforms;
  const double low[3] = {u.frame_min_x_m, u.min_y_m, u.frame_min_z_m};
  const double high[3] = {u.frame_max_x_m, u.max_y_m, u.frame_max_z_m};
  std::ranges::copy(low, view.min_m);
  std::ranges::copy(high, view.max_m);
  view.max_speed_mps = scene.particles->max_speed_mps;
  // The particles of a sample are drawn larger, so that together they fill the same volume.
  const double thinning = view.count > 0 ? std::max(1.0, static_cast<double>(live_count) / view.count) : 1.0;
  view.radius_m = derived.particles->spacing_m / 2 * std::cbrt(thinning);
  view.words = words.subspan(kParticleHeaderWords, std::size_t{view.count} * kWordsPerParticle);
  return view;
}

}  // namespace spindrift::sim
