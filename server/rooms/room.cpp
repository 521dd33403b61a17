#include <algorithm>

#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/core/version.h>
#include <spindrift/rooms/room.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using std::chrono::duration;

/// Share of the wall time that heavy commands may take, and how much of it at once: ticks come first.
constexpr double kHeavyShare = 0.25;
constexpr auto kHeavyBurst = 30ms;
/// A paused room's frame that found no free slot is asked for again.
constexpr auto kDroppedFrameRetry = 10ms;
/// While the device works on a frame, look for it this often.
constexpr auto kReadbackPollInterval = 1ms;
/// A room that stands still and has commands that cannot be carried out yet (heavy ones wait for their budget).
constexpr auto kWaitingCommandInterval = 10ms;
/// A room that stands still looks after its state on disk, its people and its metrics.
constexpr auto kStandingInterval = 1s;
/// Time from the last client's leaving until a room whose scene sleeps without clients stops.
constexpr auto kSleepPatience = 2s;
constexpr auto kVitalsInterval = 250ms;
constexpr double kSlowFactor = 0.9;
constexpr auto kSlowPatience = 5s;
constexpr auto kSlowWarningInterval = 60s;

}  // namespace

Room::Room(std::string name, const RoomRules& rules, WaterBuilder& builder, RoomOutlets& outlets,
           std::unique_ptr<RoomWater> room_water, std::unique_ptr<CommandLogWriter> log)
    : name_(std::move(name)),
      rules_(rules),
      builder_(builder),
      outlets_(outlets),
      water_(std::move(room_water)),
      log_(std::move(log)),
      heavy_budget_(kHeavyShare, kHeavyBurst),
      chosen_fidelity_(water_->scene().fidelity()),
      roster_(rules.grace, [this] { wake(); }),
      clock_(water_->sim().derived().tick_s),
      boats_(water_->boats()) {
  recovery_news_.restart(water_->sim().recoveredCount());
  tick_cost_.restart(water_->warmTick_ms(), water_->work());
  publishSnapshot();
  publishVitals({});
}

core::Result<std::shared_ptr<Room>> Room::create(std::string name, std::unique_ptr<Water> water, const RoomRules& rules,
                                                 WaterBuilder& builder, RoomOutlets& outlets, RoomPlace place,
                                                 v1::RoomAccess access) {
  auto room = begin(std::move(name), std::move(water), rules, builder, outlets, std::move(place), std::move(access));
  if (!room) return room;
  if (const auto restored = (*room)->restoreUntil(TimePoint::max()); !restored) return restored.error();
  if (const auto kept = (*room)->isOnDisk(TimePoint::max()); !kept) return kept.error();
  return room;
}

core::Result<std::shared_ptr<Room>> Room::begin(std::string name, std::unique_ptr<Water> water, const RoomRules& rules,
                                                WaterBuilder& builder, RoomOutlets& outlets, RoomPlace place,
                                                v1::RoomAccess access) {
  auto room_water = std::make_unique<RoomWater>(std::move(water));
  std::unique_ptr<CommandLogWriter> log;
  if (!rules.record_folder.empty() && place.kept) {
    spdlog::warn(
        "room {}: is not recorded, because it continues from its state on disk, and a log has to begin with a scene",
        name);
  } else if (!rules.record_folder.empty()) {
    v1::RecordHeader header;
    header.set_server(std::string(core::nameAndVersion()));
    describeDevice(header, room_water->device());
    header.set_room(name);
    *header.mutable_scene() = room_water->scene();
    header.set_hash_interval_ticks(rules.hash_interval_ticks);
    auto opened = CommandLogWriter::create(rules.record_folder, header);
    if (!opened) return opened.error();
    log = *std::move(opened);
    spdlog::info("room {}: recorded to {}", name, log->file().string());
  }
  auto room =
      std::shared_ptr<Room>(new Room(std::move(name), rules, builder, outlets, std::move(room_water), std::move(log)));
  room->access_ = std::move(access);
  if (!place.keeper) return room;
  room->restoration_ = std::make_unique<Restoration>();
  room->restoration_->keeper = std::move(place.keeper);
  if (place.kept) {
    auto repetition = room->repetitionOf(*std::move(place.kept));
    if (!repetition) return repetition.error();
    room->restoration_->repetition = *std::move(repetition);
  }
  return room;
}

