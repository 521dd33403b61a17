#include <shared/bindings.h>

#include "fits_device.h"
#include "shader_defines.h"
#include "water_sim_parts.h"

namespace spindrift::sim {

// The algorithm

void WaterSim::step() {
  if (!waitForDevice()) return;
  parts_->uniforms.bindUniform(SIM_UNIFORMS);  // another WaterSim of the context may have bound its own
  watchHealth();
  startEvents();
  // The surface, its breakers and the bodies advance once per tick; the wave divides the tick by its own step-size
  // rule.
  advanceWave();
  stirParticles();
  sampleSurface();
  breakWaves();
  moveBodies();
  movePatch();
  // Particles take as many substeps as their step-size rules require.
  for (std::uint32_t substep = 0; parts_->particles && substep < derived_.substeps_count; ++substep) {
    emitParticles(substep);
    leadSurface(substep);
    predictParticles();
    buildGrid();
    advanceParticles();
    hitFloaters(substep);
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
    if (parts_->boats) parts_->boats->feel(*parts_->wave, k == 0);
    parts_->wave->advance(parts_->breakers ? &parts_->breakers->state() : nullptr,
                          parts_->effects.advance(end_s, domainOf(*derived_.wave)), advanceSea(k),
                          begin_s + 0.5 * derived_.wave->dt_s);
  }
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

void WaterSim::moveBodies() {
  if (!parts_->boats && !parts_->floaters) return parts_->pressBodies();
  const auto timer = timers_.scope("bodies");
  if (parts_->floaters) parts_->floaters->move(derived_.tick_s, *parts_->wave, parts_->boats.get());
  if (parts_->boats) parts_->boats->move(parts_->wave.get());
  if (parts_->floaters) parts_->floaters->feel(derived_.tick_s, *parts_->wave);
  if (parts_->boats && parts_->wave)
    parts_->boats->endMovedTick(*parts_->wave, tick_ + 1, derived_.tick_s, waterDensity_kgpm3(scene_));
  parts_->pressBodies();  // particles that fall in this tick add to it
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
  if (!parts_->pool || !isNonlinear(scene_)) return;
  const auto timer = timers_.scope("coupling");
  parts_->pool->mix(*parts_->wave);
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

void WaterSim::hitFloaters(std::uint32_t substep) {
  if (!parts_->floaters || !parts_->particles) return;
  const auto timer = timers_.scope("bodies");
  bindSurroundings();
  parts_->floaters->meetParticles(substep == 0 ? derived_.tick_s : 0.0, *parts_->particles,
                                  parts_->population(derived_));
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
  parts_->pool->bindLanded();
}

void WaterSim::measure() {
  const auto timer = timers_.scope("diagnostics");
  std::optional<Population> population;
  if (parts_->particles) population = parts_->population(derived_);
  parts_->diagnostics->measure(tick_, scene_, derived_, parts_->particlesOrNull(), population ? &*population : nullptr,
                               parts_->grid.get(), parts_->wave.get(), parts_->breakers.get(), parts_->boats.get(),
                               parts_->floaters.get());
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

core::Result<void> WaterSim::build(BasinStore* basins) {
  if (auto fits = fitsDevice(ctx_, scene_, derived_); !fits) return fits;
  Creation create(ctx_, shaderDefines(scene_));
  const auto make = [&]<typename Part>(std::unique_ptr<Part>& part, const auto&... arguments) {
    part = std::make_unique<Part>(create, arguments...);
  };
  Parts& p = *parts_;
  p.uniforms = create.uniforms<shared::SimUniforms>("sim uniforms");
  if (derived_.wave) make(p.wave, scene_, *derived_.wave, isSampled(scene_), basins);
  if (derived_.particles) {
    p.particles.emplace(create, derived_.particles->count, storesFoamSource(scene_), hasTension(scene_));
    make(p.grid, *derived_.particles);
    if (scene_.particles->solver == core::PressureSolver::kPositionBased)
      make(p.position_based);
    else
      make(p.sph);
  }
  if (hasWindSea(scene_)) make(p.wind_sea, scene_, *derived_.wave);
  if (hasBreakers(scene_)) make(p.breakers, *derived_.wave);
  if (isTwoWay(scene_)) make(p.pool, scene_, derived_);
  if (scene_.boats) make(p.boats, scene_, derived_.uniforms.wave_cell_m);
  if (scene_.floaters) make(p.floaters, scene_);
  if (hasSurfaceFoam(scene_)) make(p.foam, scene_, *derived_.wave);
  if (!scene_.wave) make(p.stir);
  if (followNumber(scene_) != 0) make(p.follower, scene_);
  make(p.frames, scene_, derived_);
  make(p.diagnostics, scene_, derived_);
  if (create.error()) return *create.error();
  if (p.wave) p.basin_inputs.emplace(scene_, *derived_.wave);  // Wave's constructor uploaded its tables
  p.makeCheckpoints(create);
  return create.result();
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
  add(floaters);
  add(grid);
  // The pass that moves the patch of particles changes them; the values of surface tension follow from the scene.
  out.push_back({.buffer = &uniforms, .first_word_count = kUniformWordsBeforeTension});
  return out;
}

void WaterSim::Parts::makeCheckpoints(Creation& create) {
  std::vector<gpu::Buffer*> buffers;
  for (const StateBuffer& each : stateBuffers())
    if (each.checkpoint) buffers.push_back(each.buffer);
  auto made = std::make_unique<Checkpoints>(create, std::move(buffers));
  if (!create.error()) checkpoints = std::move(made);
}

core::Result<void> WaterSim::Parts::resize(gpu::Context& ctx, const core::Scene& scene, const Derived& derived) {
  Creation create(ctx);
  ParticleBuffers fresh(create, derived.particles->count, storesFoamSource(scene), hasTension(scene));
  resizeOthers(create, scene, derived);
  if (create.error()) return *create.error();
  std::swap(*particles, fresh);
  makeCheckpoints(create);
  if (create.error()) std::swap(*particles, fresh);
  return create.result();
}

core::Result<void> WaterSim::Parts::resizeBack(gpu::Context& ctx, const core::Scene& scene, const Derived& derived) {
  Creation create(ctx);
  resizeOthers(create, scene, derived);
  return create.result();
}

void WaterSim::Parts::resizeOthers(Creation& create, const core::Scene& scene, const Derived& derived) {
  grid->resize(create, *derived.particles);
  frames->resize(create, scene, derived);
  diagnostics->resize(create, derived);
}

}  // namespace spindrift::sim
