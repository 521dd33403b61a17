#include "diagnostics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <span>
#include <utility>

#include <shared/bindings.h>
#include <shared/fixed_point.h>
#include <shared/gauge_uniforms.h>
#include <shared/pool.h>

#include "surface_points.h"
#include "ticks_in_flight.h"

namespace spindrift::sim {
namespace {

/// Partial result of one invocation, as shaders/diagnostics writes it. The integers are sums of upper and lower parts.
struct Partial {
  float nonfinite, escaped, max_a, max_b;
  float sum[4];
  std::int32_t elevation_high;
  std::uint32_t elevation_low;
  std::int32_t outflow_high;
  std::uint32_t outflow_low;
};
static_assert(sizeof(Partial) == 48);
/// Slots for the ticks in flight, for the tick that is measured now, and for results that poll() has not yet returned.
constexpr std::size_t kReadingSlotCount = 8;
static_assert(kReadingSlotCount > TicksInFlight::kMaxCount + 1);
/// Of water without particles.
constexpr double kWaterDensity_kgpm3 = 1000.0;

struct Total {
  double nonfinite = 0, escaped = 0, max_a = 0, max_b = 0, count_b = 0;
  double sum[4] = {0, 0, 0, 0};
  std::int64_t elevation_units = 0;
  std::int64_t outflow_units = 0;
};

Total total(std::span<const std::byte> bytes) {
  Total out;
  for (std::size_t at = 0; at + sizeof(Partial) <= bytes.size(); at += sizeof(Partial)) {
    Partial p;
    std::memcpy(&p, bytes.data() + at, sizeof p);
    out.nonfinite += p.nonfinite;
    out.escaped += p.escaped;
    out.max_a = std::max(out.max_a, static_cast<double>(p.max_a));
    out.max_b = std::max(out.max_b, static_cast<double>(p.max_b));
    out.count_b += p.max_b;
    out.elevation_units += std::int64_t{p.elevation_high} * 65536 + p.elevation_low;
    out.outflow_units += std::int64_t{p.outflow_high} * (1 << 24) + p.outflow_low;
    for (int k = 0; k < 4; ++k) out.sum[k] += p.sum[k];
  }
  return out;
}

using GaugeTexel = std::array<float, 4>;
constexpr std::size_t kGaugeBytes = MAX_GAUGES * sizeof(GaugeTexel);

GaugeReading gaugeReading(std::span<const std::byte> bytes, std::size_t gauge) {
  GaugeTexel texel;
  std::memcpy(texel.data(), bytes.data() + gauge * sizeof texel, sizeof texel);
  return {.elevation_m = texel[0], .velocity_x_mps = texel[1], .velocity_z_mps = texel[2]};
}

/// Number of invocations, and of partial results, for this many items: a whole number of groups.
std::uint32_t sharesFor(std::uint32_t items, const gpu::Program& program, const gpu::Context& ctx) {
  const std::uint32_t group = program.groupSize()[0];
  return (items / ctx.tuning().reduce_items + group) / group * group;
}

}  // namespace

std::size_t Diagnostics::poolOffset() const {
  return (particle_shares_ + surface_shares_) * sizeof(Partial);
}

std::size_t Diagnostics::gaugeOffset() const {
  return poolOffset() + (is_pooled_ ? POOL_WORDS * sizeof(std::uint32_t) : 0);
}

double waterDensity_kgpm3(const core::Scene& scene) {
  return scene.particles ? scene.particles->rest_density_kgpm3 : kWaterDensity_kgpm3;
}

Diagnostics::Diagnostics(Creation& create, const core::Scene& scene, const Derived& derived) : ctx_(create.context()) {
  if (derived.particles) {
    is_pooled_ = derived.uniforms.pool_capacity_count > 0;
    particle_pass_ = create.pass("diagnostics/particles.comp");
  }
  if (derived.wave) {
    cells_ = static_cast<std::uint32_t>(derived.wave->counts().total());
    surface_pass_ = create.pass("diagnostics/surface.comp");
    if (create.error()) return;
    surface_shares_ = sharesFor(cells_, surface_pass_, ctx_);
    surface_sums_ = create.buffer("surface sums", surface_shares_ * sizeof(Partial), gpu::BufferContent::kScratch);
  }
  if (!scene.gauges.empty()) placeGauges(create, scene, *derived.wave, {});
  resize(create, derived);
}

void Diagnostics::placeGauges(Creation& create, const core::Scene& scene, const WaveLayout& layout,
                              std::span<const GaugePlace> places) {
  static_assert(MAX_GAUGES == core::kMaxGauges);
  assert(scene.gauges.size() + places.size() <= MAX_GAUGES);
  if (!gauge_readings_) {
    auto uniforms = create.uniforms<shared::GaugeUniforms>("gauges");
    auto readings = create.buffer("gauge readings", kGaugeBytes, gpu::BufferContent::kScratch);
    auto pass = create.pass("diagnostics/gauges.comp");
    if (create.error()) return;
    gauge_places_ = std::move(uniforms);
    gauge_readings_ = std::move(readings);
    gauge_pass_ = std::move(pass);
  }
  shared::GaugeUniforms uniforms{};
  const auto add = [&](double x_m, double z_m) {
    shared::GaugePlace& place = uniforms.gauges[uniforms.gauge_count++];
    const CellPlace at = cellPlaceOf(layout, x_m, z_m);
    place.column = at.column;
    place.row = at.row;
  };
  for (const core::Gauge& gauge : scene.gauges) add(gauge.x_m, gauge.z_m);
  placed_ids_.clear();
  for (const GaugePlace& place : places) {
    add(place.x_m, place.z_m);
    placed_ids_.push_back(place.gauge_id);
  }
  gauge_places_.uploadValue(uniforms);
}

void Diagnostics::resize(Creation& create, const Derived& derived) {
  if (create.error()) return;
  gpu::Buffer sums;
  const std::uint32_t shares = derived.particles ? sharesFor(derived.particles->count, particle_pass_, ctx_) : 0;
  if (shares > 0) sums = create.buffer("particle sums", shares * sizeof(Partial), gpu::BufferContent::kScratch);
  auto ring = create.ring(
      "diagnostics",
      (shares + surface_shares_) * sizeof(Partial) + (is_pooled_ ? POOL_WORDS * 4 : 0) + (cells_ > 0 ? kGaugeBytes : 0),
      kReadingSlotCount);
  if (create.error()) return;
  particle_sums_ = std::move(sums);
  ring_ = std::move(ring);
  in_flight_.clear();
  particle_shares_ = shares;
  particles_ = derived.particles ? derived.particles->count : 0;
}

void Diagnostics::measure(std::uint64_t tick, const core::Scene& scene, const Derived& derived,
                          const ParticleBuffers* particles, const Population* population, const NeighborGrid* grid,
                          Wave* wave, Breakers* breakers, const Boats* boats, const Floaters* floaters) {
  auto slot = ring_->begin();
  if (!slot) return;
  Scale scale{.tick = tick, .gravity_mps2 = scene.gravity_mps2, .density_kgpm3 = waterDensity_kgpm3(scene)};
  if (derived.particles) scale.particle_mass_kg = derived.particles->mass_kg;
  if (derived.wave) scale.cell_area_m2 = derived.wave->cell_m * derived.wave->cell_m;
  scale.droplet_units = derived.uniforms.droplet_units;
  if (wave) scale.resting_units = wave->restingUnits();
  bool copied = true;
  if (particles) {
    population->bind();
    particles->position.bindTexel(POSITION);
    particles->velocity.bindTexel(VELOCITY);
    particles->acceleration.bindTexel(ACCELERATION);
    grid->crowded().bindTexel(CROWDED);
    particle_sums_.bindStorage(PARTIAL_SUM);
    particle_pass_.dispatch(particle_shares_);
    copied = slot->copyFrom(particle_sums_, 0, particle_sums_.sizeBytes(), 0);
  }
  if (wave) {
    wave->elevation().bindTexel(ELEVATION);
    wave->flow().bindTexel(FLOW);
    wave->bindBasin();
    if (breakers) breakers->state().bindTexel(BREAKING);
    if (boats) boats->bind();
    if (floaters) floaters->bind();
    if (auto* outflow = wave->outflow()) outflow->bindTexel(OUTFLOW);
    surface_sums_.bindStorage(PARTIAL_SUM);
    surface_pass_.dispatch(surface_shares_);
    copied = copied && slot->copyFrom(surface_sums_, 0, surface_sums_.sizeBytes(), particle_shares_ * sizeof(Partial));
  }
  if (is_pooled_) {
    copied = copied && slot->copyFrom(population->pool()->words(), 0, POOL_WORDS * 4, poolOffset());
  }
  const std::size_t gauge_count = scene.gauges.size() + placed_ids_.size();
  if (gauge_count > 0) {  // ELEVATION, FLOW and the basin are bound
    gauge_places_.bindUniform(GAUGE_UNIFORMS);
    gauge_readings_.bindStorage(PARTIAL_SUM);
    gauge_pass_.dispatch(static_cast<std::uint32_t>(gauge_count));
    copied = copied && slot->copyFrom(gauge_readings_, 0, gauge_count * sizeof(GaugeTexel), gaugeOffset());
    scale.scene_gauge_count = scene.gauges.size();
    scale.placed_ids = placed_ids_;
  }
  // The next tick's passes write the buffers that were read here.
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  if (!copied) return;
  slot->submit(tick);
  in_flight_.push_back(std::move(scale));
}

std::vector<Health> Diagnostics::poll() {
  std::vector<Health> out;
  for (const auto& slot : ring_->poll()) {
    // A slot whose fence failed is never returned: skip it.
    while (in_flight_.front().tick != slot->tag()) in_flight_.pop_front();
    const Scale scale = std::move(in_flight_.front());
    in_flight_.pop_front();
    Health h;
    h.tick = slot->tag();
    const auto bytes = slot->bytes();
    const std::size_t split = particle_shares_ * sizeof(Partial);
    if (particles_) {
      const Total t = total(bytes.subspan(0, split));
      h.nonfinite_count += static_cast<std::uint64_t>(t.nonfinite);
      h.escaped_count = static_cast<std::uint64_t>(t.escaped);
      h.max_speed_mps = t.max_a;
      h.max_density_ratio = t.max_b / scale.density_kgpm3;
      h.particle_count = particles_;
      Partial first;
      std::memcpy(&first, bytes.data(), sizeof first);
      const auto crowded = static_cast<std::uint32_t>(first.elevation_high);  // see diagnostics/particles.comp
      h.crowded_count = crowded - std::exchange(crowded_before_, crowded);
      if (is_pooled_) {
        std::array<std::uint32_t, POOL_WORDS> pool;
        std::memcpy(pool.data(), bytes.data() + poolOffset(), sizeof pool);
        h.particle_count = pool[POOL_EMITTED] - pool[POOL_ABSORBED];
        h.emitted_count = pool[POOL_EMITTED];
        h.absorbed_count = pool[POOL_ABSORBED];
        h.pool_refused_count = pool[POOL_REFUSED];
      }
      h.mean_density_ratio = h.particle_count > 0 ? t.sum[0] / h.particle_count / scale.density_kgpm3 : 0.0;
      h.kinetic_energy_j = 0.5 * scale.particle_mass_kg * t.sum[1];
      h.potential_energy_j = scale.particle_mass_kg * scale.gravity_mps2 * t.sum[2];
    }
    if (cells_) {
      const Total t = total(bytes.subspan(split, surface_shares_ * sizeof(Partial)));
      const double area_m2 = scale.cell_area_m2;
      h.nonfinite_count += static_cast<std::uint64_t>(t.nonfinite);
      h.max_elevation_m = t.max_a;
      h.breaking_ratio = t.count_b / cells_;
      h.surface_units = t.elevation_units - scale.resting_units;
      h.outflow_units = t.outflow_units;
      h.volume_error_units = h.surface_units + t.outflow_units;
      const double droplet_m3 = static_cast<double>(scale.droplet_units) * double{ELEVATION_UNIT_M} * area_m2;
      h.emitted_m3 = h.emitted_count * droplet_m3;
      h.absorbed_m3 = h.absorbed_count * droplet_m3;
      if (is_pooled_) h.volume_error_units += std::int64_t{h.particle_count} * scale.droplet_units;
      h.wave_volume_m3 = static_cast<double>(h.surface_units) * ELEVATION_UNIT_M * area_m2;
      h.wave_energy_j = 0.5 * scale.density_kgpm3 * area_m2 * (scale.gravity_mps2 * t.sum[0] + t.sum[1]);
    }
    const auto gauges = bytes.subspan(gaugeOffset());
    for (std::size_t k = 0; k < scale.scene_gauge_count; ++k) h.gauges.push_back(gaugeReading(gauges, k));
    for (std::size_t k = 0; k < scale.placed_ids.size(); ++k)
      h.placed_gauges.push_back({scale.placed_ids[k], gaugeReading(gauges, scale.scene_gauge_count + k)});
    out.push_back(std::move(h));
  }
  return out;
}

}  // namespace spindrift::sim