std::shared_ptr<const RoomSnapshot> Room::snapshot() const {
  const std::lock_guard lock(snapshot_mutex_);
  return snapshot_;
}

void Room::publishSnapshot() {
  auto fresh = std::make_shared<const RoomSnapshot>(
      RoomSnapshot{water_->scene(), water_->sceneVersion(), paused_, clock_.speed(), boats_, water_->sim().gauges()});
  const std::lock_guard lock(snapshot_mutex_);
  snapshot_ = std::move(fresh);
}

bool Room::askForSnapshot() {
  if (!keeper_) return false;
  keeper_->ask();
  wake();
  return true;
}

std::optional<StateKeeper::Status> Room::keptStatus() const {
  if (!keeper_) return std::nullopt;
  return keeper_->status();
}

std::shared_ptr<const RoomVitals> Room::vitals() const {
  const std::lock_guard lock(snapshot_mutex_);
  return vitals_;
}

void Room::publishVitals(TimePoint now) {
  next_vitals_ = now + kVitalsInterval;
  auto fresh = std::make_shared<RoomVitals>();
  fresh->tick = tick();
  fresh->time_s = water_->sim().time_s();
  fresh->asleep = asleep_;
  fresh->lost = is_lost_;
  fresh->waiting_command_count = static_cast<std::uint32_t>(commands_.size());
  fresh->dropped_frame_count = dropped_frames_;
  fresh->tick_times = tick_times_;
  fresh->diagnostics = diagnostics();
  const std::lock_guard lock(snapshot_mutex_);
  vitals_ = std::move(fresh);
}

void Room::publishLoss() {
  auto fresh = std::make_shared<RoomVitals>(*vitals());
  fresh->lost = true;
  const std::lock_guard lock(snapshot_mutex_);
  vitals_ = std::move(fresh);
}

void Room::record(v1::Record record) {
  if (!log_) return;
  record.set_tick(tick());
  log_->write(std::move(record));
}

// One tick

void Room::start(TimePoint now) {
  clock_.restart(now);
  last_run_ = last_watched_ = now;
}

Room::TimePoint Room::due() const {
  const auto is_ready = [](const auto& work) { return work.wait_for(0s) == std::future_status::ready; };
  if (change_ ? is_ready(change_->prepared) : build_ && is_ready(build_->water)) return ran_;
  const bool is_stopped = is_lost_ || change_;
  const bool stands_still = is_stopped || paused_ || asleep_;
  TimePoint next = stands_still ? ran_ + kStandingInterval : clock_.due();
  const auto no_later_than = [&next](TimePoint when) { next = std::min(next, when); };
  if (!is_lost_ && water_->sim().framesInFlight() > 0) no_later_than(ran_ + kReadbackPollInterval);
  if (!stands_still) return next;
  if (is_woken_ || (pending_tick_count_ > 0 && !is_stopped)) return ran_;
  if (commands_.size() > 0 || put_off_) no_later_than(ran_ + kWaitingCommandInterval);
  if (is_lost_ && !build_) no_later_than(next_rebuild_);
  if (has_people_news_) no_later_than(next_people_news_);
  if (paused_ && !is_stopped && outlets_.sessionCount(*this) > 0) no_later_than(frames_.idleDue());
  return next;
}

void Room::wake() {
  if (!is_woken_.exchange(true) && on_wake_) on_wake_();
}

void Room::run(TimePoint now, double thread_load) {
  thread_load_ = thread_load;
  is_woken_ = false;
  ran_ = now;
  water_->bind();
  water_->reloadChangedShaders();
  session_count_ = outlets_.sessionCount();
  adoptWater(now);
  if (isLost(now)) {
    announce();
    return;
  }
  const bool stands_still = paused_ || asleep_;
  if (!stands_still) unpaused_wall_s_ += duration<double>(now - last_run_).count();
  last_run_ = now;
  handOverFrames();
  watchOverSleep(now);
  settlePeople(now);
  finishChange();
  if (paused_ || asleep_ || now >= clock_.due()) applyCommands(now);
  announce();
  if (change_) {
    // The state stands still until the particles are laid out.
  } else if (paused_) {
    advancePaused(now);
  } else if (!asleep_ && now >= clock_.due()) {
    step(now);
  }
  announceRecovery(now);
  keepState(now);
  handOverFrames();
  if (now >= next_vitals_) publishVitals(now);
}

