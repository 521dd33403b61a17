// WaterSim: health, frames, and copies of the state.
#include <algorithm>
#include <cmath>
#include <span>

#include <shared/fixed_point.h>
#include <shared/pool.h>
#include <spdlog/spdlog.h>

#include "water_sim_parts.h"

namespace spindrift::sim {
namespace {

constexpr double kCheckpointInterval_s = 1.0;
/// A room runs this long with half the step after a recovery.
constexpr double kCareful_s = 5.0;

}  // namespace

// The device

static_assert(WaterSim::kMaxTicksInFlight == TicksInFlight::kMaxCount);

bool WaterSim::waitForDevice() {
  if (device_error_) return false;
  const auto waited = parts_->ticks_in_flight.waitForRoom();
  if (waited) return true;
  device_error_ = waited.error();
  spdlog::error("scene {}: {}", scene_.name, device_error_->message);
  return false;
}

// Health

void WaterSim::watchHealth() {
  for (const Health& health : parts_->diagnostics->poll()) {
    if (health.tick <= abandoned_until_tick_) continue;
    health_ = health;
    if (gauges_) gauges_->add(static_cast<double>(health.tick - start_tick_) * derived_.tick_s, health.gauges);
    nonfinite_count_ += health.nonfinite_count;
    escaped_count_ += health.escaped_count;
    if (health.crowded_count > 0 && crowded_count_ == 0) {
      spdlog::warn(
          "scene {}: tick {}: {} particles lie so close together that their neighbour search was cut at {} candidates "
          "per column; later ticks are only counted",
          scene_.name, health.tick, health.crowded_count, derived_.uniforms.candidates_max_count);
    }
    crowded_count_ += health.crowded_count;
    if (health.isGood() && !ledger_units_) ledger_units_ = health.volume_error_units;
    if (health.isGood() && health.volume_error_units == ledger_units_) {
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
  const std::int64_t lost_units = breach.volume_error_units - ledger_units_.value_or(breach.volume_error_units);
  ledger_units_.reset();
  const std::optional<double> flow_ratio = parts_->checkpoints->restore();
  const bool restored = flow_ratio.has_value();
  if (!restored) {
    uploadStartingState();
  } else if (*flow_ratio != 1.0) {
    parts_->wave->scaleFlow(*flow_ratio);
  }
  if (parts_->wave) parts_->wave->clearPressure();
  if (parts_->boats) parts_->boats->mend();
  parts_->effects.clear();
  abandoned_until_tick_ = tick_;
  ++revision_;
  careful_until_tick_ = tick_ + static_cast<std::uint64_t>(kCareful_s / derived_.tick_s);
  setCareful(true);
  // The checkpoint may come from deeper water.
  if (restored && parts_->wave) parts_->wave->fillUpToBed(scene_, *derived_.wave);
  if (recovered_count_ <= 10 || recovered_count_ % 100 == 0) {
    spdlog::warn(
        "scene {}: tick {} has {} values out of range, {} escaped particles and a volume that is off by {} units; went "
        "back to {} with half the step for {} s (watchdog stepped in {} times)",
        scene_.name, breach.tick, breach.nonfinite_count, breach.escaped_count, lost_units,
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
    if (halved.wave) halved.wave->fixed_substeps_count = 2 * derived->wave->substeps_count;
    derived = derive(halved, kept ? &*kept : nullptr);
  }
  // scene_ was valid, and half the step breaks no rule. Only the limit on substeps can refuse it; then the step stays.
  if (derived) derived_ = *std::move(derived);
  parts_->uniforms.uploadValue(derived_.uniforms);
  uploadBasin();
  if (parts_->wave && parts_->wave->makers()) parts_->wave->makers()->update(scene_, *derived_.wave);
  if (parts_->wind_sea) parts_->wind_sea->fadeTo(seaState(scene_, *derived_.wave));
}

// Frames

bool WaterSim::requestFrame(const FrameRequest& request) {
  std::optional<Population> population;
  if (parts_->particles) population = parts_->population(derived_);
  const FramePacker::Parts parts{.wave = parts_->wave.get(),
                                 .particles = parts_->particlesOrNull(),
                                 .population = population ? &*population : nullptr,
                                 .foam = parts_->foam.get(),
                                 .boats = parts_->boats.get()};
  const auto timer = timers_.scope("stream");
  parts_->uniforms.bindUniform(SIM_UNIFORMS);
  return parts_->frames->pack(tick_, time_s(), scene_, derived_, parts, request);
}

core::ReducedCounts WaterSim::reducedCounts() const {
  return core::reducedCounts(derived_.wave ? derived_.wave->counts() : core::CellCounts{},
                             derived_.particles ? derived_.particles->count : 0);
}

std::size_t WaterSim::framesInFlight() const {
  return parts_->frames->inFlightCount();
}

std::vector<core::FrameView> WaterSim::takeFrames() {
  return parts_->frames->poll();
}

// State

std::vector<double> WaterSim::copyElevation() {
  const std::size_t n = derived_.wave->counts().total();
  std::vector<double> out;
  out.reserve(n);
  for (const std::int32_t units : parts_->wave->elevation().downloadVector<std::int32_t>(n))
    out.push_back(units * double{ELEVATION_UNIT_M});
  return out;
}

StateCopy WaterSim::copyState() {
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
  if (parts_->boats) out.boats = parts_->boats->state().downloadVector<float>(std::size_t{MAX_BOATS} * BOAT_TEXELS * 4);
  if (parts_->wave) {
    const std::size_t n = derived_.wave->counts().total();
    out.elevation_m = copyElevation();
    out.flow_m2ps = parts_->wave->flow().downloadVector<float>(n * parts_->wave->flowComponents());
    if (auto* elevation_x = parts_->wave->elevationX())
      out.elevation_x_units = elevation_x->downloadVector<std::int32_t>(n);
  }
  return out;
}

void WaterSim::setState(const StateCopy& state) {
  abandoned_until_tick_ = tick_;  // health in flight belongs to the state before
  ledger_units_.reset();
  if (parts_->particles) {
    parts_->particles->position.upload(state.position);
    parts_->particles->velocity.upload(state.velocity);
  }
  if (parts_->pool && !state.pool.empty()) parts_->pool->words().upload(state.pool);
  if (parts_->boats) parts_->boats->state().upload(state.boats);
  if (parts_->wave) {
    std::vector<std::int32_t> units;
    for (const double eta_m : state.elevation_m)
      units.push_back(static_cast<std::int32_t>(std::lround(eta_m * double{ELEVATION_UNITS_PER_M})));
    parts_->wave->elevation().upload(units);
    parts_->wave->flow().upload(state.flow_m2ps);
    parts_->wave->forgetLastStep();
    if (auto* elevation_x = parts_->wave->elevationX()) elevation_x->upload(state.elevation_x_units);
  }
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
  add(std::as_bytes(std::span(state.elevation_x_units)));
  return hash;
}

}  // namespace spindrift::sim
