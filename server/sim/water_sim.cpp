#include <cstddef>

#include <shared/bindings.h>

#include "create_all.h"
#include "settled_positions.h"
#include "shader_defines.h"
#include "water_sim_parts.h"

namespace spindrift::sim {

// The algorithm

void WaterSim::step() {
  if (!waitForDevice()) return;
  parts_->uniforms.bindUniform(SIM_UNIFORMS);  // another WaterSim of the context may have bound its own
  watchHealth();
  startEvents();
  // The surface, its breakers and the boats advance once per tick; the wave divides the tick by its own step-size rule.
  advanceWave();
  stirParticles();
  sampleSurface();
  breakWaves();
  moveBoats();
  movePatch();
  // Particles take as many substeps as their step-size rules require.
  for (std::uint32_t substep = 0; parts_->particles && substep < derived_.substeps_count; ++substep) {
    emitParticles(substep);
    leadSurface(substep);
    predictParticles();
    buildGrid();
    advanceParticles();
  }
  mixLandedWater();
  fadeFoam();
  ++tick_;
  measure();
  saveCheckpoint();
  parts_->ticks_in_flight.submitted(tick_);
}

void WaterSim::advanceWave() {
  if (!parts_->wave) return;
  const auto timer = timers_.scope("wave");
  for (std::uint32_t k = 0; k < derived_.wave->substeps_count; ++k) {
    const double begin_s = time_s() + k * derived_.wave->dt_s;
    const double end_s = time_s() + (k + 1) * derived_.wave->dt_s;
    parts_->wave->advance(parts_->breakers ? &parts_->breakers->state() : nullptr,
                          parts_->effects.advance(end_s, domainOf(*derived_.wave)), advanceSea(k),
                          begin_s + 0.5 * derived_.wave->dt_s);
  }
  parts_->wave->clearPressure();  // hulls and falling particles set it again for the next tick
}

const gpu::TexelBuffer* WaterSim::advanceSea(std::uint32_t substep) {
  if (!parts_->wind_sea) return nullptr;
  parts_->wave->bindBasin();
  const double begin_s = runTick() * derived_.tick_s + substep * derived_.wave->dt_s;
  return parts_->wind_sea->advance(begin_s, derived_.wave->dt_s);
}

void WaterSim::stirParticles() {
  if (!parts_->stir || parts_->effects.idle()) return;
  const auto timer = timers_.scope("stir");
  parts_->stir->apply(parts_->effects.advance(time_s() + derived_.tick_s, Stir::domain(scene_, derived_)),
                      *parts_->particles, parts_->population(derived_));
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
  parts_->boats->move(parts_->wave.get());
  if (parts_->wave) parts_->boats->press(parts_->wave->pressureHead());
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
}

void WaterSim::movePatch() {
  if (parts_->follower) parts_->follower->move(parts_->uniforms, parts_->boats.get());
}

void WaterSim::mixLandedWater() {
  if (!parts_->landed_water) return;
  const auto timer = timers_.scope("coupling");
  parts_->landed_water->mix(*parts_->wave);
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
  if (parts_->boats) parts_->boats->bind();
  if (!parts_->wave) return;
  if (scene_.coupling) parts_->wave->bindSurface();
  parts_->wave->bindTerrain();
  if (!parts_->pool) return;
  parts_->wave->elevation().bindStorage(ELEVATION);
  parts_->wave->pressureHead().bindStorage(PRESSURE_HEAD);
  if (parts_->foam) parts_->foam->landed()->bindStorage(LANDED);
  if (parts_->landed_water) parts_->landed_water->bind();
}

void WaterSim::measure() {
  const auto timer = timers_.scope("diagnostics");
  std::optional<Population> population;
  if (parts_->particles) population = parts_->population(derived_);
  parts_->diagnostics->measure(tick_, scene_, derived_, parts_->particlesOrNull(), population ? &*population : nullptr,
                               parts_->grid.get(), parts_->wave.get(), parts_->breakers.get(), parts_->boats.get());
}

// Setting up

WaterSim::WaterSim(gpu::Context& ctx, core::Scene scene, Derived derived)
    : ctx_(ctx),
      scene_(std::move(scene)),
      derived_(std::move(derived)),
      timers_(ctx),
      gauges_(scene_.gauges.empty() ? nullptr : std::make_shared<GaugeHistory>(scene_.gauges.size())),
      parts_(std::make_unique<Parts>(ctx)) {}

WaterSim::~WaterSim() = default;

core::Result<std::unique_ptr<WaterSim>> WaterSim::create(gpu::Context& ctx, const core::Scene& scene) {
  auto derived = derive(scene);
  if (!derived) return derived.error();
  auto sim = std::unique_ptr<WaterSim>(new WaterSim(ctx, scene, *std::move(derived)));
  if (auto built = sim->build(); !built) return built.error();
  if (scene.particles && scene.particles->settle_s > 0 && !isTwoWay(scene)) {
    auto settled = settledPositions(ctx, scene);
    if (!settled) return settled.error();
    sim->parts_->settled_positions = *std::move(settled);
  }
  sim->reset();
  return sim;
}

core::Result<void> WaterSim::build() {
  const gpu::Defines defines = shaderDefines(scene_);
  Creation create;
  create(parts_->uniforms,
         gpu::Buffer::create(ctx_, "sim uniforms", sizeof(shared::SimUniforms), gpu::BufferUse::kUpdatable));
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
  if (hasWindSea(scene_)) create(parts_->wind_sea, WindSea::create(ctx_, scene_, *derived_.wave, defines));
  if (hasBreakers(scene_)) create(parts_->breakers, Breakers::create(ctx_, *derived_.wave, defines));
  if (isTwoWay(scene_)) create(parts_->pool, ParticlePool::create(ctx_, *derived_.particles, defines));
  if (isTwoWay(scene_) && isNonlinear(scene_))
    create(parts_->landed_water, LandedWater::create(ctx_, *derived_.wave, defines));
  if (scene_.boats) create(parts_->boats, Boats::create(ctx_, scene_, derived_.uniforms.wave_cell_m, defines));
  if (hasSurfaceFoam(scene_)) create(parts_->foam, SurfaceFoam::create(ctx_, scene_, *derived_.wave, defines));
  if (!scene_.wave) create(parts_->stir, Stir::create(ctx_, defines));
  if (followNumber(scene_) != 0) create(parts_->follower, PatchFollower::create(ctx_, scene_, defines));
  create(parts_->frames, FramePacker::create(ctx_, scene_, derived_, defines));
  create(parts_->diagnostics, Diagnostics::create(ctx_, scene_, derived_, defines));
  if (create.error()) return *create.error();
  if (parts_->wave) parts_->basin_inputs.emplace(scene_, *derived_.wave);  // Wave::create() uploaded its tables
  return parts_->makeCheckpoints(ctx_);
}

WaterSim::Parts::Parts(gpu::Context& ctx) : ticks_in_flight(ctx) {}

StateBuffers WaterSim::Parts::stateBuffers() {
  StateBuffers out;
  const auto add = [&](auto& part) {
    if (part) part->declareState(out);
  };
  add(wave);
  add(particles);
  add(pool);
  add(breakers);
  add(foam);
  add(wind_sea);
  add(boats);
  add(landed_water);
  add(grid);
  out.push_back({.buffer = &uniforms});  // the pass that moves the patch of particles changes them
  return out;
}

core::Result<void> WaterSim::Parts::makeCheckpoints(gpu::Context& ctx) {
  std::vector<gpu::Buffer*> buffers;
  for (const StateBuffer& each : stateBuffers())
    if (each.checkpoint) buffers.push_back(each.buffer);
  auto made = Checkpoints::create(ctx, std::move(buffers));
  if (!made) return made.error();
  checkpoints = *std::move(made);
  return {};
}

/// Replaces everything whose size depends on the number of particles; programs stay. After an error the particles are
/// the old ones, and other parts may have either size: call resizeBack().
core::Result<void> WaterSim::Parts::resize(gpu::Context& ctx, const core::Scene& scene, const Derived& derived) {
  auto fresh = ParticleBuffers::create(ctx, derived.particles->count, storesFoamSource(scene));
  if (!fresh) return fresh.error();
  if (auto sized = grid->resize(*derived.particles); !sized) return sized;
  if (auto sized = frames->resize(derived); !sized) return sized;
  if (auto sized = diagnostics->resize(derived); !sized) return sized;
  std::swap(*particles, *fresh);
  auto made = makeCheckpoints(ctx);
  if (!made) std::swap(*particles, *fresh);
  return made;
}

core::Result<void> WaterSim::Parts::resizeBack(const Derived& derived) {
  if (auto sized = grid->resize(*derived.particles); !sized) return sized;
  if (auto sized = frames->resize(derived); !sized) return sized;
  return diagnostics->resize(derived);
}

}  // namespace spindrift::sim