void Room::watchOverSleep(TimePoint now) {
  if (water_->scene().unwatched() != v1::UNWATCHED_SLEEP || outlets_.sessionCount(*this) > 0) {
    last_watched_ = now;
    if (!asleep_) return;
    asleep_ = false;
    clock_.restart(now);
  } else if (!asleep_ && now - last_watched_ >= kSleepPatience) {
    asleep_ = true;
    publishVitals(now);
  }
}

void Room::step(TimePoint now) {
  const TimePoint scheduled = clock_.due();
  const TimePoint end = timedStep();
  run_s_ += water_->sim().derived().tick_s;
  unpaused_wall_s_ += duration<double>(end - std::max(now, last_run_)).count();
  last_run_ = end;
  clock_.ticked(end);
  restartIfOver();
  const auto levels = frames_.afterTick({.time_s = water_->sim().time_s(),
                                         .scheduled = scheduled,
                                         .end = end,
                                         .speed = clock_.speed(),
                                         .frame_rate_hz = water_->scene().stream().frame_rate_hz()});
  if (levels) requestFrame(end, *levels);
  watchRealTime(end);
  adaptFidelity(end);
}

void Room::advancePaused(TimePoint now) {
  if (pending_tick_count_ > 0) {
    const TimePoint end = timedStep();
    if (--pending_tick_count_ == 0) frames_.setIdleDue(end);  // what was asked for is there to see at once
    now = end;
  }
  if (now < frames_.idleDue()) return;
  frames_.idleFrame(now);
  requestFrame(now, core::LevelSet::all());
}

Room::TimePoint Room::timedStep() {
  const auto begin = std::chrono::steady_clock::now();
  water_->step();
  const auto end = std::chrono::steady_clock::now();
  const double step_ms = duration<double, std::milli>(end - begin).count();
  tick_cost_.note(step_ms);
  tick_times_.note(1e-3 * step_ms);
  step_ms_sum_ += step_ms;
  ++step_count_;
  if (log_ && !log_->ended()) {
    if (const std::uint64_t count = water_->sim().recoveredCount(); count != logged_recovery_count_) {
      logged_recovery_count_ = count;
      v1::Record recovered;
      recovered.set_recovered(true);
      record(std::move(recovered));
    }
    if (tick() % log_->hashInterval_ticks() == 0) {
      v1::Record hash;
      hash.set_state_hash(water_->sim().stateHash());
      record(std::move(hash));
    }
  }
  return end;
}

// Frames

void Room::requestFrame(TimePoint now, core::LevelSet due) {
  const v1::Scene& scene = water_->scene();
  const WatchedLayers watched = outlets_.watched(*this, water_->sim().reducedCounts(), due);
  wants_diagnostics_ = wants_diagnostics_ || watched.diagnostics;
  sim::FrameRequest request{.bodies = scene.has_boats() && watched.bodies,
                            .asked_s = core::monotonic_s(now),
                            .state_id = water_->stateId(),
                            .due = due};
  for (std::size_t k = 0; k < core::kLevelCount; ++k) {
    const sim::LayerRequest& layers = watched.levels[k];
    request.levels[k] = {.surface = scene.has_wave() && layers.surface,
                         .particles = scene.has_particles() && layers.particles,
                         .foam = scene.foam().surface() && layers.foam};
  }
  if (request.isEmpty() || water_->sim().requestFrame(request)) return;
  ++dropped_frames_;
  frames_.setIdleDue(now + kDroppedFrameRetry);
}

