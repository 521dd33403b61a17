#include "room.h"

#include <algorithm>
#include <variant>

#include <spdlog/spdlog.h>

#include <spindrift/stream/client_message.h>
#include <spindrift/stream/parameters.h>
#include <spindrift/stream/scene_loader.h>
#include <spindrift/stream/server_message.h>

namespace spindrift::app {
namespace {

using namespace std::chrono_literals;
using std::chrono::duration;

constexpr std::size_t kCommandQueueCount = 1024;
/// A paused room still shows newcomers its water.
constexpr auto kPausedFrameInterval = 500ms;
/// While the device works on a frame, look for it this often.
constexpr auto kReadbackPollInterval = 1ms;
constexpr double kSlowFactor = 0.9;
constexpr auto kSlowPatience = 5s;
constexpr auto kSlowWarningInterval = 60s;

net::LayerIndex slot(v1::Layer layer) {
  return static_cast<net::LayerIndex>(layer);
}

}  // namespace

Room::Room(std::string name, v1::Scene scene, std::unique_ptr<sim::WaterSim> sim)
    : name_(std::move(name)),
      scene_(std::move(scene)),
      sim_(std::move(sim)),
      commands_(kCommandQueueCount),
      clock_(sim_->derived().tick_s) {
  publishSnapshot();
}

core::Result<std::unique_ptr<Room>> Room::create(gpu::Context& ctx, RoomSetup setup) {
  auto sim = sim::WaterSim::create(ctx, stream::toCore(setup.scene));
  if (!sim) return core::Error{sim.error().code, "room " + setup.name + ": " + sim.error().message};
  return std::unique_ptr<Room>(new Room(std::move(setup.name), std::move(setup.scene), *std::move(sim)));
}

std::shared_ptr<const RoomSnapshot> Room::snapshot() const {
  const std::lock_guard lock(snapshot_mutex_);
  return snapshot_;
}

void Room::publishSnapshot() {
  auto fresh = std::make_shared<const RoomSnapshot>(RoomSnapshot{scene_, paused_, clock_.speed()});
  const std::lock_guard lock(snapshot_mutex_);
  snapshot_ = std::move(fresh);
}

// One tick

void Room::start(TimePoint now) {
  clock_.restart(now);
  last_run_ = now;
}

Room::TimePoint Room::due(TimePoint now) const {
  const TimePoint next = paused_ ? now + 10ms : clock_.due();
  return frames_in_flight_ > 0 ? std::min(next, now + kReadbackPollInterval) : next;
}

void Room::run(TimePoint now, net::Hub& hub, EncoderThread& encoder) {
  if (!paused_) unpaused_wall_s_ += duration<double>(now - last_run_).count();
  last_run_ = now;
  handOverFrames(encoder);
  if (paused_ || now >= clock_.due()) applyCommands(hub);
  if (paused_) {
    if (now >= next_idle_frame_) requestFrame(now, hub);
  } else if (now >= clock_.due()) {
    const auto begin = std::chrono::steady_clock::now();
    sim_->step();
    const auto end = std::chrono::steady_clock::now();
    step_ms_sum_ += duration<double, std::milli>(end - begin).count();
    ++step_count_;
    run_s_ += sim_->derived().tick_s;
    unpaused_wall_s_ += duration<double>(end - last_run_).count();
    last_run_ = end;
    clock_.ticked(end);
    if (sim_->time_s() + 1e-9 >= next_frame_s_) requestFrame(end, hub);
    watchRealTime(end);
  }
  handOverFrames(encoder);
}

// Commands

void Room::applyCommands(net::Hub& hub) {
  for (const core::Command& command : commands_.drain()) {
    if (auto rejection = apply(command, hub)) {
      rejection->command_id = command.command_id;
      hub.sendControl(command.session_id, stream::reject(*rejection));
    } else {
      hub.sendControl(command.session_id, stream::ack(command.command_id, sim_->tick()));
    }
  }
}

std::optional<stream::CommandRejection> Room::apply(const core::Command& command, net::Hub& hub) {
  // Checked against the scene when it arrived; parameters may have changed since.
  if (auto rejection = stream::checkAgainstScene(command, scene_)) return rejection;
  const auto announce = [&] {
    publishSnapshot();
    hub.broadcastControl(name_, stream::roomState(paused_, clock_.speed()));
  };
  if (const auto* change = std::get_if<core::SetParameter>(&command.action)) return setParameter(command, *change, hub);
  if (const auto* pause = std::get_if<core::SetPaused>(&command.action)) {
    if (paused_ && !pause->paused) clock_.restart(std::chrono::steady_clock::now());
    paused_ = pause->paused;
    announce();
    return {};
  }
  if (const auto* speed = std::get_if<core::SetSpeed>(&command.action)) {
    clock_.setSpeed(speed->speed);
    announce();
    return {};
  }
  if (std::holds_alternative<core::Reset>(command.action)) {
    sim_->reset();
    next_frame_s_ = 0.0;
    return {};
  }
  core::Result<void> started;
  if (const auto* splash = std::get_if<core::Splash>(&command.action)) started = sim_->start(*splash);
  if (const auto* wave = std::get_if<core::BreakingWave>(&command.action)) started = sim_->start(*wave);
  if (started) return {};
  const bool busy = started.error().code == core::ErrorCode::kUnavailable;
  return stream::CommandRejection{.command_id = command.command_id,
                                  .reason = busy ? v1::REJECT_REASON_BUSY : v1::REJECT_REASON_ABSENT_PART,
                                  .field = "",
                                  .message = started.error().message};
}

std::optional<stream::CommandRejection> Room::setParameter(const core::Command& command,
                                                           const core::SetParameter& change, net::Hub& hub) {
  v1::Scene changed = scene_;
  if (auto error = stream::setParameter(changed, change.path, change.value)) {
    return stream::CommandRejection{command.command_id, error->reason, error->field, error->message};
  }
  if (auto applied = sim_->setScene(stream::toCore(changed)); !applied) {
    return stream::CommandRejection{command.command_id, v1::REJECT_REASON_BREAKS_STEP_RULE, change.path,
                                    applied.error().message};
  }
  scene_ = std::move(changed);
  publishSnapshot();
  hub.broadcastControl(name_, stream::parameterChanged(change.path, change.value, sim_->tick()));
  return {};
}

// Frames

void Room::requestFrame(TimePoint now, net::Hub& hub) {
  const double interval_s = clock_.speed() / scene_.stream().frame_rate_hz();  // frames keep their rate in wall time
  if (!paused_) next_frame_s_ = std::max(next_frame_s_ + interval_s, sim_->time_s());
  next_idle_frame_ = now + kPausedFrameInterval;
  wants_diagnostics_ = wants_diagnostics_ || hub.watcherCount(name_, slot(v1::LAYER_DIAGNOSTICS)) > 0;
  const sim::FrameRequest request{
      .surface = scene_.has_wave() && hub.watcherCount(name_, slot(v1::LAYER_SURFACE)) > 0,
      .particles = scene_.has_particles() && hub.watcherCount(name_, slot(v1::LAYER_PARTICLES)) > 0};
  if (!request.surface && !request.particles) return;
  if (sim_->requestFrame(request))
    ++frames_in_flight_;
  else
    ++dropped_frames_;
}

void Room::handOverFrames(EncoderThread& encoder) {
  for (core::FrameView& frame : sim_->takeFrames()) {
    --frames_in_flight_;
    if (wants_diagnostics_) frame.diagnostics = diagnostics();
    wants_diagnostics_ = false;
    encoder.submit(name_, std::move(frame));
  }
  if (wants_diagnostics_ && frames_in_flight_ == 0) {
    wants_diagnostics_ = false;
    core::FrameView frame;
    frame.tick = sim_->tick();
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
  out.particle_count = d.particles ? d.particles->count : 0;
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
