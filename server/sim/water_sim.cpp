#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <shared/bindings.h>
#include <shared/fixed_point.h>
#include <shared/pool.h>
#include <spdlog/spdlog.h>

#include <spindrift/sim/water_sim.h>

#include "basin.h"
#include "boats.h"
#include "breakers.h"
#include "checkpoints.h"
#include "create_all.h"
#include "diagnostics.h"
#include "effects.h"
#include "frame_packer.h"
#include "neighbor_grid.h"
#include "particle_buffers.h"
#include "particle_pool.h"
#include "patch_follower.h"
#include "position_based.h"
#include "relay_particles.h"
#include "sph.h"
#include "starting_state.h"
#include "stir.h"
#include "storm.h"
#include "surface_foam.h"
#include "wave.h"

namespace spindrift::sim {
namespace {

using core::Error;
using core::ErrorCode;

/// A reduction costs a tenth of a step on two cores; a breach is still seen within a tenth of a second, and frames hold
/// integers, so no client sees it.
constexpr std::uint64_t kDiagnosticsInterval_ticks = 4;
constexpr double kCheckpointInterval_s = 1.0;
/// A splash reaches at most this share of the way to the ground.
constexpr double kLargestDepthShare = 0.9;
/// How long a room that was put back runs with half the step.
constexpr double kCareful_s = 5.0;

/// As shaders/include/kernels.glsl numbers them.
int kernelSetNumber(core::KernelSet set) {
  switch (set) {
    case core::KernelSet::kMuller:
      return 1;
    case core::KernelSet::kCubicSpline:
      return 2;
    case core::KernelSet::kWendlandC2:
      break;
  }
  return 3;
}

/// As shaders/coupling/follow.comp numbers them; 0 = the patch stays.
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

}  // namespace

/// What the scene named, and nothing else.
struct WaterSim::Parts {
  gpu::Buffer uniforms;
  std::optional<ParticleBuffers> particles;
  std::unique_ptr<NeighborGrid> grid;
  std::unique_ptr<Sph> sph;  ///< one of the two solvers
  std::unique_ptr<PositionBased> position_based;
  std::unique_ptr<Wave> wave;
  Effects effects;
  std::unique_ptr<Breakers> breakers;
  std::unique_ptr<ParticlePool> pool;
  std::unique_ptr<Boats> boats;
  std::unique_ptr<SurfaceFoam> foam;
  std::unique_ptr<PatchFollower> follower;
  std::unique_ptr<Stir> stir;  ///< where there is no wave for effects to act on
  std::unique_ptr<FramePacker> frames;
  std::unique_ptr<Diagnostics> diagnostics;
  std::unique_ptr<Checkpoints> checkpoints;

