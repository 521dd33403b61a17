#include "room.h"

#include <algorithm>

#include <spdlog/spdlog.h>

#include <spindrift/stream/frame_encoder.h>
#include <spindrift/stream/scene_loader.h>

namespace spindrift::app {
namespace {

using namespace std::chrono_literals;
using std::chrono::duration;

constexpr std::size_t kCommandQueueCount = 1024;
/// A paused room still shows newcomers its water.
constexpr auto kPausedFrameInterval = 500ms;
/// A paused room's frame that found no free slot is asked for again.
constexpr auto kDroppedFrameRetry = 10ms;
/// While the device works on a frame, look for it this often.
constexpr auto kReadbackPollInterval = 1ms;
constexpr double kSlowFactor = 0.9;
constexpr auto kSlowPatience = 5s;
constexpr auto kSlowWarningInterval = 60s;

/// Whether somebody watches the layer, plain or packed.
bool isWatched(const net::Hub& hub, const std::string& room, v1::Layer layer) {
  return std::ranges::any_of(stream::allStreams(), [&](const stream::Stream& stream) {
    return stream.layer == layer && hub.watcherCount(room, static_cast<net::LayerIndex>(stream::indexOf(stream))) > 0;
  });
}

}  // namespace

core::Result<std::unique_ptr<sim::WaterSim>> createWarm(gpu::Context& ctx, const v1::Scene& scene) {
  // A step's shaders are compiled when they first run, which takes a software device seconds; diagnostics run every
  // fourth tick, so as many ticks leave their rhythm as it was.
  constexpr int kWarmUpTickCount = 4;
  auto sim = sim::WaterSim::create(ctx, stream::toCore(scene));
  if (!sim) return sim;
  for (int i = 0; i < kWarmUpTickCount; ++i) (*sim)->step();
  (void)(*sim)->requestFrame({.surface = true, .particles = true, .foam = true, .bodies = true});
  ctx.finish();
  (void)(*sim)->takeFrames();
  (void)(*sim)->takePassCosts();
  (*sim)->reset();
  return sim;
}

Room::Room(gpu::Context& ctx, std::string name, v1::Scene scene, const SceneCatalog& scenes,
           std::unique_ptr<sim::WaterSim> sim)
    : ctx_(ctx),
      name_(std::move(name)),
      scenes_(scenes),
      scene_(std::move(scene)),
      sim_(std::move(sim)),
      commands_(kCommandQueueCount),
      clock_(sim_->derived().tick_s),
      tick_shift_(0 - sim_->tick()) {
  recovery_news_.restart(sim_->recoveredCount());
  readBoats();
  publishSnapshot();
}

core::Result<std::unique_ptr<Room>> Room::create(gpu::Context& ctx, RoomSetup setup, const SceneCatalog& scenes) {
  auto sim = createWarm(ctx, setup.scene);
  if (!sim) return core::Error{sim.error().code, "room " + setup.name + ": " + sim.error().message};
  return std::unique_ptr<Room>(new Room(ctx, std::move(setup.name), std::move(setup.scene), scenes, *std::move(sim)));
}

std::shared_ptr<const RoomSnapshot> Room::snapshot() const {
  const std::lock_guard lock(snapshot_mutex_);
  return snapshot_;
}

void Room::publishSnapshot() {
  auto fresh = std::make_shared<const RoomSnapshot>(RoomSnapshot{scene_, paused_, clock_.speed(), boats_});
  const std::lock_guard lock(snapshot_mutex_);
  snapshot_ = std::move(fresh);
}

void Room::readBoats() {
  boats_.Clear();
  for (const sim::BoatRecord& boat : sim_->boats()) {
    v1::BoatInfo& info = *boats_.add_boats();
    info.set_boat_id(boat.boat_id);
    info.set_length_m(boat.length_m);
    info.set_beam_m(boat.beam_m);
    info.set_height_m(boat.height_m);
    info.set_draught_m(boat.draught_m);
  }
}

// One tick

void Room::start(TimePoint now) {
  clock_.restart(now);
  last_run_ = now;
}

Room::TimePoint Room::due(TimePoint now) const {
  if (pending_tick_count_ > 0) return now;
  const TimePoint next = paused_ ? now + 10ms : clock_.due();
  return frames_in_flight_ > 0 ? std::min(next, now + kReadbackPollInterval) : next;
}

void Room::run(TimePoint now, net::Hub& hub, EncoderThread& encoder, RoomObserver& observer) {
  if (!paused_) unpaused_wall_s_ += duration<double>(now - last_run_).count();
  last_run_ = now;
  handOverFrames(encoder);
  if (paused_ || now >= clock_.due()) applyCommands(hub, observer);
  if (paused_) {
    advancePaused(now, hub);
  } else if (now >= clock_.due()) {
    step(now, hub);
  }
  announceRecovery(now, hub);
  handOverFrames(encoder);
}

void Room::step(TimePoint now, net::Hub& hub) {
  const TimePoint end = timedStep();
  run_s_ += sim_->derived().tick_s;
  unpaused_wall_s_ += duration<double>(end - std::max(now, last_run_)).count();
  last_run_ = end;
  clock_.ticked(end);
  if (sim_->time_s() + 1e-9 >= next_frame_s_) requestFrame(end, hub);
  watchRealTime(end);
}

void Room::advancePaused(TimePoint now, net::Hub& hub) {
  if (pending_tick_count_ > 0) {
    const TimePoint end = timedStep();
    if (--pending_tick_count_ == 0) next_idle_frame_ = end;  // what was asked for is there to see at once
    now = end;
  }
  if (now >= next_idle_frame_) requestFrame(now, hub);
}

Room::TimePoint Room::timedStep() {
  const auto begin = std::chrono::steady_clock::now();
  sim_->step();
  const auto end = std::chrono::steady_clock::now();
  step_ms_sum_ += duration<double, std::milli>(end - begin).count();
  ++step_count_;
  return end;
}

// Frames

void Room::requestFrame(TimePoint now, net::Hub& hub) {
  const double interval_s = clock_.speed() / scene_.stream().frame_rate_hz();  // frames keep their rate in wall time
  if (!paused_) next_frame_s_ = std::max(next_frame_s_ + interval_s, sim_->time_s());
  next_idle_frame_ = now + kPausedFrameInterval;
  wants_diagnostics_ = wants_diagnostics_ || isWatched(hub, name_, v1::LAYER_DIAGNOSTICS);
  const auto wanted = [&](bool has_it, v1::Layer layer) { return has_it && isWatched(hub, name_, layer); };
  const sim::FrameRequest request{.surface = wanted(scene_.has_wave(), v1::LAYER_SURFACE),
                                  .particles = wanted(scene_.has_particles(), v1::LAYER_PARTICLES),
                                  .foam = wanted(scene_.foam().surface(), v1::LAYER_FOAM),
                                  .bodies = wanted(scene_.has_boats(), v1::LAYER_BODIES)};
  if (!request.surface && !request.particles && !request.foam && !request.bodies) return;
  if (sim_->requestFrame(request)) {
    ++frames_in_flight_;
  } else {
    ++dropped_frames_;
    next_idle_frame_ = now + kDroppedFrameRetry;
  }
}

void Room::handOverFrames(EncoderThread& encoder) {
  for (core::FrameView& frame : sim_->takeFrames()) {
    if (frames_in_flight_ > 0) --frames_in_flight_;
    frame.tick += tick_shift_;
    if (wants_diagnostics_) frame.diagnostics = diagnostics();
    wants_diagnostics_ = false;
    encoder.submit(name_, std::move(frame));
  }
  if (wants_diagnostics_ && frames_in_flight_ == 0) {
    wants_diagnostics_ = false;
    core::FrameView frame;
    frame.tick = tick();
    frame.time_s = sim_->time_s();
    frame.diagnostics = diagnostics();
    encoder.submit(name_, std::move(frame));
  }
}

core::DiagnosticsView Room::diagnostics() {
  if (step_count_ > 0) last_step_ms_ = step_ms_sum_ / step_count_;
  const sim::Health& h = sim_->health();
  const sim::Derived& d = sim_->derived();
  core::DiagnosticsView out;
  out.step_ms = last_step_ms_;
  out.real_time_factor = paused_ ? 0.0 : clock_.realTimeFactor();
  out.substeps_count = d.substeps_count;
  out.particle_count = sim_->particleCount();
  out.max_particle_speed_mps = h.max_speed_mps;
  out.max_elevation_m = h.max_elevation_m;
  out.kinetic_energy_j = h.kinetic_energy_j;
  out.potential_energy_j = h.potential_energy_j;
  out.wave_energy_j = h.wave_energy_j;
  out.mean_density_ratio = h.mean_density_ratio;
  out.max_density_ratio = h.max_density_ratio;
  out.nonfinite_count = sim_->nonfiniteCount();
  out.escaped_count = sim_->escapedCount();
  out.recovered_count = sim_->recoveredCount();
  out.boat_count = sim_->boatCount();
  out.volume_error_units = h.volume_error_units;
  out.emitted_m3 = h.emitted_m3;
  out.absorbed_m3 = h.absorbed_m3;
  out.breaking_ratio = h.breaking_ratio;
  if (step_count_ > 0) {
    last_passes_.clear();
    for (const gpu::PassCost& pass : sim_->takePassCosts())
      last_passes_.push_back({pass.name, pass.total_ms / step_count_});
  }
  out.passes = last_passes_;
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
      "room {}: time runs at {:.2f} of {:.2f} wanted: this machine cannot keep up; use fewer particles, a coarser wave "
      "or a lower speed",
      name_, factor, clock_.speed());
}

double Room::meanRealTimeFactor(TimePoint now) const {
  const double open_s = paused_ ? 0.0 : duration<double>(now - last_run_).count();
  const double wall_s = unpaused_wall_s_ + open_s;
  return wall_s > 0 ? run_s_ / wall_s : 0.0;
}

}  // namespace spindrift::app
