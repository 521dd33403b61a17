#include <utility>

#include <spindrift/rooms/room_hulls.h>

namespace spindrift::rooms {
namespace {

void fill(v1::Wrench& out, const sim::Wrench& wrench) {
  out.set_force_x_n(wrench.force_n[0]);
  out.set_force_y_n(wrench.force_n[1]);
  out.set_force_z_n(wrench.force_n[2]);
  out.set_moment_roll_nm(wrench.moment_nm[0]);
  out.set_moment_pitch_nm(wrench.moment_nm[1]);
  out.set_moment_yaw_nm(wrench.moment_nm[2]);
}

}  // namespace

void RoomHulls::ticked() {
  const sim::WaterSim& sim = room_.water->sim();
  if (sim.hullForcesInFlight() == 0) return ticks_.clear();
  ticks_.push_back({.water_tick = sim.tick(),
                    .tick = room_.water->tick(),
                    .time_s = sim.time_s(),
                    .state_id = room_.water->stateId(),
                    .movers = room_.movers});
}

void RoomHulls::handOver() {
  if (ticks_.empty()) return;
  for (const sim::HullForces& forces : room_.water->sim().takeHullForces()) {
    while (!ticks_.empty() && ticks_.front().water_tick < forces.tick) ticks_.pop_front();
    if (ticks_.empty() || ticks_.front().water_tick != forces.tick) continue;
    tell(ticks_.front(), forces);
    ticks_.pop_front();
  }
  if (room_.water->sim().hullForcesInFlight() == 0) ticks_.clear();
}

void RoomHulls::tell(const Tick& tick, const sim::HullForces& forces) {
  std::map<std::uint64_t, std::pair<core::Sender, v1::HullForces>> by_session;
  for (const sim::HullForce& hull : forces.hulls) {
    const auto mover = tick.movers.find(hull.boat_id);
    if (mover == tick.movers.end()) continue;
    auto& [sender, message] = by_session[mover->second.session_id];
    sender = mover->second;
    v1::HullForce& out = *message.add_hulls();
    out.set_boat_id(hull.boat_id);
    fill(*out.mutable_hydrostatic(), hull.hydrostatic);
    fill(*out.mutable_dynamic(), hull.dynamic);
    fill(*out.mutable_drag(), hull.drag);
  }
  for (auto& [session_id, told] : by_session) {
    auto& [sender, message] = told;
    message.set_tick(tick.tick);
    message.set_time_s(tick.time_s);
    message.set_state_id(tick.state_id);
    room_.outlets.hullsFelt(room_.self, sender, message);
  }
}

}  // namespace spindrift::rooms
