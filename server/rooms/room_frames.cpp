#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <spindrift/codec/stream.h>
#include <spindrift/core/monotonic.h>
#include <spindrift/rooms/room_frames.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// A paused room's frame that found no free slot is asked for again.
constexpr auto kDroppedFrameRetry = 10ms;

using GaugeNow = core::DiagnosticsView::GaugeNow;

/// Writes what gauges have read, in the order of their history.
void setReadings(const sim::GaugeHistory& history, std::span<GaugeNow> gauges) {
  const std::vector<sim::GaugeHistory::Now> now = history.now();
  for (std::size_t k = 0; k < gauges.size(); ++k) {
    gauges[k].elevation_m = now[k].reading.elevation_m;
    gauges[k].velocity_x_mps = now[k].reading.velocity_x_mps;
    gauges[k].velocity_z_mps = now[k].reading.velocity_z_mps;
    gauges[k].highest_m = now[k].highest_m;
    gauges[k].lowest_m = now[k].lowest_m;
    gauges[k].is_unread = history.newestTime_s() == 0.0;
  }
}

/// Adds the gauges of the scene and those of people.
void addGauges(const RoomData& room, core::DiagnosticsView& out) {
  const sim::WaterSim& water = room.water->sim();
  for (const core::Gauge& gauge : water.scene().gauges)
    out.gauges.push_back({.name = gauge.name, .x_m = gauge.x_m, .z_m = gauge.z_m});
  if (const auto history = water.gauges()) {
    setReadings(*history, out.gauges);
    out.gauges_time_s = history->newestTime_s();
  }
  for (const PlacedGauge& gauge : room.gauges) {
    out.gauges.push_back({.name = gauge.name,
                          .x_m = gauge.x_m,
                          .z_m = gauge.z_m,
                          .gauge_id = gauge.gauge_id,
                          .person_id = gauge.person_id});
    setReadings(*gauge.history, std::span(out.gauges).last(1));
    out.gauges_time_s = std::max(out.gauges_time_s, gauge.history->newestTime_s());
  }
}

/// Returns where the boat or the floater with this id is: BodiesFixed28 and FloatersFixed28 begin with id, x, y, z.
std::optional<Referee::Position> placeOf(std::uint32_t id, std::span<const std::uint32_t> words, std::uint32_t count) {
  constexpr std::size_t kWords = 7;
  constexpr double kMillimetre_m = 1e-3;
  for (std::size_t at = 0; at < kWords * count && at + kWords <= words.size(); at += kWords) {
    if (words[at] != id) continue;
    return Referee::Position{kMillimetre_m * static_cast<std::int32_t>(words[at + 1]),
                             kMillimetre_m * static_cast<std::int32_t>(words[at + 3])};
  }
  return std::nullopt;
}

}  // namespace

void RoomFrames::afterTick(TimePoint scheduled, TimePoint end, double speed) {
  const auto levels = room_.schedule.afterTick({.time_s = room_.water->sim().time_s(),
                                                .scheduled = scheduled,
                                                .end = end,
                                                .speed = speed,
                                                .frame_rate_hz = room_.water->scene().stream().frame_rate_hz()});
  if (levels) request(end, *levels);
}

void RoomFrames::whilePaused(TimePoint now) {
  if (now < room_.schedule.idleDue()) return;
  room_.schedule.idleFrame(now);
  request(now, core::LevelSet::all());
}

void RoomFrames::request(TimePoint now, core::LevelSet due) {
  const v1::Scene& scene = room_.water->scene();
  sim::WaterSim& sim = room_.water->sim();
  const core::ReducedCounts counts = sim.reducedCounts();
  sim::FrameRequest request{.asked_s = core::monotonic_s(now), .state_id = room_.water->stateId(), .due = due};
  for (const codec::Stream& stream : codec::allStreams()) {
    const std::uint32_t reduced_count = codec::reducedCountOf(stream, counts);
    const auto demand = core::demandOfFrame(room_.demand->of(codec::indexOf(stream), now), reduced_count,
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
  const Referee& referee = room_.referee;
  request.bodies |= referee.isWatching() && referee.kind() == v1::GAME_KIND_RACE;
  request.floaters |= referee.isWatching() && referee.kind() == v1::GAME_KIND_BALL;
  if (request.isEmpty() || sim.requestFrame(request)) return;
  ++dropped_count_;
  room_.schedule.setIdleDue(now + kDroppedFrameRetry);
}

void RoomFrames::handOver() {
  sim::WaterSim& sim = room_.water->sim();
  for (core::FrameView& frame : sim.takeFrames()) {
    frame.tick = room_.water->tickOf(frame.tick);
    if (std::exchange(wants_diagnostics_, false)) frame.diagnostics = diagnostics();
    showReferee(frame);
    room_.outlets.frameReady(room_.self, std::move(frame));
  }
  if (!wants_diagnostics_ || sim.framesInFlight() > 0) return;
  wants_diagnostics_ = false;
  core::FrameView frame;
  frame.tick = room_.water->tick();
  frame.time_s = sim.time_s();
  frame.state_id = room_.water->stateId();
  frame.diagnostics = diagnostics();
  room_.outlets.frameReady(room_.self, std::move(frame));
}

void RoomFrames::showReferee(const core::FrameView& frame) {
  Referee& referee = room_.referee;
  if (!referee.isWatching()) return;
  Referee::Sample sample{.tick = frame.tick, .time_s = frame.time_s};
  std::vector<Referee::Boat> boats;
  if (referee.kind() == v1::GAME_KIND_RACE && frame.bodies) {
    for (const Roster::BoatOwner& owner : room_.roster.boatOwners()) {
      if (const auto place = placeOf(owner.boat_id, frame.bodies->words, frame.bodies->count))
        boats.push_back({owner.boat_id, owner.person_id, owner.team, *place});
    }
    sample.boats = boats;
  } else if (referee.kind() == v1::GAME_KIND_BALL && frame.floaters) {
    sample.ball = placeOf(referee.ballId(), frame.floaters->words, frame.floaters->count);
  } else {
    return;
  }
  referee.see(sample);
}

void RoomFrames::restart() {
  room_.schedule.restart();
  room_.schedule.setIdleDue({});
  wants_diagnostics_ = false;
}

core::DiagnosticsView RoomFrames::diagnostics() {
  sim::WaterSim& water = room_.water->sim();
  const TickMeter::Means& means = room_.tick_meter.takeMeans(water);
  const sim::Health& h = water.health();
  core::DiagnosticsView out{.step_ms = means.step_ms,
                            .real_time_factor = room_.time.realTimeFactor(),
                            .substeps_count = water.derived().substeps_count,
                            .particle_count = water.particleCount(),
                            .max_particle_speed_mps = h.max_speed_mps,
                            .max_elevation_m = h.max_elevation_m,
                            .kinetic_energy_j = h.kinetic_energy_j,
                            .potential_energy_j = h.potential_energy_j,
                            .wave_energy_j = h.wave_energy_j,
                            .mean_density_ratio = h.mean_density_ratio,
                            .max_density_ratio = h.max_density_ratio,
                            .nonfinite_count = water.nonfiniteCount(),
                            .escaped_count = water.escapedCount(),
                            .recovered_count = water.recoveredCount(),
                            .boat_count = water.boatCount(),
                            .volume_error_units = h.volume_error_units,
                            .emitted_m3 = h.emitted_m3,
                            .absorbed_m3 = h.absorbed_m3,
                            .breaking_ratio = h.breaking_ratio,
                            .passes = means.passes};
  addGauges(room_, out);
  return out;
}

}  // namespace spindrift::rooms
