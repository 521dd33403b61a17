#include <utility>

#include <spindrift/codec/stream.h>
#include <spindrift/core/monotonic.h>
#include <spindrift/rooms/room_frames.h>
#include <spindrift/rooms/room_view.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// A paused room's frame that found no free slot is asked for again.
constexpr auto kDroppedFrameRetry = 10ms;

}  // namespace

void RoomFrames::afterTick(TimePoint scheduled, TimePoint end) {
  const auto levels = schedule_.afterTick({.time_s = parts_.water.sim().time_s(),
                                           .scheduled = scheduled,
                                           .end = end,
                                           .speed = parts_.time.speed(),
                                           .frame_rate_hz = parts_.water.scene().stream().frame_rate_hz()});
  if (levels) request(end, *levels);
}

void RoomFrames::whilePaused(TimePoint now) {
  if (now < schedule_.idleDue()) return;
  schedule_.idleFrame(now);
  request(now, core::LevelSet::all());
}

void RoomFrames::request(TimePoint now, core::LevelSet due) {
  const v1::Scene& scene = parts_.water.scene();
  sim::WaterSim& sim = parts_.water.sim();
  const core::ReducedCounts counts = sim.reducedCounts();
  sim::FrameRequest request{.asked_s = core::monotonic_s(now), .state_id = parts_.water.stateId(), .due = due};
  for (const codec::Stream& stream : codec::allStreams()) {
    const std::uint32_t reduced_count = codec::reducedCountOf(stream.layer, counts);
    const auto demand = core::demandOfFrame(parts_.demand.of(codec::indexOf(stream), now), reduced_count,
                                            codec::levelsTaking(stream.layer, due));
    for (std::size_t k = 0; k < core::kLevelCount; ++k) {
      if (demand[k].watcher_count == 0) continue;
      sim::LayerRequest& layers = request.levels[k];
      layers.surface |= stream.layer == v1::LAYER_SURFACE && scene.has_wave();
      layers.particles |= stream.layer == v1::LAYER_PARTICLES && scene.has_particles();
      layers.foam |= stream.layer == v1::LAYER_FOAM && scene.foam().surface();
      request.bodies |= stream.layer == v1::LAYER_BODIES && scene.has_boats();
      request.floaters |= stream.layer == v1::LAYER_FLOATERS && scene.has_floaters();
      wants_diagnostics_ |= stream.layer == v1::LAYER_DIAGNOSTICS;
    }
  }
  if (request.isEmpty() || sim.requestFrame(request)) return;
  ++dropped_count_;
  schedule_.setIdleDue(now + kDroppedFrameRetry);
}

void RoomFrames::handOver() {
  sim::WaterSim& sim = parts_.water.sim();
  for (core::FrameView& frame : sim.takeFrames()) {
    frame.tick = parts_.water.tickOf(frame.tick);
    if (std::exchange(wants_diagnostics_, false)) frame.diagnostics = diagnostics();
    parts_.outlets.frameReady(parts_.room, std::move(frame));
  }
  if (!wants_diagnostics_ || sim.framesInFlight() > 0) return;
  wants_diagnostics_ = false;
  core::FrameView frame;
  frame.tick = parts_.water.tick();
  frame.time_s = sim.time_s();
  frame.state_id = parts_.water.stateId();
  frame.diagnostics = diagnostics();
  parts_.outlets.frameReady(parts_.room, std::move(frame));
}

void RoomFrames::restart() {
  schedule_.restart();
  schedule_.setIdleDue({});
  wants_diagnostics_ = false;
}

core::DiagnosticsView RoomFrames::diagnostics() {
  sim::WaterSim& sim = parts_.water.sim();
  return diagnosticsOf(sim, parts_.tick_meter.takeMeans(sim), parts_.time.realTimeFactor());
}

}  // namespace spindrift::rooms
