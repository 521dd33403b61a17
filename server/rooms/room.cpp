#include <algorithm>

#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/rooms/room.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

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
constexpr auto kVitalsInterval = 250ms;

}  // namespace

Room::Room(std::string name, const RoomRules& rules, WaterBuilder& builder, RoomOutlets& outlets,
           std::unique_ptr<RoomWater> room_water, Diary diary)
    : name_(std::move(name)),
      rules_(rules),
      builder_(builder),
      outlets_(outlets),
      water_(std::move(room_water)),
      diary_(std::move(diary)),
      heavy_budget_(kHeavyShare, kHeavyBurst),
      chosen_fidelity_(water_->scene().fidelity()),
      roster_(rules.grace, [this] { wake(); }),
      time_(water_->sim().derived().tick_s),
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
  auto diary = Diary::create(name, *room_water, rules.record_folder, rules.hash_interval_ticks, place.kept.has_value());
  if (!diary) return diary.error();
  auto room = std::shared_ptr<Room>(
      new Room(std::move(name), rules, builder, outlets, std::move(room_water), *std::move(diary)));
  room->access_ = std::move(access);
  if (!place.keeper) return room;
  room->restoration_ = std::make_unique<Restoration>();
  room->restoration_->keeper = std::move(place.keeper);
  if (place.kept) {
    auto repetition = room->beginRepetition(*std::move(place.kept));
    if (!repetition) return repetition.error();
    room->restoration_->repetition.emplace(*std::move(repetition));
  }
  return room;
}

std::shared_ptr<const RoomSnapshot> Room::snapshot() const {
  const std::lock_guard lock(snapshot_mutex_);
  return snapshot_;
}

void Room::publishSnapshot() {
  auto fresh = std::make_shared<const RoomSnapshot>(RoomSnapshot{
      water_->scene(), water_->sceneVersion(), time_.isPaused(), time_.speed(), boats_, water_->sim().gauges()});
  const std::lock_guard lock(snapshot_mutex_);
  snapshot_ = std::move(fresh);
}

bool Room::askForSnapshot() {
  if (!diary_.keeper()) return false;
  diary_.keeper()->ask();
  wake();
  return true;
}

std::optional<StateKeeper::Status> Room::keptStatus() const {
  if (!diary_.keeper()) return std::nullopt;
  return diary_.keeper()->status();
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
  fresh->asleep = time_.isAsleep();
  fresh->lost = is_lost_;
  fresh->waiting_command_count = static_cast<std::uint32_t>(commands_.size());
  fresh->dropped_frame_count = dropped_frames_;
  fresh->tick_times = tick_meter_.times();
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

// One tick

void Room::start(TimePoint now) {
  time_.start(now);
}

Room::TimePoint Room::due() const {
  const auto is_ready = [](const auto& work) { return work.wait_for(0s) == std::future_status::ready; };
  if (change_ ? is_ready(change_->prepared) : build_ && is_ready(build_->water)) return ran_;
  const bool is_stopped = is_lost_ || change_;
  const bool stands_still = is_stopped || !time_.runs();
  TimePoint next = stands_still ? ran_ + kStandingInterval : time_.due();
  const auto no_later_than = [&next](TimePoint when) { next = std::min(next, when); };
  if (!is_lost_ && water_->sim().framesInFlight() > 0) no_later_than(ran_ + kReadbackPollInterval);
  if (!stands_still) return next;
  if (is_woken_ || (time_.stepsToCome() > 0 && !is_stopped)) return ran_;
  if (commands_.size() > 0 || put_off_) no_later_than(ran_ + kWaitingCommandInterval);
  if (is_lost_ && !build_) no_later_than(next_rebuild_);
  if (has_people_news_) no_later_than(next_people_news_);
  if (time_.isPaused() && !is_stopped && outlets_.sessionCount(*this) > 0) no_later_than(frames_.idleDue());
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
  time_.beginRound(now);
  handOverFrames();
  const bool may_sleep = water_->scene().unwatched() == v1::UNWATCHED_SLEEP;
  if (time_.watchOver(!may_sleep || outlets_.sessionCount(*this) > 0, now)) publishVitals(now);
  settlePeople(now);
  finishChange();
  if (!time_.runs() || now >= time_.due()) applyCommands(now);
  announce();
  if (change_) {
    // The state stands still until the particles are laid out.
  } else if (time_.isPaused()) {
    advancePaused(now);
  } else if (time_.runs() && now >= time_.due()) {
    step(now);
  }
  announceRecovery(now);
  keepState(now);
  handOverFrames();
  if (now >= next_vitals_) publishVitals(now);
}

void Room::step(TimePoint now) {
  const TimePoint scheduled = time_.due();
  const TimePoint end = timedStep();
  time_.ticked(now, end);
  restartIfOver();
  const auto levels = frames_.afterTick({.time_s = water_->sim().time_s(),
                                         .scheduled = scheduled,
                                         .end = end,
                                         .speed = time_.speed(),
                                         .frame_rate_hz = water_->scene().stream().frame_rate_hz()});
  if (levels) requestFrame(end, *levels);
  time_.warnIfSlow(name_, end);
  adaptFidelity(end);
}

void Room::advancePaused(TimePoint now) {
  if (time_.stepsToCome() > 0) {
    const TimePoint end = timedStep();
    if (time_.stepped()) frames_.setIdleDue(end);  // what was asked for is there to see at once
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
  const double step_ms = std::chrono::duration<double, std::milli>(end - begin).count();
  tick_cost_.note(step_ms);
  tick_meter_.note(step_ms);
  diary_.ticked(tick(), water_->sim());
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
  sim::WaterSim& water = water_->sim();
  const TickMeter::Means& means = tick_meter_.takeMeans(water);
  const sim::Health& h = water.health();
  const sim::Derived& d = water.derived();
  core::DiagnosticsView out;
  out.step_ms = means.step_ms;
  out.real_time_factor = time_.realTimeFactor();
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
  out.passes = means.passes;
  out.gauges = gaugesNow(water);
  return out;
}

}  // namespace spindrift::rooms
