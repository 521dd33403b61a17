#include <algorithm>
#include <cmath>
#include <optional>

#include <shared/bindings.h>
#include <spdlog/spdlog.h>

#include <spindrift/sim/water_sim.h>

#include "checkpoints.h"
#include "create_all.h"
#include "diagnostics.h"
#include "effects.h"
#include "frame_packer.h"
#include "neighbor_grid.h"
#include "particle_buffers.h"
#include "sph.h"
#include "starting_state.h"
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

}  // namespace

/// What the scene named, and nothing else.
struct WaterSim::Parts {
  gpu::Buffer uniforms;
  std::optional<ParticleBuffers> particles;
  std::unique_ptr<NeighborGrid> grid;
  std::unique_ptr<Sph> sph;
  std::unique_ptr<Wave> wave;
  Effects effects;
  std::unique_ptr<FramePacker> frames;
  std::unique_ptr<Diagnostics> diagnostics;
  std::unique_ptr<Checkpoints> checkpoints;

  [[nodiscard]] ParticleBuffers* particlesOrNull() { return particles ? &*particles : nullptr; }
};

gpu::Defines shaderDefines(const core::Scene& scene) {
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const bool has_particles = scene.particles.has_value();
  return {{"PERIODIC_X", flag(has_particles && scene.particles->boundary_x == core::Boundary::kPeriodic)},
          {"PERIODIC_Z", flag(has_particles && scene.particles->boundary_z == core::Boundary::kPeriodic)},
          {"COUPLED", flag(scene.coupling.has_value())},
          {"KERNEL_SET", std::to_string(has_particles ? kernelSetNumber(scene.particles->kernel_set) : 3)},
          {"FOAM", flag(scene.foam.has_value())},
          {"LATTICE", std::to_string(scene.coupling ? scene.coupling->lattice_count : 5)},
          {"STENCIL", scene.wave && scene.wave->stencil == core::Stencil::kNinePoint ? "9" : "5"},
          {"WAVE_PERIODIC", flag(scene.wave && scene.wave->boundary_minus_x == core::WaveBoundary::kPeriodic)}};
}

// The algorithm

void WaterSim::step() {
  parts_->uniforms.bindUniform(SIM_UNIFORMS);  // rooms share the context
  watchHealth();
  startTimedEvents();
  for (std::uint32_t substep = 0; substep < derived_.substeps_count; ++substep) {
    advanceWave(time_s() + substep * derived_.dt_s);
    sampleSurface();
    buildGrid();
    advanceParticles();
  }
  ++tick_;
  measure();
  saveCheckpoint();
}

void WaterSim::advanceWave(double time_s) {
  if (!parts_->wave) return;
  const auto timer = timers_.scope("wave");
  for (std::uint32_t k = 0; k < derived_.wave->substeps_count; ++k) {
    if (!parts_->effects.idle())
      parts_->wave->inject(parts_->effects.advance(time_s + k * derived_.wave->dt_s, *derived_.wave));
    parts_->wave->evolve();
  }
}

void WaterSim::sampleSurface() {
  if (!scene_.coupling) return;
  const auto timer = timers_.scope("coupling");
  parts_->wave->sampleSurface();
  parts_->wave->bindSurface();
}

void WaterSim::buildGrid() {
  if (!parts_->particles) return;
  const auto timer = timers_.scope("grid");
  parts_->grid->build(*parts_->particles);
}

void WaterSim::advanceParticles() {
  if (!parts_->particles) return;
  const auto timer = timers_.scope("sph");
  parts_->sph->density(*parts_->particles);
  parts_->sph->forces(*parts_->particles);
  parts_->sph->integrate(*parts_->particles);
}

void WaterSim::measure() {
  if (tick_ % kDiagnosticsInterval_ticks != 0) return;
  const auto timer = timers_.scope("diagnostics");
  parts_->diagnostics->measure(tick_, parts_->particlesOrNull(), parts_->wave.get());
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
  if (derived_.wave) create(parts_->wave, Wave::create(ctx_, *derived_.wave, defines, scene_.coupling.has_value()));
  if (derived_.particles) {
    const std::size_t n = derived_.particles->count;
    ParticleBuffers& p = parts_->particles.emplace();
    const auto make = [&](gpu::TexelBuffer& buffer, const char* name) {
      create(buffer, gpu::TexelBuffer::create(ctx_, name, n, gpu::TexelFormat::kRGBA32F));
    };
    make(p.position, "position");
    make(p.velocity, "velocity");
    make(p.sorted_position, "sorted position");
    make(p.sorted_velocity, "sorted velocity");
    make(p.pressure_point, "pressure point");
    make(p.motion_point, "motion point");
    make(p.acceleration, "acceleration");
    create(parts_->grid, NeighborGrid::create(ctx_, *derived_.particles, defines));
    create(parts_->sph, Sph::create(ctx_, *derived_.particles, defines));
  }
  create(parts_->frames, FramePacker::create(ctx_, derived_, defines));
  create(parts_->diagnostics, Diagnostics::create(ctx_, derived_, defines));
  if (create.error()) return *create.error();
  std::vector<gpu::Buffer*> state;
  if (parts_->wave) {
    state = {&parts_->wave->elevationPrevious(), &parts_->wave->elevation()};
    if (scene_.coupling) state.push_back(&parts_->wave->flow());
  }
  if (parts_->particles) state.insert(state.end(), {&parts_->particles->position, &parts_->particles->velocity});
  create(parts_->checkpoints, Checkpoints::create(ctx_, state));
  if (create.error()) return *create.error();
  return {};
}

