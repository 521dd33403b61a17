#include "wave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <shared/bindings.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<Wave>> Wave::create(gpu::Context& ctx, const core::Scene& scene, const WaveLayout& layout,
                                                 const gpu::Defines& defines, bool sampled) {
  using gpu::Program;
  using gpu::TexelBuffer;
  using gpu::TexelFormat;
  auto wave = std::unique_ptr<Wave>(new Wave(ctx, layout));
  const std::size_t cells = layout.counts().total();
  const bool nine = scene.wave->stencil == core::Stencil::kNinePoint;
  const bool wide_flow = nine || isNonlinear(scene);
  wave->flow_components_ = wide_flow ? 4 : 2;
  wave->is_varied_ = isVaried(scene);
  wave->has_outflow_ = exchangesWater(scene);
  Creation create;
  create(wave->elevation_, TexelBuffer::create(ctx, "elevation", cells, TexelFormat::kR32I));
  create(wave->flow_, TexelBuffer::create(ctx, "flow", cells, wide_flow ? TexelFormat::kRGBA32F : TexelFormat::kRG32F));
  create(wave->transfer_,
         TexelBuffer::create(ctx, "transfer", cells, nine ? TexelFormat::kRGBA32I : TexelFormat::kRG32I,
                             gpu::BufferContent::kScratch));
  create(wave->given_share_,
         TexelBuffer::create(ctx, "given share", cells, TexelFormat::kR32F, gpu::BufferContent::kScratch));
  create(wave->limit_args_, gpu::Buffer::create(ctx, "limit arguments", 3 * sizeof(std::uint32_t)));
  if (wave->is_varied_) {
    create(wave->basin_, TexelBuffer::create(ctx, "basin", cells, TexelFormat::kRGBA32F));
    create(wave->bed_, TexelBuffer::create(ctx, "bed", cells, TexelFormat::kRGBA32F));
  }
  if (wave->has_outflow_) create(wave->outflow_, TexelBuffer::create(ctx, "outflow", cells, TexelFormat::kRG32UI));
  wave->has_matched_layer_ = hasMatchedLayer(scene);
  if (wave->has_matched_layer_)
    create(wave->elevation_x_, TexelBuffer::create(ctx, "elevation from x faces", cells, TexelFormat::kR32I));
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
  create(wave->find_share_, Program::create(ctx, "wave/given_share.comp", defines));
  create(wave->limit_, Program::create(ctx, "wave/limit.comp", defines));
  for (const bool sea : {false, true}) {
    if (sea && !hasWindSea(scene)) continue;
    gpu::Defines of_sea = defines;
    of_sea.emplace_back("SEA", sea ? "1" : "0");
    if (!isNonlinear(scene)) create(wave->momentum_[sea], Program::create(ctx, "wave/momentum.comp", of_sea));
    create(wave->continuity_[sea], Program::create(ctx, "wave/continuity.comp", of_sea));
  }
  if (sampled) {
    create(wave->surface_,
           TexelBuffer::create(ctx, "surface", cells, TexelFormat::kRGBA32F, gpu::BufferContent::kScratch));
    create(wave->surface_flow_,
           TexelBuffer::create(ctx, "surface flow", cells, TexelFormat::kRG32F, gpu::BufferContent::kScratch));
    create(wave->sample_surface_, Program::create(ctx, "coupling/sample_surface.comp", defines));
  }
  if (isNonlinear(scene)) create(wave->shallow_flow_, ShallowFlow::create(ctx, scene, layout, defines));
  if (hasMakers(scene)) create(wave->makers_, WaveMakers::create(ctx, scene, layout, defines));
  if (create.error()) return *create.error();
  if (disperses(scene)) {
    auto dispersed = DispersedSlope::create(ctx, layout, layOutBasin(scene, layout), defines, isNonlinear(scene));
    if (!dispersed) return dispersed.error();
    wave->dispersed_slope_ = *std::move(dispersed);
  }
  // Rows are one group high. Momentum sets the first word if transfers have to be limited; continuity clears it.
  wave->limit_args_.upload(std::array<std::uint32_t, 3>{0, layout.count_z, 1});
  wave->uploadBasin(scene, layout);
  return wave;
}

