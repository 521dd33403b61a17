#include "wave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include <shared/bindings.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>

namespace spindrift::sim {

Wave::Wave(Creation& create, const core::Scene& scene, const WaveLayout& layout, bool sampled, BasinStore* basins)
    : count_(layout.counts()), is_nonlinear_(isNonlinear(scene)), splash_tiles_(layout) {
  using enum gpu::TexelFormat;
  const std::size_t cells = count_.total();
  const bool nine = scene.wave->stencil == core::Stencil::kNinePoint;
  elevation_ = create.texels("elevation", cells, kR32I);
  flow_ = create.texels("flow", cells, nine || is_nonlinear_ ? kRGBA32F : kRG32F);
  if (is_nonlinear_) next_flow_ = create.texels("flow", cells, kRGBA32F);
  transfer_ = create.scratch("transfer", cells, nine ? kRGBA32I : kRG32I);
  given_share_ = create.scratch("given share", cells, kR32F);
  limit_args_ = create.buffer("limit arguments", 3 * sizeof(std::uint32_t));
  if (isVaried(scene)) {
    basin_ = create.texels("basin", cells, kRGBA32F);
    bed_ = create.texels("bed", cells, kRGBA32F);
  }
  if (exchangesWater(scene)) outflow_ = create.texels("outflow", cells, kRG32UI);
  if (hasMatchedLayer(scene)) elevation_x_ = create.texels("elevation from x faces", cells, kR32I);
  if (hasPressureHead(scene)) pressure_head_ = create.texels("pressure head", cells, kR32I);
  if (sampled && isVaried(scene)) {
    terrain_ = create.texels("terrain", cells, kRGBA32F);
    landing_ = create.texels("landing", cells, kR32I);
  }
  event_uniforms_ = create.uniforms<shared::EventUniforms>("event uniforms");
  splash_tiles_buffer_ = create.updatable("splash tiles", splash_tiles_.count() * sizeof(shared::SplashTile));
  splash_ = create.pass("wave/splash.comp");
  crest_profile_ = create.scratch("crest profile", MAX_CRESTS * std::size_t{std::max(count_.x, count_.z)}, kRG32F);
  profile_crests_ = create.pass("wave/crest_profile.comp");
  for (const bool lateral : {false, true})
    crest_[lateral] = create.pass("wave/crest.comp", {{"LATERAL", lateral ? "1" : "0"}});
  find_share_ = create.pass("wave/given_share.comp");
  limit_ = create.pass("wave/limit.comp");
  for (const bool sea : {false, true}) {
    if (sea && !hasWindSea(scene)) continue;
    const gpu::Defines of_sea{{"SEA", sea ? "1" : "0"}};
    momentum_[sea] = create.pass(is_nonlinear_ ? "wave/shallow_momentum.comp" : "wave/momentum.comp", of_sea);
    continuity_[sea] = create.pass("wave/continuity.comp", of_sea);
  }
  if (sampled) {
    surface_ = create.scratch("surface", cells, kRGBA32F);
    surface_flow_ = create.scratch("surface flow", cells, kRG32F);
    sample_surface_ = create.pass("coupling/sample_surface.comp");
  }
  if (is_nonlinear_ && disperses(scene)) {
    rise_ = create.scratch("surface rise", cells, kRG32F);
    slope_ = create.pass("wave/shallow_slope.comp");
  }
  if (hasRipples(scene)) {
    tense_level_ = create.texels("tense level", cells, kR32I, gpu::BufferContent::kScratch);
    tense_ = create.pass("wave/capillary.comp");
  }
  if (hasMakers(scene)) makers_ = std::make_unique<WaveMakers>(create, scene, layout);
  if (create.error()) return;
  std::shared_ptr<const BasinTables> tables;
  if (basin_ || disperses(scene)) {
    const bool with_terrain = static_cast<bool>(terrain_);
    tables = basins ? basins->of(scene, layout, with_terrain)
                    : std::make_shared<const BasinTables>(layOutTables(scene, layout, with_terrain));
  }
  if (disperses(scene))
    dispersed_slope_ = std::make_unique<DispersedSlope>(create, layout, tables->dispersion, is_nonlinear_);
  if (create.error()) return;
  // Rows are one group high. Momentum sets the first word if transfers have to be limited; continuity clears it.
  limit_args_.upload(std::array<std::uint32_t, 3>{0, layout.count_z, 1});
  if (basin_) upload(*tables);
}

void Wave::clear() {
  if (is_nonlinear_) {
    elevation_.upload(resting_elevation_);
  } else {
    elevation_.clear();
  }
  flow_.clear();
  forgetLastStep();
  if (outflow_) outflow_.clear();
  if (elevation_x_) elevation_x_.clear();
  clearPressure();
}

void Wave::declareState(StateBuffers& out) {
  out.push_back({.buffer = &elevation_, .checkpoint = true, .carried = true});
  out.push_back({.buffer = &flow_, .checkpoint = true, .carried = true});
  if (outflow_) out.push_back({.buffer = &outflow_, .checkpoint = true});  // setOutflow() carries its sum over
  if (elevation_x_) out.push_back({.buffer = &elevation_x_, .checkpoint = true, .carried = true});
  if (dispersed_slope_) dispersed_slope_->declareState(out);
  if (pressure_head_) out.push_back({.buffer = &pressure_head_});
  out.push_back({.buffer = &limit_args_, .lasts = false});  // the same words after each step
  if (next_flow_) out.push_back({.buffer = &next_flow_, .lasts = false});
}

void Wave::forgetLastStep() {
  if (rise_) dispersed_slope_->texels().clear();
}

void Wave::bindEvents() const {
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
}

void Wave::clearPressure() {
  if (pressure_head_) pressure_head_.clear();
}

void Wave::uploadBasin(const core::Scene& scene, const WaveLayout& layout) {
  if (!basin_ && !dispersed_slope_) return;
  const BasinTables tables = layOutTables(scene, layout, static_cast<bool>(terrain_));
  if (dispersed_slope_) dispersed_slope_->upload(tables.dispersion);
  if (basin_) upload(tables);
}

void Wave::upload(const BasinTables& tables) {
  basin_.upload(tables.basin.conductance_m);
  bed_.upload(tables.basin.bed);
  if (is_nonlinear_) {
    resting_elevation_ = restingElevation(tables.basin);
    resting_units_ = std::accumulate(resting_elevation_.begin(), resting_elevation_.end(), std::int64_t{0});
  }
  if (!terrain_) return;
  terrain_.upload(tables.terrain.ground);
  landing_.upload(tables.terrain.landing);
}

void Wave::scaleFlow(double ratio) {
  auto flow_m2ps = flow_.downloadVector<float>(flow_.sizeBytes() / sizeof(float));
  for (float& q : flow_m2ps) q *= static_cast<float>(ratio);
  flow_.upload(flow_m2ps);
}

void Wave::fillUpToBed(const core::Scene& scene, const WaveLayout& layout) {
  const std::size_t cells = count_.total();
  std::vector<std::int64_t> bed_units(cells, bedUnits(scene.wave->depth_m));
  if (basin_)
    std::ranges::transform(layOutBasin(scene, layout).depth_m, bed_units.begin(), [](float m) { return bedUnits(m); });
  auto elevation_units = elevation_.downloadVector<std::int32_t>(cells);
  const FillUp filled = fillUp(bed_units, elevation_units, outflow_ ? Lack::kComesFromOutside : Lack::kStays);
  if (!filled.is_changed) return;
  elevation_.upload(elevation_units);
  if (filled.from_outside_units > 0) {
    const auto outflow = outflow_.downloadVector<std::int32_t>(2);
    uploadOutflow(std::int64_t{outflow[1]} * (1 << 24) + outflow[0] - filled.from_outside_units);
  }
}

void Wave::setOutflow(std::int64_t units) {
  if (!outflow_) return;
  outflow_.clear();
  uploadOutflow(units);
}

/// Only the sum over all cells matters, so the first cell takes all. Low 24 bits, then the rest.
void Wave::uploadOutflow(std::int64_t units) {
  outflow_.upload(
      std::array<std::int32_t, 2>{static_cast<std::int32_t>(units & 0xffffff), static_cast<std::int32_t>(units >> 24)});
}

void Wave::bindTerrain() const {
  if (!terrain_) return;
  terrain_.bindTexel(TERRAIN);
  landing_.bindTexel(LANDING);
}

void Wave::bindBasin() const {
  if (!basin_) return;
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
  if (outflow_) outflow_.bindStorage(OUTFLOW);
  if (elevation_x_) elevation_x_.bindStorage(ELEVATION_X);
  if (sea) incident_sea->bindTexel(INCIDENT_SEA);  // other passes use its unit
  continuity_[sea].run(count_);
  if (makers_) makers_->advance(middle_s);
}

/// Updates FLOW and writes TRANSFER; leaves both bound as storage, with LIMIT_ARGS.
void Wave::accelerate(const gpu::TexelBuffer* breaking, const gpu::TexelBuffer* incident_sea) {
  const bool sea = incident_sea != nullptr;
  elevation_.bindTexel(ELEVATION);
  if (pressure_head_) pressure_head_.bindTexel(PRESSURE_HEAD);
  if (rise_) {
    bindBasin();
    flow_.bindTexel(FLOW);
    if (breaking) breaking->bindTexel(BREAKING);
    dispersed_slope_->texels().bindTexel(DISPERSED);
    rise_.bindStorage(SURFACE_RISE);
    slope_.runStrips(count_);
    rise_.bindTexel(SURFACE_RISE);
  }
  if (tense_level_) {
    bindBasin();
    tense_level_.bindStorage(TENSE_LEVEL);
    tense_.run(count_);
    tense_level_.bindTexel(ELEVATION);
  }
  if (dispersed_slope_) dispersed_slope_->compute();
  if (tense_level_) elevation_.bindTexel(ELEVATION);
  bindBasin();
  if (dispersed_slope_) dispersed_slope_->texels().bindTexel(DISPERSED);
  if (breaking) breaking->bindTexel(BREAKING);
  transfer_.bindStorage(TRANSFER);
  limit_args_.bindStorage(LIMIT_ARGS);
  if (sea) incident_sea->bindTexel(INCIDENT_SEA);
  if (!is_nonlinear_) {
    flow_.bindStorage(FLOW);
    momentum_[sea].run(count_);
    return;
  }
  flow_.bindTexel(FLOW);
  next_flow_.bindStorage(FLOW);
  momentum_[sea].run(count_);
  std::swap(flow_, next_flow_);
  flow_.bindStorage(FLOW);
}

/// Adds to TRANSFER and, for crests and calmed discs, changes FLOW; advance() has bound both.
void Wave::displace(const shared::EventUniforms& events) {
  const bool any = events.splash_count + events.crest_count + events.calm_count > 0;
  if (!any && !had_events_) return;
  had_events_ = any;
  event_uniforms_.uploadValue(events);
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
  if (const auto tiles = splash_tiles_.list(events); !tiles.empty()) {
    splash_tiles_buffer_.upload(tiles);
    splash_tiles_buffer_.bindStorage(SPLASH_TILES);
    splash_.runGroups(static_cast<std::uint32_t>(tiles.size()));
  }
  if (events.crest_count + events.calm_count == 0) return;
  crest_profile_.bindStorage(CREST_PROFILE);
  if (events.crest_count > 0) profile_crests_.run(std::max(count_.x, count_.z), events.crest_count);
  crest_profile_.bindTexel(CREST_PROFILE);
  const std::span crests(events.crests, events.crest_count);
  crest_[std::ranges::any_of(crests, [](const auto& each) { return each.lateral_m > 0.0f; })].run(count_);
}

/// Both passes run no group in a step in which no cell could become empty.
void Wave::limit() {
  find_share_.barrier(gpu::Barrier::kIndirect);
  transfer_.bindTexel(TRANSFER);
  given_share_.bindStorage(GIVEN_SHARE);
  find_share_.dispatchIndirect(limit_args_);
  find_share_.barrier();

  given_share_.bindTexel(GIVEN_SHARE);
  limit_.dispatchIndirect(limit_args_);
  limit_.barrier();
}

void Wave::sampleSurface() {
  bindBasin();
  elevation_.bindTexel(ELEVATION);
  flow_.bindTexel(FLOW);
  surface_.bindStorage(SURFACE);
  surface_flow_.bindStorage(SURFACE_FLOW);
  sample_surface_.run(count_);
}

void Wave::bindSurface() const {
  surface_.bindTexel(SURFACE);
  surface_flow_.bindTexel(SURFACE_FLOW);
}

}  // namespace spindrift::sim