void WaterSim::uploadStartingState() {
  if (parts_->wave) {
    parts_->wave->elevation().clear();
    parts_->wave->elevationPrevious().clear();
    if (scene_.coupling) parts_->wave->flow().clear();
  }
  if (parts_->particles) {
    parts_->particles->position.upload(startingPositions(scene_, *derived_.particles));
    parts_->particles->velocity.clear();
    // Density is known before the first step, so that a first frame can be packed.
    const auto rho_0 = static_cast<float>(scene_.particles->rest_density_kgpm3);
    parts_->particles->acceleration.upload(std::vector<float>(std::size_t{derived_.particles->count} * 4, rho_0));
  }
  ctx_.barrier(gpu::Barrier::kBufferUpdate | gpu::Barrier::kStorageAndTexel);
}

void WaterSim::reset() {
  boats_.clear();
  last_boat_id_ = 0;
  if (scene_.boats) {
    for (const core::Boat& boat : scene_.boats->boats) (void)spawnBoat(boat);
  }
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
  if (!parts_->wave)
    return Error{ErrorCode::kInvalidInput, "effects act on the wave, and this scene has none: use a scene with a wave"};
  return parts_->effects.start(effect, time_s());
}

// Boats

core::Result<std::uint32_t> WaterSim::spawnBoat(const core::Boat& boat) {
  if (!scene_.boats) return Error{ErrorCode::kInvalidInput, "this scene has no boats: use a scene that has"};
  if (boats_.size() >= scene_.boats->capacity_count) {
    return Error{ErrorCode::kUnavailable,
                 "all " + std::to_string(boats_.size()) + " places for boats are taken: remove a boat first"};
  }
  boats_.push_back({.boat_id = ++last_boat_id_,
                    .length_m = boat.length_m,
                    .beam_m = boat.beam_m,
                    .height_m = boat.height_m,
                    .draught_m = boat.density_ratio * boat.height_m});
  return last_boat_id_;
}

core::Result<void> WaterSim::controlBoat(std::uint32_t boat_id, double /*throttle*/, double /*rudder*/) {
  if (std::ranges::any_of(boats_, [&](const BoatRecord& boat) { return boat.boat_id == boat_id; })) return {};
  return Error{ErrorCode::kInvalidInput, "there is no boat " + std::to_string(boat_id)};
}

core::Result<void> WaterSim::removeBoat(std::uint32_t boat_id) {
  if (std::erase_if(boats_, [&](const BoatRecord& boat) { return boat.boat_id == boat_id; }) > 0) return {};
  return Error{ErrorCode::kInvalidInput, "there is no boat " + std::to_string(boat_id)};
}

core::Result<void> WaterSim::setScene(const core::Scene& scene) {
  auto fresh = derive(scene);
  if (!fresh) return fresh.error();
  if (needsRestart(derived_, *fresh) || shaderDefines(scene_) != shaderDefines(scene)) {
    return Error{ErrorCode::kInvalidInput,
                 "this change needs new buffers or shaders: start the room again with the changed scene"};
  }
  scene_ = scene;
  setCareful(is_careful_);
  return {};
}

void WaterSim::startTimedEvents() {
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
  ctx_.barrier(gpu::Barrier::kUniform);
}

// Frames

bool WaterSim::requestFrame(const FrameRequest& request) {
  Wave* wave = request.surface ? parts_->wave.get() : nullptr;
  ParticleBuffers* particles = request.particles ? parts_->particlesOrNull() : nullptr;
  if (!wave && !particles) return !(request.foam || request.bodies);
  const auto timer = timers_.scope("stream");
  parts_->uniforms.bindUniform(SIM_UNIFORMS);
  return parts_->frames->pack(tick_, time_s(), particles, wave);
}

std::vector<core::FrameView> WaterSim::takeFrames() {
  return parts_->frames->poll(scene_, derived_);
}

// State

StateCopy WaterSim::copyState() {
  ctx_.barrier(gpu::Barrier::kBufferUpdate);
  StateCopy out;
  if (parts_->particles) {
    const std::size_t n = std::size_t{derived_.particles->count} * 4;
    out.position = parts_->particles->position.downloadVector<float>(n);
    out.velocity = parts_->particles->velocity.downloadVector<float>(n);
    const auto acceleration = parts_->particles->acceleration.downloadVector<float>(n);
    for (std::size_t i = 3; i < n; i += 4) out.density_kgpm3.push_back(acceleration[i]);
  }
  if (parts_->wave) {
    const std::size_t n = std::size_t{derived_.wave->resolution_count} * derived_.wave->resolution_count;
    out.elevation_m = parts_->wave->elevation().downloadVector<float>(n);
    out.elevation_previous_m = parts_->wave->elevationPrevious().downloadVector<float>(n);
  }
  return out;
}

void WaterSim::setState(const StateCopy& state) {
  if (parts_->particles) {
    parts_->particles->position.upload(state.position);
    parts_->particles->velocity.upload(state.velocity);
  }
  if (parts_->wave) {
    parts_->wave->elevation().upload(state.elevation_m);
    parts_->wave->elevationPrevious().upload(state.elevation_previous_m);
  }
  ctx_.barrier(gpu::Barrier::kBufferUpdate | gpu::Barrier::kStorageAndTexel);
}

std::uint64_t WaterSim::stateHash() {
  const StateCopy state = copyState();
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const std::vector<float>* part :
       {&state.position, &state.velocity, &state.elevation_m, &state.elevation_previous_m}) {
    for (const std::byte b : std::as_bytes(std::span(*part)))
      hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001b3ull;
  }
  return hash;
}

}  // namespace spindrift::sim