void Wave::clear() {
  if (shallow_flow_) {
    elevation_.upload(resting_elevation_);
  } else {
    elevation_.clear();
  }
  flow_.clear();
  forgetLastStep();
  if (has_outflow_) outflow_.clear();
  if (has_matched_layer_) elevation_x_.clear();
  clearPressure();
}

void Wave::declareState(StateBuffers& out) {
  out.push_back({.buffer = &elevation_, .checkpoint = true, .carried = true});
  out.push_back({.buffer = &flow_, .checkpoint = true, .carried = true});
  if (has_outflow_) out.push_back({.buffer = &outflow_, .checkpoint = true});  // setOutflow() carries its sum over
  if (has_matched_layer_) out.push_back({.buffer = &elevation_x_, .checkpoint = true, .carried = true});
  if (dispersed_slope_) dispersed_slope_->declareState(out);
  if (has_head_) out.push_back({.buffer = &pressure_head_});
  out.push_back({.buffer = &limit_args_, .lasts = false});  // the same words after each step
  if (shallow_flow_) shallow_flow_->declareState(out);
}

void Wave::forgetLastStep() {
  if (shallow_flow_ && dispersed_slope_) dispersed_slope_->texels().clear();
}

void Wave::bindEvents() const {
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
}

void Wave::clearPressure() {
  if (has_head_) pressure_head_.clear();
}

void Wave::uploadBasin(const core::Scene& scene, const WaveLayout& layout) {
  if (!is_varied_ && !dispersed_slope_) return;
  const Basin basin = layOutBasin(scene, layout);
  if (dispersed_slope_) dispersed_slope_->upload(layout, basin);
  if (!is_varied_) return;
  basin_.upload(basin.conductance_m);
  bed_.upload(basin.bed);
  if (shallow_flow_) {
    resting_elevation_ = restingElevation(basin);
    resting_units_ = std::accumulate(resting_elevation_.begin(), resting_elevation_.end(), std::int64_t{0});
  }
  if (!has_terrain_) return;
  const Terrain terrain = layOutTerrain(scene, layout, basin);
  terrain_.upload(terrain.ground);
  landing_.upload(terrain.landing);
}

void Wave::scaleFlow(double ratio) {
  auto flow_m2ps = flow_.downloadVector<float>(count_.total() * flow_components_);
  for (float& q : flow_m2ps) q *= static_cast<float>(ratio);
  flow_.upload(flow_m2ps);
}

void Wave::fillUpToBed(const core::Scene& scene, const WaveLayout& layout) {
  const std::size_t cells = count_.total();
  std::vector<std::int64_t> bed_units(cells, bedUnits(scene.wave->depth_m));
  if (is_varied_)
    std::ranges::transform(layOutBasin(scene, layout).depth_m, bed_units.begin(), [](float m) { return bedUnits(m); });
  auto elevation_units = elevation_.downloadVector<std::int32_t>(cells);
  const FillUp filled = fillUp(bed_units, elevation_units, has_outflow_ ? Lack::kComesFromOutside : Lack::kStays);
  if (!filled.is_changed) return;
  elevation_.upload(elevation_units);
  if (filled.from_outside_units > 0) {
    const auto outflow = outflow_.downloadVector<std::int32_t>(2);
    uploadOutflow(std::int64_t{outflow[1]} * (1 << 24) + outflow[0] - filled.from_outside_units);
  }
}

void Wave::setOutflow(std::int64_t units) {
  if (!has_outflow_) return;
  outflow_.clear();
  uploadOutflow(units);
}

/// Only the sum over all cells matters, so the first cell takes all. Low 24 bits, then the rest.
void Wave::uploadOutflow(std::int64_t units) {
  outflow_.upload(
      std::array<std::int32_t, 2>{static_cast<std::int32_t>(units & 0xffffff), static_cast<std::int32_t>(units >> 24)});
}

void Wave::bindTerrain() const {
  if (!has_terrain_) return;
  terrain_.bindTexel(TERRAIN);
  landing_.bindTexel(LANDING);
}

void Wave::bindBasin() const {
  if (!is_varied_) return;
  basin_.bindTexel(BASIN);
  bed_.bindTexel(BED);
}

