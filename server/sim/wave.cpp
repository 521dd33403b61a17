#include "wave.h"

#include <algorithm>
#include <cmath>

#include <shared/bindings.h>

#include "basin.h"
#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<Wave>> Wave::create(gpu::Context& ctx, const core::Scene& scene, const WaveLayout& layout,
                                                 const gpu::Defines& defines, bool sampled) {
  using gpu::Program;
  using gpu::TexelBuffer;
  using gpu::TexelFormat;
  auto wave = std::unique_ptr<Wave>(new Wave(ctx, layout));
  const std::size_t cells = std::size_t{layout.resolution_count} * layout.resolution_count;
  const bool nine = scene.wave->stencil == core::Stencil::kNinePoint;
  wave->flow_components_ = nine ? 4 : 2;
  wave->is_varied_ = isVaried(scene);
  wave->has_outflow_ = isOpen(scene);
  Creation create;
  create(wave->elevation_, TexelBuffer::create(ctx, "elevation", cells, TexelFormat::kR32I));
  create(wave->flow_, TexelBuffer::create(ctx, "flow", cells, nine ? TexelFormat::kRGBA32F : TexelFormat::kRG32F));
  if (wave->is_varied_) {
    create(wave->basin_, TexelBuffer::create(ctx, "basin", cells, TexelFormat::kRGBA32F));
    create(wave->sponge_, TexelBuffer::create(ctx, "sponge", cells, TexelFormat::kRG32F));
  }
  if (wave->has_outflow_) create(wave->outflow_, TexelBuffer::create(ctx, "outflow", cells, TexelFormat::kRG32UI));
  wave->has_head_ = hasPressureHead(scene);
  wave->has_terrain_ = sampled && isVaried(scene);
  if (wave->has_head_)
    create(wave->pressure_head_, TexelBuffer::create(ctx, "pressure head", cells, TexelFormat::kR32I));
  if (wave->has_terrain_) {
    create(wave->terrain_, TexelBuffer::create(ctx, "terrain", cells, TexelFormat::kRGBA32F));
    create(wave->landing_, TexelBuffer::create(ctx, "landing", cells, TexelFormat::kR32I));
  }
  create(wave->event_uniforms_,
         gpu::Buffer::create(ctx, "event uniforms", sizeof(shared::EventUniforms), gpu::BufferUse::kUpdatable));
  create(wave->splash_, Program::create(ctx, "wave/splash.comp", defines));
  create(wave->crest_, Program::create(ctx, "wave/crest.comp", defines));
  create(wave->momentum_, Program::create(ctx, "wave/momentum.comp", defines));
  create(wave->continuity_, Program::create(ctx, "wave/continuity.comp", defines));
  if (sampled) {
    create(wave->surface_,
           TexelBuffer::create(ctx, "surface", cells, TexelFormat::kRGBA32F, gpu::BufferContent::kScratch));
    create(wave->surface_flow_,
           TexelBuffer::create(ctx, "surface flow", cells, TexelFormat::kRG32F, gpu::BufferContent::kScratch));
    create(wave->sample_surface_, Program::create(ctx, "coupling/sample_surface.comp", defines));
  }
  if (create.error()) return *create.error();
  wave->uploadBasin(scene, layout);
  return wave;
}

void Wave::clear() {
  elevation_.clear();
  flow_.clear();
  if (has_outflow_) outflow_.clear();
  clearPressure();
}

void Wave::bindEvents() const {
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
}

void Wave::clearPressure() {
  if (has_head_) pressure_head_.clear();
}

void Wave::uploadBasin(const core::Scene& scene, const WaveLayout& layout) {
  if (!is_varied_) return;
  const Basin basin = layOutBasin(scene, layout);
  basin_.upload(basin.conductance_m);
  sponge_.upload(basin.loss_per_s);
  if (!has_terrain_) return;
  const Terrain terrain = layOutTerrain(scene, layout, basin);
  terrain_.upload(terrain.ground);
  landing_.upload(terrain.landing);
}

void Wave::scaleFlow(double ratio) {
  auto flow_m2ps = flow_.downloadVector<float>(std::size_t{n_} * n_ * flow_components_);
  for (float& q : flow_m2ps) q *= static_cast<float>(ratio);
  flow_.upload(flow_m2ps);
}

void Wave::bindTerrain() const {
  if (!has_terrain_) return;
  terrain_.bindTexel(TERRAIN);
  landing_.bindTexel(LANDING);
}

void Wave::bindBasin() const {
  if (!is_varied_) return;
  basin_.bindTexel(BASIN);
  sponge_.bindTexel(SPONGE);
}

void Wave::displace(const shared::EventUniforms& events) {
  const bool any = events.splash_count + events.crest_count > 0;
  if (!any && !had_events_) return;
  had_events_ = any;
  event_uniforms_.uploadValue(events);
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
  bindBasin();
  elevation_.bindStorage(ELEVATION);
  if (events.splash_count > 0) {
    float radius_m = 0.0f;
    for (std::uint32_t k = 0; k < events.splash_count; ++k) radius_m = std::max(radius_m, events.splashes[k].radius_m);
    // The largest splash decides; wave/splash.comp leaves out what a smaller one does not reach.
    const auto across = static_cast<std::uint32_t>(2 * std::ceil(SPLASH_REACH * radius_m / cell_m_)) + 4;
    splash_.dispatch(std::min(across, 2 * n_), std::min(across, 2 * n_), events.splash_count);
    ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  }
  if (events.crest_count > 0) {
    flow_.bindStorage(FLOW);
    crest_.dispatch(n_, n_);
    ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  }
}

void Wave::advance(const gpu::TexelBuffer* breaking) {
  bindBasin();
  elevation_.bindTexel(ELEVATION);
  if (has_head_) pressure_head_.bindTexel(PRESSURE_HEAD);
  if (breaking) breaking->bindTexel(BREAKING);
  flow_.bindStorage(FLOW);
  momentum_.dispatch(n_, n_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);

  flow_.bindTexel(FLOW);
  elevation_.bindStorage(ELEVATION);
  if (has_outflow_) outflow_.bindStorage(OUTFLOW);
  continuity_.dispatch(n_, n_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Wave::sampleSurface() {
  bindBasin();
  elevation_.bindTexel(ELEVATION);
  flow_.bindTexel(FLOW);
  surface_.bindStorage(SURFACE);
  surface_flow_.bindStorage(SURFACE_FLOW);
  sample_surface_.dispatch(n_, n_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Wave::bindSurface() const {
  surface_.bindTexel(SURFACE);
  surface_flow_.bindTexel(SURFACE_FLOW);
}

}  // namespace spindrift::sim