void Room::handOverFrames() {
  for (core::FrameView& frame : water_->sim().takeFrames()) {
    frame.tick = water_->tickOf(frame.tick);
    if (wants_diagnostics_) frame.diagnostics = diagnostics();
    wants_diagnostics_ = false;
    outlets_.frameReady(*this, std::move(frame));
  }
  if (wants_diagnostics_ && water_->sim().framesInFlight() == 0) {
    wants_diagnostics_ = false;
    core::FrameView frame;
    frame.tick = tick();
    frame.time_s = water_->sim().time_s();
    frame.state_id = water_->stateId();
    frame.diagnostics = diagnostics();
    outlets_.frameReady(*this, std::move(frame));
  }
}

std::vector<core::DiagnosticsView::GaugeNow> gaugesNow(const sim::WaterSim& water) {
  std::vector<core::DiagnosticsView::GaugeNow> out;
  if (!water.gauges()) return out;
  const std::vector<sim::GaugeHistory::Now> now = water.gauges()->now();
  for (std::size_t k = 0; k < now.size(); ++k) {
    out.push_back({.name = water.scene().gauges[k].name,
                   .elevation_m = now[k].reading.elevation_m,
                   .velocity_x_mps = now[k].reading.velocity_x_mps,
                   .velocity_z_mps = now[k].reading.velocity_z_mps,
                   .highest_m = now[k].highest_m,
                   .lowest_m = now[k].lowest_m});
  }
  return out;
}

core::DiagnosticsView Room::diagnostics() {
  if (step_count_ > 0) last_step_ms_ = step_ms_sum_ / step_count_;
  sim::WaterSim& water = water_->sim();
  const sim::Health& h = water.health();
  const sim::Derived& d = water.derived();
  core::DiagnosticsView out;
  out.step_ms = last_step_ms_;
  out.real_time_factor = paused_ || asleep_ ? 0.0 : clock_.realTimeFactor();
  out.substeps_count = d.substeps_count;
  out.particle_count = water.particleCount();
  out.max_particle_speed_mps = h.max_speed_mps;
  out.max_elevation_m = h.max_elevation_m;
  out.kinetic_energy_j = h.kinetic_energy_j;
  out.potential_energy_j = h.potential_energy_j;
  out.wave_energy_j = h.wave_energy_j;
  out.mean_density_ratio = h.mean_density_ratio;
  out.max_density_ratio = h.max_density_ratio;
  out.nonfinite_count = water.nonfiniteCount();
  out.escaped_count = water.escapedCount();
  out.recovered_count = water.recoveredCount();
  out.boat_count = water.boatCount();
  out.volume_error_units = h.volume_error_units;
  out.emitted_m3 = h.emitted_m3;
  out.absorbed_m3 = h.absorbed_m3;
  out.breaking_ratio = h.breaking_ratio;
  if (step_count_ > 0) {
    last_passes_.clear();
    for (const gpu::PassCost& pass : water.takePassCosts())
      last_passes_.push_back({pass.name, pass.total_ms / step_count_});
  }
  out.passes = last_passes_;
  out.gauges = gaugesNow(water);
  step_ms_sum_ = 0.0;
  step_count_ = 0;
  return out;
}

void Room::watchRealTime(TimePoint now) {
  const double factor = clock_.realTimeFactor();
  if (factor == 0.0 || factor >= kSlowFactor * clock_.speed()) {
    slow_since_ = now;
    return;
  }
  if (slow_since_ == TimePoint{}) slow_since_ = now;
  if (now - slow_since_ < kSlowPatience || now < next_slow_warning_) return;
  next_slow_warning_ = now + kSlowWarningInterval;
  spdlog::warn(
      "room {}: time runs at {:.2f} of {:.2f} wanted: this machine cannot keep up; use a lower fidelity (serve --adapt "
      "does so by itself), fewer particles, or a lower speed",
      name_, factor, clock_.speed());
}

double Room::meanRealTimeFactor(TimePoint now) const {
  const double open_s = paused_ || asleep_ ? 0.0 : duration<double>(now - last_run_).count();
  const double wall_s = unpaused_wall_s_ + open_s;
  return wall_s > 0 ? run_s_ / wall_s : 0.0;
}

}  // namespace spindrift::rooms