  /// Whom the passes over particles are for.
  [[nodiscard]] Population population(const Derived& derived) const {
    return {derived.particles->count, derived.particles->cell_count, pool.get()};
  }
  [[nodiscard]] ParticleBuffers* particlesOrNull() { return particles ? &*particles : nullptr; }
  core::Result<void> makeCheckpoints(gpu::Context& ctx);
  core::Result<void> resize(gpu::Context& ctx, const core::Scene& scene, const Derived& derived);
};

gpu::Defines shaderDefines(const core::Scene& scene) {
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const bool has_particles = scene.particles.has_value();
  // The particles of a two-way scene are all over the water, and its sides are theirs.
  const bool periodic_x = isTwoWay(scene) ? isPeriodicX(*scene.wave)
                                          : has_particles && scene.particles->boundary_x == core::Boundary::kPeriodic;
  const bool periodic_z = isTwoWay(scene) ? isPeriodicZ(*scene.wave)
                                          : has_particles && scene.particles->boundary_z == core::Boundary::kPeriodic;
  return {{"PERIODIC_X", flag(periodic_x)},
          {"PERIODIC_Z", flag(periodic_z)},
          {"COUPLED", flag(scene.coupling.has_value())},
          {"KERNEL_SET", std::to_string(has_particles ? kernelSetNumber(scene.particles->kernel_set) : 3)},
          {"FOAM", flag(scene.foam.has_value())},
          {"NEIGHBOUR_FOAM", flag(countsNeighbours(scene))},
          {"TAIT", flag(has_particles && scene.particles->equation_of_state == core::EquationOfState::kTait)},
          {"COHESION", flag(has_particles && scene.particles->cohesion)},
          {"MEAN_FORCE", flag(has_particles && scene.particles->pressure_force == core::PressureForce::kMean)},
          {"LATTICE", std::to_string(scene.coupling ? scene.coupling->lattice_count : 5)},
          {"STENCIL", scene.wave && scene.wave->stencil == core::Stencil::kNinePoint ? "9" : "5"},
          {"WAVE_PERIODIC_X", flag(scene.wave && isPeriodicX(*scene.wave))},
          {"WAVE_PERIODIC_Z", flag(scene.wave && isPeriodicZ(*scene.wave))},
          {"VARIED", flag(scene.wave && isVaried(scene))},
          {"OPEN", flag(scene.wave && isOpen(scene))},
          {"HEAD", flag(hasPressureHead(scene))},
          {"BREAKERS", flag(hasBreakers(scene))},
          {"POOL_PARTICLES", flag(isTwoWay(scene))},
          {"FOLLOW", std::to_string(followNumber(scene))},
          {"HULLS", flag(scene.boats.has_value())},
          {"SURFACE_FOAM", flag(hasSurfaceFoam(scene))},
          {"LANDINGS", flag(hasSurfaceFoam(scene) && isTwoWay(scene))},
          {"STEEPEN", flag(scene.wave && scene.wave->steepening_ratio > 0)}};
}

// The algorithm

void WaterSim::step() {
  parts_->uniforms.bindUniform(SIM_UNIFORMS);  // rooms share the context
  watchHealth();
  startEvents();
  // The surface, its breakers and the boats move once a tick; the wave divides it by its own bound.
  advanceWave();
  stirParticles();
  sampleSurface();
  breakWaves();
  moveBoats();
  movePatch();
  // Particles take as many substeps as their bounds ask for.
  for (std::uint32_t substep = 0; parts_->particles && substep < derived_.substeps_count; ++substep) {
    emitParticles(substep);
    leadSurface(substep);
    predictParticles();
    buildGrid();
    advanceParticles();
  }
  fadeFoam();
  ++tick_;
  measure();
  saveCheckpoint();
}

void WaterSim::advanceWave() {
  if (!parts_->wave) return;
  const auto timer = timers_.scope("wave");
  for (std::uint32_t k = 0; k < derived_.wave->substeps_count; ++k) {
    parts_->wave->displace(parts_->effects.advance(time_s() + k * derived_.wave->dt_s, *derived_.wave));
    parts_->wave->advance(parts_->breakers ? &parts_->breakers->state() : nullptr);
  }
  parts_->wave->clearPressure();  // hulls and falling particles press anew for the next tick
}

void WaterSim::stirParticles() {
  if (!parts_->stir || parts_->effects.idle()) return;
  const auto timer = timers_.scope("stir");
  parts_->stir->apply(parts_->effects.advance(time_s(), Stir::stage(scene_, derived_)), *parts_->particles,
                      parts_->population(derived_));
}

void WaterSim::sampleSurface() {
  if (!isSampled(scene_)) return;
  const auto timer = timers_.scope("coupling");
  parts_->wave->sampleSurface();
  parts_->wave->bindSurface();
}

void WaterSim::breakWaves() {
  if (!parts_->breakers) return;
  const auto timer = timers_.scope("breaking");
  parts_->breakers->update(*parts_->wave, parts_->pool.get(), runTick());
}

void WaterSim::moveBoats() {
  if (!parts_->boats) return;
  const auto timer = timers_.scope("bodies");
  parts_->boats->move(*parts_->wave);
  parts_->boats->press(parts_->wave->pressureHead());
}

void WaterSim::emitParticles(std::uint32_t substep) {
  if (!parts_->pool) return;
  const auto timer = timers_.scope("coupling");
  parts_->pool->plan();
  if (substep == 0) parts_->pool->emit(*parts_->particles, *parts_->wave, parts_->breakers->state(), runTick());
}

void WaterSim::leadSurface(std::uint32_t substep) {
  if (!scene_.coupling || derived_.substeps_count == 1) return;
  const auto left = static_cast<double>(derived_.substeps_count - 1 - substep);
  parts_->uniforms.uploadValue(static_cast<float>(-left * derived_.dt_s),
                               offsetof(shared::SimUniforms, surface_lead_s));
  ctx_.barrier(gpu::Barrier::kUniform);
}

void WaterSim::movePatch() {
  if (parts_->follower) parts_->follower->move(parts_->uniforms, parts_->boats.get());
}

void WaterSim::fadeFoam() {
  if (!parts_->foam) return;
  const auto timer = timers_.scope("foam");
  parts_->foam->advance(*parts_->wave, *parts_->breakers, parts_->boats.get());
}

void WaterSim::predictParticles() {
  if (!parts_->position_based) return;
  const auto timer = timers_.scope("pbf");
  bindSurroundings();
  parts_->position_based->predict(*parts_->particles, parts_->population(derived_));
}

void WaterSim::buildGrid() {
  if (!parts_->particles) return;
  const auto timer = timers_.scope("grid");
  parts_->grid->build(*parts_->particles, parts_->population(derived_));
}

void WaterSim::advanceParticles() {
  if (!parts_->particles) return;
  bindSurroundings();
  const Population population = parts_->population(derived_);
  if (parts_->position_based) {
    const auto timer = timers_.scope("pbf");
    parts_->position_based->project(*parts_->particles, population, scene_.particles->iterations_count);
    parts_->position_based->finish(*parts_->particles, population);
  }
  if (!parts_->sph) return;
  const auto timer = timers_.scope("sph");
  parts_->sph->density(*parts_->particles, population);
  parts_->sph->forces(*parts_->particles, population);
  parts_->sph->integrate(*parts_->particles, population);
}

void WaterSim::bindSurroundings() {
  if (!parts_->wave) return;
  if (scene_.coupling) parts_->wave->bindSurface();
  parts_->wave->bindTerrain();
  if (parts_->boats) parts_->boats->bind();
  if (!parts_->pool) return;
  parts_->wave->elevation().bindStorage(ELEVATION);
  parts_->wave->pressureHead().bindStorage(PRESSURE_HEAD);
  if (parts_->foam) parts_->foam->landed()->bindStorage(LANDED);
}

void WaterSim::measure() {
  if (tick_ % kDiagnosticsInterval_ticks != 0) return;
  const auto timer = timers_.scope("diagnostics");
  std::optional<Population> population;
  if (parts_->particles) population = parts_->population(derived_);
  parts_->diagnostics->measure(tick_, parts_->particlesOrNull(), population ? &*population : nullptr,
                               parts_->wave.get(), parts_->breakers.get(), parts_->boats.get());
}

// Setting up

WaterSim::WaterSim(gpu::Context& ctx, core::Scene scene, Derived derived)
    : ctx_(ctx),
      scene_(std::move(scene)),
      derived_(std::move(derived)),
      timers_(ctx),
      parts_(std::make_unique<Parts>()) {}

WaterSim::~WaterSim() = default;

core::Result<std::unique_ptr<WaterSim>> WaterSim::create(gpu::Context& ctx, const core::Scene& scene) {
  auto derived = derive(scene);
  if (!derived) return derived.error();
  auto sim = std::unique_ptr<WaterSim>(new WaterSim(ctx, scene, *std::move(derived)));
  if (auto built = sim->build(); !built) return built.error();
  sim->reset();
  return sim;
}

core::Result<void> WaterSim::build() {
  const gpu::Defines defines = shaderDefines(scene_);
  Creation create;
  create(parts_->uniforms, gpu::Buffer::create(ctx_, "sim uniforms", sizeof(shared::SimUniforms)));
  if (derived_.wave) create(parts_->wave, Wave::create(ctx_, scene_, *derived_.wave, defines, isSampled(scene_)));
  if (derived_.particles) {
    create(parts_->particles.emplace(),
           ParticleBuffers::create(ctx_, derived_.particles->count, storesFoamSource(scene_)));
    create(parts_->grid, NeighborGrid::create(ctx_, *derived_.particles, defines, isTwoWay(scene_)));
    if (scene_.particles->solver == core::PressureSolver::kPositionBased)
      create(parts_->position_based, PositionBased::create(ctx_, defines));
    else
      create(parts_->sph, Sph::create(ctx_, defines));
  }
  if (hasBreakers(scene_)) create(parts_->breakers, Breakers::create(ctx_, *derived_.wave, defines));
  if (isTwoWay(scene_)) create(parts_->pool, ParticlePool::create(ctx_, *derived_.particles, defines));
  if (scene_.boats) create(parts_->boats, Boats::create(ctx_, scene_, *derived_.wave, defines));
  if (hasSurfaceFoam(scene_)) create(parts_->foam, SurfaceFoam::create(ctx_, scene_, *derived_.wave, defines));
  if (!scene_.wave) create(parts_->stir, Stir::create(ctx_, defines));
  if (followNumber(scene_) != 0) create(parts_->follower, PatchFollower::create(ctx_, scene_, defines));
  create(parts_->frames, FramePacker::create(ctx_, scene_, derived_, defines));
  create(parts_->diagnostics, Diagnostics::create(ctx_, derived_, defines));
  if (create.error()) return *create.error();
  return parts_->makeCheckpoints(ctx_);
}

core::Result<void> WaterSim::Parts::makeCheckpoints(gpu::Context& ctx) {
  std::vector<gpu::Buffer*> state;
  if (wave) {
    state = {&wave->elevation(), &wave->flow()};
    if (auto* outflow = wave->outflow()) state.push_back(outflow);
  }
  if (particles) state.insert(state.end(), {&particles->position, &particles->velocity});
  if (pool) state.push_back(&pool->words());
  if (breakers) state.push_back(&breakers->state());
  if (foam) state.push_back(&foam->field());
  auto made = Checkpoints::create(ctx, state);
  if (!made) return made.error();
  checkpoints = *std::move(made);
  return {};
}

/// Whatever depends on the number of particles, made anew; programs stay. After an error parts may be of either size:
/// size them back.
core::Result<void> WaterSim::Parts::resize(gpu::Context& ctx, const core::Scene& scene, const Derived& derived) {
  auto fresh = ParticleBuffers::create(ctx, derived.particles->count, storesFoamSource(scene));
  if (!fresh) return fresh.error();
  if (auto sized = grid->resize(*derived.particles); !sized) return sized.error();
  if (auto sized = frames->resize(derived); !sized) return sized.error();
  if (auto sized = diagnostics->resize(derived); !sized) return sized.error();
  particles = *std::move(fresh);
  return makeCheckpoints(ctx);
}

void WaterSim::uploadStartingState() {
  if (parts_->wave) parts_->wave->clear();
  if (parts_->breakers) parts_->breakers->clear();
  if (parts_->foam) parts_->foam->clear();
  if (parts_->boats) parts_->boats->reset(scene_);
  if (parts_->pool) {
    parts_->pool->clear();
  } else if (parts_->particles) {
    parts_->particles->position.upload(startingPositions(scene_, *derived_.particles));
    parts_->particles->velocity.clear();
    // Density is known before the first step, so that a first frame can be packed.
    const auto rho_0 = static_cast<float>(scene_.particles->rest_density_kgpm3);
    parts_->particles->acceleration.upload(std::vector<float>(std::size_t{derived_.particles->count} * 4, rho_0));
  }
  ctx_.barrier(gpu::Barrier::kBufferUpdate | gpu::Barrier::kStorageAndTexel);
}

void WaterSim::reset() {
  parts_->effects.clear();
  start_tick_ = tick_;
  abandoned_until_tick_ = tick_;
  health_ = {};
  setCareful(false);
  uploadStartingState();
  parts_->checkpoints->forget();
}

// Commands

core::Result<void> WaterSim::start(const core::Effect& effect) {
  auto started = parts_->effects.start(effect, time_s());
  const auto* splash = std::get_if<core::Splash>(&effect);
  if (started && splash && parts_->follower) parts_->follower->goTo(splash->x_m, splash->z_m);
  return started;
}

core::Result<std::uint32_t> WaterSim::spawnBoat(const core::Boat& boat) {
  if (!parts_->boats)
    return Error{ErrorCode::kInvalidInput, "this scene has no boats: choose one whose file has \"boats {}\""};
  return parts_->boats->spawn(boat);
}

core::Result<void> WaterSim::controlBoat(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio) {
  if (!parts_->boats) return Error{ErrorCode::kInvalidInput, "this scene has no boats"};
  return parts_->boats->control(boat_id, throttle_ratio, rudder_ratio);
}

core::Result<void> WaterSim::removeBoat(std::uint32_t boat_id) {
  if (!parts_->boats) return Error{ErrorCode::kInvalidInput, "this scene has no boats"};
  return parts_->boats->remove(boat_id);
}

std::vector<BoatRecord> WaterSim::boats() const {
  return parts_->boats ? parts_->boats->records() : std::vector<BoatRecord>{};
}

std::uint32_t WaterSim::particleCount() const {
  if (!derived_.particles) return 0;
  return parts_->pool ? health_.particle_count : derived_.particles->count;
}

core::Result<void> WaterSim::setScene(const core::Scene& scene) {
  auto fresh = derive(scene);
  if (!fresh) return fresh.error();
  const bool relays = scene.particles && scene_.particles && scene.particles->count != scene_.particles->count;
  // Compared with a fresh start of the scene as it was, but for the number of particles: the running layout may be one
  // that no fresh start has.
  // A pool's places are counted on the device and do not move.
  if (relays && parts_->pool) {
    return Error{
        ErrorCode::kInvalidInput,
        "particles.count: is the size of the pool of this two-way scene: start the room again with the changed scene"};
  }
  core::Scene comparable = scene_;
  if (relays) comparable.particles->count = scene.particles->count;
  const auto before = derive(comparable);
  if (!before || needsRestart(*before, *fresh) || shaderDefines(scene_) != shaderDefines(scene) ||
      (scene.particles && scene.particles->solver != scene_.particles->solver)) {
    return Error{ErrorCode::kInvalidInput,
                 "this change needs new buffers or shaders: start the room again with the changed scene"};
  }
  if (relays) {
    if (auto relaid = relay(scene); !relaid) return relaid.error();
  }
  scene_ = scene;
  setCareful(is_careful_);
  return {};
}

core::Result<void> WaterSim::relay(const core::Scene& scene) {
  const auto layout = layOutAgain(scene, *derived_.particles);
  if (!layout) return layout.error();
  auto derived = derive(scene, &*layout);
  if (!derived) return derived.error();
  const StateCopy state = copyState();
  const RelaidParticles particles = relayParticles(scene, derived_, state, *layout);
  if (auto sized = parts_->resize(ctx_, scene, *derived); !sized) {
    // The device refused. Back to the old size, which it held a moment ago, and to the old state.
    if (auto back = parts_->resize(ctx_, scene_, derived_); !back) return back.error();
    setState(state);
    return sized.error();
  }
  derived_ = *std::move(derived);
  parts_->particles->position.upload(particles.position);
  parts_->particles->velocity.upload(particles.velocity);
  parts_->particles->acceleration.upload(std::vector<float>(std::size_t{derived_.particles->count} * 4,
                                                            static_cast<float>(scene.particles->rest_density_kgpm3)));
  ctx_.barrier(gpu::Barrier::kBufferUpdate | gpu::Barrier::kStorageAndTexel);
  abandoned_until_tick_ = tick_;  // what is still to come is about the old particles
  return {};
}

void WaterSim::startEvents() {
  if (scene_.storm) {
    for (const core::Effect& effect : stormEffects(scene_, *derived_.wave, tick_ - start_tick_, derived_.tick_s)) {
      // Weather gives way to people: a drop that finds no place does not fall.
      (void)parts_->effects.start(effect, time_s(),
                                  std::holds_alternative<core::Splash>(effect) ? kSpareSplashes : kSpareCrests);
    }
  }
  const double from_s = time_s();
  const double to_s = from_s + derived_.tick_s;
  for (const core::TimedEvent& event : scene_.events) {
    const double repeats =
        event.every_s > 0 ? std::max(0.0, std::ceil((from_s - event.at_s) / event.every_s - 1e-9)) : 0.0;
    const double due_s = event.at_s + repeats * event.every_s;
    if (due_s < from_s - 1e-9 || due_s >= to_s - 1e-9) continue;
    core::Effect effect = event.effect;
    // The scene was checked with the depth it began with; an effect shrinks with water that was made shallower since.
    if (auto* splash = std::get_if<core::Splash>(&effect); splash && scene_.wave) {
      splash->depth_m = std::min(splash->depth_m, kLargestDepthShare * scene_.wave->depth_m);
    }
    if (auto started = start(effect); !started) spdlog::warn("scene {}: {}", scene_.name, started.error().message);
  }
}

// Health

void WaterSim::watchHealth() {
  for (const Health& health : parts_->diagnostics->poll(scene_, derived_)) {
    if (health.tick <= abandoned_until_tick_) continue;
    health_ = health;
    nonfinite_count_ += health.nonfinite_count;
    escaped_count_ += health.escaped_count;
    if (health.isGood()) {
      parts_->checkpoints->confirm(health.tick);
    } else {
      recover(health);
      return;
    }
  }
  if (is_careful_ && tick_ >= careful_until_tick_) setCareful(false);
}

void WaterSim::saveCheckpoint() {
  const auto interval = static_cast<std::uint64_t>(std::ceil(kCheckpointInterval_s / derived_.tick_s));
  if (tick_ % interval == 0) parts_->checkpoints->save(tick_);
}

void WaterSim::recover(const Health& breach) {
  ++recovered_count_;
  const bool restored = parts_->checkpoints->restore();
  if (!restored) uploadStartingState();
  if (parts_->boats) parts_->boats->mend();
  parts_->effects.clear();
  abandoned_until_tick_ = tick_;
  careful_until_tick_ = tick_ + static_cast<std::uint64_t>(kCareful_s / derived_.tick_s);
  setCareful(true);
  if (recovered_count_ <= 10 || recovered_count_ % 100 == 0) {
    spdlog::warn(
        "scene {}: tick {} has {} non-finite values and {} escaped particles; went back to {} with half the step for "
        "{} s (guard stepped in {} times)",
        scene_.name, breach.tick, breach.nonfinite_count, breach.escaped_count,
        restored ? "the last good checkpoint" : "the start", kCareful_s, recovered_count_);
  }
}

void WaterSim::setCareful(bool careful) {
  is_careful_ = careful;
  const std::optional<ParticleLayout> kept = derived_.particles;
  auto derived = derive(scene_, kept ? &*kept : nullptr);
  if (derived && careful) {
    core::Scene halved = scene_;
    halved.fixed_substeps_count = 2 * derived->substeps_count;
    derived = derive(halved, kept ? &*kept : nullptr);
  }
  // scene_ was accepted before and halving a step breaks no rule; at the bound of substeps the step stays as it was.
  if (derived) derived_ = *std::move(derived);
  parts_->uniforms.uploadValue(derived_.uniforms);
  if (parts_->wave) parts_->wave->uploadBasin(scene_, *derived_.wave);
  ctx_.barrier(gpu::Barrier::kUniform | gpu::Barrier::kBufferUpdate | gpu::Barrier::kStorageAndTexel);
}

// Frames

bool WaterSim::requestFrame(const FrameRequest& request) {
  std::optional<Population> population;
  if (parts_->particles) population = parts_->population(derived_);
  const FramePacker::Parts wanted{.wave = request.surface ? parts_->wave.get() : nullptr,
                                  .particles = request.particles ? parts_->particlesOrNull() : nullptr,
                                  .population = population ? &*population : nullptr,
                                  .foam = request.foam ? parts_->foam.get() : nullptr,
                                  .boats = request.bodies ? parts_->boats.get() : nullptr};
  if (!wanted.wave && !wanted.particles && !wanted.foam && !wanted.boats) return false;
  const auto timer = timers_.scope("stream");
  parts_->uniforms.bindUniform(SIM_UNIFORMS);
  return parts_->frames->pack(tick_, time_s(), wanted);
}

std::vector<core::FrameView> WaterSim::takeFrames() {
  return parts_->frames->poll(scene_, derived_);
}

// State

StateCopy WaterSim::copyState() {
  ctx_.barrier(gpu::Barrier::kBufferUpdate);
  StateCopy out;
  if (parts_->particles) {
    std::size_t count = derived_.particles->count;
    if (parts_->pool) {
      out.pool = parts_->pool->words().downloadVector<std::uint32_t>(POOL_WORDS);
      count = out.pool[POOL_LIVE];
    }
    const std::size_t n = count * 4;
    out.position = parts_->particles->position.downloadVector<float>(n);
    out.velocity = parts_->particles->velocity.downloadVector<float>(n);
    const auto acceleration = parts_->particles->acceleration.downloadVector<float>(n);
    for (std::size_t i = 3; i < n; i += 4) out.density_kgpm3.push_back(acceleration[i]);
  }
  if (parts_->wave) {
    const std::size_t n = std::size_t{derived_.wave->resolution_count} * derived_.wave->resolution_count;
    for (const std::int32_t units : parts_->wave->elevation().downloadVector<std::int32_t>(n))
      out.elevation_m.push_back(units * double{ELEVATION_UNIT_M});
    if (parts_->boats)
      out.boats = parts_->boats->state().downloadVector<float>(std::size_t{MAX_BOATS} * BOAT_TEXELS * 4);
    out.flow_m2ps = parts_->wave->flow().downloadVector<float>(n * parts_->wave->flowComponents());
  }
  return out;
}

void WaterSim::setState(const StateCopy& state) {
  if (parts_->particles) {
    parts_->particles->position.upload(state.position);
    parts_->particles->velocity.upload(state.velocity);
  }
  if (parts_->wave) {
    std::vector<std::int32_t> units;
    for (const double eta_m : state.elevation_m)
      units.push_back(static_cast<std::int32_t>(std::lround(eta_m * double{ELEVATION_UNITS_PER_M})));
    parts_->wave->elevation().upload(units);
    parts_->wave->flow().upload(state.flow_m2ps);
  }
  ctx_.barrier(gpu::Barrier::kBufferUpdate | gpu::Barrier::kStorageAndTexel);
}

std::uint64_t WaterSim::stateHash() {
  const StateCopy state = copyState();
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto add = [&](std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001b3ull;
  };
  add(std::as_bytes(std::span(state.position)));
  add(std::as_bytes(std::span(state.velocity)));
  add(std::as_bytes(std::span(state.elevation_m)));
  add(std::as_bytes(std::span(state.flow_m2ps)));
  add(std::as_bytes(std::span(state.boats)));
  add(std::as_bytes(std::span(state.pool)));
  return hash;
}

}  // namespace spindrift::sim
