// WaterSim: health, frames, and copies of the state.
#include <algorithm>
#include <cmath>
#include <ranges>
#include <string_view>

#include <shared/fixed_point.h>
#include <spdlog/spdlog.h>

#include "shader_defines.h"
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
    recordGauges(health);
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

void WaterSim::takeHealth() {
  ctx_.finish();
  watchHealth();
}

void WaterSim::recordGauges(const Health& health) {
  const double time_s = static_cast<double>(health.tick - start_tick_) * derived_.tick_s;
  if (gauges_) gauges_->add(time_s, health.gauges);
  for (const PlacedReading& placed : health.placed_gauges) {
    const auto history = placed_gauges_.find(placed.gauge_id);
    if (history != placed_gauges_.end()) history->second->add(time_s, std::span(&placed.reading, 1));
  }
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
  if (parts_->floaters) parts_->floaters->mend();
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
                                 .boats = parts_->boats.get(),
                                 .floaters = parts_->floaters.get()};
  const auto timer = timers_.scope("stream");
  parts_->uniforms.bindUniform(SIM_UNIFORMS);
  return parts_->frames->pack(tick_, time_s(), scene_, derived_, parts, request);
}

core::Result<bool> WaterSim::sampleAt(std::span<const SurfacePoint> points, std::uint64_t number) {
  if (!parts_->wave) return core::invalid("the scene has no wave to ask");
  if (!parts_->points) {
    Creation create(ctx_, shaderDefines(scene_));
    auto made = std::make_unique<SurfacePoints>(create);
    if (create.error()) return *create.error();
    parts_->points = std::move(made);
  }
  const auto timer = timers_.scope("queries");
  parts_->uniforms.bindUniform(SIM_UNIFORMS);
  return parts_->points->sample(points, number, *derived_.wave, *parts_->wave, parts_->foam.get());
}

std::vector<SurfaceSamples> WaterSim::takeSamples() {
  return parts_->points ? parts_->points->poll() : std::vector<SurfaceSamples>();
}

std::size_t WaterSim::samplesInFlight() const {
  return parts_->points ? parts_->points->inFlightCount() : 0;
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
  const std::size_t live_count = parts_->liveCount(derived_);
  StateCopy::forEachArray(out, [&](std::string_view name, auto& words) {
    using Word = std::ranges::range_value_t<decltype(words)>;
    if (const auto from = carriedBuffer(name)) words = from->buffer->downloadVector<Word>(from->wordCount(live_count));
  });
  if (parts_->particles) {
    const auto acceleration = parts_->particles->acceleration.downloadVector<float>(4 * live_count);
    for (std::size_t i = 3; i < acceleration.size(); i += 4) out.density_kgpm3.push_back(acceleration[i]);
  }
  if (parts_->wave) out.elevation_m = copyElevation();
  return out;
}

void WaterSim::setState(const StateCopy& state) {
  abandoned_until_tick_ = tick_;  // health in flight belongs to the state before
  ledger_units_.reset();
  StateCopy::forEachArray(state, [&](std::string_view name, const auto& words) {
    if (const auto to = carriedBuffer(name)) to->buffer->upload(words);
  });
  if (!parts_->wave) return;
  std::vector<std::int32_t> units;
  units.reserve(state.elevation_m.size());
  for (const double eta_m : state.elevation_m)
    units.push_back(static_cast<std::int32_t>(std::lround(eta_m * double{ELEVATION_UNITS_PER_M})));
  parts_->wave->elevation().upload(units);
  parts_->wave->forgetLastStep();
}

std::optional<StateBuffer> WaterSim::carriedBuffer(std::string_view name) {
  for (const StateBuffer& each : parts_->stateBuffers())
    if (each.carried && each.buffer->name() == name) return each;
  return std::nullopt;
}

}  // namespace spindrift::sim