void Wave::advance(const gpu::TexelBuffer* breaking, const shared::EventUniforms& events,
                   const gpu::TexelBuffer* incident_sea, double middle_s) {
  const bool sea = incident_sea != nullptr;
  accelerate(breaking, incident_sea);
  displace(events);
  limit();

  transfer_.bindTexel(TRANSFER);
  elevation_.bindStorage(ELEVATION);
  if (has_outflow_) outflow_.bindStorage(OUTFLOW);
  if (has_matched_layer_) elevation_x_.bindStorage(ELEVATION_X);
  if (sea) incident_sea->bindTexel(INCIDENT_SEA);  // other passes use its unit
  continuity_[sea].dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  if (makers_) makers_->advance(middle_s);
}

/// Updates FLOW and writes TRANSFER; leaves both bound as storage, with LIMIT_ARGS.
void Wave::accelerate(const gpu::TexelBuffer* breaking, const gpu::TexelBuffer* incident_sea) {
  const bool sea = incident_sea != nullptr;
  elevation_.bindTexel(ELEVATION);
  if (has_head_) pressure_head_.bindTexel(PRESSURE_HEAD);
  if (shallow_flow_ && dispersed_slope_) {
    bindBasin();
    flow_.bindTexel(FLOW);
    if (breaking) breaking->bindTexel(BREAKING);
    dispersed_slope_->texels().bindTexel(DISPERSED);
    shallow_flow_->findRise().bindTexel(SURFACE_RISE);
  }
  if (dispersed_slope_) dispersed_slope_->compute();
  bindBasin();
  if (dispersed_slope_) dispersed_slope_->texels().bindTexel(DISPERSED);
  if (breaking) breaking->bindTexel(BREAKING);
  transfer_.bindStorage(TRANSFER);
  limit_args_.bindStorage(LIMIT_ARGS);
  if (sea) incident_sea->bindTexel(INCIDENT_SEA);
  if (shallow_flow_) {
    shallow_flow_->advance(flow_, sea);
    flow_.bindStorage(FLOW);
    return;
  }
  flow_.bindStorage(FLOW);
  momentum_[sea].dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

/// Adds to TRANSFER and, for crests and calmed discs, changes FLOW; advance() has bound both.
void Wave::displace(shared::EventUniforms events) {
  const bool any = events.splash_count + events.crest_count + events.calm_count > 0;
  if (!any && !had_events_) return;
  had_events_ = any;
  // Number of cells along each side of the square that the largest splash can reach.
  const auto across = static_cast<std::uint32_t>(2 * std::ceil(events.reach_m / cell_m_)) + 4;
  // wave/splash.comp has two ways; the one with fewer invocations is faster.
  const bool every_cell = std::uint64_t{across} * across * events.splash_count > count_.total();
  events.every_cell = every_cell;
  event_uniforms_.uploadValue(events);
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
  if (events.splash_count > 0) {
    if (every_cell) {
      splash_.dispatch(count_.x, count_.z);
    } else {
      splash_.dispatch(across, across, events.splash_count);
    }
    ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  }
  if (events.crest_count + events.calm_count > 0) {
    crest_.dispatch(count_.x, count_.z);
    ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  }
}

/// Both passes run no group in a step in which no cell could become empty.
void Wave::limit() {
  ctx_.barrier(gpu::Barrier::kIndirect);
  transfer_.bindTexel(TRANSFER);
  given_share_.bindStorage(GIVEN_SHARE);
  find_share_.dispatchIndirect(limit_args_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);

  given_share_.bindTexel(GIVEN_SHARE);
  limit_.dispatchIndirect(limit_args_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Wave::sampleSurface() {
  bindBasin();
  elevation_.bindTexel(ELEVATION);
  flow_.bindTexel(FLOW);
  surface_.bindStorage(SURFACE);
  surface_flow_.bindStorage(SURFACE_FLOW);
  sample_surface_.dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Wave::bindSurface() const {
  surface_.bindTexel(SURFACE);
  surface_flow_.bindTexel(SURFACE_FLOW);
}

}  // namespace spindrift::sim
